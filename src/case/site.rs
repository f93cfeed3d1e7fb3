//! Contacts with the axes of their grids: all that is known of a case before a grid is filled.

use super::contact::PlacedContact;
use super::grids::{Grid, grids};
use super::input::Case;
use super::places::find;
use crate::error::Result;
use crate::numerics::interval::Interval;
use crate::patch::{Patch, Window};
use crate::search::TrackSide;

/// One contact with the axes of one grid, and the folder of its files.
#[derive(Debug, Clone)]
pub struct Site {
    /// Folder below the run's own; empty for the run's own.
    pub folder: String,
    /// The placed pair.
    pub contact: PlacedContact,
    /// The axes.
    pub grid: Grid,
    /// Normal force \[N\] of what the grid covers; `None` unless a load was asked for.
    pub normal_load: Option<f64>,
}

/// Finds the sites of a case, the first contact's first; a patch of several parts has a site for each.
///
/// # Errors
/// No contact; axes that cannot be sized; more contacts or parts than are listed.
pub fn sites(case: &Case) -> Result<Vec<Site>> {
    let contacts = find(case, case.question.approach)?;
    let grids = contacts.iter().map(|contact| grids(&case.axes, contact)).collect::<Result<Vec<_>>>()?;
    let mut sites: Vec<Site> = Vec::new();
    let one_grid = case.axes.xi.is_some() && case.axes.eta.is_some();
    for (contact, grids) in contacts.into_iter().zip(grids) {
        let shared = |k: &usize| grids.iter().filter(|grid| grid.groups.contains(k)).count() > 1;
        let shares: Vec<bool> = grids.iter().map(|grid| grid.groups.iter().any(shared)).collect();
        for (number, grid) in grids.into_iter().enumerate() {
            let folder = match (&contact.found, number) {
                _ if sites.is_empty() => String::new(),
                (Some(found), 0) => found.folder(),
                (Some(found), _) => format!("{}-patch-{}", found.folder(), number + 1),
                (None, _) => format!("patch-{}", number + 1),
            };
            let normal_load = match contact.normal_loads.as_slice() {
                [] => None,
                // Axes that the scene gives are one grid for all groups of parts.
                loads if one_grid => Some(loads.iter().sum()),
                // A part of the plane's patch may lie over two of the conformal one: nothing divides its load.
                _ if shares[number] => None,
                loads => {
                    let covered: Vec<f64> =
                        grid.groups.iter().filter_map(|&k| loads.get(k).copied()).collect();
                    (!covered.is_empty()).then(|| covered.iter().sum())
                }
            };
            sites.push(Site { folder, contact: contact.clone(), grid, normal_load });
        }
    }
    Ok(sites)
}

impl Site {
    /// Names the contact as messages call it: by side and number if it was found, by its part of the patch if it was
    /// chosen and has several grids.
    pub fn name(&self) -> String {
        match &self.contact.found {
            Some(found) => found.name(),
            None if self.folder.is_empty() => "contact".into(),
            None => format!("contact, {}", self.folder),
        }
    }

    /// Gives the side of a wheelset's contact; `None` of a single wheel's.
    pub fn side(&self) -> Option<TrackSide> {
        self.contact.found.as_ref()?.side
    }

    /// Gives δ \[mm\], 0 for a case without an approach.
    pub fn approach(&self) -> f64 {
        self.contact.approach.unwrap_or(0.0)
    }

    /// Gives the vertical part of the normal force \[N\]; `None` unless a load was asked for.
    pub fn vertical_load(&self) -> Option<f64> {
        self.normal_load.map(|load| load * self.contact.placement.upright())
    }

    /// Gives the rectangle between the outermost points of the grid.
    pub fn window(&self) -> Window {
        Window { xi: ends(&self.grid.xi), eta: ends(&self.grid.eta) }
    }

    /// Finds the patch in the window of the grid; `None` without an approach.
    pub fn patch(&self) -> Option<Patch> {
        self.contact.patch_in(&self.window())
    }

    /// Tells whether the bodies overlap before any approach. Only the first contact of a side can be infeasible: a further one is placed as
    /// touching, which makes the bodies overlap at the first.
    pub fn is_infeasible(&self) -> bool {
        let first = self.contact.found.as_ref().is_none_or(|found| found.contact == 1);
        first && !self.contact.feasibility.feasible
    }

    /// Lists why the contact is infeasible or its patch in the window empty.
    pub fn refusals(&self, patch: Option<&Patch>) -> Vec<String> {
        let mut out = Vec::new();
        let feasibility = &self.contact.feasibility;
        if self.is_infeasible() {
            out.push(format!(
                "infeasible contact: the bodies overlap by {:.6e} mm at xi = {:.6} mm, eta = {:.6} mm; expected s >= 0 \
                 everywhere (4.1); choose another pair of points",
                -feasibility.least_separation_mm, feasibility.at_xi_mm, feasibility.at_eta_mm
            ));
        }
        if patch.is_some_and(|patch| patch.components.is_empty()) {
            out.push(if self.has_extent() {
                "empty patch: s is nowhere below the approach in the window of the grid".into()
            } else {
                "empty patch: the grid is a single line".into()
            });
        }
        out
    }

    /// Tells whether the grid has more than one row and one column.
    pub fn has_extent(&self) -> bool {
        self.grid.xi.len() > 1 && self.grid.eta.len() > 1
    }
}

/// Gives the first and the last value.
pub(super) fn ends(values: &[f64]) -> Interval {
    match values {
        [first, .., last] => Interval::new(*first, *last),
        [only] => Interval::of(*only),
        [] => Interval::of(0.0),
    }
}

/// Tells which ends of an interval of η lie at those of the window.
pub(super) fn cut_by(window: Interval, eta: Interval) -> [bool; 2] {
    [eta.low <= window.low, eta.high >= window.high]
}

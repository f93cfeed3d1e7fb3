//! The grids of a case: its own axes, or automatic ones over every part of the patch.

use super::contact::PlacedContact;
use super::formats::Writer;
use super::input::{AskedAxes, Outputs};
use super::places::MOST_PARTS;
use crate::conformal::{RailArcLength, Reference};
use crate::error::{Error, Result};
use crate::mesh::{Axes, GridGroup, MOST_POINTS, groups};
use crate::numerics::interval::Interval;
use crate::patch::{Patch, Window};

/// The axes of one grid.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    /// ξ \[mm\], ascending.
    pub xi: Vec<f64>,
    /// η \[mm\], ascending.
    pub eta: Vec<f64>,
    /// What the user should know of automatic axes.
    pub warning: Option<String>,
    /// σ \[mm\], ascending, where gaps are given over the rail's surface; ξ are then those of its points.
    pub sigma: Option<Vec<f64>>,
    /// Indices of the groups of parts of the plane's patch that an automatic grid covers.
    pub groups: Vec<usize>,
}

impl Grid {
    fn points(&self) -> usize {
        self.xi.len() * self.eta.len()
    }
}

/// Gives the grids of one contact: the case's own axes, or one grid over every part of the patch, of the conformal one over the
/// rail's surface.
///
/// A contact that was found has one grid, over the part of the patch that holds it: the others are contacts of
/// their own.
///
/// # Errors
/// Automatic axes without a patch; a patch of more parts than are listed; cells that do not fit into memory.
pub(super) fn grids(asked: &AskedAxes, contact: &PlacedContact) -> Result<Vec<Grid>> {
    let AskedAxes { xi, eta, spacing, merge, reference } = asked;
    let rail = || RailArcLength::new(&contact.placement);
    if let (Some(xi), Some(eta)) = (xi, eta) {
        let grid = Grid { xi: xi.clone(), eta: eta.clone(), warning: None, sigma: None, groups: Vec::new() };
        return Ok(vec![if *reference == Reference::Rail { on_rail(grid, &rail())? } else { grid }]);
    }
    let patch = contact.whole_patch();
    // In another frame a found contact's patch has its own parts only.
    let whole = contact.found.is_some() && !contact.placement.is_at_contact();
    let merge = if whole { f64::INFINITY } else { *merge };
    let plane = patch.map_or_else(Vec::new, |patch| groups(patch, merge, *spacing));
    let mut groups = match (reference, contact.approach) {
        (Reference::Rail, Some(approach)) => {
            groups(&Patch::over_rail(&contact.placement, approach, &Window::UNBOUNDED), asked.merge, *spacing)
        }
        _ => plane.clone(),
    };
    if groups.is_empty() && contact.approach.is_none() {
        let expected = "an approach or a load, by which the grid is sized";
        let advice = "give [patch] approach = … (mm) or load = … (N), or axes in [grid]";
        return Err(Error::new("patch", "none", expected, advice));
    }
    if groups.is_empty() {
        let expected = "values, or a patch that the axes can be sized by";
        let advice = "give from, to and n, or a larger approach";
        return Err(Error::new("grid", "auto, and no patch", expected, advice));
    }
    if contact.found.is_some() {
        groups.truncate(1);
    }
    if groups.len() > MOST_PARTS {
        let (found, expected) =
            (format!("a patch of {} parts", groups.len()), format!("at most {MOST_PARTS}"));
        let advice = "smooth the profiles, give grid.merge, or from, to and n";
        return Err(Error::new("grid", found, expected, advice));
    }
    let grid = |(index, group): (usize, &GridGroup)| {
        let automatic = group.axes(*spacing)?;
        let warning = stretched(&automatic);
        let eta = eta.clone().unwrap_or(automatic.eta);
        if *reference == Reference::Plane {
            let xi = xi.clone().unwrap_or(automatic.xi);
            return Ok(Grid { xi, eta, warning, sigma: None, groups: vec![index] });
        }
        let rail = rail();
        let covered = covered(&rail, group, &plane);
        let xi = xi.clone().unwrap_or_else(|| within(automatic.xi, rail.reach()));
        on_rail(Grid { xi, eta, warning, sigma: None, groups: covered }, &rail)
    };
    groups.iter().enumerate().map(grid).collect()
}

/// Lists the groups of the plane's patch that a group over the rail's surface covers.
fn covered(rail: &RailArcLength<'_>, group: &GridGroup, plane: &[GridGroup]) -> Vec<usize> {
    let xi = group.extent.xi.map(|sigma| rail.point(sigma).map_or(f64::NAN, |at| at.xi));
    let under = Window { xi, eta: group.extent.eta };
    (0..plane.len()).filter(|&k| under.meets(&plane[k].extent)).collect()
}

/// Keeps the values of an automatic axis of σ \[mm\] that lie on the rail's surface; its margins may not.
fn within(sigma: Vec<f64>, reach: Option<Interval>) -> Vec<f64> {
    let inside = |sigma: &f64| reach.is_some_and(|reach| reach.contains(*sigma));
    sigma.into_iter().filter(inside).collect()
}

/// Takes the first axis of a grid as σ along the rail's surface.
///
/// # Errors
/// Values beyond the part of the rail that σ covers; a rail without a surface at C.
fn on_rail(grid: Grid, rail: &RailArcLength<'_>) -> Result<Grid> {
    let beyond = |found: String, Interval { low, high }: Interval| {
        let expected = format!("σ within [{low}, {high}] mm, where the rail's surface is single-valued");
        let advice =
            "it ends, overhangs or is covered by another part of the rail beyond: take a smaller range";
        Error::new("grid: xi", found, expected, advice)
    };
    let Some(reach) = rail.reach() else {
        return Err(beyond("no surface at C".into(), Interval::of(f64::NAN)));
    };
    let point =
        |&sigma: &f64| rail.point(sigma).map(|at| at.xi).ok_or_else(|| beyond(sigma.to_string(), reach));
    let xi = grid.xi.iter().map(point).collect::<Result<Vec<_>>>()?;
    Ok(Grid { xi, sigma: Some(grid.xi), ..grid })
}

fn stretched(axes: &Axes) -> Option<String> {
    let [xi, eta] = axes.spacing;
    axes.square_cells.map(|cells| {
        format!(
            "the patch is so long and thin that {cells:.0} square cells would cover it: the automatic grid's are \
             {xi:.3e} x {eta:.3e} mm (xi, eta); give grid.spacing for others"
        )
    })
}

/// Refuses grids for which the memory cannot be had, before any is filled: a failed allocation ends the process.
///
/// # Errors
/// More than 10⁸ points together; more than the system grants.
pub(super) fn check_memory<'a>(outputs: &Outputs, grids: impl Iterator<Item = &'a Grid>) -> Result<()> {
    /// Bytes of one value of s.
    const NUMBER: usize = 8;
    /// Bytes of the text of one value of s, which all decks share.
    const TEXT: usize = 25;
    /// Bytes up to which the system is not asked.
    const ALWAYS_THERE: usize = 100_000_000;
    let (all, largest) = grids.map(Grid::points).fold((0, 0), |(all, largest), n| (all + n, largest.max(n)));
    let bad = |found: String, expected: String| {
        Err(Error::new("grid", found, expected, "take a coarser grid, a smaller window or fewer formats"))
    };
    if all as f64 > MOST_POINTS {
        return bad(format!("{all} points"), format!("at most {MOST_POINTS:e} points"));
    }
    // All grids are kept, and written one after the other.
    let bytes = NUMBER * all + if outputs.wants(Writer::is_deck) { TEXT * largest } else { 0 };
    let mut memory = Vec::<u8>::new();
    if bytes > ALWAYS_THERE && std::hint::black_box(&mut memory).try_reserve_exact(bytes).is_err() {
        let found = format!("{all} points, which take {bytes} bytes of memory");
        return bad(found, "a grid for which the system grants the memory".into());
    }
    Ok(())
}

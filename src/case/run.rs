//! A case and everything computed from it.

use rayon::prelude::*;

use super::analysis::Analysis;
use super::conformal::turning_warning;
use super::doubts::Doubt;
use super::found::Found;
use super::grids::check_memory;
use super::input::{ApproachBy, Arrangement, Case};
use super::landmarks::SideLandmarks;
use super::places::follows;
use super::pressure::PartPressure;
use super::site::{Site, sites};
use super::site_doubts::{doubted, doubts_of, doubts_of_placing, other_lift};
use crate::error::{Result, in_order};
use crate::numerics::interval::Interval;
use crate::patch::Patch;
use crate::placement::{Creepages, Placement};
use crate::search::TrackSide;
use crate::separation::Plan;

/// Is told the step that a run is at, and the share of the run's work that is behind it (0 to 1), from several threads.
pub type Tell<'a> = &'a (dyn Fn(String, f64) + Sync);

/// Share of a run's work before its files are written, as a guess.
pub(super) const COMPUTING: f64 = 0.5;

/// Tells nobody.
pub const SILENT: Tell<'static> = &|_, _| {};

/// Share of an axle's load by which the loads of its wheels may differ without a word: more than forces err by.
const UNEQUAL: f64 = 0.01;

/// Difference \[mm\] of the heights of an axle's middle over its two rails that is none. A wheel carries some 1 kN more for each µm that it sinks:
/// with heights so near to each other the loads differ by far less than [`UNEQUAL`].
const ONE_HEIGHT: f64 = 1e-4;

/// A case and everything computed from it.
#[derive(Debug, Clone)]
pub struct Run {
    /// What was computed.
    pub case: Case,
    /// One part for every grid; the first contact's first.
    pub parts: Vec<Part>,
}

/// A site and the analysis of its grid.
#[derive(Debug, Clone)]
pub struct Part {
    /// Contact and axes.
    pub site: Site,
    /// Separation and patch.
    pub analysis: Analysis,
    /// What a user should know before using the files.
    pub warnings: Vec<String>,
}

impl Run {
    /// Computes a case.
    ///
    /// # Errors
    /// No contact; grids that cannot be sized or take more memory than there is; a method without a formula for the
    /// pair. An infeasible contact or an empty patch is a result: [`Run::refusals`].
    ///
    /// # Examples
    /// ```
    /// use wheelrail::case::{Run, SILENT};
    /// use wheelrail::scene::{self, Scene};
    ///
    /// let text = r#"
    /// rail.profile = "60E1"
    /// wheel = { profile = "S1002", radius = 460.0 }
    /// contact = { rail_x = 0.0, wheel_x = 0.0 }
    /// patch = { approach = 0.05 }
    /// "#;
    /// let scene: Scene = scene::parse(text, false)?;
    /// let run = Run::new(scene::resolve(&scene, ".".as_ref(), "example")?, SILENT)?;
    /// assert_eq!(run.parts.len(), 1);
    /// # Ok::<(), wheelrail::Error>(())
    /// ```
    pub fn new(case: Case, tell: Tell<'_>) -> Result<Self> {
        tell("contacts".into(), 0.0);
        let sites = sites(&case).map_err(|error| doubted(error, &case.doubts))?;
        let others: Vec<f64> = sites.iter().map(|site| other_lift(site, &sites, &case.landmarks)).collect();
        check_memory(&case.outputs, sites.iter().map(|site| &site.grid))?;
        let all = sites.len() as f64;
        let part = |(k, site): (usize, Site)| {
            let (Site { grid, .. }, done) = (&site, k as f64 / all);
            let step = format!("{}: grid of {} x {} points", site.name(), grid.xi.len(), grid.eta.len());
            tell(step, COMPUTING * done);
            let analysis = Analysis::new(&site, &case.question)?;
            let warnings = warnings_of(&site, &analysis, (&case.landmarks, others[k]));
            Ok(Part { site, analysis, warnings })
        };
        let parts = in_order(sites.into_par_iter().enumerate().map(part))?;
        Ok(Self { case, parts })
    }

    /// Puts all parts below a folder of many runs: the first as `name`, the others as `name-…`.
    #[must_use]
    pub fn filed_under(mut self, name: &str) -> Self {
        for Part { site, .. } in &mut self.parts {
            site.folder =
                if site.folder.is_empty() { name.to_string() } else { format!("{name}-{}", site.folder) };
        }
        self
    }

    /// Gives about how many bytes of files will be written: those that grow with the grids.
    pub fn expected_bytes(&self) -> f64 {
        let points = self.parts.iter().map(|part| part.site.grid.xi.len() * part.site.grid.eta.len());
        points.sum::<usize>() as f64 * self.case.outputs.bytes_a_point()
    }

    /// Lists why contacts are infeasible or patches empty, each with the name of its contact if there are several.
    pub fn refusals(&self) -> Vec<String> {
        let named = |part: &Part| {
            let name = if self.parts.len() > 1 { format!("{}: ", part.site.name()) } else { String::new() };
            part.refusals().into_iter().map(move |refusal| format!("{name}{refusal}"))
        };
        self.parts.iter().flat_map(named).collect()
    }

    /// Lists what a user should know before using the files.
    pub fn warnings(&self) -> Vec<String> {
        let mut out = self.case.warnings();
        let first = self.parts.first();
        let placing = first.into_iter().flat_map(|part| doubts_of_placing(&self.case, &part.site));
        out.extend(placing.map(|doubt| doubt.to_string()));
        out.extend(if follows(&self.case) { self.heights_warning() } else { self.shares_warning() });
        for part in &self.parts {
            let folder = &part.site.folder;
            let place = if folder.is_empty() { String::new() } else { format!("{folder}: ") };
            out.extend(part.warnings.iter().map(|warning| format!("{place}{warning}")));
        }
        out
    }

    /// Says that the wheels of an axle carry unequal parts of its load under a roll that does not follow the load. Returns `None` for other
    /// loads, and if the parts differ by less than forces err.
    fn shares_warning(&self) -> Option<String> {
        let Some(ApproachBy::AxleLoad(load)) = self.case.question.approach else { return None };
        let [left, right] = [TrackSide::Left, TrackSide::Right]
            .map(|side| self.sites_of(side).filter_map(Site::vertical_load).sum::<f64>());
        ((right - left).abs() > UNEQUAL * load).then(|| {
            let [left, right] = [left, right].map(|carried| carried / 1e3);
            format!(
                "the left wheel carries {left:.2} kN and the right one {right:.2} kN of the axle's load: the roll is the scene's; with \
                 roll = \"load\" the axle rolls until each carries half"
            )
        })
    }

    /// Says by how much the middle of the axle is higher over one rail than over the other under a roll that follows the loads. Returns
    /// `None` if both are one height.
    fn heights_warning(&self) -> Option<String> {
        let height = |side| {
            let site = self.sites_of(side).next()?;
            let upright = site.contact.placement.upright();
            Some(site.contact.found.as_ref()?.height_mm - site.approach() / upright)
        };
        let higher = height(TrackSide::Left)? - height(TrackSide::Right)?;
        (higher.abs() > ONE_HEIGHT).then(|| {
            let side = if higher > 0.0 { TrackSide::Left } else { TrackSide::Right };
            format!(
                "each wheel carries its load, but the middle of the axle is {:.4} mm higher over the {side} rail than over the other: the \
                 height jumps at this roll, where a place comes or goes within a region, and no roll gives both one height",
                higher.abs()
            )
        })
    }

    /// Returns the sites of a side, that which touches first before the others.
    fn sites_of(&self, side: TrackSide) -> impl Iterator<Item = &Site> {
        self.parts.iter().map(|part| &part.site).filter(move |site| site.side() == Some(side))
    }

    /// Finds the creepages of a part, in its contact frame and, on a left side, in the axes of its mirror image; `None` for
    /// a case without a motion.
    ///
    /// # Errors
    /// A wheel at rest where it touches.
    pub fn creepages(&self, part: &Part) -> Result<Option<Creepages>> {
        let Some(motion) = self.case.question.motion else { return Ok(None) };
        let left = part.site.side() == Some(TrackSide::Left);
        let half = match &self.case.setup.arrangement {
            Arrangement::Wheelset { system, .. } if left => system.left().wheelset().wheel_x(),
            Arrangement::Wheelset { system, .. } => system.right().wheelset().wheel_x(),
            Arrangement::Points { .. } | Arrangement::Wheel { .. } | Arrangement::OnSlices { .. } => 0.0,
        };
        let motion = if left { motion.mirrored() } else { motion };
        motion.creepages(&part.site.contact.placement, half, self.free_radius()?).map(Some)
    }

    /// Gives the rolling radius \[mm\] of a wheelset that rolls freely: the mean of those at which its sides touch first, whatever
    /// frame their contacts have.
    ///
    /// # Errors
    /// Chosen points at which the pair cannot be placed.
    fn free_radius(&self) -> Result<f64> {
        if let Arrangement::Points { rail_x, wheel_x } = &self.case.setup.arrangement {
            let pair = &self.case.profiles.right.pair;
            return Ok(pair.placed(*rail_x, *wheel_x, 0.0)?.rolling_radius());
        }
        let mut sides: Vec<&Found> = Vec::new();
        for found in self.parts.iter().filter_map(|part| part.site.contact.found.as_ref()) {
            // A patch of several parts has a site for each.
            if found.contact == 1 && sides.iter().all(|known| known.side != found.side) {
                sides.push(found);
            }
        }
        Ok(sides.iter().map(|found| found.place.rolling_radius_mm).sum::<f64>() / sides.len() as f64)
    }
}

impl Part {
    /// Gives the largest pressure of Hertz's ellipse \[N/mm²\]; `None` without an ellipse, and where pressures were solved.
    pub fn hertz_pressure(&self) -> Option<f64> {
        let contact = &self.site.contact;
        let unsolved = !contact.is_loaded() && self.analysis.pressure.is_none();
        contact
            .ellipse
            .filter(|_| unsolved && contact.open_end().is_none())
            .map(|ellipse| ellipse.pressure_n_per_mm2)
    }

    /// Lists why the contact of the part is infeasible or its patch empty.
    pub fn refusals(&self) -> Vec<String> {
        self.site.refusals(self.analysis.patch.as_ref())
    }
}

/// Distance along the track \[mm\] within which a patch counts as reaching a slice: a point of it lies some tenths of a millimetre above or
/// below the tangent plane, which pitches by a tenth at most.
const AT_SLICE: f64 = 0.1;

/// Gives the end of the slices \[mm\] that a patch on a rail that varies along the track reaches: there is no surface beyond.
pub(super) fn end_reached(placement: &Placement, patch: &Patch) -> Option<f64> {
    let lofted = placement.lofted_rail()?;
    let (loft, along) = (lofted.loft(), patch.extent()?.eta.map(|eta| lofted.along_at(0.0, eta)));
    // As far as there is a surface from C.
    let slices = loft.holes.iter().fold(loft.reach(), |reach, hole| {
        let Interval { low, high } = reach;
        if hole.high <= lofted.along() {
            Interval::new(hole.high, high)
        } else {
            Interval::new(low, high.min(hole.low))
        }
    });
    match () {
        () if along.low <= slices.low + AT_SLICE => Some(slices.low),
        () if along.high >= slices.high - AT_SLICE => Some(slices.high),
        () => None,
    }
}

/// Says that a patch reaches the first or the last slice.
fn slices_warning(site: &Site, patch: &Patch) -> Option<String> {
    let end = end_reached(&site.contact.placement, patch)?;
    Some(format!(
        "the patch reaches the end of the slices at {end} mm: it is cut off there, and pressures are too large; list more slices"
    ))
}

/// Lists what a user should know before using the files of a part; `other` is the lift of the other wheel \[mm\].
fn warnings_of(site: &Site, analysis: &Analysis, (landmarks, other): (&SideLandmarks, f64)) -> Vec<String> {
    let mut out = Vec::from_iter(site.grid.warning.clone());
    if analysis.patch.as_ref().is_some_and(Patch::cut_by_window) {
        out.push("the window of the grid cuts the patch: solvers would overestimate the pressure".into());
    }
    let Analysis { patch, conformal, .. } = analysis;
    out.extend(patch.as_ref().and_then(|patch| slices_warning(site, patch)));
    out.extend(turning_warning(site, patch.as_ref(), conformal.as_ref()));
    let Plan { choice, error, tolerance, .. } = &analysis.plan;
    if error.is_nan() {
        let name = choice.method.name();
        out.push(format!(
            "the method {name} has no number at some points of both bodies: take \"auto\" as grid.method"
        ));
    } else if error > tolerance {
        out.push(format!(
            "the separation's estimated error, {error:.1e} mm, is above grid.tolerance, {tolerance:e} mm"
        ));
    }
    out.extend(analysis.pressure.iter().flat_map(PartPressure::warnings));
    out.extend(doubts_of(site, landmarks, other).iter().map(Doubt::to_string));
    out
}

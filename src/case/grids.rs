//! The grids of a case: its own axes, or automatic ones over every part of the patch.

use super::input::{AskedAxes, OutputFormat, Outputs};
use super::places::{MOST_PARTS, Placed};
use crate::conformal::{RailArcLength, Reference};
use crate::error::{Error, Result};
use crate::mesh::{Axes, GridGroup, MOST_POINTS, groups};
use crate::placement::Placement;

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
}

impl Grid {
    fn points(&self) -> usize {
        self.xi.len() * self.eta.len()
    }
}

/// Gives the grids of one contact: the case's own axes, or one grid over every part of the patch.
///
/// A contact that was found has one grid, over the part of the patch that holds it: the others are contacts of
/// their own.
///
/// # Errors
/// Automatic axes without a patch; a patch of more parts than anybody looks through; cells that do not fit into memory.
pub(super) fn grids(asked: &AskedAxes, place: &Placed) -> Result<Vec<Grid>> {
    let AskedAxes { xi, eta, spacing, merge, reference } = asked;
    let unrolled = |grid: Grid| match reference {
        Reference::Plane => Ok(grid),
        Reference::Rail => on_rail(grid, &place.contact.placement, xi.is_some()),
    };
    if let (Some(xi), Some(eta)) = (xi, eta) {
        let grid = Grid { xi: xi.clone(), eta: eta.clone(), warning: None, sigma: None };
        return Ok(vec![unrolled(grid)?]);
    }
    let patch = place.contact.whole_patch();
    let mut groups = patch.map_or_else(Vec::new, |patch| groups(patch, *merge, *spacing));
    if groups.is_empty() && place.contact.approach.is_none() {
        let expected = "an approach or a load, by which the grid is sized";
        let advice = "give [patch] approach = … (mm) or load = … (N), or axes in [grid]";
        return Err(Error::new("patch", "none", expected, advice));
    }
    if groups.is_empty() {
        let expected = "values, or a patch that the axes can be sized by";
        let advice = "give from, to and n, or a larger approach";
        return Err(Error::new("grid", "auto, and no patch", expected, advice));
    }
    if place.found.is_some() {
        groups.truncate(1);
    }
    if groups.len() > MOST_PARTS {
        let (found, expected) =
            (format!("a patch of {} parts", groups.len()), format!("at most {MOST_PARTS}"));
        let advice = "smooth the profiles, give grid.merge, or from, to and n";
        return Err(Error::new("grid", found, expected, advice));
    }
    let grid = |group: &GridGroup| {
        let automatic = group.axes(*spacing)?;
        let warning = stretched(&automatic);
        let (xi, eta) = (xi.clone().unwrap_or(automatic.xi), eta.clone().unwrap_or(automatic.eta));
        unrolled(Grid { xi, eta, warning, sigma: None })
    };
    groups.iter().map(grid).collect()
}

/// Lays the first axis of a grid along the rail's surface. Given values are σ already; an automatic axis is laid anew with its
/// own step over the arc between its ends, as far as the surface reaches.
///
/// # Errors
/// Values beyond the part of the rail that σ covers; a rail without a surface at C.
fn on_rail(grid: Grid, placement: &Placement, given: bool) -> Result<Grid> {
    let rail = RailArcLength::new(placement);
    let beyond = |found: String, [low, high]: [f64; 2]| {
        let expected = format!("σ within [{low}, {high}] mm, where the rail's surface is single-valued");
        let advice =
            "it ends, overhangs or is covered by another part of the rail beyond: take a smaller range";
        Error::new("grid: xi", found, expected, advice)
    };
    let Some(reach) = rail.reach() else { return Err(beyond("no surface at C".into(), [f64::NAN; 2])) };
    let sigma = if given { grid.xi } else { arc_axis(&rail, reach, &grid.xi) };
    let point =
        |&sigma: &f64| rail.point(sigma).map(|at| at.xi).ok_or_else(|| beyond(sigma.to_string(), reach));
    let xi = sigma.iter().map(point).collect::<Result<Vec<_>>>()?;
    Ok(Grid { xi, sigma: Some(sigma), ..grid })
}

/// Lays an axis of equal steps along the rail over the same part as an axis of ξ, on the lattice about C.
fn arc_axis(rail: &RailArcLength<'_>, reach: [f64; 2], xi: &[f64]) -> Vec<f64> {
    let (Some(&first), Some(&last)) = (xi.first(), xi.last()) else { return Vec::new() };
    let step = (last - first) / (xi.len().max(2) - 1) as f64;
    let end = |xi: f64, end: f64| Some(rail.sigma(xi)).filter(|sigma| !sigma.is_nan()).unwrap_or(end);
    let from = (end(first, reach[0]) / step).ceil() as i64;
    let to = (end(last, reach[1]) / step).floor() as i64;
    (from..=to).map(|k| k as f64 * step).collect()
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
    /// Bytes of its text, which the decks share.
    const TEXT: usize = 25;
    /// Below this the system is not asked.
    const ALWAYS_THERE: usize = 100_000_000;
    let (all, largest) = grids.map(Grid::points).fold((0, 0), |(all, largest), n| (all + n, largest.max(n)));
    let bad = |found: String, expected: String| {
        Err(Error::new("grid", found, expected, "take a coarser grid, a smaller window or fewer formats"))
    };
    if all as f64 > MOST_POINTS {
        return bad(format!("{all} points"), format!("at most {MOST_POINTS:e} points"));
    }
    // All grids are kept, and written one after the other.
    let bytes = NUMBER * all + if outputs.any(&OutputFormat::DECKS) { TEXT * largest } else { 0 };
    let mut memory = Vec::<u8>::new();
    if bytes > ALWAYS_THERE && std::hint::black_box(&mut memory).try_reserve_exact(bytes).is_err() {
        let found = format!("{all} points, which take {bytes} bytes of memory");
        return bad(found, "a grid for which the system grants the memory".into());
    }
    Ok(())
}

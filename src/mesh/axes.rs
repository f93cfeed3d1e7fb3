//! The rectangular solver grid: cell centres over the potential contact area, sized from the interpenetration box.

use crate::error::{Error, Result};
use crate::interpenetration::{Patch, Window};
use crate::placement::Placement;

/// Cells over the short side of the box when no spacing is given: peak pressures are then good to 0.02 %.
const CELLS_ACROSS: f64 = 16.0;

/// Empty cells on each side of the box, which boundary-element solvers want.
const MARGIN_CELLS: f64 = 2.0;

/// Cells beyond which a grid does not fit into memory.
const MOST_CELLS: f64 = 1.2e8;

/// Widest |η| that is looked at, as a share of the rolling radius: the ring is closed well beyond.
const WIDEST: f64 = 0.5;

/// The axes of one grid of cell centres.
#[derive(Debug, Clone, PartialEq)]
pub struct Axes {
    /// ξ of the cell centres \[mm\], ascending, equal steps.
    pub xi: Vec<f64>,
    /// η of the cell centres \[mm\], ascending, equal steps; symmetric to the last bit without skew.
    pub eta: Vec<f64>,
}

/// Boxes of the patch over the whole overlap of the two profiles, one for every component or group of components
/// closer in ξ than `merge` \[mm\]; the group that holds C first, else the deepest first.
pub fn boxes(placement: &Placement, approach: f64, merge: f64) -> Vec<Window> {
    let Some(xi) = placement.overlap() else { return Vec::new() };
    let widest = WIDEST * placement.rolling_radius();
    let patch = Patch::new(placement, approach, &Window { xi, eta: [-widest, widest] });
    let mut groups: Vec<(Window, f64)> = Vec::new();
    for component in &patch.components {
        let depth = component.deepest[0];
        match groups.last_mut() {
            Some((window, least)) if component.xi[0] - window.xi[1] < merge => {
                window.xi[1] = component.xi[1];
                window.eta = [window.eta[0].min(component.eta[0]), window.eta[1].max(component.eta[1])];
                *least = least.min(depth);
            }
            _ => groups.push((Window { xi: component.xi, eta: component.eta }, depth)),
        }
    }
    let away = |window: &Window| !(window.xi[0] <= 0.0 && window.xi[1] >= 0.0);
    groups.sort_by(|(a, p), (b, q)| away(a).cmp(&away(b)).then(p.total_cmp(q)));
    groups.into_iter().map(|(window, _)| window).collect()
}

/// Cell centres over a box with a margin; `spacing` = \[Δξ, Δη\] \[mm\], by default square cells, 16 across.
///
/// # Errors
/// A spacing for which the grid would not fit into memory.
pub fn over(window: &Window, spacing: Option<[f64; 2]>) -> Result<Axes> {
    let sides = [window.xi, window.eta].map(|[a, b]| b - a);
    let short = sides[0].min(sides[1]) / CELLS_ACROSS;
    let steps = spacing.unwrap_or([short; 2]);
    let cells = [0, 1].map(|k| (sides[k] / steps[k]).ceil() + 2.0 * MARGIN_CELLS);
    if !(cells[0] * cells[1] <= MOST_CELLS) {
        let found = format!("{:e} cells over the patch", cells[0] * cells[1]);
        return Err(Error::new(
            "grid: spacing",
            found,
            format!("at most {MOST_CELLS:e}"),
            "take a larger step",
        ));
    }
    let centres = |[a, b]: [f64; 2], step: f64, n: f64| {
        let middle = a + (b - a) / 2.0;
        (0..n as usize).map(|k| middle + (k as f64 - (n - 1.0) / 2.0) * step).collect()
    };
    Ok(Axes { xi: centres(window.xi, steps[0], cells[0]), eta: centres(window.eta, steps[1], cells[1]) })
}

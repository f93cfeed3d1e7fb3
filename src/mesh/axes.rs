//! The rectangular solver grid: cell centres over the potential contact area, whose size follows from the box around the
//! patch.
//!
//! Centres lie on the lattice (i Δξ, j Δη) about C. C itself is therefore a centre, the η axis is symmetric to the last bit
//! over a symmetric patch, and grids of one spacing for several parts or approaches share their centres.

use crate::error::{Error, ErrorKind, Result, finite};
use crate::numerics::interval::Interval;
use crate::patch::{Component, Patch, Window};

/// Cells over the short side of the box if no spacing is given. The peak pressures of both solvers are then within 0.5 %.
const CELLS_ACROSS: f64 = 16.0;

/// Empty rows and columns on each side of the box. Boundary-element solvers need them.
const MARGIN_CELLS: f64 = 2.0;

/// Steps up to which the cells of a grid reach beyond the box around its patch: its margin, half a cell, and what the lattice adds.
#[cfg(feature = "files")]
pub(crate) const CELLS_REACHED: f64 = MARGIN_CELLS + 1.5;

/// Most cells of a grid without a given spacing: five times what CONTACT takes, 50 MB of files. With square cells the patch
/// would be some 300 times as long as wide.
const MOST_UNASKED: f64 = 1e5;

/// Most points of all grids of a run together: 3.3 GB of memory with the text decks, 50 GB of files with all formats.
pub const MOST_POINTS: f64 = 1e8;

/// Most values of one axis. Several writers hold a column as text at once, which takes 100 MB.
pub const MOST_ON_AXIS: f64 = 1e6;

/// The axes of one grid of cell centres.
#[derive(Debug, Clone, PartialEq)]
pub struct Axes {
    /// ξ of the cell centres \[mm\], ascending, equal steps.
    pub xi: Vec<f64>,
    /// η of the cell centres \[mm\], ascending, equal steps; symmetric to the last bit without skew.
    pub eta: Vec<f64>,
    /// \[Δξ, Δη\] \[mm\].
    pub spacing: [f64; 2],
    /// Number of square cells that the grid would have; `None` if its cells were not stretched to save cells.
    pub square_cells: Option<f64>,
}

impl Axes {
    /// Returns the rectangle that the cells cover: half a step beyond the outermost centres.
    pub fn window(&self) -> Window {
        let edges = |values: &[f64], step: f64| match values {
            [first, .., last] => Interval::new(*first, *last).grown(step / 2.0),
            _ => Interval::of(f64::NAN),
        };
        Window { xi: edges(&self.xi, self.spacing[0]), eta: edges(&self.eta, self.spacing[1]) }
    }
}

/// Returns n ≥ 2 values from a to b in equal steps, both ends included; symmetric to the last bit if a = −b.
pub fn equal_steps(a: f64, b: f64, n: usize) -> Vec<f64> {
    let last = n as f64 - 1.0;
    (0..n).map(|k| (a * (last - k as f64) + b * k as f64) / last).collect()
}

/// Components of a patch that share a grid; for a conformal patch σ stands in the place of ξ.
#[derive(Debug, Clone, PartialEq)]
pub struct GridGroup {
    /// Indices of the components in the patch, ascending.
    pub components: Vec<usize>,
    /// The box around the components \[mm\].
    pub extent: Window,
    /// Smallest s, or t − δ cos α, on the components \[mm\].
    pub least: f64,
    /// The shorter side of the box around the largest component \[mm\].
    pub short_side: f64,
}

/// Divides the components of a patch into groups; the patch must be that over the whole plane. Components closer to each
/// other than `merge` \[mm\] share a group. If `merge` is 0 or NaN, each component has a group of its own, unless the grid
/// of one would cut another one; `spacing` is that of [`GridGroup::axes`]. The group that holds C comes first, the others
/// follow by their depth. An empty patch has no group.
///
/// # Examples
/// ```
/// # use wheelrail::{Arc, Half, Pair, Profile, Segment};
/// use wheelrail::{Patch, Window, mesh::groups};
/// # let rail = Arc::about([0.0, -300.0], 300.0, Half::Upper, [-35.0, 35.0])?;
/// # let rail = Profile::new("crown", "", vec![Segment::arc(rail)])?;
/// # let wheel = Profile::new("cylinder", "", vec![Segment::arc(Arc::line([-60.0, 0.0], [60.0, 0.0])?)])?;
/// # let pair = Pair::new(rail, wheel, 460.0)?;
/// let placement = pair.placed(0.0, 0.0, 0.0)?; // a crown of 300 mm below a cylinder of 460 mm
/// let patch = Patch::new(&placement, 0.05, &Window::UNBOUNDED);
/// let axes = groups(&patch, 0.0, None)[0].axes(Some([0.5, 0.5]))?;
/// assert!(axes.xi.contains(&0.0) && axes.xi[0] < patch.components[0].xi.low);
/// # Ok::<(), wheelrail::Error>(())
/// ```
pub fn groups(patch: &Patch, merge: f64, spacing: Option<[f64; 2]>) -> Vec<GridGroup> {
    let part = |component: &Component| GridPart {
        extent: Window { xi: component.xi, eta: component.eta },
        least: component.deepest[0],
    };
    grouped(&patch.components.iter().map(part).collect::<Vec<_>>(), merge, spacing)
}

/// The data of a component by which it is put into a group.
#[derive(Debug, Clone, Copy)]
struct GridPart {
    /// The box around the component \[mm\].
    extent: Window,
    /// Smallest s on the component \[mm\].
    least: f64,
}

fn grouped(parts: &[GridPart], merge: f64, spacing: Option<[f64; 2]>) -> Vec<GridGroup> {
    let mut groups: Vec<GridGroup> = Vec::new();
    for (index, part) in parts.iter().enumerate() {
        let mut group = GridGroup::of(index, part);
        // A new part may link groups that were apart: all groups near it are joined.
        let belongs = |group: &GridGroup, other: &GridGroup| {
            let apart = distance(&group.extent, &other.extent);
            apart < merge || group.cuts(other, spacing) || other.cuts(group, spacing)
        };
        while let Some(near) = groups.iter().position(|other| belongs(&group, other)) {
            group = groups.swap_remove(near).joined(group, parts);
        }
        groups.push(group);
    }
    let away = |group: &GridGroup| !group.components.iter().any(|&k| holds_contact(&parts[k].extent));
    groups.sort_by(|a, b| away(a).cmp(&away(b)).then(a.least.total_cmp(&b.least)));
    groups
}

impl GridGroup {
    /// Makes the grid of cell centres over the group, with a margin of two cells on each side. `spacing` is \[Δξ, Δη\]
    /// \[mm\]. If it is not given, cells are square, 16 over the short side of the largest component; they are stretched
    /// along the group's longer side if there would be more than 10⁵. If the end of a profile cuts the group, cells beyond
    /// that end have no separation.
    ///
    /// # Errors
    /// A spacing that is not positive; a grid of more than 10⁸ points, or 10⁶ on an axis.
    pub fn axes(&self, spacing: Option<[f64; 2]>) -> Result<Axes> {
        match spacing {
            Some(spacing) => lattice(&self.extent, spacing),
            None => unasked(&self.extent, self.short_side / CELLS_ACROSS),
        }
    }

    /// Gives the longest step of the group's grid \[mm\], unless its cells are stretched.
    #[cfg(feature = "files")]
    pub(crate) fn step(&self, spacing: Option<[f64; 2]>) -> f64 {
        spacing.map_or(self.short_side / CELLS_ACROSS, |[xi, eta]| xi.max(eta))
    }

    /// Returns whether the grid over this group reaches into another group. Part of its margin would then lie in that group's
    /// patch.
    fn cuts(&self, other: &Self, spacing: Option<[f64; 2]>) -> bool {
        self.axes(spacing).is_ok_and(|axes| distance(&axes.window(), &other.extent) <= 0.0)
    }

    fn of(index: usize, part: &GridPart) -> Self {
        let [short_side, _] = sides(&part.extent);
        Self { components: vec![index], extent: part.extent, least: part.least, short_side }
    }

    fn joined(mut self, other: Self, parts: &[GridPart]) -> Self {
        self.components.extend(other.components);
        self.components.sort_unstable();
        let boxes = self.components.iter().map(|&k| sides(&parts[k].extent));
        let largest = boxes.max_by(|a, b| (a[0] * a[1]).total_cmp(&(b[0] * b[1])));
        Self {
            extent: self.extent.hull(other.extent),
            least: self.least.min(other.least),
            short_side: largest.map_or(self.short_side, |[short, _]| short),
            components: self.components,
        }
    }
}

fn holds_contact(extent: &Window) -> bool {
    extent.contains(0.0, 0.0)
}

/// Returns the shorter and the longer side of a component's box \[mm\].
fn sides(extent: &Window) -> [f64; 2] {
    let [along, across] = [extent.xi, extent.eta].map(Interval::width);
    [along.min(across), along.max(across)]
}

/// Returns the distance of two boxes \[mm\]; 0 if they meet.
fn distance(a: &Window, b: &Window) -> f64 {
    a.xi.distance(b.xi).hypot(a.eta.distance(b.eta))
}

/// Makes the grid of square cells of this size. If they are too many, they are stretched: first along the longer side,
/// until both sides have the same number of cells.
fn unasked(window: &Window, step: f64) -> Result<Axes> {
    // The lattice has margins, and one more cell at each end that the window cuts.
    let more = 2.0 * MARGIN_CELLS + 2.0;
    let sides = [window.xi, window.eta].map(Interval::width);
    let counts = sides.map(|side| side / step + more);
    let square_cells = counts[0] * counts[1];
    if square_cells <= MOST_UNASKED {
        return lattice(window, [step; 2]);
    }
    let across = counts[0].min(counts[1]).min(MOST_UNASKED.sqrt());
    let stretched = [0, 1].map(|k| {
        let most = if counts[k] > counts[1 - k] { MOST_UNASKED / across } else { across };
        if counts[k] <= most { step } else { sides[k] / (most - more) }
    });
    Ok(Axes { square_cells: Some(square_cells), ..lattice(window, stretched)? })
}

fn lattice(window: &Window, spacing: [f64; 2]) -> Result<Axes> {
    for step in spacing {
        if finite("grid: spacing", step)? <= 0.0 {
            let advice = "give a step, or let the patch decide";
            return Err(Error::new("grid: spacing", step.to_string(), "a positive length in mm", advice));
        }
    }
    // Cell i covers [(i − ½) Δ, (i + ½) Δ].
    let range = |side: Interval, step: f64| {
        Interval::new((side.low / step + 0.5).floor(), (side.high / step - 0.5).ceil()).grown(MARGIN_CELLS)
    };
    let (xi, eta) = (range(window.xi, spacing[0]), range(window.eta, spacing[1]));
    let [along, across] = [xi, eta].map(|cells| cells.width() + 1.0);
    let fits = along <= MOST_ON_AXIS && across <= MOST_ON_AXIS && along * across <= MOST_POINTS;
    if !fits {
        let found = format!("{along:e} x {across:e} cells over the patch");
        let expected = format!("at most {MOST_POINTS:e}, and {MOST_ON_AXIS:e} on an axis");
        return Err(
            Error::new("grid: spacing", found, expected, "take a larger step").of_kind(ErrorKind::Limit)
        );
    }
    let centres = |cells: Interval, step: f64| {
        (cells.low as i64..=cells.high as i64).map(|i| i as f64 * step).collect::<Vec<f64>>()
    };
    let [xi, eta] = [centres(xi, spacing[0]), centres(eta, spacing[1])];
    Ok(Axes { xi, eta, spacing, square_cells: None })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lattice_covers_the_box_with_its_margin_and_no_more() -> Result<()> {
        for [a, b] in [[-1.0, 1.0], [-0.3, 0.7], [5.0, 9.1], [-7.2, -3.0]] {
            for step in [0.1, 0.07, 0.5] {
                let axes = lattice(
                    &Window { xi: Interval::new(a, b), eta: Interval::symmetric(2.0) },
                    [step, 0.25],
                )?;
                let n = axes.xi.len();
                let edges = |k: usize| [axes.xi[k] - step / 2.0, axes.xi[k] + step / 2.0];
                assert!(edges(1)[1] <= a + 1e-12 && edges(2)[1] >= a - 1e-12, "[{a}, {b}] {step}");
                assert!(edges(n - 2)[0] >= b - 1e-12 && edges(n - 3)[0] <= b + 1e-12, "[{a}, {b}] {step}");
                assert!(axes.eta.iter().zip(axes.eta.iter().rev()).all(|(p, q)| *p == -*q));
                assert!(axes.eta.contains(&0.0));
            }
        }
        Ok(())
    }

    #[test]
    fn cells_that_nobody_sized_are_stretched_and_never_too_many() -> Result<()> {
        for (sides, step) in
            [([60.0, 1e-9], 1e-10), ([1e-3, 50.0], 1e-5), ([60.0, 50.0], 1e-7), ([1.0, 250.0], 0.0625)]
        {
            let [xi, eta] = sides.map(|side: f64| Interval::symmetric(side / 2.0));
            let axes = unasked(&Window { xi, eta }, step)?;
            let cells = (axes.xi.len() * axes.eta.len()) as f64;
            assert!(cells <= MOST_UNASKED && cells > 0.8 * MOST_UNASKED, "{sides:?}: {cells}");
            assert_eq!(axes.square_cells.is_some(), axes.spacing != [step; 2], "{sides:?}");
            // Thin boxes keep their cells across.
            assert!(
                sides[0].min(sides[1]) > 10.0 || axes.spacing.contains(&step),
                "{sides:?}: {:?}",
                axes.spacing
            );
        }
        Ok(())
    }

    #[test]
    fn bad_steps_and_too_many_cells_are_refused() {
        let window = Window { xi: Interval::symmetric(1.0), eta: Interval::symmetric(1.0) };
        for spacing in [[0.0, 1.0], [1.0, f64::NAN], [-1.0, 1.0], [1e-5, 1e-5], [1e-300, 1.0]] {
            assert!(lattice(&window, spacing).is_err(), "{spacing:?}");
        }
        assert!(lattice(&Window::UNBOUNDED, [1.0; 2]).is_err());
    }
}

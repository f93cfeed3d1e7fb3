//! Equal cells over a region of contact.

use crate::error::{Error, Result};
use crate::numerics::interval::Interval;
use crate::patch::Window;
use crate::placement::Placement;
use crate::separation::Evaluator;

/// Most cells of one half-space: their products take a second.
const MOST_CELLS: usize = 1 << 22;

/// Equal rectangular cells in the tangent plane at C.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cells {
    /// Lower corner of the first cell along ξ and η \[mm\].
    pub from: [f64; 2],
    /// Sides of a cell along ξ and η \[mm\], > 0.
    pub step: [f64; 2],
    /// Cells along ξ and η.
    pub count: [usize; 2],
}

impl Cells {
    /// Divides a bounded window into cells.
    ///
    /// # Errors
    /// A window without extent; no cells, or more than four million.
    pub fn over(window: &Window, count: [usize; 2]) -> Result<Self> {
        let ranges = [window.xi, window.eta];
        let from = ranges.map(|range| range.low);
        let step = [0, 1].map(|k| ranges[k].width() / count[k] as f64);
        let cells = count[0].checked_mul(count[1]).filter(|cells| (1..=MOST_CELLS).contains(cells));
        if cells.is_none() || !step.iter().all(|step| step.is_finite() && *step > 0.0) {
            let found = format!("{} × {} cells over {:?} mm", count[0], count[1], ranges.map(Interval::ends));
            let expected = format!("at most {MOST_CELLS} cells over a bounded window");
            return Err(Error::new("pressure", found, expected, "give other cells, or a larger approach"));
        }
        Ok(Self { from, step, count })
    }

    /// Gives the middles of the cells along ξ (0) or η (1) \[mm\].
    pub fn middles(&self, axis: usize) -> Vec<f64> {
        (0..self.count[axis]).map(|i| self.middle(axis, i as f64)).collect()
    }

    /// Gives a place along an axis \[mm\], counted in cells from the first one's middle.
    pub(super) fn middle(&self, axis: usize, cells: f64) -> f64 {
        self.from[axis] + (cells + 0.5) * self.step[axis]
    }

    /// Tells whether a point lies over the cells.
    pub fn hold(&self, point: [f64; 2]) -> bool {
        [0, 1].iter().all(|&k| {
            let along = point[k] - self.from[k];
            (0.0..=self.count[k] as f64 * self.step[k]).contains(&along)
        })
    }

    /// Gives the area of a cell \[mm²\].
    pub fn area(&self) -> f64 {
        self.step[0] * self.step[1]
    }

    /// Computes s \[mm\] at the middle of every cell, at i_ξ · n_η + i_η; NaN where a body has no surface.
    pub fn separations(&self, placement: &Placement) -> Vec<f64> {
        let (mut evaluator, eta) = (Evaluator::new(placement), self.middles(1));
        let mut gap = vec![0.0; self.count[0] * eta.len()];
        for (column, xi) in gap.chunks_exact_mut(eta.len()).zip(self.middles(0)) {
            evaluator.column(xi, &eta, column);
        }
        gap
    }

    /// Gives every second cell with twice the sides, about the same middles.
    pub(super) fn coarser(&self) -> Self {
        let from = [0, 1].map(|k| self.from[k] - 0.5 * self.step[k]);
        Self { from, step: self.step.map(|step| 2.0 * step), count: self.count.map(|n| n.div_ceil(2)) }
    }

    /// Gives cells over the same area whose sides are half as long along some axes.
    ///
    /// # Errors
    /// More than four million.
    pub(super) fn halved(&self, axes: [bool; 2]) -> Result<Self> {
        let side = |k: usize| Interval::new(self.from[k], self.from[k] + self.step[k] * self.count[k] as f64);
        let count = [0, 1].map(|k| self.count[k].saturating_mul(if axes[k] { 2 } else { 1 }));
        Self::over(&Window { xi: side(0), eta: side(1) }, count)
    }

    /// Gives the values of all cells, linearly between the middles of `known` ones over the same area.
    pub(super) fn between(&self, known: &Self, values: &[f64]) -> Vec<f64> {
        let near = |axis: usize, k: usize| {
            let last = known.count[axis] - 1;
            let at = (k as f64 + 0.5) * known.count[axis] as f64 / self.count[axis] as f64 - 0.5;
            let at = at.clamp(0.0, last as f64);
            (at as usize, (at as usize + 1).min(last), at.fract())
        };
        let row: Vec<_> = (0..self.count[1]).map(|j| near(1, j)).collect();
        let column = |i: usize| {
            let (i0, i1, u) = near(0, i);
            let at = |i: usize, j: usize| values[i * known.count[1] + j];
            let along =
                move |i: usize, (j0, j1, v): (usize, usize, f64)| (1.0 - v) * at(i, j0) + v * at(i, j1);
            let value = |j: &(usize, usize, f64)| (1.0 - u) * along(i0, *j) + u * along(i1, *j);
            row.iter().map(value).collect::<Vec<_>>()
        };
        (0..self.count[0]).flat_map(column).collect()
    }

    /// Keeps every second value along both axes.
    pub(super) fn thinned(&self, values: &[f64]) -> Vec<f64> {
        let columns = values.chunks_exact(self.count[1]).step_by(2);
        columns.flat_map(|column| column.iter().step_by(2).copied()).collect()
    }

    /// Gives the values of all cells from those of every second one: means between two, the last one beyond.
    pub(super) fn filled(&self, every_second: &[f64]) -> Vec<f64> {
        let [columns, rows] = self.count;
        let (wide, high) = (columns.div_ceil(2), rows.div_ceil(2));
        let near = |k: usize, count: usize| [k / 2, k.div_ceil(2).min(count - 1)];
        let value = |i: usize, j: usize| {
            let [[i0, i1], [j0, j1]] = [near(i, wide), near(j, high)];
            let at = |i: usize, j: usize| every_second[i * high + j];
            0.25 * (at(i0, j0) + at(i0, j1) + at(i1, j0) + at(i1, j1))
        };
        (0..columns).flat_map(|i| (0..rows).map(move |j| [i, j])).map(|[i, j]| value(i, j)).collect()
    }
}

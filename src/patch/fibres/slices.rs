//! The slices of a line, and lines laid between others until their slices answer one to one.

use crate::numerics::interval::Interval;
use crate::patch::lines::line::{Crossing, CrossingKind};

/// Most lines.
const MOST_LINES: usize = 20_000;

/// A slice of the patch on a line.
#[derive(Debug, Clone, Copy)]
pub(in crate::patch) struct LineSlice {
    /// \[mm\]
    pub(in crate::patch) eta: Interval,
    /// What lies at either end.
    pub(in crate::patch) kinds: [CrossingKind; 2],
    /// η of the least s in it and that s \[mm\]; NaN on proved lines.
    pub(in crate::patch) lowest: [f64; 2],
}

/// A line of constant ξ or σ with its slices, by ascending η.
#[derive(Debug, Clone)]
pub(in crate::patch) struct SlicedLine {
    /// \[mm\]
    pub(in crate::patch) xi: f64,
    pub(in crate::patch) slices: Vec<LineSlice>,
    /// Of swept bodies all places at which slices or surfaces end.
    pub(in crate::patch) crossings: Vec<Crossing>,
    /// Whether the slices answer those of the line before one to one.
    pub(in crate::patch) follows: bool,
}

impl SlicedLine {
    /// Lists the pairs of slices of a line and this one, the next line, that are parts of one band.
    pub(super) fn links(&self, before: &Self) -> Vec<[usize; 2]> {
        if self.follows {
            return (0..self.slices.len()).map(|k| [k, k]).collect();
        }
        let all = (0..before.slices.len()).flat_map(|i| (0..self.slices.len()).map(move |j| [i, j]));
        all.filter(|&[i, j]| before.slices[i].eta.overlaps(self.slices[j].eta)).collect()
    }
}

/// The slices of a band, by ascending ξ.
#[derive(Debug, Clone, Default)]
pub(in crate::patch) struct Lane {
    pub(in crate::patch) rows: Vec<LaneRow>,
}

/// A slice of a band on one of the lines.
#[derive(Debug, Clone, Copy)]
pub(in crate::patch) struct LaneRow {
    /// ξ or σ \[mm\].
    pub(in crate::patch) xi: f64,
    pub(in crate::patch) slice: LineSlice,
    /// Whether one slice lies between it and the row before on every line, and its ends move without a jump.
    pub(in crate::patch) follows: bool,
}

impl Lane {
    /// Returns the rows on both sides of ξ.
    pub(in crate::patch) fn beside(&self, xi: f64) -> Option<[&LaneRow; 2]> {
        let last = self.rows.len().checked_sub(1)?;
        let after = self.rows.partition_point(|row| row.xi < xi).min(last);
        Some([&self.rows[after.saturating_sub(1)], &self.rows[after]])
    }
}

/// Lays lines between others until neighbours answer each other, or are as near to each other as `nearest` says.
pub(in crate::patch) fn refined<T>(
    of: &mut T,
    lines: Vec<SlicedLine>,
    nearest: impl Fn(f64, f64) -> f64,
    answer: impl Fn(&mut T, [&SlicedLine; 2]) -> bool,
    between: impl Fn(&mut T, [&SlicedLine; 2]) -> SlicedLine,
) -> Vec<SlicedLine> {
    let mut out: Vec<SlicedLine> = Vec::with_capacity(2 * lines.len());
    let mut waiting: Vec<SlicedLine> = lines.into_iter().rev().collect();
    while let Some(mut next) = waiting.pop() {
        let Some(last) = out.last() else {
            out.push(next);
            continue;
        };
        next.follows = answer(of, [last, &next]);
        if next.follows || next.xi - last.xi <= nearest(last.xi, next.xi) || out.len() > MOST_LINES {
            out.push(next);
            continue;
        }
        let middle = between(of, [last, &next]);
        waiting.extend([next, middle]);
    }
    out
}

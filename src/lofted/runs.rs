//! Runs: stretches of a section over which a body that varies faces the other one, seen from a contact frame.

use std::ops::Range;

use super::build::Loft;
use super::strip::LoftStrip;
use crate::numerics::interval::Interval;

/// Distance along the surface of the sections from which feet are sought \[mm\].
pub(super) const LEVEL: f64 = 4.0;

/// How far beyond the end of a run feet are sought from it \[mm\]: a part may be that much wider half a step along the track.
const BESIDE: f64 = 2.0;

/// Successive nodes of a strip in one section over which ξ ascends.
#[derive(Debug, Clone)]
pub(super) struct AscendingRun {
    pub strip: usize,
    first: usize,
    /// ξ of the nodes \[mm\].
    pub xi: Vec<f64>,
}

/// Finds the runs in the section at y \[mm\]. `xi` gives ξ \[mm\] of a point \[x, z\] of a section at y. With `beside`, only cells near
/// ξ = 0 are looked at, from which all feet at ξ = 0 can be found.
pub(super) fn runs(
    loft: &Loft,
    xi: impl Fn([f64; 2], f64) -> f64,
    y: f64,
    beside: bool,
) -> Vec<AscendingRun> {
    let mut runs: Vec<AscendingRun> = Vec::new();
    for (strip, own) in loft.strips.iter().enumerate() {
        let [from, to] = own.reach().ends();
        // A part that begins or ends within a step has feet that are found from here.
        if y < from - LEVEL || y > to + LEVEL {
            continue;
        }
        let y = y.clamp(from, to);
        let cells =
            if beside { cells_beside(&xi, own, y) } else { std::iter::once(0..own.cells()).collect() };
        for cells in cells {
            let mut open = false;
            for node in cells.start..=cells.end {
                let xi = xi(own.point(node as f64, y).at, y);
                match runs.last_mut().filter(|_| open) {
                    Some(run) if run.xi[run.xi.len() - 1] < xi => run.xi.push(xi),
                    _ => runs.push(AscendingRun { strip, first: node, xi: vec![xi] }),
                }
                open = true;
            }
        }
    }
    runs.retain(|run| run.xi.len() > 1);
    runs
}

/// Lists the cells of a strip at y \[mm\] that may lie in a run from which feet at ξ = 0 are sought, as stretches in order.
fn cells_beside(xi: impl Fn([f64; 2], f64) -> f64, strip: &LoftStrip, y: f64) -> Vec<Range<usize>> {
    let (bay, near) = (strip.bay_at(y), Interval::symmetric(2.0 * BESIDE + strip.off()));
    let (mut found, mut waiting): (Vec<Range<usize>>, _) = (Vec::new(), vec![1]);
    while let Some(node) = waiting.pop() {
        let (cells, [x, z]) = (bay.cells(node), bay.bounds(node).map(Interval::ends));
        let corners = x.into_iter().flat_map(|x| z.map(|z| xi([x, z], y)));
        if cells.is_empty() || !Interval::around(corners).meets(near) {
            continue;
        }
        if bay.only_cell(node).is_none() {
            waiting.extend([2 * node + 1, 2 * node]);
            continue;
        }
        match found.last_mut().filter(|last| last.end == cells.start) {
            Some(last) => last.end = cells.end,
            None => found.push(cells),
        }
    }
    found
}

impl AscendingRun {
    /// Gives the interval of ξ between its ends \[mm\].
    pub fn reach(&self) -> Interval {
        Interval::new(self.xi[0], self.xi[self.xi.len() - 1])
    }

    pub fn holds(&self, xi: f64) -> bool {
        self.reach().grown(BESIDE).contains(xi)
    }

    /// Tells whether ξ \[mm\] lies between its ends.
    pub fn covers(&self, xi: f64) -> bool {
        let Interval { low, high } = self.reach();
        low < xi && xi < high
    }

    /// Gives the parameter u at ξ \[mm\], by linear interpolation.
    pub fn place(&self, xi: f64) -> f64 {
        let k = self.xi.partition_point(|at| *at <= xi).clamp(1, self.xi.len() - 1);
        let share = (xi - self.xi[k - 1]) / (self.xi[k] - self.xi[k - 1]);
        (self.first + k - 1) as f64 + share.clamp(0.0, 1.0)
    }
}

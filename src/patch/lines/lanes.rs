//! The slices of single lines of ξ, and the edges of a lane on any line.

use super::Lines;
use super::line::{Crossing, CrossingKind, crossings, held, leaves, rim_on};
use super::newton::newton_from;
use crate::numerics::interval::Interval;
use crate::numerics::roots::bracketed;
use crate::patch::fibres::{Lane, LaneRow, LineSlice, SlicedLine};

/// Returns a line of ξ or σ with its slices inside a window.
pub(in crate::patch) fn line(lines: &mut Lines<'_>, xi: f64, window: Interval) -> SlicedLine {
    let crossings = crossings(lines, xi, window);
    let mut slices = Vec::new();
    let mut open: Option<&Crossing> = None;
    for crossing in &crossings {
        let inside = crossing.inside()[1];
        match open {
            None if inside => open = Some(crossing),
            Some(from) if !inside => {
                let (eta, kinds) = (Interval::new(from.eta, crossing.eta), [from.kind, crossing.kind]);
                slices.push(LineSlice { eta, kinds, lowest: [f64::NAN; 2] });
                open = None;
            }
            _ => {}
        }
    }
    SlicedLine { xi, slices, crossings, follows: false }
}

/// Returns both ends of the slice of a lane on the line of ξ or σ \[mm\]; `None` for a lane without rows.
pub(in crate::patch) fn edges_of(
    lines: &mut Lines<'_>,
    xi: f64,
    lane: &Lane,
    window: Interval,
) -> Option<[f64; 2]> {
    let [a, b] = lane.beside(xi)?;
    let near = if (xi - a.xi).abs() <= (b.xi - xi).abs() { a } else { b };
    if near.xi == xi || !b.follows || xi < a.xi || b.xi < xi {
        return Some(near.slice.eta.ends());
    }
    let edge = |lines: &mut Lines<'_>, side: usize| edge_between(lines, xi, [a, b], (side, window));
    Some([edge(lines, 0), edge(lines, 1)])
}

pub(super) fn edge_between(
    lines: &mut Lines<'_>,
    xi: f64,
    rows: [&LaneRow; 2],
    (side, window): (usize, Interval),
) -> f64 {
    let [a, b] = rows.map(|row| row.slice.eta[side]);
    let kinds = rows.map(|row| row.slice.kinds[side]);
    match if kinds[0] == CrossingKind::Root { kinds[1] } else { kinds[0] } {
        CrossingKind::Rim(rim) => rim_on(lines, rim, xi),
        CrossingKind::Limit => lines.gap.within(Interval::of(xi)).cut(window)[side],
        CrossingKind::Root => {
            let between = Interval::new(rows[0].xi, rows[1].xi);
            let mut range = held(lines, between, CrossingKind::Root, [a, b]);
            let share = (xi - between.low) / between.width();
            let [first, last] = rows.map(|row| row.slice.eta.middle());
            // Beside a tip the range may hold the other edge, too.
            let middle = first + (last - first) * share;
            if lines.gap.gap(xi, middle) < 0.0 {
                range = if side == 0 {
                    range.cut(Interval::new(range.low, middle))
                } else {
                    range.cut(Interval::new(middle, range.high))
                };
            }
            let guess = a + (b - a) * share;
            let at = |eta: f64| lines.gap.at(xi, eta).map(|at| [at.gap, at.across]);
            if let Some(eta) = newton_from(at, guess, [-1.0, 1.0][side], range.width())
                && range.contains(eta)
            {
                return eta;
            }
            let (on, mut off) = if side == 0 { (range.high, range.low) } else { (range.low, range.high) };
            // Beside a saddle it may hold that of a neighbour.
            if lines.gap.gap(xi, off) < 0.0 {
                off = bracketed(|eta| lines.gap.across(xi, eta), on, off).unwrap_or(off);
            }
            leaves(lines, xi, [on, off])
        }
    }
}

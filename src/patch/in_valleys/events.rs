//! Finds the ξ at which the intervals of a patch that is found from valleys begin, end, divide or join.

use super::monotone::{along_surface, monotone};
use crate::numerics::interval::Interval;
use crate::numerics::roots::{bracketed, last_where};
use crate::patch::band::Turn;
use crate::patch::outline::Outline;

/// Share of the way from an event to a place outside the patch at which is seen whether a crease itself goes on within the patch.
const BEYOND: f64 = 1e-6;

/// Values of ξ at which the intervals of η may change \[mm\], in no order.
#[derive(Debug, Default)]
pub(in crate::patch) struct Events {
    /// All events.
    pub(in crate::patch) xi: Vec<f64>,
    /// Events at which s over a valley or ridge inside the window passes δ.
    pub(in crate::patch) tips: Vec<f64>,
    /// Events at which s over a valley or ridge outside the window makes the patch reach the window's edge,
    /// or leave it.
    pub(in crate::patch) cuts: Vec<f64>,
    /// Places at which s over a valley may be least.
    pub(in crate::patch) turns: Vec<Turn>,
}

/// Finds the events inside a range of ξ, which must not be empty.
pub(in crate::patch) fn events(outline: &mut Outline<'_>, range: Interval) -> Events {
    let mut events = Events::default();
    let approach = outline.slicer.approach();
    let count = outline.slicer.in_valleys.as_ref().map_or(0, |in_valleys| in_valleys.valleys.creases.len());
    let over_rail = outline.slicer.is_over_rail();
    let raised = outline.slicer.in_valleys.as_ref().map(|in_valleys| &in_valleys.raised);
    let pieces: Vec<_> = raised.into_iter().flat_map(|raised| raised.pieces(range)).collect();
    let (mut intervals, mut level) = (Vec::new(), Vec::new());
    for crease in 0..count {
        let Some(in_valleys) = &mut outline.slicer.in_valleys else { break };
        let is_valley = in_valleys.valleys.creases[crease].is_valley;
        for end in in_valleys.valleys.creases[crease].xi.ends() {
            for xi in in_valleys.raised.sigmas(end, range) {
                // Where s is above δ, nothing begins or ends.
                let above = in_valleys.depth(crease, xi) > 0.0;
                events.xi.extend((!above && range.surrounds(xi)).then_some(xi));
            }
        }
        intervals.clear();
        level.clear();
        if over_rail {
            along_surface(
                &in_valleys.valleys,
                (&in_valleys.raised, &pieces),
                crease,
                &mut intervals,
                &mut level,
            );
        } else {
            let matters = |s: Interval| s.low < approach && (is_valley || s.high > approach);
            monotone(&in_valleys.valleys, in_valleys.raised.rail(), crease, range, matters, &mut intervals);
        }
        for interval in &intervals {
            let ends = [interval.low.next_up(), interval.high];
            let depths = ends.map(|xi| crease_depth(outline, crease, xi));
            passes(outline, crease, (ends, depths), &mut events);
            if is_valley && !over_rail {
                let turn = |end: usize| Turn { valley: Some(crease), xi: ends[end], depth: depths[end] };
                events.turns.extend([turn(0), turn(1)]);
            }
        }
        if is_valley {
            let turn = |xi: f64| Turn { valley: Some(crease), xi, depth: f64::NAN };
            events.turns.extend(turns_within(outline, crease, &mut level).into_iter().map(turn));
        }
    }
    events
}

/// Returns the σ at which the least t over a valley may turn, and the ends of the ranges of σ in which they are sought \[mm\].
fn turns_within(outline: &mut Outline<'_>, valley: usize, level: &mut Vec<Interval>) -> Vec<f64> {
    level.sort_by(|a, b| a.low.total_cmp(&b.low));
    level.dedup();
    let mut turns: Vec<f64> = level.iter().flat_map(|range| range.ends()).collect();
    level.iter().for_each(|&range| outline.turns_over_rail(valley, range, &mut turns));
    turns.sort_by(f64::total_cmp);
    turns.dedup();
    turns
}

/// Adds the event at which s over a valley or ridge passes δ in a stretch over which it is monotone.
fn passes(
    outline: &mut Outline<'_>,
    crease: usize,
    (ends, depths): ([f64; 2], [f64; 2]),
    events: &mut Events,
) {
    if ends[0] > ends[1] {
        return;
    }
    let inside = depths.map(|depth| depth < 0.0);
    if inside == [false; 2] {
        return;
    }
    let seen = ends.map(|xi| outline.window.eta.contains(outline.slicer.valley(Some(crease), xi)));
    if seen == [true; 2] {
        if inside[0] == inside[1] {
            return;
        }
        match bracketed(|xi| crease_depth(outline, crease, xi), ends[0], ends[1]) {
            Some(xi) => {
                events.tips.push(xi);
                events.xi.push(xi);
            }
            None => {
                let (on, off) = if inside[0] { (ends[0], ends[1]) } else { (ends[1], ends[0]) };
                events.xi.push(last_where(|xi| crease_depth(outline, crease, xi) < 0.0, on, off));
            }
        }
    } else if inside.contains(&true) {
        passes_beside_window(outline, crease, ends.into(), events);
    }
}

/// Adds the events of a valley or ridge that leaves the window: there s at its place, or at the window's edge next to it,
/// passes δ.
fn passes_beside_window(outline: &mut Outline<'_>, crease: usize, over: Interval, events: &mut Events) {
    let mut places = vec![over.low];
    for edge in outline.window.eta.ends().into_iter().filter(|edge| edge.is_finite()) {
        places.extend(outline.turns_along(edge, over));
    }
    places.push(over.high);
    places.sort_by(f64::total_cmp);
    let mut before = outline.depth(Some(crease), over.low) < 0.0;
    for pair in places.windows(2) {
        let here = outline.depth(Some(crease), pair[1]) < 0.0;
        if here != before {
            let (on, off) = if before { (pair[0], pair[1]) } else { (pair[1], pair[0]) };
            let xi = last_where(|xi| outline.depth(Some(crease), xi) < 0.0, on, off);
            // Where the crease leaves the window, rounding decides on which side of its edge it is seen.
            let goes_on = crease_depth(outline, crease, xi + BEYOND * (off - xi)) < 0.0;
            let seen = outline.window.eta.contains(outline.slicer.valley(Some(crease), xi));
            (if seen && !goes_on { &mut events.tips } else { &mut events.cuts }).push(xi);
            events.xi.push(xi);
        }
        before = here;
    }
}

/// Returns s − δ at the place of a valley or ridge \[mm\], inside or outside the window.
fn crease_depth(outline: &mut Outline<'_>, crease: usize, xi: f64) -> f64 {
    outline.slicer.in_valleys.as_mut().map_or(f64::NAN, |in_valleys| in_valleys.depth(crease, xi))
}

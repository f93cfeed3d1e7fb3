//! Finds where a band ends: where the least gap of a line passes δ, or a body ends.

use super::place::LowestPlace;
use super::ranges::{LeastGap, STEPS, halfway};
use crate::numerics::interval::Interval;
use crate::numerics::roots::{bracketed, last_where};
use crate::patch::end::End;

/// Most steps to where the least gap passes δ.
const MOST_STEPS: usize = 100;

/// Returns the ξ or σ \[mm\] between two places at which the least gap passes δ, and η of that gap; `None` where a body is missing.
///
/// Method: Newton's steps inside a bracket.
fn root(gap: &mut LeastGap<'_, '_>, [a, b]: [&LowestPlace; 2]) -> Option<[f64; 2]> {
    if !gap.lines.gap.is_skewed() {
        let floor = gap.window.nearest(0.0);
        return bracketed(|xi| gap.lines.gap.gap(xi, floor), a.xi, b.xi).map(|xi| [xi, floor]);
    }
    let mut ends = [*a, *b];
    let share = a.depth.high / (a.depth.high - b.depth.high);
    let turn = (b.eta - a.eta) / (b.xi - a.xi);
    let [mut next, mut eta] = [a.xi + share * (b.xi - a.xi), a.eta + share * (b.eta - a.eta)];
    // Steps of both at once come close.
    for _ in 0..STEPS {
        let Some(at) = gap.lines.gap.at(next, eta).filter(|_| gap.window.contains(eta)) else { break };
        let fall = at.across / (2.0 * gap.lines.gap.opening);
        let step = (at.gap - at.across * fall / 2.0) / at.along;
        if !Interval::new(a.xi, b.xi).surrounds(next - step) {
            break;
        }
        (next, eta) = (next - step, eta - fall - turn * step);
    }
    if eta.is_nan() {
        eta = halfway(a.eta, b.eta);
    }
    for _ in 0..MOST_STEPS {
        let between = Interval::new(ends[0].xi, ends[1].xi);
        if !between.surrounds(next) {
            next = between.middle();
        }
        if !between.surrounds(next) {
            break;
        }
        let place = gap.lowest_place(next, eta);
        eta = place.eta;
        let at = gap.lines.gap.at(next, gap.window.nearest(eta))?;
        ends[usize::from(place.is_inside() == ends[1].is_inside())] = place;
        let step = place.depth.high / at.along;
        if place.depth.high == 0.0 || step.abs() <= f64::EPSILON * next.abs() {
            return Some([next, gap.window.nearest(eta)]);
        }
        next -= step;
    }
    let nearest = if ends[0].depth.high.abs() < ends[1].depth.high.abs() { ends[0] } else { ends[1] };
    (!ends.iter().any(LowestPlace::is_missing)).then(|| [nearest.xi, gap.window.nearest(nearest.eta)])
}

/// Returns the end of the patch between two lines, one of which meets it, and what bounds it there.
pub(super) fn end_between(gap: &mut LeastGap<'_, '_>, [a, b]: [&LowestPlace; 2]) -> (f64, End) {
    if let Some([xi, eta]) = root(gap, [a, b]) {
        let is_tip = !gap.lines.gap.is_skewed() && eta == 0.0 || eta == gap.lines.lowest(xi, eta);
        let end = if is_tip || gap.window.surrounds(eta) { End::Tip } else { End::Window };
        return (xi, end);
    }
    // If one side has no surface, the end is the last ξ with a surface.
    let (on, off) = if a.is_inside() { (a.xi, b.xi) } else { (b.xi, a.xi) };
    let guess = if a.is_inside() { a.eta } else { b.eta };
    let xi = last_where(|xi| gap.lowest_place(xi, guess).is_inside(), on, off);
    (xi, End::ProfileEnd)
}

//! Finds the bands of a patch without skew. A line of constant ξ then meets the patch in at most one interval.

use super::band::{Band, steps};
use super::outline::{End, Outline, Window};
use crate::numerics::roots::{bracketed, last_where};
use crate::patch::turning_points;
use crate::placement::Placement;

/// Number of intervals in which turns of the depth over a roller are sought if the lowest places along η are not in its midplane. A
/// part is missed only if it begins and ends within one of them.
const WINDOW_INTERVALS: usize = 512;

/// Returns the bands by ascending ξ, and the ξ at which s may be least \[mm\].
///
/// At a joint the gap may step (an overhang). Every interval between turning points is therefore judged by the values at
/// its own two ends.
pub(super) fn bands(outline: &mut Outline<'_>) -> (Vec<Band>, Vec<f64>) {
    let placement = outline.slicer.placement();
    // A skewed wheel lies over another part of a roller.
    let over = if placement.skew() == 0.0 { placement.overlap() } else { placement.rail().section.reach() };
    let Some([first, last]) = over else { return (Vec::new(), Vec::new()) };
    let [a, b] = [first.max(outline.window.xi[0]), last.min(outline.window.xi[1])];
    if a.is_nan() || b.is_nan() || a >= b {
        return (Vec::new(), Vec::new());
    }
    let turns = turns_of_depth(outline, a, b);
    let extent = placement.rail().profile().extent().max(placement.wheel().profile().extent());
    let mut torn: Vec<f64> = steps(&placement.rail().section, [a, b], extent).collect();
    torn.extend(steps(&placement.wheel().section, [a, b], extent));
    let mut bands = Vec::new();
    let mut begun: Option<(f64, Option<End>)> = None;
    for pair in turns.windows(2) {
        let (p, q) = (pair[0].next_up(), pair[1]);
        let inside = [p, q].map(|xi| outline.depth(None, xi) < 0.0);
        let step = if pair[0] == a && a != first { End::Window } else { End::ProfileEnd };
        begun = match begun {
            Some(begin) if !inside[0] => {
                bands.push(closed(outline, begin, (pair[0], Some(step))));
                None
            }
            Some(begin) if torn.contains(&pair[0]) => {
                bands.push(closed(outline, begin, (pair[0], None)));
                Some((pair[0], None))
            }
            None if inside[0] => Some((pair[0], Some(step))),
            begun => begun,
        };
        if inside[0] != inside[1] {
            let (xi, end) = part_end(outline, [p, q], inside[0]);
            begun = match begun {
                Some(begin) => {
                    bands.push(closed(outline, begin, (xi, Some(end))));
                    None
                }
                None => Some((xi, Some(end))),
            };
        }
    }
    if let Some(begin) = begun {
        let end = if b == last { End::ProfileEnd } else { End::Window };
        bands.push(closed(outline, begin, (b, Some(end))));
    }
    bands.retain(|band| band.xi[0] < band.xi[1]);
    (bands, turns)
}

/// Finds \[s, ξ, η\] \[mm\] of the least s of a wheel on a roller; `None` where the bodies nowhere lie over each other.
pub(crate) fn least_on_roller(placement: &Placement) -> Option<[f64; 3]> {
    let [a, b] = placement.rail().section.reach()?;
    let mut outline = Outline::new(placement, 0.0, &Window::UNBOUNDED);
    // C comes first: rounding may put a turn next to it.
    let places = std::iter::once(0.0).chain(turns_of_depth(&mut outline, a, b));
    let found: Vec<_> =
        places.map(|xi| outline.lowest(None, xi)).filter(|least| !least[0].is_nan()).collect();
    found.into_iter().min_by(|p, q| p[0].total_cmp(&q[0]))
}

fn closed(
    outline: &mut Outline<'_>,
    (from, begin): (f64, Option<End>),
    (to, end): (f64, Option<End>),
) -> Band {
    // A joint belongs to the left piece. If the surface steps or begins at a joint, the slice on its right is taken at the
    // next number.
    let beside = begin.is_none() || outline.depth(None, from).is_nan();
    let places = [(begin, if beside { from.next_up() } else { from }), (end, to)];
    let sides = places.map(|(end, xi)| {
        let edges = outline.edges(None, xi).filter(|_| end != Some(End::Tip));
        edges.map_or_else(|| [outline.floor(None, xi); 2], |edges| edges.map(|edge| edge.eta))
    });
    Band::new([from, to], [begin, end], sides, outline.window.eta)
}

/// Returns a, b, and all ξ between them where the depth may turn: joints and stationary points. The depth is monotone
/// between neighbours.
fn turns_of_depth(outline: &mut Outline<'_>, a: f64, b: f64) -> Vec<f64> {
    let mut points = turning_points(outline.slicer.placement(), a, b);
    let placement = outline.slicer.placement();
    let (skewed, on_roller) = (placement.skew() != 0.0, placement.under().is_some());
    if !skewed && outline.floor(None, a) == 0.0 {
        return points;
    }
    if !on_roller {
        let floor = outline.floor(None, a);
        points.extend(outline.turns_along(floor, [a, b]));
    } else {
        let step = (b - a) / WINDOW_INTERVALS as f64;
        points.extend((1..WINDOW_INTERVALS).map(|k| a + step * k as f64));
        points.sort_by(f64::total_cmp);
        // At the lowest place along η, that of s has no part along η.
        let mut slope = |xi: f64| {
            let floor = outline.floor(None, xi);
            outline.slicer.gradient(xi, floor)[0]
        };
        let turns: Vec<f64> =
            points.windows(2).filter_map(|pair| bracketed(&mut slope, pair[0].next_up(), pair[1])).collect();
        points.extend(turns);
    }
    points.sort_by(f64::total_cmp);
    points.dedup();
    points
}

/// Returns the end of the patch between p and q, one of which is inside the patch, and what bounds it there.
fn part_end(outline: &mut Outline<'_>, [p, q]: [f64; 2], first_inside: bool) -> (f64, End) {
    if let Some(tip) = bracketed(|xi| outline.depth(None, xi), p, q) {
        let is_tip = outline.floor(None, tip) == outline.slicer.lowest(tip);
        return (tip, if is_tip { End::Tip } else { End::Window });
    }
    // If one side has no surface, the end is the last ξ with a surface.
    let (on, off) = if first_inside { (p, q) } else { (q, p) };
    (last_where(|xi| outline.depth(None, xi) < 0.0, on, off), End::ProfileEnd)
}

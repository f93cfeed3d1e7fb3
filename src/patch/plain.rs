//! Finds the bands of a patch that a line of constant ξ meets in at most one interval: on a roller, and without skew over the tangent
//! plane of a rail unless lines enter the wheel again over its end.

use super::band::{Band, Turn, steps};
use super::by_roots::turns::LeastGap;
use super::outline::{End, Outline};
use super::window::Window;
use crate::conformal::Reference;
use crate::numerics::interval::Interval;
use crate::numerics::roots::{bracketed, last_where};
use crate::patch::turning_points;
use crate::placement::Placement;

/// Returns the bands by ascending ξ, and the places at which s may be least.
///
/// At a joint the gap may step (an overhang). An interval between turning points that begins there is judged by a value of its own.
pub(super) fn bands(outline: &mut Outline<'_>) -> (Vec<Band>, Vec<Turn>) {
    let placement = outline.slicer.placement();
    let Some(reach) = outline.slicer.reach() else { return (Vec::new(), Vec::new()) };
    let over = reach.cut(outline.window.xi);
    let [a, b] = over.ends();
    if a.is_nan() || b.is_nan() || a >= b {
        return (Vec::new(), Vec::new());
    }
    let extent = placement.rail().profile().extent().max(placement.wheel().profile().extent());
    let mut torn: Vec<f64> = Vec::new();
    if !outline.slicer.is_over_rail() {
        torn.extend(steps(&placement.rail().section, over, extent));
        torn.extend(steps(&placement.wheel().section, over, extent));
    }
    let turns = turns_of_depth(outline, over, &torn);
    let mut bands = Vec::new();
    let mut begun: Option<(f64, Option<End>)> = None;
    let at = |outline: &mut Outline<'_>, xi: f64| Turn { valley: None, xi, depth: outline.depth(None, xi) };
    let mut places = vec![at(outline, a)];
    for pair in turns.windows(2) {
        let before = places[places.len() - 1];
        let here = at(outline, pair[1]);
        places.push(here);
        let torn_here = torn.contains(&pair[0]);
        let judged_beside = torn_here || before.depth.is_nan() || outline.slicer.is_over_rail();
        let from = if judged_beside { at(outline, pair[0].next_up()) } else { before };
        let (p, q) = (from.xi, pair[1]);
        let inside = [from, here].map(|place| place.depth < 0.0);
        let step = if pair[0] == a && a != reach.low { End::Window } else { End::ProfileEnd };
        begun = match begun {
            Some(begin) if !inside[0] => {
                bands.push(closed(outline, begin, (pair[0], Some(step))));
                None
            }
            Some(begin) if torn_here => {
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
        let end = if b == reach.high { End::ProfileEnd } else { End::Window };
        bands.push(closed(outline, begin, (b, Some(end))));
    }
    bands.retain(|band| band.xi.has_width());
    (bands, places)
}

/// Finds \[s, ξ, η\] \[mm\] of the least s of a wheel on a roller; `None` where the bodies nowhere lie over each other.
pub(crate) fn least_on_roller(placement: &Placement) -> Option<[f64; 3]> {
    let reach = placement.rail().section.reach()?;
    let mut outline = Outline::new(placement, 0.0, &Window::UNBOUNDED, Reference::Plane);
    let slices = outline.slicer.by_roots.as_mut()?;
    let xi = LeastGap { slices, over: reach, window: Interval::ALL }.least_of_all()?;
    Some(outline.lowest(None, xi))
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
        edges.map_or_else(|| Interval::of(outline.floor(None, xi)), Interval::from)
    });
    Band::new(Interval::new(from, to), [begin, end], sides, outline.window.eta)
}

/// Returns both ends of a range of ξ \[mm\], and so many places between them, ascending, that the depth passes 0 at most once from one to
/// the next: all at which it may turn or, next to `torn` ones, as many as prove it.
fn turns_of_depth(outline: &mut Outline<'_>, over: Interval, torn: &[f64]) -> Vec<f64> {
    if let Some(least) = outline.slicer.least_gap(over, outline.window.eta) {
        return least.turns(torn.to_vec());
    }
    let mut points = turning_points(outline.slicer.placement(), over.low, over.high);
    let floor = outline.floor(None, over.low);
    if floor != 0.0 {
        points.extend(outline.turns_along(floor, over));
        points.sort_by(f64::total_cmp);
        points.dedup();
    }
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

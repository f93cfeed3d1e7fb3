//! The least gap over boxes of the plane.

use super::bounds::BoxSlopes;
use super::lanes::edges_of;
use super::line::{CrossingKind, beside, beside_rims, rim_on, rims_at, shortest_part};
use super::ranges::{LEVEL, SHALLOW, least_between};
use super::{BESIDE, Lines, SHALLOW_VALLEY};
use crate::numerics::interval::Interval;
use crate::numerics::roots::bracketed;
use crate::patch::fibres::Lane;

/// Most Newton's steps to a least gap.
const SETTLING: usize = 8;

/// Most boxes that are looked at for a least gap.
const MOST_BOXES: usize = 1 << 10;

/// A box of ξ or σ and η that may hold the least gap.
#[derive(Debug, Clone, Copy)]
pub(in crate::patch) struct GapBox {
    pub(in crate::patch) xi: Interval,
    pub(in crate::patch) eta: Interval,
    /// Whether its sides along ξ are no ends of a surface or a window: where the gap slopes one way along η it then is not least.
    pub(in crate::patch) is_open: bool,
}

/// Returns \[G, ξ, η\] \[mm\] of the least gap of a lane.
pub(in crate::patch) fn least_of(lines: &mut Lines<'_>, lane: &Lane) -> Option<[f64; 3]> {
    let ends = [lane.rows.first()?, lane.rows.last()?].map(|row| {
        let [eta, gap] = lowest_within(lines, row.xi, row.slice.eta);
        [gap, row.xi, eta]
    });
    let mut best = if ends[0][0] <= ends[1][0] { ends[0] } else { ends[1] };
    for pair in lane.rows.windows(2) {
        for side in 0..2 {
            if let [CrossingKind::Rim(rim), CrossingKind::Rim(other)] =
                [0, 1].map(|k| pair[k].slice.kinds[side])
                && rim == other
            {
                best = least_on_rim(
                    lines,
                    (rim, [1.0, -1.0][side]),
                    Interval::new(pair[0].xi, pair[1].xi),
                    best,
                );
            }
        }
    }
    let rows = lane.rows.windows(2);
    let boxes = rows.map(|pair| GapBox {
        xi: Interval::new(pair[0].xi, pair[1].xi),
        eta: pair[0].slice.eta.hull(pair[1].slice.eta),
        is_open: pair.iter().flat_map(|row| row.slice.kinds).all(|mark| mark == CrossingKind::Root),
    });
    Some(least_in(lines, boxes.collect(), best))
}

/// Returns the least of a gap that is known, \[G, ξ, η\] \[mm\], and those on one side of a rim over a range.
fn least_on_rim(
    lines: &mut Lines<'_>,
    (rim, side): (usize, f64),
    over: Interval,
    known: [f64; 3],
) -> [f64; 3] {
    let (mut best, mut waiting) = (known, vec![over]);
    let shallow = lines.gap.roundings(SHALLOW);
    while let Some(xi) = waiting.pop() {
        let (x, eta) = (xi.middle(), rim_on(lines, rim, xi.middle()));
        let gap = beside(lines, x, eta, side);
        if gap < best[0] {
            best = [gap, x, eta];
        }
        let ends = xi.ends().map(|xi| rim_on(lines, rim, xi));
        let slopes = lines.along_rim(rim, xi, Interval::between(ends[0], ends[1])).unwrap_or(Interval::ALL);
        let one_way = slopes.low >= 0.0 || slopes.high <= 0.0;
        let higher = gap - slopes.magnitude() * xi.width() / 2.0 >= best[0] - shallow;
        if !(one_way || higher) && xi.width() > lines.narrowest() {
            waiting.extend(xi.halves());
        }
    }
    best
}

/// Returns the least of a gap that is known, \[G, ξ, η\] \[mm\], and the gaps over boxes.
///
/// Method: the box that may hold the lowest gap is halved, until its bounds lie above the least that is known, prove that the gap slopes one
/// way all over it, or that it is convex where the least that is known is a stationary place.
pub(in crate::patch) fn least_in(lines: &mut Lines<'_>, boxes: Vec<GapBox>, known: [f64; 3]) -> [f64; 3] {
    let (mut best, mut is_level) = (known, false);
    let bounded = |lines: &Lines<'_>, of: GapBox| (lines.gap.least(of.xi, of.eta), of);
    let mut waiting: Vec<(f64, GapBox)> = boxes.into_iter().map(|of| bounded(lines, of)).collect();
    let level = lines.gap.roundings(LEVEL);
    for _ in 0..MOST_BOXES {
        let lowest = (0..waiting.len()).min_by(|a, b| waiting[*a].0.total_cmp(&waiting[*b].0));
        let Some((bound, GapBox { xi, eta, is_open })) = lowest.map(|k| waiting.swap_remove(k)) else {
            break;
        };
        if bound > best[0] - level {
            break;
        }
        let [x, y] = [xi.middle(), eta.middle()];
        let gap = lines.gap.or_infinite(x, y);
        if gap < best[0] {
            (best, is_level) = settled(lines, [gap, x, y], GapBox { xi, eta, is_open });
        }
        let holds_best = is_level && xi.surrounds(best[1]) && eta.surrounds(best[2]);
        if holds_best
            && lines.gap.is_over_plane()
            && lines.gap.is_bowl(xi, eta, lines.gap.roundings(SHALLOW_VALLEY))
        {
            continue;
        }
        let whole = lines.gap.slopes(xi, eta, Interval::ALL);
        let slopes = whole.or_else(|| lines.gap.torn_slopes(xi, eta));
        let ways = |BoxSlopes { along, across, .. }: &BoxSlopes| {
            [along.magnitude() * xi.width() / 2.0, across.magnitude() * eta.width() / 2.0]
        };
        let [by_xi, by_eta] = slopes.as_ref().map_or([xi.width(), eta.width()], ways);
        let one_way = |slope: Interval| slope.low > 0.0 || slope.high < 0.0;
        // Of a slice that a rim bounds the gaps there are known.
        let leaves = !is_open && slopes.is_some_and(|slopes| one_way(slopes.along) || one_way(slopes.across));
        let falls_on = leaves
            || whole.is_some_and(|slopes| {
                one_way(slopes.along) || (is_open && (one_way(slopes.across) || one_way(slopes.lowest)))
            });
        let above = slopes.is_some() && whole.is_some() && gap - by_xi - by_eta >= best[0] - level;
        if falls_on || above || xi.width().max(eta.width()) <= lines.narrowest() {
            continue;
        }
        if by_xi >= by_eta {
            waiting.extend(xi.halves().map(|xi| bounded(lines, GapBox { xi, eta, is_open })));
        } else {
            waiting.extend(eta.halves().map(|eta| bounded(lines, GapBox { xi, eta, is_open })));
        }
    }
    best
}

/// Returns the place \[G, ξ, η\] \[mm\] to which Newton's steps go down from one in a box, and whether the gap is level there.
///
/// Method: each step is that of the slopes at the place and at two beside it.
fn settled(lines: &mut Lines<'_>, known: [f64; 3], GapBox { xi, eta, .. }: GapBox) -> ([f64; 3], bool) {
    let beside = BESIDE * lines.gap.placement().rolling_radius();
    let [mut x, mut y] = [known[1], known[2]];
    let mut best = known;
    for _ in 0..SETTLING {
        let places = [[x, y], [x + beside, y], [x, y + beside]];
        let [Some(at), Some(by_xi), Some(by_eta)] = places.map(|[x, y]| lines.gap.at(x, y)) else { break };
        let [a, b] = [(by_xi.along - at.along) / beside, (by_xi.across - at.across) / beside];
        let c = (by_eta.across - at.across) / beside;
        let det = a * c - b * b;
        if !(a > 0.0 && det > 0.0) {
            break;
        }
        let steps = [(b * at.across - c * at.along) / det, (b * at.along - a * at.across) / det];
        if -(at.along * steps[0] + at.across * steps[1]) <= lines.gap.roundings(SHALLOW) {
            return (best, true);
        }
        (x, y) = (x + steps[0], y + steps[1]);
        let gap = lines.gap.or_infinite(x, y);
        if !(xi.contains(x) && eta.contains(y)) || gap >= best[0] {
            break;
        }
        best = [gap, x, y];
    }
    (best, false)
}

/// Returns η of the least gap in a part of a line, and that gap \[mm\].
///
/// Method: between two rims the part is halved where bounds of the slope leave it open that the gap is lower there, until the gap is proved
/// convex.
pub(in crate::patch) fn lowest_within(lines: &mut Lines<'_>, xi: f64, over: Interval) -> [f64; 2] {
    let off = beside_rims(lines);
    let rims: Vec<f64> = rims_at(lines, xi, over.grown(off)).into_iter().map(|(eta, _)| eta).collect();
    let is_rim = |eta: f64| rims.iter().any(|rim| (rim - eta).abs() <= off);
    let mut waiting: Vec<(Interval, [f64; 2])> = Vec::new();
    let mut best = [over.low, f64::INFINITY];
    for part in over.parts(rims.iter().copied().filter(|rim| over.surrounds(*rim)).collect()) {
        let ends = [(part.low, 1.0), (part.high, -1.0)].map(|(eta, inwards)| {
            if is_rim(eta) { beside(lines, xi, eta, inwards) } else { lines.gap.or_infinite(xi, eta) }
        });
        for (eta, gap) in part.ends().into_iter().zip(ends) {
            if gap < best[1] {
                best = [eta, gap];
            }
        }
        waiting.push((part, ends));
    }
    let shallow = lines.gap.roundings(SHALLOW);
    while let Some((eta, ends)) = waiting.pop() {
        let line = Interval::of(xi);
        let slopes = lines.gap.torn_slopes(line, eta).map(|slopes| slopes.across);
        // Where no surface folds back, one that is missing at both ends of a part is missing all over it.
        let missing = ends.iter().all(|gap| gap.is_infinite());
        let settled = slopes.is_some_and(|across| {
            missing
                || across.low >= 0.0
                || across.high <= 0.0
                || least_between(ends, eta.width(), across) >= best[1] - shallow
        });
        let shortest = shortest_part(lines, over, slopes.is_some());
        let middle = eta.middle();
        let is_short = eta.width() <= shortest || !eta.surrounds(middle);
        if settled || is_short || lines.gap.least(line, eta) > best[1] {
            continue;
        }
        let is_smooth = eta.ends().iter().all(|eta| lines.gap.across(xi, *eta).is_finite());
        if is_smooth && lines.gap.is_convex(line, eta, lines.gap.roundings(SHALLOW_VALLEY)) {
            let turn = bracketed(|eta| lines.gap.across(xi, eta), eta.low, eta.high);
            let turned = turn.map(|eta| [eta, lines.gap.or_infinite(xi, eta)]);
            best = turned.filter(|turned| turned[1] < best[1]).unwrap_or(best);
            continue;
        }
        let gap = lines.gap.or_infinite(xi, middle);
        if gap < best[1] {
            best = [middle, gap];
        }
        let [lower, upper] = eta.halves();
        waiting.extend([(lower, [ends[0], gap]), (upper, [gap, ends[1]])]);
    }
    best
}

/// Returns η \[mm\] of the least gap on a line of ξ or σ.
pub(in crate::patch) fn lowest_of_line(lines: &mut Lines<'_>, xi: f64, window: Interval) -> f64 {
    let within = lines.gap.within(Interval::of(xi)).cut(window);
    lowest_within(lines, xi, within)[0]
}

/// Returns η of the least gap in the slice of a lane on the line of ξ or σ \[mm\], or next to it.
pub(in crate::patch) fn lowest_of(lines: &mut Lines<'_>, xi: f64, lane: &Lane, window: Interval) -> f64 {
    let edges = edges_of(lines, xi, lane, window);
    edges.map_or(f64::NAN, |edges| lowest_within(lines, xi, edges.into())[0])
}

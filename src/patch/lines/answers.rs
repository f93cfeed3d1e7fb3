//! Whether the slices of two neighbouring lines answer one to one on all lines between them.

use super::Lines;
use super::gap::BoxSlopes;
use super::lanes::line;
use super::line::{Crossing, CrossingKind, held};
use super::ranges::{UNKNOWN, least_between};
use crate::numerics::interval::Interval;
use crate::patch::fibres::SlicedLine;

/// Distance of two lines, as a share of R, up to which they answer each other if their crossings are alike: a part of the patch between them
/// would be shallower than 1e-8 mm unless the bodies bend by more than 1/0.4 mm. Beside hollow kinks, and where a surface folds back over
/// itself, bounds do not prove more.
const NEAR: f64 = 1e-6;

/// Most boxes by which one part between two lines is proved to be inside the patch, or outside.
const MOST_BOXES: usize = 96;

/// The crossings of two lines that answer each other, and the ranges of η \[mm\] that hold them on all lines between.
struct Answering<'l> {
    xi: Interval,
    lines: [&'l [Crossing]; 2],
    held: Vec<Interval>,
}

/// Returns whether slices of two lines answer one to one, and on every line between them lies one slice between two that do.
///
/// Method: between two lines each edge runs in a box in which the gap slopes along η one way; boxes between these are proved to be inside
/// or outside by bounds of the slopes or by heights. No bounds are known where a surface stands upright: there, of lines no farther
/// apart than [`UNKNOWN`], the one in the middle is to have the crossings that theirs say, and each root that is not upright is to pass once.
pub(in crate::patch) fn answer(lines: &mut Lines<'_>, pair: [&SlicedLine; 2], window: Interval) -> bool {
    let xi = Interval::new(pair[0].xi, pair[1].xi);
    let [a, b] = pair.map(|line| line.crossings.as_slice());
    if !are_alike(a, b) {
        return false;
    }
    let held: Vec<Interval> = a.iter().zip(b).map(|(a, b)| held(lines, xi, a.kind, [a.eta, b.eta])).collect();
    let is_upright = |(crossing, held): (&Crossing, &Interval)| match crossing.kind {
        CrossingKind::Limit => false,
        CrossingKind::Root if crossing.sides.iter().any(|side| side.is_infinite()) => true,
        _ => lines.gap.torn_slopes(xi, *held).is_none(),
    };
    let is_settled = |(crossing, held): (&Crossing, &Interval)| {
        crossing.kind != CrossingKind::Root
            || is_upright((crossing, held))
            || passes_once(lines, xi, *held, crossing)
    };
    let is_unknown = a.iter().zip(&held).any(is_upright) && a.iter().zip(&held).all(is_settled);
    let short = UNKNOWN * lines.gap.reach().map_or(0.0, Interval::width);
    if xi.width() <= NEAR * lines.gap.placement().rolling_radius()
        || (is_unknown && xi.width() <= short && is_between(lines, xi, (a, &held), window))
    {
        return true;
    }
    let over = lines.gap.within(xi).cut(window);
    let answering = Answering { xi, lines: [a, b], held };
    answer_at_crossings(lines, &answering) && answer_between(lines, &answering, over)
}

fn are_alike(a: &[Crossing], b: &[Crossing]) -> bool {
    let alike = |(a, b): (&Crossing, &Crossing)| a.kind == b.kind && a.inside() == b.inside();
    a.len() == b.len() && a.iter().zip(b).all(alike)
}

/// Returns whether the line in the middle of a range has the crossings of its ends, within the ranges that hold these.
fn is_between(
    lines: &mut Lines<'_>,
    xi: Interval,
    (ends, held): (&[Crossing], &[Interval]),
    window: Interval,
) -> bool {
    let middle = line(lines, xi.middle(), window).crossings;
    let is_held = |(crossing, held): (&Crossing, &Interval)| {
        crossing.kind == CrossingKind::Limit || held.contains(crossing.eta)
    };
    are_alike(ends, &middle) && middle.iter().zip(held).all(is_held)
}

fn answer_at_crossings(lines: &mut Lines<'_>, answering: &Answering<'_>) -> bool {
    let Answering { xi, lines: [a, b], held } = answering;
    let mut k = 0;
    while k < held.len() {
        // Rims that lie next to each other count as one.
        let (first, mut box_of) = (k, held[k]);
        while k + 1 < held.len() && held[k + 1].low <= box_of.high {
            k += 1;
            box_of = box_of.hull(held[k]);
        }
        let both = [&a[first..=k], &b[first..=k]];
        let good = match a[first].kind {
            CrossingKind::Limit if k == first => true,
            CrossingKind::Root if k == first => passes_once(lines, *xi, box_of, &a[first]),
            _ => keeps_order(lines, *xi, box_of, both),
        };
        if !good {
            return false;
        }
        k += 1;
    }
    true
}

/// Returns whether the gap is proved to slope one way along η over a box around a root.
fn passes_once(lines: &Lines<'_>, xi: Interval, eta: Interval, root: &Crossing) -> bool {
    let sign = if root.inside()[0] { 1.0 } else { -1.0 };
    let slopes = lines.gap.torn_slopes(xi, eta);
    slopes.is_some_and(|slopes| (slopes.across * sign).low > 0.0)
}

/// Returns whether a box around rims and roots beside them holds these alone on every line.
///
/// Method: at rims the gap keeps its signs by bounds of its slope along their circles, and beside them it slopes along η one way, or too
/// little to pass δ.
fn keeps_order(lines: &Lines<'_>, xi: Interval, eta: Interval, pair: [&[Crossing]; 2]) -> bool {
    let sides = || pair.into_iter().flatten().flat_map(|crossing| crossing.sides);
    let inside = pair[0][0].sides[0] < 0.0;
    if sides().all(|side| (side < 0.0) == inside) && lines.gap.is_all(xi, eta, inside) {
        return true;
    }
    let Some(slopes) = lines.gap.torn_slopes(xi, eta) else { return false };
    let most = slopes.along.magnitude() * xi.width() + slopes.across.magnitude() * eta.width();
    let alike = |(a, b): (&Crossing, &Crossing)| {
        (0..2).all(|side| a.sides[side].is_finite() == b.sides[side].is_finite())
    };
    if !pair[0].iter().zip(pair[1]).all(alike) {
        return false;
    }
    let has_rims_alone = pair[0].iter().all(|crossing| matches!(crossing.kind, CrossingKind::Rim(_)));
    if has_rims_alone && sides().all(|side| side.abs() > most) {
        return true;
    }
    let one_way = slopes.across.low > 0.0 || slopes.across.high < 0.0;
    one_way && pair[0].iter().zip(pair[1]).all(|(a, b)| keeps_signs(lines, xi, [a, b]))
}

/// Returns whether the gap keeps its sign along a rim between two lines, on each side that has a surface.
fn keeps_signs(lines: &Lines<'_>, xi: Interval, ends: [&Crossing; 2]) -> bool {
    let rim = match ends[0].kind {
        CrossingKind::Rim(rim) => rim,
        CrossingKind::Root => return true,
        CrossingKind::Limit => return false,
    };
    let eta = Interval::between(ends[0].eta, ends[1].eta);
    let Some(slopes) = lines.along_rim(rim, xi, eta) else { return false };
    (0..2).all(|side| {
        let gaps = ends.map(|end| end.sides[side]);
        let sign = if gaps[0] < 0.0 { -1.0 } else { 1.0 };
        !gaps[0].is_finite() || least_between(gaps.map(|gap| gap * sign), xi.width(), slopes * sign) > 0.0
    })
}

fn answer_between(lines: &mut Lines<'_>, answering: &Answering<'_>, over: Interval) -> bool {
    let Answering { xi, lines: [a, _], held } = answering;
    let mut low = over.low;
    let mut inside = false;
    for (crossing, held) in a.iter().zip(held) {
        let part = Interval::new(low, held.low);
        if crossing.kind != CrossingKind::Limit {
            if part.has_width() && !is_all(lines, *xi, part, crossing.inside()[0]) {
                return false;
            }
            low = low.max(held.high);
        }
        inside = crossing.inside()[1];
    }
    let limited = a.last().is_some_and(|last| last.kind == CrossingKind::Limit && last.inside()[0]);
    let part = Interval::new(low, over.high);
    !part.has_width() || is_all(lines, *xi, part, inside || limited)
}

/// Returns whether all of a box is proved to be inside the patch, or all outside.
fn is_all(lines: &mut Lines<'_>, xi: Interval, eta: Interval, inside: bool) -> bool {
    let sign = if inside { -1.0 } else { 1.0 };
    let mut waiting = vec![eta];
    for _ in 0..MOST_BOXES {
        let Some(eta) = waiting.pop() else { return true };
        if lines.gap.is_all(xi, eta, inside) {
            continue;
        }
        let middle = sign * lines.gap.gap(xi.middle(), eta.middle());
        let Some(slopes) = lines.gap.torn_slopes(xi, eta).filter(|_| middle.is_finite()) else {
            waiting.extend(eta.halves());
            continue;
        };
        let across = slopes.across * sign;
        // Where the gap slopes one way along η, one side decides.
        let side = if across.low >= 0.0 {
            Some(eta.low)
        } else if across.high <= 0.0 {
            Some(eta.high)
        } else {
            None
        };
        let clear = match side {
            Some(place) => {
                let ends = xi.ends().map(|xi| sign * lines.gap.gap(xi, place));
                let is_clear = |slopes: BoxSlopes| least_between(ends, xi.width(), slopes.along * sign) > 0.0;
                is_clear(slopes) || lines.gap.torn_slopes(xi, Interval::of(place)).is_some_and(is_clear)
            }
            None => {
                let half = [slopes.along.magnitude() * xi.width(), across.magnitude() * eta.width()];
                middle > (half[0] + half[1]) / 2.0
            }
        };
        if clear {
            continue;
        }
        if side.is_some() || eta.width() < xi.width() {
            return false;
        }
        waiting.extend(eta.halves());
    }
    false
}

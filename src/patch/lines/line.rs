//! All slices of one line, found by bounds of the slope along it.

use super::gap::BoxSlopes;
use super::ranges::{SHALLOW, UNKNOWN, least_between};
use super::{BESIDE, Lines};
use crate::numerics::interval::Interval;
use crate::numerics::roots::{bracketed, last_where};

/// Share by which the range of an edge between two lines is widened that is to hold it on all lines between.
const WIDER: f64 = 0.125;

/// Most parts of a line.
const MOST_PARTS: usize = 4096;

/// What lies at a place of a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::patch) enum CrossingKind {
    /// The gap passes δ.
    Root,
    /// A surface ends or steps, on a circle by its number.
    Rim(usize),
    /// The line is looked at from here on, or up to here.
    Limit,
}

/// A place of a line at which it may enter or leave the patch.
#[derive(Debug, Clone, Copy)]
pub(in crate::patch) struct Crossing {
    /// \[mm\]
    pub(in crate::patch) eta: f64,
    pub(in crate::patch) kind: CrossingKind,
    /// G on both sides of a rim \[mm\], infinite where a body has no surface; the sign of G else.
    pub(super) sides: [f64; 2],
}

impl Crossing {
    /// Whether the line is in the patch on either side.
    pub(in crate::patch) fn inside(&self) -> [bool; 2] {
        self.sides.map(|side| side < 0.0)
    }
}

/// The part of a line between two places \[mm\], with G there \[mm\].
#[derive(Clone, Copy)]
struct LinePart {
    eta: Interval,
    ends: [f64; 2],
}

/// Returns the places, ascending, at which the line of ξ or σ passes δ or a surface ends or steps inside a window, and where the window
/// cuts off a slice.
///
/// Method: between two rims a part is halved until bounds prove that the gap does not pass δ in it, or once.
pub(in crate::patch) fn crossings(lines: &mut Lines<'_>, xi: f64, window: Interval) -> Vec<Crossing> {
    let over = lines.gap.within(Interval::of(xi)).cut(window);
    let mut found = Vec::new();
    if !over.has_width() {
        return found;
    }
    let off = beside_rims(lines);
    let mut rims = rims_at(lines, xi, over);
    rims.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut low = over.low;
    let limit = |eta: f64, sides: [f64; 2]| Crossing { eta, kind: CrossingKind::Limit, sides };
    let first = lines.gap.or_infinite(xi, low);
    if first < 0.0 {
        found.push(limit(low, [f64::INFINITY, first]));
    }
    for (k, &(eta, rim)) in rims.iter().enumerate() {
        let sides = [-1.0, 1.0].map(|side| beside(lines, xi, eta, side));
        if low < eta - off {
            roots(lines, xi, (Interval::new(low, eta - off), over), &mut found);
        }
        low = low.max(eta + off);
        // A root beyond the next rim is none of this side.
        let before = rims[..k].last().map_or(f64::NEG_INFINITY, |rim| rim.0);
        let after = rims.get(k + 1).map_or(f64::INFINITY, |rim| rim.0);
        found.extend(root_beside(lines, xi, eta, (-1.0, sides[0])).filter(|root| before < root.eta));
        found.push(Crossing { eta, kind: CrossingKind::Rim(rim), sides });
        found.extend(root_beside(lines, xi, eta, (1.0, sides[1])).filter(|root| root.eta < after));
    }
    if low < over.high {
        roots(lines, xi, (Interval::new(low, over.high), over), &mut found);
    }
    let last = lines.gap.or_infinite(xi, over.high);
    if last < 0.0 {
        found.push(limit(over.high, [last, f64::INFINITY]));
    }
    without_shallow(lines, xi, found)
}

/// Leaves out roots between which the gap differs from δ by rounding alone.
fn without_shallow(lines: &mut Lines<'_>, xi: f64, all: Vec<Crossing>) -> Vec<Crossing> {
    let shallow = lines.gap.roundings(SHALLOW);
    let mut found: Vec<Crossing> = Vec::with_capacity(all.len());
    for crossing in all {
        let level = found.last().is_some_and(|last| {
            last.kind == CrossingKind::Root
                && crossing.kind == CrossingKind::Root
                && lines.gap.gap(xi, Interval::new(last.eta, crossing.eta).middle()).abs() <= shallow
        });
        if level {
            found.pop();
        } else {
            found.push(crossing);
        }
    }
    found
}

/// Returns the root of the gap between a rim and the place beside it from which on a line is looked at, if there is one. `at` is G at the rim
/// on that side.
fn root_beside(lines: &mut Lines<'_>, xi: f64, eta: f64, (side, at): (f64, f64)) -> Option<Crossing> {
    let off = side * beside_rims(lines);
    let gap = lines.gap.or_infinite(xi, eta + off);
    let root = eta + off * (at / (at - gap));
    let sides = if side < 0.0 { [gap, at] } else { [at, gap] };
    ((gap < 0.0) != (at < 0.0) && root.is_finite()).then_some(Crossing {
        eta: root,
        kind: CrossingKind::Root,
        sides,
    })
}

/// Returns the distance \[mm\] from a rim at which its sides are looked at.
pub(super) fn beside_rims(lines: &Lines<'_>) -> f64 {
    BESIDE * lines.gap.placement().rolling_radius()
}

/// Returns G \[mm\] on one side of a rim; infinite where a body has no surface.
///
/// Method: from the gap and its slope at a place beside it; farther out the surface may fold back. Rounding ends no surface at two places.
pub(super) fn beside(lines: &mut Lines<'_>, xi: f64, eta: f64, side: f64) -> f64 {
    let off = side * beside_rims(lines);
    let goes_on = !lines.gap.gap(xi, eta + 2.0 * off).is_nan();
    let near = lines.gap.at(xi, eta + off).filter(|near| goes_on && near.across.is_finite());
    near.map_or(f64::INFINITY, |near| near.gap - off * near.across)
}

/// Returns the places inside a range of η \[mm\] at which the line of ξ or σ meets ends and steps of the surfaces, with their numbers.
pub(super) fn rims_at(lines: &Lines<'_>, xi: f64, over: Interval) -> Vec<(f64, usize)> {
    let at = lines.gap.xi_and_run(xi).0;
    let all = (0..lines.rims.count()).map(|rim| (lines.rims.met(rim, at), rim));
    all.filter(|(eta, _)| over.surrounds(*eta)).collect()
}

/// Returns η \[mm\] of a rim on the line of ξ or σ.
pub(super) fn rim_on(lines: &Lines<'_>, rim: usize, xi: f64) -> f64 {
    lines.rims.met(rim, lines.gap.xi_and_run(xi).0)
}

/// Returns η \[mm\] of the last place with a surface on one side of a rim, which rounding may end a little before it.
pub(super) fn end_on(lines: &mut Lines<'_>, rim: usize, xi: f64, side: f64) -> f64 {
    let (eta, off) = (rim_on(lines, rim, xi), side * beside_rims(lines));
    let mut is_on = |eta: f64| !lines.gap.gap(xi, eta).is_nan();
    if is_on(eta) || !is_on(eta + off) { eta } else { last_where(is_on, eta + off, eta) }
}

/// Returns the range of η \[mm\] that is to hold a crossing on all lines between two, from its places on both.
pub(super) fn held(lines: &Lines<'_>, xi: Interval, kind: CrossingKind, [a, b]: [f64; 2]) -> Interval {
    let range = Interval::between(a, b);
    range.grown(match kind {
        CrossingKind::Root => WIDER * (range.width() + xi.width()),
        // So far from a rim its sides are looked at.
        CrossingKind::Rim(_) => WIDER * range.width() + 2.0 * beside_rims(lines),
        CrossingKind::Limit => 0.0,
    })
}

/// Appends the places in a part of the range of a line \[mm\] at which the gap passes δ, where no surface ends or steps.
fn roots(lines: &mut Lines<'_>, xi: f64, (part, over): (Interval, Interval), found: &mut Vec<Crossing>) {
    let ends = part.ends().map(|eta| lines.gap.or_infinite(xi, eta));
    let mut waiting = vec![LinePart { eta: part, ends }];
    let mut count = 0;
    while let Some(LinePart { eta, ends }) = waiting.pop() {
        count += 1;
        let passes = (ends[0] < 0.0) != (ends[1] < 0.0);
        let slopes = lines.gap.torn_slopes(Interval::of(xi), eta);
        let shortest = shortest_part(lines, over, slopes.is_some());
        match crossed(lines, xi, (LinePart { eta, ends }, slopes)) {
            Some(false) => continue,
            None if eta.width() > shortest && count < MOST_PARTS => {
                let middle = lines.gap.or_infinite(xi, eta.middle());
                let [lower, upper] = eta.halves();
                waiting.push(LinePart { eta: upper, ends: [middle, ends[1]] });
                waiting.push(LinePart { eta: lower, ends: [ends[0], middle] });
            }
            _ if passes => {
                let root = root(lines, xi, LinePart { eta, ends });
                found.push(Crossing { eta: root, kind: CrossingKind::Root, sides: ends });
            }
            _ => {}
        }
    }
}

/// Returns the width \[mm\] down to which a part of a range of η is halved: where a surface stands upright no bounds are known, and halves
/// prove no more.
pub(super) fn shortest_part(lines: &Lines<'_>, over: Interval, is_known: bool) -> f64 {
    if is_known { lines.narrowest() } else { UNKNOWN * over.width() }
}

/// Returns whether the gap passes δ in a part of a line once, or nowhere; `None` where bounds prove neither.
fn crossed(
    lines: &Lines<'_>,
    xi: f64,
    (LinePart { eta, ends }, slopes): (LinePart, Option<BoxSlopes>),
) -> Option<bool> {
    let inside = ends.map(|gap| gap < 0.0);
    let line = Interval::of(xi);
    let finite = ends.iter().all(|gap| gap.is_finite());
    // Between two rims a body has a surface all over, or nowhere.
    if !ends.iter().any(|gap| gap.is_finite()) {
        return Some(false);
    }
    let Some(slopes) = slopes.filter(|_| finite) else {
        return (inside[0] == inside[1] && lines.gap.is_all(line, eta, inside[0])).then_some(false);
    };
    let (across, width) = (slopes.across, eta.width());
    let monotone = across.low >= 0.0 || across.high <= 0.0;
    let shallow = lines.gap.roundings(SHALLOW);
    match inside {
        _ if monotone => Some(inside[0] != inside[1]),
        [false, false] => (least_between(ends, width, across) > -shallow).then_some(false),
        [true, true] => (least_between(ends.map(|gap| -gap), width, -across) > -shallow).then_some(false),
        _ => None,
    }
}

/// Returns the η \[mm\] at which the gap passes δ in a part of a line.
fn root(lines: &mut Lines<'_>, xi: f64, LinePart { eta, ends }: LinePart) -> f64 {
    let [low, high] = eta.ends();
    leaves(lines, xi, if ends[0] < 0.0 { [low, high] } else { [high, low] })
}

/// Returns the η \[mm\] at which a line leaves the patch between a place in it and one that is not: at a root of the gap, or where a
/// surface ends.
pub(super) fn leaves(lines: &mut Lines<'_>, xi: f64, [on, off]: [f64; 2]) -> f64 {
    if let Some(root) = bracketed(|eta| lines.gap.gap(xi, eta), on, off) {
        return root;
    }
    let end = last_where(|eta| lines.gap.has_surface(xi, eta), on, off);
    if lines.gap.gap(xi, end) < 0.0 {
        return end;
    }
    let root = bracketed(|eta| lines.gap.gap(xi, eta), on, end);
    root.unwrap_or_else(|| last_where(|eta| lines.gap.gap(xi, eta) < 0.0, on, off))
}

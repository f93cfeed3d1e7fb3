//! Single lines laid over a range of ξ, joined to bands, and where these end.

use super::answers::answer;
use super::lanes::{edge_between, line};
use super::least::lowest_within;
use super::line::{CrossingKind, beside, beside_rims, end_on, rim_on};
use super::ranges::STEPS;
use super::{LEVELLED, Lines, SECANTS};
use crate::numerics::interval::Interval;
use crate::numerics::roots::{bracketed, last_where};
use crate::patch::band::Band;
use crate::patch::end::End;
use crate::patch::fibres::{Lane, LaneEnd, LaneRow, LineSlice, SlicedLine, joined, refined};

/// Distance of two lines, in roundings of R, at which none is laid between them: slices begin, end, divide or join there.
const NEAREST: f64 = 1000.0;

/// Distance from a tip or saddle, as a share of that, at which lines are laid on both sides of it.
const BESIDE_EVENT: f64 = 0.4;

/// Distance, as a share of R, over which a slice that has no partner on a line next to it is followed to its tip.
const TO_TIP: f64 = 2e-9;

/// Finds the bands of a range of ξ or σ inside a window from single lines; what bounds them at its ends is `ends`.
pub(in crate::patch) fn lanes(
    lines: &mut Lines<'_>,
    over: Interval,
    window: Interval,
    ends: [End; 2],
) -> Vec<(Band, Lane)> {
    // A step belongs to the range on its left.
    let torn = |xi: f64| lines.gap.torn(Interval::ALL).contains(&xi);
    let from = if torn(over.low) { over.low.next_up() } else { over.low };
    let mut places = vec![from, over.high];
    if over.surrounds(0.0) {
        places.insert(1, 0.0);
    }
    let first = places.into_iter().map(|xi| line(lines, xi, window)).collect();
    let between = |lines: &mut Lines<'_>, pair: [&SlicedLine; 2]| {
        let xi = event(lines, pair).unwrap_or(pair[0].xi + (pair[1].xi - pair[0].xi) / 2.0);
        line(lines, xi, window)
    };
    let apart = lines.gap.roundings(NEAREST);
    let all = refined(lines, first, |_, _| apart, |lines, pair| answer(lines, pair, window), between);
    let at_ends = [from, over.high];
    let near = to_tip(lines);
    let met = |pair: &[SlicedLine]| {
        let [before, line] = [&pair[0], &pair[1]];
        let both = if line.follows {
            [Vec::new(), Vec::new()]
        } else {
            [[before, line], [line, before]].map(|pair| saddles(lines, pair, near))
        };
        both.concat()
    };
    let saddles: Vec<Vec<[f64; 2]>> = all.windows(2).map(met).collect();
    let mut lanes = joined((&all, &saddles), window, |xi, slice, side| {
        if xi == at_ends[side] {
            return LaneEnd { xi: over[side], side: slice.eta, end: ends[side] };
        }
        tip(lines, xi, slice).unwrap_or_else(|| end(lines, xi, slice, (side, window)))
    });
    for (band, lane) in &mut lanes {
        end_at_tips(band, lane);
        part_at_corners(lines, band, lane, window);
    }
    lanes
}

/// Adds the tips of a band to its lane, so that its edges meet there.
fn end_at_tips(band: &Band, lane: &mut Lane) {
    let [Some(first), Some(last)] = [lane.rows.first().copied(), lane.rows.last().copied()] else { return };
    let is_tip = |end: usize| !band.sides[end].has_width();
    let at = |end: usize, slice: LineSlice, follows: bool| {
        let eta = band.sides[end];
        LaneRow { xi: band.xi[end], slice: LineSlice { eta, ..slice }, follows }
    };
    if is_tip(1) && last.xi < band.xi.high {
        lane.rows.push(at(1, last.slice, true));
    }
    if is_tip(0) && band.xi.low < first.xi {
        lane.rows[0].follows = true;
        lane.rows.insert(0, at(0, first.slice, false));
    }
}

/// Returns ξ or σ \[mm\] next to a place between two lines where a slice without a partner has its tip, or where two slices meet, on the
/// side that is farther from both.
fn event(lines: &mut Lines<'_>, pair: [&SlicedLine; 2]) -> Option<f64> {
    let between = Interval::new(pair[0].xi, pair[1].xi);
    let beside = BESIDE_EVENT * lines.gap.roundings(NEAREST);
    for side in 0..2 {
        let (own, other) = (pair[side], pair[1 - side]);
        let alone = |slice: &&LineSlice| !other.slices.iter().any(|other| other.eta.overlaps(slice.eta));
        let tip = own.slices.iter().find(alone).copied();
        let at = match tip {
            Some(slice) => tip_from(lines, own.xi, &slice, between.width()).map(|tip| tip.xi),
            None => saddles(lines, [own, other], between.width()).first().map(|[xi, _]| *xi),
        };
        let Some(at) = at.filter(|at| between.surrounds(*at)) else { continue };
        let next = if (at - own.xi).abs() > 2.0 * beside { own.xi } else { other.xi };
        return Some(at + beside.copysign(next - at)).filter(|at| between.surrounds(*at));
    }
    None
}

/// Returns ξ or σ and η \[mm\], up to `within` \[mm\] from a line, at which two of its slices meet that overlap one of another line.
fn saddles(lines: &mut Lines<'_>, [own, other]: [&SlicedLine; 2], within: f64) -> Vec<[f64; 2]> {
    let meets = |pair: &&[LineSlice]| {
        let one = |other: &LineSlice| pair.iter().all(|slice| slice.eta.overlaps(other.eta));
        other.slices.iter().any(one)
    };
    let saddle = |pair: &[LineSlice]| match [pair[0].kinds[1], pair[1].kinds[0]] {
        [CrossingKind::Root, CrossingKind::Root] => {
            saddle_from(lines, own.xi, Interval::new(pair[0].eta.high, pair[1].eta.low), within)
        }
        [CrossingKind::Rim(one), CrossingKind::Rim(other)] => {
            joined_rims(lines, own.xi, [one, other], within)
        }
        _ => None,
    };
    own.slices.windows(2).filter(meets).filter_map(saddle).collect()
}

/// Returns ξ or σ and η \[mm\], up to `within` \[mm\] from a line, at which it would touch the circle of which two rims are parts.
fn joined_rims(lines: &Lines<'_>, xi: f64, rims: [usize; 2], within: f64) -> Option<[f64; 2]> {
    let [place, eta] = lines.rims.joined(rims)?;
    let at = lines.gap.sigma(place);
    ((at - xi).abs() <= within).then_some([at, eta])
}

/// Adds rows to a lane, and corners to its band, where an edge passes from a rim to a root of the gap.
fn part_at_corners(lines: &mut Lines<'_>, band: &mut Band, lane: &mut Lane, window: Interval) {
    let rows = std::mem::take(&mut lane.rows);
    for mut row in rows {
        if let Some(last) = lane.rows.last().copied().filter(|last| last.slice.kinds != row.slice.kinds) {
            let xi =
                corner(lines, &last, &row).unwrap_or(row.xi).clamp(last.xi.next_up(), row.xi.next_down());
            let eta = [0, 1].map(|side| edge_between(lines, xi, [&last, &row], (side, window)));
            let at = |kinds| LineSlice { eta: eta.into(), kinds, ..row.slice };
            lane.rows.push(LaneRow { xi, slice: at(last.slice.kinds), follows: true });
            lane.rows.push(LaneRow { xi, slice: at(row.slice.kinds), follows: false });
            band.corners.push(xi);
            row.follows = true;
        }
        lane.rows.push(row);
    }
}

/// Returns ξ or σ \[mm\] between two rows at which an edge passes from a rim to a root of the gap.
fn corner(lines: &mut Lines<'_>, last: &LaneRow, row: &LaneRow) -> Option<f64> {
    let changed = (0..2).find(|&side| last.slice.kinds[side] != row.slice.kinds[side])?;
    let rims = [last, row].map(|row| row.slice.kinds[changed]);
    let rim =
        rims.into_iter().find_map(|mark| if let CrossingKind::Rim(rim) = mark { Some(rim) } else { None })?;
    tip_on_rim(lines, row.xi, rim, [1.0, -1.0][changed]).map(|tip| tip.xi)
}

/// Returns the tip next to a slice that has no partner on the line beside it; `None` where a body ends.
fn tip(lines: &mut Lines<'_>, xi: f64, slice: &LineSlice) -> Option<LaneEnd> {
    if let [CrossingKind::Rim(one), CrossingKind::Rim(other)] = slice.kinds
        && let Some([at, eta]) = joined_rims(lines, xi, [one, other], to_tip(lines))
    {
        return Some(LaneEnd { xi: at, side: Interval::of(eta), end: End::ProfileEnd });
    }
    for side in 0..2 {
        let found = match slice.kinds[side] {
            CrossingKind::Rim(rim) => tip_on_rim(lines, xi, rim, [1.0, -1.0][side]),
            CrossingKind::Limit => tip_on_limit(lines, xi, slice.eta[side]),
            CrossingKind::Root => None,
        };
        if found.is_some() {
            return found;
        }
    }
    tip_from(lines, xi, slice, to_tip(lines))
}

fn to_tip(lines: &Lines<'_>) -> f64 {
    TO_TIP * lines.gap.placement().rolling_radius()
}

/// Returns the tip of a slice between roots, up to `within` \[mm\] from its line.
fn tip_from(lines: &mut Lines<'_>, xi: f64, slice: &LineSlice, within: f64) -> Option<LaneEnd> {
    if slice.kinds != [CrossingKind::Root; 2] {
        return None;
    }
    let [mut eta, depth] = lowest_within(lines, xi, slice.eta);
    let lowest = |lines: &mut Lines<'_>, at: f64| {
        eta = lines.lowest(at, eta);
        eta
    };
    let [at, eta] = level_from(lines, [xi, depth], lowest, within)?;
    let around = slice.eta.grown(slice.eta.width() + within);
    around.contains(eta).then(|| LaneEnd { xi: at, side: Interval::of(eta), end: End::Tip })
}

/// Returns ξ or σ and η \[mm\] of the saddle at which two slices of a line meet, up to `within` \[mm\] from there; `between` lies
/// between both.
fn saddle_from(lines: &mut Lines<'_>, xi: f64, between: Interval, within: f64) -> Option<[f64; 2]> {
    let highest = |lines: &mut Lines<'_>, at: f64| {
        bracketed(|eta| lines.gap.across(at, eta), between.low, between.high).unwrap_or(f64::NAN)
    };
    let eta = highest(lines, xi);
    let depth = lines.gap.gap(xi, eta);
    level_from(lines, [xi, depth], highest, within)
}

/// Returns the place up to `within` \[mm\] from a line at which the gap is δ along turning places, which `turn` gives for each line.
/// `depth` is the gap on this line.
///
/// Method: secant steps; at kinks turning places follow the kink.
fn level_from<'a>(
    lines: &mut Lines<'a>,
    [xi, depth]: [f64; 2],
    mut turn: impl FnMut(&mut Lines<'a>, f64) -> f64,
    within: f64,
) -> Option<[f64; 2]> {
    let (mut last, mut before, mut at) = (xi, depth, xi + beside_rims(lines));
    let apart = lines.gap.roundings(NEAREST);
    let level = apart.max(LEVELLED * depth.abs());
    for _ in 0..SECANTS {
        let eta = turn(lines, at);
        let depth = lines.gap.gap(at, eta);
        let step = depth * ((at - last) / (depth - before));
        (last, before) = (at, depth);
        at -= step;
        if (at - xi).abs() > within || at.is_nan() {
            return None;
        }
        if step.abs() <= apart {
            let eta = turn(lines, at);
            // Where a turning place is lost, a step is short, too.
            return (lines.gap.gap(at, eta).abs() <= level).then_some([at, eta]);
        }
    }
    None
}

/// Returns the last line next to one on which a slice that has no partner on a side is still found: there a body ends, rims meet, or one
/// leaves the window.
fn end(lines: &mut Lines<'_>, xi: f64, slice: &LineSlice, (side, window): (usize, Interval)) -> LaneEnd {
    let beside = to_tip(lines);
    let around = slice.eta.grown(slice.eta.width() + beside);
    let mut met = |xi: f64| line(lines, xi, window).slices.into_iter().find(|last| last.eta.meets(around));
    let at = last_where(|xi| met(xi).is_some(), xi, xi + [-beside, beside][side]);
    let end = if slice.kinds.contains(&CrossingKind::Limit) { End::Window } else { End::ProfileEnd };
    LaneEnd { xi: at, side: met(at).unwrap_or(*slice).eta, end }
}

/// Returns the tip next to a slice at which a rim passes δ, with the patch on one side of it.
fn tip_on_rim(lines: &mut Lines<'_>, xi: f64, rim: usize, side: f64) -> Option<LaneEnd> {
    let at = passed(xi, to_tip(lines), |xi| {
        let eta = rim_on(lines, rim, xi);
        beside(lines, xi, eta, side)
    })?;
    Some(LaneEnd { xi: at, side: Interval::of(end_on(lines, rim, at, side)), end: End::Tip })
}

/// Returns the end next to a slice at which the patch leaves the window over one η.
fn tip_on_limit(lines: &mut Lines<'_>, xi: f64, eta: f64) -> Option<LaneEnd> {
    let at = passed(xi, to_tip(lines), |xi| lines.gap.or_infinite(xi, eta))?;
    Some(LaneEnd { xi: at, side: Interval::of(eta), end: End::Window })
}

/// Returns ξ or σ \[mm\] up to `within` \[mm\] from a place at which a gap along a curve passes 0.
fn passed(xi: f64, within: f64, mut gap: impl FnMut(f64) -> f64) -> Option<f64> {
    let mut at = xi;
    for _ in 0..STEPS {
        let slope = (gap(at + within) - gap(at - within)) / (2.0 * within);
        at -= gap(at) / slope;
        if !slope.is_finite() || (at - xi).abs() > within {
            return None;
        }
    }
    Some(at)
}

//! Finds which branch counts at each ξ: the outer one, unless it belongs to another head.

use std::ops::Range;
use std::sync::OnceLock;

use super::branch::Branch;
use super::points::BranchPoint;
use crate::numerics::interval::Interval;
use crate::numerics::roots::bracketed;
use crate::profile::side::Side;

/// Least distance \[mm\] along ζ by which a sheet begins in front of the sheet of C if it is that of another head, with a
/// flangeway between. Flanges are at least 20 mm thick; lips that hang over a worn head stand off by less than 5 mm.
const LEAST_FLANGEWAY: f64 = 10.0;

/// A closed interval of ξ over which one branch counts.
#[derive(Debug, Clone)]
pub struct Piece {
    /// Interval of ξ \[mm\].
    pub xi: Interval,
    /// Index of the branch.
    pub branch: usize,
    /// ζ \[mm\] at the two ends, to a rounding of the profile's extent.
    pub heights: [f64; 2],
    /// The two ends as points of the branch, with their ζ \[mm\], once they were asked for.
    pub(super) ends: OnceLock<Box<[(BranchPoint, f64); 2]>>,
    /// Bounds of ζ′, once they were asked for.
    pub(super) slopes: OnceLock<Interval>,
}

/// Returns the outer envelope of all branches, in order of ξ. With a rounding of their ends \[mm\] the frame is that of a contact: other
/// heads then count only where the sheet through C has ended, and an end beside C is at C.
pub(super) fn pieces(branches: &[Branch], side: Side, at_contact: Option<f64>) -> Vec<Piece> {
    let with_heights = |(xi, branch): (Interval, usize)| {
        let whole = &branches[branch];
        let height = |end: usize| {
            let known = whole.heights.filter(|_| xi[end] == whole.xi[end]);
            known.map_or_else(|| whole.height(xi[end]), |heights| heights[end])
        };
        let heights = [height(0), height(1)];
        Piece { xi, branch, heights, ends: OnceLock::new(), slopes: OnceLock::new() }
    };
    let mut outer = intervals(branches, side);
    if at_contact.is_some() {
        outer = without_other_heads(branches, outer);
    }
    let mut pieces: Vec<Piece> = outer.into_iter().map(with_heights).collect();
    if let Some(rounding) = at_contact {
        reach_origin(&mut pieces, rounding);
    }
    pieces
}

/// Replaces the sheets of other heads by the sheet through C, as far as that goes.
fn without_other_heads(branches: &[Branch], outer: Vec<(Interval, usize)>) -> Vec<(Interval, usize)> {
    let Some(own) = sheet_at_origin(branches) else { return outer };
    if outer.iter().all(|(_, branch)| own.contains(branch)) {
        return outer;
    }
    let sheet = &branches[own.clone()];
    let reach = Interval::new(sheet[0].xi.low, sheet[sheet.len() - 1].xi.high);
    let mut other_head = vec![false; outer.len()];
    let right = outer.partition_point(|(xi, _)| xi.high <= 0.0);
    // Away from C in both directions; the interval over C itself is visited from either side.
    let ways: [(Vec<usize>, usize); 2] =
        [((right..outer.len()).collect(), 0), ((0..(right + 1).min(outer.len())).rev().collect(), 1)];
    for (order, near) in ways {
        // Whether the sheets since C's own was left are those of another head.
        let mut other = None;
        for k in order {
            let (xi, branch) = outer[k];
            let at = if xi.contains(0.0) { 0.0 } else { xi[near] };
            if own.contains(&branch) || !reach.contains(at) {
                other = None;
                continue;
            }
            other_head[k] |=
                *other.get_or_insert_with(|| step(&branches[branch], sheet, at) > LEAST_FLANGEWAY);
        }
    }
    let mut out = Vec::with_capacity(outer.len());
    for ((xi, branch), other_head) in outer.into_iter().zip(other_head) {
        if !other_head {
            push(&mut out, xi, branch);
            continue;
        }
        let own_part = xi.cut(reach);
        push(&mut out, Interval::new(xi.low, own_part.low), branch);
        for k in own.clone() {
            push(&mut out, own_part.cut(branches[k].xi), k);
        }
        push(&mut out, Interval::new(own_part.high, xi.high), branch);
    }
    out
}

/// Returns the distance \[mm\] along ζ of a branch from a sheet at ξ; 0 where the sheet has a hole there.
fn step(branch: &Branch, sheet: &[Branch], xi: f64) -> f64 {
    let own = sheet.iter().find(|own| own.xi.contains(xi));
    own.map_or(0.0, |own| (branch.height(xi) - own.height(xi)).abs())
}

/// Returns the range of the branches that go on from the one nearest to the origin without a break; `None` without branches.
fn sheet_at_origin(branches: &[Branch]) -> Option<Range<usize>> {
    let beside = |k: usize| branches[k].xi.nearest(0.0);
    let distance = |k: usize| beside(k).hypot(branches[k].height(beside(k)));
    let first = (0..branches.len()).min_by(|&i, &j| beside(i).abs().total_cmp(&beside(j).abs()))?;
    let mut nearest = (first, distance(first));
    for k in 0..branches.len() {
        // No point of a branch is nearer than its ξ.
        if beside(k).abs() < nearest.1 && distance(k) < nearest.1 {
            nearest = (k, distance(k));
        }
    }
    let (nearest, _) = nearest;
    let joined = |k: usize| branches[k].xi.high == branches[k + 1].xi.low;
    let first = (0..nearest).rev().take_while(|&k| joined(k)).last().unwrap_or(nearest);
    let last = (nearest..branches.len() - 1).take_while(|&k| joined(k)).last().map_or(nearest, |k| k + 1);
    Some(first..last + 1)
}

/// If no piece holds the origin, moves the ends within `rounding` \[mm\] of it there. C lies on its profile, but where it is the profile's end,
/// the turn into the contact frame may put that end beside it.
fn reach_origin(pieces: &mut [Piece], rounding: f64) {
    let next = pieces.partition_point(|piece| piece.xi.high < 0.0);
    let (before, after) = pieces.split_at_mut(next);
    if after.first().is_some_and(|piece| piece.xi.low <= 0.0) {
        return;
    }
    if let Some(piece) = before.last_mut().filter(|piece| piece.xi.high >= -rounding) {
        piece.xi.high = 0.0;
    }
    if let Some(piece) = after.first_mut().filter(|piece| piece.xi.low <= rounding) {
        piece.xi.low = 0.0;
    }
}

/// Returns the indices of the pieces that begin at another ξ than where the piece before ends, or whose heights there differ by more
/// than `rounding` \[mm\].
pub(super) fn steps(pieces: &[Piece], rounding: f64) -> Vec<usize> {
    let joins = |[before, piece]: [&Piece; 2]| {
        before.xi.high == piece.xi.low && (piece.heights[0] - before.heights[1]).abs() <= rounding
    };
    (1..pieces.len()).filter(|&k| !joins([&pieces[k - 1], &pieces[k]])).collect()
}

/// Returns the intervals in order of ξ, each with the index of the outer branch over it.
fn intervals(branches: &[Branch], side: Side) -> Vec<(Interval, usize)> {
    if branches.is_sorted_by(|before, branch| before.xi.high <= branch.xi.low) {
        let mut out = Vec::with_capacity(branches.len());
        branches.iter().enumerate().for_each(|(k, branch)| push(&mut out, branch.xi, k));
        return out;
    }
    let mut ends: Vec<f64> = branches.iter().flat_map(|b| b.xi.ends()).collect();
    ends.sort_by(f64::total_cmp);
    ends.dedup();
    let mut order: Vec<usize> = (0..branches.len()).collect();
    order.sort_by(|&a, &b| branches[a].xi.low.total_cmp(&branches[b].xi.low));
    let mut waiting = order.into_iter().peekable();
    let mut active: Vec<usize> = Vec::new();
    let mut out = Vec::new();
    for pair in ends.windows(2) {
        let interval = Interval::new(pair[0], pair[1]);
        while let Some(&next) = waiting.peek().filter(|&&b| branches[b].xi.low <= interval.low) {
            active.push(next);
            waiting.next();
        }
        active.retain(|&b| branches[b].xi.high >= interval.high);
        outermost(branches, &active, interval, side, &mut out);
    }
    out
}

/// Splits one interval, which every active branch spans, at the abscissae where the outer branch changes.
fn outermost(
    branches: &[Branch],
    active: &[usize],
    xi: Interval,
    side: Side,
    out: &mut Vec<(Interval, usize)>,
) {
    let outer = |xi: f64| {
        active.iter().copied().min_by(|&i, &j| {
            let order = branches[i].height(xi).total_cmp(&branches[j].height(xi));
            if side == Side::Wheel { order } else { order.reverse() }
        })
    };
    let (Some(first), Some(last)) = (outer(xi.low), outer(xi.high)) else { return };
    let middle = xi.middle();
    if active.len() == 1 || middle <= xi.low || middle >= xi.high {
        return push(out, xi, first);
    }
    if first == last {
        // Sheets of a chain that does not cross itself keep their order. Where they meet at an end, rounding decides.
        return push(out, xi, outer(middle).unwrap_or(first));
    }
    let difference = |xi: f64| branches[first].height(xi) - branches[last].height(xi);
    let cut = bracketed(difference, xi.low, xi.high).unwrap_or(middle);
    push(out, Interval::new(xi.low, cut), first);
    push(out, Interval::new(cut, xi.high), last);
}

/// Appends an interval. If the last interval has the same branch and ends there, it is extended instead.
fn push(out: &mut Vec<(Interval, usize)>, xi: Interval, branch: usize) {
    match out.last_mut() {
        Some((before, last)) if *last == branch && before.high == xi.low => before.high = xi.high,
        _ if xi.has_width() => out.push((xi, branch)),
        _ => {}
    }
}

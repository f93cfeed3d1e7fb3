//! Finds which branch is the outer one at each ξ.

use super::branch::Branch;
use super::points::BranchPoint;
use crate::numerics::roots::bracketed;
use crate::profile::side::Side;

/// A closed interval of ξ over which one branch is the outer one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// Interval of ξ \[mm\].
    pub xi: [f64; 2],
    /// Index of the outer branch.
    pub branch: usize,
    /// The two ends of the interval as points of the branch, with their ζ \[mm\].
    pub ends: [(BranchPoint, f64); 2],
}

/// Returns the outer envelope of all branches, in order of ξ.
pub(super) fn pieces(branches: &[Branch], side: Side) -> Vec<Piece> {
    let with_ends =
        |(xi, branch): ([f64; 2], usize)| Piece { xi, branch, ends: xi.map(|xi| branches[branch].point(xi)) };
    intervals(branches, side).into_iter().map(with_ends).collect()
}

/// Returns the indices of the pieces that do not begin where the piece before ends, with heights equal to `rounding` \[mm\].
pub(super) fn steps(pieces: &[Piece], rounding: f64) -> Vec<usize> {
    let joins = |[before, piece]: [&Piece; 2]| {
        before.xi[1] == piece.xi[0] && (piece.ends[0].1 - before.ends[1].1).abs() <= rounding
    };
    (1..pieces.len()).filter(|&k| !joins([&pieces[k - 1], &pieces[k]])).collect()
}

/// Returns the intervals in order of ξ, each with the index of the outer branch over it.
fn intervals(branches: &[Branch], side: Side) -> Vec<([f64; 2], usize)> {
    let mut ends: Vec<f64> = branches.iter().flat_map(|b| b.xi).collect();
    ends.sort_by(f64::total_cmp);
    ends.dedup();
    let mut order: Vec<usize> = (0..branches.len()).collect();
    order.sort_by(|&a, &b| branches[a].xi[0].total_cmp(&branches[b].xi[0]));
    let mut waiting = order.into_iter().peekable();
    let mut active: Vec<usize> = Vec::new();
    let mut out = Vec::new();
    for pair in ends.windows(2) {
        let interval = [pair[0], pair[1]];
        while let Some(&next) = waiting.peek().filter(|&&b| branches[b].xi[0] <= interval[0]) {
            active.push(next);
            waiting.next();
        }
        active.retain(|&b| branches[b].xi[1] >= interval[1]);
        outermost(branches, &active, interval, side, &mut out);
    }
    out
}

/// Splits one interval, which every active branch spans, at the abscissae where the outer branch changes.
fn outermost(
    branches: &[Branch],
    active: &[usize],
    [a, b]: [f64; 2],
    side: Side,
    out: &mut Vec<([f64; 2], usize)>,
) {
    let outer = |xi: f64| {
        active.iter().copied().min_by(|&i, &j| {
            let order = branches[i].height(xi).total_cmp(&branches[j].height(xi));
            if side == Side::Wheel { order } else { order.reverse() }
        })
    };
    let (Some(first), Some(last)) = (outer(a), outer(b)) else { return };
    let middle = a + (b - a) / 2.0;
    if active.len() == 1 || middle <= a || middle >= b {
        return push(out, [a, b], first);
    }
    if first == last {
        // Sheets of a chain that does not cross itself keep their order. Where they meet at an end, rounding decides.
        return push(out, [a, b], outer(middle).unwrap_or(first));
    }
    let difference = |xi: f64| branches[first].height(xi) - branches[last].height(xi);
    let cut = bracketed(difference, a, b).unwrap_or(middle);
    push(out, [a, cut], first);
    push(out, [cut, b], last);
}

/// Appends an interval. If the last interval has the same branch and ends there, it is extended instead.
fn push(out: &mut Vec<([f64; 2], usize)>, xi: [f64; 2], branch: usize) {
    match out.last_mut() {
        Some((before, last)) if *last == branch && before[1] == xi[0] => before[1] = xi[1],
        _ if xi[0] < xi[1] => out.push((xi, branch)),
        _ => {}
    }
}

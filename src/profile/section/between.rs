//! Finds the abscissae where two branches are parallel, the stationary points of the gap between them, and where one branch is
//! parallel to a line.

use super::branch::{ArcBranch, Branch, BranchShape};
use crate::numerics::polynomial::{derivative, range, value};
use crate::numerics::roots::bracketed;

/// Most bisections of an interval in which the bounds decide nothing. 2⁻⁴⁸ of the interval is below rounding.
const DEEPEST: u32 = 48;

/// Number of points at which slopes are compared. It is also the number of roundings by which equal slopes may differ,
/// because polynomials in two frames are rounded a few times each.
const SAMPLES: u32 = 8;
const SLOPE_ROUNDINGS: f64 = 8.0;

/// Returns all ξ inside (a, b) where ζ^W(ξ) − ζ^R(ξ) is stationary, ascending. `a` and `b` \[mm\] must be within both
/// branches.
///
/// Method: for lines and arcs the sines of the two tangent angles are linear in ξ, so that there is at most one such point,
/// in closed form. Otherwise interval bounds of both derivatives prove that there is no point or exactly one; where they
/// prove neither, the interval is bisected, so that no point is missed. Degenerate case: if the gap changes by less than
/// its rounding, the result is the middle of the interval. Cost: nearly equal polynomials take up to some 10⁴ bisections.
pub fn stationary_points(rail: &Branch, wheel: &Branch, a: f64, b: f64) -> Vec<f64> {
    if let (BranchShape::Arc(rail), BranchShape::Arc(wheel)) = (&rail.shape, &wheel.shape) {
        return parallel(rail, wheel).filter(|&xi| xi > a && xi < b).into_iter().collect();
    }
    let mut found = Vec::new();
    if a < b {
        let middle = a + (b - a) / 2.0;
        let scale = (b - a).max(rail.height(middle).abs());
        search(rail, wheel, [a, b], DEEPEST, f64::EPSILON * scale, &mut found);
    }
    found
}

/// Returns all ξ inside (a, b) \[mm\] where a branch has the direction of a line \[n_ξ, n_ζ\], ascending.
///
/// Method: on an arc the sine of the tangent angle is linear in ξ. On a polynomial bounds of the component across the line and
/// of its derivative prove that there is no such place or exactly one; where they prove neither, the interval is bisected.
pub fn parallel_to(branch: &Branch, n: [f64; 2], [a, b]: [f64; 2]) -> Vec<f64> {
    let mut found = Vec::new();
    match &branch.shape {
        BranchShape::Arc(arc) => {
            let sine = n[1] * n[0].signum() / n[0].hypot(n[1]);
            found.push(arc.anchor[0] + (sine - arc.sin) / arc.curvature);
        }
        BranchShape::Polynomial(p) => {
            let (dx, dz) = (derivative(&p.xi), derivative(&p.zeta));
            let term = |c: &[f64], k: usize| c.get(k).copied().unwrap_or(0.0);
            let across: Vec<f64> =
                (0..dx.len().max(dz.len())).map(|k| term(&dx, k) * n[1] - term(&dz, k) * n[0]).collect();
            roots(&across, [p.parameter(a), p.parameter(b)], DEEPEST, &mut found);
            found.iter_mut().for_each(|t| *t = value(&p.xi, *t));
        }
    }
    found.retain(|&xi| a < xi && xi < b);
    found
}

/// Adds the roots of a polynomial in an interval at which its sign changes, ascending.
fn roots(c: &[f64], [a, b]: [f64; 2], depth: u32, found: &mut Vec<f64>) {
    let [low, high] = range(c, a, b);
    if low > 0.0 || high < 0.0 {
        return;
    }
    let [falls, climbs] = range(&derivative(c), a, b);
    let middle = a + (b - a) / 2.0;
    if falls > 0.0 || climbs < 0.0 || depth == 0 || middle <= a || middle >= b {
        found.extend(bracketed(|t| value(c, t), a, b));
        return;
    }
    roots(c, [a, middle], depth - 1, found);
    roots(c, [middle, b], depth - 1, found);
}

/// Solves S_R + κ_R (ξ − ξ_R) = S_W + κ_W (ξ − ξ_W) for ξ.
fn parallel(rail: &ArcBranch, wheel: &ArcBranch) -> Option<f64> {
    let turn = wheel.curvature - rail.curvature;
    if turn == 0.0 {
        return None;
    }
    // The abscissa is measured from the rail's anchor, so that two anchors at C give exactly 0.
    let apart = wheel.anchor[0] - rail.anchor[0];
    Some(rail.anchor[0] + (rail.sin - wheel.sin + wheel.curvature * apart) / turn)
}

fn search(rail: &Branch, wheel: &Branch, [a, b]: [f64; 2], depth: u32, rounding: f64, found: &mut Vec<f64>) {
    let [slope_r, second_r] = rail.derivative_bounds(a, b);
    let [slope_w, second_w] = wheel.derivative_bounds(a, b);
    if slope_w[0] > slope_r[1] || slope_w[1] < slope_r[0] {
        return;
    }
    let slope = |xi: f64| wheel.chord_slope(xi, xi) - rail.chord_slope(xi, xi);
    if second_w[0] > second_r[1] || second_w[1] < second_r[0] {
        found.extend(bracketed(slope, a, b).filter(|&xi| xi > a && xi < b));
        return;
    }
    let middle = a + (b - a) / 2.0;
    if agree(rail, wheel, a, b) {
        found.push(middle);
        return;
    }
    // The mean value theorem about the middle gives bounds that shrink with the square of the width. Plain bounds of the
    // two slopes would overlap for any two curves that run alongside each other.
    let (here, half) = (slope(middle).abs(), (b - a) / 2.0);
    let change = half * (second_w[1] - second_r[0]).max(second_r[1] - second_w[0]);
    if here > change {
        return;
    }
    if depth == 0 || middle <= a || middle >= b || (here + change) * half <= rounding {
        found.push(middle);
        return;
    }
    search(rail, wheel, [a, middle], depth - 1, rounding, found);
    if slope(middle) == 0.0 {
        found.push(middle);
    }
    search(rail, wheel, [middle, b], depth - 1, rounding, found);
}

/// Returns whether the two slopes agree to rounding all over \[a, b\]. They are compared at more points than two different
/// curves of a drawing can share. Without this test, equal polynomials on both bodies would be bisected down to the last
/// level everywhere.
fn agree(rail: &Branch, wheel: &Branch, a: f64, b: f64) -> bool {
    (0..=SAMPLES).all(|k| {
        let xi = a + (b - a) * f64::from(k) / f64::from(SAMPLES);
        let (r, w) = (rail.chord_slope(xi, xi), wheel.chord_slope(xi, xi));
        (r - w).abs() <= SLOPE_ROUNDINGS * f64::EPSILON * (1.0 + r.abs())
    })
}

//! Where two branches are parallel: the stationary points of the gap between them.

use super::{ArcBranch, Branch, BranchShape};
use crate::numerics::roots::bracketed;

/// Bisections after which an interval on which neither bound decides is left: 2⁻⁴⁸ of it is below rounding.
const DEEPEST: u32 = 48;

/// All ξ inside (a, b) where ζ^W(ξ) − ζ^R(ξ) is stationary, ascending; `a` and `b` within both branches.
///
/// Method: for lines and arcs the sines of the two tangent angles are linear in ξ, so that there is one point at
/// most, in closed form. Otherwise interval bounds of both derivatives decide between no point, exactly one,
/// and bisection: none is missed. Degenerate: nothing is reported where the two slopes agree over an interval.
pub fn stationary_points(rail: &Branch, wheel: &Branch, a: f64, b: f64) -> Vec<f64> {
    if let (BranchShape::Arc(rail), BranchShape::Arc(wheel)) = (&rail.shape, &wheel.shape) {
        return parallel(rail, wheel).filter(|&xi| xi > a && xi < b).into_iter().collect();
    }
    let mut found = Vec::new();
    if a < b {
        search(rail, wheel, [a, b], DEEPEST, &mut found);
    }
    found
}

/// S_R + κ_R (ξ − ξ_R) = S_W + κ_W (ξ − ξ_W).
fn parallel(rail: &ArcBranch, wheel: &ArcBranch) -> Option<f64> {
    let turn = wheel.curvature - rail.curvature;
    if turn == 0.0 {
        return None;
    }
    // Measured from the rail's anchor, so that both anchors at C give exactly 0.
    let apart = wheel.anchor[0] - rail.anchor[0];
    Some(rail.anchor[0] + (rail.sin - wheel.sin + wheel.curvature * apart) / turn)
}

fn search(rail: &Branch, wheel: &Branch, [a, b]: [f64; 2], depth: u32, found: &mut Vec<f64>) {
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
    if depth == 0 || middle <= a || middle >= b {
        found.push(middle);
        return;
    }
    search(rail, wheel, [a, middle], depth - 1, found);
    if slope(middle) == 0.0 {
        found.push(middle);
    }
    search(rail, wheel, [middle, b], depth - 1, found);
}

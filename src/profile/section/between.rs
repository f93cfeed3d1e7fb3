//! Finds the abscissae where two branches are parallel, the stationary points of the gap between them, and where one branch is
//! parallel to a line.

use super::arc_branch::ArcBranch;
use super::branch::{Branch, BranchShape};
use crate::numerics::interval::Interval;
use crate::numerics::lanes::{Lanes, lanes};
use crate::numerics::polynomial::{derivative, value};
use crate::numerics::sign_changes::sign_changes;

/// Difference of slopes, or sine of an angle, whose sign does not count. Points that are missed change the gap by less than 1e-13 of
/// their distance.
const SLOPE_NOISE: f64 = 1e-13;

/// Returns all ξ inside (a, b) where ζ^W(ξ) − ζ^R(ξ) is stationary, ascending. `a` and `b` \[mm\] must be within both
/// branches.
///
/// Method: for lines and arcs the sines of the two tangent angles are linear in ξ, so that there is at most one such point,
/// in closed form. Otherwise bounds of both slopes prove that there is no point, or all sign changes of their difference are found, or
/// beside an upright end those of the sine of the angle between the tangents.
/// Degenerate cases: two arcs of equal curvature, or two lines, give none. If the gap to a polynomial changes by less than its
/// rounding, the result is the middle of the interval.
pub fn stationary_points(rail: &Branch, wheel: &Branch, a: f64, b: f64) -> Vec<f64> {
    if let (BranchShape::Arc(rail), BranchShape::Arc(wheel)) = (&rail.shape, &wheel.shape) {
        return parallel(rail, wheel).filter(|&xi| xi > a && xi < b).into_iter().collect();
    }
    let mut found = Vec::new();
    let over = Interval::new(a, b);
    let [slope_r, slope_w] = [rail, wheel].map(|branch| branch.slope_bounds(over));
    let upright = |slopes: Interval| slopes.magnitude().is_infinite();
    if a >= b || !slope_w.meets(slope_r) {
        return found;
    }
    if upright(slope_r) || upright(slope_w) {
        // Where a branch stands upright its slope has a pole. The sine of the angle has none over that branch's own parameter.
        let (own, other) = if upright(slope_r) { (rail, wheel) } else { (wheel, rail) };
        let at = |parameter: f64| own.station_and_curvature(parameter).0;
        let sine = |parameter: f64| {
            let here = at(parameter);
            let there = other.station(over.nearest(here.x));
            here.sin * there.cos - here.cos * there.sin
        };
        let ends = over.map(|xi| own.parameter(xi));
        sign_changes(|parameters: &Lanes| parameters.map(sine), ends, SLOPE_NOISE, &mut found);
        found.iter_mut().for_each(|parameter| *parameter = at(*parameter).x);
    } else {
        let slope = |xi: f64| wheel.chord_slope(xi, xi) - rail.chord_slope(xi, xi);
        let slopes = |xi: &Lanes| {
            let many = pulp::Arch::new().dispatch(SlopeDifferences { rail, wheel, xi });
            many.unwrap_or_else(|| xi.map(slope))
        };
        sign_changes(slopes, over, SLOPE_NOISE, &mut found);
    }
    found.retain(|&xi| over.surrounds(xi));
    found
}

/// The difference of the slopes of two branches at 16 ξ, computed by vector code; `None` where a point is not found.
struct SlopeDifferences<'b> {
    rail: &'b Branch,
    wheel: &'b Branch,
    xi: &'b Lanes,
}

impl pulp::WithSimd for SlopeDifferences<'_> {
    type Output = Option<Lanes>;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> Option<Lanes> {
        let (rail, wheel) = (self.rail.slopes(self.xi)?, self.wheel.slopes(self.xi)?);
        Some(lanes(|k| wheel[k] - rail[k]))
    }
}

/// Returns all ξ between the ends of a range \[mm\] where a branch is parallel to a line of direction \[n_ξ, n_ζ\], ascending.
///
/// Method: on an arc the sine of the tangent angle is linear in ξ. On a polynomial it is where the component across the line
/// changes its sign. Degenerate cases: a polynomial that has the direction everywhere gives the middle of the range; a line gives
/// nothing.
pub fn parallel_to(branch: &Branch, n: [f64; 2], over: Interval) -> Vec<f64> {
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
            let ends = p.parameters(over);
            let size = value(&across.iter().map(|c| c.abs()).collect::<Vec<_>>(), ends.magnitude());
            if ends.has_width() {
                let many = |t: &Lanes| t.map(|t| value(&across, t));
                sign_changes(many, ends, f64::EPSILON * size, &mut found);
            }
            found.iter_mut().for_each(|t| *t = value(&p.xi, *t));
        }
    }
    found.retain(|&xi| over.surrounds(xi));
    found
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

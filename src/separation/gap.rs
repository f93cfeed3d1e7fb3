//! The midplane gap g(ξ) = ζ^W(ξ, 0) − ζ^R(ξ), to full relative accuracy over the contact segments.

use super::columns::{MANY, Row, every, row};
use crate::placement::Placement;
use crate::profile::{ArcBranch, Branch, BranchPoints, BranchShape};

/// g(ξ) \[mm\], NaN where a body has no surface.
///
/// Accuracy: relative, a few roundings, where both bodies' contact segments lie (arcs that conform to ten
/// digits included); absolute, a few roundings of the profile's extent, elsewhere.
pub fn midplane_gap(placement: &Placement, xi: f64) -> f64 {
    let (rail, wheel) = (&placement.rail.section, &placement.wheel.section);
    match (rail.piece_at(xi), wheel.piece_at(xi)) {
        (Some(r), Some(w)) => {
            let contact = rail.contact == Some(r.branch) && wheel.contact == Some(w.branch);
            let (r, w) = (&rail.branches[r.branch], &wheel.branches[w.branch]);
            let height = w.height(xi);
            if contact { contact_gap(r, w, xi, height) } else { height - r.height(xi) }
        }
        _ => f64::NAN,
    }
}

/// A difference down to this share of its terms has lost three bits, which is within the promise; a smaller one is taken in 32
/// digits.
const UNCANCELLED: f64 = 0.125;

/// The gap between two branches through C that share their tangent there; `zeta_w` is ζ^W(ξ).
pub(super) fn contact_gap(rail: &Branch, wheel: &Branch, xi: f64, zeta_w: f64) -> f64 {
    if let (BranchShape::Arc(rail), BranchShape::Arc(wheel)) = (&rail.shape, &wheel.shape) {
        let [gap] = arc_gaps(rail, wheel, &[xi]);
        return gap;
    }
    let gap = zeta_w - rail.height(xi);
    if gap.abs() >= UNCANCELLED * zeta_w.abs() {
        return gap;
    }
    (wheel.exact_height(xi) - rail.exact_height(xi)).high
}

/// [`contact_gap`] at many ξ, from the wheel's points there and their ζ; where one is to be taken in 32 digits, all are. `None`
/// where a point is not found.
#[inline(always)]
pub(super) fn contact_gaps(
    rail: &Branch,
    wheel: &Branch,
    xi: &Row,
    (wheel_points, zeta_w): (&BranchPoints<MANY>, &Row),
) -> Option<Row> {
    if let (BranchShape::Arc(rail), BranchShape::Arc(wheel)) = (&rail.shape, &wheel.shape) {
        return Some(arc_gaps(rail, wheel, xi));
    }
    let (rail_points, zeta_r) = rail.points(xi)?;
    let gap = row(|k| zeta_w[k] - zeta_r[k]);
    if every(|k| gap[k].abs() >= UNCANCELLED * zeta_w[k].abs()) {
        return Some(gap);
    }
    let (zeta_w, zeta_r) = (wheel.exact_heights(xi, wheel_points), rail.exact_heights(xi, &rail_points));
    Some(row(|k| (zeta_w.get(k) - zeta_r.get(k)).high))
}

/// g = ξ² (κ_W − κ_R) [1 + (κ_W + κ_R)/(κ_W C_R + κ_R C_W)] / ((1 + C_W)(1 + C_R)) for curvatures of one sign;
/// the plain difference, which then does not cancel, for opposite ones.
#[inline(always)]
pub(super) fn arc_gaps<const N: usize>(rail: &ArcBranch, wheel: &ArcBranch, xi: &[f64; N]) -> [f64; N] {
    let (k_r, k_w) = (rail.curvature, wheel.curvature);
    let mut gap = [0.0; N];
    if k_r == k_w {
        return gap;
    }
    let difference = curvature_difference(wheel.radius, rail.radius);
    for k in 0..N {
        let (c_r, c_w) = (rail.sine_cosine(xi[k]).1, wheel.sine_cosine(xi[k]).1);
        let square = xi[k] * xi[k];
        gap[k] = if k_r * k_w < 0.0 {
            square * (k_w / (1.0 + c_w) - k_r / (1.0 + c_r))
        } else {
            let bracket = 1.0 + (k_w + k_r) / (k_w * c_r + k_r * c_w);
            square * difference * bracket / ((1.0 + c_w) * (1.0 + c_r))
        };
    }
    gap
}

/// κ_W − κ_R from the radii, whose difference is exact when they are close.
pub(super) fn curvature_difference(wheel_radius: f64, rail_radius: f64) -> f64 {
    if wheel_radius.is_finite() && rail_radius.is_finite() {
        (rail_radius - wheel_radius) / (rail_radius * wheel_radius)
    } else {
        wheel_radius.recip() - rail_radius.recip()
    }
}

/// ζ^W(ξ + `shift`) − ζ^R(ξ) for a skewed wheel, over both contact segments: the gap at ξ and the wheel's rise from there,
/// neither of which cancels.
pub(super) fn skewed_gap(rail: &Branch, wheel: &Branch, xi: f64, shift: f64) -> f64 {
    let inside = |x: f64| x >= wheel.xi[0] && x <= wheel.xi[1];
    if !inside(xi) {
        return wheel.height(xi + shift) - rail.height(xi);
    }
    contact_gap(rail, wheel, xi, wheel.height(xi)) + shift * wheel.chord_slope(xi, xi + shift)
}

/// κ_W − κ_R \[1/mm\] of two contact arcs, or `None` when a polynomial is among them.
pub(super) fn relative_curvature(placement: &Placement) -> Option<f64> {
    let arc = |section: &crate::profile::Section| match &section.branches[section.contact?].shape {
        BranchShape::Arc(arc) => Some(arc.radius),
        BranchShape::Polynomial(_) => None,
    };
    Some(curvature_difference(arc(&placement.wheel.section)?, arc(&placement.rail.section)?))
}

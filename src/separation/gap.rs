//! The midplane gap g(ξ) = ζ^W(ξ, 0) − ζ^R(ξ), to full relative accuracy over the contact segments.

use crate::numerics::lanes::{Lanes, every, lanes};
use crate::placement::Placement;
use crate::profile::{ArcBranch, Branch, BranchShape, Section};

/// Computes g(ξ) \[mm\]; NaN where a body has no surface.
///
/// Accuracy: where ξ lies over both contact segments, a few roundings of g, even for arcs whose radii agree to ten digits;
/// elsewhere a few roundings of the profile's extent.
pub fn midplane_gap(placement: &Placement, xi: f64) -> f64 {
    midplane_gap_of(&placement.rail().section, &placement.wheel().section, xi)
}

/// Computes the gap \[mm\] between two profiles in one contact frame; NaN where one has no surface.
pub(super) fn midplane_gap_of(rail: &Section, wheel: &Section, xi: f64) -> f64 {
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

/// Least size of a difference, as a share of its terms, at which working precision is enough. A smaller one has lost more
/// than three bits and is computed with 32 digits.
const UNCANCELLED: f64 = 0.125;

/// Computes the gap \[mm\] between two branches through C that share their tangent there; `zeta_w` is ζ^W(ξ).
pub(crate) fn contact_gap(rail: &Branch, wheel: &Branch, xi: f64, zeta_w: f64) -> f64 {
    contact_gaps(rail, wheel, &[xi], &[zeta_w]).map_or(f64::NAN, |[gap]| gap)
}

/// Computes the gaps \[mm\] between two branches through C at N abscissae; `zeta_w` is ζ^W there. If one gap needs 32
/// digits, all are computed with them. Returns `None` if N > 1 and a point is not found.
#[inline(always)]
pub(crate) fn contact_gaps<const N: usize>(
    rail: &Branch,
    wheel: &Branch,
    xi: &Lanes<N>,
    zeta_w: &Lanes<N>,
) -> Option<Lanes<N>> {
    if let (BranchShape::Arc(rail), BranchShape::Arc(wheel)) = (&rail.shape, &wheel.shape) {
        return Some(arc_gaps(rail, wheel, xi));
    }
    let (rail_points, zeta_r) = rail.points(xi)?;
    let gap: Lanes<N> = lanes(|k| zeta_w[k] - zeta_r[k]);
    if every::<N>(|k| gap[k].abs() >= UNCANCELLED * zeta_w[k].abs()) {
        return Some(gap);
    }
    let zeta_r = rail.exact_heights(xi, &rail_points);
    let zeta_w = wheel.exact_heights(xi, &wheel.points(xi)?.0);
    Some(lanes(|k| (zeta_w[k] - zeta_r[k]).high))
}

/// Computes the gaps \[mm\] between two arcs through C. For curvatures of one sign, g = ξ² (κ_W − κ_R) [1 + (κ_W +
/// κ_R)/(κ_W C_R + κ_R C_W)] / ((1 + C_W)(1 + C_R)). For opposite signs it is the plain difference, which then does not
/// cancel.
#[inline(always)]
fn arc_gaps<const N: usize>(rail: &ArcBranch, wheel: &ArcBranch, xi: &Lanes<N>) -> Lanes<N> {
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

/// Computes κ_W − κ_R \[1/mm\] from the radii. The difference of nearly equal radii is exact.
fn curvature_difference(wheel_radius: f64, rail_radius: f64) -> f64 {
    if wheel_radius.is_finite() && rail_radius.is_finite() {
        (rail_radius - wheel_radius) / (rail_radius * wheel_radius)
    } else {
        wheel_radius.recip() - rail_radius.recip()
    }
}

/// Computes ζ^W(ξ + `shift`) − ζ^R(ξ) \[mm\] for a skewed wheel over both contact segments. It is the gap at ξ plus the
/// wheel's rise from there; neither cancels. If the wheel's segment does not hold ξ, it is the plain difference.
pub(super) fn skewed_gap(rail: &Branch, wheel: &Branch, xi: f64, shift: f64) -> f64 {
    if !wheel.xi.contains(xi) {
        return wheel.height(xi + shift) - rail.height(xi);
    }
    contact_gap(rail, wheel, xi, wheel.height(xi)) + shift * wheel.chord_slope(xi, xi + shift)
}

/// Returns κ_W − κ_R \[1/mm\] of two contact arcs; `None` if a body touches with a kink or a polynomial.
pub(super) fn relative_curvature(placement: &Placement) -> Option<f64> {
    let arc = |section: &Section| match &section.branches[section.contact?].shape {
        BranchShape::Arc(arc) => Some(arc.radius),
        BranchShape::Polynomial(_) => None,
    };
    Some(curvature_difference(arc(&placement.wheel().section)?, arc(&placement.rail().section)?))
}

//! Finds the slices of the patch of a wheel on a roller, with and without skew, by roots.
//!
//! Along a line of constant ξ both bodies bend away from each other, so that s falls to one lowest place and rises on either side
//! of it. Without skew that place is η = 0. A skewed wheel would have a second one only where its hollow is narrower than the sum
//! of the bodies' curvatures around their axles allows: κ sin²χ > 1/ϱ_W + 1/ϱ_R.

use super::skewed::slicer::{Edge, STEP_ROUNDINGS};
use crate::numerics::roots::{bracketed, last_where};
use crate::placement::Placement;
use crate::separation::Evaluator;

/// Factor by which an end of a slice is sought farther out.
const WIDER: f64 = 1.25;

/// The slices of a placed pair on a roller at one approach.
#[derive(Debug)]
pub(super) struct OnRoller<'a> {
    evaluator: Evaluator<'a>,
    /// Whether the lowest place along η may be off η = 0.
    skewed: bool,
    /// Approach δ \[mm\].
    approach: f64,
    /// Coefficient \[1/mm\] of η² of two cylinders with the radii at C.
    opening: f64,
    /// Least step of a surface \[mm\].
    step: f64,
}

impl<'a> OnRoller<'a> {
    /// Makes the slices of a placed pair; `None` on a rail.
    pub(super) fn new(placement: &'a Placement, approach: f64) -> Option<Self> {
        placement.under()?;
        let around = placement.rolling_radius().recip() + placement.rail().axle_distance().recip();
        let step = STEP_ROUNDINGS * f64::EPSILON * placement.wheel().profile().extent();
        let (evaluator, skewed) = (Evaluator::new(placement), placement.skew() != 0.0);
        Some(Self { evaluator, skewed, approach, opening: 0.5 * around, step })
    }

    /// Returns η \[mm\] of the least s at ξ; NaN where a body has no surface.
    pub(super) fn lowest(&mut self, xi: f64) -> f64 {
        if !self.skewed {
            return 0.0;
        }
        let mut slope = |eta: f64| self.evaluator.separation_and_gradient(xi, eta).1[1];
        let at_middle = slope(0.0);
        if at_middle == 0.0 || at_middle.is_nan() {
            return 0.0 * at_middle;
        }
        let (mut near, mut far) = (0.0, -at_middle / self.opening);
        while slope(far) * at_middle > 0.0 {
            (near, far) = (far, WIDER * far);
        }
        if slope(far).is_nan() {
            far = last_where(|eta| !slope(eta).is_nan(), near, far);
        }
        // Without a root s falls up to the end of the surface.
        bracketed(slope, near, far).unwrap_or(far)
    }

    /// Returns s − δ \[mm\] at the lowest place of ξ.
    pub(super) fn depth(&mut self, xi: f64) -> f64 {
        let eta = self.lowest(xi);
        self.evaluator.separation(xi, eta) - self.approach
    }

    /// Returns both ends of the slice at ξ; `None` outside the patch.
    pub(super) fn edges(&mut self, xi: f64) -> Option<[Edge; 2]> {
        let lowest = self.lowest(xi);
        let depth = self.approach - self.evaluator.separation(xi, lowest);
        if depth.is_nan() || depth < 0.0 {
            return None;
        }
        let upper = self.edge(xi, lowest, (depth / self.opening).sqrt());
        let mirrored = Edge { eta: -upper.eta, ..upper };
        let lower =
            if self.skewed { self.edge(xi, lowest, -(depth / self.opening).sqrt()) } else { mirrored };
        Some([lower, upper])
    }

    /// Returns the end of a slice on one side of its lowest place, to which `reach` \[mm\] leads.
    fn edge(&mut self, xi: f64, lowest: f64, reach: f64) -> Edge {
        let mut miss = |eta: f64| self.evaluator.separation(xi, eta) - self.approach;
        if reach == 0.0 {
            return Edge { eta: lowest, ledge: false };
        }
        let (mut near, mut far) = (0.0, reach);
        while miss(lowest + far) < 0.0 {
            (near, far) = (far, WIDER * far);
        }
        if miss(lowest + far).is_nan() {
            far = last_where(|off| !miss(lowest + off).is_nan(), near, far);
        }
        // Without a root the surface ends inside the patch.
        let eta = lowest + bracketed(|off| miss(lowest + off), near, far).unwrap_or(far);
        Edge { eta, ledge: miss(eta).abs() > self.step }
    }
}

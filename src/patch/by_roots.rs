//! Finds the slices of a patch by roots: of a wheel on a roller, with and without skew, and over the rail's own surface.
//!
//! Along a line of constant ξ or σ both bodies bend away from each other, so that the gap falls to one lowest place and rises on
//! either side of it. Without skew that place is η = 0. A skewed wheel would have a second one only where its hollow is narrower than
//! the sum of the bodies' curvatures around their axles allows: κ sin²χ > 1/ϱ_W + 1/ϱ_R.

use super::level::Level;
use super::skewed::slicer::{Edge, STEP_ROUNDINGS};
use crate::conformal::NormalGap;
use crate::numerics::roots::{bracketed, last_where};
use crate::placement::Placement;

/// Factor by which an end of a slice is sought farther out.
const WIDER: f64 = 1.25;

/// The slices of a placed pair at one approach.
#[derive(Debug)]
pub(super) struct ByRoots<'a> {
    gap: Level<'a>,
    /// Whether the lowest place along η may be off η = 0.
    skewed: bool,
    /// Approach δ \[mm\].
    approach: f64,
    /// Coefficient \[1/mm\] of η² of two cylinders with the radii at C.
    opening: f64,
    /// Least step of a surface \[mm\].
    step: f64,
}

impl<'a> ByRoots<'a> {
    /// Makes the slices of a placed pair over its tangent plane; `None` on a rail.
    pub(super) fn on_roller(placement: &'a Placement, approach: f64) -> Option<Self> {
        placement.under()?;
        Some(Self::new(Level::plane(placement), placement, approach))
    }

    /// Makes the slices of a placed pair over the rail's surface.
    pub(super) fn over_rail(placement: &'a Placement, approach: f64) -> Self {
        Self::new(Level::over_rail(placement, approach), placement, approach)
    }

    fn new(gap: Level<'a>, placement: &Placement, approach: f64) -> Self {
        let around = placement.rolling_radius().recip() + placement.rail().axle_distance().recip();
        let step = STEP_ROUNDINGS * f64::EPSILON * placement.wheel().profile().extent();
        Self { gap, skewed: placement.skew() != 0.0, approach, opening: 0.5 * around, step }
    }

    /// Returns the normal gap of slices over the rail's surface; `None` for those over the tangent plane.
    pub(super) fn normal_gap(&self) -> Option<&NormalGap<'a>> {
        self.gap.normal_gap()
    }

    /// Returns the gap \[mm\]; NaN where a body has no surface.
    pub(super) fn gap(&mut self, xi: f64, eta: f64) -> f64 {
        self.gap.gap(xi, eta)
    }

    /// Returns \[∂/∂ξ, ∂/∂η\] of the gap.
    pub(super) fn gradient(&mut self, xi: f64, eta: f64) -> [f64; 2] {
        self.gap.gradient(xi, eta)
    }

    /// Returns η \[mm\] of the least gap at ξ; NaN where a body has no surface.
    pub(super) fn lowest(&mut self, xi: f64) -> f64 {
        if !self.skewed {
            return 0.0;
        }
        let at_middle = self.gap.slope(xi, 0.0);
        if at_middle == 0.0 || at_middle.is_nan() {
            return 0.0 * at_middle;
        }
        let (mut near, mut far) = (0.0, -at_middle / self.opening);
        while self.gap.slope(xi, far) * at_middle > 0.0 {
            (near, far) = (far, WIDER * far);
        }
        if self.gap.slope(xi, far).is_nan() {
            far = last_where(|eta| !self.gap.slope(xi, eta).is_nan(), near, far);
        }
        // Without a root the gap falls up to the end of the surface.
        bracketed(|eta| self.gap.slope(xi, eta), near, far).unwrap_or(far)
    }

    /// Returns the gap less δ \[mm\] at the lowest place of ξ.
    pub(super) fn depth(&mut self, xi: f64) -> f64 {
        let eta = self.lowest(xi);
        self.gap.gap(xi, eta) - self.approach
    }

    /// Returns both ends of the slice at ξ; `None` outside the patch.
    pub(super) fn edges(&mut self, xi: f64) -> Option<[Edge; 2]> {
        let lowest = self.lowest(xi);
        let depth = self.approach - self.gap.gap(xi, lowest);
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
        let approach = self.approach;
        let mut miss = |eta: f64| self.gap.gap(xi, eta) - approach;
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
        let over = miss(eta).abs();
        Edge { eta, ledge: over > self.step }
    }
}

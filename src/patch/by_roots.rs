//! Finds the slices of a patch by roots: of a wheel on a roller, with and without skew, and over the rail's own surface.
//!
//! Along a line of constant ξ or σ both bodies bend away from each other, so that the gap falls to one lowest place and rises on
//! either side of it. Without skew that place is η = 0. A skewed wheel would have a second one only where its hollow is narrower than
//! the sum of the bodies' curvatures around their axles allows: κ sin²χ > 1/ϱ_W + 1/ϱ_R.

use super::level::Level;
use super::skewed::slicer::{Edge, STEP_ROUNDINGS};
use crate::numerics::roots::{bracketed, last_where};
use crate::placement::Placement;

/// Factor by which an end of a slice is sought farther out.
const WIDER: f64 = 1.25;

/// The slices of a placed pair at one approach.
#[derive(Debug)]
pub(super) struct ByRoots<'a> {
    pub(super) level: Level<'a>,
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
    /// Makes the slices of a placed pair at a level of its gap, which is that of an approach δ \[mm\].
    pub(super) fn new(placement: &Placement, approach: f64, level: Level<'a>) -> Self {
        let around = placement.rolling_radius().recip() + placement.rail().axle_distance().recip();
        let step = STEP_ROUNDINGS * f64::EPSILON * placement.wheel().profile().extent();
        Self { level, skewed: placement.skew() != 0.0, approach, opening: 0.5 * around, step }
    }

    /// Returns η \[mm\] of the least gap at ξ; NaN where a body has no surface.
    pub(super) fn lowest(&mut self, xi: f64) -> f64 {
        if !self.skewed {
            return 0.0;
        }
        let at_middle = self.level.slope(xi, 0.0);
        if at_middle == 0.0 || at_middle.is_nan() {
            return 0.0 * at_middle;
        }
        let (mut near, mut far) = (0.0, -at_middle / self.opening);
        while self.level.slope(xi, far) * at_middle > 0.0 {
            (near, far) = (far, WIDER * far);
        }
        if self.level.slope(xi, far).is_nan() {
            far = last_where(|eta| !self.level.slope(xi, eta).is_nan(), near, far);
        }
        // Without a root the gap falls up to the end of the surface.
        bracketed(|eta| self.level.slope(xi, eta), near, far).unwrap_or(far)
    }

    /// Returns the gap less δ \[mm\] at the lowest place of ξ.
    pub(super) fn depth(&mut self, xi: f64) -> f64 {
        let eta = self.lowest(xi);
        self.level.gap(xi, eta) - self.approach
    }

    /// Returns both ends of the slice at ξ; `None` outside the patch.
    pub(super) fn edges(&mut self, xi: f64) -> Option<[Edge; 2]> {
        let lowest = self.lowest(xi);
        let depth = self.approach - self.level.gap(xi, lowest);
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
        let mut miss = |eta: f64| self.level.gap(xi, eta) - approach;
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

//! The patch at one ξ: the interval of η with s(ξ, η) < δ.
//!
//! Without skew (7.2)–(7.3) become: the wheel is to rise by δ − g(ξ), which gives the sagitta e, and
//! η = ±√(e(2w + e)): exact at the tips, where (7.3) cancels.

use crate::numerics::roots::bracketed;
use crate::placement::Placement;
use crate::separation::Evaluator;
use crate::separation::column::{Foot, Span, WheelSurface};
use crate::separation::gap::midplane_gap;

/// Contractions of the sagitta step; each gains at least three digits away from vertical tangents.
const CONTRACTIONS: usize = 24;

/// The interval of η at one ξ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slice {
    /// Lower and upper end \[mm\].
    pub eta: [f64; 2],
}

/// Slices of a placed pair at one approach.
#[derive(Debug)]
pub struct Slicer<'a> {
    placement: &'a Placement,
    wheel: WheelSurface<'a>,
    evaluator: Evaluator<'a>,
    spans: Vec<Span>,
    /// δ \[mm\].
    pub approach: f64,
}

impl<'a> Slicer<'a> {
    /// A slicer for approach δ \[mm\].
    pub fn new(placement: &'a Placement, approach: f64) -> Self {
        Self {
            placement,
            wheel: WheelSurface::new(placement),
            evaluator: Evaluator::new(placement),
            spans: Vec::new(),
            approach,
        }
    }

    /// min over η of s(ξ, η) − δ \[mm\]: negative inside the patch, zero at its tips; NaN off the bodies.
    pub fn depth(&mut self, xi: f64) -> f64 {
        if self.placement.skew == 0.0 {
            return midplane_gap(self.placement, xi) - self.approach;
        }
        let lowest = self.lowest(xi);
        self.evaluator.separation(xi, lowest) - self.approach
    }

    /// The interval of η at ξ, or `None` outside the patch. A tip gives an interval of no width.
    ///
    /// Accuracy: |Δη| ≤ (R/η) × the accuracy of s.
    pub fn slice(&mut self, xi: f64) -> Option<Slice> {
        if self.placement.skew == 0.0 {
            let half = self.half_width(xi)?;
            return Some(Slice { eta: [-half, half] });
        }
        let lowest = self.lowest(xi);
        let inside = self.evaluator.separation(xi, lowest) - self.approach;
        if inside.is_nan() || inside > 0.0 {
            return None;
        }
        // The wheel rises by about η²/2R: a bracket of four times the width that lifts it by δ.
        let reach = 4.0 * (2.0 * self.placement.rolling_radius() * (self.approach + inside.abs())).sqrt();
        let approach = self.approach;
        let mut side = |end: f64| {
            let beyond = self.evaluator.separation(xi, lowest + end);
            if beyond.is_nan() || beyond < approach {
                return None;
            }
            bracketed(|eta| self.evaluator.separation(xi, eta) - approach, lowest, lowest + end)
        };
        Some(Slice { eta: [side(-reach)?, side(reach)?] })
    }

    /// η > 0 with s(ξ, η) = δ without skew.
    fn half_width(&mut self, xi: f64) -> Option<f64> {
        let depth = self.approach - midplane_gap(self.placement, xi);
        if depth.is_nan() || depth < 0.0 {
            return None;
        }
        // Enough for slopes up to 80°; steeper ones take the whole profile.
        let likely = 16.0 * self.placement.rolling_radius() * depth;
        let foot =
            self.foot_lifted(xi, depth, likely).or_else(|| self.foot_lifted(xi, depth, f64::INFINITY))?;
        Some(foot.u.max(0.0).sqrt())
    }

    /// The wheel point that lies `depth` above the midplane point at ξ.
    fn foot_lifted(&mut self, xi: f64, depth: f64, u_max: f64) -> Option<Foot> {
        self.wheel.spans(xi, u_max, &mut self.spans);
        let floor = self.spans.first().filter(|span| span.e[0] == 0.0)?.height;
        for span in &self.spans {
            let rise = depth - (span.height - floor);
            let end = span.e[1].is_finite().then(|| self.wheel.foot(xi, span, span.e[1]));
            if end.is_none_or(|end| end.rise >= rise) {
                return Some(self.wheel.foot_with_rise(xi, span, rise.max(0.0), CONTRACTIONS));
            }
        }
        None
    }

    /// η of the lowest wheel point at ξ, with skew.
    fn lowest(&mut self, xi: f64) -> f64 {
        // The slope across is about η/R + χ (slope along): its root is near χ R × slope, well inside R/4.
        let reach = 0.25 * self.placement.rolling_radius();
        let root = bracketed(|eta| self.evaluator.wheel_slopes(xi, eta)[1], -reach, reach);
        root.unwrap_or(f64::NAN)
    }

    /// dη/dξ of the boundary at a point of it: −s_ξ/s_η, infinite at a tip.
    pub fn boundary_slope(&mut self, xi: f64, eta: f64) -> f64 {
        let rail = self.evaluator.rail_slope(xi);
        let [along, across] = self.evaluator.wheel_slopes(xi, eta);
        -(along - rail) / across
    }

    /// s(ξ, η) \[mm\].
    pub fn separation(&mut self, xi: f64, eta: f64) -> f64 {
        self.evaluator.separation(xi, eta)
    }

    /// The pair.
    pub fn placement(&self) -> &'a Placement {
        self.placement
    }
}

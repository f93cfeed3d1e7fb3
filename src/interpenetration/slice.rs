//! The patch at one ξ: the interval of η with s(ξ, η) < δ.
//!
//! Without skew (7.2)–(7.3) become: the wheel is to rise by δ − g(ξ), which gives the sagitta e, and
//! η = ±√(e(2w + e)): exact at the tips, where (7.3) cancels.

use super::components::Component;
use super::valleys::Valleys;
use crate::placement::Placement;
use crate::separation::column::{Foot, Span, WheelSurface};
use crate::separation::gap::midplane_gap;
use crate::separation::{Evaluator, WheelPoint};

/// Contractions of the sagitta step; each gains at least three digits away from vertical tangents.
const CONTRACTIONS: usize = 24;

/// A step of the wheel along a column counts as one beyond this many roundings of its height; less is a smooth
/// joint whose two sides round differently.
pub(super) const STEP_ROUNDINGS: f64 = 64.0;

/// The interval of η at one ξ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slice {
    /// Lower and upper end \[mm\].
    pub eta: [f64; 2],
}

/// One end of a slice.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Edge {
    /// η \[mm\].
    pub(super) eta: f64,
    /// Whether the wheel's surface ends or steps there, so that s jumps past δ.
    pub(super) ledge: bool,
}

/// Slices of a placed pair at one approach.
#[derive(Debug)]
pub struct Slicer<'a> {
    pub(super) placement: &'a Placement,
    wheel: WheelSurface<'a>,
    pub(super) evaluator: Evaluator<'a>,
    spans: Vec<Span>,
    /// The wheel's valleys and ridges; `None` without skew.
    pub(super) valleys: Option<Valleys<'a>>,
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
            valleys: (placement.skew != 0.0).then(|| Valleys::new(placement)),
            approach,
        }
    }

    /// min over η of s(ξ, η) − δ \[mm\]: negative inside the patch, zero at its tips; NaN off the bodies.
    pub fn depth(&mut self, xi: f64) -> f64 {
        match self.lowest_valley(xi) {
            Some(valley) => self.depth_of(valley, xi),
            None if self.placement.skew == 0.0 => midplane_gap(self.placement, xi) - self.approach,
            None => f64::NAN,
        }
    }

    /// The interval of η at ξ, or `None` outside the patch; with skew, of several the deepest. A tip gives an interval of
    /// no width; where the wheel's surface ends along η before s reaches δ, so does the interval.
    ///
    /// Accuracy: |Δη| ≤ (R/η) × the accuracy of s.
    pub fn slice(&mut self, xi: f64) -> Option<Slice> {
        let valley = self.lowest_valley(xi);
        if valley.is_none() && self.placement.skew != 0.0 {
            return None;
        }
        self.edges(xi, valley).map(|[low, high]| Slice { eta: [low.eta, high.eta] })
    }

    /// The interval of η at ξ that lies in a component of the patch at this approach.
    pub fn slice_in(&mut self, component: &Component, xi: f64) -> Option<Slice> {
        self.edges(xi, component.part.valley(xi)).map(|[low, high]| Slice { eta: [low.eta, high.eta] })
    }

    /// Both ends of the slice; with skew, of the one that holds a valley.
    pub(super) fn edges(&mut self, xi: f64, valley: Option<usize>) -> Option<[Edge; 2]> {
        if let Some(valley) = valley {
            return self.skewed_edges(xi, valley);
        }
        let half = self.half_width(xi)?;
        Some([Edge { eta: -half.eta, ..half }, half])
    }

    /// η > 0 with s(ξ, η) = δ without skew.
    fn half_width(&mut self, xi: f64) -> Option<Edge> {
        let depth = self.approach - midplane_gap(self.placement, xi);
        if depth.is_nan() || depth < 0.0 {
            return None;
        }
        // Enough for slopes up to 80°; steeper ones take the whole profile.
        let likely = 16.0 * self.placement.rolling_radius() * depth;
        let (foot, ledge) =
            self.foot_lifted(xi, depth, likely).or_else(|| self.foot_lifted(xi, depth, f64::INFINITY))?;
        Some(Edge { eta: foot.u.max(0.0).sqrt(), ledge })
    }

    /// The wheel point that lies `depth` above the midplane point at ξ, and whether the surface ends or steps
    /// there; `None` where it is beyond `u_max`.
    fn foot_lifted(&mut self, xi: f64, depth: f64, u_max: f64) -> Option<(Foot, bool)> {
        self.wheel.spans(xi, u_max, &mut self.spans);
        let floor = self.spans.first().filter(|span| span.e[0] == 0.0)?.height;
        for span in &self.spans {
            let rise = depth - (span.height - floor);
            let end = span.e[1].is_finite().then(|| self.wheel.foot(xi, span, span.e[1]));
            if end.is_none_or(|end| end.rise >= rise) {
                let step = rise < -STEP_ROUNDINGS * f64::EPSILON * (span.height.abs() + floor.abs());
                return Some((self.wheel.foot_with_rise(xi, span, rise.max(0.0), CONTRACTIONS), step));
            }
        }
        let last = self.spans.last().filter(|span| span.u[1] < u_max)?;
        Some((self.wheel.foot(xi, last, last.e[1]), true))
    }

    /// η of the least s at ξ \[mm\]: 0 without skew, else where the wheel is parallel to η or its surface ends; NaN where
    /// there is none.
    pub fn lowest(&mut self, xi: f64) -> f64 {
        match self.lowest_valley(xi) {
            Some(valley) => self.spot(valley, xi).eta,
            None if self.placement.skew == 0.0 => 0.0,
            None => f64::NAN,
        }
    }

    /// dη/dξ of the boundary at a point of it: −s_ξ/s_η, infinite at a tip.
    pub fn boundary_slope(&mut self, xi: f64, eta: f64) -> f64 {
        let [along, across] = self.gradient(xi, eta);
        -along / across
    }

    /// (∂s/∂ξ, ∂s/∂η).
    pub(super) fn gradient(&mut self, xi: f64, eta: f64) -> [f64; 2] {
        let rail = self.evaluator.rail_slope(xi);
        let [along, across] = self.evaluator.wheel_slopes(xi, eta);
        [along - rail, across]
    }

    /// dη/dξ of a ledge: the circle of one profile point about the axle, along which dξ′ : dη′ = η′ sinθ : w.
    pub(super) fn ledge_slope(&mut self, xi: f64, eta: f64) -> f64 {
        if let Some(valleys) = &self.valleys {
            return valleys.rim_slope(xi, eta);
        }
        // A rounding inside: the ledge itself may count as off the surface.
        let inside = self.evaluator.wheel_point(xi, eta * (1.0 - 4.0 * f64::EPSILON));
        let Some(WheelPoint { eta_w, foot, .. }) = inside else { return f64::NAN };
        foot.w / (eta_w * self.placement.wheel.section.frame.sin)
    }

    /// Abscissa in the wheel's section of the profile point under (ξ, η) \[mm\]; NaN off the wheel.
    pub(super) fn foot_abscissa(&mut self, xi: f64, eta: f64) -> f64 {
        self.evaluator.foot_abscissa(xi, eta)
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

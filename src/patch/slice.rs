//! The patch at one ξ: the interval of η with s(ξ, η) < δ.
//!
//! Without skew (7.2)–(7.3) become: the wheel is to rise by δ − g(ξ), which gives the sagitta e, and
//! η = ±√(e(2w + e)): exact at the tips, where (7.3) cancels.

use super::skewed::slicer::{Edge, STEP_ROUNDINGS, Skewed};
use crate::placement::Placement;
use crate::separation::Evaluator;
use crate::separation::gap::midplane_gap;
use crate::separation::wheel_surface::{SagittaPoint, Span, WheelSurface};

/// Contractions of the sagitta step; each gains at least three digits away from vertical tangents.
const CONTRACTIONS: usize = 24;

/// The interval of η at one ξ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slice {
    /// Lower and upper end \[mm\].
    pub eta: [f64; 2],
}

/// The upper end of a slice without skew, and the wheel point there.
#[derive(Debug, Clone, Copy)]
struct Half {
    edge: Edge,
    span: Span,
    foot: SagittaPoint,
}

/// Slices of a placed pair at one approach.
#[derive(Debug)]
pub struct Slicer<'a> {
    pub(super) placement: &'a Placement,
    wheel: WheelSurface<'a>,
    pub(super) evaluator: Evaluator<'a>,
    spans: Vec<Span>,
    /// Slices from the wheel's valleys; `None` without skew.
    pub(super) skewed: Option<Skewed<'a>>,
    approach: f64,
}

impl<'a> Slicer<'a> {
    /// A slicer for approach δ \[mm\].
    pub fn new(placement: &'a Placement, approach: f64) -> Self {
        Self {
            placement,
            wheel: WheelSurface::new(placement),
            evaluator: Evaluator::new(placement),
            spans: Vec::new(),
            skewed: (placement.skew() != 0.0).then(|| Skewed::new(placement, approach)),
            approach,
        }
    }

    /// δ \[mm\].
    pub fn approach(&self) -> f64 {
        self.approach
    }

    /// min over η of s(ξ, η) − δ \[mm\]: negative inside the patch, zero at its tips; NaN off the bodies.
    pub fn depth(&mut self, xi: f64) -> f64 {
        match &mut self.skewed {
            Some(skewed) => skewed.lowest_valley(xi).map_or(f64::NAN, |valley| skewed.depth(valley, xi)),
            None => midplane_gap(self.placement, xi) - self.approach,
        }
    }

    /// The interval of η at ξ, or `None` outside the patch; with skew, of several the deepest. A tip gives an interval of
    /// no width; where the wheel's surface ends along η before s reaches δ, so does the interval.
    ///
    /// Accuracy: |Δη| ≤ (R/η) × the accuracy of s.
    pub fn slice(&mut self, xi: f64) -> Option<Slice> {
        let valley = match &mut self.skewed {
            Some(skewed) => Some(skewed.lowest_valley(xi)?),
            None => None,
        };
        self.edges(xi, valley).map(|[low, high]| Slice { eta: [low.eta, high.eta] })
    }

    /// Both ends of the slice; with skew, of the one that holds a valley.
    pub(super) fn edges(&mut self, xi: f64, valley: Option<usize>) -> Option<[Edge; 2]> {
        if let (Some(skewed), Some(valley)) = (&mut self.skewed, valley) {
            return skewed.edges(xi, valley);
        }
        let Half { edge, .. } = self.half(xi)?;
        Some([Edge { eta: -edge.eta, ..edge }, edge])
    }

    /// The same with dη/dξ of both branches, infinite at a tip.
    pub(super) fn edges_and_slopes(
        &mut self,
        xi: f64,
        valley: Option<usize>,
    ) -> Option<([Edge; 2], [f64; 2])> {
        if self.skewed.is_some() {
            let edges = self.edges(xi, valley)?;
            let slope = |edge: Edge| {
                if edge.ledge { self.ledge_slope(xi, edge.eta) } else { self.boundary_slope(xi, edge.eta) }
            };
            return Some((edges, edges.map(slope)));
        }
        let half = self.half(xi)?;
        let slope = self.half_slope(xi, &half);
        Some(([Edge { eta: -half.edge.eta, ..half.edge }, half.edge], [-slope, slope]))
    }

    /// The slice for η > 0 without skew.
    fn half(&mut self, xi: f64) -> Option<Half> {
        let depth = self.approach - midplane_gap(self.placement, xi);
        if depth.is_nan() || depth < 0.0 {
            return None;
        }
        // Enough for slopes up to 80°; steeper ones take the whole profile.
        let likely = 16.0 * self.placement.rolling_radius() * depth;
        self.foot_lifted(xi, depth, likely).or_else(|| self.foot_lifted(xi, depth, f64::INFINITY))
    }

    /// dη/dξ of the branch η > 0 without skew: −s_ξ/s_η, or along the circle of a ledge.
    fn half_slope(&self, xi: f64, Half { edge, span, foot }: &Half) -> f64 {
        if edge.ledge {
            return foot.w / (edge.eta * self.placement.wheel().section.frame.sin);
        }
        let normal = self.wheel.normal(xi, edge.eta, span, foot);
        let rail = self.evaluator.rail_slope(xi);
        // s_ξ = −n_ξ/n_ζ − the rail's slope, s_η = −n_η/n_ζ.
        -(normal.x + rail * normal.z) / normal.y
    }

    /// The wheel point that lies `depth` above the midplane point at ξ, or where the surface ends or steps below that;
    /// `None` where it is beyond `u_max`.
    fn foot_lifted(&mut self, xi: f64, depth: f64, u_max: f64) -> Option<Half> {
        self.wheel.spans(xi, u_max, &mut self.spans);
        let half = |foot: SagittaPoint, span: &Span, ledge: bool| Half {
            edge: Edge { eta: foot.u.max(0.0).sqrt(), ledge },
            span: *span,
            foot,
        };
        let floor = self.spans.first().filter(|span| span.e[0] == 0.0)?.height;
        for span in &self.spans {
            let rise = depth - (span.height - floor);
            let end = span.e[1].is_finite().then(|| self.wheel.point(xi, span, span.e[1]));
            if end.is_none_or(|end| end.rise >= rise) {
                let step = rise < -STEP_ROUNDINGS * f64::EPSILON * (span.height.abs() + floor.abs());
                let foot = self.wheel.point_with_rise(xi, span, rise.max(0.0), CONTRACTIONS);
                return Some(half(foot, span, step));
            }
        }
        let last = self.spans.last().filter(|span| span.u[1] < u_max)?;
        Some(half(self.wheel.point(xi, last, last.e[1]), last, true))
    }

    /// η of the least s at ξ \[mm\]: 0 without skew, else where the wheel is parallel to η or its surface ends; NaN where
    /// there is none.
    pub fn lowest(&mut self, xi: f64) -> f64 {
        let Some(skewed) = &mut self.skewed else { return 0.0 };
        skewed.lowest_valley(xi).map_or(f64::NAN, |valley| skewed.valleys.spot(valley, xi).eta)
    }

    /// η of a valley at ξ \[mm\]; 0 without skew.
    pub(super) fn valley(&self, valley: Option<usize>, xi: f64) -> f64 {
        let places = self.skewed.as_ref().zip(valley);
        places.map_or(0.0, |(skewed, valley)| skewed.valleys.spot(valley, xi).eta)
    }

    /// η, or next to it where the surface ends by a rounding too early.
    pub(super) fn on_surface(&mut self, xi: f64, eta: f64) -> f64 {
        self.skewed.as_mut().map_or(eta, |skewed| skewed.on_surface(xi, eta))
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

    /// dη/dξ under skew along the end or step of the wheel's surface next to a point; NaN without skew.
    fn ledge_slope(&self, xi: f64, eta: f64) -> f64 {
        self.skewed.as_ref().map_or(f64::NAN, |skewed| skewed.valleys.rim_slope(xi, eta))
    }

    /// s(ξ, η) \[mm\].
    pub fn separation(&mut self, xi: f64, eta: f64) -> f64 {
        self.evaluator.separation(xi, eta)
    }

    /// s(ξ, η) at all η of one column \[mm\].
    pub(super) fn column(&mut self, xi: f64, eta: &[f64], out: &mut [f64]) {
        self.evaluator.column(xi, eta, out);
    }

    /// The pair.
    pub fn placement(&self) -> &'a Placement {
        self.placement
    }
}

//! The patch at one ξ: the interval of η with s(ξ, η) < δ.
//!
//! Without skew (7.2)–(7.3) become: the wheel is to rise by δ − g(ξ), which gives the sagitta e, and
//! η = ±√(e(2w + e)): exact at the tips, where (7.3) cancels.

use crate::numerics::roots::bracketed;
use crate::placement::Placement;
use crate::separation::column::{Foot, Span, WheelSurface};
use crate::separation::gap::midplane_gap;
use crate::separation::{Evaluator, WheelPoint};

/// Contractions of the sagitta step; each gains at least three digits away from vertical tangents.
const CONTRACTIONS: usize = 24;

/// A step of the wheel along a column counts as one beyond this many roundings of its height; less is a smooth
/// joint whose two sides round differently.
const STEP_ROUNDINGS: f64 = 64.0;

/// Newton's steps to s = δ with skew.
const NEWTON_STEPS: usize = 6;

/// A step below this share of the way leaves its square: nothing.
const QUADRATIC: f64 = 1e-8;

/// Half the interval, in roundings of η, in which Newton's result is confirmed by a change of sign.
const NEWTON_ROUNDINGS: f64 = 64.0;

/// Secant steps to the lowest point of a column with skew.
const SECANT_STEPS: usize = 8;

/// A lowest point off by this share of R raises s by the square of it, far below rounding of any approach.
const LOWEST_SHARE: f64 = 1e-14;

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

    /// The interval of η at ξ, or `None` outside the patch. A tip gives an interval of no width; where the wheel's
    /// surface ends along η before s reaches δ, so does the interval.
    ///
    /// Accuracy: |Δη| ≤ (R/η) × the accuracy of s.
    pub fn slice(&mut self, xi: f64) -> Option<Slice> {
        self.edges(xi).map(|[low, high]| Slice { eta: [low.eta, high.eta] })
    }

    /// Both ends of the slice.
    pub(super) fn edges(&mut self, xi: f64) -> Option<[Edge; 2]> {
        if self.placement.skew == 0.0 {
            let half = self.half_width(xi)?;
            return Some([Edge { eta: -half.eta, ..half }, half]);
        }
        let lowest = self.lowest(xi);
        let depth = self.approach - self.evaluator.separation(xi, lowest);
        if depth.is_nan() || depth < 0.0 {
            return None;
        }
        // The wheel rises by about η²/2R: twice that width is enough but for steep profiles.
        let reach = 2.0 * (2.0 * self.placement.rolling_radius() * depth).sqrt();
        Some([-reach, reach].map(|reach| self.edge(xi, lowest, reach)))
    }

    /// The end of the slice on one side of its lowest point, with skew.
    fn edge(&mut self, xi: f64, lowest: f64, mut reach: f64) -> Edge {
        let approach = self.approach;
        let mut there = self.evaluator.separation(xi, lowest + reach);
        // Ends at the latest where the column leaves the wheel's own ring.
        while there < approach {
            reach *= 2.0;
            there = self.evaluator.separation(xi, lowest + reach);
        }
        let mut far = lowest + reach;
        if there.is_nan() {
            far = self.surface_end(xi, lowest, far);
            if self.evaluator.separation(xi, far) < approach {
                return Edge { eta: far, ledge: true };
            }
        }
        let eta = self.level(xi, lowest, far).unwrap_or(lowest);
        let step = STEP_ROUNDINGS * f64::EPSILON * self.placement.wheel.profile.extent();
        Edge { eta, ledge: (self.evaluator.separation(xi, eta) - approach).abs() > step }
    }

    /// η with s(ξ, η) = δ between `lowest` and `far`, on whose two sides s − δ has different signs.
    ///
    /// Method: s is nearly a parabola and convex, so that Newton's steps from half way come from outside and reach rounding
    /// within four. The result is taken if s − δ changes sign within some roundings of it; a bracketed root replaces one
    /// that a joint has misled.
    fn level(&mut self, xi: f64, lowest: f64, far: f64) -> Option<f64> {
        let approach = self.approach;
        let mut eta = lowest + (far - lowest) / 2.0;
        for _ in 0..NEWTON_STEPS {
            let (s, [_, slope]) = self.evaluator.separation_and_slopes(xi, eta);
            let step = (s - approach) / slope;
            eta -= step;
            if step.abs() <= QUADRATIC * (eta - lowest).abs() {
                break;
            }
        }
        let near = NEWTON_ROUNDINGS * f64::EPSILON * eta.abs().max((eta - lowest).abs());
        let near = near.copysign(far - lowest);
        let mut depth = |eta: f64| self.evaluator.separation(xi, eta) - approach;
        let confirmed = depth(eta - near) <= 0.0 && depth(eta + near) >= 0.0;
        if confirmed { Some(eta) } else { bracketed(depth, lowest, far) }
    }

    /// The last η with a surface between `on`, which has one, and `off`, which has none.
    fn surface_end(&mut self, xi: f64, mut on: f64, mut off: f64) -> f64 {
        loop {
            let middle = on + (off - on) / 2.0;
            if middle == on || middle == off {
                return on;
            }
            if self.evaluator.separation(xi, middle).is_nan() { off = middle } else { on = middle }
        }
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

    /// η of the least s at ξ \[mm\]: 0 without skew, else where the wheel is parallel to η, or the end of its
    /// surface nearest to that; NaN where there is none at η = 0.
    pub fn lowest(&mut self, xi: f64) -> f64 {
        if self.placement.skew == 0.0 {
            return 0.0;
        }
        self.lowest_by_secants(xi).unwrap_or_else(|| self.lowest_by_bracket(xi))
    }

    /// The slope across is about η/R + χ (slope along): secants settle at once but for joints.
    fn lowest_by_secants(&mut self, xi: f64) -> Option<f64> {
        let radius = self.placement.rolling_radius();
        let mut last = [0.0, self.evaluator.wheel_slopes(xi, 0.0)[1]];
        let mut eta = -last[1] * radius;
        for _ in 0..SECANT_STEPS {
            let slope = self.evaluator.wheel_slopes(xi, eta)[1];
            let step = slope * (eta - last[0]) / (slope - last[1]);
            if slope == 0.0 || step.abs() <= LOWEST_SHARE * radius {
                return Some(eta);
            }
            (last, eta) = ([eta, slope], eta - step);
        }
        None
    }

    fn lowest_by_bracket(&mut self, xi: f64) -> f64 {
        if self.evaluator.separation(xi, 0.0).is_nan() {
            return f64::NAN;
        }
        let reach = 0.25 * self.placement.rolling_radius();
        let [low, high] = [-reach, reach].map(|far| {
            let there = self.evaluator.separation(xi, far);
            if there.is_nan() { self.surface_end(xi, 0.0, far) } else { far }
        });
        let mut slope = |eta: f64| self.evaluator.wheel_slopes(xi, eta)[1];
        if slope(low) > 0.0 {
            low
        } else if slope(high) < 0.0 {
            high
        } else {
            bracketed(slope, low, high).unwrap_or(f64::NAN)
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
        // A rounding inside: the ledge itself may count as off the surface.
        let inside = self.evaluator.wheel_point(xi, eta * (1.0 - 4.0 * f64::EPSILON));
        let Some(WheelPoint { eta_w, foot, .. }) = inside else { return f64::NAN };
        let (sin, cos) = self.placement.skew.sin_cos();
        let along = eta_w * self.placement.wheel.section.frame.sin;
        (along * sin + foot.w * cos) / (along * cos - foot.w * sin)
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

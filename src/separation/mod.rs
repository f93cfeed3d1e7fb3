//! INSEP (Report Sec. 6): the separation s(ξ, η) = ζ^W − ζ^R and the unit normals.

pub mod approximate;
pub mod axis;
pub mod column;
mod columns;
pub mod gap;
pub mod grid;
mod horner;
mod measure;
pub mod midsep;
pub mod plan;
pub mod pointwise;
pub mod report_newton;
mod rounding;
mod samples;
mod skewed;
pub mod spectral;
mod stream;
mod strip;
pub mod strips;
pub mod values;

use crate::placement::Placement;
use column::{Foot, Span, WheelSurface};

/// Both outward unit normals (ξ, η, ζ) at one point of the grid, NaN where a body has no surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Normals {
    /// Of the rail, up at C.
    pub rail: [f64; 3],
    /// Of the wheel, down at C.
    pub wheel: [f64; 3],
}

/// Point-wise evaluation over a placed pair; holds the scratch space of one column.
#[derive(Debug)]
pub struct Evaluator<'a> {
    placement: &'a Placement,
    wheel: WheelSurface<'a>,
    spans: Vec<Span>,
    skew: (f64, f64),
    /// 1 − cos χ, to all digits.
    versine: f64,
}

/// A point of the wheel over the tangent plane.
#[derive(Debug, Clone, Copy)]
pub(crate) struct WheelPoint {
    /// The wheel's own ξ′ and η′ \[mm\], and ξ′ − ξ.
    xi_w: f64,
    shift: f64,
    pub(crate) eta_w: f64,
    /// Its span.
    span: Span,
    /// Its place there.
    pub(crate) foot: Foot,
}

impl<'a> Evaluator<'a> {
    /// An evaluator of one pair.
    pub fn new(placement: &'a Placement) -> Self {
        let skew = placement.skew.sin_cos();
        let versine = 2.0 * (placement.skew / 2.0).sin().powi(2);
        Self { placement, wheel: WheelSurface::new(placement), spans: Vec::with_capacity(4), skew, versine }
    }

    /// s(ξ, η) \[mm\], negative where the bodies overlap; NaN where a body has no surface.
    ///
    /// Method: sagitta form. Accuracy: over both contact segments the error is below 1e-13 times the magnitudes of what s is the
    /// sum of: midplane gap, rise of the wheel across, and under yaw its climb along ξ′ − ξ. That is a relative error below
    /// 1e-13 of s where these are of one sign, as at any contact that is open all around. Elsewhere the absolute error is below
    /// 2e-12 mm × max(1, R_max/300 mm). Checked against 28- and 60-digit values.
    pub fn separation(&mut self, xi: f64, eta: f64) -> f64 {
        self.wheel_point(xi, eta).map_or(f64::NAN, |point| self.separation_at(xi, &point))
    }

    /// s \[mm\] and [∂ζ^W/∂ξ, ∂ζ^W/∂η] at (ξ, η), at less cost than two calls; NaN off the wheel.
    pub fn separation_and_slopes(&mut self, xi: f64, eta: f64) -> (f64, [f64; 2]) {
        let Some(point) = self.wheel_point(xi, eta) else { return (f64::NAN, [f64::NAN; 2]) };
        (self.separation_at(xi, &point), slopes(self.wheel_normal(&point)))
    }

    /// [∂ζ^W/∂ξ, ∂ζ^W/∂η] at (ξ, η); NaN off the wheel.
    pub fn wheel_slopes(&mut self, xi: f64, eta: f64) -> [f64; 2] {
        self.wheel_point(xi, eta).map_or([f64::NAN; 2], |point| slopes(self.wheel_normal(&point)))
    }

    /// Both normals at (ξ, η).
    pub fn normals(&mut self, xi: f64, eta: f64) -> Normals {
        let rail = self.placement.rail.section.branch_at(xi).map_or([f64::NAN; 3], |branch| {
            let tangent = branch.station(xi);
            [-tangent.sin, 0.0, tangent.cos]
        });
        let wheel = self.wheel_point(xi, eta).map_or([f64::NAN; 3], |point| self.wheel_normal(&point));
        Normals { rail, wheel }
    }

    /// The wheel point over (ξ, η); `None` off the wheel.
    pub(crate) fn wheel_point(&mut self, xi: f64, eta: f64) -> Option<WheelPoint> {
        let [shift, eta_w] = self.wheel_coordinates(xi, eta);
        let (xi_w, u) = (xi + shift, eta_w * eta_w);
        self.wheel.spans(xi_w, u, &mut self.spans);
        let span = self.spans[WheelSurface::span_at(&self.spans, u)?];
        Some(WheelPoint { xi_w, shift, eta_w, span, foot: self.wheel.foot_at(xi_w, &span, u)? })
    }

    /// s and the sum of the magnitudes of what it is the sum of \[mm\]: gap, climb along ξ′ − ξ, rise across; NaN as
    /// [`Self::separation`].
    fn separation_and_size(&mut self, xi: f64, eta: f64) -> [f64; 2] {
        let Some(point) = self.wheel_point(xi, eta) else { return [f64::NAN; 2] };
        let base = self.base(xi, point.shift, &point.span);
        let gap = gap::midplane_gap(self.placement, xi);
        let along = if gap.is_nan() { base.abs() } else { gap.abs() + (base - gap).abs() };
        [base + point.foot.rise, along + point.foot.rise.abs()]
    }

    /// s where the wheel point lies over ξ.
    fn separation_at(&self, xi: f64, point: &WheelPoint) -> f64 {
        self.base(xi, point.shift, &point.span) + point.foot.rise
    }

    /// The wheel's normal in (ξ, η, ζ).
    fn wheel_normal(&self, point: &WheelPoint) -> [f64; 3] {
        let [x, y, z] = self.wheel.normal(point.xi_w, point.eta_w, &point.span, &point.foot);
        let (sin, cos) = self.skew;
        [x * cos - y * sin, x * sin + y * cos, z]
    }

    /// dζ^R/dξ at ξ; NaN off the rail.
    pub fn rail_slope(&self, xi: f64) -> f64 {
        self.placement.rail.section.branch_at(xi).map_or(f64::NAN, |branch| branch.chord_slope(xi, xi))
    }

    /// ζ^R(ξ) \[mm\]; NaN off the rail.
    pub fn rail_height(&self, xi: f64) -> f64 {
        self.placement.rail.section.height(xi)
    }

    /// s at all η of one column.
    pub fn column(&mut self, xi: f64, eta: &[f64], out: &mut [f64]) {
        if self.placement.skew == 0.0 {
            let u_max = eta.iter().fold(0.0, |m: f64, eta| m.max(eta * eta));
            let mut spans = std::mem::take(&mut self.spans);
            self.wheel.spans(xi, u_max, &mut spans);
            // s at the beginning of the span that the last η lay over.
            let (mut known, mut base) = (None, f64::NAN);
            for (s, &eta) in out.iter_mut().zip(eta) {
                let u = eta * eta;
                let found = WheelSurface::span_at(&spans, u);
                if found != known {
                    (known, base) = (found, found.map_or(f64::NAN, |k| self.base(xi, 0.0, &spans[k])));
                }
                *s = base + found.map_or(f64::NAN, |k| self.rise(xi, &spans[k], u));
            }
            self.spans = spans;
            return;
        }
        for (s, &eta) in out.iter_mut().zip(eta) {
            *s = self.separation(xi, eta);
        }
    }

    /// s at the given u = η² of one span, without skew.
    fn over_span(&self, xi: f64, span: &Span, u: &[f64], out: &mut [f64]) {
        let base = self.base(xi, 0.0, span);
        for (s, &u) in out.iter_mut().zip(u) {
            *s = base + self.rise(xi, span, u);
        }
    }

    /// ζ of the wheel above the beginning of a span; NaN beyond the ring.
    fn rise(&self, xi_w: f64, span: &Span, u: f64) -> f64 {
        self.wheel.foot_at(xi_w, span, u).map_or(f64::NAN, |foot| foot.rise)
    }

    /// \[s at η′ = 0, coefficient of η′²\] with the wheel at its own abscissa ξ′ = ξ + `shift`.
    fn parabola(&mut self, xi: f64, shift: f64) -> [f64; 2] {
        let xi_w = xi + shift;
        self.wheel.spans(xi_w, 0.0, &mut self.spans);
        let Some(span) = self.spans.first() else { return [f64::NAN; 2] };
        [self.base(xi, shift, span), self.wheel.opening(xi_w, span)]
    }

    /// ξ′ − ξ, which does not cancel, and η′ in the wheel's own directions of the tangent plane \[mm\].
    #[inline(always)]
    fn wheel_coordinates(&self, xi: f64, eta: f64) -> [f64; 2] {
        let (sin, cos) = self.skew;
        if sin == 0.0 { [0.0, eta] } else { [eta * sin - xi * self.versine, eta * cos - xi * sin] }
    }

    /// Whether a span begins in the midplane, over both contact segments.
    fn over_contact(&self, xi: f64, span: &Span) -> bool {
        let (rail, wheel) = (&self.placement.rail.section, &self.placement.wheel.section);
        let contact = rail.piece_at(xi).is_some_and(|piece| rail.contact == Some(piece.branch));
        contact && wheel.contact == Some(span.branch) && span.e[0] == 0.0
    }

    /// Size of the coordinates from which both bodies' heights are computed, the wheel's being as given \[mm\].
    #[inline(always)]
    fn size(&self, xi: f64, height: f64) -> f64 {
        let frames = [&self.placement.rail.section.frame, &self.placement.wheel.section.frame];
        let coordinates = frames.map(|frame| frame.z.abs() + (frame.sin * xi).abs());
        height.abs() + coordinates[0].max(coordinates[1])
    }

    /// s at the beginning of a span of the column at ξ + `shift`: the wheel's height there less the rail's at ξ.
    fn base(&self, xi: f64, shift: f64, span: &Span) -> f64 {
        let (rail, wheel) = (&self.placement.rail.section, &self.placement.wheel.section);
        let Some(piece) = rail.piece_at(xi) else { return f64::NAN };
        let both = self.over_contact(xi, span);
        let rail = &rail.branches[piece.branch];
        if !both {
            return span.height - rail.height(xi);
        }
        let branch = &wheel.branches[span.branch];
        if shift == 0.0 {
            return gap::contact_gap(rail, branch, xi, span.height);
        }
        gap::skewed_gap(rail, branch, xi, shift)
    }
}

/// [∂ζ/∂ξ, ∂ζ/∂η] of a surface with this normal.
fn slopes([x, y, z]: [f64; 3]) -> [f64; 2] {
    [-x / z, -y / z]
}

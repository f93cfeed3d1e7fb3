//! s(ξ, η), its slopes and both unit normals at single points. This is the reference for all other methods.

use nalgebra::{Unit, UnitComplex, Vector2, Vector3};

use super::gap;
use super::wheel_surface::{SagittaPoint, Span, WheelSurface};
use crate::placement::Placement;

/// Both outward unit normals (ξ, η, ζ) over one point of the tangent plane; `None` where a body has no surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Normals {
    /// Normal of the rail; it points up at C.
    pub rail: Option<Unit<Vector3<f64>>>,
    /// Normal of the wheel; it points down at C.
    pub wheel: Option<Unit<Vector3<f64>>>,
}

/// Evaluates single points over a placed pair. It holds the memory for the spans of one column.
///
/// # Examples
/// ```
/// # use wheelrail::{Arc, Half, Pair, Profile, Segment};
/// use wheelrail::Evaluator;
/// # let rail = Arc::about([0.0, -300.0], 300.0, Half::Upper, [-35.0, 35.0])?;
/// # let rail = Profile::new("crown", "", vec![Segment::arc(rail)])?;
/// # let wheel = Profile::new("cylinder", "", vec![Segment::arc(Arc::line([-60.0, 0.0], [60.0, 0.0])?)])?;
/// # let pair = Pair::new(rail, wheel, 460.0)?;
/// let placement = pair.placed(0.0, 0.0, 0.0)?; // a crown of 300 mm below a cylinder of 460 mm
/// let mut evaluator = Evaluator::new(&placement);
/// let across = 300.0 - f64::sqrt(300.0 * 300.0 - 2.0 * 2.0);
/// let along = 460.0 - f64::sqrt(460.0 * 460.0 - 5.0 * 5.0);
/// assert!((evaluator.separation(2.0, 0.0) - across).abs() < 1e-13);
/// assert!((evaluator.separation(0.0, 5.0) - along).abs() < 1e-13);
/// assert!(evaluator.separation(36.0, 0.0).is_nan()); // off the rail
/// # Ok::<(), wheelrail::Error>(())
/// ```
#[derive(Debug)]
pub struct Evaluator<'a> {
    pub(super) placement: &'a Placement,
    pub(super) wheel: WheelSurface<'a>,
    pub(super) spans: Vec<Span>,
    /// The rotation by χ.
    skew: UnitComplex<f64>,
    /// 1 − cos χ, to all digits.
    versine: f64,
}

/// The point of the wheel over one point of the tangent plane.
#[derive(Debug, Clone, Copy)]
struct WheelPoint {
    /// ξ′ in the wheel's own axes \[mm\].
    xi_w: f64,
    /// ξ′ − ξ \[mm\].
    shift: f64,
    /// η′ in the wheel's own axes \[mm\].
    eta_w: f64,
    /// The span of the column that holds the point.
    span: Span,
    /// The point of that span.
    point: SagittaPoint,
}

impl<'a> Evaluator<'a> {
    /// Makes an evaluator for a placed pair.
    pub fn new(placement: &'a Placement) -> Self {
        let skew = placement.skew_rotation();
        let versine = 2.0 * (placement.skew() / 2.0).sin().powi(2);
        Self { placement, wheel: WheelSurface::new(placement), spans: Vec::with_capacity(4), skew, versine }
    }

    /// Computes s(ξ, η) \[mm\], which is negative where the bodies overlap, and NaN where a body has no surface.
    ///
    /// Method: sagitta form. Accuracy: over both contact segments the error is below 1e-13 times the sum of the magnitudes
    /// of the terms of s: the midplane gap, the rise of the wheel across and, under yaw, its climb along ξ′ − ξ. If these
    /// terms have one sign, as at any contact that is open all around, this is a relative error of s below 1e-13. Elsewhere
    /// the absolute error is below 2e-12 mm × max(1, R_max/300 mm). Both are checked against 28- and 60-digit values.
    pub fn separation(&mut self, xi: f64, eta: f64) -> f64 {
        self.wheel_point(xi, eta).map_or(f64::NAN, |point| self.separation_at(xi, &point))
    }

    /// Computes s \[mm\] and [∂ζ^W/∂ξ, ∂ζ^W/∂η] at (ξ, η); one call costs less than two. The results are NaN off the wheel.
    pub fn separation_and_slopes(&mut self, xi: f64, eta: f64) -> (f64, [f64; 2]) {
        let Some(point) = self.wheel_point(xi, eta) else { return (f64::NAN, [f64::NAN; 2]) };
        (self.separation_at(xi, &point), slopes(self.wheel_normal(&point)))
    }

    /// Computes [∂ζ^W/∂ξ, ∂ζ^W/∂η] at (ξ, η); NaN off the wheel.
    pub fn wheel_slopes(&mut self, xi: f64, eta: f64) -> [f64; 2] {
        self.wheel_point(xi, eta).map_or([f64::NAN; 2], |point| slopes(self.wheel_normal(&point)))
    }

    /// Computes both outward normals at (ξ, η).
    pub fn normals(&mut self, xi: f64, eta: f64) -> Normals {
        let rail = self.placement.rail().section.branch_at(xi).map(|branch| {
            let tangent = branch.station(xi);
            Unit::new_unchecked(Vector3::new(-tangent.sin, 0.0, tangent.cos))
        });
        let wheel = self.wheel_point(xi, eta).map(|point| self.wheel_normal(&point));
        Normals { rail, wheel }
    }

    /// Finds the wheel point over (ξ, η); returns `None` off the wheel.
    fn wheel_point(&mut self, xi: f64, eta: f64) -> Option<WheelPoint> {
        let [shift, eta_w] = self.wheel_coordinates(xi, eta);
        let (xi_w, u) = (xi + shift, eta_w * eta_w);
        self.wheel.spans(xi_w, u, &mut self.spans);
        let span = self.spans[WheelSurface::span_at(&self.spans, u)?];
        Some(WheelPoint { xi_w, shift, eta_w, span, point: self.wheel.point_at(xi_w, &span, u)? })
    }

    /// Computes s, and the sum of the magnitudes of its terms \[mm\]: gap, climb along ξ′ − ξ, rise across. Both are NaN
    /// off either body.
    pub(super) fn separation_and_size(&mut self, xi: f64, eta: f64) -> [f64; 2] {
        let Some(point) = self.wheel_point(xi, eta) else { return [f64::NAN; 2] };
        let base = self.base(xi, point.shift, &point.span);
        let gap = gap::midplane_gap(self.placement, xi);
        let along = if gap.is_nan() { base.abs() } else { gap.abs() + (base - gap).abs() };
        [base + point.point.rise, along + point.point.rise.abs()]
    }

    /// Computes s \[mm\] of a wheel point over ξ.
    fn separation_at(&self, xi: f64, point: &WheelPoint) -> f64 {
        self.base(xi, point.shift, &point.span) + point.point.rise
    }

    /// Computes the wheel's normal in (ξ, η, ζ).
    fn wheel_normal(&self, point: &WheelPoint) -> Unit<Vector3<f64>> {
        let own = self.wheel.normal(point.xi_w, point.eta_w, &point.span, &point.point);
        let turned = self.skew * Vector2::new(own.x, own.y);
        Unit::new_unchecked(Vector3::new(turned.x, turned.y, own.z))
    }

    /// Computes dζ^R/dξ at ξ; NaN off the rail.
    pub fn rail_slope(&self, xi: f64) -> f64 {
        self.placement.rail().section.branch_at(xi).map_or(f64::NAN, |branch| branch.chord_slope(xi, xi))
    }

    /// Computes ζ^R(ξ) \[mm\]; NaN off the rail.
    pub fn rail_height(&self, xi: f64) -> f64 {
        self.placement.rail().section.height(xi)
    }

    /// Computes s \[mm\] at all η \[mm\] of one column; NaN where a body has no surface.
    pub fn column(&mut self, xi: f64, eta: &[f64], out: &mut [f64]) {
        if self.placement.skew() == 0.0 {
            let u_max = eta.iter().fold(0.0, |m: f64, eta| m.max(eta * eta));
            let mut spans = std::mem::take(&mut self.spans);
            self.wheel.spans(xi, u_max, &mut spans);
            // The span of the previous η, and s at the beginning of that span.
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

    /// Computes s \[mm\] of one span at several u = η² \[mm²\], without skew.
    pub(super) fn over_span(&self, xi: f64, span: &Span, u: &[f64], out: &mut [f64]) {
        let base = self.base(xi, 0.0, span);
        for (s, &u) in out.iter_mut().zip(u) {
            *s = base + self.rise(xi, span, u);
        }
    }

    /// Computes ζ of the wheel above its value at the beginning of a span \[mm\]; NaN if u lies beyond the wheel.
    fn rise(&self, xi_w: f64, span: &Span, u: f64) -> f64 {
        self.wheel.point_at(xi_w, span, u).map_or(f64::NAN, |point| point.rise)
    }

    /// Computes u_0 = η′² \[mm²\] at which the column begins, s \[mm\] and ds/du \[1/mm\] there. The wheel is taken at its own
    /// abscissa ξ′ = ξ + `shift`. u_0 is 0 unless ξ′ lies beyond the wheel's end or in a hole; the result is NaN if the
    /// column has no surface up to `u_max` \[mm²\].
    pub(super) fn parabola(&mut self, xi: f64, shift: f64, u_max: f64) -> [f64; 3] {
        let xi_w = xi + shift;
        self.wheel.spans(xi_w, 0.0, &mut self.spans);
        if self.spans.is_empty() {
            self.wheel.spans(xi_w, u_max, &mut self.spans);
        }
        let Some(span) = self.spans.first() else { return [f64::NAN; 3] };
        [span.u[0], self.base(xi, shift, span), self.wheel.opening(xi_w, span)]
    }

    /// Computes ξ′ − ξ and η′ \[mm\] in the wheel's own directions of the tangent plane. The difference does not cancel.
    #[inline(always)]
    pub(super) fn wheel_coordinates(&self, xi: f64, eta: f64) -> [f64; 2] {
        let (sin, cos) = (self.skew.im, self.skew.re);
        if sin == 0.0 { [0.0, eta] } else { [eta * sin - xi * self.versine, eta * cos - xi * sin] }
    }

    /// Returns whether a span begins in the midplane, over both contact segments.
    fn over_contact(&self, xi: f64, span: &Span) -> bool {
        let (rail, wheel) = (&self.placement.rail().section, &self.placement.wheel().section);
        let contact = rail.piece_at(xi).is_some_and(|piece| rail.contact == Some(piece.branch));
        contact && wheel.contact == Some(span.branch) && span.e[0] == 0.0
    }

    /// Returns the size \[mm\] of the coordinates from which the heights of both bodies are computed. `height` is the
    /// wheel's height.
    #[inline(always)]
    pub(super) fn size(&self, xi: f64, height: f64) -> f64 {
        let frames = [&self.placement.rail().section.frame, &self.placement.wheel().section.frame];
        let coordinates = frames.map(|frame| frame.z.abs() + (frame.sin * xi).abs());
        height.abs() + coordinates[0].max(coordinates[1])
    }

    /// Computes s \[mm\] at the beginning of a span of the column at ξ + `shift`: the wheel's height there, less the rail's
    /// height at ξ.
    pub(super) fn base(&self, xi: f64, shift: f64, span: &Span) -> f64 {
        let (rail, wheel) = (&self.placement.rail().section, &self.placement.wheel().section);
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

/// Computes [∂ζ/∂ξ, ∂ζ/∂η] of a surface from its normal.
fn slopes(normal: Unit<Vector3<f64>>) -> [f64; 2] {
    [-normal.x / normal.z, -normal.y / normal.z]
}

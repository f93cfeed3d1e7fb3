//! The relief of one wheel: the height of its surface over the profile below it.

use nalgebra::{Unit, UnitComplex, Vector2, Vector3};

use super::gap;
use super::span::{SagittaPoint, Span};
use super::wheel_surface::WheelSurface;
use crate::lofted::FramedLoft;
use crate::placement::Placement;
use crate::profile::Section;

/// The height ζ(ξ, η) − h(ξ) of a wheel over the profile h below it. It holds the memory for the spans of one column.
///
/// On an extruded rail it is the separation. On a roller the separation is the sum of two reliefs: that of the wheel over the roller's
/// profile, and that of this profile over the roller, which upside down is a wheel as well.
#[derive(Debug, Clone)]
pub struct Relief<'a> {
    /// The lower body's profile in the contact frame.
    pub below: &'a Section,
    /// The surface whose height is measured.
    pub wheel: WheelSurface<'a>,
    /// The spans of the last column.
    spans: Vec<Span>,
    /// ξ′ \[mm\] of that column, and u \[mm²\] up to which they reach.
    spanned: [f64; 2],
    /// The directions of the surface.
    pub skew: Skew,
}

/// The directions of a surface of revolution in the tangent plane, turned by the skew χ.
#[derive(Debug, Clone, Copy)]
pub struct Skew {
    /// The rotation from the surface's own directions to ξ and η.
    pub rotation: UnitComplex<f64>,
    /// 1 − cos χ, to all digits.
    versine: f64,
}

impl Skew {
    /// Returns the directions of the wheel of a placed pair.
    pub fn new(placement: &Placement) -> Self {
        let versine = 2.0 * (placement.skew() / 2.0).sin().powi(2);
        Self { rotation: placement.skew_rotation(), versine }
    }

    /// Returns whether the surface's own directions differ from ξ and η.
    pub fn turns(&self) -> bool {
        self.rotation.im != 0.0
    }

    /// Computes ξ′ − ξ and η′ \[mm\] in the own directions. The difference does not cancel.
    #[inline(always)]
    pub fn own(&self, xi: f64, eta: f64) -> [f64; 2] {
        let (sin, cos) = (self.rotation.im, self.rotation.re);
        if sin == 0.0 { [0.0, eta] } else { [eta * sin - xi * self.versine, eta * cos - xi * sin] }
    }
}

/// The point of a surface over one point of the tangent plane.
#[derive(Debug, Clone, Copy)]
pub struct ReliefPoint {
    /// ξ′ in the surface's own axes \[mm\].
    xi_w: f64,
    /// ξ′ − ξ \[mm\].
    shift: f64,
    /// η′ in the surface's own axes \[mm\].
    eta_w: f64,
    /// The span of the column that holds the point.
    span: Span,
    /// The point of that span.
    pub point: SagittaPoint,
}

impl<'a> Relief<'a> {
    /// Makes the reliefs of a placed pair: that of the wheel over the lower profile, and that of the profile over a roller. On swept
    /// bodies the separation is their sum. A wheel that varies around its axle has none.
    pub fn all(placement: &'a Placement) -> impl Iterator<Item = Self> {
        let round = Some(placement).filter(|placement| placement.lofted_wheel().is_none());
        round.into_iter().chain(placement.under()).map(Self::new)
    }

    /// Makes the relief of the wheel of a placed pair over the profile of its rail or roller; over the tangent plane of a rail that
    /// varies.
    pub fn new(placement: &'a Placement) -> Self {
        Self {
            // The height of a rail that varies over its tangent plane is computed elsewhere.
            below: placement.lofted_rail().map_or(&placement.rail().section, FramedLoft::plane),
            wheel: WheelSurface::new(placement),
            spans: Vec::with_capacity(4),
            spanned: [f64::NAN; 2],
            skew: Skew::new(placement),
        }
    }

    /// Returns whether the surface's own directions differ from ξ and η.
    pub fn is_skewed(&self) -> bool {
        self.skew.turns()
    }

    /// Finds the point over (ξ, η); returns `None` where there is no surface.
    pub fn point(&mut self, xi: f64, eta: f64) -> Option<ReliefPoint> {
        let [shift, eta_w] = self.skew.own(xi, eta);
        let (xi_w, u) = (xi + shift, eta_w * eta_w);
        if u.is_nan() {
            return None;
        }
        let span = self.span(xi_w, u)?;
        Some(ReliefPoint { xi_w, shift, eta_w, span, point: self.wheel.point_at(xi_w, &span, u)? })
    }

    /// Returns whether there is a surface over (ξ, η), without finding its point. Degenerate case: it may also be true where the surface would
    /// lie beyond the axle, where [`Self::point`] gives `None`.
    pub fn has_surface(&mut self, xi: f64, eta: f64) -> bool {
        let [shift, eta_w] = self.skew.own(xi, eta);
        self.span(xi + shift, eta_w * eta_w).is_some()
    }

    /// Returns the span of the column at ξ′ \[mm\] that holds u \[mm²\]; `None` where there is no surface.
    pub fn span(&mut self, xi_w: f64, u: f64) -> Option<Span> {
        if self.spanned[0] != xi_w || self.spanned[1] < u {
            self.wheel.spans(xi_w, u, &mut self.spans);
            self.spanned = [xi_w, u];
        }
        WheelSurface::span_at(&self.spans, u).map(|k| self.spans[k])
    }

    /// Computes the relief at a point \[mm\]; NaN where there is no surface, and off the lower body's profile.
    pub fn height(&mut self, xi: f64, eta: f64) -> f64 {
        self.point(xi, eta).map_or(f64::NAN, |point| self.height_at(xi, &point))
    }

    /// Computes the relief, and the sum of the magnitudes of its terms \[mm\]: gap, climb along ξ′ − ξ, rise across. Both are
    /// NaN where there is no surface.
    pub fn height_and_size(&mut self, xi: f64, eta: f64) -> [f64; 2] {
        let Some(point) = self.point(xi, eta) else { return [f64::NAN; 2] };
        let base = self.base(xi, point.shift, &point.span);
        // A span that begins in the midplane at ξ itself begins with the gap.
        let in_midplane = point.shift == 0.0 && point.span.e.low == 0.0;
        let gap = if in_midplane { base } else { self.midplane(xi) };
        let along = if gap.is_nan() { base.abs() } else { gap.abs() + (base - gap).abs() };
        [base + point.point.rise, along + point.point.rise.abs()]
    }

    /// Computes the relief \[mm\] of a point over ξ.
    pub fn height_at(&self, xi: f64, point: &ReliefPoint) -> f64 {
        self.height_over(xi, 0.0, point)
    }

    /// Computes how far a point over ξ + `moved` \[mm\] lies above the profile at ξ \[mm\].
    pub fn height_over(&self, xi: f64, moved: f64, point: &ReliefPoint) -> f64 {
        self.base(xi, moved + point.shift, &point.span) + point.point.rise
    }

    /// Computes the relief at η = 0 \[mm\] without skew; NaN where a body has no surface.
    pub fn midplane(&self, xi: f64) -> f64 {
        gap::midplane_gap_of(self.below, self.wheel.section, xi)
    }

    /// Returns the abscissa \[mm\] of the profile's point whose circle about the axle holds a point of the surface.
    pub fn abscissa(&self, point: &ReliefPoint) -> f64 {
        self.wheel.abscissa(point.xi_w, point.point.e)
    }

    /// Computes \[∂ζ/∂ξ, ∂ζ/∂η\] of the surface.
    pub fn slopes(&self, point: &ReliefPoint) -> [f64; 2] {
        let down = self.normal(point);
        [-down.x / down.z, -down.y / down.z]
    }

    /// Computes the unit normal in (ξ, η, ζ) that points down.
    pub fn normal(&self, point: &ReliefPoint) -> Unit<Vector3<f64>> {
        let own = self.wheel.normal(point.xi_w, point.eta_w, &point.span, &point.point);
        let turned = self.skew.rotation * Vector2::new(own.x, own.y);
        Unit::new_unchecked(Vector3::new(turned.x, turned.y, own.z))
    }

    /// Computes the relief \[mm\] at all η \[mm\] of one column; NaN where there is no surface.
    pub fn column(&mut self, xi: f64, eta: &[f64], out: &mut [f64]) {
        if !self.is_skewed() {
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
            (self.spans, self.spanned) = (spans, [xi, u_max]);
            return;
        }
        for (s, &eta) in out.iter_mut().zip(eta) {
            *s = self.height(xi, eta);
        }
    }

    /// Computes the relief \[mm\] of one span at several u = η² \[mm²\], without skew.
    pub fn over_span(&self, xi: f64, span: &Span, u: &[f64], out: &mut [f64]) {
        let base = self.base(xi, 0.0, span);
        for (s, &u) in out.iter_mut().zip(u) {
            *s = base + self.rise(xi, span, u);
        }
    }

    /// Computes ζ of the surface above its value at the beginning of a span \[mm\]; NaN if η is beyond the surface.
    fn rise(&self, xi_w: f64, span: &Span, u: f64) -> f64 {
        self.wheel.point_at(xi_w, span, u).map_or(f64::NAN, |point| point.rise)
    }

    /// Computes u_0 = η′² \[mm²\] at which the column begins, the relief \[mm\] and its derivative with respect to u \[1/mm\]
    /// there. The surface is taken at its own abscissa ξ′ = ξ + `shift`. u_0 is 0 unless ξ′ lies beyond the surface's end or in
    /// a hole; the result is NaN if the column has no surface up to `u_max` \[mm²\].
    pub fn parabola(&mut self, xi: f64, shift: f64, u_max: f64) -> [f64; 3] {
        let xi_w = xi + shift;
        self.spanned = [xi_w, 0.0];
        self.wheel.spans(xi_w, 0.0, &mut self.spans);
        if self.spans.is_empty() {
            self.spanned = [xi_w, u_max];
            self.wheel.spans(xi_w, u_max, &mut self.spans);
        }
        let Some(span) = self.spans.first() else { return [f64::NAN; 3] };
        [span.u.low, self.base(xi, shift, span), self.wheel.opening(xi_w, span)]
    }

    /// Returns whether a span begins in the midplane, over both contact segments.
    fn over_contact(&self, xi: f64, span: &Span) -> bool {
        let (rail, wheel) = (self.below, self.wheel.section);
        let contact = rail.piece_at(xi).is_some_and(|piece| rail.contact == Some(piece.branch));
        contact && wheel.contact == Some(span.branch) && span.e.low == 0.0
    }

    /// Returns the size \[mm\] of the coordinates from which heights are computed. `height` is the surface's.
    #[inline(always)]
    pub fn size(&self, xi: f64, height: f64) -> f64 {
        let frames = [&self.below.frame, &self.wheel.section.frame];
        let coordinates = frames.map(|frame| frame.z.abs() + (frame.sin * xi).abs());
        height.abs() + coordinates[0].max(coordinates[1])
    }

    /// Computes the relief \[mm\] at the beginning of a span of the column at ξ + `shift`: the surface's height there, less that of
    /// the lower body's profile at ξ.
    pub fn base(&self, xi: f64, shift: f64, span: &Span) -> f64 {
        let (rail, wheel) = (self.below, self.wheel.section);
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

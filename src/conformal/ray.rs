//! The line along the rail's normal, seen in the wheel's meridian plane, and the spans of its column over the wheel.
//!
//! A point of the line is on the wheel exactly when the point lower by the sagitta e is on the profile:
//! P′ + t n′ − e d, d = (sinθ, cosθ). As e grows from 0, the line moves along the profile, from segment to segment.

use super::arc_length::RailPoint;
use super::meeting::{along, along_by};
use crate::numerics::lanes::{Lanes, lanes};
use crate::placement::Placement;
use crate::profile::{Branch, BranchPoint, ONE_JOINT, Piece};
use crate::separation::{WheelSurface, contact_gap, sagitta, skewed_gap};

/// Most steps to the sagitta of a point. Each gains some three digits.
const STEPS: usize = 40;

/// Roundings of the sagitta below which its steps have settled.
const SETTLED: f64 = 2.0;

/// The bodies over which rays are cast, with what all rays share.
#[derive(Debug, Clone, Copy)]
pub struct RayBodies<'a> {
    placement: &'a Placement,
    /// The wheel.
    pub wheel: WheelSurface<'a>,
    /// sin χ.
    skew_sin: f64,
    /// cos χ.
    skew_cos: f64,
    /// 1 − cos χ, to all digits.
    versine: f64,
    /// Size of the coordinates \[mm\] whose roundings part the two sides of a joint.
    size: f64,
}

/// A line along the rail's normal, in the wheel's meridian plane in the contact frame.
#[derive(Debug, Clone, Copy)]
pub struct Ray<'a> {
    bodies: RayBodies<'a>,
    /// P′ \[mm\].
    p: [f64; 2],
    /// n′.
    n: [f64; 2],
    /// η′ of the point t = 0 \[mm\].
    pub eta: f64,
    /// dη′/dt = sin α sin χ.
    tilt: f64,
    /// n′·d.
    down: f64,
    /// Move of the line across itself as e grows: sinθ n′_ζ − cosθ n′_ξ.
    drift: f64,
    /// ξ \[mm\] of the rail's point, and ξ′ − ξ, if the rail's point is on the segment through C.
    contact: Option<[f64; 2]>,
}

/// The part of a ray's column that lies over one branch of the wheel.
#[derive(Debug, Clone, Copy)]
pub struct RaySpan<'a> {
    /// The branch.
    pub branch: &'a Branch,
    /// Index of the branch.
    pub index: usize,
    /// Range of e \[mm\]; the end may be infinite.
    pub e: [f64; 2],
    /// t at the beginning \[mm\].
    pub t: f64,
    /// Axle distance at the beginning \[mm\].
    pub w: f64,
    /// The wheel's point at the beginning.
    pub begin: BranchPoint,
    /// Least e \[mm\] that counts: before it, the previous piece covers this one.
    pub from: f64,
    /// Whether it begins above the midplane of both contact segments, from where t keeps all digits.
    pub over_contact: bool,
}

/// A point of the wheel on a ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RayPoint {
    /// t \[mm\].
    pub t: f64,
    /// Sagitta e \[mm\].
    pub e: f64,
    /// Axle distance w \[mm\].
    pub w: f64,
    /// η′ \[mm\].
    pub eta: f64,
    /// Index of the wheel's branch.
    pub branch: usize,
    /// Abscissa of the profile's point in the contact frame \[mm\].
    pub abscissa: f64,
    /// Whether the point lies over both contact segments.
    pub over_contact: bool,
}

impl<'a> RayBodies<'a> {
    /// Prepares a placed pair.
    pub fn new(placement: &'a Placement) -> Self {
        let skew = placement.skew_rotation();
        let versine = 2.0 * (placement.skew() / 2.0).sin().powi(2);
        let wheel = WheelSurface::new(placement);
        let frame = &wheel.section.frame;
        let size = placement.wheel().profile().extent() + frame.x.abs() + frame.z.abs();
        Self { placement, wheel, skew_sin: skew.im, skew_cos: skew.re, versine, size }
    }

    /// Returns the rounding \[mm\] of a height of the wheel beyond its contact segment.
    pub fn rounding(&self) -> f64 {
        f64::EPSILON * self.size
    }

    /// Casts the ray from a point of the rail at lateral position η \[mm\]. Without skew all η have the same ray but for η.
    pub fn ray(&self, from: &RailPoint, eta: f64) -> Ray<'a> {
        let (sin, cos) = (self.skew_sin, self.skew_cos);
        let skewed = sin != 0.0;
        let shift = if skewed { eta * sin - from.xi * self.versine } else { 0.0 };
        let n = [if skewed { -from.sin * cos } else { -from.sin }, from.cos];
        Ray {
            bodies: *self,
            p: [from.xi + shift, from.zeta],
            n,
            eta: if skewed { eta * cos - from.xi * sin } else { eta },
            tilt: from.sin * sin,
            down: n[0] * self.wheel.sin + n[1] * self.wheel.cos,
            drift: self.wheel.sin * n[1] - self.wheel.cos * n[0],
            contact: from.on_contact.then_some([from.xi, shift]),
        }
    }
}

impl<'a> Ray<'a> {
    /// Finds the wheel's point at the ray's own η′; `None` where the ray misses the wheel.
    ///
    /// Accuracy: over both contact segments a few roundings of the terms of t; elsewhere of the profile's extent.
    pub fn point(&self) -> Option<RayPoint> {
        let mut spans = Spans::new(self)?;
        loop {
            let span = spans.here();
            match self.beyond(&span) {
                true => spans = spans.next()?,
                false => return self.point_over(&span),
            }
        }
    }

    /// Returns the same ray at another η′ \[mm\]; for a wheel without skew.
    pub fn at(&self, eta: f64) -> Self {
        Self { eta, ..*self }
    }

    /// Returns the first span of the column, and the others by [`Spans::next`].
    pub fn spans(&self) -> Option<Spans<'_, 'a>> {
        Spans::new(self)
    }

    /// Tells whether the ray's η′ lies beyond the end of a span.
    fn beyond(&self, span: &RaySpan<'a>) -> bool {
        if span.e[1].is_infinite() {
            return false;
        }
        let t = self.t_over(span, span.e[1]);
        let (w, eta) = (self.axle_distance(t), self.eta_at(t));
        // Beyond the axle's height u would fall again.
        w > 0.0 && eta * eta > span.e[1] * (2.0 * w + span.e[1])
    }

    /// Finds the point at the ray's own η′ over a span.
    ///
    /// Method: the sagitta from t and t from the sagitta in turn.
    pub fn point_over(&self, span: &RaySpan<'a>) -> Option<RayPoint> {
        let mut t = span.t;
        let (mut e, mut w) = (span.e[0], span.w);
        for _ in 0..STEPS {
            let eta = self.eta_at(t);
            let next = sagitta(w, eta * eta);
            let step = (next - e).abs();
            e = next;
            t = self.t_over(span, e);
            w = self.axle_distance(t);
            // The comparison is false for a ray that misses.
            if step <= SETTLED * f64::EPSILON * e {
                let abscissa = self.p[0] + t * self.n[0] - e * self.bodies.wheel.sin;
                let on_wheel = w > 0.0 && t.is_finite() && e >= span.from;
                let (branch, over_contact) = (span.index, span.over_contact);
                let point = RayPoint { t, e, w, eta: self.eta_at(t), branch, abscissa, over_contact };
                return on_wheel.then_some(point);
            }
            if t.is_nan() {
                return None;
            }
        }
        None
    }

    /// Computes t \[mm\] at the sagitta e \[mm\] over a span; NaN where the ray misses its branch.
    pub fn t_over(&self, span: &RaySpan<'a>, e: f64) -> f64 {
        span.t + self.rises(span, &[e - span.e[0]]).map_or(f64::NAN, |[rise]| rise)
    }

    /// Computes the growth of t \[mm\] over sagittae larger by `runs` \[mm\] than at the beginning of a span. NaN where the
    /// ray misses the branch. Returns `None` where Newton's steps on a polynomial do not settle.
    #[inline(always)]
    pub fn rises<const N: usize>(&self, span: &RaySpan<'a>, runs: &Lanes<N>) -> Option<Lanes<N>> {
        let wheel = &self.bodies.wheel;
        let v0 = [lanes(|k| -runs[k] * wheel.sin), lanes(|k| -runs[k] * wheel.cos)];
        along(span.branch, &span.begin.repeated(), [&v0[0], &v0[1]], self.n)
    }

    /// Finds sagittae larger by about `runs` \[mm\] than at the beginning of a span: by how much they are, and by how much t
    /// has grown \[mm\]. No root is sought. NaN where the ray misses the branch.
    #[inline(always)]
    pub fn rises_by<const N: usize>(&self, span: &RaySpan<'a>, runs: &Lanes<N>) -> Option<[Lanes<N>; 2]> {
        let wheel = &self.bodies.wheel;
        along_by(span.branch, &span.begin, runs, ([wheel.sin, wheel.cos], self.n), self.drift)
    }

    /// Computes about the sagitta \[mm\] of η \[mm\] over a span of a wheel without skew, to some four digits.
    pub fn sagitta_near(&self, span: &RaySpan<'a>, eta: f64) -> f64 {
        let u = eta * eta;
        // t grows by about e − e₀ over the cosine between normal and axle's plane; its square enters w.
        let e = sagitta(span.w, u);
        sagitta(span.w - (e - span.e[0]) * self.down * self.down, u)
    }

    /// Computes u − u₀ \[mm²\] of points whose t has grown by `rise` \[mm\] and whose e by `runs` \[mm\] from the beginning
    /// of a span. Nothing cancels.
    #[inline(always)]
    pub fn u_above<const N: usize>(&self, span: &RaySpan<'a>, runs: &Lanes<N>, rise: &Lanes<N>) -> Lanes<N> {
        let e0 = span.e[0];
        lanes(|k| {
            let fall = rise[k] * self.down;
            let (w, e) = (span.w - fall, e0 + runs[k]);
            runs[k] * (2.0 * w + (e0 + e)) - 2.0 * e0 * fall
        })
    }

    /// Computes the axle distance w \[mm\] of the point at t \[mm\].
    pub fn axle_distance(&self, t: f64) -> f64 {
        let wheel = &self.bodies.wheel;
        wheel.axle - (self.p[0] * wheel.sin + self.p[1] * wheel.cos) - t * self.down
    }

    fn eta_at(&self, t: f64) -> f64 {
        self.eta + t * self.tilt
    }

    /// Computes how far a point of the profile lies beside the ray \[mm\], towards larger ξ.
    fn beside(&self, at: [f64; 2]) -> f64 {
        (at[0] - self.p[0]) * self.n[1] - (at[1] - self.p[1]) * self.n[0]
    }

    fn pieces(&self) -> &'a [Piece] {
        &self.bodies.wheel.section.pieces
    }

    fn branch(&self, piece: &Piece) -> &'a Branch {
        &self.bodies.wheel.section.branches[piece.branch]
    }

    /// Computes how far the ends of a piece lie beside the ray \[mm\].
    fn ends_beside(&self, index: usize) -> [f64; 2] {
        let piece = &self.pieces()[index];
        [0, 1].map(|end| self.beside([piece.xi[end], piece.ends[end].1]))
    }

    /// Finds the piece of the wheel's profile that the ray meets in the wheel's own midplane, e = 0.
    ///
    /// Method: the pieces are followed from the one above P′ towards the ray.
    fn first_piece(&self) -> Option<usize> {
        let last = self.pieces().len().checked_sub(1)?;
        let rounding = ONE_JOINT * self.bodies.size;
        let mut index = self.pieces().partition_point(|piece| piece.xi[1] < self.p[0]).min(last);
        let mut came: Option<(usize, f64)> = None;
        loop {
            let [low, high] = self.ends_beside(index);
            let next = if low > 0.0 {
                index.checked_sub(1).map(|next| (next, low))
            } else if high < 0.0 {
                (index < last).then_some((index + 1, high))
            } else {
                return Some(index);
            };
            let outer = if low > 0.0 { low } else { high };
            let Some((next, edge)) = next else {
                // The end of the profile is on the ray to rounding.
                return (outer.abs() <= rounding).then_some(index);
            };
            // The ray passes between two pieces: through a joint that both round differently, or through a step.
            if let Some((before, passed)) = came.filter(|(before, _)| *before == next) {
                return ((edge - passed).abs() <= rounding).then_some(before);
            }
            came = Some((index, edge));
            index = next;
        }
    }

    /// Makes the span that begins in the wheel's midplane.
    fn first_span(&self, index: usize) -> Option<RaySpan<'a>> {
        let (piece, wheel) = (&self.pieces()[index], &self.bodies.wheel);
        let branch = self.branch(piece);
        let on_contact = wheel.section.contact == Some(piece.branch);
        let contact = self.contact.filter(|[xi, shift]| {
            let inside = |x: f64| branch.xi[0] <= x && x <= branch.xi[1];
            on_contact && inside(*xi) && inside(xi + shift)
        });
        let rail = &self.bodies.placement.rail().section;
        let over_contact = contact.is_some() && rail.contact.is_some();
        let (above, f) = match (contact, rail.contact) {
            (Some([xi, shift]), Some(r)) => {
                let (rail, at) = (&rail.branches[r], xi + shift);
                let f = if shift == 0.0 {
                    contact_gap(rail, branch, xi, branch.height(xi))
                } else {
                    skewed_gap(rail, branch, xi, shift)
                };
                (at, f)
            }
            _ => {
                let at = self.p[0].max(piece.xi[0]).min(piece.xi[1]);
                (at, branch.height(at) - self.p[1])
            }
        };
        let (from, _) = branch.point(above);
        let v0 = [self.p[0] - above, -f];
        let t = along(branch, &from, [&[v0[0]], &[v0[1]]], self.n).map(|[t]| t).filter(|t| t.is_finite())?;
        let begin = branch.point(self.p[0] + t * self.n[0]).0;
        let e = [0.0, self.leaves(index)];
        let (index, w) = (piece.branch, self.axle_distance(t));
        Some(RaySpan { branch, index, e, t, w, begin, from: 0.0, over_contact })
    }

    /// Returns the ends of a piece by which the column enters and leaves it; 0 is the end at smaller ξ.
    fn sides(&self) -> [usize; 2] {
        if self.drift > 0.0 { [1, 0] } else { [0, 1] }
    }

    /// Computes e \[mm\] at which the line passes an end of a piece.
    fn passes(&self, index: usize, side: usize) -> f64 {
        if self.drift == 0.0 { f64::INFINITY } else { (-self.ends_beside(index)[side] / self.drift).max(0.0) }
    }

    /// Computes e \[mm\] at which the line leaves a piece; infinite if it moves along itself.
    fn leaves(&self, index: usize) -> f64 {
        self.passes(index, self.sides()[1])
    }

    /// Makes the span that begins at the near end of a piece; the previous one has ended at the sagitta `before` \[mm\].
    fn span_from_joint(&self, index: usize, before: f64) -> Option<RaySpan<'a>> {
        let (piece, wheel) = (&self.pieces()[index], &self.bodies.wheel);
        let [near, _] = self.sides();
        let (begin, zeta) = piece.ends[near];
        let e = self.passes(index, near);
        let from = [piece.xi[near] - self.p[0] + e * wheel.sin, zeta - self.p[1] + e * wheel.cos];
        let square = self.n[0] * self.n[0] + self.n[1] * self.n[1];
        let t = (from[0] * self.n[0] + from[1] * self.n[1]) / square;
        let span = RaySpan {
            branch: self.branch(piece),
            index: piece.branch,
            e: [e, self.leaves(index)],
            t,
            w: self.axle_distance(t),
            begin,
            from: before.max(e),
            over_contact: false,
        };
        Some(span).filter(|span| span.e[0].is_finite())
    }
}

/// The spans of a ray's column, in order of e.
#[derive(Debug, Clone, Copy)]
pub struct Spans<'r, 'a> {
    ray: &'r Ray<'a>,
    piece: usize,
    span: RaySpan<'a>,
}

impl<'r, 'a> Spans<'r, 'a> {
    fn new(ray: &'r Ray<'a>) -> Option<Self> {
        let piece = ray.first_piece()?;
        Some(Self { ray, piece, span: ray.first_span(piece)? })
    }

    /// Returns the span.
    pub fn here(&self) -> RaySpan<'a> {
        self.span
    }

    /// Returns the next span; `None` at the end of the profile.
    pub fn next(self) -> Option<Self> {
        let end = self.span.e[1];
        let piece = match self.ray.sides()[1] {
            0 => self.piece.checked_sub(1)?,
            _ => Some(self.piece + 1).filter(|&next| next < self.ray.pieces().len())?,
        };
        let span = self.ray.span_from_joint(piece, end)?;
        Some(Self { piece, span, ..self })
    }
}

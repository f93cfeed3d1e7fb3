//! The spans of a ray's column over the wheel: one for each segment of the profile that the column crosses.

use super::arc_length::RailPoint;
use super::meeting::along_by;
use super::ray::{Ray, RayBodies};
use super::rays::{Met, RayStart, at_joint, in_midplane, meet};
use crate::numerics::interval::Interval;
use crate::numerics::lanes::{Lanes, MANY, every, lanes};
use crate::profile::Branch;
use crate::separation::sagitta;

/// The part of a ray's column that lies over one branch of the wheel.
#[derive(Debug, Clone, Copy)]
pub struct RaySpan<'a> {
    ray: Ray<'a>,
    /// Index of the piece of the wheel's profile.
    piece: usize,
    branch: &'a Branch,
    begin: RayStart<1>,
    /// Axle distance at the beginning \[mm\].
    w: f64,
    /// e at the end \[mm\]; may be infinite.
    end: f64,
    /// Least e \[mm\] that counts: before it, the previous piece covers this one.
    from: f64,
    /// Whether it begins at a joint; otherwise in the wheel's midplane.
    joint: bool,
}

/// A point of the wheel on a ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RayPoint {
    /// t \[mm\].
    pub t: f64,
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

/// How far a span reaches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpanReach {
    /// e at the end less e at the beginning \[mm\].
    pub run: f64,
    /// Range of u \[mm²\] over which the span counts.
    pub u: Interval,
}

/// Points of the wheel on the rays of 16 places of one σ, over one piece.
#[derive(Debug, Clone, Copy)]
pub struct RayPoints {
    /// t \[mm\].
    pub t: Lanes,
    /// Abscissae of the profile's points \[mm\].
    pub abscissae: Lanes,
    /// Range of abscissae of the piece \[mm\].
    pub piece: Interval,
    /// Whether the points lie over both contact segments.
    pub over_contact: bool,
}

/// Finds the points at 16 places η \[mm\] of one point of the rail. Returns `None` if they do not all lie over one piece.
#[inline(always)]
pub fn points(bodies: &RayBodies<'_>, at: &RailPoint, eta: &Lanes) -> Option<RayPoints> {
    let rays = eta.map(|eta| bodies.ray(at, eta));
    let span = RaySpan::holding(&rays[MANY / 2])?;
    let over_it = |ray: &Ray<'_>| RaySpan::holding(ray).is_some_and(|other| other.piece == span.piece);
    if !over_it(&rays[0]) || !over_it(&rays[MANY - 1]) {
        return None;
    }
    let begin = if span.joint {
        let begin = at_joint(&rays, span.piece)?;
        // Each column enters the piece at its joint, and not from a step that covers it.
        let enters = span.from == span.begin.e[0] && every::<MANY>(|k| begin.e[k] > 0.0);
        Some(begin).filter(|_| enters)?
    } else {
        let met = |k: usize| {
            let [low, high] = rays[k].ends_beside(span.piece);
            low <= 0.0 && 0.0 <= high
        };
        Some(in_midplane(&rays, span.piece)?).filter(|_| every::<MANY>(met))?
    };
    let Met { t, e, .. } = meet(&rays, span.branch, &begin)?;
    if !every::<MANY>(|k| begin.e[k] <= e[k] && e[k] <= rays[k].leaves(span.piece)) {
        return None;
    }
    let (sin, n) = (bodies.wheel.sin, span.ray.n);
    let abscissae = lanes(|k| rays[k].p[0] + t[k] * n[0] - e[k] * sin);
    let piece = span.ray.pieces()[span.piece].xi;
    Some(RayPoints { t, abscissae, piece, over_contact: begin.over_contact })
}

impl<'a> RaySpan<'a> {
    /// Makes the span that begins in the wheel's midplane. Returns `None` if [`Ray::first_piece`] finds no piece.
    pub fn first(ray: &Ray<'a>) -> Option<Self> {
        let piece = ray.first_piece()?;
        let begin = in_midplane(&[*ray], piece)?;
        Some(Self::over(ray, piece, begin, 0.0, false))
    }

    /// Makes the spans of 16 rays without skew that begin in the wheel's midplane; `None` for a ray that has none.
    #[inline(always)]
    pub fn firsts(rays: &[Ray<'a>; MANY]) -> [Option<Self>; MANY] {
        let pieces = rays.map(|ray| ray.first_piece());
        let together = every::<MANY>(|k| pieces[k] == pieces[0]);
        // A closure would be compiled apart, for the least of machines.
        let begins = match pieces[0] {
            Some(piece) if together => in_midplane(rays, piece),
            _ => None,
        };
        let mut spans = [None; MANY];
        for (k, (span, ray)) in spans.iter_mut().zip(rays).enumerate() {
            *span = match (&begins, pieces[k]) {
                (Some(begins), Some(piece)) => Some(Self::over(ray, piece, begins.lane(k), 0.0, false)),
                _ => Self::first(ray),
            };
        }
        spans
    }

    /// Returns the next span. Returns `None` at the end of the profile, and if it has a step or turns back across the ray.
    pub fn next(&self) -> Option<Self> {
        let ray = &self.ray;
        let piece = match ray.sides()[1] {
            0 => self.piece.checked_sub(1)?,
            _ => Some(self.piece + 1).filter(|&next| next < ray.pieces().len())?,
        };
        if !ray.passes_once(piece) || !ray.joins([piece.min(self.piece), piece.max(self.piece)]) {
            return None;
        }
        let begin = at_joint(&[*ray], piece)?;
        Some(Self::over(ray, piece, begin, self.end.max(begin.e[0]), true))
    }

    /// Tells whether the span leaves its piece by the end of the profile.
    pub fn is_last(&self) -> bool {
        match self.ray.sides()[1] {
            0 => self.piece == 0,
            _ => self.piece + 1 == self.ray.pieces().len(),
        }
    }

    fn over(ray: &Ray<'a>, piece: usize, begin: RayStart<1>, from: f64, joint: bool) -> Self {
        let branch = ray.branch(&ray.pieces()[piece]);
        let (w, end) = (ray.axle_distance(begin.t[0]), ray.leaves(piece));
        Self { ray: *ray, piece, branch, begin, w, end, from, joint }
    }

    /// Finds the span that holds a ray's own η′. Returns `None` if [`Self::first`] or [`Self::next`] finds none on the way there.
    pub fn holding(ray: &Ray<'a>) -> Option<Self> {
        let mut span = Self::first(ray)?;
        while span.is_passed() {
            span = span.next()?;
        }
        Some(span)
    }

    /// Tells whether the ray's η′ lies beyond the end.
    fn is_passed(&self) -> bool {
        if self.end.is_infinite() {
            return false;
        }
        let t = self.t_at_end();
        let (w, eta) = (self.ray.axle_distance(t), self.ray.eta_at(t));
        // Beyond the axle's height u would fall again.
        w > 0.0 && eta * eta > self.end * (2.0 * w + self.end)
    }

    /// Finds the point at another η′ \[mm\] of the ray. Returns `None` if a previous span covers it, and as for [`meet`].
    pub fn point_at(&self, eta: f64) -> Option<RayPoint> {
        let ray = self.ray.at(eta);
        let Met { t: [t], e: [e], w: [w] } = meet(&[ray], self.branch, &self.begin)?;
        let abscissa = ray.p[0] + t * ray.n[0] - e * ray.bodies.wheel.sin;
        let (branch, over_contact) = (ray.pieces()[self.piece].branch, self.begin.over_contact);
        let point = RayPoint { t, w, eta: ray.eta_at(t), branch, abscissa, over_contact };
        (e >= self.from).then_some(point)
    }

    /// Computes t \[mm\] at the end of a span that ends at a joint.
    fn t_at_end(&self) -> f64 {
        let (ray, piece) = (&self.ray, &self.ray.pieces()[self.piece]);
        let [_, far] = ray.sides();
        ray.t_through([piece.xi[far], piece.heights[far]], self.end)
    }

    /// Finds how far the span reaches. `before` is the u \[mm²\] at which the previous span ended, and `eta` \[mm\] the
    /// farthest place that counts; for a wheel without skew.
    pub fn reach(&self, before: f64, eta: f64) -> SpanReach {
        let (e0, u_max) = (self.begin.e[0], eta * eta);
        let begin = if self.joint && self.from == e0 {
            // Two spans meet at one joint, in spite of rounding.
            before
        } else {
            before.max(self.u0())
        };
        if self.end.is_finite() {
            let w = self.ray.axle_distance(self.t_at_end());
            let end = self.end * (2.0 * w + self.end);
            if w > 0.0 && end < u_max {
                return SpanReach { run: self.end - e0, u: Interval::new(begin, end.max(begin)) };
            }
        }
        // t grows by about e − e₀ over the cosine between the normal and the axle's plane; its square enters w.
        let down = self.ray.down;
        let near = sagitta(self.w, u_max);
        let e = sagitta(self.w - (near - e0) * down * down, u_max);
        SpanReach { run: e - e0, u: Interval::new(begin, u_max) }
    }

    /// Returns t at the beginning \[mm\].
    pub fn base(&self) -> f64 {
        self.begin.t[0]
    }

    /// Returns e at the beginning \[mm\].
    pub fn e0(&self) -> f64 {
        self.begin.e[0]
    }

    /// Returns u at the beginning \[mm²\].
    pub fn u0(&self) -> f64 {
        self.begin.e[0] * (2.0 * self.w + self.begin.e[0])
    }

    /// Finds points with sagittae larger by about `runs` \[mm\] than at the beginning. Returns by how much the sagittae are larger, and
    /// by how much t is \[mm\]. No root is sought. The result is NaN if the ray misses the branch.
    #[inline(always)]
    pub fn rises_by<const N: usize>(&self, runs: &Lanes<N>) -> Option<[Lanes<N>; 2]> {
        let (ray, wheel) = (&self.ray, &self.ray.bodies.wheel);
        along_by(self.branch, &self.begin.points, runs, ([wheel.sin, wheel.cos], ray.n), ray.drift)
    }

    /// Computes u − u₀ \[mm²\] of points whose t has grown by `rise` \[mm\] and whose e by `runs` \[mm\] from the
    /// beginning. Nothing cancels.
    #[inline(always)]
    pub fn u_above<const N: usize>(&self, runs: &Lanes<N>, rise: &Lanes<N>) -> Lanes<N> {
        let e0 = self.begin.e[0];
        lanes(|k| {
            let fall = rise[k] * self.ray.down;
            let (w, e) = (self.w - fall, e0 + runs[k]);
            runs[k] * (2.0 * w + (e0 + e)) - 2.0 * e0 * fall
        })
    }
}

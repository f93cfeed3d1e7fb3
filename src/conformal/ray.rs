//! The line along the rail's normal, seen in the wheel's meridian plane.
//!
//! A point of the line is on the wheel exactly when the point lower by the sagitta e is on the profile:
//! P′ + t n′ − e d, d = (sinθ, cosθ). As e grows from 0, the line moves along the profile, from segment to segment.

use super::arc_length::RailPoint;
use crate::numerics::interval::Interval;
use crate::placement::Placement;
use crate::profile::{Branch, ONE_JOINT, Piece, Section};
use crate::separation::{Skew, WheelSurface, sagitta};

/// The bodies over which rays are cast, with what all rays share.
#[derive(Debug, Clone)]
pub struct RayBodies<'a> {
    placement: &'a Placement,
    /// The wheel.
    pub wheel: WheelSurface<'a>,
    /// The rotation from the wheel's own directions of the tangent plane to ξ and η.
    skew: Skew,
    /// Intervals of ξ \[mm\] at which the wheel's outer surface has a step or a hole.
    steps: Vec<Interval>,
    /// Size of the coordinates \[mm\] whose roundings part the two sides of a joint.
    size: f64,
}

/// A line along the rail's normal, in the wheel's meridian plane in the contact frame.
#[derive(Debug, Clone, Copy)]
pub struct Ray<'a> {
    /// The bodies.
    pub bodies: &'a RayBodies<'a>,
    /// P′ \[mm\].
    pub p: [f64; 2],
    /// n′.
    pub n: [f64; 2],
    /// η′ of the point t = 0 \[mm\].
    pub eta: f64,
    /// dη′/dt = sin α sin χ.
    tilt: f64,
    /// n′·d.
    pub down: f64,
    /// Move of the line across itself as e grows: sinθ n′_ζ − cosθ n′_ξ.
    pub drift: f64,
    /// ξ \[mm\] of the rail's point, and ξ′ − ξ, if the rail's point is on the segment through C.
    pub contact: Option<[f64; 2]>,
}

impl<'a> RayBodies<'a> {
    /// Prepares a placed pair.
    pub fn new(placement: &'a Placement) -> Self {
        let wheel = WheelSurface::new(placement);
        let frame = &wheel.section.frame;
        let size = placement.wheel().profile().extent() + frame.x.abs() + frame.z.abs();
        let steps = wheel.section.steps();
        Self { placement, wheel, skew: Skew::new(placement), steps, size }
    }

    /// Returns the rail's section in the contact frame.
    pub fn rail(&self) -> &'a Section {
        &self.placement.rail().section
    }

    /// Tells whether the wheel is skewed.
    pub fn is_skewed(&self) -> bool {
        self.skew.turns()
    }

    /// Returns the rounding \[mm\] of a height of the wheel beyond its contact segment.
    pub fn rounding(&self) -> f64 {
        f64::EPSILON * self.size
    }

    /// Returns the largest distance \[mm\] of the two sides of a joint.
    pub fn joint(&self) -> f64 {
        ONE_JOINT * self.size
    }

    /// Tells whether the wheel's outer surface has steps.
    pub fn has_steps(&self) -> bool {
        !self.steps.is_empty()
    }

    /// Tells whether the wheel's outer surface has a step over a column, between the midplane and the sagittae of its points, and whether
    /// it ends there.
    pub fn edges_over(&self, from: &RailPoint, eta: &[f64]) -> [bool; 2] {
        let ends = [eta.first(), eta.last()].map(|eta| self.ray(from, eta.copied().unwrap_or(0.0)));
        let reach = ends.iter().map(|ray| ray.own_sagitta() * self.wheel.sin.abs()).fold(0.0, f64::max);
        let over = Interval::between(ends[0].p[0], ends[1].p[0]).grown(reach);
        let inside = self.wheel.section.reach().is_some_and(|reach| reach.holds(over));
        [self.steps.iter().any(|step| step.meets(over)), !inside]
    }

    /// Casts the ray from a point of the rail at lateral position η \[mm\]. Without skew, η changes only the starting point.
    pub fn ray(&'a self, from: &RailPoint, eta: f64) -> Ray<'a> {
        let rotation = self.skew.rotation;
        let [shift, eta] = self.skew.own(from.xi, eta);
        let n = [-from.sin * rotation.re, from.cos];
        Ray {
            bodies: self,
            p: [from.xi + shift, from.zeta],
            n,
            eta,
            tilt: from.sin * rotation.im,
            down: n[0] * self.wheel.sin + n[1] * self.wheel.cos,
            drift: self.wheel.sin * n[1] - self.wheel.cos * n[0],
            contact: from.on_contact.then_some([from.xi, shift]),
        }
    }
}

impl<'a> Ray<'a> {
    /// Returns this ray with its starting point at another η′ \[mm\]; for a wheel without skew.
    pub fn at(&self, eta: f64) -> Self {
        Self { eta, ..*self }
    }

    /// Computes the axle distance w \[mm\] of the point at t \[mm\].
    pub fn axle_distance(&self, t: f64) -> f64 {
        let wheel = &self.bodies.wheel;
        wheel.axle - (self.p[0] * wheel.sin + self.p[1] * wheel.cos) - t * self.down
    }

    /// Returns η′ \[mm\] of the point at t \[mm\].
    pub fn eta_at(&self, t: f64) -> f64 {
        self.eta + t * self.tilt
    }

    /// Computes t \[mm\] at which the line, lowered by the sagitta e \[mm\], passes through a point of the profile.
    #[inline(always)]
    pub fn t_through(&self, at: [f64; 2], e: f64) -> f64 {
        let (wheel, n) = (&self.bodies.wheel, self.n);
        let [run, rise] = [at[0] - self.p[0] + e * wheel.sin, at[1] - self.p[1] + e * wheel.cos];
        (run * n[0] + rise * n[1]) / (n[0] * n[0] + n[1] * n[1])
    }

    /// Computes the sagitta e \[mm\] of the ray's own beginning, t = 0; NaN behind the axle.
    pub fn own_sagitta(&self) -> f64 {
        sagitta(self.axle_distance(0.0), self.eta * self.eta)
    }

    /// Tells whether the ray's beginning, t = 0, is on the side of the wheel's profile from which the ray meets it at t \[mm\]: inside
    /// the material if t is negative, outside if t is positive.
    pub fn begins_on_side(&self, t: f64) -> bool {
        let (wheel, e) = (&self.bodies.wheel, self.own_sagitta());
        let height = wheel.section.height(self.p[0] - e * wheel.sin);
        let depth = self.p[1] - e * wheel.cos - height;
        if t < 0.0 { depth >= -self.bodies.joint() } else { depth.is_nan() || depth <= self.bodies.joint() }
    }

    /// Computes how far a point of the profile lies beside the ray \[mm\], towards larger ξ.
    pub fn beside(&self, at: [f64; 2]) -> f64 {
        (at[0] - self.p[0]) * self.n[1] - (at[1] - self.p[1]) * self.n[0]
    }

    /// Returns the pieces of the wheel's profile.
    pub fn pieces(&self) -> &'a [Piece] {
        &self.section().pieces
    }

    /// Returns the wheel's section.
    pub fn section(&self) -> &'a Section {
        self.bodies.wheel.section
    }

    /// Returns the branch of a piece.
    pub fn branch(&self, piece: &Piece) -> &'a Branch {
        &self.section().branches[piece.branch]
    }

    /// Computes how far the ends of a piece lie beside the ray \[mm\].
    pub fn ends_beside(&self, index: usize) -> [f64; 2] {
        let piece = &self.pieces()[index];
        [0, 1].map(|end| self.beside([piece.xi[end], piece.heights[end]]))
    }

    /// Tells whether the ray crosses a piece at most once, because the piece nowhere turns back across the ray.
    pub fn passes_once(&self, index: usize) -> bool {
        let slopes = self.bodies.wheel.section.slopes(index);
        // A vertical surface has an infinite slope, and rays along ζ cross it once, too.
        self.n[0] == 0.0 || slopes.ends().iter().all(|slope| slope * self.n[0] < self.n[1])
    }

    /// Tells whether the ray crosses a piece at most once on the part that is followed: from the abscissa of P′, if the piece is above
    /// P′, to the end towards which the profile is followed.
    fn leads(&self, index: usize) -> bool {
        if self.passes_once(index) {
            return true;
        }
        let (piece, from) = (&self.pieces()[index], self.p[0]);
        if !piece.xi.contains(from) {
            return false;
        }
        let branch = self.branch(piece);
        let beside = self.beside([from, branch.height(from)]);
        // A ray from a point in the material is followed against its direction.
        let leans_right = self.n[0] > 0.0;
        let outside = (beside < 0.0) == leans_right || beside.abs() <= self.bodies.joint();
        let [slopes, _] = branch.derivative_bounds(piece.xi.split(from)[usize::from(outside == leans_right)]);
        slopes.ends().iter().all(|slope| slope * self.n[0] < self.n[1])
    }

    /// Tells whether two neighbouring pieces have one point in common, seen along the ray.
    pub fn joins(&self, [left, right]: [usize; 2]) -> bool {
        let ([_, end], [begin, _]) = (self.ends_beside(left), self.ends_beside(right));
        (end - begin).abs() <= self.bodies.joint()
    }

    /// Finds the piece of the wheel's profile that the ray meets in the wheel's own midplane, e = 0. Returns `None` if the ray misses
    /// the profile, and if the part of the profile that leads there has a step or turns back across the ray.
    ///
    /// Method: the pieces are followed from the one above P′ towards the ray.
    pub fn first_piece(&self) -> Option<usize> {
        let last = self.pieces().len().checked_sub(1)?;
        let mut index = self.pieces().partition_point(|piece| piece.xi.high < self.p[0]).min(last);
        let mut came = None;
        while self.leads(index) {
            let [low, high] = self.ends_beside(index);
            let next = if low > 0.0 {
                index.checked_sub(1)
            } else if high < 0.0 {
                (index < last).then_some(index + 1)
            } else {
                return Some(index);
            };
            let Some(next) = next else {
                // The end of the profile is on the ray to rounding.
                let outer = if low > 0.0 { low } else { high };
                return (outer.abs() <= self.bodies.joint()).then_some(index);
            };
            if !self.joins([index.min(next), index.max(next)]) {
                return None;
            }
            // The ray passes through a joint that both pieces round differently.
            if came == Some(next) {
                return came;
            }
            came = Some(index);
            index = next;
        }
        None
    }

    /// Returns the ends of a piece by which the column enters and leaves it; 0 is the end at smaller ξ.
    pub fn sides(&self) -> [usize; 2] {
        if self.drift > 0.0 { [1, 0] } else { [0, 1] }
    }

    /// Computes e \[mm\] at which the line passes an end of a piece.
    pub fn passes(&self, index: usize, side: usize) -> f64 {
        if self.drift == 0.0 { f64::INFINITY } else { (-self.ends_beside(index)[side] / self.drift).max(0.0) }
    }

    /// Computes e \[mm\] at which the line leaves a piece; infinite if it moves along itself.
    pub fn leaves(&self, index: usize) -> f64 {
        self.passes(index, self.sides()[1])
    }
}

//! Finds where a skewed wheel is parallel to η: the lowest and highest points of all lines of constant ξ, in
//! closed form.
//!
//! Let p be the profile abscissa of a wheel point, φ = ψ + θ its tangent angle, ρ the axle distance of its
//! circle and v its angle from the wheel's midplane. It lies at ξ′ = p + ρ (1 − cos v) sinθ, η′ = ρ sin v.
//! With t = tan(v/2), the normal there has no component along η where
//!
//! ```text
//! sinχ sin(ψ + 2θ) t² + 2 cosχ cosφ t + sinχ sinψ = 0.
//! ```
//!
//! One of the two roots is on the side of the rail, so that every profile point has one such place. If its ξ grows with p,
//! the place is the lowest of its line of constant ξ (a valley); if ξ falls, it is the highest (a ridge). At kinks and ends
//! p is constant and φ turns: the valley follows the point's circle, the rim. If lines of constant ξ leave the wheel over a
//! rim and enter it again, they have a second valley where they enter.

use std::ops::Range;

use nalgebra::Vector2;

use super::circle::{BESIDE, Circle, FARTHEST, Parallel, PlanePoint, Turned};
use super::path::{Leg, ValleyPath, circle_legs};
use crate::numerics::interval::Interval;
use crate::numerics::roots::bracketed;
use crate::placement::Placement;

/// Largest error of ξ, as a share of ξ, with which a root is accepted.
const ROOT_SHARE: f64 = 4.0 * f64::EPSILON;

/// Most secant steps to the profile point whose place is at ξ. The number is small because ξ is nearly linear in the
/// point's abscissa.
const SECANTS: usize = 8;

/// The place of a valley or ridge at one ξ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ValleySpot {
    /// η \[mm\].
    pub(crate) eta: f64,
    /// ζ of the wheel \[mm\].
    height: f64,
    /// Whether the place is on the circle of a kink or end. Elsewhere the surface itself is parallel to η.
    on_circle: bool,
}

/// A valley or ridge over an interval of ξ.
#[derive(Debug, Clone)]
pub(crate) struct Crease {
    /// Interval of ξ \[mm\].
    pub(crate) xi: Interval,
    /// True for a valley, false for a ridge.
    pub(crate) is_valley: bool,
    /// The legs that make it up, in order of ξ.
    pub(super) legs: Vec<Leg>,
}

/// All valleys and ridges of a wheel.
#[derive(Debug)]
pub(crate) struct Valleys<'a> {
    pub(super) turned: Turned<'a>,
    pub(crate) creases: Vec<Crease>,
    /// Circles at which the wheel's surface ends or steps.
    rims: Vec<Circle>,
}

impl<'a> Valleys<'a> {
    /// Finds the valleys and ridges of a placed pair.
    pub(crate) fn new(placement: &'a Placement) -> Self {
        let turned = Turned::new(placement);
        let (mut creases, mut rims) = (Vec::new(), Vec::new());
        let runs = runs(&turned);
        for (k, run) in runs.iter().enumerate() {
            let path = ValleyPath::new(&turned, run);
            let chains = path.monotone(turned.rounding()).into_iter();
            creases.extend(chains.map(|(legs, is_valley)| Crease::new(legs, is_valley)));
            rims.extend(path.ends);
            // A line of constant ξ continues over a step if the upper side is below δ, too.
            let steps = [k > 0, k + 1 < runs.len()].into_iter().zip(path.ends).filter(|(step, _)| *step);
            let brinks = steps.flat_map(|(_, circle)| circle_legs(&turned, circle));
            creases.extend(brinks.map(|leg| Crease::new(vec![leg], false)));
        }
        Self { turned, creases, rims }
    }

    /// Returns whether a valley lies in the midplane, about which the wheel is symmetric: without skew, unless it is on the circle of an
    /// end.
    pub(crate) fn is_mirrored(&self, valley: usize) -> bool {
        !self.turned.is_skewed() && self.creases[valley].legs[0].piece.is_some()
    }

    /// Returns the place of a valley or ridge at ξ, which must lie inside its interval.
    pub(crate) fn spot(&self, crease: usize, xi: f64) -> ValleySpot {
        let legs = &self.creases[crease].legs;
        let leg = &legs[legs.partition_point(|leg| leg.xi[1] < xi).min(legs.len() - 1)];
        let (circle, t) = match leg.piece {
            Some(piece) if !self.turned.is_skewed() => {
                (self.turned.circle(piece, self.abscissa(piece, leg.range, xi)), 0.0)
            }
            Some(piece) => self.turned.parallel(piece, self.abscissa(piece, leg.range, xi)),
            None => (leg.circle, self.turn(leg, xi)),
        };
        let [eta, height] = [self.turned.place(&circle, t).eta, self.turned.height(&circle, t)];
        ValleySpot { eta, height, on_circle: leg.piece.is_none() }
    }

    /// Returns t at which the line of constant ξ meets a leg on a circle.
    pub(super) fn turn(&self, leg: &Leg, xi: f64) -> f64 {
        let range = Interval::between(leg.range[0], leg.range[1]);
        let outside = |t: &f64| (range.low - t).max(t - range.high);
        let [one, other] = self.turned.crossings(&leg.circle, xi);
        // Rounding may move the line off a circle that it touches.
        let t = if outside(&one) <= outside(&other) { one } else { other };
        range.nearest(if t.is_nan() { self.turned.touching() } else { t })
    }

    /// Returns the parameter of a leg at ξ: the profile abscissa \[mm\], or t on a circle.
    pub(super) fn parameter(&self, leg: &Leg, xi: f64) -> f64 {
        match (leg.xi.iter().position(|end| *end == xi), leg.piece) {
            (Some(end), _) => leg.range[end],
            (None, Some(piece)) => self.abscissa(piece, leg.range, xi),
            (None, None) => self.turn(leg, xi),
        }
    }

    /// Returns ξ and ζ \[mm\] at a parameter of a leg, and the direction \[dξ, dζ\] along the leg or against it.
    pub(super) fn place(&self, leg: &Leg, at: f64) -> (f64, f64, Vector2<f64>) {
        let Parallel { circle, t, direction } = match leg.piece {
            Some(piece) => self.turned.parallel_with_direction(piece, at),
            None => Parallel { circle: leg.circle, t: at, direction: self.turned.direction(at) },
        };
        (self.turned.place(&circle, t).xi, self.turned.height(&circle, t), direction)
    }

    /// Returns bounds of dζ/dξ along a leg.
    pub(super) fn slopes(&self, leg: &Leg) -> Interval {
        let turned = &self.turned;
        let slope = |direction: Vector2<f64>| direction.y / direction.x;
        let Some(piece) = leg.piece else {
            // Along a circle the slope is monotone up to where the circle is parallel to η; there it is infinite.
            let [a, b] = leg.range;
            let [first, middle, last] = [a, a + (b - a) / 2.0, b].map(|t| slope(turned.direction(t)));
            let ends = Interval::between(first, last);
            let flat = if ends.low.abs() < ends.high.abs() { ends.low } else { ends.high };
            return match middle {
                middle if ends.contains(middle) => ends,
                middle if middle > flat => Interval { low: flat, ..Interval::ALL },
                _ => Interval { high: flat, ..Interval::ALL },
            };
        };
        let ends = turned.section.slopes(piece).ends().map(|tangent| turned.parallel_to_tangent(tangent).1);
        // Where the surface may stand upright between the ends of the piece, ξ turns back and the leg ends.
        if ends.iter().all(|end| end.x > 0.0) { ends.map(slope).into() } else { Interval::ALL }
    }

    /// Returns how far the wheel at the place of a valley or ridge lies above a height \[mm\]. `over` gives the same from the surface at
    /// the place, moved along ξ by its argument \[mm\].
    pub(crate) fn separation(&self, spot: &ValleySpot, height: f64, mut over: impl FnMut(f64) -> f64) -> f64 {
        let own = spot.height - height;
        let s = if spot.on_circle { f64::NAN } else { over(0.0) };
        if s.is_nan() || s <= own + self.turned.rounding() {
            // Rounding may end the surface a little before this place.
            return if s.is_nan() { own } else { s };
        }
        // Rounding may find the upper side of a step. Then the lower side is next to it.
        let beside = BESIDE * self.turned.axle;
        let sides = [-beside, beside].map(over);
        if sides.iter().any(|side| *side < own + (s - own) / 2.0) { own } else { s }
    }

    /// Returns the profile abscissa \[mm\] of a piece whose place is at ξ. If there is none, it returns the end of `[from,
    /// to]` that is nearest to it.
    pub(super) fn abscissa(&self, piece: usize, [from, to]: [f64; 2], xi: f64) -> f64 {
        let miss = |p: f64| {
            let (circle, t) = self.turned.parallel(piece, p);
            let miss = self.turned.place(&circle, t).xi - xi;
            if miss.abs() <= ROOT_SHARE * xi.abs() { 0.0 } else { miss }
        };
        let range = Interval::between(from, to);
        if !self.turned.is_skewed() {
            return range.nearest(xi);
        }
        // The place is C itself. A bracket with an end at 0 would be halved a thousand times.
        if xi == 0.0 && range.contains(0.0) && miss(0.0) == 0.0 {
            return 0.0;
        }
        // Where the skew is small, the place is nearly over the profile point itself.
        let near = range.nearest(xi);
        let mut a = (near, miss(near));
        let next = range.nearest(near - a.1);
        let mut b = if a.1 == 0.0 { a } else { (next, miss(next)) };
        for _ in 0..SECANTS {
            let next = b.0 - b.1 * ((b.0 - a.0) / (b.1 - a.1));
            if b.1 == 0.0 || !range.contains(next) {
                break;
            }
            (a, b) = (b, (next, miss(next)));
        }
        if b.1 == 0.0 {
            return b.0;
        }
        let nearest = || if miss(from).abs() <= miss(to).abs() { from } else { to };
        bracketed(miss, from, to).unwrap_or_else(nearest)
    }

    /// Returns the indices of the valleys and ridges over ξ.
    pub(crate) fn over(&self, xi: f64) -> impl Iterator<Item = usize> {
        (0..self.creases.len()).filter(move |&k| self.creases[k].xi.contains(xi))
    }

    /// Returns whether a single valley lies over a whole range of ξ \[mm\], and no other valley or ridge over any part of it.
    pub(crate) fn is_one_between(&self, xi: Interval) -> bool {
        let mut met = self.creases.iter().filter(|crease| crease.xi.meets(xi));
        let only = met.next().is_some_and(|crease| crease.is_valley && crease.xi.holds(xi));
        only && met.next().is_none()
    }

    /// Returns whether nothing else than a valley lies at ξ in an interval of η \[mm\] around it: no other valley or ridge, and no end or
    /// step of the surface.
    pub(crate) fn is_alone_within(&self, valley: usize, xi: f64, eta: Interval) -> bool {
        let only = self.over(xi).nth(1).is_none();
        let alone = only || self.over(xi).all(|k| (k == valley) == eta.contains(self.spot(k, xi).eta));
        alone && !self.rims(xi).any(|rim| eta.contains(rim))
    }

    /// Returns the η at which the line of constant ξ meets ends and steps of the wheel's surface \[mm\].
    pub(crate) fn rims(&self, xi: f64) -> impl Iterator<Item = f64> {
        self.crossings(xi).map(|(place, _)| place.eta)
    }

    /// Calls `visit` as [`Self::visit_rims`] does, for the circle of every joint and end of the wheel.
    pub(crate) fn visit_joints(
        &self,
        (xi, eta): (Interval, Interval),
        mut visit: impl FnMut(&dyn Fn(f64) -> [f64; 2], [f64; 2]),
    ) {
        let pieces = &self.turned.section.pieces;
        for (k, piece) in pieces.iter().enumerate() {
            let joined = pieces.get(k + 1).is_some_and(|next| next.xi.low == piece.xi.high);
            for p in piece.xi.ends().into_iter().take(if joined { 1 } else { 2 }) {
                self.visit_circle(&self.turned.circle(k, p), (xi, eta), &mut visit);
            }
        }
    }

    /// Calls `visit` for the circle of every end and step of the wheel's surface that may meet a box of the ξ–η plane. The arguments
    /// are \[ξ, ζ\] as a function of t along the circle, and the range of t.
    pub(crate) fn visit_rims(
        &self,
        within: (Interval, Interval),
        mut visit: impl FnMut(&dyn Fn(f64) -> [f64; 2], [f64; 2]),
    ) {
        self.rims.iter().for_each(|rim| self.visit_circle(rim, within, &mut visit));
    }

    fn visit_circle(
        &self,
        circle: &Circle,
        (xi, eta): (Interval, Interval),
        visit: &mut impl FnMut(&dyn Fn(f64) -> [f64; 2], [f64; 2]),
    ) {
        let turned = &self.turned;
        let range = turned.turns(circle, eta);
        let places = [range[0], range[1], turned.touching().clamp(range[0], range[1])];
        if Interval::around(places.map(|t| turned.place(circle, t).xi)).meets(xi) {
            visit(&|t| [turned.place(circle, t).xi, turned.height(circle, t)], range);
        }
    }

    /// Returns the places where the line of constant ξ meets ends and steps, with t.
    fn crossings(&self, xi: f64) -> impl Iterator<Item = (PlanePoint, f64)> {
        self.rims.iter().flat_map(move |rim| {
            let near = self.turned.crossings(rim, xi).into_iter().filter(|t| t.abs() <= FARTHEST);
            near.map(|t| (self.turned.place(rim, t), t))
        })
    }
}

impl Crease {
    fn new(legs: Vec<Leg>, is_valley: bool) -> Self {
        let xi = Interval::new(legs[0].xi[0], legs[legs.len() - 1].xi[1]);
        Self { xi, is_valley, legs }
    }
}

/// Returns the ranges of the envelope's pieces over which the surface neither ends nor steps.
fn runs(turned: &Turned<'_>) -> Vec<Range<usize>> {
    let pieces = &turned.section.pieces;
    let mut runs = Vec::new();
    let mut begin = 0;
    for k in 1..=pieces.len() {
        let joined = k < pieces.len()
            && pieces[k - 1].xi.high == pieces[k].xi.low
            && (pieces[k - 1].heights[1] - pieces[k].heights[0]).abs() <= turned.rounding();
        if !joined {
            runs.push(begin..k);
            begin = k;
        }
    }
    runs
}

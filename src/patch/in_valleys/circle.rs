//! The circles that the points of a wheel's profile describe about the axle, as seen in the tangent plane of a skewed
//! placement.

use nalgebra::{UnitComplex, Vector2};

use crate::numerics::direction;
use crate::numerics::interval::Interval;
use crate::placement::Placement;
use crate::profile::{Branch, Section};

/// Farthest place from the midplane that is examined, as tan(v/2): |η′| = 0.65 ρ. A tilted wheel is treated as if it ended
/// at 0.7 ρ.
pub(in crate::patch) const FARTHEST: f64 = 0.369;
/// sin v there.
pub(in crate::patch) const FARTHEST_SINE: f64 = 2.0 * FARTHEST / (1.0 + FARTHEST * FARTHEST);

/// Distance of a point beside an end or step, as a share of R. It is a million roundings, and less than any segment.
pub(in crate::patch) const BESIDE: f64 = 1e-9;

/// Share of a range of η by which that range is widened on either side.
const MARGIN: f64 = 0.05;

/// Places the circles of a wheel's profile points over the tangent plane of a skewed placement.
#[derive(Debug, Clone, Copy)]
pub(in crate::patch) struct Turned<'a> {
    pub(in crate::patch) section: &'a Section,
    /// R, the axle distance of C \[mm\].
    pub(in crate::patch) axle: f64,
    /// The rotation by θ, from the wheel's contact frame to its profile's axes.
    pub(in crate::patch) tilt: UnitComplex<f64>,
    /// The rotation by χ, from the wheel's directions in the tangent plane to ξ and η.
    pub(in crate::patch) skew: UnitComplex<f64>,
}

/// The circle of one profile point about the axle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Circle {
    /// Profile abscissa in the wheel's contact frame \[mm\].
    p: f64,
    pub(super) height: f64,
    /// Axle distance \[mm\].
    radius: f64,
}

/// A point of the tangent plane, \[mm\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::patch) struct PlanePoint {
    pub(in crate::patch) xi: f64,
    pub(in crate::patch) eta: f64,
}

/// The place on the circle of a profile point where the surface is parallel to η.
#[derive(Debug, Clone, Copy)]
pub(super) struct Parallel {
    pub(super) circle: Circle,
    /// tan(v/2) of the place on the circle.
    pub(super) t: f64,
    /// Direction \[dξ, dζ\] of the surface at the place. dξ is not positive where the surface stands upright or has turned over.
    pub(super) direction: Vector2<f64>,
}

impl<'a> Turned<'a> {
    /// Makes the circles of a placed pair.
    pub(in crate::patch) fn new(placement: &'a Placement) -> Self {
        let wheel = placement.wheel();
        Self {
            section: &wheel.section,
            axle: placement.rolling_radius(),
            tilt: wheel.contact_frame().rotation,
            skew: placement.skew_rotation(),
        }
    }

    /// Returns whether the wheel is skewed.
    pub(super) fn is_skewed(&self) -> bool {
        self.skew.im != 0.0
    }

    /// Returns the circle of the profile point at abscissa `p` of a piece.
    pub(super) fn circle(&self, piece: usize, p: f64) -> Circle {
        self.circle_with(p, self.section.branches[self.section.pieces[piece].branch].height(p))
    }

    fn circle_with(&self, p: f64, height: f64) -> Circle {
        Circle { p, height, radius: self.axle - p * self.tilt.im - height * self.tilt.re }
    }

    /// Returns the circle of a profile point, and the t on it at which the surface is parallel to η. If that place is farther away
    /// than [`FARTHEST`], t is ±[`FARTHEST`].
    pub(super) fn parallel(&self, piece: usize, p: f64) -> (Circle, f64) {
        let Parallel { circle, t, .. } = self.parallel_with_direction(piece, p);
        (circle, t)
    }

    /// Returns the place on the circle of a profile point where the surface is parallel to η, with the direction of the surface there.
    pub(super) fn parallel_with_direction(&self, piece: usize, p: f64) -> Parallel {
        let tangent = self.section.branches[self.section.pieces[piece].branch].station(p);
        let (t, direction) = self.parallel_of(Vector2::new(tangent.cos, tangent.sin));
        Parallel { circle: self.circle_with(p, tangent.z), t, direction }
    }

    /// Returns t of the place that is parallel to η on the circle of a point whose profile has a slope, which may be infinite, and the
    /// direction of the surface there. t and the angle of the direction are monotone functions of the profile's angle.
    pub(super) fn parallel_to_tangent(&self, slope: f64) -> (f64, Vector2<f64>) {
        self.parallel_of(direction(slope).into())
    }

    /// Returns t of the place that is parallel to η and the direction of the surface there, from the unit tangent of the profile.
    fn parallel_of(&self, tangent: Vector2<f64>) -> (f64, Vector2<f64>) {
        // The tangent is (cos φ, sin φ) in the profile's own axes.
        let own = self.tilt * tangent;
        let (constant, half) = (self.skew.im * tangent.y, own.x * self.skew.re);
        let nearest = self.nearest(tangent, own);
        let far = FARTHEST.copysign(-constant * half);
        let t = if nearest.abs() <= FARTHEST { nearest } else { far };
        let share = 2.0 / (1.0 + t * t);
        // The normal in the wheel's own directions is that in the midplane plus what the turn by v adds to it.
        let lifted = own.x * share * t * t;
        let along = tangent.y + lifted * self.tilt.im;
        let across = own.x * share * t;
        let up = lifted * self.tilt.re - tangent.x;
        (t, Vector2::new(-up, (self.skew * Vector2::new(along, across)).x))
    }

    /// Returns t of the place that is parallel to η, however far away, from the unit tangent and that in the profile's own axes; NaN
    /// if there is none.
    fn nearest(&self, tangent: Vector2<f64>, own: Vector2<f64>) -> f64 {
        let half = own.x * self.skew.re;
        let constant = self.skew.im * tangent.y;
        let square = self.skew.im * (self.tilt * own).y;
        let root = (half * half - constant * square).sqrt();
        -constant / (half + root.copysign(half))
    }

    /// Returns dξ/dl of the place of a profile point that is parallel to η, where l is the length of the profile. The point is given by
    /// the own parameter of its branch.
    ///
    /// With φ = ψ + θ, the place is where F = sinχ (sinφ cosθ − cosφ sinθ cos v) + cosχ cosφ sin v is 0, so that dv/dl =
    /// −(∂F/∂ψ)/(∂F/∂v) dψ/dl.
    pub(super) fn run(&self, branch: &Branch, parameter: f64) -> f64 {
        let (tangent, curvature) = branch.station_and_curvature(parameter);
        let own = self.tilt * Vector2::new(tangent.cos, tangent.sin);
        let t = self.nearest(Vector2::new(tangent.cos, tangent.sin), own);
        let share = 1.0 / (1.0 + t * t);
        let (sin, cos, versine) = (2.0 * t * share, (1.0 - t * t) * share, 2.0 * t * t * share);
        let [by_psi, by_v] = [
            self.skew.im * (own.x * self.tilt.re + own.y * self.tilt.im * cos) - self.skew.re * own.y * sin,
            own.x * (self.skew.im * self.tilt.im * sin + self.skew.re * cos),
        ];
        let turn = -by_psi / by_v * curvature;
        let radius = self.circle_with(tangent.x, tangent.z).radius;
        let along = tangent.cos + self.tilt.im * (radius * sin * turn - own.y * versine);
        self.skew.re * along - self.skew.im * (radius * cos * turn - own.y * sin)
    }

    /// Returns whether bounds of angle and curvature leave it open that ξ of the places turns along a piece.
    pub(super) fn may_turn(&self, piece: usize) -> bool {
        let (xi, slopes) = (self.section.pieces[piece].xi, self.section.slopes(piece));
        let [_, seconds] = self.section.branches[self.section.pieces[piece].branch].derivative_bounds(xi);
        let steepest = slopes.magnitude();
        let far = slopes.ends().map(|slope| self.parallel_to_tangent(slope).0.abs());
        let t = far[0].max(far[1]);
        let (sin, cos) = (2.0 * t / (1.0 + t * t), (1.0 - t * t) / (1.0 + t * t));
        let [turned, tilted] = [self.skew.im.abs(), self.tilt.im.abs()];
        let flattest = slopes.ends().map(|slope| (self.tilt.re - self.tilt.im * slope) / 1f64.hypot(slope));
        let by_v = flattest[0].min(flattest[1]) * (self.skew.re * cos - turned * tilted * sin);
        // dψ/dp is ζ″/(1 + ζ′²).
        let turn = (turned + self.skew.re * sin) * seconds.magnitude() / by_v;
        let radii = xi.ends().map(|p| self.circle(piece, p).radius);
        let radius = radii[0].max(radii[1]) + steepest * xi.width();
        let growth = tilted + steepest * self.tilt.re;
        let most = growth * (tilted * (1.0 - cos) + turned * sin) + radius * turn * (turned + tilted * sin);
        !(by_v > 0.0 && most < self.skew.re)
    }

    /// Returns ξ at which a circle crosses the line of constant η, next to the midplane; NaN if it does not.
    pub(in crate::patch) fn xi_at(&self, piece: usize, p: f64, eta: f64) -> f64 {
        let circle = self.circle(piece, p);
        let constant = circle.p * self.skew.im - eta;
        let square = constant + 2.0 * circle.radius * self.tilt.im * self.skew.im;
        let half = circle.radius * self.skew.re;
        let t = -constant / (half + (half * half - square * constant).sqrt().copysign(half));
        self.place(&circle, t).xi
    }

    /// Returns the place at t on a circle.
    pub(super) fn place(&self, circle: &Circle, t: f64) -> PlanePoint {
        let share = 2.0 / (1.0 + t * t);
        let along = circle.p + circle.radius * share * t * t * self.tilt.im;
        let across = circle.radius * share * t;
        let turned = self.skew * Vector2::new(along, across);
        PlanePoint { xi: turned.x, eta: turned.y }
    }

    /// Returns ζ of the wheel at t on a circle \[mm\].
    pub(super) fn height(&self, circle: &Circle, t: f64) -> f64 {
        circle.height + circle.radius * 2.0 * t * t / (1.0 + t * t) * self.tilt.re
    }

    /// Returns the unit vector \[dξ, dζ\] along any circle at t, towards larger t; without skew away from the midplane.
    pub(super) fn direction(&self, t: f64) -> Vector2<f64> {
        // Without skew both halves of a circle lie on one straight line of ξ and ζ, which ends at t = 0.
        let (sin, cos) = if self.is_skewed() { (2.0 * t, 1.0 - t * t) } else { (1.0, 0.0) };
        Vector2::new(self.tilt.im * self.skew.re * sin - self.skew.im * cos, sin * self.tilt.re).normalize()
    }

    /// Returns the rounding of ξ and ζ \[mm\].
    pub(in crate::patch) fn rounding(&self) -> f64 {
        64.0 * f64::EPSILON * self.axle
    }

    /// Returns t where a circle is parallel to η: a line of constant ξ touches the circle there.
    pub(super) fn touching(&self) -> f64 {
        ((self.skew.im / (self.tilt.im * self.skew.re)).atan() / 2.0).tan()
    }

    /// Returns where a line of constant ξ touches the circle of the left (0) or right (1) end of the profile, at most as far off as
    /// [`FARTHEST`], and ζ of the wheel there \[mm\].
    pub(in crate::patch) fn touched(&self, end: usize) -> Option<(PlanePoint, f64)> {
        let pieces = &self.section.pieces;
        let last = pieces.len().checked_sub(1)?;
        let piece = [0, last][end];
        let (circle, t) =
            (self.circle(piece, pieces[piece].xi[end]), self.touching().clamp(-FARTHEST, FARTHEST));
        Some((self.place(&circle, t), self.height(&circle, t)))
    }

    /// Returns both t at which a circle crosses the ends of a range of η, widened a little.
    pub(super) fn turns(&self, circle: &Circle, eta: Interval) -> [f64; 2] {
        eta.grown(MARGIN * eta.width()).ends().map(|eta| {
            // The circle also moves along the profile as it turns. This is left out, and the margin covers it.
            let sin = (eta - circle.p * self.skew.im) / (self.skew.re * circle.radius);
            let sin = sin.clamp(-FARTHEST_SINE, FARTHEST_SINE);
            sin / (1.0 + (1.0 - sin * sin).sqrt())
        })
    }

    /// Returns whether lines of constant ξ leave the wheel over one end of its profile, the left (0) or the right (1), and
    /// enter it again.
    pub(in crate::patch) fn is_hollow(&self, end: usize) -> bool {
        if end == 0 { self.tilt.im < 0.0 } else { self.tilt.im > 0.0 }
    }

    /// Returns both t at which the line of constant ξ meets a circle; NaN if it does not meet it.
    pub(super) fn crossings(&self, circle: &Circle, xi: f64) -> [f64; 2] {
        let constant = circle.p * self.skew.re - xi;
        let square = constant + 2.0 * circle.radius * self.tilt.im * self.skew.re;
        let half = circle.radius * self.skew.im;
        let sum = half + (half * half - square * constant).sqrt().copysign(half);
        [constant / sum, sum / square]
    }
}

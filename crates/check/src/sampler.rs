//! Samples points of both bodies from the profiles' own parametrisation. Nothing here uses the separation code.
//!
//! Points of a curve come from its start station and curvature (arcs, lines) or from its coefficients (polynomials).
//! The rail is the curve moved along y; wheel and roller are the curve turned about their axle. All coordinates are
//! measured from the contact point, so that the axle's distance costs no digits.

use super::meshes::Vector;
use wheelrail::Interval;
use wheelrail::internal::{Twice, recentred};
use wheelrail::placement::{Body, Generator, Placement};
use wheelrail::profile::{Polynomial, Segment, Shape, Station};

/// One segment as a curve (x − x_C, z − z_C)(t), 0 ≤ t ≤ length.
#[derive(Debug, Clone)]
pub(super) struct SampledCurve {
    shape: SampledForm,
    /// Largest parameter: \[mm\] along arcs and lines, else in the polynomial's own unit.
    pub length: f64,
    /// Range of the parameter over which the curve turns by about 1 rad: a radius, or the length of a line.
    pub scale: f64,
    /// Upper bound of the arc length \[mm\].
    pub longest: f64,
}

#[derive(Debug, Clone)]
enum SampledForm {
    Turning {
        start: Station,
        curvature: f64,
    },
    /// With the coefficients of (x − x_C, z − z_C) about the beginning of the range; in double-double, as terms may be much
    /// larger than their sum.
    Polynomial {
        polynomial: Polynomial,
        local: [Vec<Twice>; 2],
    },
}

/// Returns the coefficients of a polynomial about the parameter `begin`, with `less` subtracted from the first. Coefficients are
/// double-double, so that the difference keeps its digits.
fn about(c: &[[f64; 2]], begin: f64, less: f64) -> Vec<Twice> {
    let mut local = recentred(&exact(c), begin.into());
    if let Some(first) = local.first_mut() {
        *first -= less;
    }
    local
}

fn exact(c: &[[f64; 2]]) -> Vec<Twice> {
    c.iter().map(|[high, low]| Twice::sum(*high, *low)).collect()
}

impl SampledCurve {
    /// Makes the curve of a segment, relative to `origin`; `longest` bounds the scale of an arc or line \[mm\].
    pub fn of_segment(segment: &Segment, origin: [f64; 2], longest: f64) -> Self {
        match &segment.shape {
            Shape::Arc(arc) => {
                let length = arc.length();
                let scale = if arc.radius().is_finite() { arc.radius().abs() } else { length };
                Self::turning(&arc.start(), arc.curvature(), length, scale.min(longest), origin)
            }
            Shape::Polynomial(polynomial) => {
                let length = polynomial.range()[1] - polynomial.range()[0];
                let [x, z] = polynomial.coefficients();
                let begin = polynomial.range()[0];
                let local = [(x, origin[0]), (z, origin[1])].map(|(c, origin)| about(&c, begin, origin));
                let shape = SampledForm::Polynomial { polynomial: polynomial.clone(), local };
                let curve = Self { shape, length, scale: length, longest: length };
                curve.with_scale_of_polynomial(polynomial)
            }
        }
    }

    fn turning(start: &Station, curvature: f64, length: f64, scale: f64, [x, z]: [f64; 2]) -> Self {
        let start = Station { x: start.x - x, z: start.z - z, ..*start };
        Self { shape: SampledForm::Turning { start, curvature }, length, scale, longest: length }
    }

    /// Sets the scale to the smaller of the parameter range and the smallest of nine radii of curvature, in units of
    /// the parameter, and sets the bound of the arc length.
    fn with_scale_of_polynomial(mut self, polynomial: &Polynomial) -> Self {
        let range = polynomial.range();
        for k in 0..=8 {
            let t = range.step(k, 8);
            let speed = self.speed(t - range.low);
            self.scale = self.scale.min((polynomial.curvature(t) * speed).abs().recip());
        }
        let half = self.length / 2.0;
        self.longest = self.length * (self.speed(half) + self.bend(half, half) * half);
        self
    }

    /// Returns (x − x_C, z − z_C) \[mm\] in profile axes. Beyond its ends the curve continues unchanged.
    pub fn point(&self, t: f64) -> [f64; 2] {
        match &self.shape {
            SampledForm::Turning { start, curvature } => {
                // Half the turn: the chord has the mean angle of its two end tangents.
                let half = t * curvature / 2.0;
                let chord = if half == 0.0 { t } else { t * (half.sin() / half) };
                let (sin, cos) = half.sin_cos();
                [
                    start.x + chord * (start.cos * cos - start.sin * sin),
                    start.z + chord * (start.sin * cos + start.cos * sin),
                ]
            }
            SampledForm::Polynomial { local: [x, z], .. } => {
                [x, z].map(|c| c.iter().rev().fold(Twice::from(0.0), |sum, c| sum * t + *c).into())
            }
        }
    }

    /// Returns the angle \[rad\] of the tangent in profile axes.
    pub fn angle(&self, t: f64) -> f64 {
        match &self.shape {
            SampledForm::Turning { start, curvature } => start.angle() + t * curvature,
            SampledForm::Polynomial { polynomial, .. } => {
                polynomial.station(polynomial.range()[0] + t).angle()
            }
        }
    }

    /// Returns the parameter of that of 65 samples which is nearest to the contact point.
    pub fn nearest_to_origin(&self) -> f64 {
        let distance = |t: f64| self.point(t).into_iter().fold(0.0, f64::hypot);
        let samples = (0..=64).map(|k| self.length * f64::from(k) / 64.0);
        samples.min_by(|&a, &b| distance(a).total_cmp(&distance(b))).unwrap_or(0.0)
    }

    /// Returns the arc length per unit of the parameter, by a central difference with eight correct digits or more: for
    /// sizes of cells, steps and bounds, not for measured values.
    pub fn speed(&self, t: f64) -> f64 {
        let h = self.scale * f64::EPSILON.cbrt();
        let ([x0, z0], [x1, z1]) = (self.point(t - h), self.point(t + h));
        (x1 - x0).hypot(z1 - z0) / (2.0 * h)
    }

    /// Returns a bound of |d²(x, z)/dt²| within `reach` of t.
    pub fn bend(&self, t: f64, reach: f64) -> f64 {
        match &self.shape {
            SampledForm::Turning { curvature, .. } => curvature.abs(),
            SampledForm::Polynomial { polynomial, .. } => {
                let bound = |c: &[[f64; 2]]| -> f64 {
                    let local = recentred(&exact(c), (polynomial.range()[0] + t).into());
                    let terms = local.iter().enumerate().skip(2);
                    terms
                        .map(|(k, &c)| {
                            let (power, c) = (k as i32 - 2, f64::from(c).abs());
                            (k * (k - 1)) as f64 * c * reach.powi(power)
                        })
                        .sum()
                };
                let [x, z] = polynomial.coefficients();
                bound(&x).hypot(bound(&z))
            }
        }
    }
}

/// One body's surface in the contact frame, with parameters (curve, t, v); v is the length along y, or around the axle
/// at the distance of C from it \[mm\]. ∂X/∂t × ∂X/∂v points up where the surface faces the other body.
#[derive(Debug, Clone)]
pub(super) struct SampledSurface {
    /// The curves, in order of the chain.
    pub curves: Vec<SampledCurve>,
    cos: f64,
    sin: f64,
    /// Whether this is the upper body.
    is_wheel: bool,
    /// How the curve is turned; `None` for a rail.
    turned: Option<AboutAxle>,
    /// Lift along ζ \[mm\].
    lift: f64,
    /// Size of the coordinates \[mm\], to which the rounding of a point is proportional.
    pub size: f64,
}

/// The axle about which a curve is turned.
#[derive(Debug, Clone, Copy)]
struct AboutAxle {
    /// Height of the axle over C \[mm\], negative for a roller's.
    axle: f64,
    /// sin χ and cos χ.
    skew: (f64, f64),
}

impl SampledSurface {
    /// Makes the rail of a placed pair: extruded, or turned about a roller's axle.
    pub fn rail(placement: &Placement) -> Self {
        let z = placement.rail().point().station.z;
        let turned = match placement.rail().generator() {
            Generator::Extruded => None,
            Generator::Revolved { radius } => Some(AboutAxle { axle: -(radius + z), skew: (0.0, 1.0) }),
        };
        Self::new(placement.rail(), false, turned)
    }

    /// Makes the revolved wheel of a placed pair, turned about ζ by the skew.
    pub fn wheel(placement: &Placement) -> Self {
        let axle = placement.wheel_radius() - placement.wheel().point().station.z;
        Self::new(placement.wheel(), true, Some(AboutAxle { axle, skew: placement.skew().sin_cos() }))
    }

    fn new(body: &Body, is_wheel: bool, turned: Option<AboutAxle>) -> Self {
        let c = body.point().station;
        let origin = [c.x, c.z];
        let extent = body.profile().extent();
        let segments = body.profile().segments().iter();
        let curves = segments.map(|segment| SampledCurve::of_segment(segment, origin, extent)).collect();
        let size = extent + c.x.abs() + c.z.abs();
        Self { curves, cos: c.cos, sin: c.sin, is_wheel, turned, lift: 0.0, size }
    }

    /// Returns the surface raised along ζ by `lift` \[mm\].
    pub fn lifted(&self, lift: f64) -> Self {
        Self { lift, ..self.clone() }
    }

    /// Returns whether this is the wheel.
    pub fn is_wheel(&self) -> bool {
        self.is_wheel
    }

    /// Returns the point (ξ, η, ζ) \[mm\].
    pub fn point(&self, curve: usize, t: f64, v: f64) -> Vector {
        let [x, z] = self.curves[curve].point(t);
        let Some(AboutAxle { axle, skew }) = self.turned else {
            return Vector::new(x * self.cos + z * self.sin, v, z * self.cos - x * self.sin + self.lift);
        };
        // Turned about the axle by φ: z rises by w(1 − cos φ) = 2w sin²(φ/2), w negative over a roller's axle.
        let (w, half) = (axle - z, v / axle / 2.0);
        let (sin, cos) = half.sin_cos();
        let (y, z) = (2.0 * w * sin * cos, z + 2.0 * w * sin * sin);
        let (along, zeta) = (x * self.cos + z * self.sin, z * self.cos - x * self.sin);
        Vector::new(along * skew.1 - y * skew.0, along * skew.0 + y * skew.1, zeta + self.lift)
    }

    /// Returns \[∂X/∂t, ∂X/∂v\] by central differences, for Newton steps.
    pub fn tangents(&self, curve: usize, t: f64, v: f64) -> [Vector; 2] {
        let h = self.curves[curve].scale * f64::EPSILON.cbrt();
        let k = self.round_scale() * f64::EPSILON.cbrt();
        [
            (self.point(curve, t + h, v) - self.point(curve, t - h, v)) / (2.0 * h),
            (self.point(curve, t, v + k) - self.point(curve, t, v - k)) / (2.0 * k),
        ]
    }

    /// Returns the length \[mm\] of v over which the surface turns by 1 rad: the distance of C from the axle; for an
    /// extruded rail, which does not turn, its size.
    pub fn round_scale(&self) -> f64 {
        self.turned.map_or(self.size, |turned| turned.axle.abs())
    }

    /// Returns the largest v needed for points up to `reach` from the origin in the ξ–η plane.
    pub fn v_reach(&self, reach: f64) -> f64 {
        // The chord of an angle is at least 2/π of its arc.
        reach * std::f64::consts::FRAC_PI_2
    }

    /// Returns the range of the ζ component of the unit normals of points up to `reach` from one at v and
    /// height `z` over C, if the profile's tangents have angles \[rad\] between `tilts`.
    ///
    /// Method: n = cosψ cosφ cosθ + sinψ sinθ at the tangent's angle ψ, turned about the axle by φ.
    pub fn normals_between(&self, tilts: Interval, v: f64, z: f64, reach: f64) -> Interval {
        let turned = self.turned.map_or([0.0; 2], |AboutAxle { axle, .. }| {
            // The chord of an angle is at least 2/π of its arc.
            let least = (axle - z).abs() - reach;
            let (turn, away) = ((v / axle).abs(), reach * std::f64::consts::FRAC_PI_2 / least);
            [(turn - away).max(0.0), turn + away]
        });
        let mut out = Interval::NONE;
        for cos in turned.map(f64::cos) {
            let (up, along) = (cos * self.cos, self.sin);
            let crest = along.atan2(up);
            let at = |tilt: f64| up * tilt.cos() + along * tilt.sin();
            let highest = (tilts.low < crest && crest < tilts.high).then(|| up.hypot(along));
            out = tilts.ends().map(at).into_iter().chain(highest).fold(out, Interval::with);
        }
        out
    }

    /// Returns the cell size in v \[mm\] whose sagitta is that of a cell of `h` parameter units in t.
    pub fn v_cell(&self, curve: usize, t: f64, h: f64) -> f64 {
        let curve = &self.curves[curve];
        let speed = curve.speed(t);
        h * speed * (self.round_scale() / (curve.scale * speed)).sqrt().max(1.0)
    }

    /// Returns a bound \[mm\] of the distance between the surface and a triangle whose legs are the sides (h, k) of a cell
    /// at t, ¼ ‖D²X‖ in units of the cell, and the angle \[rad\] by which the normal can turn over a cell.
    pub fn chordal_bound(&self, curve: usize, t: f64, [h, k]: [f64; 2]) -> [f64; 2] {
        let reach = 3.0 * h;
        let (bend, speed) = (self.curves[curve].bend(t, reach), self.curves[curve].speed(t));
        let least_speed = (speed - bend * reach).max(0.0);
        let turn = bend * h / least_speed;
        let along = h * h * bend;
        let Some(AboutAxle { axle, .. }) = self.turned else { return [along / 4.0, turn] };
        let [_, z] = self.curves[curve].point(t);
        let greatest_speed = speed + bend * reach;
        let mixed = h * k * greatest_speed / axle.abs();
        let around = k * k * ((axle - z).abs() + reach * greatest_speed) / (axle * axle);
        [(along * along + 2.0 * mixed * mixed + around * around).sqrt() / 4.0, turn + k / axle.abs()]
    }
}

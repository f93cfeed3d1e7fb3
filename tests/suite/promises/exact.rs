//! s to some 28 digits, by three-dimensional geometry: no sagitta, no span, no expansion.
//!
//! The wheel is its axle, a point and a direction in space, and its profile as a graph z(x); the rail is its profile. Along the
//! line through (ξ, η) parallel to ζ a body begins where "inside" changes its sign: R − z(x) less the distance from the axle for
//! the wheel, z(x) − z for the rail. The first such place is found by steps in binary64 and bisection, and then refined.

use super::twice::Twice;
use wheelrail::profile::{Arc, Half, Polynomial, Profile, Segment as ProfileSegment, Shape};
use wheelrail_report::reference::ReferenceSegment;

/// Steps along ζ \[mm\], and how far from C they go: no built-in profile reaches further in any frame.
const STEP: f64 = 0.25;
const FARTHEST: f64 = 90.0;

/// Nearer than this to an end of a segment \[mm\], or at less than this slope of "inside" along ζ, a place is left out.
const AT_AN_END: f64 = 1e-6;
const GRAZING: f64 = 0.02;

/// What "inside" may be off zero on a surface \[mm\].
const ON_SURFACE: f64 = 1e-7;

/// What lies along one line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Found {
    /// ζ \[mm\].
    At(Twice),
    /// No surface that faces the other body.
    Nothing,
    /// Too near a joint, an end or a grazing line to tell.
    Unclear,
}

/// z(x) of one segment, from numbers that are taken as they are.
enum Graph {
    Line { z0: f64, slope: Twice },
    Arc { a: f64, b: f64, radius: f64, sign: f64 },
    Curve { t: [f64; 2], x: Vec<Twice>, z: Vec<Twice> },
}

struct Segment {
    x: [f64; 2],
    graph: Graph,
}

/// A profile as a graph.
pub struct Exact {
    segments: Vec<Segment>,
}

/// The profile and its exact double: arcs by centre and radius, rounded first, so that both mean the same numbers. `None` where an
/// arc is no part of half a circle in these numbers.
pub fn doubled(profile: &Profile) -> Option<(Profile, Exact)> {
    let (mut rebuilt, mut exact) = (Vec::new(), Vec::new());
    for segment in profile.segments() {
        let x = [segment.start().x, segment.end().x];
        let (shape, graph) = match &segment.shape {
            Shape::Arc(arc) => match arc.centre() {
                None => {
                    let slope = (Twice::from(arc.end().z) - Twice::from(arc.start().z))
                        / (Twice::from(x[1]) - Twice::from(x[0]));
                    let line = Arc::line([x[0], arc.start().z], [x[1], arc.end().z]).ok()?;
                    (Shape::Arc(line), Graph::Line { z0: arc.start().z, slope })
                }
                Some([a, b]) => {
                    let radius = arc.radius().abs();
                    let (half, sign) =
                        if arc.radius() < 0.0 { (Half::Upper, 1.0) } else { (Half::Lower, -1.0) };
                    (Shape::Arc(Arc::about([a, b], radius, half, x).ok()?), Graph::Arc { a, b, radius, sign })
                }
            },
            Shape::Polynomial(p) => {
                if !ascends(p) {
                    return None;
                }
                let [x, z] =
                    p.coefficients().map(|c| c.into_iter().map(|[high, low]| Twice { high, low }).collect());
                (segment.shape.clone(), Graph::Curve { t: p.range().ends(), x, z })
            }
        };
        rebuilt.push(ProfileSegment { label: String::new(), shape });
        exact.push(Segment { x, graph });
    }
    Some((Profile::new(profile.name.clone(), "rebuilt", rebuilt).ok()?, Exact { segments: exact }))
}

/// Whether x grows along a curve, at places close enough for the cubics of a spline: one that turns back is no graph.
fn ascends(curve: &Polynomial) -> bool {
    let stations = (0..=64).map(|k| curve.station(curve.range().at(f64::from(k) / 64.0)));
    stations.into_iter().all(|station| station.cos > 0.0)
}

/// Value and derivative by Horner's rule.
fn horner(c: &[Twice], t: Twice) -> [Twice; 2] {
    let zero = Twice::from(0.0);
    c.iter().rev().fold([zero; 2], |[p, d], &c| [p * t + c, d * t + p])
}

fn horner64(c: &[Twice], t: f64) -> [f64; 2] {
    c.iter().rev().fold([0.0; 2], |[p, d], c| [p * t + c.high, d * t + p])
}

impl Graph {
    /// The parameter at x in binary64.
    fn parameter(c: &[Twice], [low, high]: [f64; 2], x: f64) -> f64 {
        let (mut low, mut high) = (low, high);
        let mut t = 0.5 * (low + high);
        for _ in 0..80 {
            let [value, slope] = horner64(c, t);
            if value > x {
                high = t
            } else {
                low = t
            }
            let newton = t - (value - x) / slope;
            let next = if low <= newton && newton <= high { newton } else { 0.5 * (low + high) };
            if (next - t).abs() <= 1e-15 * (high - low).abs().max(t.abs()) {
                return next;
            }
            t = next;
        }
        t
    }

    fn z64(&self, [x0, _]: [f64; 2], x: f64) -> f64 {
        match self {
            Self::Line { z0, slope } => z0 + slope.high * (x - x0),
            Self::Arc { a, b, radius, sign } => {
                b + sign * ((radius - (x - a)) * (radius + (x - a))).max(0.0).sqrt()
            }
            Self::Curve { t, x: cx, z } => horner64(z, Self::parameter(cx, *t, x))[0],
        }
    }

    /// z and dz/dx.
    fn z(&self, [x0, _]: [f64; 2], x: Twice) -> [Twice; 2] {
        match self {
            Self::Line { z0, slope } => [Twice::from(*z0) + *slope * (x - Twice::from(x0)), *slope],
            Self::Arc { a, b, radius, sign } => {
                let (run, radius, sign) = (x - Twice::from(*a), Twice::from(*radius), Twice::from(*sign));
                let root = ((radius - run) * (radius + run)).sqrt();
                [Twice::from(*b) + sign * root, -(sign * run) / root]
            }
            Self::Curve { t, x: cx, z } => {
                let mut t = Twice::from(Self::parameter(cx, *t, x.high));
                for _ in 0..3 {
                    let [value, slope] = horner(cx, t);
                    t = t - (value - x) / slope;
                }
                let ([_, dx], [z, dz]) = (horner(cx, t), horner(z, t));
                [z, dz / dx]
            }
        }
    }
}

impl Exact {
    /// The segment that holds x, at a joint the left one.
    fn segment(&self, x: f64) -> Option<&Segment> {
        let index = self.segments.partition_point(|segment| segment.x[1] < x);
        self.segments.get(index).filter(|segment| segment.x[0] <= x)
    }

    /// z at x, cos and sin of the tangent's angle.
    fn frame(&self, x: f64) -> Option<[Twice; 3]> {
        let segment = self.segment(x)?;
        let [z, slope] = segment.graph.z(segment.x, x.into());
        let cos = Twice::from(1.0) / (Twice::from(1.0) + slope * slope).sqrt();
        Some([z, cos, slope * cos])
    }
}

/// A placed pair.
pub struct Pair<'a> {
    rail: (&'a Exact, Twice, [Twice; 3]),
    wheel: &'a Exact,
    radius: Twice,
    /// Point of the axle in the contact frame, its direction, and the profile abscissa of that point.
    axle: ([Twice; 3], [Twice; 3], Twice),
}

/// A line parallel to ζ: what is inside a body.
trait Inside {
    /// The profile and the abscissa x(ζ) = x_0 + x_1 ζ.
    fn abscissa(&self) -> (&Exact, [Twice; 2]);
    /// Positive inside, from z of the profile at the abscissa.
    fn inside(&self, zeta: Twice, z: Twice) -> Twice;
    fn inside64(&self, zeta: f64, z: f64) -> f64;
}

struct InRail<'a> {
    rail: &'a Exact,
    x: [Twice; 2],
    z: [Twice; 2],
}

impl Inside for InRail<'_> {
    fn abscissa(&self) -> (&Exact, [Twice; 2]) {
        (self.rail, self.x)
    }
    fn inside(&self, zeta: Twice, z: Twice) -> Twice {
        z - (self.z[0] + self.z[1] * zeta)
    }
    fn inside64(&self, zeta: f64, z: f64) -> f64 {
        z - (self.z[0].high + self.z[1].high * zeta)
    }
}

struct InWheel<'a> {
    wheel: &'a Exact,
    x: [Twice; 2],
    /// Squared distance from the axle as a polynomial in ζ.
    square: [Twice; 3],
    radius: Twice,
}

impl Inside for InWheel<'_> {
    fn abscissa(&self) -> (&Exact, [Twice; 2]) {
        (self.wheel, self.x)
    }
    fn inside(&self, zeta: Twice, z: Twice) -> Twice {
        let [a, b, c] = self.square;
        self.radius - z - (a + zeta * (b + zeta * c)).sqrt()
    }
    fn inside64(&self, zeta: f64, z: f64) -> f64 {
        let [a, b, c] = self.square.map(|c| c.high);
        self.radius.high - z - (a + zeta * (b + zeta * c)).sqrt()
    }
}

fn dot(a: [Twice; 3], b: [Twice; 3]) -> Twice {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Whether a place on a line is on the surface of the body.
fn on_surface(line: &impl Inside, zeta: f64) -> bool {
    let (profile, x) = line.abscissa();
    let x = x[0].high + x[1].high * zeta;
    let inside = profile.segment(x).map(|segment| line.inside64(zeta, segment.graph.z64(segment.x, x)));
    inside.is_some_and(|inside| inside.abs() <= ON_SURFACE)
}

/// Where a line first enters a body; `upwards` along ζ or downwards.
fn entered(line: &impl Inside, upwards: bool) -> Found {
    let (profile, x) = line.abscissa();
    let at = |zeta: f64| {
        let x = x[0].high + x[1].high * zeta;
        let segment = profile.segment(x)?;
        Some((line.inside64(zeta, segment.graph.z64(segment.x, x)), segment, x))
    };
    let sign = if upwards { 1.0 } else { -1.0 };
    let mut before: Option<(f64, f64)> = None;
    let count = (2.0 * FARTHEST / STEP) as u32;
    for k in 0..=count {
        let zeta = sign * (f64::from(k) * STEP - FARTHEST);
        let here = at(zeta).map(|(inside, ..)| inside);
        if let (None, Some(inside)) = (before, here) {
            // The profile begins since the last step: there it may be outside still.
            let begin = first_held([zeta - sign * STEP, zeta], &at);
            before = at(begin).map(|(inside, ..)| (begin, inside)).filter(|_| inside >= 0.0);
        }
        if let (Some((last, outside)), Some(inside)) = (before, here)
            && outside < 0.0
            && inside >= 0.0
        {
            return refined(line, [last, zeta], &at);
        }
        before = here.map(|inside| (zeta, inside));
    }
    Found::Nothing
}

/// The first place that has a value, of two of which the second one has.
fn first_held<'s>(
    [mut without, mut with]: [f64; 2],
    at: &impl Fn(f64) -> Option<(f64, &'s Segment, f64)>,
) -> f64 {
    for _ in 0..60 {
        let middle = without + 0.5 * (with - without);
        if at(middle).is_some() { with = middle } else { without = middle }
    }
    with
}

fn refined<'s>(
    line: &impl Inside,
    [mut out, mut within]: [f64; 2],
    at: &impl Fn(f64) -> Option<(f64, &'s Segment, f64)>,
) -> Found {
    for _ in 0..70 {
        let middle = out + 0.5 * (within - out);
        match at(middle) {
            Some((inside, ..)) if inside >= 0.0 => within = middle,
            Some(_) => out = middle,
            None => return Found::Unclear,
        }
    }
    let Some((_, segment, abscissa)) = at(within) else { return Found::Unclear };
    if abscissa - segment.x[0] < AT_AN_END || segment.x[1] - abscissa < AT_AN_END {
        return Found::Unclear;
    }
    let (_, x) = line.abscissa();
    let value = |zeta: Twice| line.inside(zeta, segment.graph.z(segment.x, x[0] + x[1] * zeta)[0]);
    let h = 1e-7;
    let mut zeta = Twice::from(within);
    let slope = (value(zeta + Twice::from(h)) - value(zeta - Twice::from(h))).high / (2.0 * h);
    if slope.is_nan() || slope.abs() < GRAZING {
        return Found::Unclear;
    }
    for _ in 0..4 {
        zeta = zeta - value(zeta) / Twice::from(slope);
    }
    Found::At(zeta)
}

impl<'a> Pair<'a> {
    /// C at abscissae of both profiles, the wheel of radius R turned by χ about ζ.
    pub fn new(
        rail: &'a Exact,
        wheel: &'a Exact,
        radius: f64,
        [rail_x, wheel_x]: [f64; 2],
        skew: f64,
    ) -> Option<Self> {
        let (of_rail, [z, cos, sin]) = (rail.frame(rail_x)?, wheel.frame(wheel_x)?);
        let rolling = Twice::from(radius) - z;
        let (turn_sin, turn_cos) = Twice::from(skew).sin_cos();
        let point = [sin * turn_cos, sin * turn_sin, cos].map(|v| v * rolling);
        let direction = [cos * turn_cos, cos * turn_sin, -sin];
        let axle = (point, direction, Twice::from(wheel_x));
        Some(Self { rail: (rail, rail_x.into(), of_rail), wheel, radius: radius.into(), axle })
    }

    /// ζ of the rail.
    pub fn rail(&self, xi: f64) -> Found {
        entered(&self.in_rail(xi), false)
    }

    /// The line through ξ.
    fn in_rail(&self, xi: f64) -> InRail<'_> {
        let (rail, x_c, [z_c, cos, sin]) = self.rail;
        let xi = Twice::from(xi);
        InRail { rail, x: [x_c + xi * cos, -sin], z: [z_c + xi * sin, cos] }
    }

    /// ζ of the wheel.
    pub fn wheel(&self, xi: f64, eta: f64) -> Found {
        entered(&self.in_wheel(xi, eta), true)
    }

    /// The line through (ξ, η).
    fn in_wheel(&self, xi: f64, eta: f64) -> InWheel<'_> {
        let (q, a, x_q) = self.axle;
        let from = [Twice::from(xi) - q[0], Twice::from(eta) - q[1], -q[2]];
        let (along, one, two) = (dot(from, a), Twice::from(1.0), Twice::from(2.0));
        let square = [dot(from, from) - along * along, two * (from[2] - along * a[2]), one - a[2] * a[2]];
        InWheel { wheel: self.wheel, x: [x_q + along, a[2]], square, radius: self.radius }
    }

    /// Whether the rail has a surface at this ζ, and the wheel where s leads to from there.
    pub fn on_both(&self, [xi, eta]: [f64; 2], rail: f64, s: f64) -> bool {
        on_surface(&self.in_rail(xi), rail) && on_surface(&self.in_wheel(xi, eta), rail + s)
    }

    /// s \[mm\].
    pub fn separation(&self, xi: f64, eta: f64) -> Found {
        match (self.rail(xi), self.wheel(xi, eta)) {
            (Found::At(rail), Found::At(wheel)) => Found::At(wheel - rail),
            (Found::Unclear, _) | (_, Found::Unclear) => Found::Unclear,
            _ => Found::Nothing,
        }
    }
}

impl Exact {
    /// The profile of a file of 60-digit values.
    pub fn of_reference(segments: &[ReferenceSegment]) -> Self {
        let exact = |c: &[f64]| c.iter().map(|&c| Twice::from(c)).collect();
        let segments = segments.iter().map(|segment| match segment {
            ReferenceSegment::Line { x0, z0, x1, z1 } => {
                let slope = (Twice::from(*z1) - Twice::from(*z0)) / (Twice::from(*x1) - Twice::from(*x0));
                Segment { x: [*x0, *x1], graph: Graph::Line { z0: *z0, slope } }
            }
            ReferenceSegment::Arc { x0, x1, a, b, r, sigma } => {
                Segment { x: [*x0, *x1], graph: Graph::Arc { a: *a, b: *b, radius: *r, sign: *sigma } }
            }
            ReferenceSegment::Poly { x0, x1, c } => {
                // Its own parameter is x.
                let x = [0.0, 1.0].map(Twice::from).to_vec();
                Segment { x: [*x0, *x1], graph: Graph::Curve { t: [*x0, *x1], x, z: exact(c) } }
            }
            ReferenceSegment::Spline { t1, cx, cz } => {
                let (x, z): (Vec<_>, Vec<_>) = (exact(cx), exact(cz));
                let ends = [0.0, *t1].map(|t| horner64(&x, t)[0]);
                Segment { x: ends, graph: Graph::Curve { t: [0.0, *t1], x, z } }
            }
        });
        Self { segments: segments.collect() }
    }
}

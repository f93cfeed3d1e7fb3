//! The elements of a profile's outer surface: arcs, lines, stretches of polynomials, and the fans of normals
//! at kinks and ends. Each is a curve over its own parameter, which passes the vertical without a
//! singularity.

use super::bounds::{Bounds, DerivativeBounds};
use crate::numerics::cosine;
use crate::numerics::interval::Interval;
use crate::profile::{ArcBranch, Side, Station};

/// Amount by which a sine may exceed the ends of an element: a root on a joint may come out this far beyond
/// either neighbour. A smaller value loses the root; a larger one only moves it, by as little.
pub(super) const SINE_ROUNDING: f64 = 4.0 * f64::EPSILON;

/// One stretch of a profile, or the fan of normals at one of its points.
#[derive(Debug, Clone)]
pub(super) struct Element {
    /// Kind of curve, with its data.
    pub shape: ElementCurve,
    /// Range of the parameter, ascending: sinφ of an arc or fan, x \[mm\] of a line, t of a stretch.
    pub range: Interval,
    /// The points at the ends of `range`.
    pub ends: [Station; 2],
    /// The point in the middle of `range`.
    pub middle: ElementPoint,
    /// Guaranteed bounds of the element.
    pub bounds: Bounds,
}

/// The kinds of curve that the search distinguishes.
#[derive(Debug, Clone, Copy)]
pub(super) enum ElementCurve {
    /// An arc; a fan is an arc of radius 0.
    Arc(ArcElement),
    /// A line.
    Line,
    /// A part of a polynomial.
    Stretch(PolynomialPart),
}

/// An arc with the sine of its tangent angle as parameter.
#[derive(Debug, Clone, Copy)]
pub(super) struct ArcElement {
    anchor: Station,
    /// Signed radius \[mm\], positive with the hollow side up. A fan has +0 on the wheel and −0 on the rail,
    /// so that its curvature is ±∞ as it must be.
    pub radius: f64,
    /// Curvature 1/radius \[1/mm\].
    curvature: f64,
    /// Centre \[mm\]: accurate enough for abscissae, too coarse for heights when the radius is large.
    pub centre: [f64; 2],
}

/// A part of a polynomial: where the body keeps its coefficients, and bounds of its derivatives.
#[derive(Debug, Clone, Copy)]
pub(super) struct PolynomialPart {
    /// Index of the first coefficient.
    pub first: usize,
    /// Number of coefficients.
    pub count: usize,
    /// Bounds of the derivatives.
    pub reach: DerivativeBounds,
}

/// A point of an element, with its derivatives with respect to the element's parameter.
#[derive(Debug, Clone, Copy)]
pub(super) struct ElementPoint {
    /// The point and its tangent.
    pub station: Station,
    /// Derivative of x with respect to the parameter.
    pub run: f64,
    /// Derivative of sinφ with respect to the parameter.
    pub turn: f64,
    /// Curvature \[1/mm\] of the profile, whatever the yaw.
    pub curvature: f64,
}

impl ArcElement {
    /// Makes the element of a branch that is an arc.
    pub fn of(arc: &ArcBranch) -> Self {
        let [x, z] = arc.anchor;
        let centre = [x - arc.radius * arc.sin, z + arc.radius * arc.cos];
        let anchor = Station { x, z, cos: arc.cos, sin: arc.sin };
        Self { anchor, radius: arc.radius, curvature: arc.radius.recip(), centre }
    }

    /// Makes the fan of all normals through a point.
    pub fn fan(point: &Station, side: Side) -> Self {
        let anchor = Station { cos: 1.0, sin: 0.0, ..*point };
        let radius = if side == Side::Wheel { 0.0 } else { -0.0 };
        Self { anchor, radius, curvature: radius.recip(), centre: [point.x, point.z] }
    }

    /// Returns the point with a given tangent.
    #[inline]
    pub fn at(&self, sin: f64, cos: f64) -> Station {
        let a = &self.anchor;
        let run = self.radius * (sin - a.sin);
        Station { x: a.x + run, z: a.z + run * ((a.sin + sin) / (a.cos + cos)), cos, sin }
    }

    /// Returns the sine of the tangent at an abscissa; for a fan, the sine at its anchor.
    fn sine_at(&self, x: f64) -> f64 {
        if self.radius == 0.0 { self.anchor.sin } else { self.anchor.sin + (x - self.anchor.x) / self.radius }
    }
}

impl ElementCurve {
    /// Returns the point at a parameter; `start` is a point of the line, if the shape is one.
    #[inline]
    pub fn place(&self, start: &Station, coefficients: &[[f64; 2]], p: f64) -> ElementPoint {
        match self {
            ElementCurve::Arc(arc) => ElementPoint {
                station: arc.at(p, cosine(p)),
                run: arc.radius,
                turn: 1.0,
                curvature: arc.curvature,
            },
            ElementCurve::Line => {
                let z = start.z + (p - start.x) * (start.sin / start.cos);
                ElementPoint { station: Station { x: p, z, ..*start }, run: 1.0, turn: 0.0, curvature: 0.0 }
            }
            ElementCurve::Stretch(stretch) => stretch.place(coefficients, p),
        }
    }
}

impl Element {
    /// Returns the point at a parameter, inside the element or beyond it; `coefficients` are those of the
    /// whole body.
    #[inline]
    pub fn place(&self, coefficients: &[[f64; 2]], p: f64) -> ElementPoint {
        self.shape.place(&self.ends[0], coefficients, p)
    }

    /// Returns the signed radius \[mm\] of the profile at a point of this element.
    pub fn radius(&self, place: &ElementPoint) -> f64 {
        match &self.shape {
            ElementCurve::Arc(arc) => arc.radius,
            ElementCurve::Line => f64::INFINITY,
            ElementCurve::Stretch(_) => place.curvature.recip(),
        }
    }

    /// Returns the parameter at an abscissa within the element.
    ///
    /// Accuracy: rounding. Cost for a stretch: three or four Newton steps, safeguarded by a bracket.
    pub fn parameter_at(&self, coefficients: &[[f64; 2]], x: f64) -> f64 {
        match &self.shape {
            ElementCurve::Arc(arc) => arc.sine_at(x).clamp(self.range.low, self.range.high),
            ElementCurve::Line => x,
            ElementCurve::Stretch(_) => {
                let values = self.ends.map(|end| end.x).into();
                rising_root(self.range.ends(), values, x, |p| {
                    let place = self.place(coefficients, p);
                    [place.station.x, place.run]
                })
            }
        }
    }
}

/// Returns the parameter at which a rising function equals `value`. `ends` of the parameter have the
/// function's `values`, ascending; `f` gives the function and its derivative. For a value beyond `values` it
/// returns the nearer end.
///
/// Accuracy: rounding. Cost: three or four Newton steps on a function that is nearly straight; a bracket is
/// kept.
pub(super) fn rising_root(ends: [f64; 2], values: Interval, value: f64, f: impl Fn(f64) -> [f64; 2]) -> f64 {
    let [mut low, mut high] = ends;
    let share = (value - values.low) / values.width();
    if share.is_nan() || share <= 0.0 {
        return low;
    }
    if share >= 1.0 {
        return high;
    }
    let done = 2.0 * f64::EPSILON * (low.abs() + high.abs());
    let mut p = low + (high - low) * share;
    // Halving alone takes some 60 steps.
    for _ in 0..64 {
        let [at, slope] = f(p);
        let miss = at - value;
        if miss == 0.0 {
            break;
        }
        if miss > 0.0 {
            high = p;
        } else {
            low = p;
        }
        let newton = p - miss / slope;
        let inside = (newton - low) * (newton - high) < 0.0;
        let next = if inside { newton } else { low + (high - low) / 2.0 };
        let step = (next - p).abs();
        p = next;
        if step <= done {
            break;
        }
    }
    p
}

impl PolynomialPart {
    /// Returns the point at a parameter.
    #[inline]
    pub fn place(&self, coefficients: &[[f64; 2]], t: f64) -> ElementPoint {
        let ([mut x, mut dx, mut hx], [mut z, mut dz, mut hz]) = ([0.0; 3], [0.0; 3]);
        for c in coefficients[self.first..self.first + self.count].iter().rev() {
            (hx, hz) = (hx * t + 2.0 * dx, hz * t + 2.0 * dz);
            (dx, dz) = (dx * t + x, dz * t + z);
            (x, z) = (x * t + c[0], z * t + c[1]);
        }
        let slowness = (dx * dx + dz * dz).sqrt().recip();
        let (cos, sin) = (dx * slowness, dz * slowness);
        let curvature = (cos * hz - sin * hx) * (slowness * slowness);
        ElementPoint { station: Station { x, z, cos, sin }, run: dx, turn: curvature * dx, curvature }
    }
}

/// Returns the point of a line at which a linear function, given by its `values` at the ends, equals `value`;
/// `None` outside the line.
pub(super) fn between(ends: &[Station; 2], values: Interval, value: f64, rounding: f64) -> Option<Station> {
    if !values.grown(rounding).contains(value) {
        return None;
    }
    let share = ((value - values.low) / values.width()).clamp(0.0, 1.0);
    let [a, b] = ends;
    Some(Station { x: a.x + share * (b.x - a.x), z: a.z + share * (b.z - a.z), ..*a })
}

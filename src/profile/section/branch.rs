//! One segment, or the part of it that faces the other body, as a function ζ(ξ). Computes points and chords at N abscissae
//! at once.

use std::sync;

use super::arc_branch::ArcBranch;
use super::curve::PolynomialBranch;
use super::points::{self, BranchPoint, BranchPoints, repeated};
use super::span::{TurnedPolynomial, View};
use super::turned::{rising_parts, seen_from, seen_from_own_point};
use crate::numerics::cosine;
use crate::numerics::interval::Interval;
use crate::numerics::lanes::Lanes;
use crate::numerics::polynomial::{derivatives, exact_values, value, value_and_slope, values_and_slopes};
use crate::numerics::twice::Twice;
use crate::profile::arc::Arc;
use crate::profile::polynomial::Polynomial;
use crate::profile::station::Station;

/// Least cosine of the tangent of a line that is stored by its angle. A steeper line is stored by its ends: at 1e-3 a
/// rounding of ξ is 1e-11 mm of ζ. The angle of a gentler line has more digits than a difference of ends that may be near
/// each other.
const STEEP_LINE: f64 = 1e-3;

/// A branch ζ(ξ) over a closed interval of ξ.
#[derive(Debug, Clone)]
pub struct Branch {
    /// Interval of ξ \[mm\].
    pub xi: Interval,
    /// Index of the segment that the branch is a part of.
    pub segment: usize,
    /// The curve.
    pub shape: BranchShape,
    pub(super) begins_segment: bool,
    pub(super) ends_segment: bool,
    /// ζ \[mm\] at both ends, where it is known without the curve.
    pub(super) heights: Option<[f64; 2]>,
    kind: BranchKind,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum BranchKind {
    Contact,
    Plain,
}

/// The curve of a branch, in the frame: one variant for each variant of [`super::super::Shape`].
#[derive(Debug, Clone)]
pub enum BranchShape {
    /// A line or an arc.
    Arc(ArcBranch),
    /// A polynomial curve.
    Polynomial(TurnedPolynomial),
}

impl Branch {
    /// Makes the branch from the part of an arc that faces the other body. Returns `None` if the tangent nowhere points to
    /// larger ξ.
    pub(super) fn of_arc(segment: usize, arc: &Arc, frame: &Station, contact: bool) -> Option<Self> {
        let (start, end) = (arc.start.seen_from(frame), arc.end.seen_from(frame));
        let (begins, ends) = (start.cos >= 0.0, end.cos >= 0.0);
        if !begins && !ends {
            return None;
        }
        let quarter = 1f64.copysign(arc.radius);
        let sines = [if begins { start.sin } else { -quarter }, if ends { end.sin } else { quarter }];
        let known = if begins { start } else { end };
        let abscissa = |sin: f64| known.x + (sin - known.sin) * arc.radius;
        let xi = Interval::new(
            if begins { start.x } else { abscissa(sines[0]) },
            if ends { end.x } else { abscissa(sines[1]) },
        );
        if !xi.has_width() {
            return None;
        }
        let curvature = arc.curvature();
        let shape = if contact {
            ArcBranch { anchor: [0.0; 2], sin: 0.0, cos: 1.0, radius: arc.radius, curvature }
        } else {
            let sin = flattest(sines);
            let cos = if sin == start.sin {
                start.cos
            } else if sin == end.sin {
                end.cos
            } else {
                cosine(sin)
            };
            // The anchor is reached from the end that is nearer in angle. Often that end is the flattest point itself, and
            // often it is the joint nearest to C.
            let from_end = ends && (!begins || (sin - end.sin).abs() < (sin - start.sin).abs());
            let known = if from_end { end } else { start };
            let run = if curvature == 0.0 || sin == known.sin { 0.0 } else { (sin - known.sin) * arc.radius };
            let rise = run * ((known.sin + sin) / (known.cos + cos));
            ArcBranch { anchor: [known.x + run, known.z + rise], sin, cos, radius: arc.radius, curvature }
        };
        let kind = if contact { BranchKind::Contact } else { BranchKind::Plain };
        let shape = BranchShape::Arc(shape);
        let mut branch =
            Self { xi, segment, shape, begins_segment: begins, ends_segment: ends, heights: None, kind };
        branch.keep_ends([start.z, end.z]);
        Some(branch)
    }

    /// Makes the branch begin at `joint`, where its left neighbour ends. The two segments round a common joint differently,
    /// and the smallest gap between two pieces would be an end of the profile.
    pub(super) fn begin_at(&mut self, joint: f64) {
        if joint < self.xi.high {
            let heights = self.xi.ends().map(|xi| self.height(xi));
            self.xi.low = joint;
            self.keep_ends(heights);
        }
    }

    /// Makes a steep line run through the heights of its ends. A line by its angle misses them by the rounding of ξ times
    /// the slope. On a line that is vertical to rounding, that is the whole length.
    fn keep_ends(&mut self, [from, to]: [f64; 2]) {
        let [a, b] = self.xi.ends();
        if let BranchShape::Arc(line) = &mut self.shape
            && self.kind == BranchKind::Plain
            && line.curvature == 0.0
            && line.cos < STEEP_LINE
        {
            let length = (b - a).hypot(to - from);
            (line.anchor, line.sin, line.cos) = ([a, from], (to - from) / length, (b - a) / length);
        }
    }

    /// Makes the branch of a span that faces the other body everywhere. It begins at `joint`, where its left neighbour ends, as by
    /// [`Self::begin_at`].
    pub(super) fn of_span(
        segment: usize,
        (view, span): (&sync::Arc<View>, usize),
        joint: Option<f64>,
    ) -> Self {
        let [from, to] = [0, 1].map(|end| view.spans[span].end(end, &view.frame));
        Self {
            xi: Interval::new(joint.filter(|joint| *joint < to[0]).unwrap_or(from[0]), to[0]),
            segment,
            shape: BranchShape::Polynomial(TurnedPolynomial::of_span(view, span)),
            begins_segment: true,
            ends_segment: true,
            heights: Some([from[1], to[1]]),
            kind: BranchKind::Plain,
        }
    }

    /// Makes the branches of a polynomial segment: the parts that face the other body. `contact` is the parameter of the
    /// contact point, if that point is on the segment; only the part through it is then returned.
    pub(super) fn of_polynomial(
        segment: usize,
        polynomial: &Polynomial,
        (view, span): (&sync::Arc<View>, usize),
        contact: Option<Twice>,
    ) -> Vec<Self> {
        let faces = view.spans[span].faces(&view.frame);
        if faces == Some(false) && contact.is_none() {
            return Vec::new();
        }
        let (exact, range) = match contact {
            Some(origin) => seen_from_own_point(polynomial, origin),
            None => seen_from(polynomial, &view.frame),
        };
        let whole = PolynomialBranch::new(exact, range);
        let kind = if contact.is_some() { BranchKind::Contact } else { BranchKind::Plain };
        let mut parts = match faces {
            Some(true) => vec![range],
            _ => rising_parts([&whole.xi, &whole.zeta], range),
        };
        parts.retain(|t| kind == BranchKind::Plain || t.contains(0.0));
        let branch = |t: Interval, whole: PolynomialBranch| {
            let xi = t.map(|t| value(&whole.xi, t));
            let part = PolynomialBranch { t, ends: xi, ..whole };
            let shape = BranchShape::Polynomial(TurnedPolynomial::of_part(view, span, part));
            let (begins_segment, ends_segment) = (t.low == range.low, t.high == range.high);
            Self { xi, segment, shape, begins_segment, ends_segment, heights: None, kind }
        };
        // The last part takes over the coefficients, because nearly always there is only one part.
        let Some(last) = parts.pop() else { return Vec::new() };
        let mut branches: Vec<Self> = parts.into_iter().map(|t| branch(t, whole.clone())).collect();
        branches.push(branch(last, whole));
        branches
    }

    pub(super) fn is_contact(&self, segment: usize) -> bool {
        self.kind == BranchKind::Contact && self.segment == segment
    }

    /// Computes ζ(ξ) \[mm\].
    #[inline]
    pub fn height(&self, xi: f64) -> f64 {
        match &self.shape {
            BranchShape::Arc(arc) => arc.height(xi),
            BranchShape::Polynomial(p) => {
                let p = p.curve();
                value(&p.zeta, p.parameter(xi))
            }
        }
    }

    /// Computes ζ \[mm\] at points of this branch in twice the working precision, for differences between closely
    /// conforming branches. The result is NaN for points of another branch.
    #[inline(always)]
    pub fn exact_heights<const N: usize>(&self, xi: &Lanes<N>, points: &BranchPoints<N>) -> [Twice; N] {
        match (&self.shape, points) {
            (BranchShape::Arc(arc), BranchPoints::Arc { .. }) => arc.exact_heights(xi),
            (BranchShape::Polynomial(p), BranchPoints::Polynomial { t, .. }) => {
                let p = p.curve();
                exact_values(&p.exact[1], &p.exact_parameters(xi, t)).0
            }
            _ => [Twice { high: f64::NAN, low: f64::NAN }; N],
        }
    }

    /// Finds the points at N abscissae and their ζ \[mm\]. Returns `None` if N > 1 and Newton's steps on a polynomial do
    /// not settle.
    #[inline(always)]
    pub fn points<const N: usize>(&self, xi: &Lanes<N>) -> Option<(BranchPoints<N>, Lanes<N>)> {
        match &self.shape {
            BranchShape::Arc(arc) => {
                let [mut sin, mut cos, mut secant, mut zeta] = [[0.0; N]; 4];
                for k in 0..N {
                    (sin[k], cos[k]) = arc.sine_cosine(xi[k]);
                    secant[k] = 1.0 / cos[k];
                    zeta[k] = arc.height_of(xi[k], sin[k], cos[k]);
                }
                Some((BranchPoints::Arc { sin, cos, secant }, zeta))
            }
            BranchShape::Polynomial(p) => {
                let p = p.curve();
                points::points(p.coefficients(), repeated(p.t), repeated(p.ends), xi)
            }
        }
    }

    /// Returns the points of a polynomial at N parameters, from which chords are drawn; `None` for an arc or line.
    #[inline(always)]
    pub fn points_of<const N: usize>(&self, t: &Lanes<N>) -> Option<BranchPoints<N>> {
        let BranchShape::Polynomial(p) = &self.shape else { return None };
        let [xi, mut rate] = values_and_slopes(p.xi.as_slice(), t);
        for rate in &mut rate {
            *rate = 1.0 / *rate;
        }
        Some(BranchPoints::Polynomial { xi, t: *t, rate })
    }

    /// Finds the point at ξ, from which chords are drawn, and ζ(ξ) \[mm\].
    #[inline]
    pub fn point(&self, xi: f64) -> (BranchPoint, f64) {
        let nan = [f64::NAN];
        let nowhere = (BranchPoint::Arc { sin: nan, cos: nan, secant: nan }, nan);
        let (point, [height]) = self.points(&[xi]).unwrap_or(nowhere);
        (point, height)
    }

    /// Computes the slopes (ζ(to) − ζ(from))/(to − from) of chords from points of this branch. The slope is that of the
    /// tangent where the two abscissae are equal; nothing cancels. Returns `None` for points of another branch, and if N >
    /// 1 and Newton's steps on a polynomial do not settle.
    #[inline(always)]
    pub fn chords_from<const N: usize>(&self, from: &BranchPoints<N>, to: &Lanes<N>) -> Option<Lanes<N>> {
        match (&self.shape, from) {
            (BranchShape::Arc(arc), BranchPoints::Arc { sin, cos, .. }) => {
                let mut slope = [0.0; N];
                for k in 0..N {
                    let (sin_to, cos_to) = arc.sine_cosine(to[k]);
                    slope[k] = (sin[k] + sin_to) / (cos[k] + cos_to);
                }
                Some(slope)
            }
            (BranchShape::Polynomial(p), BranchPoints::Polynomial { xi, t, rate }) => {
                let p = p.curve();
                points::chords(p.coefficients(), repeated(p.t), [xi, t, rate], to)
            }
            _ => None,
        }
    }

    /// Computes the slope of the chord from a point of this branch to the abscissa `to` \[mm\]. The result is NaN for a
    /// point of another branch.
    #[inline]
    pub fn chord_from(&self, from: &BranchPoint, to: f64) -> f64 {
        self.chords_from(from, &[to]).map_or(f64::NAN, |[slope]| slope)
    }

    /// Computes ζ′ at N abscissae. Returns `None` if N > 1 and Newton's steps on a polynomial do not settle.
    #[inline(always)]
    pub fn slopes<const N: usize>(&self, xi: &Lanes<N>) -> Option<Lanes<N>> {
        self.chords_from(&self.points(xi)?.0, xi)
    }

    /// Computes the slope of the chord from ξ = a to ξ = b \[mm\]; it is ζ′(a) for a = b. Nothing cancels.
    pub fn chord_slope(&self, a: f64, b: f64) -> f64 {
        self.chord_from(&self.point(a).0, b)
    }

    /// Computes ζ and ξ along chords from points of this branch, as multiples of `runs`. The multiple of ξ is about 1.
    ///
    /// There is no iteration and at most one division. The other end of a chord on a polynomial is where t has changed by
    /// runs × dt/dξ; on an arc it follows from the angle between chord and tangent. The results are NaN for points of
    /// another branch. The multiple of ξ is NaN if the chord may end beyond a vertical tangent.
    #[inline(always)]
    pub fn chords_near<const N: usize>(&self, from: &BranchPoints<N>, runs: &Lanes<N>) -> [Lanes<N>; 2] {
        match (&self.shape, from) {
            (BranchShape::Arc(arc), BranchPoints::Arc { sin, secant, .. }) => {
                arc.chords_near([sin, secant], runs)
            }
            (BranchShape::Polynomial(p), BranchPoints::Polynomial { t, rate, .. }) => {
                points::chords_near(p.coefficients(), [t, rate], runs)
            }
            // Points of another branch have no chords on this one.
            _ => [[f64::NAN; N]; 2],
        }
    }

    /// Computes dζ/dξ at a point of this branch. It is infinite or NaN where the branch is vertical, and NaN for a point of
    /// another branch.
    #[inline]
    pub fn slope_from(&self, point: &BranchPoint) -> f64 {
        match (&self.shape, point) {
            (BranchShape::Arc(_), BranchPoint::Arc { sin: [sin], cos: [cos], .. }) => sin / cos,
            (BranchShape::Polynomial(p), BranchPoint::Polynomial { t: [t], .. }) => {
                let p = p.curve();
                value_and_slope(&p.zeta, *t)[1] / value_and_slope(&p.xi, *t)[1]
            }
            _ => f64::NAN,
        }
    }

    /// Returns the branch's own parameter at ξ \[mm\]: t of a polynomial, for which a root is sought, and ξ on an arc.
    pub fn parameter(&self, xi: f64) -> f64 {
        match &self.shape {
            BranchShape::Arc(_) => xi,
            BranchShape::Polynomial(p) => p.parameter(xi),
        }
    }

    /// Computes the point with its unit tangent, in the frame, and the curvature \[1/mm\], positive where the hollow side is up, at
    /// an own parameter.
    pub fn station_and_curvature(&self, parameter: f64) -> (Station, f64) {
        match &self.shape {
            BranchShape::Arc(arc) => {
                let (sin, cos) = arc.sine_cosine(parameter);
                (Station { x: parameter, z: arc.height(parameter), cos, sin }, arc.curvature)
            }
            BranchShape::Polynomial(p) => {
                let p = p.curve();
                let [x, dx, hx] = derivatives(&p.xi, parameter);
                let [z, dz, hz] = derivatives(&p.zeta, parameter);
                let norm = dx.hypot(dz);
                let station = Station { x, z, cos: dx / norm, sin: dz / norm };
                (station, (dx * hz - dz * hx) / norm.powi(3))
            }
        }
    }

    /// Finds the point at ξ \[mm\] with its unit tangent, in the frame.
    pub fn station(&self, xi: f64) -> Station {
        Station { x: xi, ..self.station_and_curvature(self.parameter(xi)).0 }
    }

    /// Computes the curvature \[1/mm\] at ξ \[mm\], positive where the hollow side is up.
    pub fn curvature(&self, xi: f64) -> f64 {
        self.station_and_curvature(self.parameter(xi)).1
    }

    /// Computes bounds of ζ′ over a range of ξ \[mm\]: no slope lies beyond them. A polynomial's are those of the whole branch, where
    /// they are known. They are infinite where the branch is vertical.
    pub fn slope_bounds(&self, xi: Interval) -> Interval {
        match &self.shape {
            BranchShape::Arc(_) => self.derivative_bounds(xi)[0],
            BranchShape::Polynomial(p) => p.slopes().unwrap_or_else(|| p.rates(xi).1),
        }
    }

    /// Computes bounds of ζ \[mm\] over a range of ξ \[mm\]: to rounding, no height lies beyond them.
    pub(crate) fn height_bounds(&self, xi: Interval) -> Interval {
        match &self.shape {
            BranchShape::Arc(arc) => {
                let flattest = xi.nearest(arc.anchor[0] - arc.sin * arc.radius);
                Interval::around([xi.low, flattest, xi.high].map(|xi| arc.height(xi)))
            }
            BranchShape::Polynomial(p) => p.height_bounds(xi),
        }
    }

    /// Computes bounds of ζ′ and of ζ″ \[1/mm\] over a range of ξ \[mm\]: no value lies beyond them. They are infinite where the
    /// branch is vertical.
    pub fn derivative_bounds(&self, xi: Interval) -> [Interval; 2] {
        match &self.shape {
            BranchShape::Arc(arc) => {
                let ((sin_a, cos_a), (sin_b, cos_b)) = (arc.sine_cosine(xi.low), arc.sine_cosine(xi.high));
                // The flattest point bounds ζ″ = κ/C³ from one side and the steeper end from the other side.
                let flat = cosine(flattest([sin_a, sin_b]));
                let steep = cos_a.min(cos_b);
                let second = Interval::between(arc.curvature / flat.powi(3), arc.curvature / steep.powi(3));
                [Interval::between(sin_a / cos_a, sin_b / cos_b), second]
            }
            BranchShape::Polynomial(p) => p.derivative_bounds(xi),
        }
    }

    /// Computes bounds of the curvature \[1/mm\], positive where the hollow side is up, over a range of ξ \[mm\].
    pub(crate) fn curvature_bounds(&self, xi: Interval) -> Interval {
        match &self.shape {
            BranchShape::Arc(arc) => Interval::of(arc.curvature),
            BranchShape::Polynomial(p) => p.curvature_bounds(xi),
        }
    }
}

/// Returns the sine of smallest size between two sines.
fn flattest([a, b]: [f64; 2]) -> f64 {
    if a * b <= 0.0 {
        0.0
    } else if a.abs() <= b.abs() {
        a
    } else {
        b
    }
}

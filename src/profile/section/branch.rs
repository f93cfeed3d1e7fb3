//! One segment, or the part of it that faces the other body, as a function ζ(ξ).

use twofloat::TwoFloat;

use super::super::arc::cosine;
use super::super::{Arc, Polynomial, Station};
use crate::numerics::polynomial::{
    derivative, derivatives, divided_difference, range, recentred, slope_twofloat, value, value_and_slope,
    value_twofloat,
};
use crate::numerics::roots::bracketed;
use crate::numerics::twice;

/// A Newton step below this share of the range and of the step before, and below t, leaves of t an error of about its
/// square: none, down to the contact point at t = 0.
pub(super) const QUADRATIC: f64 = 1e-4 * 1e-4;

/// Cosine of the tangent angle below which a line is kept by its ends: at 1e-3 a rounding of ξ is 1e-11 mm of ζ. Gentler lines
/// are kept by their angle, which has more digits than a difference of ends that may be near each other.
const STEEP_LINE: f64 = 1e-3;

/// A branch ζ(ξ) over a closed interval of ξ.
#[derive(Debug, Clone)]
pub struct Branch {
    /// Its interval of ξ \[mm\].
    pub xi: [f64; 2],
    /// Index of the segment it belongs to.
    pub segment: usize,
    /// Its shape.
    pub shape: BranchShape,
    pub(super) begins_segment: bool,
    pub(super) ends_segment: bool,
    kind: Kind,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Contact,
    Plain,
}

/// The two shapes of [`super::super::Shape`], transformed.
#[derive(Debug, Clone)]
pub enum BranchShape {
    /// Line or arc.
    Arc(ArcBranch),
    /// Polynomial.
    Polynomial(Box<PolynomialBranch>),
}

/// A point of a branch, from which chords are drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BranchPoint {
    /// On an arc: sine and cosine of the tangent angle.
    Arc {
        /// S.
        sin: f64,
        /// C.
        cos: f64,
    },
    /// On a polynomial: abscissa and parameter.
    Polynomial {
        /// ξ \[mm\].
        xi: f64,
        /// t.
        t: f64,
    },
}

/// ζ = ζ_a + Δξ (S_a + S)/(C_a + C) with S = S_a + κΔξ, C = √(1 − S²): the slope of a chord is the tangent
/// of its mean angle. Nothing cancels, for any radius, lines included.
#[derive(Debug, Clone, Copy)]
pub struct ArcBranch {
    /// Anchor (ξ_a, ζ_a): the contact point, or where the branch is flattest.
    pub anchor: [f64; 2],
    /// S_a, sine of the tangent angle at the anchor.
    pub sin: f64,
    /// C_a, its cosine.
    pub cos: f64,
    /// Signed radius \[mm\].
    pub radius: f64,
    /// κ = 1/radius \[1/mm\].
    pub curvature: f64,
}

/// (ξ(t), ζ(t)) with t = 0 at the contact point where there is one: ζ then has neither constant nor linear
/// term, and keeps its relative accuracy down to C.
#[derive(Debug, Clone)]
pub struct PolynomialBranch {
    /// Coefficients of ξ(t).
    pub xi: Vec<f64>,
    /// Coefficients of ζ(t).
    pub zeta: Vec<f64>,
    /// Parameter range, ξ ascending with t.
    pub t: [f64; 2],
    pub(super) ends: [f64; 2],
    pub(super) exact: [Vec<TwoFloat>; 2],
}

impl ArcBranch {
    /// (S, C) at ξ. A line's own C: that of S = 1 − 1e-17 is 0 to rounding.
    #[inline(always)]
    pub fn sine_cosine(&self, xi: f64) -> (f64, f64) {
        let sin = self.sin + self.curvature * (xi - self.anchor[0]);
        (sin, if self.curvature == 0.0 { self.cos } else { cosine(sin) })
    }

    /// ζ(ξ).
    #[inline]
    pub fn height(&self, xi: f64) -> f64 {
        let (sin, cos) = self.sine_cosine(xi);
        self.height_of(xi, sin, cos)
    }

    #[inline(always)]
    pub(super) fn height_of(&self, xi: f64, sin: f64, cos: f64) -> f64 {
        self.anchor[1] + (xi - self.anchor[0]) * ((self.sin + sin) / (self.cos + cos))
    }
}

impl PolynomialBranch {
    /// t with ξ(t) = ξ.
    pub fn parameter(&self, xi: f64) -> f64 {
        self.parameter_near(xi, self.guess(xi))
    }

    /// t where ξ is on the line through the ends.
    pub(super) fn guess(&self, xi: f64) -> f64 {
        let [low, high] = self.t;
        let share = (xi - self.ends[0]) / (self.ends[1] - self.ends[0]);
        low + (high - low) * share
    }

    /// t with ξ(t) = ξ, by Newton steps from a guess inside a shrinking bracket.
    fn parameter_near(&self, xi: f64, guess: f64) -> f64 {
        let [mut low, mut high] = self.t;
        let mut t = guess.clamp(low, high);
        let (done, mut last) = (QUADRATIC * (high - low), f64::INFINITY);
        // Newton's steps fall below rounding within 6 on any branch that is not vertical.
        for _ in 0..60 {
            let [p, slope] = value_and_slope(&self.xi, t);
            let miss = p - xi;
            if miss == 0.0 {
                return t;
            }
            if miss > 0.0 {
                high = t;
            } else {
                low = t;
            }
            let newton = t - miss / slope;
            let next = if newton >= low && newton <= high { newton } else { low + (high - low) / 2.0 };
            let step = (next - t).abs();
            t = next;
            let settled = step <= done.min(t.abs()) && step <= QUADRATIC * last;
            if settled || step <= 2.0 * f64::EPSILON * t.abs() {
                break;
            }
            last = step;
        }
        t
    }

    /// The parameter in twice the working precision.
    pub(super) fn exact_parameter(&self, xi: f64) -> TwoFloat {
        let t = self.parameter(xi);
        let [_, slope] = value_and_slope(&self.xi, t);
        // One step more, which doubles the digits whatever the rounding of its slope.
        let t = TwoFloat::from(t);
        t - (value_twofloat(&self.exact[0], t) - xi) / slope
    }
}

impl Branch {
    /// The part of an arc that faces the other body: where the tangent points to larger ξ.
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
        let xi = [
            if begins { start.x } else { abscissa(sines[0]) },
            if ends { end.x } else { abscissa(sines[1]) },
        ];
        if xi[0] >= xi[1] {
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
            // From the end that is nearer in angle: often that is the flattest point itself, and often the joint nearest to C.
            let from_end = ends && (!begins || (sin - end.sin).abs() < (sin - start.sin).abs());
            let known = if from_end { end } else { start };
            let run = if curvature == 0.0 || sin == known.sin { 0.0 } else { (sin - known.sin) * arc.radius };
            let rise = run * ((known.sin + sin) / (known.cos + cos));
            ArcBranch { anchor: [known.x + run, known.z + rise], sin, cos, radius: arc.radius, curvature }
        };
        let kind = if contact { Kind::Contact } else { Kind::Plain };
        let shape = BranchShape::Arc(shape);
        let mut branch = Self { xi, segment, shape, begins_segment: begins, ends_segment: ends, kind };
        branch.keep_ends([start.z, end.z]);
        Some(branch)
    }

    /// Makes the branch begin where the one before it ends. A joint is rounded on either segment, and the smallest gap between
    /// two pieces would be an end of the profile.
    pub(super) fn begin_at(&mut self, joint: f64) {
        if joint < self.xi[1] {
            let heights = self.xi.map(|xi| self.height(xi));
            self.xi[0] = joint;
            self.keep_ends(heights);
        }
    }

    /// Makes a steep line run through its ends' heights. By its angle it would miss them by the rounding of ξ times its slope: by
    /// its whole length where it is vertical to rounding.
    fn keep_ends(&mut self, [from, to]: [f64; 2]) {
        let [a, b] = self.xi;
        if let BranchShape::Arc(line) = &mut self.shape
            && self.kind == Kind::Plain
            && line.curvature == 0.0
            && line.cos < STEEP_LINE
        {
            let length = (b - a).hypot(to - from);
            (line.anchor, line.sin, line.cos) = ([a, from], (to - from) / length, (b - a) / length);
        }
    }

    /// The parts of a polynomial segment that face the other body; `contact` is the contact point's parameter.
    pub(super) fn of_polynomial(
        segment: usize,
        polynomial: &Polynomial,
        frame: &Station,
        contact: Option<TwoFloat>,
    ) -> Vec<Self> {
        let [xi, zeta, t] = match contact {
            Some(origin) => polynomial.seen_from_own_point(origin),
            None => polynomial.seen_from(frame),
        };
        let range_t = [f64::from(t[0]), f64::from(t[1])];
        let plain = |c: &[TwoFloat]| -> Vec<f64> { c.iter().map(|&c| c.into()).collect() };
        let (xi_plain, zeta_plain) = (plain(&xi), plain(&zeta));
        let kind = if contact.is_some() { Kind::Contact } else { Kind::Plain };
        let mut parts = if rises_throughout(&xi_plain, range_t) {
            vec![range_t]
        } else {
            let (run, rise) = (derivative(&xi_plain), derivative(&zeta_plain));
            let fastest =
                [&run, &rise].map(|c| range(c, range_t[0], range_t[1]).map(f64::abs)).into_iter().flatten();
            let vertical = VERTICAL * fastest.fold(0.0, f64::max);
            rising_intervals(&run, vertical, range_t)
        };
        let shape = PolynomialBranch {
            xi: xi_plain,
            zeta: zeta_plain,
            t: range_t,
            ends: [f64::NAN; 2],
            exact: [xi, zeta],
        };
        let branch = |part: [f64; 2], shape: PolynomialBranch| {
            let ends = part.map(|t| value(&shape.xi, t));
            let shape = BranchShape::Polynomial(Box::new(PolynomialBranch { t: part, ends, ..shape }));
            let (begins_segment, ends_segment) = (part[0] == range_t[0], part[1] == range_t[1]);
            Self { xi: ends, segment, shape, begins_segment, ends_segment, kind }
        };
        parts.retain(|[a, b]| kind == Kind::Plain || (*a <= 0.0 && *b >= 0.0));
        let Some(last) = parts.pop() else { return Vec::new() };
        let mut branches: Vec<Self> = parts.into_iter().map(|part| branch(part, shape.clone())).collect();
        branches.push(branch(last, shape));
        branches
    }

    pub(super) fn is_contact(&self, segment: usize) -> bool {
        self.kind == Kind::Contact && self.segment == segment
    }

    /// ζ(ξ) \[mm\].
    #[inline]
    pub fn height(&self, xi: f64) -> f64 {
        match &self.shape {
            BranchShape::Arc(arc) => arc.height(xi),
            BranchShape::Polynomial(p) => value(&p.zeta, p.parameter(xi)),
        }
    }

    /// The point at ξ, from which chords are drawn, and ζ(ξ) \[mm\].
    #[inline]
    pub fn point(&self, xi: f64) -> (BranchPoint, f64) {
        match &self.shape {
            BranchShape::Arc(arc) => {
                let (sin, cos) = arc.sine_cosine(xi);
                (BranchPoint::Arc { sin, cos }, arc.height_of(xi, sin, cos))
            }
            BranchShape::Polynomial(p) => {
                let t = p.parameter(xi);
                (BranchPoint::Polynomial { xi, t }, value(&p.zeta, t))
            }
        }
    }

    /// (ζ(to) − ζ(from))/(to − from), the tangent's slope where they are equal; nothing cancels.
    #[inline]
    pub fn chord_from(&self, from: &BranchPoint, to: f64) -> f64 {
        match (&self.shape, from) {
            (BranchShape::Arc(arc), BranchPoint::Arc { sin, cos }) => {
                let (sin_to, cos_to) = arc.sine_cosine(to);
                (sin + sin_to) / (cos + cos_to)
            }
            (BranchShape::Polynomial(p), BranchPoint::Polynomial { xi, t }) => {
                let slope = value_and_slope(&p.xi, *t)[1];
                let t_to = p.parameter_near(to, t + (to - xi) / slope);
                divided_difference(&p.zeta, *t, t_to) / divided_difference(&p.xi, *t, t_to)
            }
            // A point of another branch has no chord on this one.
            _ => f64::NAN,
        }
    }

    /// dζ/dξ at a point of this branch; infinite or NaN where it is vertical.
    #[inline]
    pub fn slope_from(&self, point: &BranchPoint) -> f64 {
        match (&self.shape, point) {
            (BranchShape::Arc(_), BranchPoint::Arc { sin, cos }) => sin / cos,
            (BranchShape::Polynomial(p), BranchPoint::Polynomial { t, .. }) => {
                value_and_slope(&p.zeta, *t)[1] / value_and_slope(&p.xi, *t)[1]
            }
            // A point of another branch has no tangent on this one.
            _ => f64::NAN,
        }
    }

    /// (ζ(b) − ζ(a))/(b − a), the slope ζ′(a) for a = b; nothing cancels.
    pub fn chord_slope(&self, a: f64, b: f64) -> f64 {
        self.chord_from(&self.point(a).0, b)
    }

    /// The point at ξ with its unit tangent, in the frame.
    pub fn station(&self, xi: f64) -> Station {
        match &self.shape {
            BranchShape::Arc(arc) => {
                let (sin, cos) = arc.sine_cosine(xi);
                Station { x: xi, z: arc.height(xi), cos, sin }
            }
            BranchShape::Polynomial(p) => {
                let t = p.parameter(xi);
                let ([_, dx, _], [z, dz, _]) = (derivatives(&p.xi, t), derivatives(&p.zeta, t));
                let norm = dx.hypot(dz);
                Station { x: xi, z, cos: dx / norm, sin: dz / norm }
            }
        }
    }

    /// Curvature \[1/mm\] at ξ, positive where hollow side up.
    pub fn curvature(&self, xi: f64) -> f64 {
        match &self.shape {
            BranchShape::Arc(arc) => arc.curvature,
            BranchShape::Polynomial(p) => {
                let t = p.parameter(xi);
                let ([_, dx, hx], [_, dz, hz]) = (derivatives(&p.xi, t), derivatives(&p.zeta, t));
                (dx * hz - dz * hx) / dx.hypot(dz).powi(3)
            }
        }
    }

    /// Bounds of ζ′ and ζ″ over \[a, b\], for searches that must not miss a minimum. Infinite where the branch
    /// is vertical.
    pub fn derivative_bounds(&self, a: f64, b: f64) -> [[f64; 2]; 2] {
        match &self.shape {
            BranchShape::Arc(arc) => {
                let ((sin_a, cos_a), (sin_b, cos_b)) = (arc.sine_cosine(a), arc.sine_cosine(b));
                // The flattest point bounds ζ″ = κ/C³ from one side, the steeper end from the other.
                let flat = cosine(flattest([sin_a, sin_b]));
                let steep = cos_a.min(cos_b);
                let second = [arc.curvature / flat.powi(3), arc.curvature / steep.powi(3)];
                [ordered(sin_a / cos_a, sin_b / cos_b), ordered(second[0], second[1])]
            }
            BranchShape::Polynomial(p) => p.derivative_bounds(a, b),
        }
    }
}

impl PolynomialBranch {
    fn derivative_bounds(&self, a: f64, b: f64) -> [[f64; 2]; 2] {
        let (a, b) = (self.parameter(a), self.parameter(b));
        let (dx, dz) = (derivative(&self.xi), derivative(&self.zeta));
        let run = range(&dx, a, b);
        if run[0] <= 0.0 {
            return [[f64::NEG_INFINITY, f64::INFINITY]; 2];
        }
        let rise = range(&dz, a, b);
        let slope = quotient(rise, run);
        let turn = add(
            product(range(&derivative(&dz), a, b), run),
            product(range(&derivative(&dx), a, b), rise).map(|v| -v),
        );
        [slope, quotient(turn, [run[0].powi(3), run[1].powi(3)])]
    }
}

fn ordered(a: f64, b: f64) -> [f64; 2] {
    if a <= b { [a, b] } else { [b, a] }
}

fn product(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    let all = [a[0] * b[0], a[0] * b[1], a[1] * b[0], a[1] * b[1]];
    [all.into_iter().fold(f64::INFINITY, f64::min), all.into_iter().fold(f64::NEG_INFINITY, f64::max)]
}

/// Quotient by a positive interval.
fn quotient(a: [f64; 2], positive: [f64; 2]) -> [f64; 2] {
    product(a, [positive[1].recip(), positive[0].recip()])
}

/// a + b, where b may come with its ends swapped by a change of sign.
fn add(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    let b = ordered(b[0], b[1]);
    [a[0] + b[0], a[1] + b[1]]
}

/// The sine of smallest size between two.
fn flattest([a, b]: [f64; 2]) -> f64 {
    if a * b <= 0.0 {
        0.0
    } else if a.abs() <= b.abs() {
        a
    } else {
        b
    }
}

/// Share of a curve's speed below which its run along ξ is the rounding of a vertical: the direction of a straight wall is
/// known no better, and its run changes sign all along.
const VERTICAL: f64 = 16.0 * f64::EPSILON;

/// Whether a polynomial has a positive derivative all over \[t0, t1\], by a bound that costs a sum: true of most spans. Where
/// it is false the polynomial may rise all the same.
fn rises_throughout(c: &[f64], [t0, t1]: [f64; 2]) -> bool {
    let farthest = t0.abs().max(t1.abs());
    let Some(first) = c.get(1) else { return false };
    let (mut slope, mut power) = (0.0, 1.0);
    for (k, c) in c.iter().enumerate().skip(2) {
        power *= farthest;
        slope += k as f64 * c.abs() * power;
    }
    // Far above the rounding of a slope.
    0.5 * first > slope
}

/// The parts of \[t0, t1\] where the polynomial `slope` is positive, by bisection down to 2⁻⁴⁰ of the range; none where it is nowhere
/// larger than `rounding`.
fn rising_intervals(slope: &[f64], rounding: f64, [t0, t1]: [f64; 2]) -> Vec<[f64; 2]> {
    let mut parts = Vec::new();
    if range(slope, t0, t1)[1] <= rounding {
        return parts;
    }
    let mut cuts = vec![t0];
    sign_changes(slope, rounding, [t0, t1], 40, &mut cuts);
    cuts.push(t1);
    for pair in cuts.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        if b > a && value(slope, a + (b - a) / 2.0) > 0.0 {
            parts.push([a, b]);
        }
    }
    parts
}

/// Appends where the polynomial changes sign, but for parts where it is no larger than `rounding`.
fn sign_changes(c: &[f64], rounding: f64, [a, b]: [f64; 2], depth: u32, out: &mut Vec<f64>) {
    let [low, high] = range(c, a, b);
    if low > 0.0 || high < 0.0 || depth == 0 || (low >= -rounding && high <= rounding) {
        return;
    }
    let monotone = range(&derivative(c), a, b);
    if monotone[0] > 0.0 || monotone[1] < 0.0 {
        out.extend(bracketed(|t| value(c, t), a, b).filter(|&t| t > a && t < b));
        return;
    }
    let middle = a + (b - a) / 2.0;
    sign_changes(c, rounding, [a, middle], depth - 1, out);
    if value(c, middle) == 0.0 {
        out.push(middle);
    }
    sign_changes(c, rounding, [middle, b], depth - 1, out);
}

impl Polynomial {
    /// Coefficients of ξ and ζ and the parameter range, seen from a frame.
    fn seen_from(&self, frame: &Station) -> [Vec<TwoFloat>; 3] {
        let (mut x, mut z) = (self.x.clone(), self.z.clone());
        (x[0], z[0]) = (x[0] - frame.x, z[0] - frame.z);
        let [xi, zeta] = turned(&x, &z, frame.cos.into(), frame.sin.into());
        [xi, zeta, self.t.map(TwoFloat::from).to_vec()]
    }

    /// The same seen from the contact frame of its own point t = `origin`, which becomes t = 0; ζ has neither
    /// constant nor linear term, exactly.
    fn seen_from_own_point(&self, origin: TwoFloat) -> [Vec<TwoFloat>; 3] {
        let zero = TwoFloat::from(0.0);
        let (mut x, mut z) = (recentred(&self.x, origin), recentred(&self.z, origin));
        z.resize(z.len().max(2), zero);
        (x[0], z[0]) = (zero, zero);
        let norm = (x[1] * x[1] + z[1] * z[1]).sqrt();
        let [xi, mut zeta] = turned(&x, &z, twice::quotient(x[1], norm), twice::quotient(z[1], norm));
        zeta[1] = zero;
        [xi, zeta, self.t.map(|t| TwoFloat::from(t) - origin).to_vec()]
    }

    /// The station at a parameter in twice the working precision.
    pub(super) fn station_at(&self, t: TwoFloat) -> Station {
        let (dx, dz) = (slope_twofloat(&self.x, t), slope_twofloat(&self.z, t));
        let norm = (dx * dx + dz * dz).sqrt();
        Station {
            x: value_twofloat(&self.x, t).into(),
            z: value_twofloat(&self.z, t).into(),
            cos: (dx / norm).into(),
            sin: (dz / norm).into(),
        }
    }
}

/// (x, z) → (x cos + z sin, z cos − x sin), coefficient by coefficient.
fn turned(x: &[TwoFloat], z: &[TwoFloat], cos: TwoFloat, sin: TwoFloat) -> [Vec<TwoFloat>; 2] {
    let get = |c: &[TwoFloat], k: usize| c.get(k).copied().unwrap_or(TwoFloat::from(0.0));
    let n = x.len().max(z.len());
    [
        (0..n).map(|k| get(x, k) * cos + get(z, k) * sin).collect(),
        (0..n).map(|k| get(z, k) * cos - get(x, k) * sin).collect(),
    ]
}

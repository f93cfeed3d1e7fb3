//! The rail's surface by its arc length σ from the contact point.

use std::sync::{Arc, OnceLock};

use crate::numerics::chebyshev::{NODES, POINTS, PROOF, coefficients_by_vectors, value};
use crate::numerics::interval::Interval;
use crate::numerics::lanes::{Lanes, padded};
use crate::numerics::polynomial::{derivatives, value_and_slope};
use crate::numerics::quadrature::smooth_integrals;
use crate::numerics::roots::bracketed;
use crate::placement::Placement;
use crate::profile::{ArcBranch, Branch, BranchShape, ONE_JOINT, PolynomialBranch, Station};

/// Relative accuracy demanded of the arc length of a polynomial: rounding.
const LENGTH_DEMAND: f64 = 1e-15;

/// Most Newton steps to the parameter of an arc length. Each doubles the digits; more are needed only where a polynomial is
/// nearly vertical in its parameter.
const STEPS: usize = 60;

/// Newton step, in roundings of the parameter run through, after which iteration ends.
const STEP_ROUNDINGS: f64 = 4.0;

/// A point of the rail with the direction of its surface, in the contact frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RailPoint {
    /// Arc length σ from C \[mm\], positive towards +ξ.
    pub sigma: f64,
    /// ξ \[mm\].
    pub xi: f64,
    /// ζ \[mm\].
    pub zeta: f64,
    /// cos α; α is the angle of the outward normal (−sin α, cos α) from ζ, positive counter-clockwise.
    pub cos: f64,
    /// sin α.
    pub sin: f64,
    /// dα/dσ \[1/mm\]: the curvature, positive where the hollow side is up.
    pub curvature: f64,
    /// Whether the point lies on the segment through C.
    pub on_contact: bool,
}

/// The part of the rail's surface that is connected with C and is a graph over ξ, by arc length.
#[derive(Debug, Clone)]
pub struct RailArcLength<'a> {
    /// In order of σ. Copies share what is found of them on the way.
    stretches: Arc<[BranchStretch<'a>]>,
}

/// A stretch of the rail over one branch.
#[derive(Debug, Clone)]
struct BranchStretch<'a> {
    /// Range of σ \[mm\].
    sigma: Interval,
    /// Index of the piece of the rail's section.
    piece: usize,
    curve: StretchCurve<'a>,
    on_contact: bool,
}

/// The curve of a stretch, from a known point at a known σ.
#[derive(Debug, Clone)]
enum StretchCurve<'a> {
    /// A line or arc through a station.
    Arc { begin: f64, from: Station, radius: f64 },
    /// A polynomial from the first of two parameters to the second, which need not be larger. Its mean speed is found when it is asked
    /// for; `None` if that is not resolved.
    Polynomial {
        begin: f64,
        t: [f64; 2],
        branch: &'a PolynomialBranch,
        mean: OnceLock<Option<Box<MeanSpeed>>>,
    },
}

impl<'a> RailArcLength<'a> {
    /// Follows the rail of a placed pair from C to both sides.
    ///
    /// It ends where the surface that s sees ends, or steps to another part of the profile.
    pub fn new(placement: &'a Placement) -> Self {
        let section = &placement.rail().section;
        let mut stretches = Vec::new();
        let centre = section.pieces.partition_point(|piece| piece.xi.high < 0.0);
        if section.pieces.get(centre).is_none_or(|piece| piece.xi.low > 0.0) {
            return Self { stretches: stretches.into() };
        }
        let frame = &section.frame;
        let size = placement.rail().profile().extent() + frame.x.abs() + frame.z.abs();
        let connected = |left: usize| {
            let (Some(a), Some(b)) = (section.pieces.get(left), section.pieces.get(left + 1)) else {
                return false;
            };
            let ([xi_a, xi_b], [zeta_a, zeta_b]) = ([a.xi.high, b.xi.low], [a.heights[1], b.heights[0]]);
            let slope = section.end_slope(a, 1).abs();
            // A rounding of ξ moves the point of a steep end along its slope.
            let steep = if slope.is_finite() { 1.0 + slope } else { 1.0 / f64::EPSILON };
            xi_a == xi_b && (zeta_a - zeta_b).abs() <= ONE_JOINT * size * steep
        };
        let mut follow = |index: usize, from: (f64, f64), forward: bool| {
            let piece = &section.pieces[index];
            let branch = &section.branches[piece.branch];
            let far = piece.xi[usize::from(forward)];
            let on_contact = section.contact == Some(piece.branch);
            let stretch = BranchStretch::new((index, branch), on_contact, far, from, forward);
            let sigma = stretch.sigma[usize::from(forward)];
            stretches.push(stretch);
            (far, sigma)
        };
        let (mut index, mut at) = (centre, follow(centre, (0.0, 0.0), false));
        while index > 0 && connected(index - 1) {
            index -= 1;
            at = follow(index, at, false);
        }
        (index, at) = (centre, follow(centre, (0.0, 0.0), true));
        while connected(index) {
            index += 1;
            at = follow(index, at, true);
        }
        stretches.retain(|stretch| stretch.sigma.has_width());
        stretches.sort_by(|a, b| a.sigma.low.total_cmp(&b.sigma.low));
        Self { stretches: stretches.into() }
    }

    /// Returns the smallest and largest σ \[mm\]; `None` if C is not on the rail's surface.
    pub fn reach(&self) -> Option<Interval> {
        Some(Interval::new(self.stretches.first()?.sigma.low, self.stretches.last()?.sigma.high))
    }

    /// Returns the σ \[mm\] of the joints inside the reach, ascending.
    pub fn joints(&self) -> Vec<f64> {
        // C parts its own piece.
        let joined = self.stretches.windows(2).filter(|pair| pair[0].piece != pair[1].piece);
        joined.map(|pair| pair[1].sigma.low).collect()
    }

    /// Returns the ranges of σ \[mm\] over which the rail is one piece of its section, ascending, each with the index of that piece. C
    /// parts its own piece.
    pub(crate) fn pieces(&self) -> impl Iterator<Item = (Interval, usize)> {
        self.stretches.iter().map(|stretch| (stretch.sigma, stretch.piece))
    }

    /// Finds the point of the rail at σ \[mm\]. At a joint it is on the stretch at smaller σ. Returns `None` beyond the
    /// reach.
    ///
    /// Accuracy: on the segment through C a few roundings of each coordinate, relative to σ; elsewhere a few roundings of
    /// the profile's extent. Cost: a sine and a cosine on arcs; on polynomials three Newton steps, and 16 short quadratures for the first
    /// point of each.
    pub fn point(&self, sigma: f64) -> Option<RailPoint> {
        let index = self.stretches.partition_point(|stretch| stretch.sigma.high < sigma);
        let stretch = self.stretches.get(index).filter(|stretch| stretch.sigma.low <= sigma)?;
        let (at, curvature) = stretch.curve.station_and_curvature(sigma);
        let on_contact = stretch.on_contact;
        Some(RailPoint { sigma, xi: at.x, zeta: at.z, cos: at.cos, sin: at.sin, curvature, on_contact })
    }

    /// Finds σ \[mm\] of the point at ξ \[mm\]; NaN beyond the reach.
    pub fn sigma(&self, xi: f64) -> f64 {
        let Some(reach) = self.reach() else { return f64::NAN };
        let across = |sigma: f64| self.point(sigma).map_or(f64::NAN, |point| point.xi - xi);
        bracketed(across, reach.low, reach.high).unwrap_or(f64::NAN)
    }
}

impl<'a> BranchStretch<'a> {
    /// Makes the stretch of a piece and its branch from (ξ, σ) \[mm\] to the abscissa `far` \[mm\].
    fn new(
        (piece, branch): (usize, &'a Branch),
        on_contact: bool,
        far: f64,
        (xi, begin): (f64, f64),
        forward: bool,
    ) -> Self {
        let (curve, length) = match &branch.shape {
            BranchShape::Arc(arc) => {
                // The contact segment goes through C with no rounding.
                let at_c = on_contact && xi == 0.0;
                let from = if at_c { Station::AXES } else { branch.station(xi) };
                (StretchCurve::Arc { begin, from, radius: arc.radius }, arc_length(arc, &from, far))
            }
            BranchShape::Polynomial(branch) => {
                let t = if on_contact && xi == 0.0 { 0.0 } else { branch.parameter(xi) };
                let end = branch.parameter(far);
                let mean = OnceLock::new();
                let curve = StretchCurve::Polynomial { begin, t: [t, end], branch, mean };
                (curve, run_length(branch, t, end))
            }
        };
        let sign = if forward { 1.0 } else { -1.0 };
        Self { sigma: Interval::between(begin, begin + sign * length.abs()), piece, curve, on_contact }
    }
}

/// Computes the length \[mm\] along a line or arc from a station to the abscissa `far` \[mm\].
fn arc_length(arc: &ArcBranch, from: &Station, far: f64) -> f64 {
    let (sin, cos) = arc.sine_cosine(far);
    if arc.curvature == 0.0 {
        // A steep line is stored by its ends, so that its height at ξ is more accurate than its cosine.
        return (far - from.x).hypot(arc.height(far) - from.z);
    }
    arc.radius * (sin * from.cos - cos * from.sin).atan2(cos * from.cos + sin * from.sin)
}

/// Computes the length \[mm\] of a polynomial between two parameters; negative if they descend.
fn run_length(branch: &PolynomialBranch, a: f64, b: f64) -> f64 {
    let over = Interval::between(a, b);
    let speed = |t: &f64| speed(branch, *t);
    let [length] = smooth_integrals(&mut |t| [padded(t.iter().map(speed))], over, [LENGTH_DEMAND], true);
    if a <= b { length } else { -length }
}

impl StretchCurve<'_> {
    /// Returns the point, tangent and curvature \[1/mm\] at σ \[mm\].
    fn station_and_curvature(&self, sigma: f64) -> (Station, f64) {
        match self {
            Self::Arc { begin, from, radius } => {
                let length = sigma - begin;
                // The chord has the direction of the mean tangent.
                let turn = length / radius;
                let (sin_half, cos_half) = (0.5 * turn).sin_cos();
                let chord = if turn == 0.0 { length } else { 2.0 * radius * sin_half };
                let sin = 2.0 * sin_half * cos_half;
                let cos = (cos_half - sin_half) * (cos_half + sin_half);
                let station = Station { x: chord * cos_half, z: chord * sin_half, cos, sin };
                (station.placed_by(from), 1.0 / radius)
            }
            Self::Polynomial { begin, t, branch, mean } => {
                let length = sigma - begin;
                let t = match mean.get_or_init(|| MeanSpeed::new(branch, *t).map(Box::new)) {
                    Some(mean) => mean.parameter(branch, length),
                    None => parameter(branch, t[0], length),
                };
                let ([x, dx, hx], [z, dz, hz]) = (derivatives(&branch.xi, t), derivatives(&branch.zeta, t));
                let speed = dx.hypot(dz);
                let curvature = (dx * hz - dz * hx) / speed.powi(3);
                (Station { x, z, cos: dx / speed, sin: dz / speed }, curvature)
            }
        }
    }
}

/// The mean of the speed of a polynomial between its first point and another, as a function of the latter. Unlike the length, of which
/// it is the quotient by the parameter run through, it keeps its digits near the first point.
#[derive(Debug, Clone)]
struct MeanSpeed {
    first: f64,
    /// Middle of the range of the parameter, and half its width, negative if the first point is the largest.
    middle: f64,
    half: f64,
    /// Of Chebyshev polynomials over the range.
    coefficients: Lanes,
}

impl MeanSpeed {
    /// Interpolates the mean over a range; `None` if 16 points do not resolve it.
    fn new(branch: &PolynomialBranch, [first, last]: [f64; 2]) -> Option<Self> {
        let half = (last - first) / 2.0;
        let middle = first + half;
        let mean = |node: f64| {
            let at = middle + half * node;
            run_length(branch, first, at) / (at - first)
        };
        let coefficients = coefficients_by_vectors(&NODES.map(mean));
        let tail = coefficients[POINTS - PROOF..].iter().map(|c| c.abs()).sum::<f64>();
        (tail <= f64::EPSILON * coefficients[0]).then_some(Self { first, middle, half, coefficients })
    }

    /// Finds the parameter at a length \[mm\] from the first point, by Newton's method held inside the range.
    fn parameter(&self, branch: &PolynomialBranch, length: f64) -> f64 {
        let first = self.first;
        let range = Interval::between(first, self.middle + self.half);
        let mut t = range.nearest(first + length / self.coefficients[0]);
        for _ in 0..STEPS {
            let mean = value(&self.coefficients, (t - self.middle) / self.half);
            let next = range.nearest(t + (length - (t - first) * mean) / speed(branch, t));
            let step = next - t;
            t = next;
            if step.abs() <= STEP_ROUNDINGS * f64::EPSILON * (t - first).abs() {
                break;
            }
        }
        t
    }
}

/// Computes the length \[mm\] of a polynomial per parameter.
fn speed(branch: &PolynomialBranch, t: f64) -> f64 {
    let [dx, dz] = [&branch.xi, &branch.zeta].map(|coordinate| value_and_slope(coordinate, t)[1]);
    (dx * dx + dz * dz).sqrt()
}

/// Finds the parameter at a length \[mm\] along a polynomial from the parameter `from`, by Newton's method held inside the
/// range.
fn parameter(branch: &PolynomialBranch, from: f64, length: f64) -> f64 {
    let (mut t, mut walked) = (from, 0.0);
    for _ in 0..STEPS {
        let next = branch.t.nearest(t + (length - walked) / speed(branch, t));
        let step = next - t;
        if step.abs() <= f64::EPSILON * (next - from).abs() {
            break;
        }
        walked += run_length(branch, t, next);
        t = next;
    }
    t
}

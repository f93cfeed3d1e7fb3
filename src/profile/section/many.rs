//! Points and chords of a branch at several abscissae at once: the formulas of [`Branch::point`] and
//! [`Branch::chord_from`] step by step for all, so that no abscissa waits for the one before it.

use twofloat::TwoFloat;

use super::super::arc::cosine;
use super::branch::{ArcBranch, Branch, BranchPoint, BranchShape, QUADRATIC};
use crate::numerics::polynomial::value_and_slope;
use crate::numerics::twice::Twice;

/// Newton's steps are given up after this many: the branch is nearly vertical somewhere.
const STEPS: usize = 10;

/// A parabola's chord to its vertex is half as long as the tangent promised.
const LEAST_STRETCH: f64 = 0.5;

/// [`BranchPoint`] for several.
#[derive(Debug, Clone, Copy)]
pub enum BranchPoints<const N: usize> {
    /// On an arc: sines and cosines of the tangent angle.
    Arc {
        /// S.
        sin: [f64; N],
        /// C.
        cos: [f64; N],
    },
    /// On a polynomial: abscissae and parameters.
    Polynomial {
        /// ξ \[mm\].
        xi: [f64; N],
        /// t.
        t: [f64; N],
        /// dt/dξ there.
        rate: [f64; N],
    },
}

/// Branches, one for each of several abscissae.
#[derive(Debug)]
pub enum Branches<'a, const N: usize> {
    /// One for all.
    One(&'a Branch),
    /// Such as splines are made of.
    Cubics(Cubics<N>),
}

/// Polynomial branches of at most the third degree.
#[derive(Debug)]
pub struct Cubics<const N: usize> {
    xi: [[f64; N]; CUBIC],
    zeta: [[f64; N]; CUBIC],
    t: [[f64; N]; 2],
    ends: [[f64; N]; 2],
}

/// Coefficients of a cubic.
const CUBIC: usize = 4;

impl<'a, const N: usize> Branches<'a, N> {
    /// These branches, if all are the same one or cubics.
    pub fn of(branches: [&'a Branch; N]) -> Option<Self> {
        if branches.iter().all(|branch| std::ptr::eq(*branch, branches[0])) {
            return Some(Self::One(branches[0]));
        }
        let none = || [[0.0; N]; CUBIC];
        let mut all = Cubics { xi: none(), zeta: none(), t: [[0.0; N]; 2], ends: [[0.0; N]; 2] };
        for (k, branch) in branches.into_iter().enumerate() {
            let BranchShape::Polynomial(p) = &branch.shape else { return None };
            if p.xi.len().max(p.zeta.len()) > CUBIC {
                return None;
            }
            for (rows, c) in [(&mut all.xi, &p.xi), (&mut all.zeta, &p.zeta)] {
                for (row, c) in rows.iter_mut().zip(c) {
                    row[k] = *c;
                }
            }
            for end in 0..2 {
                (all.t[end][k], all.ends[end][k]) = (p.t[end], p.ends[end]);
            }
        }
        Some(Self::Cubics(all))
    }

    /// As [`Branch::points`].
    #[inline(always)]
    pub fn points(&self, xi: &[f64; N]) -> Option<(BranchPoints<N>, [f64; N])> {
        match self {
            Self::One(branch) => branch.points(xi),
            Self::Cubics(c) => {
                let t = parameters(&c.xi, c.t, xi, guesses(c.t, c.ends, xi))?;
                let (_, slope) = values_and_slopes(&c.xi, &t);
                let (zeta, _) = values_and_slopes(&c.zeta, &t);
                Some((BranchPoints::Polynomial { xi: *xi, t, rate: reciprocals(slope) }, zeta))
            }
        }
    }

    /// As [`Branch::chords_from`].
    #[inline(always)]
    pub fn chords_from(&self, from: &BranchPoints<N>, to: &[f64; N]) -> Option<[f64; N]> {
        match (self, from) {
            (Self::One(branch), _) => branch.chords_from(from, to),
            (Self::Cubics(c), BranchPoints::Polynomial { xi, t, rate }) => {
                chords([&c.xi, &c.zeta], c.t, [xi, t, rate], to)
            }
            _ => None,
        }
    }

    /// The slopes of chords from the points, and how long they are as multiples of `runs` along ξ, which is about 1. With no
    /// iteration: on a polynomial the other end is where t has changed by runs × dt/dξ; NaN where that may be beyond a vertical
    /// tangent.
    #[inline(always)]
    pub fn chords_near(&self, from: &BranchPoints<N>, runs: &[f64; N]) -> [[f64; N]; 2] {
        match (self, from) {
            (Self::One(branch), _) => branch.chords_near(from, runs),
            (Self::Cubics(c), BranchPoints::Polynomial { t, rate, .. }) => {
                chords_near([&c.xi, &c.zeta], [t, rate], runs)
            }
            _ => [[f64::NAN; N]; 2],
        }
    }
}

impl Branch {
    /// The points at ξ and their ζ \[mm\]; `None` where Newton's steps on a polynomial do not settle.
    #[inline(always)]
    pub fn points<const N: usize>(&self, xi: &[f64; N]) -> Option<(BranchPoints<N>, [f64; N])> {
        match &self.shape {
            BranchShape::Arc(arc) => {
                let (mut sin, mut cos, mut zeta) = ([0.0; N], [0.0; N], [0.0; N]);
                for k in 0..N {
                    (sin[k], cos[k]) = arc.sine_cosine(xi[k]);
                    zeta[k] = arc.height_of(xi[k], sin[k], cos[k]);
                }
                Some((BranchPoints::Arc { sin, cos }, zeta))
            }
            BranchShape::Polynomial(p) => {
                let (range, ends) = (rows(p.t), rows(p.ends));
                let t = parameters(p.xi.as_slice(), range, xi, guesses(range, ends, xi))?;
                let (_, slope) = values_and_slopes(p.xi.as_slice(), &t);
                let (zeta, _) = values_and_slopes(p.zeta.as_slice(), &t);
                Some((BranchPoints::Polynomial { xi: *xi, t, rate: reciprocals(slope) }, zeta))
            }
        }
    }

    /// A point of this branch, several times.
    #[inline(always)]
    pub fn repeated<const N: usize>(&self, point: &BranchPoint) -> BranchPoints<N> {
        match (&self.shape, *point) {
            (_, BranchPoint::Arc { sin, cos }) => BranchPoints::Arc { sin: [sin; N], cos: [cos; N] },
            (BranchShape::Polynomial(p), BranchPoint::Polynomial { xi, t }) => {
                let [_, slope] = value_and_slope(&p.xi, t);
                BranchPoints::Polynomial { xi: [xi; N], t: [t; N], rate: [1.0 / slope; N] }
            }
            // No point of this branch.
            _ => BranchPoints::Arc { sin: [f64::NAN; N], cos: [f64::NAN; N] },
        }
    }

    /// The slopes of the chords from the points to the abscissae; `None` as for [`Self::points`].
    #[inline(always)]
    pub fn chords_from<const N: usize>(&self, from: &BranchPoints<N>, to: &[f64; N]) -> Option<[f64; N]> {
        match (&self.shape, from) {
            (BranchShape::Arc(arc), BranchPoints::Arc { sin, cos }) => {
                let mut slope = [0.0; N];
                for k in 0..N {
                    let (sin_to, cos_to) = arc.sine_cosine(to[k]);
                    slope[k] = (sin[k] + sin_to) / (cos[k] + cos_to);
                }
                Some(slope)
            }
            (BranchShape::Polynomial(p), BranchPoints::Polynomial { xi, t, rate }) => {
                chords([p.xi.as_slice(), p.zeta.as_slice()], rows(p.t), [xi, t, rate], to)
            }
            // Points of another branch have no chords on this one.
            _ => None,
        }
    }

    /// As [`Branches::chords_near`].
    #[inline(always)]
    fn chords_near<const N: usize>(&self, from: &BranchPoints<N>, runs: &[f64; N]) -> [[f64; N]; 2] {
        match (&self.shape, from) {
            (BranchShape::Arc(arc), BranchPoints::Arc { sin, cos }) => {
                let mut slope = [0.0; N];
                for k in 0..N {
                    let sin_to = sin[k] + arc.curvature * runs[k];
                    slope[k] = (sin[k] + sin_to) / (cos[k] + cosine(sin_to));
                }
                [slope, [1.0; N]]
            }
            (BranchShape::Polynomial(p), BranchPoints::Polynomial { t, rate, .. }) => {
                chords_near([p.xi.as_slice(), p.zeta.as_slice()], [t, rate], runs)
            }
            // Points of another branch have no chords on this one.
            _ => [[f64::NAN; N]; 2],
        }
    }

    /// ζ at ξ in twice the working precision, for differences between closely conforming branches; from the points there,
    /// NaN for those of another branch.
    #[inline(always)]
    pub fn exact_heights<const N: usize>(&self, xi: &[f64; N], points: &BranchPoints<N>) -> Exact<N> {
        match (&self.shape, points) {
            (BranchShape::Arc(arc), BranchPoints::Arc { .. }) => arc.exact_heights(xi),
            (BranchShape::Polynomial(p), BranchPoints::Polynomial { t, .. }) => {
                let mut exact = Exact { high: *t, low: [0.0; N] };
                let (abscissa, slope) = exact_values(&p.exact[0], &exact);
                for k in 0..N {
                    // One Newton step more, which doubles the digits whatever the rounding of its slope.
                    let miss = abscissa.get(k) - Twice::from(xi[k]);
                    exact.set(k, Twice::sum(t[k], -(miss.high / slope[k])));
                }
                exact_values(&p.exact[1], &exact).0
            }
            _ => Exact { high: [f64::NAN; N], low: [f64::NAN; N] },
        }
    }

    /// ζ(ξ) in twice the working precision.
    pub fn exact_height(&self, xi: f64) -> Twice {
        self.exact_heights(&[xi], &self.repeated(&self.point(xi).0)).get(0)
    }
}

/// Several numbers in twice the working precision: high and low parts apart, as vector code wants them.
#[derive(Debug, Clone, Copy)]
pub struct Exact<const N: usize> {
    high: [f64; N],
    low: [f64; N],
}

impl<const N: usize> Exact<N> {
    /// The k-th of them.
    #[inline(always)]
    pub fn get(&self, k: usize) -> Twice {
        Twice { high: self.high[k], low: self.low[k] }
    }

    #[inline(always)]
    fn set(&mut self, k: usize, value: Twice) {
        (self.high[k], self.low[k]) = (value.high, value.low);
    }
}

impl ArcBranch {
    #[inline(always)]
    fn exact_heights<const N: usize>(&self, xi: &[f64; N]) -> Exact<N> {
        let (one, sin_a, cos_a) = (Twice::from(1.0), Twice::from(self.sin), Twice::from(self.cos));
        let [xi_a, zeta_a] = self.anchor;
        let mut zeta = Exact { high: [0.0; N], low: [0.0; N] };
        for (k, &xi) in xi.iter().enumerate() {
            let run = Twice::sum(xi, -xi_a);
            let turn =
                if self.radius.is_finite() { run / Twice::from(self.radius) } else { Twice::from(0.0) };
            let sin = turn + sin_a;
            let cos = ((one - sin) * (one + sin)).sqrt();
            zeta.set(k, run * (sin + sin_a) / (cos + cos_a) + Twice::from(zeta_a));
        }
        zeta
    }
}

/// Each of two numbers several times. `array::map` may be left out of line.
#[inline(always)]
fn rows<const N: usize>([a, b]: [f64; 2]) -> [[f64; N]; 2] {
    [[a; N], [b; N]]
}

#[inline(always)]
fn reciprocals<const N: usize>(mut values: [f64; N]) -> [f64; N] {
    for value in &mut values {
        *value = 1.0 / *value;
    }
    values
}

/// The coefficients of several polynomials. A trait and not iterators, whose closures may be left out of line.
trait Coefficients<const N: usize>: Copy {
    /// How many they have.
    fn count(self) -> usize;

    /// Those of t^k.
    fn row(self, k: usize) -> [f64; N];
}

/// The same for all.
impl<const N: usize> Coefficients<N> for &[f64] {
    #[inline(always)]
    fn count(self) -> usize {
        self.len()
    }

    #[inline(always)]
    fn row(self, k: usize) -> [f64; N] {
        [self[k]; N]
    }
}

/// Each its own.
impl<const N: usize> Coefficients<N> for &[[f64; N]; CUBIC] {
    #[inline(always)]
    fn count(self) -> usize {
        CUBIC
    }

    #[inline(always)]
    fn row(self, k: usize) -> [f64; N] {
        self[k]
    }
}

/// t where ξ is on the line through the ends.
#[inline(always)]
fn guesses<const N: usize>(t: [[f64; N]; 2], ends: [[f64; N]; 2], xi: &[f64; N]) -> [f64; N] {
    let mut guess = [0.0; N];
    for k in 0..N {
        let share = (xi[k] - ends[0][k]) / (ends[1][k] - ends[0][k]);
        guess[k] = t[0][k] + (t[1][k] - t[0][k]) * share;
    }
    guess
}

/// t with ξ(t) = ξ by Newton's steps from guesses within a range.
#[inline(always)]
fn parameters<const N: usize>(
    c: impl Coefficients<N>,
    [low, high]: [[f64; N]; 2],
    xi: &[f64; N],
    guess: [f64; N],
) -> Option<[f64; N]> {
    let mut t = guess;
    let mut last = [f64::INFINITY; N];
    let mut settled = [0u64; N];
    for k in 0..N {
        t[k] = within(t[k], low[k], high[k]);
    }
    for _ in 0..STEPS {
        let (value, slope) = values_and_slopes(c, &t);
        for k in 0..N {
            let next = within(t[k] - (value[k] - xi[k]) / slope[k], low[k], high[k]);
            let step = (next - t[k]).abs();
            let done = (QUADRATIC * (high[k] - low[k])).min(next.abs());
            let small = step <= 2.0 * f64::EPSILON * next.abs();
            settled[k] |= u64::from(small | ((step <= done) & (step <= QUADRATIC * last[k])));
            (t[k], last[k]) = (next, step);
        }
        if settled.iter().fold(1, |all, settled| all & settled) == 1 {
            return Some(t);
        }
    }
    None
}

/// The value, or the end that it is beyond; NaN stays. `f64::clamp` checks its ends, which keeps loops from becoming vector
/// code.
#[inline(always)]
fn within(value: f64, low: f64, high: f64) -> f64 {
    let above = if value < low { low } else { value };
    if above > high { high } else { above }
}

/// The slopes of chords from points (ξ, t, dt/dξ) to abscissae, of curves with coefficients of ξ and ζ.
#[inline(always)]
fn chords<const N: usize>(
    [c_xi, c_zeta]: [impl Coefficients<N>; 2],
    range: [[f64; N]; 2],
    [xi, t, rate]: [&[f64; N]; 3],
    to: &[f64; N],
) -> Option<[f64; N]> {
    let mut guess = *t;
    for k in 0..N {
        guess[k] += (to[k] - xi[k]) * rate[k];
    }
    let t_to = parameters(c_xi, range, to, guess)?;
    let (mut rise, run) = (differences(c_zeta, t, &t_to), differences(c_xi, t, &t_to));
    for k in 0..N {
        rise[k] /= run[k];
    }
    Some(rise)
}

/// As [`Branches::chords_near`], from points (t, dt/dξ) of curves with coefficients of ξ and ζ.
#[inline(always)]
fn chords_near<const N: usize>(
    [c_xi, c_zeta]: [impl Coefficients<N>; 2],
    [t, rate]: [&[f64; N]; 2],
    runs: &[f64; N],
) -> [[f64; N]; 2] {
    let mut t_to = *t;
    for k in 0..N {
        t_to[k] += runs[k] * rate[k];
    }
    let (mut slope, mut stretch) = (differences(c_zeta, t, &t_to), differences(c_xi, t, &t_to));
    for k in 0..N {
        slope[k] /= stretch[k];
        stretch[k] *= rate[k];
        stretch[k] = if stretch[k] > LEAST_STRETCH { stretch[k] } else { f64::NAN };
    }
    [slope, stretch]
}

/// Values and first derivatives.
#[inline(always)]
fn values_and_slopes<const N: usize>(c: impl Coefficients<N>, t: &[f64; N]) -> ([f64; N], [f64; N]) {
    let (mut value, mut slope) = ([0f64; N], [0f64; N]);
    for power in (0..c.count()).rev() {
        let c = c.row(power);
        for k in 0..N {
            slope[k] = slope[k].mul_add(t[k], value[k]);
            value[k] = value[k].mul_add(t[k], c[k]);
        }
    }
    (value, slope)
}

/// Values in twice the working precision, and slopes in the working one: compensated Horner's rule (Langlois and Louvet
/// 2007), which adds up what every step rounds.
#[inline(always)]
fn exact_values<const N: usize>(c: &[TwoFloat], t: &Exact<N>) -> (Exact<N>, [f64; N]) {
    let (mut value, mut slope, mut rounded) = ([0f64; N], [0f64; N], [0f64; N]);
    for c in c.iter().rev() {
        let (high, low) = (c.hi(), c.lo());
        for k in 0..N {
            let t = t.high[k];
            let product = value[k] * t;
            let of_product = value[k].mul_add(t, -product);
            let sum = Twice::sum(product, high);
            slope[k] = slope[k].mul_add(t, value[k]);
            rounded[k] = rounded[k].mul_add(t, of_product + (sum.low + low));
            value[k] = sum.high;
        }
    }
    let mut exact = Exact { high: value, low: [0.0; N] };
    for k in 0..N {
        exact.set(k, Twice::sum(value[k], slope[k].mul_add(t.low[k], rounded[k])));
    }
    (exact, slope)
}

/// [`crate::numerics::polynomial::divided_difference`] for several.
#[inline(always)]
fn differences<const N: usize>(c: impl Coefficients<N>, a: &[f64; N], b: &[f64; N]) -> [f64; N] {
    let (mut quotient, mut sum) = ([0f64; N], [0f64; N]);
    for power in (1..c.count()).rev() {
        let c = c.row(power);
        for k in 0..N {
            quotient[k] = quotient[k].mul_add(a[k], c[k]);
            sum[k] = sum[k].mul_add(b[k], quotient[k]);
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::profile::{Profile, Section, Side, standards};

    /// Largest relative difference of points and chords between many and one by one, and how many were compared.
    fn differences(profile: &Profile, side: Side) -> (f64, usize) {
        let section = Section::own_axes(profile, side);
        let (mut worst, mut compared) = (0f64, 0);
        for branch in &section.branches {
            let [a, b] = branch.xi;
            let at = |share: f64| a + (b - a) * share;
            let (xi, to) = ([at(0.1), at(0.5), at(0.9)], [at(0.3), at(0.500001), at(0.95)]);
            let Some((points, heights)) = branch.points(&xi) else { continue };
            let Some(chords) = branch.chords_from(&points, &to) else { continue };
            let [near, stretch] = branch.chords_near(&points, &[0, 1, 2].map(|k| to[k] - xi[k]));
            let zeta = branch.exact_heights(&xi, &points);
            for k in 0..3 {
                let (point, height) = branch.point(xi[k]);
                let chord = branch.chord_from(&point, to[k]);
                worst = worst.max((heights[k] - height).abs() / (1.0 + height.abs()));
                worst = worst.max((chords[k] - chord).abs() / (1.0 + chord * chord));
                let other = branch.chord_from(&point, xi[k] + (to[k] - xi[k]) * stretch[k]);
                worst = worst.max((near[k] - other).abs() / (1.0 + other * other));
                let exact = f64::from(TwoFloat::from(zeta.get(k)) - height).abs();
                worst = worst.max(exact / (1.0 + height.abs()));
                compared += 1;
            }
        }
        (worst, compared)
    }

    #[test]
    fn a_chord_past_a_vertical_tangent_is_no_number() {
        // ξ = t − t²/2, vertical at t = 1; ζ = t/10.
        let curve = [&[0.0, 1.0, -0.5][..], &[0.0, 0.1][..]];
        let [slope, stretch] = chords_near(curve, [&[0.0; 2], &[1.0; 2]], &[0.4, 1.2]);
        assert!((stretch[0] - 0.8).abs() < 1e-15 && (slope[0] - 0.125).abs() < 1e-15);
        assert!(stretch[1].is_nan());
    }

    #[test]
    fn many_points_are_the_points_one_by_one() -> crate::error::Result<()> {
        let rail = differences(&standards::rail("UIC60")?, Side::Rail);
        let wheel = differences(&standards::wheel("S1002")?, Side::Wheel);
        for (worst, compared) in [rail, wheel] {
            assert!(worst <= 1e-14 && compared >= 12, "{worst:e} of {compared}");
        }
        Ok(())
    }
}

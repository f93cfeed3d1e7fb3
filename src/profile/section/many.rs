//! Points and chords of a branch at several abscissae at once: the formulas of [`Branch::point`] and
//! [`Branch::chord_from`] step by step for all, so that no abscissa waits for the one before it.

use super::branch::{ArcBranch, Branch, BranchPoint, BranchShape, QUADRATIC};
use crate::numerics::polynomial::value_and_slope;
use crate::numerics::polynomials::{Coefficients, divided_differences, exact_values, values_and_slopes};
use crate::numerics::twice::{Twice, Twices};

/// Newton's steps are given up after this many: the branch is nearly vertical somewhere.
const STEPS: usize = 10;

/// A parabola's chord to its vertex is half as long as the tangent promised.
const LEAST_STRETCH: f64 = 0.5;

/// [`BranchPoint`] for several.
#[derive(Debug, Clone, Copy)]
pub enum BranchPoints<const N: usize> {
    /// On an arc: of the tangent angle.
    Arc {
        /// S.
        sin: [f64; N],
        /// C.
        cos: [f64; N],
        /// 1/C.
        secant: [f64; N],
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
    Cubics(Box<Cubics<N>>),
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

impl<const N: usize> Cubics<N> {
    const NONE: Self =
        Self { xi: [[0.0; N]; CUBIC], zeta: [[0.0; N]; CUBIC], t: [[0.0; N]; 2], ends: [[0.0; N]; 2] };
}

impl<'a, const N: usize> Branches<'a, N> {
    /// These branches, if all are the same one or cubics; in the memory of `others`: a tenth of a grid's time over splines went to
    /// asking for it anew.
    pub fn of(branches: [&'a Branch; N], others: Option<Self>) -> Option<Self> {
        if branches.iter().all(|branch| std::ptr::eq(*branch, branches[0])) {
            return Some(Self::One(branches[0]));
        }
        let mut all = match others {
            Some(Self::Cubics(others)) => others,
            _ => Box::new(Cubics::NONE),
        };
        for (k, branch) in branches.into_iter().enumerate() {
            let BranchShape::Polynomial(p) = &branch.shape else { return None };
            if p.xi.len().max(p.zeta.len()) > CUBIC {
                return None;
            }
            for (rows, c) in [(&mut all.xi, &p.xi), (&mut all.zeta, &p.zeta)] {
                for (power, row) in rows.iter_mut().enumerate() {
                    row[k] = c.get(power).copied().unwrap_or(0.0);
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
            Self::Cubics(c) => points([&c.xi, &c.zeta], c.t, c.ends, xi),
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

    /// ζ and ξ along chords from the points as multiples of `runs`; that of ξ is about 1. With no iteration, and at most one
    /// division: on a polynomial the other end is where t has changed by runs × dt/dξ, on an arc it is found by its chord's
    /// angle with the tangent. NaN where that may be beyond a vertical tangent.
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
                let [mut sin, mut cos, mut secant, mut zeta] = [[0.0; N]; 4];
                for k in 0..N {
                    (sin[k], cos[k]) = arc.sine_cosine(xi[k]);
                    secant[k] = 1.0 / cos[k];
                    zeta[k] = arc.height_of(xi[k], sin[k], cos[k]);
                }
                Some((BranchPoints::Arc { sin, cos, secant }, zeta))
            }
            BranchShape::Polynomial(p) => {
                points([p.xi.as_slice(), p.zeta.as_slice()], rows(p.t), rows(p.ends), xi)
            }
        }
    }

    /// A point of this branch, several times.
    #[inline(always)]
    pub fn repeated<const N: usize>(&self, point: &BranchPoint) -> BranchPoints<N> {
        match (&self.shape, *point) {
            (_, BranchPoint::Arc { sin, cos }) => {
                BranchPoints::Arc { sin: [sin; N], cos: [cos; N], secant: [1.0 / cos; N] }
            }
            (BranchShape::Polynomial(p), BranchPoint::Polynomial { xi, t }) => {
                let [_, slope] = value_and_slope(&p.xi, t);
                BranchPoints::Polynomial { xi: [xi; N], t: [t; N], rate: [1.0 / slope; N] }
            }
            // No point of this branch.
            _ => BranchPoints::Arc { sin: [f64::NAN; N], cos: [f64::NAN; N], secant: [f64::NAN; N] },
        }
    }

    /// The slopes of the chords from the points to the abscissae; `None` as for [`Self::points`].
    #[inline(always)]
    pub fn chords_from<const N: usize>(&self, from: &BranchPoints<N>, to: &[f64; N]) -> Option<[f64; N]> {
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
            (BranchShape::Arc(arc), BranchPoints::Arc { sin, secant, .. }) => {
                arc.chords_near([sin, secant], runs)
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
    pub fn exact_heights<const N: usize>(&self, xi: &[f64; N], points: &BranchPoints<N>) -> Twices<N> {
        match (&self.shape, points) {
            (BranchShape::Arc(arc), BranchPoints::Arc { .. }) => arc.exact_heights(xi),
            (BranchShape::Polynomial(p), BranchPoints::Polynomial { t, .. }) => {
                let mut exact = Twices::from(*t);
                let (abscissa, slope) = exact_values(&p.exact[0], &exact);
                for k in 0..N {
                    // One Newton step more, which doubles the digits whatever the rounding of its slope.
                    let miss = abscissa.get(k) - Twice::from(xi[k]);
                    exact.set(k, Twice::sum(t[k], -(miss.high / slope[k])));
                }
                exact_values(&p.exact[1], &exact).0
            }
            _ => Twices::from([f64::NAN; N]),
        }
    }

    /// ζ(ξ) in twice the working precision.
    pub fn exact_height(&self, xi: f64) -> Twice {
        self.exact_heights(&[xi], &self.repeated(&self.point(xi).0)).get(0)
    }
}

impl ArcBranch {
    /// As [`Branches::chords_near`], from points with sines S and secants 1/C. A chord that turns by an angle α has the length
    /// 2R sin α and the direction of the tangent and α; α is that of tan α = runs/2RC.
    #[inline(always)]
    fn chords_near<const N: usize>(&self, [sin, secant]: [&[f64; N]; 2], runs: &[f64; N]) -> [[f64; N]; 2] {
        let [mut climb, mut stretch] = [[0.0; N]; 2];
        for k in 0..N {
            let slope = sin[k] * secant[k];
            let turn = 0.5 * self.curvature * (runs[k] * secant[k]);
            let square_cosine = 1.0 / (1.0 + turn * turn);
            climb[k] = (slope + turn) * square_cosine;
            stretch[k] = (1.0 - slope * turn) * square_cosine;
            // The tangent has turned by 2α.
            let upright = 1.0 - turn * (turn + 2.0 * slope) > 0.0;
            stretch[k] = if upright { stretch[k] } else { f64::NAN };
        }
        [climb, stretch]
    }

    #[inline(always)]
    fn exact_heights<const N: usize>(&self, xi: &[f64; N]) -> Twices<N> {
        let (one, sin_a, cos_a) = (Twice::from(1.0), Twice::from(self.sin), Twice::from(self.cos));
        let [xi_a, zeta_a] = self.anchor;
        let mut zeta = Twices::from([0.0; N]);
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

/// As [`Branches::points`], of curves with coefficients of ξ and ζ over ranges of t that end at these ξ.
#[inline(always)]
fn points<const N: usize>(
    [c_xi, c_zeta]: [impl Coefficients<N>; 2],
    range: [[f64; N]; 2],
    ends: [[f64; N]; 2],
    xi: &[f64; N],
) -> Option<(BranchPoints<N>, [f64; N])> {
    let mut guess = [0.0; N];
    for k in 0..N {
        let share = (xi[k] - ends[0][k]) / (ends[1][k] - ends[0][k]);
        guess[k] = range[0][k] + (range[1][k] - range[0][k]) * share;
    }
    let t = parameters(c_xi, range, xi, guess)?;
    let ([_, mut rate], [zeta, _]) = (values_and_slopes(c_xi, &t), values_and_slopes(c_zeta, &t));
    for rate in &mut rate {
        *rate = 1.0 / *rate;
    }
    Some((BranchPoints::Polynomial { xi: *xi, t, rate }, zeta))
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
        let [value, slope] = values_and_slopes(c, &t);
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
    let (mut rise, run) = (divided_differences(c_zeta, t, &t_to), divided_differences(c_xi, t, &t_to));
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
    let (mut climb, mut stretch) =
        (divided_differences(c_zeta, t, &t_to), divided_differences(c_xi, t, &t_to));
    for k in 0..N {
        climb[k] *= rate[k];
        stretch[k] *= rate[k];
        stretch[k] = if stretch[k] > LEAST_STRETCH { stretch[k] } else { f64::NAN };
    }
    [climb, stretch]
}

#[cfg(test)]
mod tests {
    use twofloat::TwoFloat;

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
            let [climb, stretch] = branch.chords_near(&points, &[0, 1, 2].map(|k| to[k] - xi[k]));
            let zeta = branch.exact_heights(&xi, &points);
            for k in 0..3 {
                let (point, height) = branch.point(xi[k]);
                let chord = branch.chord_from(&point, to[k]);
                worst = worst.max((heights[k] - height).abs() / (1.0 + height.abs()));
                worst = worst.max((chords[k] - chord).abs() / (1.0 + chord * chord));
                let other = branch.chord_from(&point, xi[k] + (to[k] - xi[k]) * stretch[k]);
                worst = worst.max((climb[k] / stretch[k] - other).abs() / (1.0 + other * other));
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
        let [climb, stretch] = chords_near(curve, [&[0.0; 2], &[1.0; 2]], &[0.4, 1.2]);
        assert!((stretch[0] - 0.8).abs() < 1e-15 && (climb[0] - 0.1).abs() < 1e-15);
        assert!(stretch[1].is_nan());

        // The lower half of a circle from its lowest point, where tan α = 0.2 and 1.1.
        let arc = ArcBranch { anchor: [0.0; 2], sin: 0.0, cos: 1.0, radius: 1.0, curvature: 1.0 };
        let [climb, stretch] = arc.chords_near([&[0.0; 2], &[1.0; 2]], &[0.4, 2.2]);
        let [xi, zeta] = [0.4 * stretch[0], 0.4 * climb[0]];
        assert!((xi - 5.0 / 13.0).abs() < 1e-15 && (zeta - arc.height(xi)).abs() < 1e-15);
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

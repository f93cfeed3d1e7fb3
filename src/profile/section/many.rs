//! Points and chords of a branch at several abscissae at once: the formulas of [`Branch::point`] and
//! [`Branch::chord_from`] step by step for all, so that no abscissa waits for the one before it.

use std::array::from_fn;

use twofloat::TwoFloat;

use super::branch::{ArcBranch, Branch, BranchPoint, BranchShape, PolynomialBranch, QUADRATIC};
use crate::numerics::twice::Twice;

/// Newton's steps are given up after this many: the branch is nearly vertical somewhere.
const STEPS: usize = 10;

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
    },
}

impl<const N: usize> From<&BranchPoint> for BranchPoints<N> {
    /// The same point for all.
    fn from(point: &BranchPoint) -> Self {
        match *point {
            BranchPoint::Arc { sin, cos } => Self::Arc { sin: [sin; N], cos: [cos; N] },
            BranchPoint::Polynomial { xi, t } => Self::Polynomial { xi: [xi; N], t: [t; N] },
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
                let t = p.parameters(xi, from_fn(|k| p.guess(xi[k])))?;
                Some((BranchPoints::Polynomial { xi: *xi, t }, values_and_slopes(&p.zeta, &t).0))
            }
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
            (BranchShape::Polynomial(p), BranchPoints::Polynomial { xi, t }) => {
                let (_, slope) = values_and_slopes(&p.xi, t);
                let t_to = p.parameters(to, from_fn(|k| t[k] + (to[k] - xi[k]) / slope[k]))?;
                let (rise, run) = (differences(&p.zeta, t, &t_to), differences(&p.xi, t, &t_to));
                Some(from_fn(|k| rise[k] / run[k]))
            }
            // Points of another branch have no chords on this one.
            _ => None,
        }
    }

    /// ζ at ξ in twice the working precision, for differences between closely conforming branches; from the points there,
    /// NaN for those of another branch.
    #[inline(always)]
    pub fn exact_heights<const N: usize>(&self, xi: &[f64; N], points: &BranchPoints<N>) -> [Twice; N] {
        match (&self.shape, points) {
            (BranchShape::Arc(arc), BranchPoints::Arc { .. }) => arc.exact_heights(xi),
            (BranchShape::Polynomial(p), BranchPoints::Polynomial { t, .. }) => {
                let mut exact = t.map(Twice::from);
                let (abscissa, (_, slope)) = (exact_values(&p.exact[0], &exact), values_and_slopes(&p.xi, t));
                for k in 0..N {
                    // One Newton step more, which doubles the digits whatever the rounding of its slope.
                    let miss = abscissa[k] - Twice::from(xi[k]);
                    exact[k] = Twice::sum(t[k], -(miss.high / slope[k]));
                }
                exact_values(&p.exact[1], &exact)
            }
            _ => [Twice::from(f64::NAN); N],
        }
    }

    /// ζ(ξ) in twice the working precision.
    pub fn exact_height(&self, xi: f64) -> Twice {
        let [zeta] = self.exact_heights(&[xi], &BranchPoints::from(&self.point(xi).0));
        zeta
    }
}

impl ArcBranch {
    #[inline(always)]
    fn exact_heights<const N: usize>(&self, xi: &[f64; N]) -> [Twice; N] {
        let (one, sin_a, cos_a) = (Twice::from(1.0), Twice::from(self.sin), Twice::from(self.cos));
        let [xi_a, zeta_a] = self.anchor;
        let mut zeta = [Twice::from(0.0); N];
        for k in 0..N {
            let run = Twice::sum(xi[k], -xi_a);
            let turn =
                if self.radius.is_finite() { run / Twice::from(self.radius) } else { Twice::from(0.0) };
            let sin = turn + sin_a;
            let cos = ((one - sin) * (one + sin)).sqrt();
            zeta[k] = run * (sin + sin_a) / (cos + cos_a) + Twice::from(zeta_a);
        }
        zeta
    }
}

impl PolynomialBranch {
    /// t with ξ(t) = ξ by Newton's steps from guesses.
    #[inline(always)]
    fn parameters<const N: usize>(&self, xi: &[f64; N], guess: [f64; N]) -> Option<[f64; N]> {
        let [low, high] = self.t;
        let done = QUADRATIC * (high - low);
        let mut t = guess.map(|t| t.clamp(low, high));
        let mut last = [f64::INFINITY; N];
        let mut settled = [false; N];
        for _ in 0..STEPS {
            let (value, slope) = values_and_slopes(&self.xi, &t);
            for k in 0..N {
                let next = (t[k] - (value[k] - xi[k]) / slope[k]).clamp(low, high);
                let step = (next - t[k]).abs();
                settled[k] |=
                    step <= 2.0 * f64::EPSILON * next.abs() || (step <= done && step <= QUADRATIC * last[k]);
                (t[k], last[k]) = (next, step);
            }
            if settled.iter().all(|&settled| settled) {
                return Some(t);
            }
        }
        None
    }
}

/// Values and first derivatives.
#[inline(always)]
fn values_and_slopes<const N: usize>(c: &[f64], t: &[f64; N]) -> ([f64; N], [f64; N]) {
    let (mut value, mut slope) = ([0f64; N], [0f64; N]);
    for &c in c.iter().rev() {
        for k in 0..N {
            slope[k] = slope[k].mul_add(t[k], value[k]);
            value[k] = value[k].mul_add(t[k], c);
        }
    }
    (value, slope)
}

/// Values in twice the working precision.
#[inline(always)]
fn exact_values<const N: usize>(c: &[TwoFloat], t: &[Twice; N]) -> [Twice; N] {
    let mut value = [Twice::from(0.0); N];
    for &c in c.iter().rev() {
        let c = Twice::from(c);
        for k in 0..N {
            value[k] = value[k] * t[k] + c;
        }
    }
    value
}

/// [`crate::numerics::polynomial::divided_difference`] for several.
#[inline(always)]
fn differences<const N: usize>(c: &[f64], a: &[f64; N], b: &[f64; N]) -> [f64; N] {
    let (mut quotient, mut sum) = ([0f64; N], [0f64; N]);
    for &c in c.iter().skip(1).rev() {
        for k in 0..N {
            quotient[k] = quotient[k].mul_add(a[k], c);
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
            let zeta = branch.exact_heights(&xi, &points);
            for k in 0..3 {
                let (point, height) = branch.point(xi[k]);
                let chord = branch.chord_from(&point, to[k]);
                worst = worst.max((heights[k] - height).abs() / (1.0 + height.abs()));
                worst = worst.max((chords[k] - chord).abs() / (1.0 + chord * chord));
                let exact = f64::from(TwoFloat::from(zeta[k]) - height).abs();
                worst = worst.max(exact / (1.0 + height.abs()));
                compared += 1;
            }
        }
        (worst, compared)
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

//! Fits cubic smoothing splines to one coordinate over arc length.
//!
//! The spline f minimises Σ wᵢ (yᵢ − f(sᵢ))² + Λ ∫ f″² ds. Reinsch's band system [Reinsch1967] is (R + Λ Qᵀ D Q) γ = Qᵀ y,
//! f = y − Λ D Q γ, with D = diag(1/wᵢ) and γ the second derivatives. If wᵢ is the local spacing, the sum is the integral ∫
//! (y − f)² ds. A wave of length λ then keeps the share 1/(1 + Λ (2π/λ)⁴) of its height, whatever the spacing.

use crate::numerics::twice::Twice;

/// Returns the penalty Λ \[mm⁴\] that halves waves of this length \[mm\].
pub(in crate::measured) fn penalty(cutoff_wavelength: f64) -> f64 {
    (cutoff_wavelength / std::f64::consts::TAU).powi(4)
}

/// The factored band system for given knots. One system serves for x and z.
///
/// It has twice the working precision, because its condition grows as (cut-off wavelength / spacing)⁴: 1e13 for 5 mm over
/// points every 0.5 µm. Cost: linear, about 0.5 µs a knot.
pub(in crate::measured) struct Smoother<'a> {
    steps: &'a [f64],
    slack: &'a [f64],
    penalty: f64,
    /// Entries \[d, l₁, l₂\] of LDLᵀ for each inner knot.
    factor: Vec<[Twice; 3]>,
}

/// A natural cubic spline, given by its values and second derivatives at the knots.
#[derive(Debug, Clone)]
pub(in crate::measured) struct CubicSpline {
    /// Values f at the knots \[mm\].
    pub value: Vec<Twice>,
    /// Second derivatives γ at the knots \[1/mm\]; 0 at the ends of a natural spline.
    pub second: Vec<Twice>,
}

impl<'a> Smoother<'a> {
    /// Factors the system for knots `steps` \[mm\] apart; all steps are positive. `slack` is 1/wᵢ for each knot; where it
    /// is 0 the spline passes through the value. A penalty of 0 interpolates.
    pub fn new(steps: &'a [f64], slack: &'a [f64], penalty: f64) -> Self {
        let inner = steps.len().saturating_sub(1);
        let mut smoother = Self { steps, slack, penalty, factor: Vec::with_capacity(inner) };
        for j in 0..inner {
            let row = smoother.eliminated(j);
            smoother.factor.push(row);
        }
        smoother
    }

    /// Returns the three entries of column j of Q; they belong to the knots j, j + 1 and j + 2.
    fn second_difference(&self, j: usize) -> [Twice; 3] {
        let (a, b) = (Twice::from(1.0) / self.steps[j], Twice::from(1.0) / self.steps[j + 1]);
        [a, -(a + b), b]
    }

    fn eliminated(&self, j: usize) -> [Twice; 3] {
        let here = self.second_difference(j);
        let slack = |k: usize| Twice::from(self.slack[k]) * self.penalty;
        let mut d = Twice::sum(self.steps[j], self.steps[j + 1]) / 3.0;
        for (k, q) in here.iter().enumerate() {
            d += *q * *q * slack(j + k);
        }
        let (mut l1, mut l2) = (Twice::ZERO, Twice::ZERO);
        if j >= 2 {
            let [.., far] = self.second_difference(j - 2);
            let [d_before, ..] = self.factor[j - 2];
            l2 = far * here[0] * slack(j) / d_before;
            d -= l2 * l2 * d_before;
        }
        if j >= 1 {
            let [_, middle, far] = self.second_difference(j - 1);
            let mut b = Twice::from(self.steps[j]) / 6.0;
            b += middle * here[0] * slack(j) + far * here[1] * slack(j + 1);
            let [d_before, l1_before, _] = self.factor[j - 1];
            if j >= 2 {
                b -= l2 * self.factor[j - 2][0] * l1_before;
            }
            l1 = b / d_before;
            d -= l1 * l1 * d_before;
        }
        [d, l1, l2]
    }

    /// Fits the spline to values, with second derivatives of 0 at its ends.
    pub fn fit(&self, y: &[f64]) -> CubicSpline {
        self.fit_between(y, [Twice::ZERO; 2])
    }

    /// Fits the spline to values, with given second derivatives at its ends. Second derivatives other than 0 are allowed
    /// only for interpolation.
    pub fn fit_between(&self, y: &[f64], ends: [Twice; 2]) -> CubicSpline {
        let n = y.len();
        let mut second = vec![Twice::ZERO; n];
        (second[0], second[n - 1]) = (ends[0], ends[1]);
        let inner = self.factor.len();
        for j in 0..inner {
            let rise = |k: usize| Twice::sum(y[k + 1], -y[k]) / self.steps[k];
            let mut r = rise(j + 1) - rise(j);
            if j == 0 {
                r -= ends[0] * self.steps[0] / 6.0;
            }
            if j + 1 == inner {
                r -= ends[1] * self.steps[inner] / 6.0;
            }
            if j >= 1 {
                r -= self.factor[j][1] * second[j];
            }
            if j >= 2 {
                r -= self.factor[j][2] * second[j - 1];
            }
            second[j + 1] = r;
        }
        for j in (0..inner).rev() {
            let mut r = second[j + 1] / self.factor[j][0];
            if j + 1 < inner {
                r -= self.factor[j + 1][1] * second[j + 2];
            }
            if j + 2 < inner {
                r -= self.factor[j + 2][2] * second[j + 3];
            }
            second[j + 1] = r;
        }
        let mut value: Vec<Twice> = y.iter().map(|&y| y.into()).collect();
        for j in (0..inner).filter(|_| self.penalty > 0.0) {
            for (k, q) in self.second_difference(j).into_iter().enumerate() {
                let slack = Twice::from(self.slack[j + k]) * self.penalty;
                value[j + k] -= slack * q * second[j + 1];
            }
        }
        CubicSpline { value, second }
    }
}

impl CubicSpline {
    /// Returns the coefficients of the cubic from knot k to knot k + 1, in powers of the distance from knot k.
    pub fn cubic(&self, k: usize, step: f64) -> [f64; 4] {
        let (f, g) = (&self.value, &self.second);
        let slope = (f[k + 1] - f[k]) / step - (g[k] * 2.0 + g[k + 1]) * step / 6.0;
        [f[k].into(), slope.into(), (g[k] / 2.0).into(), ((g[k + 1] - g[k]) / step / 6.0).into()]
    }

    /// Returns the derivative at knot k.
    pub fn slope(&self, k: usize, steps: &[f64]) -> f64 {
        if k < steps.len() {
            return self.cubic(k, steps[k])[1];
        }
        let Some(step) = k.checked_sub(1).map(|before| steps[before]) else {
            return 0.0;
        };
        let [_, b, c, d] = self.cubic(k - 1, step);
        b + step * (2.0 * c + step * 3.0 * d)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{PI, TAU};

    /// Returns the share of a wave's height that is left in the middle of 200 mm.
    fn share(cutoff: f64, wavelength: f64, spacing: f64) -> f64 {
        let n = (200.0 / spacing) as usize + 1;
        let y: Vec<f64> = (0..n).map(|k| (TAU * k as f64 * spacing / wavelength).sin()).collect();
        let (steps, slack) = (vec![spacing; n - 1], vec![spacing.recip(); n]);
        let fit = Smoother::new(&steps, &slack, penalty(cutoff)).fit(&y);
        let inner = n / 4..3 * n / 4;
        let sum = |of: &dyn Fn(usize) -> f64| inner.clone().map(of).sum::<f64>();
        sum(&|k| f64::from(fit.value[k]) * y[k]) / sum(&|k| y[k] * y[k])
    }

    #[test]
    fn waves_keep_the_share_of_the_transfer_function_at_every_spacing() {
        for spacing in [0.02, 0.1, 0.5] {
            for ratio in [0.5, 1.0, 2.0, 5.0] {
                let expected = (1.0 + f64::powi(ratio, -4)).recip();
                let found = share(5.0, 5.0 * ratio, spacing);
                // The sum is the integral to an error of (spacing/wavelength)².
                let bound = 1e-6 + (PI * spacing / (5.0 * ratio)).powi(2);
                assert!((found - expected).abs() < bound, "{spacing} {ratio}: {found} not {expected}");
            }
        }
    }

    #[test]
    fn interpolation_passes_and_is_twice_continuous() {
        let steps = [0.3, 1.7, 0.001, 2.0, 0.4];
        let y = [1.0, -2.0, 0.5, 0.5004, 3.0, 2.0];
        let fit = Smoother::new(&steps, &[0.0; 6], 0.0).fit(&y);
        for (k, &y) in y.iter().enumerate() {
            assert_eq!(f64::from(fit.value[k]), y);
        }
        for k in 0..4 {
            let [a, b, c, d] = fit.cubic(k, steps[k]);
            let h = steps[k];
            let next = fit.cubic(k + 1, steps[k + 1]);
            let end = [a + h * (b + h * (c + h * d)), b + h * (2.0 * c + 3.0 * h * d), c + 3.0 * h * d];
            for (end, next) in end.iter().zip(next) {
                assert!((end - next).abs() < 1e-12 * (1.0 + next.abs()), "{k}: {end} {next}");
            }
        }
    }

    #[test]
    fn a_cubic_between_its_own_second_derivatives_comes_back() {
        let cubic = |s: f64| 1.0 + s * (0.5 + s * (-0.2 + 0.03 * s));
        let steps = [0.5, 1.0, 0.25, 2.0];
        let at: Vec<f64> = [0.0, 0.5, 1.5, 1.75, 3.75].to_vec();
        let y: Vec<f64> = at.iter().map(|&s| cubic(s)).collect();
        let second = |s: f64| -0.4 + 0.18 * s;
        let fit =
            Smoother::new(&steps, &[0.0; 5], 0.0).fit_between(&y, [0.0, 3.75].map(|s| second(s).into()));
        for (g, &s) in fit.second.iter().zip(&at) {
            assert!((f64::from(*g) - second(s)).abs() < 1e-14, "{s}");
        }
    }

    #[test]
    fn pinned_knots_stay_and_lines_are_not_bent() {
        let y: Vec<f64> = (0..50).map(|k| 3.0 - 0.25 * f64::from(k)).collect();
        let steps = vec![0.1; 49];
        let fit = Smoother::new(&steps, &[10.0; 50], penalty(5.0)).fit(&y);
        assert!(fit.value.iter().zip(&y).all(|(f, y)| (f64::from(*f) - y).abs() < 1e-14));
        let mut slack = [10.0; 50];
        slack[49] = 0.0;
        let mut bent = y.clone();
        bent[49] += 1.0;
        let fit = Smoother::new(&steps, &slack, penalty(5.0)).fit(&bent);
        assert_eq!(f64::from(fit.value[49]), bent[49]);
    }
}

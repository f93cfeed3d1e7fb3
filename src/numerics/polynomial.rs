//! Polynomials by their coefficients c_0, c_1, … of t⁰, t¹, …: values for N lanes, 32 digits, bounds.

use std::ops::{Add, Mul};

use super::interval::Interval;
use super::lanes::{Lanes, multiply_add};
use super::twice::Twice;

/// The coefficients of N polynomials. It is a trait and not an iterator, because the closures of iterators may not be inlined.
pub trait Coefficients<const N: usize>: Copy {
    /// Gives the number of coefficients of each polynomial.
    fn count(self) -> usize;

    /// Gives the coefficients of t^k.
    fn of_power(self, k: usize) -> Lanes<N>;
}

/// One polynomial for all lanes.
impl<const N: usize> Coefficients<N> for &[f64] {
    #[inline(always)]
    fn count(self) -> usize {
        self.len()
    }

    #[inline(always)]
    fn of_power(self, k: usize) -> Lanes<N> {
        [self[k]; N]
    }
}

/// One polynomial for each lane.
impl<const N: usize, const COUNT: usize> Coefficients<N> for &[Lanes<N>; COUNT] {
    #[inline(always)]
    fn count(self) -> usize {
        COUNT
    }

    #[inline(always)]
    fn of_power(self, k: usize) -> Lanes<N> {
        self[k]
    }
}

/// Computes values and first derivatives by Horner's rule, each lane at its own t.
#[inline(always)]
pub fn values_and_slopes<const N: usize>(c: impl Coefficients<N>, t: &Lanes<N>) -> [Lanes<N>; 2] {
    let (mut value, mut slope) = ([0.0; N], [0.0; N]);
    for power in (0..c.count()).rev() {
        let c = c.of_power(power);
        for k in 0..N {
            slope[k] = multiply_add::<N>(slope[k], t[k], value[k]);
            value[k] = multiply_add::<N>(value[k], t[k], c[k]);
        }
    }
    [value, slope]
}

/// Computes the value and the first derivative at t.
#[inline]
pub fn value_and_slope(c: &[f64], t: f64) -> [f64; 2] {
    values_and_slopes(c, &[t]).map(|[value]| value)
}

/// Computes p(t).
#[inline]
pub fn value(c: &[f64], t: f64) -> f64 {
    value_and_slope(c, t)[0]
}

/// Computes the value and the first two derivatives at t.
pub fn derivatives(c: &[f64], t: f64) -> [f64; 3] {
    c.iter().rev().fold([0.0; 3], |[p, d, h], &c| [p * t + c, d * t + p, h * t + 2.0 * d])
}

/// Computes the divided differences p\[a, b\] = (p(b) − p(a))/(b − a), which are p′(a) for a = b. Nothing cancels.
///
/// Method: synthetic division by (t − a), evaluated at b on the way.
#[inline(always)]
pub fn divided_differences<const N: usize>(c: impl Coefficients<N>, a: &Lanes<N>, b: &Lanes<N>) -> Lanes<N> {
    let (mut quotient, mut sum) = ([0.0; N], [0.0; N]);
    for power in (1..c.count()).rev() {
        let c = c.of_power(power);
        for k in 0..N {
            quotient[k] = multiply_add::<N>(quotient[k], a[k], c[k]);
            sum[k] = multiply_add::<N>(sum[k], b[k], quotient[k]);
        }
    }
    sum
}

/// Computes values in twice the working precision, and slopes in the working one, of one polynomial at N places.
///
/// Method: compensated Horner's rule (Langlois and Louvet 2007). Accuracy: about 1e-31 of Σ |c_k t^k|.
#[inline(always)]
pub fn exact_values<const N: usize>(c: &[Twice], t: &[Twice; N]) -> ([Twice; N], Lanes<N>) {
    let (mut value, mut slope, mut rounded) = ([0f64; N], [0f64; N], [0f64; N]);
    for c in c.iter().rev() {
        for k in 0..N {
            let t = t[k].high;
            let product = Twice::product(value[k], t);
            let sum = Twice::sum(product.high, c.high);
            slope[k] = slope[k].mul_add(t, value[k]);
            rounded[k] = rounded[k].mul_add(t, product.low + (sum.low + c.low));
            value[k] = sum.high;
        }
    }
    let mut exact = *t;
    for k in 0..N {
        exact[k] = Twice::sum(value[k], slope[k].mul_add(t[k].low, rounded[k]));
    }
    (exact, slope)
}

/// Computes the first N coefficients of p in powers of the distance from t: p(t), p′(t), p″(t)/2, …, in twice the working precision.
///
/// Method: Horner's rule. Accuracy: about 1e-31 of Σ |c_k t^k|, and of its derivatives.
pub fn exact_coefficients<const N: usize>(c: &[Twice], t: Twice) -> [Twice; N] {
    let mut about = [Twice::ZERO; N];
    for &c in c.iter().rev() {
        for k in (1..N).rev() {
            about[k] = about[k] * t + about[k - 1];
        }
        about[0] = about[0] * t + c;
    }
    about
}

/// Computes the coefficients c′ about t = `centre`: p(centre + u) = Σ c′_k u^k, in the working precision or twice that.
///
/// A standard's power form about a far origin loses digits at every evaluation. It loses none once it is moved with 32 digits.
pub fn recentred<T: Copy + Add<Output = T> + Mul<Output = T>>(c: &[T], centre: T) -> Vec<T> {
    let mut out = c.to_vec();
    for start in 0..out.len() {
        for k in (start..out.len().saturating_sub(1)).rev() {
            out[k] = out[k] + centre * out[k + 1];
        }
    }
    out
}

/// Computes bounds of p over an interval of t from its Bernstein coefficients. They are too narrow by rounding at most, exact
/// where p is extreme at an end, and converge with the square of the width.
pub fn range(c: &[f64], t: Interval) -> Interval {
    Interval::around(bernstein(c, t))
}

/// Computes the Bernstein coefficients of p over an interval of t. p, or a curve with such coordinates, lies in their hull.
pub fn bernstein(c: &[f64], t: Interval) -> Vec<f64> {
    let (mut b, n) = (recentred(c, t.low), c.len().saturating_sub(1));
    let (mut power, mut binomial) = (1.0, 1.0);
    for (k, b) in b.iter_mut().enumerate() {
        *b *= power / binomial;
        power *= t.width();
        binomial *= (n - k) as f64 / (k + 1) as f64;
    }
    for step in 1..=n {
        for k in (step..=n).rev() {
            b[k] += b[k - 1];
        }
    }
    b
}

/// Computes the coefficients of the product of two polynomials. All are 0 where one polynomial has no coefficients.
pub fn convolution(a: &[f64], b: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; (a.len() + b.len()).saturating_sub(1)];
    for (i, a) in a.iter().enumerate() {
        for (k, b) in b.iter().enumerate() {
            out[i + k] += a * b;
        }
    }
    out
}

/// Computes the coefficients of p′.
pub fn derivative(c: &[f64]) -> Vec<f64> {
    c.iter().enumerate().skip(1).map(|(k, &c)| c * k as f64).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const C: [f64; 5] = [1.0, -2.0, 0.5, 3.0, -0.25];

    #[test]
    fn one_lane_and_three_agree_whether_they_share_coefficients_or_not() {
        let [a, b] = [[-0.5, 0.7, 2.0], [1.5, 0.7, -1.0]];
        let (same, own) = (&C[..], C.map(|c| [c; 3]));
        let [value, slope] = values_and_slopes(same, &a);
        assert_eq!([value, slope], values_and_slopes(&own, &a));
        let difference = divided_differences(same, &a, &b);
        assert_eq!(difference, divided_differences(&own, &a, &b));
        let exact = exact_values(&C.map(Twice::from), &a.map(Twice::from)).0;
        for k in 0..3 {
            let [p, d, _] = derivatives(&C, a[k]);
            assert_eq!([p, d], value_and_slope(&C, a[k]));
            assert!((value[k] - p).abs() < 1e-14 && (slope[k] - d).abs() < 1e-14);
            let [one] = divided_differences(same, &[a[k]], &[b[k]]);
            assert!((difference[k] - one).abs() < 1e-14);
            // Horner's rule in twice the working precision throughout.
            let expected = C.iter().rev().fold(Twice::ZERO, |sum, &c| sum * a[k] + c);
            assert!((exact[k] - expected).high.abs() < 1e-30);
        }
    }

    #[test]
    fn divided_difference_agrees_with_the_quotient_and_with_the_slope() {
        let [found] = divided_differences(&C[..], &[-0.5], &[1.5]);
        assert!((found - (value(&C, 1.5) - value(&C, -0.5)) / 2.0).abs() < 1e-14);
        assert_eq!(divided_differences(&C[..], &[0.7], &[0.7]), [derivatives(&C, 0.7)[1]]);
    }

    #[test]
    fn recentring_keeps_values() {
        let moved = recentred(&C.map(Twice::from), Twice::from(3.0));
        let [there] = exact_coefficients(&moved, Twice::from(-2.25));
        assert!((there.high - value(&C, 0.75)).abs() < 1e-15);
    }

    #[test]
    fn range_holds_every_value_and_touches_the_ends() {
        let Interval { low, high } = range(&C, Interval::new(-1.0, 2.0));
        for k in 0..=100 {
            let p = value(&C, -1.0 + 0.03 * f64::from(k));
            assert!(low - 1e-13 <= p && p <= high + 1e-13);
        }
        assert_eq!(range(&[2.0, 1.0], Interval::new(0.0, 4.0)), Interval::new(2.0, 6.0));
    }
}

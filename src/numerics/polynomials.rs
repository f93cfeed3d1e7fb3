//! Several polynomials at once, each at a place of its own: loops over rows of numbers that become vector code.

use twofloat::TwoFloat;

use super::twice::{Twice, Twices};

/// The coefficients of several polynomials. A trait and not iterators, whose closures may be left out of line.
pub trait Coefficients<const N: usize>: Copy {
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
impl<const N: usize, const COUNT: usize> Coefficients<N> for &[[f64; N]; COUNT] {
    #[inline(always)]
    fn count(self) -> usize {
        COUNT
    }

    #[inline(always)]
    fn row(self, k: usize) -> [f64; N] {
        self[k]
    }
}

/// Values and first derivatives by Horner's rule.
#[inline(always)]
pub fn values_and_slopes<const N: usize>(c: impl Coefficients<N>, t: &[f64; N]) -> [[f64; N]; 2] {
    let (mut value, mut slope) = ([0f64; N], [0f64; N]);
    for power in (0..c.count()).rev() {
        let c = c.row(power);
        for k in 0..N {
            slope[k] = slope[k].mul_add(t[k], value[k]);
            value[k] = value[k].mul_add(t[k], c[k]);
        }
    }
    [value, slope]
}

/// [`super::polynomial::divided_difference`] for several.
#[inline(always)]
pub fn divided_differences<const N: usize>(c: impl Coefficients<N>, a: &[f64; N], b: &[f64; N]) -> [f64; N] {
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

/// Values of one polynomial in twice the working precision, and slopes in the working one: compensated Horner's rule (Langlois
/// and Louvet 2007), which adds up what every step rounds.
#[inline(always)]
pub fn exact_values<const N: usize>(c: &[TwoFloat], t: &Twices<N>) -> (Twices<N>, [f64; N]) {
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
    let mut exact = Twices::from(value);
    for k in 0..N {
        exact.set(k, Twice::sum(value[k], slope[k].mul_add(t.low[k], rounded[k])));
    }
    (exact, slope)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::polynomial::{derivatives, divided_difference, value_twofloat};

    const C: [f64; 5] = [1.0, -2.0, 0.5, 3.0, -0.25];
    const PLACES: [[f64; 3]; 2] = [[-0.5, 0.7, 2.0], [1.5, 0.7, -1.0]];

    #[test]
    fn several_are_the_polynomials_one_by_one() {
        let [a, b] = PLACES;
        let (same, own) = (&C[..], C.map(|c| [c; 3]));
        let [value, slope] = values_and_slopes(same, &a);
        assert_eq!([value, slope], values_and_slopes(&own, &a));
        let difference = divided_differences(same, &a, &b);
        assert_eq!(difference, divided_differences(&own, &a, &b));
        let exact = exact_values(&C.map(TwoFloat::from), &Twices::from(a)).0;
        for k in 0..3 {
            let [p, d, _] = derivatives(&C, a[k]);
            assert!((value[k] - p).abs() < 1e-14 && (slope[k] - d).abs() < 1e-14);
            assert!((difference[k] - divided_difference(&C, a[k], b[k])).abs() < 1e-14);
            let expected = value_twofloat(&C.map(TwoFloat::from), TwoFloat::from(a[k]));
            assert!(f64::from(TwoFloat::from(exact.get(k)) - expected).abs() < 1e-30);
        }
    }
}

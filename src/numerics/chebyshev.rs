//! Interpolation at 16 Chebyshev points of the first kind.
//!
//! T_k is even or odd as k is. Both kinds are summed up apart: half the work, in whole vectors, and the values in reverse
//! order have the same coefficients, every other one with its sign changed, to the last bit.

use std::array::from_fn;
use std::f64::consts::FRAC_PI_2;
use std::sync::LazyLock;

/// How many points.
pub const POINTS: usize = 16;

const HALF: usize = POINTS / 2;

/// A matrix for T_k with even k, and one with odd k.
type Parts = [[[f64; HALF]; HALF]; 2];

/// Weight of a value at the j-th point in the coefficient of T_(2i) or T_(2i+1), at index j, i.
static WEIGHTS: LazyLock<Parts> = LazyLock::new(|| {
    let weight = |k: usize| if k == 0 { 1.0 } else { 2.0 } / POINTS as f64;
    from_fn(|odd| from_fn(|j| from_fn(|i| weight(2 * i + odd) * cosine((2 * i + odd) * (2 * j + 1)))))
});

/// The coefficients of t^(2i) or t^(2i+1) in T_k, k = 2j or 2j + 1, at index j, i: integers.
static POWERS: LazyLock<Parts> = LazyLock::new(|| {
    let mut rows = [[0.0; POINTS]; POINTS];
    (rows[0][0], rows[1][1]) = (1.0, 1.0);
    for k in 2..POINTS {
        for j in 0..=k {
            let twice = if j == 0 { 0.0 } else { 2.0 * rows[k - 1][j - 1] };
            rows[k][j] = twice - rows[k - 2][j];
        }
    }
    from_fn(|odd| from_fn(|j| from_fn(|i| rows[2 * j + odd][2 * i + odd])))
});

/// The points of (−1, 1), descending.
pub static NODES: LazyLock<[f64; POINTS]> = LazyLock::new(|| from_fn(|j| cosine(2 * j + 1)));

/// cos(m π/2n) for n points.
fn cosine(m: usize) -> f64 {
    ((m % (4 * POINTS)) as f64 * FRAC_PI_2 / POINTS as f64).cos()
}

/// The coefficients of T_0 … T_15 of the interpolant through values at the points.
#[inline(always)]
pub fn coefficients(values: &[f64; POINTS]) -> [f64; POINTS] {
    let [of_even, of_odd] = &*WEIGHTS;
    let (mut even, mut odd) = ([0.0; HALF], [0.0; HALF]);
    for j in 0..HALF {
        // The points at t and −t count together.
        let (first, other) = (values[j], values[POINTS - 1 - j]);
        even = add_multiple(even, first + other, &of_even[j]);
        odd = add_multiple(odd, first - other, &of_odd[j]);
    }
    interleaved(&even, &odd)
}

/// The coefficients of t^k from those of T_k, of which the first `kept` count. Loses digits where they fall by less than about
/// 0.4 a step.
#[inline(always)]
pub fn to_powers(c: &[f64; POINTS], kept: usize) -> [f64; POINTS] {
    let [of_even, of_odd] = &*POWERS;
    let (mut even, mut odd) = ([0.0; HALF], [0.0; HALF]);
    for j in 0..kept.div_ceil(2) {
        even = add_multiple(even, c[2 * j], &of_even[j]);
    }
    for j in 0..kept / 2 {
        odd = add_multiple(odd, c[2 * j + 1], &of_odd[j]);
    }
    interleaved(&even, &odd)
}

/// sum + factor × row.
#[inline(always)]
fn add_multiple(mut sum: [f64; HALF], factor: f64, row: &[f64; HALF]) -> [f64; HALF] {
    for k in 0..HALF {
        sum[k] = row[k].mul_add(factor, sum[k]);
    }
    sum
}

/// Even and odd in turn.
#[inline(always)]
fn interleaved(even: &[f64; HALF], odd: &[f64; HALF]) -> [f64; POINTS] {
    let mut all = [0.0; POINTS];
    for k in 0..HALF {
        (all[2 * k], all[2 * k + 1]) = (even[k], odd[k]);
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_interpolant_takes_the_values() {
        let f = |t: f64| (0.5 * t).exp() / (5.0 - t);
        let powers = to_powers(&coefficients(&NODES.map(f)), POINTS);
        for k in -10..=10 {
            let t = f64::from(k) / 10.0;
            let horner = powers.iter().rev().fold(0.0, |sum, c| sum * t + c);
            assert!((horner - f(t)).abs() < 1e-15, "{t}");
        }
    }

    #[test]
    fn values_in_reverse_order_are_those_at_opposite_points() {
        let values = NODES.map(|t| (0.5 * t).exp() / (5.0 - t));
        let mut reversed = values;
        reversed.reverse();
        let mut c = coefficients(&reversed);
        for odd in c.iter_mut().skip(1).step_by(2) {
            *odd = -*odd;
        }
        assert_eq!(c, coefficients(&values));
    }

    #[test]
    fn powers_of_chebyshev_polynomials_are_known() {
        // T_4 + 3 T_1 + 2, and a coefficient that does not count.
        let c = [2.0, 3.0, 0.0, 0.0, 1.0, 7.0];
        let c = from_fn(|k| c.get(k).copied().unwrap_or(0.0));
        assert_eq!(to_powers(&c, 5)[..5], [3.0, 3.0, -8.0, 0.0, 8.0]);
        assert!(to_powers(&c, 5)[5..].iter().all(|&power| power == 0.0));
    }
}

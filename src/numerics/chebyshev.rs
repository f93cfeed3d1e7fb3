//! Interpolation at Chebyshev points of the first kind.

use std::f64::consts::FRAC_PI_2;
use std::sync::LazyLock;

/// Most points.
pub const MOST_POINTS: usize = 16;

/// T_k at the j-th of n points, cos(k (2j + 1) π/2n), at index j n + k; by n.
static VALUES: LazyLock<Vec<Vec<f64>>> = LazyLock::new(|| {
    let cosine = |m: usize, n: usize| (m as f64 * FRAC_PI_2 / n as f64).cos();
    let table = |n: usize| (0..n * n).map(|i| cosine(i % n * (2 * (i / n) + 1) % (4 * n), n)).collect();
    (0..=MOST_POINTS).map(table).collect()
});

/// The coefficients of t^0 … t^(MOST_POINTS−1) in T_k, by k: integers.
static POWERS: LazyLock<Vec<[f64; MOST_POINTS]>> = LazyLock::new(|| {
    let mut rows = vec![[0.0; MOST_POINTS]; MOST_POINTS];
    (rows[0][0], rows[1][1]) = (1.0, 1.0);
    for k in 2..MOST_POINTS {
        for j in 0..=k {
            let twice = if j == 0 { 0.0 } else { 2.0 * rows[k - 1][j - 1] };
            rows[k][j] = twice - rows[k - 2][j];
        }
    }
    rows
});

/// The j-th of n points of (−1, 1), descending; n from 2 to [`MOST_POINTS`].
pub fn point(j: usize, n: usize) -> f64 {
    VALUES[n][j * n + 1]
}

/// The coefficients of T_0 … T_{n−1} of the interpolant through values at the n points.
#[inline(always)]
pub fn coefficients(values: &[f64], c: &mut [f64]) {
    let n = values.len();
    c.fill(0.0);
    let table = VALUES[n].chunks_exact(n);
    for ((j, first), t) in values[..n.div_ceil(2)].iter().enumerate().zip(table) {
        // T_k is even or odd as k is: the points at t and −t count together, the one at 0 once.
        let other = if j == n - 1 - j { 0.0 } else { values[n - 1 - j] };
        let parts = [first + other, first - other];
        let (pairs, rest) = c.as_chunks_mut::<2>();
        let (t_pairs, t_rest) = t.as_chunks::<2>();
        for (c, t) in pairs.iter_mut().zip(t_pairs) {
            *c = [c[0] + parts[0] * t[0], c[1] + parts[1] * t[1]];
        }
        for (c, t) in rest.iter_mut().zip(t_rest) {
            *c += parts[0] * t;
        }
    }
    c[0] *= 0.5;
    for c in c {
        *c *= 2.0 / n as f64;
    }
}

/// The coefficients of t^k from those of T_k. Loses digits where they fall by less than about 0.4 a step.
#[inline(always)]
pub fn to_powers(c: &[f64], powers: &mut [f64]) {
    powers.fill(0.0);
    for (c, row) in c.iter().zip(POWERS.iter()) {
        for (sum, power) in powers.iter_mut().zip(row) {
            *sum += c * power;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_interpolant_takes_the_values() {
        let f = |t: f64| (0.5 * t).exp() / (5.0 - t);
        let n = 16;
        let values: Vec<f64> = (0..n).map(|j| f(point(j, n))).collect();
        let mut c = vec![0.0; n];
        coefficients(&values, &mut c);
        let mut powers = vec![0.0; n];
        to_powers(&c, &mut powers);
        for k in -10..=10 {
            let t = f64::from(k) / 10.0;
            let horner = powers.iter().rev().fold(0.0, |sum, c| sum * t + c);
            assert!((horner - f(t)).abs() < 1e-15, "{t}");
        }
    }

    #[test]
    fn powers_of_chebyshev_polynomials_are_known() {
        // T_4 + 3 T_1 + 2.
        let mut powers = [0.0; 5];
        to_powers(&[2.0, 3.0, 0.0, 0.0, 1.0], &mut powers);
        assert_eq!(powers, [3.0, 3.0, -8.0, 0.0, 8.0]);
    }
}

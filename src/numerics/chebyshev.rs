//! Interpolation at Chebyshev points of the first kind.

use std::f64::consts::FRAC_PI_2;
use std::sync::LazyLock;

/// Most points.
pub const MOST_POINTS: usize = 24;

/// T_k at the j-th of n points, cos(k (2j + 1) π/2n), at index k n + j; by n.
static VALUES: LazyLock<Vec<Vec<f64>>> = LazyLock::new(|| {
    let cosine = |m: usize, n: usize| (m as f64 * FRAC_PI_2 / n as f64).cos();
    let table = |n: usize| (0..n * n).map(|i| cosine(i / n * (2 * (i % n) + 1) % (4 * n), n)).collect();
    (0..=MOST_POINTS).map(table).collect()
});

/// The j-th of n points of (−1, 1), descending; n from 2 to [`MOST_POINTS`].
pub fn point(j: usize, n: usize) -> f64 {
    VALUES[n][n + j]
}

/// The coefficients of T_0 … T_{n−1} of the interpolants through rows of `width` values at the n points, as rows.
pub fn coefficients(values: &[f64], width: usize, c: &mut [f64]) {
    let n = values.len() / width;
    c.fill(0.0);
    for (k, (c, table)) in c.chunks_exact_mut(width).zip(VALUES[n].chunks_exact(n)).enumerate() {
        let scale = if k == 0 { 1.0 } else { 2.0 } / n as f64;
        for (row, t) in values.chunks_exact(width).zip(table) {
            for (c, v) in c.iter_mut().zip(row) {
                *c += scale * t * v;
            }
        }
    }
}

/// Σ c_k T_k(t) by Clenshaw's recurrence.
pub fn value(c: &[f64], t: f64) -> f64 {
    let Some((first, rest)) = c.split_first() else { return 0.0 };
    let [b1, b2] = rest.iter().rev().fold([0.0, 0.0], |[b1, b2], c| [2.0 * t * b1 - b2 + c, b1]);
    t * b1 - b2 + first
}

/// Turns rows of coefficients of T_k into those of t^k. Loses digits where they fall by less than about 0.4 a row.
pub fn to_powers(c: &mut [f64], width: usize) {
    let n = c.len() / width;
    // Σ c_j T_j = c_0 + t Σ c′_j T_{j−1}, by T_j = 2t T_{j−1} − T_{j−2}; then the same of the rest.
    for begin in 0..n {
        for j in (begin + 2..n).rev() {
            let (lower, upper) = c.split_at_mut(j * width);
            for (low, high) in lower[(j - 2) * width..].iter_mut().zip(&mut upper[..width]) {
                *low -= *high;
                *high *= 2.0;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_interpolant_takes_the_values_in_both_forms() {
        let f = |t: f64| (0.5 * t).exp() / (5.0 - t);
        let n = 16;
        let values: Vec<f64> = (0..n).map(|j| f(point(j, n))).collect();
        let mut c = vec![0.0; n];
        coefficients(&values, 1, &mut c);
        let mut powers = c.clone();
        to_powers(&mut powers, 1);
        for k in -10..=10 {
            let t = f64::from(k) / 10.0;
            let horner = powers.iter().rev().fold(0.0, |sum, c| sum * t + c);
            assert!((value(&c, t) - f(t)).abs() < 1e-15, "{t}");
            assert!((horner - value(&c, t)).abs() < 1e-15, "{t}");
        }
    }

    #[test]
    fn powers_of_chebyshev_polynomials_are_known() {
        // T_4 beside 2 + 3 T_1.
        let mut c = [0.0, 2.0, 0.0, 3.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0];
        to_powers(&mut c, 2);
        assert_eq!(c, [1.0, 2.0, 0.0, 3.0, -8.0, 0.0, 0.0, 0.0, 8.0, 0.0]);
    }
}

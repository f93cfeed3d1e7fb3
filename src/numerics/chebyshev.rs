//! Chebyshev points: interpolation at 16 of them, and interpolation in powers at a few.
//!
//! The 16 points are those of the first kind on (−1, 1). T_k is even where k is even and odd where k is odd. Both kinds are summed
//! apart: that is half the work, in whole vectors, and values in reverse order have the same coefficients to the last bit, the odd
//! ones with opposite sign.

use std::array::from_fn;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};
use std::sync::LazyLock;

use super::lanes::{Lanes, MANY, lanes, multiply_add};

/// How many points an interpolant has.
pub const POINTS: usize = MANY;

/// Coefficients at the end of a series that have to be rounding before the series counts as complete. One may vanish by parity.
pub const PROOF: usize = 2;

/// Largest number of points of an interpolant in powers.
pub const MOST_POINTS: usize = 12;

const HALF: usize = POINTS / 2;

/// Two matrices: one for T_k with even k, one for T_k with odd k.
type Parts = [[[f64; HALF]; HALF]; 2];

/// The weight of the value at the j-th point in the coefficient of T_(2i) (first matrix) and of T_(2i+1) (second), at \[j\]\[i\].
static WEIGHTS: LazyLock<Parts> = LazyLock::new(|| {
    let weight = |k: usize| if k == 0 { 1.0 } else { 2.0 } / POINTS as f64;
    from_fn(|odd| from_fn(|j| from_fn(|i| weight(2 * i + odd) * cosine((2 * i + odd) * (2 * j + 1)))))
});

/// The coefficient of t^(2i) in T_(2j) (first matrix) and of t^(2i+1) in T_(2j+1) (second), at \[j\]\[i\]. All are integers.
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

/// The 16 points of (−1, 1), in descending order.
pub static NODES: LazyLock<Lanes> = LazyLock::new(|| from_fn(|j| cosine(2 * j + 1)));

/// Computes cos(m π/2n) for n = 16 points.
fn cosine(m: usize) -> f64 {
    ((m % (4 * POINTS)) as f64 * FRAC_PI_2 / POINTS as f64).cos()
}

/// Computes the coefficients of T_0 … T_15 of the interpolant that takes these values at the 16 points.
#[inline(always)]
pub fn coefficients(values: &Lanes) -> Lanes {
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

/// Computes [`coefficients`] by the vector code of this machine, for callers that are compiled for the plainest one.
pub fn coefficients_by_vectors(values: &Lanes) -> Lanes {
    pulp::Arch::new().dispatch(NodeValues(values))
}

/// Values of which the coefficients are sought.
struct NodeValues<'a>(&'a Lanes);

impl pulp::WithSimd for NodeValues<'_> {
    type Output = Lanes;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> Lanes {
        coefficients(self.0)
    }
}

/// Computes the coefficients of t^k from those of T_k. Only the first `kept` count; the others are taken as 0.
///
/// Accuracy: digits are lost where each coefficient is more than about 0.4 of the one before.
#[inline(always)]
pub fn to_powers(c: &Lanes, kept: usize) -> Lanes {
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

/// Computes Σ c_k T_k at N places by Clenshaw's rule; `c` has at least one coefficient.
#[inline(always)]
pub fn values<const N: usize>(c: &[f64], t: &Lanes<N>) -> Lanes<N> {
    let (mut here, mut before) = ([0.0; N], [0.0; N]);
    for &c in c[1..].iter().rev() {
        for k in 0..N {
            let next = multiply_add::<N>(2.0 * t[k], here[k], c - before[k]);
            (here[k], before[k]) = (next, here[k]);
        }
    }
    lanes(|k| multiply_add::<N>(t[k], here[k], c[0] - before[k]))
}

/// Computes Σ c_k T_k and its derivative at N places by Clenshaw's rule; `c` has at least one coefficient.
#[inline(always)]
pub fn values_and_slopes<const N: usize>(c: &[f64], t: &Lanes<N>) -> [Lanes<N>; 2] {
    let [mut here, mut before, mut slope, mut last] = [[0.0; N]; 4];
    for &c in c[1..].iter().rev() {
        for k in 0..N {
            let turn = multiply_add::<N>(2.0 * t[k], slope[k], 2.0 * here[k] - last[k]);
            let next = multiply_add::<N>(2.0 * t[k], here[k], c - before[k]);
            (slope[k], last[k]) = (turn, slope[k]);
            (here[k], before[k]) = (next, here[k]);
        }
    }
    [
        lanes(|k| multiply_add::<N>(t[k], here[k], c[0] - before[k])),
        lanes(|k| multiply_add::<N>(t[k], slope[k], here[k] - last[k])),
    ]
}

/// Computes Σ c_k T_k(t) by Clenshaw's rule; `c` has at least one coefficient.
pub fn value(c: &[f64], t: f64) -> f64 {
    let [value] = values(c, &[t]);
    value
}

/// Computes the coefficients of the derivative by t.
pub fn derivative(c: &Lanes) -> Lanes {
    let mut slope = [0.0; POINTS];
    for k in (1..POINTS).rev() {
        let further = if k + 1 < POINTS { slope[k + 1] } else { 0.0 };
        slope[k - 1] = further + 2.0 * k as f64 * c[k];
    }
    slope[0] /= 2.0;
    slope
}

/// Computes sum + factor × row.
#[inline(always)]
fn add_multiple(mut sum: [f64; HALF], factor: f64, row: &[f64; HALF]) -> [f64; HALF] {
    for k in 0..HALF {
        sum[k] = row[k].mul_add(factor, sum[k]);
    }
    sum
}

/// Merges the coefficients of even and of odd k into one series.
#[inline(always)]
fn interleaved(even: &[f64; HALF], odd: &[f64; HALF]) -> Lanes {
    let mut all = [0.0; POINTS];
    for k in 0..HALF {
        (all[2 * k], all[2 * k + 1]) = (even[k], odd[k]);
    }
    all
}

/// Turns values into coefficients, in place: N polynomials at once, each through the values `d` at its own places `v`.
///
/// `v` and `d` have one entry per point, each with N lanes; `d` ends with the coefficients of v⁰, v¹, ….
///
/// Method: divided differences, then Horner's rule on the factors. Cost: about n² steps for n points.
#[inline(always)]
pub fn powers<const N: usize>(v: &[[f64; N]], d: &mut [[f64; N]]) {
    let n = v.len();
    for order in 1..n {
        let mut rest = n;
        // One division serves two quotients, since it takes longer than some products.
        while rest >= order + 2 {
            rest -= 2;
            let [i, j] = [rest, rest + 1];
            for k in 0..N {
                let [a, b] = [v[i][k] - v[i - order][k], v[j][k] - v[j - order][k]];
                let inverse = 1.0 / (a * b);
                d[j][k] = (d[j][k] - d[i][k]) * (inverse * a);
                d[i][k] = (d[i][k] - d[i - 1][k]) * (inverse * b);
            }
        }
        if rest > order {
            for k in 0..N {
                d[order][k] = (d[order][k] - d[order - 1][k]) / (v[order][k] - v[0][k]);
            }
        }
    }
    // p_j = d_j + (v − v_j) p_(j+1), in the place of d_j, …, d_(n−1).
    for j in (0..n - 1).rev() {
        for i in j..n - 1 {
            for k in 0..N {
                d[i][k] -= v[j][k] * d[i + 1][k];
            }
        }
    }
}

/// Gives the n Chebyshev points of (0, 1) in ascending order, for n from 1 to [`MOST_POINTS`].
pub fn unit_nodes(n: usize) -> &'static [f64] {
    &UNIT_NODES[n - 1][..n]
}

/// The points (1 − cos((2j + 1)π/2n))/2 for n = 1 … [`MOST_POINTS`]; row n − 1 has n of them.
static UNIT_NODES: LazyLock<[[f64; MOST_POINTS]; MOST_POINTS]> = LazyLock::new(|| {
    from_fn(|row| {
        let n = row as f64 + 1.0;
        from_fn(|j| {
            let half = (2.0 * j as f64 + 1.0) * FRAC_PI_4 / n;
            half.sin().powi(2)
        })
    })
});

/// Gives the places of (0, 1) at which the error of an interpolant at n Chebyshev points is to be measured, besides the end.
///
/// The first extremum of the error is the largest where the function is least smooth near the beginning; the other one is near the
/// middle, because the error at the end may happen to be zero. Up to three points have both in one place.
pub fn extrema(n: usize) -> &'static [f64] {
    &EXTREMA[n - 1][usize::from(n < 4)..]
}

/// The extrema (1 − cos(kπ/n))/2 for k = 1 and k = n/2, n points in row n − 1; for n = 1 that of v(v − ½).
static EXTREMA: LazyLock<[[f64; 2]; MOST_POINTS]> = LazyLock::new(|| {
    let extremum = |k: usize, n: usize| (FRAC_PI_2 * k as f64 / n as f64).sin().powi(2);
    from_fn(|row| match row + 1 {
        1 => [0.25; 2],
        n => [extremum(1, n), extremum(n / 2, n)],
    })
});

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_interpolant_takes_the_values() {
        // In the derivative the first coefficient that is left out counts 16² times.
        let f = |t: f64| (0.5 * t).exp() / (5.0 - t);
        let powers = to_powers(&coefficients(&NODES.map(f)), POINTS);
        let c = coefficients(&NODES.map(f));
        let slope = derivative(&c);
        for k in -10..=10 {
            let t = f64::from(k) / 10.0;
            let horner = powers.iter().rev().fold(0.0, |sum, c| sum * t + c);
            assert!((horner - f(t)).abs() < 1e-15 && (value(&c, t) - f(t)).abs() < 1e-15, "{t}");
            let exact = f(t) * (0.5 + 1.0 / (5.0 - t));
            assert!((value(&slope, t) - exact).abs() < 3e-13, "{t}");
            let [[both], [rate]] = values_and_slopes(&c, &[t]);
            assert!(both == value(&c, t) && (rate - exact).abs() < 3e-13, "{t}");
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

//! N values at once: loops over arrays, which become vector code.
//!
//! A formula is written once, for N values. One value is N = 1. Code for [`MANY`] values is compiled for each kind of machine; code
//! for one value is compiled for the plainest one.

/// How many values are computed at once: they fill two of the widest vectors.
pub const MANY: usize = 16;

/// Number of values in the widest vector of any machine.
pub const WIDEST: usize = 8;

/// One quantity, N times.
pub type Lanes<const N: usize = MANY> = [f64; N];

/// Makes an array from a function of the index, by a loop: the calls of `std::array::from_fn` may not be inlined.
#[inline(always)]
pub fn lanes<const N: usize>(value: impl Fn(usize) -> f64) -> Lanes<N> {
    let mut lanes = [0.0; N];
    for (k, out) in lanes.iter_mut().enumerate() {
        *out = value(k);
    }
    lanes
}

/// Collects at most 16 values; the other lanes hold 0.
pub fn padded(values: impl Iterator<Item = f64>) -> Lanes {
    let mut lanes = [0.0; MANY];
    lanes.iter_mut().zip(values).for_each(|(lane, value)| *lane = value);
    lanes
}

/// Tells whether a property holds for each of the N indices. There is no early end, because vector code has none.
#[inline(always)]
pub fn every<const N: usize>(holds: impl Fn(usize) -> bool) -> bool {
    let mut missed = 0;
    for k in 0..N {
        missed |= u64::from(!holds(k));
    }
    missed == 0
}

/// Gives the largest magnitude of N values, where N is a power of two. A NaN does not count; the result is 0 where all are NaN.
#[inline(always)]
pub fn largest<const N: usize>(values: &Lanes<N>) -> f64 {
    let mut most: Lanes<N> = lanes(|k| if values[k].abs() > 0.0 { values[k].abs() } else { 0.0 });
    // Halves are compared with each other: a single chain of comparisons would take as long as everything else.
    let mut half = N;
    while half > 1 {
        half /= 2;
        for k in 0..half {
            most[k] = if most[k + half] > most[k] { most[k + half] } else { most[k] };
        }
    }
    most[0]
}

/// Gives the smallest magnitude of N values to two roundings, where N is a power of two. A NaN does not count; infinite where all are NaN.
#[inline(always)]
pub fn smallest<const N: usize>(values: &Lanes<N>) -> f64 {
    1.0 / largest::<N>(&lanes(|k| 1.0 / values[k]))
}

/// Computes a b + c. The result is rounded once for several lanes, and twice for one lane.
///
/// Code for several lanes is compiled for machines that have an instruction for this. Code for one lane would call a function
/// for it on the plainest machine, which takes as long as ten products.
#[inline(always)]
pub fn multiply_add<const N: usize>(a: f64, b: f64, c: f64) -> f64 {
    if N == 1 { a * b + c } else { a.mul_add(b, c) }
}

/// Number of terms of the series of sine and cosine. The first one that is left out is below 1e-16 up to π/4.
const TERMS: usize = 9;

/// ±1/n!, with n = 2k + 1 (first row) and n = 2k (second row).
const SERIES: [[f64; TERMS]; 2] = {
    let mut rows = [[1.0; TERMS]; 2];
    let mut k = 1;
    while k < TERMS {
        let n = 2.0 * k as f64;
        rows[0][k] = -rows[0][k - 1] / (n * (n + 1.0));
        rows[1][k] = -rows[1][k - 1] / (n * (n - 1.0));
        k += 1;
    }
    rows
};

/// Computes sines and cosines of angles between −π/4 and π/4, to two roundings.
#[inline(always)]
pub fn sines_cosines<const N: usize>(angle: &Lanes<N>) -> [Lanes<N>; 2] {
    let [mut sine, mut cosine] = [[0.0; N]; 2];
    for term in (0..TERMS).rev() {
        for k in 0..N {
            let square = angle[k] * angle[k];
            sine[k] = multiply_add::<N>(sine[k], square, SERIES[0][term]);
            cosine[k] = multiply_add::<N>(cosine[k], square, SERIES[1][term]);
        }
    }
    [lanes(|k| sine[k] * angle[k]), cosine]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sines_and_cosines_are_those_of_the_standard_library() {
        for k in 0..=100 {
            let angle = std::f64::consts::FRAC_PI_4 * (f64::from(k) / 50.0 - 1.0);
            let [[sine], [cosine]] = sines_cosines(&[angle]);
            let apart = [(sine - angle.sin()).abs() / angle.abs().max(1e-300), (cosine - angle.cos()).abs()];
            assert!(apart.iter().all(|apart| *apart <= 2.0 * f64::EPSILON), "{angle} {apart:?}");
        }
    }

    #[test]
    fn extremes_pass_over_what_is_no_number() {
        let values: Lanes<4> = [-3.0, f64::NAN, 2.0, 0.5];
        assert_eq!((largest(&values), smallest(&values)), (3.0, 0.5));
        assert_eq!((largest(&[f64::NAN]), largest(&[-2.0])), (0.0, 2.0));
        assert!(every::<4>(|k| values[k] != 1.0) && !every::<4>(|k| values[k] > -4.0));
    }
}

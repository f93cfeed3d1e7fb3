//! N values at once: loops over arrays, which become vector code.
//!
//! A formula is written once, for N values. One value is N = 1. Code for [`MANY`] values is compiled for each kind of machine; code
//! for one value is compiled for the plainest one.

/// How many values are computed at once: they fill two of the widest vectors.
pub const MANY: usize = 16;

/// One quantity, N times.
pub type Lanes<const N: usize = MANY> = [f64; N];

/// Makes an array from a function of the index, by a loop: the calls of `std::array::from_fn` may be left out of line.
#[inline(always)]
pub fn lanes<const N: usize>(value: impl Fn(usize) -> f64) -> Lanes<N> {
    let mut lanes = [0.0; N];
    for (k, out) in lanes.iter_mut().enumerate() {
        *out = value(k);
    }
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

/// Gives the smallest magnitude of N values to two roundings, where N is a power of two. A NaN does not count.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extremes_pass_over_what_is_no_number() {
        let values: Lanes<4> = [-3.0, f64::NAN, 2.0, 0.5];
        assert_eq!((largest(&values), smallest(&values)), (3.0, 0.5));
        assert_eq!((largest(&[f64::NAN]), largest(&[-2.0])), (0.0, 2.0));
        assert!(every::<4>(|k| values[k] != 1.0) && !every::<4>(|k| values[k] > -4.0));
    }
}

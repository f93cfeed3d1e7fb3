//! Stores past the caches, for arrays that are larger than the caches.
//!
//! An ordinary store first reads the line of memory that it will overwrite. For large arrays that takes most of the time:
//! without this reading, 10⁸ points take a third of it (`wheelrail report`, growth of cost).

use pulp::bytemuck::Pod;

/// Writes vectors of f64. They are stored past the caches if the array begins at a multiple of 16 bytes and a vector holds pairs.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
#[allow(unsafe_code, reason = "no safe store leaves the caches out")]
pub fn write<V: Pod>(out: &mut [V], values: impl Iterator<Item = V>) {
    use std::arch::x86_64::{__m128d, _mm_set_pd, _mm_sfence, _mm_stream_pd};
    use std::slice::from_mut;

    use pulp::bytemuck::cast_slice_mut;

    const PAIR: usize = size_of::<__m128d>();
    if !out.as_ptr().addr().is_multiple_of(PAIR) || !size_of::<V>().is_multiple_of(PAIR) {
        return out.iter_mut().zip(values).for_each(|(out, value)| *out = value);
    }
    for (out, mut value) in out.iter_mut().zip(values) {
        let out = cast_slice_mut::<V, [f64; 2]>(from_mut(out));
        let pairs = cast_slice_mut::<V, [f64; 2]>(from_mut(&mut value));
        for (out, pair) in out.iter_mut().zip(pairs) {
            // SAFETY: `out` is an exclusive reference to the two numbers that are stored, at a multiple of 16 bytes: the
            // array's begin and whole pairs. SSE2 is part of x86_64.
            unsafe { _mm_stream_pd(out.as_mut_ptr(), _mm_set_pd(pair[1], pair[0])) };
        }
    }
    // Such stores are not ordered with others. The fence makes them visible before the borrow of `out` ends.
    // SAFETY: SSE is part of x86_64.
    unsafe { _mm_sfence() };
}

/// Writes vectors of f64.
#[cfg(not(target_arch = "x86_64"))]
#[inline(always)]
pub fn write<V: Pod>(out: &mut [V], values: impl Iterator<Item = V>) {
    out.iter_mut().zip(values).for_each(|(out, value)| *out = value);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_vector_is_written_wherever_the_array_begins() {
        for begin in 0..4 {
            let mut numbers = vec![-1.0; 40];
            let (out, rest) = numbers[begin..].as_chunks_mut::<4>();
            let count = out.len();
            write(out, (0..count).map(|k| [k as f64; 4]));
            assert!(rest.iter().all(|&value| value == -1.0));
            for (k, &value) in numbers[begin..begin + 4 * count].iter().enumerate() {
                assert_eq!(value, (k / 4) as f64, "{begin}");
            }
            assert!(numbers[..begin].iter().all(|&value| value == -1.0));
        }
        // A vector of one number is no pair.
        let mut numbers = [0.0; 3];
        write(&mut numbers, [1.0, 2.0, 3.0].into_iter());
        assert_eq!(numbers, [1.0, 2.0, 3.0]);
    }
}

//! All places at which a smooth function changes its sign, proved by its Chebyshev coefficients.

use super::chebyshev::{NODES, PROOF, coefficients_by_vectors, derivative, value};
use super::interval::Interval;
use super::lanes::{Lanes, lanes, largest};
use super::noise::measured;
use super::roots::bracketed;

/// Share of a function's size up to which its last coefficients count as rounding. Interpolants differ from their functions by
/// 1e-15 of it; noise of some hundred roundings does not look unresolved.
const RESOLVED: f64 = 1e-13;

/// Multiple of the last coefficients that the sum of all that are left out may reach. Those of a function with a kink fall so slowly
/// that it reaches some 16.
const LEFT_OUT: f64 = 256.0;

/// Half-length, as a share of the first interval, up to which a part is not halved again: the function jumps, ends or touches zero there.
const SHORTEST: f64 = 1e-10;

/// Size of a function, in units of its error, up to which it is zero: the sum of 15 coefficients that are rounding is smaller.
const ZERO: f64 = 16.0;

/// Number of batches after which nothing is halved any more. A touched zero takes 80.
const MOST_BATCHES: usize = 1024;

/// Number of batches from which on the noise is measured, by one more batch for every interval that is halved: it may be larger than
/// the caller's estimate.
const NOISY: usize = 16;

/// Finds every place inside an interval at which a function changes its sign, ascending, and perhaps some at which it only touches
/// zero. `f` gives the values at 16 places; `noise` is the size of their rounding. `f` must be smooth except at isolated places.
///
/// Method: the function is interpolated at 16 Chebyshev points. The sum of |c_k|, k ≥ 1, and a multiple of the last of them, prove that
/// there is no zero; where the last coefficients are rounding, the derivative's prove that there is at most one. Where they prove
/// neither, the interval is halved. Accuracy: noise over slope. Two changes may be missed only if |f| stays below its noise
/// between them. Where halving does not help, the noise is measured, since it may be larger than `noise`.
/// Cost: 16 values for most intervals. Degenerate: no place where `f` is NaN.
pub fn sign_changes(
    mut f: impl FnMut(&Lanes) -> Lanes,
    interval: Interval,
    noise: f64,
    found: &mut Vec<f64>,
) {
    let first = found.len();
    let shortest = SHORTEST * interval.width();
    let mut waiting = vec![(interval, noise)];
    let mut batches = 0;
    while let Some((interval, noise)) = waiting.pop() {
        let (middle, half) = (interval.middle(), interval.width() / 2.0);
        let place = |t: f64| interval.nearest(middle + half * t);
        let values = f(&lanes(|k| place(NODES[k])));
        batches += 1;
        let short = half <= shortest || !interval.surrounds(middle) || batches > MOST_BATCHES;
        if values.iter().any(|value| value.is_nan()) {
            if !short && values.iter().any(|value| !value.is_nan()) {
                waiting.extend(interval.halves().map(|half| (half, noise)).into_iter().rev());
            }
            continue;
        }
        let c = coefficients_by_vectors(&values);
        let error = noise + RESOLVED * largest(&values);
        let others = c[1..].iter().map(|c| c.abs()).sum::<f64>();
        let last = c[c.len() - PROOF..].iter().fold(0.0, |last: f64, c| last.max(c.abs()));
        let resolved = last <= error;
        if c[0].abs() > others + if resolved { error } else { LEFT_OUT * last } {
            continue;
        }
        let slope = derivative(&c);
        let one = slope[0].abs() > slope[1..].iter().map(|c| c.abs()).sum::<f64>();
        if resolved && one {
            let ends = [-1.0, 1.0].map(|t| value(&c, t));
            // Beside a zero at an end, rounding decides on which side of the end it is.
            let at_end = (0..2).find(|&k| ends[k].abs() <= error).map(|k| [-1.0, 1.0][k]);
            found.extend(at_end.or_else(|| bracketed(|t| value(&c, t), -1.0, 1.0)).map(place));
        } else if short || largest(&values) <= ZERO * error {
            found.push(middle);
        } else {
            let noise = if batches > NOISY { noise.max(measured(&mut f, interval)) } else { noise };
            waiting.extend(interval.halves().map(|half| (half, noise)).into_iter().rev());
        }
    }
    found[first..].sort_by(f64::total_cmp);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn changes(f: impl Fn(f64) -> f64, interval: Interval) -> (Vec<f64>, usize) {
        let (mut found, mut batches) = (Vec::new(), 0);
        let many = |x: &Lanes| {
            batches += 1;
            x.map(&f)
        };
        sign_changes(many, interval, 1e-15, &mut found);
        (found, batches)
    }

    #[test]
    fn near_and_many_zeros_are_all_found() {
        let (found, _) = changes(|x| (x - 0.1) * (x - 0.1001) * (x - 0.7), Interval::new(-1.0, 1.0));
        assert_eq!(found.len(), 3, "{found:?}");
        assert!((found[0] - 0.1).abs() < 1e-9 && (found[2] - 0.7).abs() < 1e-13, "{found:?}");
        let (found, _) = changes(|x| (40.0 * x).sin(), Interval::new(0.05, 3.0));
        assert_eq!(found.len(), 38);
        for (k, x) in found.iter().enumerate() {
            assert!((x - std::f64::consts::PI * (k as f64 + 1.0) / 40.0).abs() < 1e-13, "{x}");
        }
    }

    #[test]
    fn a_zero_where_an_interval_is_halved_is_found() {
        let (found, _) = changes(|x| x * (x * x - 0.5) * (x * x - 0.9), Interval::new(-1.0, 1.0));
        assert!(found.iter().any(|x| x.abs() < 1e-14), "{found:?}");
    }

    #[test]
    fn what_stays_away_from_zero_takes_one_batch_and_what_is_no_number_ends() {
        assert_eq!(changes(|x| 2.0 + x.sin(), Interval::new(-1.0, 1.0)), (Vec::new(), 1));
        let (found, batches) = changes(|x| (x - 0.25).sqrt() - 0.5, Interval::new(0.0, 1.0));
        assert!(found.iter().any(|x| (x - 0.5).abs() < 1e-13) && batches < 400, "{found:?} {batches}");
        assert_eq!(changes(|_| f64::NAN, Interval::new(0.0, 1.0)).1, 1);
    }
}

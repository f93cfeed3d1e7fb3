//! The noise of a function's values, measured where it may be larger than the caller's estimate.

use super::chebyshev::NODES;
use super::interval::Interval;
use super::lanes::{Lanes, lanes};

/// Length of the interval in which noise is measured, as a share of that over which the function is wanted. A smooth function's
/// distance from a line falls with its square.
const CLOSE: f64 = 1e-8;

/// Noise as a multiple of the largest distance of 16 values from a line.
const LEVEL: f64 = 4.0;

/// Measures the noise of a function in the middle of an interval by the distance from a line of 16 values close together; 0 if the
/// interval is so short that all are at one place. `f` gives the values at 16 places.
pub fn measured(f: impl FnOnce(&Lanes) -> Lanes, interval: Interval) -> f64 {
    let (middle, half) = (interval.middle(), interval.width() / 2.0);
    let x = lanes(|k| middle + CLOSE * half * NODES[k]);
    let values = f(&x);
    let last = x.len() - 1;
    let rate = (values[last] - values[0]) / (x[last] - x[0]);
    let off_line = |k: usize| (values[k] - values[0] - rate * (x[k] - x[0])).abs();
    // A distance that is NaN does not count.
    LEVEL * (1..last).map(off_line).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_is_found_and_what_is_smooth_has_none() {
        let smooth = |x: f64| (3.0 * x).sin() / (x + 1.1);
        let rough = |x: f64| smooth(x) + 1e-9 * (1e12 * x).sin();
        let of = |f: &dyn Fn(f64) -> f64| measured(|x: &Lanes| x.map(f), Interval::new(-1.0, 2.0));
        assert!(of(&smooth) < 1e-14, "{}", of(&smooth));
        assert!((1e-9..1e-8).contains(&of(&rough)), "{}", of(&rough));
        assert_eq!(measured(|x: &Lanes| x.map(rough), Interval::of(1.0)), 0.0);
    }
}

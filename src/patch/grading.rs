//! Maps a parameter to ξ so that the width of a patch, which is a square root at its tips, is smooth in the parameter.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use crate::numerics::interval::Interval;
use crate::numerics::lanes::{Lanes, lanes, sines_cosines};

/// ξ as a function of t in \[0, 1\] in which the width of a patch is smooth. Equal steps of t crowd towards round ends,
/// like equal angles of an ellipse.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Grading {
    /// Ends of the range of ξ \[mm\].
    pub(crate) xi: Interval,
    /// Whether each end is round. Tips are; ends of a profile are too, because the columns of a tilted wheel reach them as
    /// a square root.
    pub(crate) round: [bool; 2],
}

impl Grading {
    /// Returns ξ(t) \[mm\].
    pub(crate) fn xi(&self, t: f64) -> f64 {
        let [[xi], _] = self.xi_and_rate(&[t]);
        xi
    }

    /// Returns ξ(t) and dξ/dt \[mm\] at N values of t.
    #[inline(always)]
    pub(crate) fn xi_and_rate<const N: usize>(&self, t: &Lanes<N>) -> [Lanes<N>; 2] {
        let [sin, cos]: [Lanes<N>; 2] = sines_cosines(&lanes(|k| FRAC_PI_4 * t[k]));
        // Sine and cosine of π t/2.
        let twice = |k: usize| [2.0 * sin[k] * cos[k], (cos[k] - sin[k]) * (cos[k] + sin[k])];
        let length = self.xi.width();
        // From the nearer end, so that no digits of the distance from there are lost.
        let xi = lanes(|k| {
            let [s, c] = twice(k);
            let [from_low, from_high] = match self.round {
                [true, true] => [s * s, c * c],
                [true, false] => [2.0 * sin[k] * sin[k], c],
                [false, true] => [s, (cos[k] - sin[k]) * (cos[k] - sin[k])],
                [false, false] => [t[k], 1.0 - t[k]],
            };
            let (low, high) = (self.xi.low + length * from_low, self.xi.high - length * from_high);
            if from_low < from_high { low } else { high }
        });
        let rate = lanes(|k| {
            length
                * match self.round {
                    [true, true] => PI * twice(k)[0] * twice(k)[1],
                    [true, false] => PI * sin[k] * cos[k],
                    [false, true] => FRAC_PI_2 * twice(k)[1],
                    [false, false] => 1.0,
                }
        });
        [xi, rate]
    }

    /// Returns the parameter t of ξ.
    pub(crate) fn parameter(&self, xi: f64) -> f64 {
        let share = (xi - self.xi.low) / self.xi.width();
        match self.round {
            [true, true] => share.sqrt().asin() / FRAC_PI_2,
            [true, false] => (share / 2.0).sqrt().asin() / (FRAC_PI_2 / 2.0),
            [false, true] => share.asin() / FRAC_PI_2,
            [false, false] => share,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gradings_and_their_inverses() {
        for round in [[true, true], [true, false], [false, true], [false, false]] {
            let grading = Grading { xi: Interval::new(-2.0, 5.0), round };
            assert_eq!(grading.xi(0.0), -2.0);
            assert!((grading.xi(1.0) - 5.0).abs() < 1e-14);
            for t in [0.0, 0.1, 0.5, 0.9] {
                assert!((grading.parameter(grading.xi(t)) - t).abs() < 1e-14, "{round:?} {t}");
                let [[xi], [rate]] = grading.xi_and_rate(&[t]);
                assert!((xi - grading.xi(t)).abs() < 1e-14, "{round:?} {t}");
                let step = 1e-5;
                let difference = (grading.xi(t + step) - grading.xi(t - step)) / (2.0 * step);
                assert!((difference - rate).abs() < 1e-8 && rate >= 0.0, "{round:?} {t}");
            }
        }
    }
}

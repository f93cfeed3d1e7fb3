//! Maps a parameter to ξ so that the width of a patch, which is a square root at its tips, is smooth in the parameter.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::numerics::quadrature::smooth_integrals;

/// Longest piece, as a share of a band, that is tried with few nodes first.
const SHORT: f64 = 0.1;

/// ξ as a function of t in \[0, 1\] in which the width of a patch is smooth. Equal steps of t crowd towards round ends,
/// like equal angles of an ellipse.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Grading {
    /// Ends of the range of ξ \[mm\].
    pub(crate) xi: [f64; 2],
    /// Whether each end is round. Tips are; ends of a profile are too, because the columns of a tilted wheel reach them as
    /// a square root.
    pub(crate) round: [bool; 2],
}

impl Grading {
    /// Returns ξ(t) \[mm\].
    pub(crate) fn xi(&self, t: f64) -> f64 {
        let share = match self.round {
            [true, true] => (FRAC_PI_2 * t).sin().powi(2),
            [true, false] => 2.0 * (FRAC_PI_2 / 2.0 * t).sin().powi(2),
            [false, true] => (FRAC_PI_2 * t).sin(),
            [false, false] => t,
        };
        self.xi[0] + (self.xi[1] - self.xi[0]) * share
    }

    /// Returns ξ(t) and dξ/dt \[mm\].
    fn xi_and_slope(&self, t: f64) -> (f64, f64) {
        let (share, slope) = match self.round {
            [true, true] => {
                let (sin, cos) = (FRAC_PI_2 * t).sin_cos();
                (sin * sin, PI * sin * cos)
            }
            [true, false] => {
                let (sin, cos) = (FRAC_PI_2 / 2.0 * t).sin_cos();
                (2.0 * sin * sin, PI * sin * cos)
            }
            [false, true] => {
                let (sin, cos) = (FRAC_PI_2 * t).sin_cos();
                (sin, FRAC_PI_2 * cos)
            }
            [false, false] => (t, 1.0),
        };
        let length = self.xi[1] - self.xi[0];
        (self.xi[0] + length * share, length * slope)
    }

    /// Returns the parameter t of ξ.
    pub(crate) fn parameter(&self, xi: f64) -> f64 {
        let share = (xi - self.xi[0]) / (self.xi[1] - self.xi[0]);
        match self.round {
            [true, true] => share.sqrt().asin() / FRAC_PI_2,
            [true, false] => (share / 2.0).sqrt().asin() / (FRAC_PI_2 / 2.0),
            [false, true] => share.asin() / FRAC_PI_2,
            [false, false] => share,
        }
    }

    /// Returns ∫ f dξ between two values of t for several functions, which are evaluated at the same places. Each integral
    /// has its own relative accuracy. The functions must be smooth in between.
    pub(crate) fn integrals<const N: usize>(
        &self,
        t: [f64; 2],
        mut f: impl FnMut(f64) -> [f64; N],
        relative: [f64; N],
    ) -> [f64; N] {
        let mut weighted = |t: f64| {
            let (xi, slope) = self.xi_and_slope(t);
            f(xi).map(|value| value * slope)
        };
        smooth_integrals(&mut weighted, t, relative, t[1] - t[0] <= SHORT)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn square_roots_at_both_ends_cost_nothing() {
        let half_circle = Grading { xi: [-1.0, 1.0], round: [true; 2] };
        let mut count = 0usize;
        let height = |x: f64| {
            count += 1;
            [((1.0 - x) * (1.0 + x)).sqrt()]
        };
        let [area] = half_circle.integrals([0.0, 1.0], height, [1e-13]);
        assert!((area - FRAC_PI_2).abs() < 1e-13 && count <= 45, "{area} {count}");
    }

    #[test]
    fn gradings_and_their_inverses() {
        for round in [[true, true], [true, false], [false, true], [false, false]] {
            let grading = Grading { xi: [-2.0, 5.0], round };
            assert_eq!(grading.xi(0.0), -2.0);
            assert!((grading.xi(1.0) - 5.0).abs() < 1e-14);
            for t in [0.0, 0.1, 0.5, 0.9] {
                assert!((grading.parameter(grading.xi(t)) - t).abs() < 1e-14, "{round:?} {t}");
                let (xi, slope) = grading.xi_and_slope(t);
                assert!((xi - grading.xi(t)).abs() < 1e-14, "{round:?} {t}");
                let [run] = grading.integrals([0.0, t], |_| [1.0], [1e-13]);
                assert!((run - (xi + 2.0)).abs() < 1e-13 && slope >= 0.0, "{round:?} {t}");
            }
        }
    }
}

//! Integrals along a component, with the square-root behaviour at its tips taken out.

use crate::numerics::quadrature::integral;

/// An interval of ξ with the square-root behaviour of the boundary at its round ends taken out:
/// ξ(t) = a + (b − a) φ(t) for t in \[0, 1\], with φ′ = 0 there.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stretch {
    /// Its ends \[mm\].
    pub(crate) xi: [f64; 2],
    /// Which of them are round: tips, and ends of a profile, which a tilted wheel's columns reach as √ too.
    pub(crate) round: [bool; 2],
}

impl Stretch {
    pub(crate) fn xi(&self, t: f64) -> f64 {
        let share = match self.round {
            [false, false] => t,
            [true, false] => t * t,
            [false, true] => t * (2.0 - t),
            [true, true] => t * t * (3.0 - 2.0 * t),
        };
        self.xi[0] + (self.xi[1] - self.xi[0]) * share
    }

    fn slope(&self, t: f64) -> f64 {
        let slope = match self.round {
            [false, false] => 1.0,
            [true, false] => 2.0 * t,
            [false, true] => 2.0 - 2.0 * t,
            [true, true] => 6.0 * t * (1.0 - t),
        };
        (self.xi[1] - self.xi[0]) * slope
    }

    /// ∫ f dξ over the interval.
    pub(crate) fn integral(&self, f: &mut impl FnMut(f64) -> f64, relative: f64) -> f64 {
        integral(&mut |t| f(self.xi(t)) * self.slope(t), 0.0, 1.0, relative)
    }
}

/// What was found at the ξ asked for so far, mostly 15 of them: several integrals over one interval share their places.
#[derive(Debug)]
pub(crate) struct Memo<T>(Vec<(f64, T)>);

impl<T: Copy> Memo<T> {
    /// Nothing yet.
    pub(crate) fn new() -> Self {
        Self(Vec::new())
    }

    /// What is at ξ, by `find` if it is not known.
    pub(crate) fn at(&mut self, xi: f64, find: impl FnOnce(f64) -> T) -> T {
        if let Some((_, known)) = self.0.iter().find(|(place, _)| *place == xi) {
            return *known;
        }
        let found = find(xi);
        self.0.push((xi, found));
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn square_roots_at_both_ends_cost_nothing() {
        let half_circle = Stretch { xi: [-1.0, 1.0], round: [true; 2] };
        let mut count = 0usize;
        let area = half_circle.integral(
            &mut |x| {
                count += 1;
                ((1.0 - x) * (1.0 + x)).sqrt()
            },
            1e-13,
        );
        assert!((area - std::f64::consts::FRAC_PI_2).abs() < 1e-13 && count <= 500, "{area} {count}");
    }
}

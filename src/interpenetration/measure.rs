//! Integrals along a component: the square-root behaviour at its tips taken out, and no halving that only
//! chases rounding.

use crate::numerics::quadrature::integral;

/// Panels after which the result is taken as it is: a kink that no corner marks needs 40.
const MOST_PANELS: usize = 128;

/// Halvings that leave more than this share of a panel's error have met rounding: a kink leaves a quarter, a step a
/// half on the average, noise about 0.7. A kink may by chance sit where the rule hardly sees it, so that a
/// few such halvings prove nothing.
const NOISE_SHARE: f64 = 0.6;
const IDLE_HALVINGS: usize = 8;

/// An interval with its integral and error estimate.
struct Panel {
    ends: [f64; 2],
    sum: f64,
    error: f64,
}

impl Panel {
    fn new(f: &mut impl FnMut(f64) -> f64, ends: [f64; 2]) -> Self {
        let [sum, error] = integral(f, ends[0], ends[1], f64::MAX);
        Self { ends, sum, error }
    }
}

/// ∫ f over \[a, b\] to a relative demand, or to the rounding of `f` where that is larger.
///
/// Method: Gauss–Kronrod panels, the worst halved until their errors sum up to less than the demand or halving
/// no longer helps (as QUADPACK's QAG): the noise of a slice's width is that of s over δ, which no fixed floor knows.
/// Cost: 15 evaluations a panel, one panel for most smooth pieces.
pub(crate) fn settled(f: &mut impl FnMut(f64) -> f64, a: f64, b: f64, relative: f64) -> f64 {
    let mut panels = vec![Panel::new(f, [a, b])];
    let mut idle = 0;
    loop {
        let sum: f64 = panels.iter().map(|panel| panel.sum).sum();
        let error: f64 = panels.iter().map(|panel| panel.error).sum();
        let worst = (0..panels.len()).max_by(|&i, &j| panels[i].error.total_cmp(&panels[j].error));
        let Some(worst) = worst.filter(|_| error > relative * sum.abs()) else { return sum };
        if panels.len() >= MOST_PANELS || idle >= IDLE_HALVINGS {
            return sum;
        }
        let Panel { ends: [a, b], error, .. } = panels.swap_remove(worst);
        let middle = a + (b - a) / 2.0;
        let halves = [[a, middle], [middle, b]].map(|ends| Panel::new(f, ends));
        idle += usize::from(halves[0].error + halves[1].error > NOISE_SHARE * error);
        panels.extend(halves);
    }
}

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
        settled(&mut |t| f(self.xi(t)) * self.slope(t), 0.0, 1.0, relative)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_ends_the_halving_and_a_kink_does_not() {
        let mut count = 0usize;
        let mut noisy = |x: f64| {
            count += 1;
            x.exp() * (1.0 + 1e-9 * (x.to_bits() % 1009) as f64 / 1009.0)
        };
        let sum = settled(&mut noisy, 0.0, 1.0, 1e-13);
        assert!((sum / 1f64.exp_m1() - 1.0).abs() < 2e-9 && count < 500, "{sum} {count}");
        let kink = settled(&mut |x: f64| (x - 0.3).abs(), 0.0, 1.0, 1e-13);
        assert!((kink - 0.29).abs() < 1e-13, "{kink}");
    }

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

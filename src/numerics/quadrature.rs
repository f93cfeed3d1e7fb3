//! Adaptive Gauss–Kronrod quadrature.

use super::interval::Interval;
use super::lanes::{Lanes, MANY};

/// A Gauss–Kronrod pair on \[−1, 1\]: the nodes of one half, the outermost first and the centre last; their weights; and the weights
/// of the Gauss rule, which has every second node.
struct Rule<const K: usize, const G: usize> {
    nodes: [f64; K],
    kronrod: [f64; K],
    gauss: [f64; G],
}

/// The pair with 3 and 7 points.
const SHORT: Rule<4, 2> = Rule {
    nodes: [0.960_491_268_708_020_3, 0.774_596_669_241_483_4, 0.434_243_749_346_802_6, 0.0],
    kronrod: [
        0.104_656_226_026_467_26,
        0.268_488_089_868_333_44,
        0.401_397_414_775_962_2,
        0.450_916_538_658_474_1,
    ],
    gauss: [5.0 / 9.0, 8.0 / 9.0],
};

/// The pair with 7 and 15 points.
const LONG: Rule<8, 4> = Rule {
    nodes: [
        0.991_455_371_120_812_6,
        0.949_107_912_342_758_5,
        0.864_864_423_359_769_1,
        0.741_531_185_599_394_4,
        0.586_087_235_467_691_1,
        0.405_845_151_377_397_2,
        0.207_784_955_007_898_47,
        0.0,
    ],
    kronrod: [
        0.022_935_322_010_529_224,
        0.063_092_092_629_978_55,
        0.104_790_010_322_250_18,
        0.140_653_259_715_525_92,
        0.169_004_726_639_267_9,
        0.190_350_578_064_785_4,
        0.204_432_940_075_298_89,
        0.209_482_141_084_727_82,
    ],
    gauss: [
        0.129_484_966_168_869_7,
        0.279_705_391_489_276_64,
        0.381_830_050_505_118_9,
        0.417_959_183_673_469_4,
    ],
};

/// Factor on the relative difference of a pair's two sums, before its power 3/2 is taken for the error over a smooth integrand (as in
/// QUADPACK). The difference is the error of the Gauss rule, which has half the order.
const SMOOTH: f64 = 200.0;

/// Largest number of panels; with so many the result is taken as it is. A kink takes 40.
const MOST_PANELS: usize = 128;

/// A halving that leaves more than this share of a panel's error has met rounding: a kink leaves a quarter, a step a half on the
/// average, noise about 0.7. A kink may by chance sit where the rule hardly sees it, so that a few such halvings prove nothing.
const NOISE_SHARE: f64 = 0.6;

/// Number of halvings that met rounding after which the rest of the error counts as rounding.
const IDLE_HALVINGS: usize = 8;

/// An interval with the integrals over it and their error estimates.
struct GaussPanel<const N: usize> {
    over: Interval,
    sums: [f64; N],
    errors: [f64; N],
}

/// Computes ∫ f over an interval for several smooth functions that are known at the same places. Each is computed to its relative
/// demand, or to the rounding of `f` where that is larger. `f` takes at most 16 places and gives the values of each function in lanes,
/// of which those beyond the places do not count.
///
/// Method: Gauss–Kronrod panels, with the error that a Kronrod rule has over smooth functions. The worst one is halved until their
/// errors sum up to less than the demand, or halving no longer helps, or there are 128 panels (as QUADPACK's QAG): no fixed floor
/// knows how much noise an integrand has.
/// Cost: 15 places a panel, and one panel for most smooth pieces. `short` intervals of a smooth piece are tried with 7 places first.
/// Nothing is allocated for one panel.
/// Degenerate: NaN where `f` is NaN.
pub fn smooth_integrals<const N: usize>(
    f: &mut impl FnMut(&[f64]) -> [Lanes; N],
    over: Interval,
    relative: [f64; N],
    short: bool,
) -> [f64; N] {
    if short {
        let panel = GaussPanel::new(f, over, &SHORT, true);
        if excess(&panel.sums, &panel.errors, &relative) <= 1.0 {
            return panel.sums;
        }
    }
    halved(f, over, relative, true)
}

/// Computes integrals by panels that are halved; functions that are not `smooth` may have kinks.
fn halved<const N: usize>(
    f: &mut impl FnMut(&[f64]) -> [Lanes; N],
    over: Interval,
    relative: [f64; N],
    smooth: bool,
) -> [f64; N] {
    let first = GaussPanel::new(f, over, &LONG, smooth);
    if excess(&first.sums, &first.errors, &relative) <= 1.0 {
        return first.sums;
    }
    let mut panels = vec![first];
    let mut idle = 0;
    loop {
        let (mut sums, mut errors) = ([0.0; N], [0.0; N]);
        for panel in &panels {
            sums = add(sums, panel.sums, 1.0);
            errors = add(errors, panel.errors, 1.0);
        }
        let excess_of = |errors: &[f64; N]| excess(&sums, errors, &relative);
        let worst = (0..panels.len())
            .max_by(|&p, &q| excess_of(&panels[p].errors).total_cmp(&excess_of(&panels[q].errors)));
        let enough = excess_of(&errors) <= 1.0 || panels.len() >= MOST_PANELS || idle >= IDLE_HALVINGS;
        let Some(worst) = worst.filter(|_| !enough) else { return sums };
        let GaussPanel { over, errors, .. } = panels.swap_remove(worst);
        let halves = over.halves().map(|half| GaussPanel::new(f, half, &LONG, smooth));
        let left = excess_of(&halves[0].errors) + excess_of(&halves[1].errors);
        idle += usize::from(left > NOISE_SHARE * excess_of(&errors));
        panels.extend(halves);
    }
}

/// Gives the largest of the errors, each in units of its demand. A NaN does not count.
fn excess<const N: usize>(sums: &[f64; N], errors: &[f64; N], relative: &[f64; N]) -> f64 {
    (0..N).map(|k| errors[k] / (relative[k] * sums[k].abs())).fold(0.0, f64::max)
}

impl<const N: usize> GaussPanel<N> {
    /// Evaluates the Kronrod sums over an interval. Their errors are |Kronrod − Gauss|, and less for smooth functions.
    fn new<const K: usize, const G: usize>(
        f: &mut impl FnMut(&[f64]) -> [Lanes; N],
        over: Interval,
        rule: &Rule<K, G>,
        smooth: bool,
    ) -> Self {
        let (centre, half) = (over.middle(), over.width() / 2.0);
        // Both nodes of a pair side by side, the centre last.
        let mut places = [centre; MANY];
        for (k, &node) in rule.nodes[..K - 1].iter().enumerate() {
            [places[2 * k], places[2 * k + 1]] = [centre - half * node, centre + half * node];
        }
        let values = f(&places[..2 * K - 1]);
        let (mut kronrod, mut gauss) = ([0.0; N], [0.0; N]);
        for (index, values) in values.iter().enumerate() {
            for k in 0..K {
                let both = if k + 1 < K { values[2 * k] + values[2 * k + 1] } else { values[2 * k] };
                kronrod[index] += rule.kronrod[k] * both;
                if k % 2 == 1 {
                    gauss[index] += rule.gauss[k / 2] * both;
                }
            }
        }
        let sums = kronrod.map(|sum| sum * half);
        let mut errors = add(kronrod, gauss, -1.0).map(|error| (error * half).abs());
        if smooth {
            for (error, sum) in errors.iter_mut().zip(sums) {
                let share = SMOOTH * *error / sum.abs();
                *error = error.min(sum.abs() * share * share.sqrt());
            }
        }
        Self { over, sums, errors }
    }
}

/// Computes a + c b.
fn add<const N: usize>(mut a: [f64; N], b: [f64; N], c: f64) -> [f64; N] {
    for (a, b) in a.iter_mut().zip(b) {
        *a += c * b;
    }
    a
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::lanes::padded;

    fn integral(f: &mut impl FnMut(f64) -> f64, a: f64, b: f64, relative: f64) -> f64 {
        let mut many = |x: &[f64]| [padded(x.iter().map(|x| f(*x)))];
        let [sum] = halved(&mut many, Interval::new(a, b), [relative], false);
        sum
    }

    #[test]
    fn smooth_and_kinked_integrands() {
        let mut count = 0;
        let mut sine = |x: f64| {
            count += 1;
            x.sin()
        };
        let sum = integral(&mut sine, 0.0, std::f64::consts::PI, 1e-13);
        assert!((sum - 2.0).abs() < 1e-14 && count <= 45, "{sum} {count}");
        let kink = integral(&mut |x: f64| (x - 0.3).abs(), 0.0, 1.0, 1e-13);
        assert!((kink - 0.29).abs() < 1e-13, "{kink}");
    }

    #[test]
    fn noise_ends_the_halving() {
        let mut count = 0;
        let mut noisy = |x: f64| {
            count += 1;
            x.exp() * (1.0 + 1e-9 * (x.to_bits() % 1009) as f64 / 1009.0)
        };
        let sum = integral(&mut noisy, 0.0, 1.0, 1e-13);
        assert!((sum / 1f64.exp_m1() - 1.0).abs() < 2e-9 && count < 500, "{sum} {count}");
    }

    #[test]
    fn undefined_integrands_give_nan_and_end() {
        assert!(integral(&mut |x: f64| (x - 0.5).sqrt(), 0.0, 1.0, 1e-6).is_nan());
    }
}

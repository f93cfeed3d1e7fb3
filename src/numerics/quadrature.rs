//! Adaptive Gauss–Kronrod quadrature.

/// Nodes of the 7–15 point Gauss–Kronrod pair on \[0, 1\] half, outermost first, the centre last.
const NODES: [f64; 8] = [
    0.991_455_371_120_812_6,
    0.949_107_912_342_758_5,
    0.864_864_423_359_769_1,
    0.741_531_185_599_394_4,
    0.586_087_235_467_691_1,
    0.405_845_151_377_397_2,
    0.207_784_955_007_898_47,
    0.0,
];
const KRONROD: [f64; 8] = [
    0.022_935_322_010_529_224,
    0.063_092_092_629_978_55,
    0.104_790_010_322_250_18,
    0.140_653_259_715_525_92,
    0.169_004_726_639_267_9,
    0.190_350_578_064_785_4,
    0.204_432_940_075_298_89,
    0.209_482_141_084_727_82,
];
/// Weights of the Gauss rule at the odd nodes above.
const GAUSS: [f64; 4] =
    [0.129_484_966_168_869_7, 0.279_705_391_489_276_64, 0.381_830_050_505_118_9, 0.417_959_183_673_469_4];

/// Panels after which the result is taken as it is: a kink takes 40.
const MOST_PANELS: usize = 128;

/// Halvings that leave more than this share of a panel's error have met rounding: a kink leaves a quarter, a step a
/// half on the average, noise about 0.7. A kink may by chance sit where the rule hardly sees it, so that a
/// few such halvings prove nothing.
const NOISE_SHARE: f64 = 0.6;

/// After so many of them the rest is rounding.
const IDLE_HALVINGS: usize = 8;

/// An interval with its integral and error estimate.
struct Panel {
    ends: [f64; 2],
    sum: f64,
    error: f64,
}

/// ∫ f over \[a, b\] to a relative demand, or to the rounding of `f` where that is larger.
///
/// After 128 panels the sum is taken as it is.
///
/// Method: Gauss–Kronrod panels, the worst halved until their errors sum up to less than the demand or halving
/// no longer helps (as QUADPACK's QAG): how much noise an integrand has, no fixed floor knows.
/// Cost: 15 evaluations a panel, one panel for most smooth pieces.
/// Degenerate: NaN where `f` is.
pub fn integral(f: &mut impl FnMut(f64) -> f64, a: f64, b: f64, relative: f64) -> f64 {
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

impl Panel {
    /// The Kronrod sum, and |Kronrod − Gauss| as its error.
    fn new(f: &mut impl FnMut(f64) -> f64, ends @ [a, b]: [f64; 2]) -> Self {
        let (centre, half) = (a + (b - a) / 2.0, (b - a) / 2.0);
        let (mut kronrod, mut gauss) = (0.0, 0.0);
        for (k, &node) in NODES.iter().enumerate() {
            let both = f(centre - half * node) + if node == 0.0 { 0.0 } else { f(centre + half * node) };
            kronrod += KRONROD[k] * both;
            if k % 2 == 1 {
                gauss += GAUSS[k / 2] * both;
            }
        }
        Self { ends, sum: kronrod * half, error: ((kronrod - gauss) * half).abs() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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

//! How far samples of a quantity, or repeated measurements, spread.

use std::f64::consts::{FRAC_2_PI, FRAC_PI_2};
use std::fmt::Write;

use serde::Serialize;

use crate::numerics::roots::bracketed;

/// Share of further measurements within an interval.
const INSIDE: f64 = 0.95;
/// Shares of the samples below the ends of an interval: 95 % lie between them.
const ENDS: [f64; 2] = [0.025, 0.975];

/// Least number of samples that may be asked for: of fewer not even one lies beyond each end of the interval. Some of them may be lost.
pub const LEAST_SAMPLES: usize = 40;

/// How far a quantity spreads over samples or measurements, each number with its standard error from their number.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Spread {
    /// Number of samples in which the quantity exists.
    pub samples: usize,
    /// Mean.
    pub mean: f64,
    /// Standard error of the mean.
    pub mean_error: f64,
    /// Standard deviation.
    pub deviation: f64,
    /// Standard error of the standard deviation, as of a normal distribution.
    pub deviation_error: f64,
    /// Lower end of the interval that holds 95 % of the samples, or of further measurements.
    pub low: f64,
    /// Standard error of the lower end.
    pub low_error: f64,
    /// Upper end of the interval.
    pub high: f64,
    /// Standard error of the upper end.
    pub high_error: f64,
}

impl Spread {
    /// Finds the spread of samples; those that are not finite are left out. `None` for fewer than half of [`LEAST_SAMPLES`].
    pub fn of(samples: impl IntoIterator<Item = f64>) -> Option<Self> {
        let mut values: Vec<f64> = samples.into_iter().filter(|value| value.is_finite()).collect();
        if 2 * values.len() < LEAST_SAMPLES {
            return None;
        }
        values.sort_by(f64::total_cmp);
        let (mean, deviation) = moments(&values);
        let count = values.len() as f64;
        let [low, high] = ENDS.map(|share| quantile(&values, share));
        let [low_error, high_error] = ENDS.map(|share| {
            let off = (share * (1.0 - share) / count).sqrt();
            (quantile(&values, share + off) - quantile(&values, share - off)) / 2.0
        });
        Some(Self::new(values.len(), mean, deviation, [(low, low_error), (high, high_error)]))
    }

    /// Finds the spread of repeated measurements; those that are not finite are left out. `None` for fewer than two.
    ///
    /// Method: the interval is that of a normal distribution for one further measurement, mean ± t s √(1 + 1/n) with Student's t of
    /// n − 1 degrees of freedom; the errors of its ends are those of mean and deviation together.
    pub fn of_repeats(measurements: impl IntoIterator<Item = f64>) -> Option<Self> {
        let values: Vec<f64> = measurements.into_iter().filter(|value| value.is_finite()).collect();
        if values.len() < 2 {
            return None;
        }
        let (mean, deviation) = moments(&values);
        let count = values.len() as f64;
        let reach = student(values.len() - 1) * (1.0 + 1.0 / count).sqrt();
        let error = deviation * (1.0 / count + reach * reach / (2.0 * (count - 1.0))).sqrt();
        let end = |sign: f64| (mean + sign * reach * deviation, error);
        Some(Self::new(values.len(), mean, deviation, [-1.0, 1.0].map(end)))
    }

    /// Takes the ends of the interval, each with its error.
    fn new(samples: usize, mean: f64, deviation: f64, [low, high]: [(f64, f64); 2]) -> Self {
        let count = samples as f64;
        Self {
            samples,
            mean,
            mean_error: deviation / count.sqrt(),
            deviation,
            deviation_error: deviation / (2.0 * (count - 1.0)).sqrt(),
            low: low.0,
            low_error: low.1,
            high: high.0,
            high_error: high.1,
        }
    }
}

/// Returns mean and standard deviation of two values or more.
fn moments(values: &[f64]) -> (f64, f64) {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    (mean, (squares / (count - 1.0)).sqrt())
}

/// Returns Student's t that 95 % of the values do not exceed in size, for one degree of freedom or more.
///
/// Method: the closed form of the distribution (Abramowitz and Stegun 26.7.3 and 26.7.4) in θ = atan(t/√ν).
fn student(freedom: usize) -> f64 {
    let inside = |angle: f64| {
        let (sin, cos) = angle.sin_cos();
        let odd = freedom % 2 == 1;
        let (mut term, mut sum) = (if odd { cos } else { 1.0 }, 0.0);
        // Powers of the cosine from 1 or 0 up to ν − 2, in steps of two.
        for power in (freedom % 2..freedom.saturating_sub(1)).step_by(2) {
            sum += term;
            term *= cos * cos * (power + 1) as f64 / (power + 2) as f64;
        }
        if odd { FRAC_2_PI * (angle + sin * sum) } else { sin * sum }
    };
    // The share runs from 0 to 1 over the angles.
    let angle = bracketed(|angle| inside(angle) - INSIDE, 0.0, FRAC_PI_2).unwrap_or(f64::NAN);
    (freedom as f64).sqrt() * angle.tan()
}

/// Returns the value below which a share of ascending values lies, straight between neighbours.
fn quantile(values: &[f64], share: f64) -> f64 {
    let at = share.clamp(0.0, 1.0) * (values.len() - 1) as f64;
    let below = at.floor() as usize;
    let above = (below + 1).min(values.len() - 1);
    values[below] + (at - below as f64) * (values[above] - values[below])
}

/// Writes the spreads of quantities by their names for people, a line each below a line of heads.
pub fn spread_text<'a>(spreads: impl IntoIterator<Item = (&'a str, Option<&'a Spread>)>) -> String {
    let mut text = format!(
        "{:<24} {:>12} {:>12}  95 % lie between, each number with its sampling error\n",
        "quantity", "mean", "deviation"
    );
    for (name, spread) in spreads {
        // Writing to a String cannot fail.
        let _ = match spread {
            None => writeln!(text, "{name:<24} too few samples have it"),
            Some(of) => writeln!(
                text,
                "{name:<24} {:>12.5} {:>12.5}  {:.5} ± {:.5} to {:.5} ± {:.5} (mean ± {:.5}, deviation ± {:.5})",
                of.mean,
                of.deviation,
                of.low,
                of.low_error,
                of.high,
                of.high_error,
                of.mean_error,
                of.deviation_error
            ),
        };
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measured::noise::Deviates;

    #[test]
    fn the_spread_of_normal_samples_is_theirs_within_its_own_errors() {
        let mut deviates = Deviates::new(1, 0);
        let Some(spread) = Spread::of((0..4000).map(|_| 5.0 + 2.0 * deviates.draw())) else { panic!() };
        let within = |value: f64, error: f64, exact: f64| (value - exact).abs() < 4.0 * error;
        assert!(within(spread.mean, spread.mean_error, 5.0), "{spread:?}");
        assert!(within(spread.deviation, spread.deviation_error, 2.0), "{spread:?}");
        assert!(within(spread.low, spread.low_error, 5.0 - 2.0 * 1.959_964), "{spread:?}");
        assert!(within(spread.high, spread.high_error, 5.0 + 2.0 * 1.959_964), "{spread:?}");
        assert!(spread.low_error > 0.02 && spread.low_error < 0.2, "{spread:?}");
        let least = LEAST_SAMPLES as i32 / 2;
        assert!(Spread::of((0..least).map(f64::from)).is_some());
        assert_eq!(Spread::of((1..least).map(f64::from)), None);
    }

    #[test]
    fn students_t_is_that_of_the_tables() {
        let table = [(1, 12.706), (2, 4.303), (3, 3.182), (4, 2.776), (9, 2.262), (10, 2.228), (30, 2.042)];
        for (freedom, t) in table {
            assert!((student(freedom) - t).abs() < 5e-4, "{freedom}: {}", student(freedom));
        }
        assert!((student(100_000) - 1.959_964).abs() < 1e-4);
    }

    /// Of many sets of three and of ten measurements, the interval holds the next one in 95 % of all.
    #[test]
    fn the_interval_of_repeats_holds_the_next_measurement() {
        let mut deviates = Deviates::new(3, 0);
        for count in [3, 10] {
            let holds = (0..10_000).filter(|_| {
                let repeats = (0..count).map(|_| 30.0 + 0.02 * deviates.draw()).collect::<Vec<_>>();
                let next = 30.0 + 0.02 * deviates.draw();
                Spread::of_repeats(repeats).is_some_and(|of| (of.low..=of.high).contains(&next))
            });
            // Four standard errors of the share.
            let share = holds.count() as f64 / 1e4;
            assert!((share - 0.95).abs() < 0.009, "{count}: {share}");
        }
        assert_eq!(Spread::of_repeats([1.0, f64::NAN]), None);
    }
}

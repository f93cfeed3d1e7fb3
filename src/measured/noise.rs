//! Random errors of measurement: seeded normal deviates, profiles measured once more, and the spread of what is computed of them.

use serde::Serialize;

use super::options::Options;
use crate::error::{Error, Result};
use crate::profile::{Profile, Side, trace};

/// Default distance \[mm\] of the points of a profile that is measured once more: that of hand-held instruments.
pub const POINT_STEP: f64 = 0.2;

/// Shares of the samples below the ends of an interval: 95 % lie between them.
const ENDS: [f64; 2] = [0.025, 0.975];

/// Least number of samples: of fewer not even one lies beyond each end of the interval.
pub const LEAST_SAMPLES: usize = 40;

/// A stream of standard normal deviates. Streams of other numbers under one seed are independent of each other, so that each sample
/// has its own, whichever thread draws it.
///
/// Method: SplitMix64 (Steele, Lea, Flood 2014), and Box and Muller's transformation.
///
/// # Examples
/// ```
/// use wheelrail::measured::noise::Deviates;
///
/// let mut deviates = Deviates::new(1, 0);
/// let mean = (0..10_000).map(|_| deviates.draw()).sum::<f64>() / 10_000.0;
/// assert!(mean.abs() < 0.05);
/// ```
#[derive(Debug, Clone)]
pub struct Deviates {
    state: u64,
    /// The second deviate of a pair.
    spare: Option<f64>,
}

impl Deviates {
    /// Begins the stream with this number under a seed.
    pub fn new(seed: u64, number: u64) -> Self {
        Self { state: mixed(mixed(seed.wrapping_add(GOLDEN)).wrapping_add(number)), spare: None }
    }

    /// Draws the next deviate: mean 0, standard deviation 1.
    pub fn draw(&mut self) -> f64 {
        if let Some(spare) = self.spare.take() {
            return spare;
        }
        let radius = (-2.0 * self.uniform().ln()).sqrt();
        let (sin, cos) = (std::f64::consts::TAU * self.uniform()).sin_cos();
        self.spare = Some(radius * sin);
        radius * cos
    }

    /// Draws a number in (0, 1).
    fn uniform(&mut self) -> f64 {
        self.state = self.state.wrapping_add(GOLDEN);
        ((mixed(self.state) >> 11) as f64 + 0.5) / (1u64 << 53) as f64
    }
}

/// SplitMix64's step: 2⁶⁴ over the golden ratio, odd.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

fn mixed(state: u64) -> u64 {
    let z = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// A profile as points at equal distances, to be measured again and again.
#[derive(Debug, Clone)]
pub struct Remeasured {
    name: String,
    side: Side,
    points: Vec<[f64; 2]>,
    /// Unit normals at the points.
    normals: Vec<[f64; 2]>,
    options: Options,
}

impl Remeasured {
    /// Takes points every `step` \[mm\] along a profile, in the profile's own axes.
    ///
    /// # Errors
    /// A step that is not positive, or longer than the profile.
    pub fn new(profile: &Profile, side: Side, step: f64) -> Result<Self> {
        if !(step > 0.0 && step.is_finite()) {
            return Err(Error::new("step", step.to_string(), "a positive number of mm", "correct it"));
        }
        let marks = trace(profile, step);
        let length = marks.last().map_or(0.0, |mark| mark.s);
        let count = (length / step).floor() as usize;
        if count < 2 {
            let expected = format!("a step shorter than the {length} mm of {}", profile.name);
            return Err(Error::new("step", step.to_string(), expected, "take a smaller one"));
        }
        let (mut points, mut normals) = (Vec::with_capacity(count + 1), Vec::with_capacity(count + 1));
        let mut k = 0;
        for number in 0..=count {
            let s = length * number as f64 / count as f64;
            while k + 2 < marks.len() && marks[k + 1].s < s {
                k += 1;
            }
            let [a, b] = [&marks[k], &marks[k + 1]];
            let share = if b.s > a.s { ((s - a.s) / (b.s - a.s)).clamp(0.0, 1.0) } else { 0.0 };
            points.push(a.between(b, share));
            let near = if share < 0.5 { a.station } else { b.station };
            normals.push([-near.sin, near.cos]);
        }
        let options = Options { mirror: Some(false), flip_z: Some(false), ..Options::default() };
        Ok(Self { name: profile.name.clone(), side, points, normals, options })
    }

    /// Measures the profile once more: each point is off across the profile by a normal deviate times `sigma` \[mm\], and the points
    /// are smoothed like those of a file, with the default cut-off wavelength.
    ///
    /// # Errors
    /// Points that no curve can be drawn through, if `sigma` is as large as their distance.
    pub fn sample(&self, sigma: f64, deviates: &mut Deviates) -> Result<Profile> {
        let moved = self.points.iter().zip(&self.normals).map(|([x, z], [across, up])| {
            let off = sigma * deviates.draw();
            [x + off * across, z + off * up]
        });
        let moved: Vec<[f64; 2]> = moved.collect();
        Ok(super::of_points(&self.name, &moved, self.side, &self.options)?.profile)
    }
}

/// How far the samples of a quantity spread, each number with its standard error from the number of samples.
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
    /// Lower end of the interval that holds 95 % of the samples.
    pub low: f64,
    /// Standard error of the lower end, from the order statistics beside it.
    pub low_error: f64,
    /// Upper end of the interval.
    pub high: f64,
    /// Standard error of the upper end.
    pub high_error: f64,
}

impl Spread {
    /// Finds the spread of samples; those that are not finite are left out. `None` of fewer than [`LEAST_SAMPLES`].
    pub fn of(samples: impl IntoIterator<Item = f64>) -> Option<Self> {
        let mut values: Vec<f64> = samples.into_iter().filter(|value| value.is_finite()).collect();
        if values.len() < LEAST_SAMPLES {
            return None;
        }
        values.sort_by(f64::total_cmp);
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        let deviation = (squares / (count - 1.0)).sqrt();
        let [low, high] = ENDS.map(|share| quantile(&values, share));
        let [low_error, high_error] = ENDS.map(|share| {
            let off = (share * (1.0 - share) / count).sqrt();
            (quantile(&values, share + off) - quantile(&values, share - off)) / 2.0
        });
        Some(Self {
            samples: values.len(),
            mean,
            mean_error: deviation / count.sqrt(),
            deviation,
            deviation_error: deviation / (2.0 * (count - 1.0)).sqrt(),
            low,
            low_error,
            high,
            high_error,
        })
    }
}

/// Returns the value below which a share of ascending values lies, straight between neighbours.
fn quantile(values: &[f64], share: f64) -> f64 {
    let at = share.clamp(0.0, 1.0) * (values.len() - 1) as f64;
    let below = at.floor() as usize;
    let above = (below + 1).min(values.len() - 1);
    values[below] + (at - below as f64) * (values[above] - values[below])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::profile::{Section, standards};

    #[test]
    fn deviates_are_normal_and_streams_differ() {
        let mut deviates = Deviates::new(7, 3);
        let values: Vec<f64> = (0..40_000).map(|_| deviates.draw()).collect();
        let moment = |power: i32| values.iter().map(|value| value.powi(power)).sum::<f64>() / 4e4;
        // Four standard errors of each moment.
        assert!(moment(1).abs() < 0.02 && (moment(2) - 1.0).abs() < 0.03, "{} {}", moment(1), moment(2));
        assert!((moment(4) - 3.0).abs() < 0.2, "{}", moment(4));
        let first = |seed, number| Deviates::new(seed, number).draw();
        assert!(first(1, 0) != first(1, 1) && first(1, 0) != first(2, 0) && first(1, 1) != first(2, 0));
    }

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
        assert_eq!(Spread::of((0..39).map(f64::from)), None);
    }

    /// Smoothing leaves a part of the noise: far less than σ, and without it the profile itself.
    #[test]
    fn a_profile_measured_once_more_is_near_itself() -> Result<()> {
        for (profile, side) in
            [(standards::rail("60E1")?, Side::Rail), (standards::wheel("S1002")?, Side::Wheel)]
        {
            let remeasured = Remeasured::new(&profile, side, POINT_STEP)?;
            let own = Section::own_axes(&profile, side);
            let off = |sigma: f64| -> Result<f64> {
                let sample = remeasured.sample(sigma, &mut Deviates::new(1, 1))?;
                let sample = Section::own_axes(&sample, side);
                let squares = (-20..=20)
                    .map(|k| 0.5 * f64::from(k))
                    .map(|x| (sample.height(x) - own.height(x)).powi(2));
                Ok((squares.sum::<f64>() / 41.0).sqrt())
            };
            assert!(off(0.0)? < 1e-3, "{}", off(0.0)?);
            assert!((2e-3..0.02).contains(&off(0.02)?), "{}", off(0.02)?);
        }
        Ok(())
    }
}

//! Random errors of measurement: seeded normal deviates, profiles measured once more, and the spread of what is computed of them.

mod spread;

use rayon::prelude::*;

pub use spread::{LEAST_SAMPLES, Spread, spread_text};

use super::options::{CurveKind, Options};
use crate::error::{Error, Result};
use crate::numerics::random::Random;
use crate::profile::{Profile, Side, trace};

/// Default distance \[mm\] of the points of a profile that is measured once more: that of hand-held instruments.
pub const POINT_STEP: f64 = 0.2;

/// Largest number of samples.
const MOST_SAMPLES: usize = 1_000_000;

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
    random: Random,
    /// The second deviate of a pair.
    spare: Option<f64>,
}

impl Deviates {
    /// Begins the stream with this number under a seed.
    pub fn new(seed: u64, number: u64) -> Self {
        Self { random: Random::stream(seed, number), spare: None }
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
        ((self.random.bits() >> 11) as f64 + 0.5) / (1u64 << 53) as f64
    }
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
    /// A step that is not positive, or longer than half of the profile.
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

    /// Has the curve of each sample drawn as these options say: kind of curve, cut-off wavelength, kink angle, tolerance. Elements are
    /// drawn through their points.
    #[must_use]
    pub fn drawn_by(mut self, options: &Options) -> Self {
        let curve = match options.curve {
            Some(CurveKind::Elements) => Some(CurveKind::Interpolation),
            curve => curve,
        };
        let Options { cutoff_wavelength, kink_angle, arc_tolerance, .. } = *options;
        self.options = Options { curve, cutoff_wavelength, kink_angle, arc_tolerance, ..self.options };
        self
    }

    /// Measures the profile once more: each point is off across the profile by a normal deviate times `sigma` \[mm\], and the curve
    /// is drawn as [`Remeasured::drawn_by`] says, or else smoothed as its own noise asks for.
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

/// The spreads of quantities over samples of noise.
#[derive(Debug, Clone, PartialEq)]
pub struct Sampled<const N: usize> {
    /// Number of samples of which nothing could be computed.
    pub failed: usize,
    /// The spread of each quantity; `None` for a quantity that fewer than half of [`LEAST_SAMPLES`] samples have.
    pub spreads: [Option<Spread>; N],
}

/// Draws samples of quantities; `sample` gives them, NaN where there is none. Each sample has a stream of deviates of its own under the
/// seed: any number of threads gives the same bits.
///
/// # Errors
/// A number of samples that gives no interval; the error of a sample where none can be computed.
pub fn sampled<const N: usize>(
    samples: usize,
    seed: u64,
    sample: impl Fn(&mut Deviates) -> Result<[f64; N]> + Sync,
) -> Result<Sampled<N>> {
    check_samples(samples)?;
    let drawn = |number: usize| sample(&mut Deviates::new(seed, number as u64));
    let all: Vec<_> = (0..samples).into_par_iter().map(drawn).collect();
    let failed = all.iter().filter(|sample| sample.is_err()).count();
    if let (true, Some(Err(error))) = (failed == all.len(), all.first()) {
        return Err(error.clone().within("noise: every sample"));
    }
    let spread = |k: usize| Spread::of(all.iter().flatten().map(|sample| sample[k]));
    Ok(Sampled { failed, spreads: std::array::from_fn(spread) })
}

/// Rejects a number of samples that gives no interval, or more than a million.
///
/// # Errors
/// Such a number.
pub fn check_samples(samples: usize) -> Result<()> {
    if (LEAST_SAMPLES..=MOST_SAMPLES).contains(&samples) {
        return Ok(());
    }
    let expected =
        format!("{LEAST_SAMPLES} to {MOST_SAMPLES}: each end of the interval needs samples beyond it");
    Err(Error::new("noise: samples", samples.to_string(), expected, "correct it"))
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

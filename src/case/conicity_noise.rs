//! How far noise of the measurement moves the contact geometry of a wheelset: seeded samples of the whole computation.

use std::sync::atomic::{AtomicUsize, Ordering};

use serde::Serialize;

use crate::error::{Error, Result, finite};
use crate::measured::noise::{Deviates, POINT_STEP, Remeasured, Sampled, Spread, check_samples, sampled};
use crate::placement::{Pair, WheelDistance, Wheelset};
use crate::profile::{Profile, Side};
use crate::search::{
    AMPLITUDE, Conicity, GeometryAt, Roll, SideOnTrack, WheelsetOnTrack, geometry_over, nonlinearity,
};

/// Amplitude up to which the samples' conicity is tabulated \[mm\]: that of the nonlinearity parameter.
const REACH: f64 = 4.0;

/// Largest share of the samples without a quantity with which its spread is given: as many as lie outside of the interval. The samples that
/// are left are no fair choice of all.
const MOST_LOST: f64 = 0.05;

/// Quantities whose spread under noise is found. Key figures have their names; places of contact are those at a displacement of 0.
pub const UNCERTAIN: [&str; 7] = [
    "conicity_3mm",
    "nonlinearity_per_mm",
    "centre_mm",
    "left_rail_x_mm",
    "left_wheel_x_mm",
    "right_rail_x_mm",
    "right_wheel_x_mm",
];

/// Noise of a measurement, and how it is sampled.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Noise {
    /// Standard deviation of the points of all profiles across the profile \[mm\].
    pub points: f64,
    /// Standard deviation of each wheel's radius \[mm\].
    pub radius: f64,
    /// Standard deviation of the gauge \[mm\].
    pub gauge: f64,
    /// Distance of the points of all profiles \[mm\].
    pub step: f64,
    /// Number of samples.
    pub samples: usize,
    /// Seed of the samples.
    pub seed: u64,
}

impl Default for Noise {
    fn default() -> Self {
        Self { points: 0.0, radius: 0.0, gauge: 0.0, step: POINT_STEP, samples: 400, seed: 1 }
    }
}

/// Spread of the quantities under noise.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Uncertainty {
    /// The noise, and how it was sampled.
    pub noise: Noise,
    /// Number of samples of which nothing could be computed.
    pub failed: usize,
    /// Number of samples without each of [`UNCERTAIN`], the failed ones included.
    pub lost: [usize; UNCERTAIN.len()],
    /// The spread of each of [`UNCERTAIN`]; `None` of a quantity that fewer than 40 samples have, or 5 % of them have not.
    pub spreads: [Option<Spread>; UNCERTAIN.len()],
}

impl Uncertainty {
    /// Says which quantities some samples have not.
    pub(super) fn findings(&self) -> impl Iterator<Item = String> {
        let quantities = UNCERTAIN.into_iter().zip(self.lost).zip(&self.spreads);
        quantities.filter(|((_, lost), _)| *lost > 0).map(|((name, lost), spread)| {
            let told = match spread {
                Some(_) => "its spread is that of the others",
                None => "no spread is given, since the others are no fair choice",
            };
            format!("{lost} of {} samples of the noise have no {name}: {told}", self.noise.samples)
        })
    }
}

impl Noise {
    /// Rejects noise without meaning.
    ///
    /// # Errors
    /// Deviations that are negative or all 0; a number of samples that gives no interval.
    pub(super) fn validate(&self) -> Result<()> {
        let sigmas = [("points", self.points), ("radius", self.radius), ("gauge", self.gauge)];
        for (key, sigma) in sigmas {
            if finite(&format!("noise: {key}"), sigma)? < 0.0 {
                let expected = "a standard deviation of 0 mm or more";
                return Err(Error::new(
                    format!("noise: {key}"),
                    sigma.to_string(),
                    expected,
                    "correct the sign",
                ));
            }
        }
        if sigmas.iter().all(|(_, sigma)| *sigma == 0.0) {
            let expected = "a standard deviation above 0 of points, radius or gauge";
            return Err(Error::new("noise", "no noise", expected, "give one, for example points=0.02"));
        }
        check_samples(self.samples)
    }
}

/// Both profiles of a side, to be measured again and again.
struct NoisySide {
    side: SideOnTrack,
    pair: Pair,
    rail: Remeasured,
    wheel: Remeasured,
}

impl NoisySide {
    fn new(side: &SideOnTrack, pair: &Pair, step: f64) -> Result<Self> {
        Ok(Self {
            side: side.clone(),
            pair: pair.clone(),
            rail: Remeasured::new(pair.rail(), Side::Rail, step)?,
            wheel: Remeasured::new(pair.wheel(), Side::Wheel, step)?,
        })
    }

    /// Draws a sample of the side: new profiles and a new radius, and the rail moved out by half of `widened` \[mm\]; the wheels keep their
    /// distance.
    fn sample(&self, noise: &Noise, widened: f64, deviates: &mut Deviates) -> Result<SideOnTrack> {
        let of = |body: &Remeasured, own: &Profile, deviates: &mut Deviates| {
            if noise.points > 0.0 { body.sample(noise.points, deviates) } else { Ok(own.clone()) }
        };
        let rail = of(&self.rail, self.pair.rail(), deviates)?;
        let wheel = of(&self.wheel, self.pair.wheel(), deviates)?;
        let radius = self.side.wheelset().radius() + noise.radius * deviates.draw();
        let pair = Pair::new(rail.clone(), wheel, radius)?;
        let pair = match self.pair.roller_radius() {
            None => pair,
            Some(roller) => pair.on_roller(roller)?,
        };
        let spacing = WheelDistance::Spacing(2.0 * self.side.wheelset().wheel_x());
        SideOnTrack::new(&pair, self.side.track().moved(widened / 2.0, 0.0)?, Wheelset::new(spacing, radius)?)
    }
}

/// Finds the spread of the quantities under noise; any number of threads gives the same bits. `pairs` are those of the left and the
/// right side.
///
/// # Errors
/// Profiles shorter than the step of the points; noise of which no sample can be computed.
pub(super) fn uncertainty(
    system: &WheelsetOnTrack,
    pairs: [&Pair; 2],
    roll: Roll,
    noise: &Noise,
) -> Result<Uncertainty> {
    let side = |side, pair| NoisySide::new(side, pair, noise.step).map_err(|error| error.within("noise"));
    let sides = [side(system.left(), pairs[0])?, side(system.right(), pairs[1])?];
    let having = [const { AtomicUsize::new(0) }; UNCERTAIN.len()];
    let Sampled { failed, mut spreads } = sampled(noise.samples, noise.seed, |deviates| {
        let widened = noise.gauge * deviates.draw();
        let left = sides[0].sample(noise, widened, deviates)?;
        let right = sides[1].sample(noise, widened, deviates)?;
        let found = quantities(&WheelsetOnTrack::of_sides(left, right), roll)?;
        for (count, _) in having.iter().zip(found).filter(|(_, value)| value.is_finite()) {
            count.fetch_add(1, Ordering::Relaxed);
        }
        Ok(found)
    })?;
    let lost = having.map(|count| noise.samples - count.into_inner());
    for (spread, _) in
        spreads.iter_mut().zip(lost).filter(|(_, lost)| *lost as f64 > MOST_LOST * noise.samples as f64)
    {
        *spread = None;
    }
    Ok(Uncertainty { noise: *noise, failed, lost, spreads })
}

/// Gives the quantities of [`UNCERTAIN`]; NaN where there is none.
fn quantities(system: &WheelsetOnTrack, roll: Roll) -> Result<[f64; UNCERTAIN.len()]> {
    let table = Conicity::new(system, REACH, roll)?;
    let centred = geometry_over(system, &[0.0], roll)?[0];
    let of = |value: fn(&GeometryAt) -> f64| centred.as_ref().map_or(f64::NAN, value);
    Ok([
        table.at(AMPLITUDE).map_or(f64::NAN, |found| found.conicity),
        nonlinearity(&table).unwrap_or(f64::NAN),
        table.centre().unwrap_or(f64::NAN),
        of(|at| at.contacts[0].rail_x),
        of(|at| at.contacts[0].wheel_x),
        of(|at| at.contacts[1].rail_x),
        of(|at| at.contacts[1].wheel_x),
    ])
}

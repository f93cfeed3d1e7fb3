//! Counts positions of a wheelset a second on one core: drawn arcs against worn profiles as instruments
//! measure them.

use super::inclined::inclined_pair;
use super::specimen::{Instrument, Specimen, SpecimenKind};
use super::speed::{LEAST_RUNS, Timing, race, timed};
use wheelrail::error::Result;
use wheelrail::measured::{CurveKind, Format, Options};
use wheelrail::placement::{Pair, RailDistance, WheelDistance};
use wheelrail::profile::{Profile, standards};
use wheelrail::search::{Conicity, Position, Roll, Selection, Sweep, WheelsetOnTrack};

/// Largest displacement of the wheelset to either side \[mm\].
pub const AMPLITUDE: f64 = 10.0;
/// Yaw of the wheelset for every millimetre of displacement \[rad/mm\].
const YAW: f64 = 2e-3;

/// Distances of the points \[mm\] and noises \[µm\] of the measured pairs: 500 and 4000 points on a profile.
pub const INSTRUMENTS: [[f64; 2]; 4] = [[0.28, 3.0], [0.28, 5.0], [0.035, 3.0], [0.035, 5.0]];

/// Seed of wear and noise.
const SEED: u64 = 60_115_302;

/// The extent of the measurement.
#[derive(Debug, Clone, PartialEq)]
pub struct Extent {
    /// Number of positions of one sweep.
    pub positions: usize,
    /// Largest displacement \[mm\].
    pub amplitude: f64,
    /// Distances \[mm\] and noises \[µm\] of the measured pairs.
    pub instruments: Vec<[f64; 2]>,
}

impl Extent {
    /// Returns the extent of `wheelrail report`.
    pub fn full() -> Self {
        Self { positions: 20_000, amplitude: AMPLITUDE, instruments: INSTRUMENTS.to_vec() }
    }
}

/// The freedoms of a sweep's wheelset.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Freedoms {
    /// Lateral displacement, with the roll neglected as in EN 15302.
    Lateral,
    /// Lateral displacement, with the roll solved.
    Rolling,
    /// Lateral displacement and yaw, with the roll solved.
    Yawing,
}

impl Freedoms {
    /// All motions.
    pub const ALL: [Self; 3] = [Self::Lateral, Self::Rolling, Self::Yawing];

    /// Returns the name of the motion in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Lateral => "roll neglected",
            Self::Rolling => "roll solved",
            Self::Yawing => "yaw, roll solved",
        }
    }

    fn at(self, lateral: f64) -> Position {
        match self {
            Self::Lateral => Position { lateral, yaw: 0.0, roll: Roll::Neglect },
            Self::Rolling => Position { lateral, yaw: 0.0, roll: Roll::Solve },
            Self::Yawing => Position { lateral, yaw: YAW * lateral, roll: Roll::Solve },
        }
    }
}

/// One row of positions.csv.
#[derive(Debug, Clone, PartialEq)]
pub struct Rate {
    /// Description of the pair.
    pub pair: String,
    /// Whether the pair is measured.
    pub measured: bool,
    /// Freedoms of the wheelset.
    pub motion: Freedoms,
    /// Number of positions of the sweep, and how many of them have a contact.
    pub positions: [usize; 2],
    /// Shortest time of a sweep with its table of conicity \[s\].
    pub seconds: f64,
    /// Shortest time of the table of conicity \[s\].
    pub table_seconds: f64,
    /// Number of searches of the table of conicity.
    pub searches: usize,
    /// Largest estimated relative error of the conicities.
    pub conicity_error: f64,
}

impl Rate {
    /// Returns positions a second.
    pub fn rate(&self) -> f64 {
        self.positions[0] as f64 / self.seconds
    }
}

/// Measures the rates of all pairs and motions, in one race, each sweep for at least `seconds`; call it on
/// one thread.
///
/// # Errors
/// Specimens that cannot be read or are off the track, which is a fault of this program.
pub fn rates(extent: &Extent, seconds: f64) -> Result<Vec<Rate>> {
    let mut systems = vec![("drawn arcs".to_string(), false, system(drawn()?)?)];
    for &[spacing, noise] in &extent.instruments {
        for curve in [CurveKind::Smoothing, CurveKind::Interpolation] {
            let (points, pair) = worn(spacing, noise, curve)?;
            let curve = if curve == CurveKind::Smoothing { "smoothed" } else { "interpolated" };
            systems.push((format!("worn, {points} points, {noise} µm, {curve}"), true, system(pair)?));
        }
    }
    let contestants = systems.iter().flat_map(|system| Freedoms::ALL.map(|motion| (system, motion)));
    let mut rows = Vec::new();
    let mut tracks = Vec::new();
    for ((pair, measured, system), motion) in contestants {
        tracks.push((system, motion));
        rows.push(Rate {
            pair: pair.clone(),
            measured: *measured,
            motion,
            positions: [extent.positions, 0],
            seconds: f64::INFINITY,
            table_seconds: f64::INFINITY,
            searches: 0,
            conicity_error: 0.0,
        });
    }
    let mut timings = vec![Timing::NONE; rows.len()];
    let mut failed = None;
    race(&mut timings, seconds, LEAST_RUNS, |k| {
        let mut run = || swept(tracks[k].0, tracks[k].1, extent, &mut rows[k]);
        let mut result = Ok(());
        let time = timed(|| result = run());
        failed = failed.take().or(result.err());
        time
    });
    for (row, timing) in rows.iter_mut().zip(timings) {
        row.seconds = timing.best;
    }
    failed.map_or(Ok(rows), Err)
}

/// Runs one sweep with its table of conicity.
fn swept(system: &WheelsetOnTrack, motion: Freedoms, extent: &Extent, row: &mut Rate) -> Result<()> {
    let Extent { positions, amplitude, .. } = *extent;
    let mut table = None;
    let seconds = timed(|| table = Some(Conicity::new(system, amplitude, motion.at(0.0).roll)));
    let Some(conicity) = table.transpose()? else { return Ok(()) };
    row.table_seconds = row.table_seconds.min(seconds);
    row.searches = conicity.searches();
    let mut sweep = Sweep::new(system, Selection { within: 0.0, apart: 0.0 }, Some(&conicity));
    let mut found = Vec::new();
    row.positions[1] = 0;
    for k in 0..positions {
        let share = k as f64 / positions.saturating_sub(1).max(1) as f64;
        found.clear();
        sweep.position(&motion.at(amplitude * (2.0 * share - 1.0)), &mut found)?;
        let Some(first) = found.first() else { continue };
        row.positions[1] += 1;
        row.conicity_error = first.conicity.map_or(row.conicity_error, |c| row.conicity_error.max(c.error));
    }
    Ok(())
}

/// Sweeps a drawn pair, or a worn and smoothed one of some 500 points, through `positions` positions, one after the other.
///
/// # Errors
/// The errors of [`rates`].
pub fn sweep(measured: bool, motion: Freedoms, positions: usize) -> Result<()> {
    let [spacing, noise] = INSTRUMENTS[0];
    let pair = if measured { worn(spacing, noise, CurveKind::Smoothing)?.1 } else { drawn()? };
    let system = system(pair)?;
    let mut sweep = Sweep::new(&system, Selection { within: 0.0, apart: 0.0 }, None);
    let mut found = Vec::new();
    for k in 0..positions {
        found.clear();
        let share = k as f64 / positions as f64;
        sweep.position(&motion.at(AMPLITUDE * (2.0 * share - 1.0)), &mut found)?;
    }
    Ok(())
}

/// Makes the pair of 60E1 and wheel A of EN 15302: arcs and lines.
fn drawn() -> Result<Pair> {
    inclined_pair(&standards::rail("60E1")?, standards::wheel("EN15302-A")?)
}

/// Makes a worn pair through points every `spacing` mm with `noise` µm; also returns the number of points of
/// the larger profile.
fn worn(spacing: f64, noise: f64, curve: CurveKind) -> Result<(usize, Pair)> {
    let specimen = |kind: SpecimenKind| Specimen::new(kind, Instrument::new(spacing, noise, SEED));
    let fitted = |specimen: &Specimen| -> Result<Profile> {
        let options = Options { curve: Some(curve), ..specimen.options(Format::Csv) };
        specimen.measured_with(Format::Csv, &options).map(|measured| measured.profile)
    };
    let (rail, wheel) = (specimen(SpecimenKind::WornRail)?, specimen(SpecimenKind::WornWheel)?);
    let points = rail.points.len().max(wheel.points.len());
    Ok((points, inclined_pair(&fitted(&rail)?, fitted(&wheel)?)?))
}

fn system(pair: Pair) -> Result<WheelsetOnTrack> {
    let backs = WheelDistance::BackToBack { distance: 1360.0, flange_back_x: -70.0 };
    WheelsetOnTrack::new(&pair, RailDistance::Gauge { gauge: 1435.0, height: 14.0 }, backs)
}

//! Times what a caller waits for: each part of the way from a pair of profiles to a meshed patch, and everything that `run`
//! computes.

use std::hint::black_box;

use super::inclined::inclined_pair;
use super::specimen::{Instrument, Specimen, SpecimenKind};
use super::speed::{LEAST_RUNS, Timing, race, timed};
use wheelrail::Interval;
use wheelrail::case::{Profiles, Run, SILENT};
use wheelrail::error::Result;
use wheelrail::measured::Format;
use wheelrail::mesh::{StripCounts, StripMesh, equal_steps};
use wheelrail::patch::{Patch, Window};
use wheelrail::placement::Placement;
use wheelrail::profile::{Profile, standards};
use wheelrail::scene::{parse, with_profiles};
use wheelrail::search::{ONE_CONTACT, Pose, ProfilePair, Selection};
use wheelrail::separation::{EtaAxis, FULL_PRECISION, plan};

/// Approach δ \[mm\].
const APPROACH: f64 = 0.08;
/// Half widths of the window \[mm\].
const HALF_WIDTHS: [f64; 2] = [12.0, 10.0];

/// Distance of the points of the measured pair \[mm\].
const SPACING: f64 = 0.28;
/// Noise of the measured pair \[µm\].
const NOISE: f64 = 3.0;
/// Seed of the measured pair.
const SEED: u64 = 1979;

/// Yaw of the wheel in the yawed cases \[rad\].
const YAW: f64 = 0.01;

/// Radius of the rollers \[mm\].
const ROLLER: f64 = 350.0;

/// Names of the parts of a case, in order.
pub const PARTS: [&str; 6] = ["touch", "place", "plan", "fill", "patch", "mesh"];

/// Times of the parts of one case.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WholeCase {
    /// Kind of the pair, one of [`CASES`].
    pub pair: &'static str,
    /// Number n of the n × n grid.
    pub side: usize,
    /// Shortest time of every part of [`PARTS`] \[s\].
    pub seconds: [f64; PARTS.len()],
}

impl WholeCase {
    /// Returns the time of all parts together \[s\].
    pub fn total(&self) -> f64 {
        self.seconds.iter().sum()
    }

    /// Returns the time of one part \[s\].
    pub fn part(&self, name: &str) -> f64 {
        PARTS.iter().position(|part| *part == name).map_or(f64::NAN, |k| self.seconds[k])
    }
}

/// Names of the cases.
pub const CASES: [&str; 6] = [
    "drawn",
    "measured",
    "drawn, yawed",
    "measured, yawed",
    "drawn, on a roller, yawed",
    "measured, on a roller, yawed",
];

/// Times cases of a centred wheel on a rail or roller, with and without yaw: lowered, placed, with a grid of n × n points
/// at full precision, the patch in its window and the patch's mesh. Each part runs for at least `seconds`. Call it on
/// one thread.
///
/// # Errors
/// Pairs that cannot be fitted or placed, which is a fault of this program.
pub fn whole_cases(side: usize, seconds: f64) -> Result<Vec<WholeCase>> {
    let timed_case = |pair: &'static str| {
        let seconds = with_parts(pair, side, |run| {
            let mut timings = [Timing::NONE; PARTS.len()];
            race(&mut timings, seconds, LEAST_RUNS, |part| timed(|| run(PARTS[part])));
            timings.map(|timing| timing.best)
        })?;
        Ok(WholeCase { pair, side, seconds })
    };
    CASES.into_iter().map(timed_case).collect()
}

/// Writes a worn rail and a worn wheel as files, reads and smooths them.
pub(super) fn measured() -> Result<[Profile; 2]> {
    let profile = |kind| {
        let specimen = Specimen::new(kind, Instrument::new(SPACING, NOISE, SEED))?;
        specimen.measured(Format::Csv).map(|measured| measured.profile)
    };
    Ok([profile(SpecimenKind::WornRail)?, profile(SpecimenKind::WornWheel)?])
}

/// Times of what `run` computes for a worn, measured wheelset 3 mm to the right.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RunCost {
    /// Shortest time for reading and smoothing both profiles \[s\].
    pub profiles: f64,
    /// Shortest time for all the rest, without writing the files \[s\].
    pub rest: f64,
}

impl RunCost {
    /// Returns the sum of both times \[s\].
    pub fn total(&self) -> f64 {
        self.profiles + self.rest
    }
}

/// The scene of [`RunCost`]. Its profiles are passed in, not read by their names.
const WHEELSET: &str = "[rail]\nprofile = \"60E1\"\n[wheel]\nprofile = \"S1002\"\nradius = 460.0\n\
                        [track]\ngauge = 1435.0\n[wheelset]\nback_to_back = 1360.0\nflange_back_x = -70.0\n\
                        lateral = 3.0\n[patch]\nload = 60000.0\n";

/// Times what `run` computes, for at least `seconds`; call it on one thread.
///
/// # Errors
/// A scene that cannot be computed, which is a fault of this program.
pub fn run_cost(seconds: f64) -> Result<RunCost> {
    let scene = parse(WHEELSET, false)?;
    let [rail, wheel] = measured()?;
    let profiles = Profiles::drawn(inclined_pair(&rail, wheel)?);
    let run = || Run::new(with_profiles(&scene, profiles.clone(), "measured")?, SILENT);
    run()?;
    let mut timings = [Timing::NONE; 2];
    race(&mut timings, seconds, LEAST_RUNS, |part| {
        timed(|| match part {
            0 => drop(measured()),
            _ => drop(run()),
        })
    });
    let [profiles, rest] = timings.map(|timing| timing.best);
    Ok(RunCost { profiles, rest })
}

/// Prepares a case of [`CASES`] with a grid of n × n points, and passes what runs one part of [`PARTS`] to `then`.
///
/// # Errors
/// A pair that cannot be fitted or placed, which is a fault of this program.
pub fn with_parts<T>(case: &str, side: usize, then: impl FnOnce(&mut dyn FnMut(&str)) -> T) -> Result<T> {
    let profiles = if case.starts_with("measured") {
        measured()?
    } else {
        [standards::rail("60E1")?, standards::wheel("EN15302-A")?]
    };
    let [rail, wheel] = profiles;
    let (pair, yaw) = (inclined_pair(&rail, wheel)?, if case.ends_with("yawed") { YAW } else { 0.0 });
    let pair = if case.contains("roller") { pair.on_roller(ROLLER)? } else { pair };
    let profiles = ProfilePair::new(&pair)?;
    let mut search = profiles.search();
    let (pose, selection) = (Pose::new(0.0, yaw, 0.0)?, Selection { within: 0.0, apart: ONE_CONTACT });
    let contact = search.touch(&pose, &selection)?.contacts[0];
    let place = || contact.placed(&pair);
    let placement: Placement = place()?;
    let [xi, eta] = HALF_WIDTHS.map(|half| equal_steps(-half, half, side));
    let window = Window { xi: Interval::symmetric(HALF_WIDTHS[0]), eta: Interval::symmetric(HALF_WIDTHS[1]) };
    let axis = EtaAxis::new(&eta);
    let mut planned = plan(&placement, &xi, &axis, FULL_PRECISION, None);
    let mut values = vec![0.0; side * side];
    values.fill(0.0);
    let mut patch = Patch::new(&placement, APPROACH, &window);
    StripMesh::new(&placement, &patch, StripCounts::default())?;
    Ok(then(&mut |part| match part {
        "touch" => {
            black_box(&search.touch(&pose, &selection));
        }
        "place" => drop(black_box(place())),
        "plan" => planned = plan(&placement, &xi, &axis, FULL_PRECISION, None),
        "fill" => planned.fill(&placement, &xi, &axis, &mut values),
        "patch" => patch = Patch::new(&placement, APPROACH, &window),
        _ => drop(black_box(StripMesh::new(&placement, &patch, StripCounts::default()))),
    }))
}

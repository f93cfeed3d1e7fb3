//! Runs whole cases of engineers from their files to their grids, and checks them against brute force.
//!
//! The cases are in `cases.toml`: profiles new and worn, from drawings and from files of every format, the position of the
//! wheel, and the reason for the case. [`run`] makes the profiles, searches the contacts, cuts the patch out of an
//! automatic grid, and compares. Heights and gaps are compared with both bodies as chords of 0.01 mm, s with rays to those
//! chords, number and area of the components with a flood fill, and the ring around the automatic grid with δ. Each
//! disagreement is a failure of a [`PracticeRow`].

mod brute;
mod checks;
mod fill;
mod polyline;
mod row;

pub use row::PracticeRow;

use serde::Deserialize;

use super::specimen::{Instrument, Specimen, SpecimenKind};
use wheelrail::error::{Error, Result};
use wheelrail::measured::Format;
use wheelrail::placement::Pair;
use wheelrail::profile::{Profile, Side, inclination, standards};

/// A case as its table has it.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PracticeCase {
    /// Name of the case.
    pub name: String,
    /// Reason for the case.
    pub why: String,
    rail: CaseProfile,
    wheel: CaseProfile,
    /// Nominal rolling radius R \[mm\].
    #[serde(default = "usual_radius")]
    radius: f64,
    /// Inclination 1:n of the rail; upright if not given.
    #[serde(default)]
    lean: Option<f64>,
    stand: Stand,
    /// Approach δ \[mm\].
    #[serde(default = "usual_approach")]
    approach: f64,
}

/// The source of a profile: a built-in name, or a specimen.
#[derive(Debug, Clone, Deserialize)]
#[serde(untagged)]
enum CaseProfile {
    BuiltIn(String),
    Made(Made),
}

/// A specimen and the format of its file.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct Made {
    kind: SpecimenKind,
    spacing: f64,
    noise: f64,
    seed: u64,
    #[serde(default)]
    pits: usize,
    #[serde(default)]
    flats: usize,
    format: Format,
}

/// The position of the wheels.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
enum Stand {
    /// One wheel, with its profile origin beside the rail's.
    Wheel { offset: f64, yaw: f64 },
    /// A wheelset on the track of the checks, with the roll solved.
    Wheelset { lateral: f64, yaw: f64 },
    /// A wheelset at equal steps of the lateral displacement, with the roll solved and the conicity at
    /// `amplitude`.
    Sweep { to: f64, steps: u32, yaw: f64, amplitude: f64 },
}

fn usual_radius() -> f64 {
    460.0
}

fn usual_approach() -> f64 {
    0.05
}

/// Reads all cases.
///
/// # Errors
/// A fault of the table.
pub fn cases() -> Result<Vec<PracticeCase>> {
    #[derive(Deserialize)]
    struct PracticeTable {
        case: Vec<PracticeCase>,
    }
    let table: PracticeTable = toml::from_str(include_str!("cases.toml"))
        .map_err(|e| Error::new("practice/cases.toml", e.to_string(), "a table of cases", "correct it"))?;
    Ok(table.case)
}

/// Runs one case; every fault on the way, an error included, is a failure of its row.
pub fn run(case: &PracticeCase) -> PracticeRow {
    let mut row = PracticeRow {
        name: case.name.clone(),
        what: case.why.clone(),
        figure: 0.0,
        contacts: 0,
        area: f64::NAN,
        failures: Vec::new(),
    };
    let done = case.pair().and_then(|pair| match case.stand {
        Stand::Wheel { offset, yaw } => checks::wheel(&pair, offset, yaw, case.approach, &mut row),
        Stand::Wheelset { lateral, yaw } => checks::wheelset(&pair, lateral, yaw, case.approach, &mut row),
        Stand::Sweep { to, steps, yaw, amplitude } => {
            let positions: Vec<f64> =
                (0..=steps).map(|k| to * (2.0 * f64::from(k) / f64::from(steps) - 1.0)).collect();
            checks::sweep(&pair, &positions, yaw, amplitude, &mut row)
        }
    });
    if let Err(error) = done {
        row.failures.push(error.to_string());
    }
    row
}

impl PracticeCase {
    /// Makes the pair of the rail as it lies, and the wheel.
    fn pair(&self) -> Result<Pair> {
        let rail = self.rail.profile(Side::Rail)?;
        let rail = match self.lean {
            Some(n) => rail.rotated(inclination(1.0, n)?),
            None => rail,
        };
        Pair::new(rail, self.wheel.profile(Side::Wheel)?, self.radius)
    }
}

impl CaseProfile {
    fn profile(&self, side: Side) -> Result<Profile> {
        match (self, side) {
            (Self::BuiltIn(name), Side::Rail) => standards::rail(name),
            (Self::BuiltIn(name), Side::Wheel) => standards::wheel(name),
            (Self::Made(made), _) => {
                let Made { kind, spacing, noise, seed, pits, flats, format } = *made;
                let instrument = Instrument { spacing, noise, pits, flats, seed };
                Ok(Specimen::new(kind, instrument)?.measured(format)?.profile)
            }
        }
    }
}

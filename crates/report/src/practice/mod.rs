//! Whole cases as engineers have them, each run from its files to its grids and checked against brute force.
//!
//! The cases are `cases.toml`: profiles new and worn, from drawings and from files of every format, where the wheel
//! stands, and why the case is there. [`run`] makes the profiles, searches the contacts, cuts the patch out of an automatic
//! grid, and compares: heights and gaps with both bodies as chords of 0.01 mm, s with rays to those chords, parts and area of
//! the patch with a flood fill, and the ring around the automatic grid with δ. What disagrees is a [`PracticeRow`]'s failure.

mod brute;
mod checks;
mod fill;
mod polyline;

use serde::Deserialize;

use super::specimen::{Instrument, Specimen, SpecimenKind};
use wheelrail::error::{Error, Result};
use wheelrail::measured::Format;
use wheelrail::placement::Pair;
use wheelrail::profile::{Profile, Side, inclination, standards};

/// One row of the report: what a case gave.
#[derive(Debug, Clone, PartialEq)]
pub struct PracticeRow {
    /// Name of the case.
    pub name: String,
    /// Why it is there, and what stands where.
    pub what: String,
    /// Its one figure: the largest difference \[mm\] of a height, gap or separation from brute force.
    pub figure: f64,
    /// Contacts and near misses that were compared.
    pub contacts: usize,
    /// Largest relative difference of a patch's area from the flood fill; NaN where no patch was asked for.
    pub area: f64,
    /// What disagrees; empty where all is well.
    pub failures: Vec<String>,
}

/// A case.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PracticeCase {
    /// Its name.
    pub name: String,
    /// Why it is there.
    pub why: String,
    rail: CaseProfile,
    wheel: CaseProfile,
    /// R \[mm\].
    #[serde(default = "usual_radius")]
    radius: f64,
    /// The rail leans by 1:n; upright if not given.
    #[serde(default)]
    lean: Option<f64>,
    stand: Stand,
    /// δ \[mm\].
    #[serde(default = "usual_approach")]
    approach: f64,
}

/// Where a profile comes from: a name, or a specimen.
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

/// Where the wheels stand.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
enum Stand {
    /// One wheel, its profile origin beside the rail's.
    Wheel { offset: f64, yaw: f64 },
    /// A wheelset: gauge and origins as below; roll solved.
    Wheelset { lateral: f64, yaw: f64 },
    /// A wheelset at equal steps of the lateral displacement, roll solved, with the conicity at `amplitude`.
    Sweep { to: f64, steps: u32, yaw: f64, amplitude: f64 },
}

fn usual_radius() -> f64 {
    460.0
}

fn usual_approach() -> f64 {
    0.05
}

/// All cases.
///
/// # Errors
/// A fault of the table.
pub fn cases() -> Result<Vec<PracticeCase>> {
    #[derive(Deserialize)]
    struct Table {
        case: Vec<PracticeCase>,
    }
    let table: Table = toml::from_str(include_str!("cases.toml"))
        .map_err(|e| Error::new("practice/cases.toml", e.to_string(), "a table of cases", "correct it"))?;
    Ok(table.case)
}

/// Runs one case; what goes wrong on the way, an error included, is a failure of its row.
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
    /// The rail as it lies, and the wheel.
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

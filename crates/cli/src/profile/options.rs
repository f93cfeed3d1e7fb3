//! The options of measured files on the command line. They have the names and words of a scene.

use clap::{Args, ValueEnum};
use serde::Serialize;
use serde::de::DeserializeOwned;

use wheelrail::error::{Error, Result};
use wheelrail::measured::{Column, Options, Origin};
use wheelrail::profile::Side;
use wheelrail::scene;

/// Rail or wheel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum BodyOption {
    /// The profile is a rail, with the material below.
    Rail,
    /// The profile is a wheel, with the material above.
    Wheel,
}

impl From<BodyOption> for Side {
    fn from(body: BodyOption) -> Self {
        match body {
            BodyOption::Rail => Self::Rail,
            BodyOption::Wheel => Self::Wheel,
        }
    }
}

/// How a measured file is read. Words and defaults are those of a scene.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "Measured files")]
pub(super) struct MeasuredArguments {
    /// Format: miniprof, simpack, gensys, text, csv or vampire; if not given, the extension tells.
    #[arg(long)]
    format: Option<String>,
    /// Columns of x and z of a text or CSV file: numbers from 1, or names; for example 2,3.
    #[arg(long, value_name = "X,Z")]
    columns: Option<String>,
    /// Section of an .mpt file, or profile of a text, CSV or Vampire file, from 1.
    #[arg(long, allow_negative_numbers = true)]
    section: Option<usize>,
    /// Place of the section along the track of an .slcs file, mm.
    #[arg(long, value_name = "MM", allow_negative_numbers = true)]
    along: Option<f64>,
    /// Place of the section around the wheel of an .slcw file, rad.
    #[arg(long, value_name = "RAD", allow_negative_numbers = true)]
    angle: Option<f64>,
    /// Whether the first axis points to the centre of the track.
    #[arg(long, value_name = "true|false", num_args = 0..=1, default_missing_value = "true")]
    mirror: Option<bool>,
    /// Whether the second axis points down.
    #[arg(long, value_name = "true|false", num_args = 0..=1, default_missing_value = "true")]
    flip_z: Option<bool>,
    /// Unit: m, cm, mm, um, in, ft.
    #[arg(long)]
    unit: Option<String>,
    /// Origin: as-is, gauge-point, tape-line, or a point X,Z in mm.
    #[arg(long, allow_hyphen_values = true)]
    origin: Option<String>,
    /// Depth of the gauge point below the top of rail, mm.
    #[arg(long, value_name = "MM", allow_negative_numbers = true)]
    gauge_height: Option<f64>,
    /// Distance of the taping line from the flange back, mm.
    #[arg(long, value_name = "MM", allow_negative_numbers = true)]
    tape_distance: Option<f64>,
    /// Repairs: any of drop-duplicates, sort, remove-spikes and cut-loops; for example sort,cut-loops.
    #[arg(long, value_delimiter = ',')]
    repair: Vec<String>,
    /// Curve: smoothing, interpolation, arcs or elements.
    #[arg(long)]
    curve: Option<String>,
    /// Wavelength whose waves smoothing halves, mm.
    #[arg(long, value_name = "MM", allow_negative_numbers = true)]
    cutoff_wavelength: Option<f64>,
    /// Kinks above this angle stay corners, rad.
    #[arg(long, value_name = "RAD", allow_negative_numbers = true)]
    kink_angle: Option<f64>,
    /// Largest distance of a point from a chain of arcs, mm.
    #[arg(long, value_name = "MM", allow_negative_numbers = true)]
    arc_tolerance: Option<f64>,
}

impl MeasuredArguments {
    /// Returns the options for a measured file.
    ///
    /// # Errors
    /// An unknown word of an option; the error lists the known ones.
    pub(super) fn options(&self) -> Result<Options> {
        Ok(Options {
            format: word("--format", self.format.as_deref())?,
            columns: self.columns.as_deref().map(columns).transpose()?,
            section: self.section,
            along: self.along,
            angle: self.angle,
            mirror: self.mirror,
            flip_z: self.flip_z,
            unit: word("--unit", self.unit.as_deref())?,
            origin: self.origin.as_deref().map(origin).transpose()?,
            gauge_height: self.gauge_height,
            tape_distance: self.tape_distance,
            // The inclination belongs to a scene. These commands apply none.
            already_inclined: false,
            repair: self.repair.iter().map(|name| one_of("--repair", name)).collect::<Result<_>>()?,
            curve: word("--curve", self.curve.as_deref())?,
            cutoff_wavelength: self.cutoff_wavelength,
            kink_angle: self.kink_angle,
            arc_tolerance: self.arc_tolerance,
        })
    }

    /// Rejects all options if the profile has no measured points.
    ///
    /// # Errors
    /// Any option that is given.
    pub(super) fn reject(&self, name: &str) -> Result<()> {
        let given: Vec<String> = self.options()?.given().iter().map(|key| key.replace('_', "-")).collect();
        if given.is_empty() {
            return Ok(());
        }
        let found = format!("--{} for a drawn profile", given.join(", --"));
        let expected = "options of measured files for a file of measured points only";
        Err(Error::new(name, found, expected, "remove them, or give another file"))
    }
}

fn word<T: DeserializeOwned + Serialize>(option: &str, text: Option<&str>) -> Result<Option<T>> {
    text.map(|text| one_of(option, text)).transpose()
}

/// Reads a word as scenes spell it. The error lists the known words.
pub(super) fn one_of<T: DeserializeOwned + Serialize>(option: &str, text: &str) -> Result<T> {
    let quoted = serde_json::Value::from(text).to_string();
    scene::parse(&quoted, true).map_err(|error| error.at(option))
}

/// Reads two columns: "2,3" or "y,z".
fn columns(text: &str) -> Result<[Column; 2]> {
    let column = |name: &str| {
        let name = name.trim();
        name.parse().map_or_else(|_| Column::Name(name.into()), Column::Number)
    };
    match text.split(',').map(column).collect::<Vec<_>>().as_slice() {
        [x, z] => Ok([x.clone(), z.clone()]),
        _ => Err(Error::new("--columns", format!("\"{text}\""), "two columns X,Z", "give 2,3 or names")),
    }
}

/// Reads an origin: a name, or a point "x,z".
fn origin(text: &str) -> Result<Origin> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|part| part.trim().parse().ok()).collect();
    if let Some([x, z]) = numbers.as_deref() {
        return Ok(Origin::At([*x, *z]));
    }
    one_of("--origin", text).map(Origin::Named)
}

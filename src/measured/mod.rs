//! Turns an instrument's file of measured points into a profile.
//!
//! ```text
//! bytes ─ scan ─ reader of the format ─ placing ─ repairs ─ checks ─ curve ─ Profile
//!                   (miniprof, simpack, columns)  (options)         └ smoothing spline, interpolation, arcs
//! ```
//!
//! Nothing is guessed, and nothing is repaired in silence. An option decides first, then the definition of the format, then
//! the shape. A question that none of them answers is an error that lists the choices. Every decision is in the [`Record`].
//! This module does not access the disk.

mod clean;
mod column;
mod fit;
mod options;
mod place;
mod read;
mod shape;
mod unit;
pub mod write;

#[cfg(test)]
mod tests;

pub use clean::checks::{Check, Finding};
pub use clean::repairs::Repaired;
pub use column::Column;
pub use fit::curve::{Corner, CurveRecord, Residual};
pub use options::{
    ARC_TOLERANCE, CUTOFF_WAVELENGTH, CurveKind, GAUGE_HEIGHT, KINK_ANGLE, NamedOrigin, Options, Origin,
    Repair, TAPE_DISTANCE,
};
pub use place::{Step, Transform};
pub use read::format::Format;
pub use read::points::{DesignElement, ElementShape, MOST_ELEMENTS, MOST_POINTS, Note, Point, Points};
pub use read::scan::LARGEST_FILE;
pub use unit::Unit;

use serde::Serialize;

use crate::error::Result;
use crate::profile::{Profile, Side};

/// The decisions, repairs and fit that made a profile from a file. A run writes them to summary.json.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Record {
    /// The file's format.
    pub format: Format,
    /// Number of points in the file, or in the chosen section.
    pub points_read: usize,
    /// Number of points through or near which the curve is drawn.
    pub points_used: usize,
    /// Oddities of the file that did not prevent reading it.
    pub notes: Vec<Note>,
    /// Transformation from the file's axes to those of the profile.
    pub transform: Transform,
    /// Whether the points already contain the rail's inclination.
    pub already_inclined: bool,
    /// The repairs that were made.
    pub repairs: Vec<Repaired>,
    /// Findings that were neither fatal nor repaired.
    pub warnings: Vec<Finding>,
    /// The curve that was drawn.
    pub curve: CurveRecord,
}

/// A measured profile with its points and its record.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// The profile.
    pub profile: Profile,
    /// The points \[mm\] through or near which the curve is drawn, in profile axes, from left to right.
    pub points: Vec<Point>,
    /// Record of how the profile was made.
    pub record: Record,
}

/// Makes the profile from the bytes of a file. `file` is its name; the name tells the format and appears in messages.
///
/// Cost: about 5 µs a point for usual files, 20 µs a point for a million points; the spline takes most of it.
///
/// # Errors
/// Anything wrong with the options, the file or its points, with the place. See [`Options`], [`Format`], [`Transform`] and
/// [`Check`].
///
/// # Examples
/// ```
/// use wheelrail::Side;
/// use wheelrail::measured::{CurveKind, Options, profile};
///
/// let file = (0..=40).map(|k| f64::from(k) - 20.0).map(|x| format!("{x},{}\n", -x * x / 600.0)).collect::<String>();
/// let options = Options {
///     mirror: Some(false),
///     flip_z: Some(false),
///     curve: Some(CurveKind::Interpolation),
///     ..Options::default()
/// };
/// let measured = profile("crown.csv", file.as_bytes(), Side::Rail, &options)?;
/// assert_eq!(measured.record.points_used, 41);
/// assert_eq!(measured.profile.segments().len(), 40);
/// # Ok::<(), wheelrail::Error>(())
/// ```
pub fn profile(file: &str, bytes: &[u8], side: Side, options: &Options) -> Result<Measured> {
    options.validate()?;
    let format = match options.format {
        Some(format) => format,
        None => Format::of_file(file)?,
    };
    let points =
        read::reader::read(bytes, format, options.columns.as_ref()).map_err(|error| error.within(file))?;
    build(file, points, side, options).map_err(|error| error.within(file))
}

/// Returns the body that a file describes, by its extension or its header. Returns `None` if neither tells.
///
/// # Errors
/// The errors of [`Format::of_file`]; a file that is not of its format.
pub fn body(file: &str, bytes: &[u8], options: &Options) -> Result<Option<Side>> {
    if let Some(side) = Format::body_of_file(file) {
        return Ok(Some(side));
    }
    match options.format.map_or_else(|| Format::of_file(file), Ok)? {
        Format::Simpack => {
            Ok(read::reader::read(bytes, Format::Simpack, None).map_err(|error| error.within(file))?.body)
        }
        _ => Ok(None),
    }
}

fn build(file: &str, read: Points, side: Side, options: &Options) -> Result<Measured> {
    let mut read = match options.section {
        Some(number) => read.section(number)?,
        None => read,
    };
    let elements_alone = read.at.is_empty();
    options.validate_for(side, read.format, elements_alone)?;
    if elements_alone {
        read.at = fit::elements::points(&read.elements);
    }
    let (transform, turned) = place::resolve(&read, side, options)?;
    let mut points = transform.points(&read.at);
    let repairs = clean::repairs::repair(&mut points, &options.repair);
    let findings = clean::checks::findings(&points, side, options.gauge_height());
    clean::checks::reject(&findings)?;
    let warnings = findings.into_iter().chain(turned).collect();
    let placed: Vec<DesignElement> = read.elements.iter().map(|element| transform.element(element)).collect();
    let (segments, curve) = fit::curve::curve(&points, &placed, options, elements_alone)?;
    let source = format!("{} file {file}", format_title(read.format));
    let profile = Profile::new(file, source, segments)?;
    let record = Record {
        format: read.format,
        points_read: read.at.len(),
        points_used: points.len(),
        notes: read.notes,
        transform,
        already_inclined: options.already_inclined,
        repairs,
        warnings,
        curve,
    };
    Ok(Measured { profile, points, record })
}

fn format_title(format: Format) -> &'static str {
    match format {
        Format::Text => "text",
        Format::Csv => "CSV",
        other => other.title(),
    }
}

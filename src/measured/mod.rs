//! Measured profiles: from an instrument's file to a chain of segments.
//!
//! ```text
//! bytes ─ scan ─ reader of the format ─ placing ─ repairs ─ checks ─ curve ─ Profile
//!                   (miniprof, simpack, columns)  (options)         └ smoothing spline, interpolation, arcs
//! ```
//!
//! Nothing is guessed and nothing repaired in silence: what an option, the format's definition or else the shape does not
//! settle is an error that lists the choices, and every decision is in the [`Record`]. No disk access here.

mod clean;
mod fit;
mod options;
mod place;
mod read;
mod shape;
pub mod write;

#[cfg(test)]
mod tests;

pub use clean::checks::{Check, Finding};
pub use clean::repairs::Repaired;
pub use fit::curve::{Corner, CurveRecord, Residual};
pub use options::{
    ARC_TOLERANCE, CUTOFF_WAVELENGTH, Column, CurveKind, GAUGE_HEIGHT, KINK_ANGLE, NamedOrigin, Options,
    Origin, Repair, TAPE_DISTANCE, Unit,
};
pub use place::{Step, Transform};
pub use read::format::Format;
pub use read::points::{Element, ElementShape, MOST_ELEMENTS, MOST_POINTS, Note, Point, Points};
pub use read::scan::LARGEST_FILE;

use serde::Serialize;

use crate::error::Result;
use crate::profile::{Profile, Side};

/// What was read, decided, repaired and fitted: for summary.json.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Record {
    /// The file's format.
    pub format: Format,
    /// Points in the file, of the section chosen.
    pub points_read: usize,
    /// Points under the curve.
    pub points_used: usize,
    /// What is odd about the file.
    pub notes: Vec<Note>,
    /// From the file's axes to the profile's.
    pub transform: Transform,
    /// Whether the rail's inclination is in the points already.
    pub already_inclined: bool,
    /// Repairs that were made.
    pub repairs: Vec<Repaired>,
    /// What is left that a user should know of.
    pub warnings: Vec<Finding>,
    /// The curve.
    pub curve: CurveRecord,
}

/// A measured profile.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// The chain of segments.
    pub profile: Profile,
    /// The points under it \[mm\], in profile axes, from left to right.
    pub points: Vec<Point>,
    /// How it came about.
    pub record: Record,
}

/// The profile that a file of measured points describes; `file` is its name, for the format and for messages.
///
/// Cost: about 5 µs a point of usual files, 20 µs of a million, most of it the spline.
///
/// # Errors
/// Whatever is wrong with the options, the file or its points, with the place: see [`Options`], [`Format::read`],
/// [`Transform`], [`Check`].
pub fn profile(file: &str, bytes: &[u8], side: Side, options: &Options) -> Result<Measured> {
    options.validate()?;
    let format = match options.format {
        Some(format) => format,
        None => Format::of_file(file)?,
    };
    let points = format.read(bytes, options.columns.as_ref()).map_err(|error| error.within(file))?;
    build(file, points, side, options).map_err(|error| error.within(file))
}

/// The body that a file is of, by its extension or its header; `None` where neither says.
///
/// # Errors
/// Those of [`Format::of_file`] and [`Format::read`].
pub fn body(file: &str, bytes: &[u8], options: &Options) -> Result<Option<Side>> {
    if let Some(side) = Format::body_of_file(file) {
        return Ok(Some(side));
    }
    match options.format.map_or_else(|| Format::of_file(file), Ok)? {
        Format::Simpack => Ok(Format::Simpack.read(bytes, None).map_err(|error| error.within(file))?.body),
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
    let placed: Vec<Element> = read.elements.iter().map(|element| transform.element(element)).collect();
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

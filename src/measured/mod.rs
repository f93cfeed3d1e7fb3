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

mod ask;
mod clean;
mod column;
mod fit;
pub mod noise;
mod options;
mod place;
mod read;
mod shape;
mod slice;
mod unit;
mod words;
pub mod write;

#[cfg(test)]
mod tests;

pub use clean::checks::{Check, Finding};
pub use clean::repairs::Repaired;
pub use column::Column;
pub use fit::curve::{Corner, CurveRecord, Residual, ShapeTaken};
pub(crate) use options::measured_options;
pub use options::{
    ARC_TOLERANCE, CUTOFF_WAVELENGTH, CurveKind, GAUGE_HEIGHT, KINK_ANGLE, NamedOrigin, Options, Origin,
    Repair, TAPE_DISTANCE,
};
pub use place::{Step, Transform};
pub use read::format::Format;
pub use read::points::{
    ColumnChoice, DesignElement, ElementShape, Gap, MOST_ELEMENTS, MOST_POINTS, Note, Point, Points,
    StatedValue,
};
pub use read::scan::LARGEST_FILE;
pub use read::slices::{ListedSlice, MOST_SLICES, SliceList, listed_body};
pub use slice::{CutRecord, SectionOfList, Share};
pub use unit::Unit;
pub use words::{Wording, spoken, spoken_error};

use serde::Serialize;

use crate::error::{Error, ErrorKind, Result};
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
    /// Diameter of the wheel at its taping line \[mm\], as the file states it; `None` if it does not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub diameter: Option<f64>,
    /// The repairs that were made.
    pub repairs: Vec<Repaired>,
    /// Findings that were neither fatal nor repaired.
    pub warnings: Vec<Finding>,
    /// The curve that was drawn.
    pub curve: CurveRecord,
    /// Where the section was cut; `None` unless the profile is a section of slices.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cut: Option<CutRecord>,
    /// Values of the profile that the file states.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub stated: Vec<StatedValue>,
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
    let named = Format::body_of_file(file).filter(|named| options.format.is_none() && *named != side);
    if let Some(named) = named {
        let [found, expected] = [named, side].map(|side| match side {
            Side::Rail => "a rail",
            Side::Wheel => "a wheel",
        });
        let found = format!("the extension of {found}");
        return Err(Error::new(file, found, expected, "give the other file, or say its `format`"));
    }
    let points =
        read::reader::read(bytes, format, options.columns.as_ref()).map_err(|error| error.within(file))?;
    build(file, points, side, options).map_err(|error| error.within(file))
}

/// Makes the profile of points \[x, z\] that no file holds, in an order, a unit and axes that the options or the shape tell; a row with
/// NaN is a gap. `name` appears in messages.
///
/// # Errors
/// Anything wrong with the options or the points, as of [`profile`]; options that choose among the contents of a file.
pub fn of_points(name: &str, at: &[[f64; 2]], side: Side, options: &Options) -> Result<Measured> {
    options.validate()?;
    options.validate_without_file()?;
    if at.len() > MOST_POINTS {
        let (found, expected) = (format!("{} points", at.len()), format!("{MOST_POINTS} points at most"));
        return Err(Error::new(name, found, expected, "thin them out").of_kind(ErrorKind::Limit));
    }
    let mut points = Points::new(Format::Text, None);
    points.take_rows(name, at)?;
    if points.at.len() < 2 {
        let found = format!("{} points", points.at.len());
        return Err(Error::new(name, found, "2 points or more", "give all points"));
    }
    let placed = placed(points, side, options)?;
    drawn(name, "points".into(), placed, options, None).map_err(|error| error.within(name))
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

/// Makes the profile of a section between slices. `file` is the name of the list, and `contents` holds the bytes of each
/// slice beside its name in [`SectionOfList::files`].
///
/// Options hold for every slice. See [`SectionOfList`] for the place; the accuracy is in `docs/measured-files.md`.
///
/// # Errors
/// The errors of [`profile`] for each slice, with its name; a slice without bytes; slices that are turned or scaled
/// differently, have an origin of their own each, or have no part in common.
pub fn section(
    file: &str,
    cut: &SectionOfList<'_>,
    contents: &[(&str, Vec<u8>)],
    side: Side,
    options: &Options,
) -> Result<Measured> {
    let options = Options { along: None, angle: None, ..options.clone() };
    options.validate()?;
    let whole = || -> Result<Measured> {
        if matches!(options.origin, Some(Origin::Named(NamedOrigin::GaugePoint | NamedOrigin::TapeLine))) {
            let expected = "one origin for all slices, \"as-is\" or a point [x, z]";
            return Err(Error::new("origin", "an origin that each slice finds", expected, "choose another"));
        }
        let slices: Vec<(&str, Placed)> = contents
            .iter()
            .map(|(name, bytes)| Ok((*name, slice(name, bytes, side, &options).map_err(|e| e.within(name))?)))
            .collect::<Result<_>>()?;
        same_turn(&slices)?;
        let of = |name: &str| slices.iter().find(|(own, _)| *own == name).map(|(_, placed)| placed);
        let missing = |name: &str| Error::new(name, "no content", "the bytes of the slice", "read its file");
        let (points, record) = cut
            .interpolate(|name| of(name).map(|placed| placed.points.clone()).ok_or_else(|| missing(name)))?;
        let model = of(&record.points_of).ok_or_else(|| missing(&record.points_of))?;
        let all =
            |list: fn(&Placed) -> &[Note]| slices.iter().flat_map(|(_, own)| list(own).to_vec()).collect();
        let within = format!("{} with the points of {}", cut.place(), record.points_of);
        let mut findings = clean::findings::findings(&points, side, options.gauge_height());
        clean::checks::reject(&findings).map_err(|error| error.within(&within))?;
        let own = |finding: &&Finding| {
            let known = || findings.iter().any(|other| other.place == finding.place);
            finding.check == Check::Orientation || finding.check == Check::Gap && !known()
        };
        let of_model: Vec<Finding> = model.findings.iter().filter(own).cloned().collect();
        findings.extend(of_model);
        let placed = Placed {
            points,
            findings,
            elements: Vec::new(),
            diameter: None,
            stated: Vec::new(),
            elements_alone: false,
            notes: all(|own| &own.notes),
            repairs: slices.iter().flat_map(|(_, own)| own.repairs.clone()).collect(),
            ..model.clone()
        };
        let source = format!("{} of slices {file}", cut.place());
        drawn(file, source, placed, &options, Some(record)).map_err(|error| error.within(within))
    };
    whole().map_err(|error| error.within(file))
}

/// Reads and places one slice, and rejects points that no curve can be drawn through.
fn slice(name: &str, bytes: &[u8], side: Side, options: &Options) -> Result<Placed> {
    let format = options.format.map_or_else(|| Format::of_file(name), Ok)?;
    placed(read::reader::read(bytes, format, options.columns.as_ref())?, side, options)
}

/// Rejects slices whose shapes or formats turn or scale them differently.
fn same_turn(slices: &[(&str, Placed)]) -> Result<()> {
    let [(a, first), (b, second)] = slices else { return Ok(()) };
    if first.transform.scale == second.transform.scale {
        return Ok(());
    }
    let found = format!(
        "scales {:?} of {a} and {:?} of {b}, as their formats and shapes have it",
        first.transform.scale, second.transform.scale
    );
    Err(Error::new("mirror", found, "slices turned alike", "give `mirror`, `flip_z` and `unit`"))
}

/// The points of one file in profile axes, and how they came there.
#[derive(Debug, Clone)]
struct Placed {
    format: Format,
    points_read: usize,
    points: Vec<Point>,
    elements: Vec<DesignElement>,
    diameter: Option<f64>,
    stated: Vec<StatedValue>,
    /// Whether the file has design elements only.
    elements_alone: bool,
    notes: Vec<Note>,
    transform: Transform,
    /// Findings about the points and their orientation; none of them is fatal.
    findings: Vec<Finding>,
    repairs: Vec<Repaired>,
}

fn build(file: &str, read: Points, side: Side, options: &Options) -> Result<Measured> {
    let source = format!("{} file {file}", format_title(read.format));
    drawn(file, source, placed(read, side, options)?, options, None)
}

/// Turns the points of a file into profile axes and repairs them.
///
/// # Errors
/// All questions that are open, in one error; points that no curve can be drawn through.
fn placed(mut read: Points, side: Side, options: &Options) -> Result<Placed> {
    let starts = if read.sections.len() > 1 { read.profiles() } else { Vec::new() };
    let mut open = ask::of_content(&read, &starts, options);
    if read.columns.as_ref().is_some_and(|choice| choice.likely.is_none()) {
        return Err(ask::asked(&open, &read.at, side, true));
    }
    match options.section {
        Some(number) => read = read.section(number)?,
        // The first of several profiles shows what else has to be asked.
        None if starts.len() > 1 => {
            read.sections = starts;
            read = read.section(1)?;
        }
        None => {}
    }
    let elements_alone = read.at.is_empty();
    options.validate_for(side, read.format, elements_alone)?;
    if elements_alone {
        read.at = fit::elements::points(&read.elements);
    }
    let points_read = read.at.len();
    let placing = place::resolve(&mut read, side, options)?;
    let transform = placing.transform;
    let mut points = transform.points(&read.at);
    open.extend(placing.open);
    if placing.wrong_unit.is_some() || !open.is_empty() {
        if placing.wrong_unit.is_none() {
            open.extend(ask::of_repairs(&points, side, options));
        }
        let error = match placing.wrong_unit {
            None => ask::asked(&open, &points, side, placing.stated),
            Some(mut error) => {
                error.advice +=
                    &open.iter().map(|question| format!("; and {}", question.choices)).collect::<String>();
                error
            }
        };
        return Err(error);
    }
    let repairs = clean::repairs::repair(&mut points, &options.repair);
    let findings = clean::findings::findings(&points, side, options.gauge_height());
    ask::reject(&transform.points(&read.at), &findings, side, options)?;
    let gaps = gaps(&read, &points, &findings);
    let elements = read.elements.iter().map(|element| transform.element(element)).collect();
    let diameter = read.diameter.filter(|_| side == Side::Wheel);
    Ok(Placed {
        format: read.format,
        points_read,
        points,
        elements,
        diameter,
        stated: read.stated,
        elements_alone,
        notes: read.notes,
        transform,
        findings: findings.into_iter().chain(gaps).chain(placing.findings).collect(),
        repairs,
    })
}

/// Returns the findings of rows without values, but for those of gaps that were found by their length.
fn gaps(read: &Points, points: &[Point], found: &[Finding]) -> Vec<Finding> {
    let place = |number: usize| points.iter().position(|point| point.number == number);
    let made = read.gaps.iter().filter_map(|gap| {
        let [a, b] = [place(gap.between[0])?, place(gap.between[1])?];
        let (before, after) = (&points[a.min(b)], &points[a.max(b)]);
        let known = found.iter().any(|own| own.check == Check::Gap && own.place == before.place());
        let wide = clean::checks::distance(before, after);
        let lines = gap.lines;
        let word = if before.line == 0 { "point" } else { "line" };
        let rows = if lines.0 == lines.1 {
            format!("{word} {}", lines.0)
        } else {
            format!("{word}s {} to {}", lines.0, lines.1)
        };
        let text = format!("no value in {rows}: no point over {wide:.2} mm up to {}", after.place());
        (!known).then(|| Finding::gap(before, text))
    });
    made.collect()
}

/// Draws the curve through placed points.
fn drawn(
    name: &str,
    source: String,
    placed: Placed,
    options: &Options,
    cut: Option<CutRecord>,
) -> Result<Measured> {
    let Placed { points, elements, elements_alone, .. } = placed;
    let (mut segments, curve, of_curve) = fit::curve::curve(&points, &elements, options, elements_alone)?;
    if curve.kind != CurveKind::Elements {
        clean::bridges::name(&mut segments, &points, &placed.findings);
    }
    let smoothed = curve.noise.filter(|_| curve.cutoff_wavelength.is_some());
    let profile = Profile::new(name, source, segments)?.with_noise(smoothed.unwrap_or(0.0));
    let record = Record {
        format: placed.format,
        points_read: placed.points_read,
        points_used: points.len(),
        notes: placed.notes,
        transform: placed.transform,
        already_inclined: options.already_inclined,
        diameter: placed.diameter,
        repairs: placed.repairs,
        warnings: placed.findings.into_iter().chain(of_curve).collect(),
        curve,
        cut,
        stated: placed.stated,
    };
    Ok(Measured { profile, points, record })
}

fn format_title(format: Format) -> &'static str {
    match format {
        Format::Text => "text",
        Format::Csv => "CSV",
        Format::Vampire => "Vampire",
        other => other.title(),
    }
}

//! `wheelrail profile convert`: writes a profile in another format.

use std::path::PathBuf;

use clap::Args;

use super::source::{SourceArguments, SourcedProfile};
use crate::answer::{Outcome, complain, counted, put};
use wheelrail::error::{Error, Result};
use wheelrail::measured::{CurveKind, Format, write};

/// The profile to convert, and the format.
#[derive(Debug, Args)]
pub(crate) struct ConvertArguments {
    #[command(flatten)]
    source: SourceArguments,
    /// Format: miniprof, simpack, gensys, text, csv or vampire for points; toml for the segments of a chain.
    #[arg(long, value_name = "FORMAT")]
    to: String,
    /// Distance of points along the curve, mm. If not given: 0.2 for a drawn profile; the measured points themselves for a
    /// measured one.
    #[arg(long, value_name = "MM", allow_negative_numbers = true)]
    step: Option<f64>,
    /// File to write; stdout if not given.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

/// Converts a profile.
///
/// # Errors
/// An unknown format; a body that only --side can tell; segments that no chain file can hold.
pub(super) fn convert(arguments: &ConvertArguments) -> Result<Outcome> {
    arguments.source.refuse_output(arguments.out.as_deref())?;
    let text = if arguments.to == "toml" { toml(arguments)? } else { points(arguments)? };
    put(&text, arguments.out.as_deref())
}

fn points(arguments: &ConvertArguments) -> Result<String> {
    let format: Format = super::options::one_of("--to", &arguments.to).map_err(|mut error| {
        error.expected += ", toml";
        error
    })?;
    let source = arguments.source.read()?;
    let measured: Option<Vec<_>> =
        source.measured().map(|measured| measured.points.iter().map(|point| point.xz()).collect());
    let of_points = (measured.as_deref(), arguments.step);
    let written = write::profile(source.profile(), of_points, (format, source.side));
    let (text, left_out) = written.map_err(|error| {
        let option = format!("--{}", error.place);
        error.at(option)
    })?;
    if left_out > 0 {
        let (left_out, least) = (counted(left_out, "point"), write::LEAST_DISTANCE);
        complain(&format!("note: left out, {left_out} nearer than {least} mm to another"));
    }
    Ok(text)
}

/// Returns a chain file. It cannot hold a spline: a measured file without --curve becomes a chain of arcs.
fn toml(arguments: &ConvertArguments) -> Result<String> {
    if let Some(step) = arguments.step {
        let expected = "no --step beside --to toml, which writes segments";
        return Err(Error::new("--step", step.to_string(), expected, "remove it"));
    }
    let source = arguments.source.read_as(Some(CurveKind::Arcs))?;
    chosen(&source);
    let profile = source.profile();
    let (text, cut) = write::chain(profile).map_err(|error| error.within(&profile.name))?;
    for cut in cut {
        complain(&format!("note: left out, {cut}"));
    }
    Ok(text)
}

fn chosen(source: &SourcedProfile) {
    let Some(curve) = source.measured().map(|measured| &measured.record.curve) else { return };
    if let (CurveKind::Arcs, Some(tolerance), Some(residual)) = (curve.kind, curve.tolerance, &curve.residual)
    {
        let (n, largest) = (curve.segments, residual.largest);
        complain(&format!(
            "note: {n} arcs within {tolerance} mm of the points, at most {largest:.2e} mm off"
        ));
    }
}

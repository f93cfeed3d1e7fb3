//! `wheelrail profile plot`: draws the picture of a profile.

use std::path::Path;

use super::source::{Source, SourceArguments};
use crate::answer::{Outcome, print};
use crate::output::PictureFormat;
use wheelrail::error::Result;
use wheelrail::export::{ProfilePicture, SEPARATOR};
use wheelrail::files::write_file;
use wheelrail::measured::{CurveRecord, Measured};
use wheelrail::profile::{Mark, beside, trace};

/// Distance of the curve's marks \[mm\]: 1500 on a profile, finer than a page can show.
const STEP: f64 = 0.1;

/// Draws the picture into a file, or as SVG to stdout.
pub(super) fn plot(arguments: &SourceArguments, out: Option<&Path>) -> Result<Outcome> {
    arguments.refuse_output(out)?;
    let format = out.map(|out| PictureFormat::of_file("--out", out)).transpose()?;
    let svg = picture(&arguments.read()?);
    match out.zip(format) {
        Some((out, format)) => write_file(out, &format.bytes(svg)?).map(|()| Outcome::Done),
        None => print(&svg),
    }
}

fn picture(source: &Source) -> String {
    let profile = source.profile();
    let marks = trace(profile, STEP);
    let points: Vec<[f64; 2]> =
        source.measured().map_or_else(Vec::new, |measured| measured.points.iter().map(|p| p.xz()).collect());
    ProfilePicture {
        title: &profile.name,
        about: &about(source),
        points: &points,
        curve: &marks.iter().map(|mark| [mark.station.x, mark.station.z]).collect::<Vec<_>>(),
        residual: &residual(&marks, &points),
        curvature: &marks.iter().map(|mark| [mark.s, mark.curvature]).collect::<Vec<_>>(),
    }
    .svg()
}

fn about(source: &Source) -> String {
    let segments = source.profile().segments().len();
    let Some(Measured { record, .. }) = source.measured() else {
        return format!("{segments} segments{SEPARATOR}{}", source.profile().source);
    };
    let CurveRecord { residual, cutoff_wavelength, tolerance, .. } = &record.curve;
    let mut out = format!("{} points", record.points_used);
    if let Some(cutoff) = cutoff_wavelength {
        out += &format!("{SEPARATOR}cut-off wavelength {cutoff} mm");
    }
    if let Some(tolerance) = tolerance {
        out += &format!("{SEPARATOR}tolerance {tolerance} mm");
    }
    if let Some(residual) = residual {
        let (largest, rms) = (1e3 * residual.largest, 1e3 * residual.rms);
        out += &format!("{SEPARATOR}residual: largest {largest:.2} µm, rms {rms:.2} µm");
    }
    out + &format!("{SEPARATOR}{segments} segments")
}

/// Returns \[s, distance of the point to the left of the curve\] \[mm\] for every point.
fn residual(marks: &[Mark], points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut hint = 0;
    let residual = |point: &[f64; 2]| {
        let found = beside(marks, *point, hint)?;
        hint = found.mark;
        Some([found.s, found.across])
    };
    points.iter().filter_map(residual).collect()
}

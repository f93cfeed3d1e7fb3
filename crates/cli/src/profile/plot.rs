//! `wheelrail profile plot`: draws the picture of a profile.

use std::path::Path;

use super::source::{SourceArguments, SourcedProfile};
use crate::answer::{Outcome, print};
use crate::output::PictureFormat;
use wheelrail::case::{about_profile, profile_picture};
use wheelrail::error::Result;
use wheelrail::files::write_file;

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

fn picture(source: &SourcedProfile) -> String {
    let (profile, measured) = (source.profile(), source.measured());
    let points: Vec<[f64; 2]> =
        measured.map_or_else(Vec::new, |measured| measured.points.iter().map(|p| p.xz()).collect());
    profile_picture(profile, &about_profile(profile, measured.map(|measured| &measured.record)), &points)
}

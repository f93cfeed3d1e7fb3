//! `wheelrail profile average`: a representative profile of many, with their spread as a band.

use std::path::PathBuf;

use clap::Args;

use super::options::one_of;
use super::several::SeveralArguments;
use super::source::SourcedProfile;
use crate::answer::{Outcome, complain, counted, put};
use crate::output::{PictureFormat, refuse_taken};
use wheelrail::error::{Error, Result};
use wheelrail::export::{BandPicture, BandPoint, SEPARATOR};
use wheelrail::files::write_file;
use wheelrail::measure::{Average, MeasureOptions, average};
use wheelrail::measured::{Format, write};
use wheelrail::profile::Profile;

/// The profiles to average, and what is written.
#[derive(Debug, Args)]
pub(crate) struct AverageArguments {
    /// Format of the average: miniprof, simpack, gensys, text or csv.
    #[arg(long, value_name = "FORMAT", default_value = "text")]
    to: String,
    /// File of the average; stdout if not given.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Table of the average with its spread, in addition.
    #[arg(long, value_name = "FILE.csv")]
    band: Option<PathBuf>,
    /// Picture of the average with its spread, in addition: .svg or .png.
    #[arg(long, value_name = "FILE")]
    picture: Option<PathBuf>,
    #[command(flatten)]
    several: SeveralArguments,
}

/// Averages profiles.
///
/// # Errors
/// A profile that cannot be read or is of another body; wrong options; fewer than two that can be aligned.
pub(super) fn run(arguments: &AverageArguments) -> Result<Outcome> {
    arguments.refuse_outputs()?;
    let format: Format = one_of("--to", &arguments.to)?;
    let several = &arguments.several;
    let sources = several.sources().into_iter().collect::<Result<Vec<_>>>()?;
    let nominal = several.nominal()?;
    let side = several.body(sources.iter().chain(&nominal))?;
    let side = side.ok_or_else(|| {
        Error::new("--side", "profiles without a body", "their body", "give --side rail or wheel")
    })?;
    let options = several.aligned(MeasureOptions::default())?;
    let profiles: Vec<&Profile> = sources.iter().map(SourcedProfile::profile).collect();
    let average = average(&profiles, side, nominal.as_ref().map(SourcedProfile::profile), &options)?;
    for finding in &average.findings {
        complain(&format!("finding: {finding}"));
    }
    let name = format!("average of {}", counted(average.profiles, "profile"));
    if let Some(band) = &arguments.band {
        write_file(band, average.csv().as_bytes())?;
    }
    if let Some(picture) = &arguments.picture {
        let bytes = PictureFormat::of_file("--picture", picture)?.bytes(drawn(&name, &average))?;
        write_file(picture, &bytes)?;
    }
    put(&write::points(&average.xz(), format, side, &name), arguments.out.as_deref())
}

fn drawn(title: &str, average: &Average) -> String {
    let points: Vec<BandPoint> = average
        .points
        .iter()
        .map(|point| BandPoint {
            at: point.at,
            normal: point.normal,
            spread: point.spread,
            range: point.range,
        })
        .collect();
    let (points_of, spread) = (counted(average.points.len(), "point"), average.spread());
    let about = format!("{points_of}{SEPARATOR}root mean square of the standard deviations {spread:.4} mm");
    BandPicture { title, about: &about, points: &points }.svg()
}

impl AverageArguments {
    fn refuse_outputs(&self) -> Result<()> {
        let mut taken = self.several.read_from();
        if let Some(picture) = &self.picture {
            PictureFormat::of_file("--picture", picture)?;
        }
        for (option, file) in [("--out", &self.out), ("--band", &self.band), ("--picture", &self.picture)] {
            let Some(file) = file else { continue };
            refuse_taken(option, file, &taken)?;
            taken.push(file.clone());
        }
        Ok(())
    }
}

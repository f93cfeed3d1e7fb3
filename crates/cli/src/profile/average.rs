//! `wheelrail profile average`: a representative profile of many, with their spread as a band.

use std::path::PathBuf;

use clap::Args;
use rayon::prelude::*;

use super::measure::{CURVE, range, source};
use super::options::{BodyOption, MeasuredArguments, one_of};
use super::source::Source;
use crate::answer::{Outcome, complain, counted, put};
use crate::output::{PictureFormat, refuse_taken};
use wheelrail::error::{Error, Result};
use wheelrail::export::{BandPicture, BandPoint, SEPARATOR};
use wheelrail::files::write_file;
use wheelrail::measure::{Average, MeasureOptions, average};
use wheelrail::measured::{Format, write};
use wheelrail::profile::{Profile, Side};

/// The profiles to average, and what is written.
#[derive(Debug, Args)]
pub(crate) struct AverageArguments {
    /// Files or names of built-in profiles, of one body.
    #[arg(required = true)]
    files: Vec<String>,
    /// Body of the profiles. Built-in names tell it, and so do files such as .ban, .whl, .prr, .prw.
    #[arg(long, ignore_case = true)]
    side: Option<BodyOption>,
    /// Name or file of a nominal profile, on which each of them is aligned.
    #[arg(long, value_name = "NAME|FILE")]
    nominal: Option<String>,
    /// Alignment: none, back, tread-point, back-and-tread, field-side, web, unworn or best-fit; best-fit with a nominal.
    #[arg(long)]
    align: Option<String>,
    /// Ranges of the nominal's x that are not worn, for --align unworn, mm.
    #[arg(long, value_name = "FROM:TO", value_delimiter = ',', allow_hyphen_values = true)]
    unworn: Vec<String>,
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
    measured: MeasuredArguments,
}

/// Averages profiles.
///
/// # Errors
/// A profile that cannot be read or is of another body; wrong options; fewer than two that can be aligned.
pub(super) fn run(arguments: &AverageArguments) -> Result<Outcome> {
    arguments.refuse_outputs()?;
    let format: Format = one_of("--to", &arguments.to)?;
    let read = |file: &String| source(file, arguments.side, arguments.measured.clone()).read_as(CURVE);
    let sources = arguments.files.par_iter().map(read).collect::<Result<Vec<_>>>()?;
    let nominal = arguments
        .nominal
        .as_ref()
        .map(|name| source(name, arguments.side, MeasuredArguments::default()).read_as(CURVE));
    let nominal = nominal.transpose().map_err(|error| error.within("--nominal"))?;
    let side = arguments.body(sources.iter().chain(&nominal))?;
    let options = MeasureOptions {
        align: arguments.align.as_deref().map(|text| one_of("--align", text)).transpose()?,
        unworn: arguments.unworn.iter().map(|text| range(text)).collect::<Result<_>>()?,
        ..MeasureOptions::default()
    };
    let profiles: Vec<&Profile> = sources.iter().map(Source::profile).collect();
    let average = average(&profiles, side, nominal.as_ref().map(Source::profile), &options)?;
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
        let read = self.files.iter().chain(&self.nominal).map(PathBuf::from);
        let mut taken: Vec<PathBuf> = read.filter(|path| path.exists()).collect();
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

    /// Returns the one body of all profiles.
    fn body<'a>(&self, sources: impl Iterator<Item = &'a Source>) -> Result<Side> {
        let mut side = self.side.map(Side::from);
        for source in sources {
            let name = &source.profile().name;
            match (side, source.side) {
                (Some(known), Some(own)) if known != own => {
                    let advice = "average wheels or rails, on a nominal of theirs";
                    return Err(Error::new(name, "the other body", "one body", advice));
                }
                (None, own) => side = own,
                _ => {}
            }
        }
        let advice = "give --side rail or wheel";
        side.ok_or_else(|| Error::new("--side", "profiles without a body", "their body", advice))
    }
}

//! `wheelrail profile measure`: flange height and thickness of wheels, wear of rails, a row a file.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use clap::Args;
use rayon::prelude::*;

use super::options::one_of;
use super::several::SeveralArguments;
use super::source::SourcedProfile;
use crate::answer::{Outcome, put};
use crate::output::{PictureFormat, refuse_taken};
use wheelrail::case::measures_page;
use wheelrail::error::{Error, Result};
use wheelrail::export::{OverlayPicture, SEPARATOR};
use wheelrail::files::{read_text, write_file};
use wheelrail::measure::{
    GaugeFrom, Limit, Limits, MeasureOptions, MeasureRow, Measures, Overlay, PointNoise, RowColumns, csv,
    json, measure, measure_noisy, overlay, repeated, table,
};
use wheelrail::profile::Side;
use wheelrail::scene;

/// Largest file of limits \[bytes\]: many times that of all quantities.
const LARGEST_LIMITS: usize = 1 << 20;

/// The profiles to measure, and how.
#[derive(Debug, Args)]
pub(crate) struct MeasureArguments {
    /// Distance of the taping line from the flange back, mm.
    #[arg(long, value_name = "MM", default_value_t = MeasureOptions::default().tread_at, allow_negative_numbers = true)]
    tread_at: f64,
    /// Height over the tread at which flange thickness is measured, mm.
    #[arg(long, value_name = "MM", default_value_t = MeasureOptions::default().flange_level, allow_negative_numbers = true)]
    flange_level: f64,
    /// Depth below the flange's tip at which qR is measured, mm.
    #[arg(long, value_name = "MM", default_value_t = MeasureOptions::default().tip_depth, allow_negative_numbers = true)]
    tip_depth: f64,
    /// Height over the tread at which flange width is measured, mm.
    #[arg(long, value_name = "MM", default_value_t = MeasureOptions::default().width_level, allow_negative_numbers = true)]
    width_level: f64,
    /// Depth below the top of rail at which W2, groove width and keeper wear are measured, mm.
    #[arg(long, value_name = "MM", default_value_t = MeasureOptions::default().gauge_level, allow_negative_numbers = true)]
    gauge_level: f64,
    /// The rail from whose top that depth counts: measured or nominal.
    #[arg(long, value_name = "RAIL")]
    gauge_from: Option<String>,
    /// Print CSV.
    #[arg(long, conflicts_with = "json")]
    csv: bool,
    /// Print JSON.
    #[arg(long)]
    json: bool,
    /// Picture of a single profile over its nominal one, .svg or .png.
    #[arg(long, value_name = "FILE", requires = "nominal")]
    picture: Option<PathBuf>,
    /// Page for a browser, in addition: it walks through the files, each over the nominal one, with its measures and findings.
    #[arg(long, value_name = "FILE.html")]
    html: Option<PathBuf>,
    /// File of limits, TOML: `flange_height_mm = { min = 27.5, max = 36.0 }`.
    #[arg(long, value_name = "FILE")]
    limits: Option<PathBuf>,
    /// Exit code 1 if a limit is broken.
    #[arg(long, requires = "limits")]
    fail: bool,
    /// Standard deviation of the points across the profile, mm: samples of it give each quantity an interval.
    #[arg(long, value_name = "MM", allow_negative_numbers = true)]
    noise: Option<f64>,
    /// Distance of the points that are noisy, mm.
    #[arg(long, value_name = "MM", default_value_t = PointNoise::default().step, requires = "noise", allow_negative_numbers = true)]
    step: f64,
    /// Number of samples of the noise.
    #[arg(long, default_value_t = PointNoise::default().samples, requires = "noise")]
    samples: usize,
    /// Seed of the samples.
    #[arg(long, default_value_t = PointNoise::default().seed, requires = "noise")]
    seed: u64,
    /// The files are repeated measurements of one profile: a last row has the mean of each quantity, with its interval.
    #[arg(long, conflicts_with = "noise")]
    repeats: bool,
    /// File to write; stdout if not given.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    #[command(flatten)]
    several: SeveralArguments,
}

/// What is asked of every profile.
struct AskedMeasures {
    nominal: Option<SourcedProfile>,
    options: MeasureOptions,
    noise: Option<PointNoise>,
}

/// Measures profiles. A file that cannot be measured is a row that says why.
///
/// # Errors
/// Wrong options, limits or a wrong nominal; repeats of two bodies, or fewer than two; an output that is one of the files.
pub(super) fn run(arguments: &MeasureArguments) -> Result<Outcome> {
    arguments.refuse_output()?;
    let limits = arguments.limits.as_deref().map(limits).transpose()?;
    let question = arguments.question()?;
    let sources = arguments.several.sources();
    let rows = arguments.rows(&sources, &question)?;
    let spread = arguments.spread(&question);
    let columns = RowColumns { limits: limits.as_ref(), spread: spread.as_deref() };
    let write = if arguments.csv {
        csv
    } else if arguments.json {
        json
    } else {
        table
    };
    put(&write(&rows, columns), arguments.out.as_deref())?;
    if let Some(picture) = &arguments.picture {
        arguments.draw(picture, &sources, &question)?;
    }
    if let Some(html) = &arguments.html {
        let profiles = sources.iter().map(|source| source.as_ref().ok().map(SourcedProfile::profile));
        // The row of repeats is of no profile.
        let rows: Vec<_> = rows.iter().cloned().zip(profiles.chain([None])).collect();
        let nominal = question.nominal.as_ref().map(SourcedProfile::profile);
        write_file(html, &measures_page(&rows, nominal, &question.options, columns).html())?;
    }
    let broken = limits.is_some_and(|limits| rows.iter().any(|row| !row.broken(&limits).is_empty()));
    let none = rows.iter().any(|row| row.measured.is_err());
    Ok(if none || arguments.fail && broken { Outcome::No } else { Outcome::Done })
}

impl MeasureArguments {
    fn refuse_output(&self) -> Result<()> {
        let mut taken = self.several.read_from();
        taken.extend(self.limits.clone().filter(|path| path.exists()));
        if let Some(picture) = &self.picture {
            PictureFormat::of_file("--picture", picture)?;
        }
        for (option, file) in [("--out", &self.out), ("--picture", &self.picture), ("--html", &self.html)] {
            let Some(file) = file else { continue };
            refuse_taken(option, file, &taken)?;
            taken.push(file.clone());
        }
        Ok(())
    }

    fn question(&self) -> Result<AskedMeasures> {
        let (nominal, options) = (self.several.nominal()?, self.options()?);
        // Invalid options are one error, not one for each file.
        if let Some(side) = self.several.side() {
            options.validate(side, nominal.is_some())?;
        }
        let noise = self.noise.map(|sigma| {
            let (step, samples, seed) = (self.step, self.samples, self.seed);
            let noise = PointNoise { sigma, step, samples, seed, curve: self.several.curve()? };
            noise.validate().map(|()| noise)
        });
        Ok(AskedMeasures { nominal, options, noise: noise.transpose()? })
    }

    /// Returns what the spread of the values comes from, repeats or noise, in words; `None` if no spread is asked for.
    fn spread(&self, question: &AskedMeasures) -> Option<String> {
        if self.repeats {
            return Some("over the repeats; 95 % of further measurements".into());
        }
        question.noise.as_ref().map(|PointNoise { sigma, step, samples, seed, .. }| {
            format!("noise of {sigma} mm of points every {step} mm; {samples} samples of seed {seed}")
        })
    }

    /// Measures all profiles.
    fn rows(&self, sources: &[Result<SourcedProfile>], question: &AskedMeasures) -> Result<Vec<MeasureRow>> {
        let row = |(file, source): (&String, &Result<SourcedProfile>)| {
            let side = source.as_ref().ok().and_then(|read| read.side).or(self.several.side());
            let measured =
                source.as_ref().map_err(Clone::clone).and_then(|read| measured(file, read, side, question));
            MeasureRow { file: file.clone(), side, measured }
        };
        let mut rows: Vec<MeasureRow> = self.several.files.par_iter().zip(sources).map(row).collect();
        if self.repeats {
            self.several.body(sources.iter().flatten())?;
            let own: Vec<&Measures> = rows.iter().flat_map(|row| &row.measured).collect();
            let mean = repeated(&own)?;
            let file = format!("mean of {} repeats", own.len());
            rows.push(MeasureRow { file, side: Some(mean.side), measured: Ok(mean) });
        }
        Ok(rows)
    }

    /// Draws the picture of a single profile over its nominal one.
    fn draw(
        &self,
        picture: &Path,
        sources: &[Result<SourcedProfile>],
        question: &AskedMeasures,
    ) -> Result<()> {
        let [own] = sources else {
            let found = format!("{} profiles", sources.len());
            return Err(Error::new("--picture", found, "a single profile", "give one profile a picture"));
        };
        let own = own.as_ref().map_err(Clone::clone)?;
        let Some((nominal, side)) = question.nominal.as_ref().zip(own.side.or(self.several.side())) else {
            return Ok(());
        };
        let Overlay { nominal: drawn, measured, differences, alignment } =
            overlay(own.profile(), side, nominal.profile(), &question.options)?;
        let svg = OverlayPicture {
            title: own.profile().title(),
            about: &format!("nominal {}{SEPARATOR}{}", nominal.profile().title(), alignment.text),
            nominal: &drawn,
            measured: &measured,
            differences: &differences,
        }
        .svg();
        write_file(picture, &PictureFormat::of_file("--picture", picture)?.bytes(svg)?)
    }

    fn options(&self) -> Result<MeasureOptions> {
        let from = self.gauge_from.as_deref().map(|text| one_of("--gauge-from", text)).transpose()?;
        self.several.aligned(MeasureOptions {
            tread_at: self.tread_at,
            flange_level: self.flange_level,
            tip_depth: self.tip_depth,
            width_level: self.width_level,
            gauge_level: self.gauge_level,
            gauge_from: from.unwrap_or(GaugeFrom::Measured),
            ..MeasureOptions::default()
        })
    }
}

fn measured(
    file: &str,
    source: &SourcedProfile,
    side: Option<Side>,
    question: &AskedMeasures,
) -> Result<Measures> {
    let AskedMeasures { nominal, options, noise } = question;
    let nominal = nominal.as_ref();
    let Some(side) = side else {
        let expected = "the body that it is of";
        return Err(Error::new(file, "segments without a body", expected, "give --side rail or wheel"));
    };
    if let Some(other) = nominal.and_then(|nominal| nominal.side).filter(|other| *other != side) {
        let word = |side| if side == Side::Rail { "rail" } else { "wheel" };
        let found = format!("a {} beside a {} as nominal", word(side), word(other));
        return Err(Error::new(file, found, "one body", "give the nominal of this body"));
    }
    let (profile, nominal) = (source.profile(), nominal.map(SourcedProfile::profile));
    let measures = match noise {
        None => measure(profile, side, nominal, options)?,
        Some(noise) => measure_noisy(profile, side, nominal, options, noise)?,
    };
    let record = source.measured().map(|of| &of.record);
    let mut measures = measures
        .with_diameter(record.and_then(|of| of.diameter))
        .compared(record.map_or(&[], |of| of.stated.as_slice()));
    let doubts = record.map_or_else(Vec::new, |of| of.warnings.clone());
    measures.findings.extend(doubts.iter().map(|doubt| format!("{}: {}", doubt.place, doubt.found)));
    Ok(measures)
}

fn limits(path: &Path) -> Result<Limits> {
    let text = read_text(path, LARGEST_LIMITS)?;
    let limits: Result<BTreeMap<String, Limit>> = scene::parse(&text, false);
    limits.and_then(Limits::new).map_err(|error| error.within(path.display()))
}

//! `wheelrail profile measure`: flange height and thickness of wheels, wear of rails, a row a file.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use clap::Args;
use rayon::prelude::*;

use super::options::{BodyOption, MeasuredArguments, one_of};
use super::source::{Source, SourceArguments};
use crate::answer::{Outcome, put};
use crate::output::{PictureFormat, refuse_taken};
use wheelrail::case::measures_page;
use wheelrail::error::{Error, Result};
use wheelrail::export::{OverlayPicture, SEPARATOR};
use wheelrail::files::{read_text, write_file};
use wheelrail::measure::{
    GaugeFrom, Limit, Limits, MeasureOptions, Measures, Overlay, Row, csv, json, measure, overlay, table,
};
use wheelrail::measured::CurveKind;
use wheelrail::profile::{Profile, Side};
use wheelrail::scene;

/// Largest file of limits \[bytes\]: many times that of all quantities.
const LARGEST_LIMITS: usize = 1 << 20;

/// The curve through measured points, if no option names one: smoothing rounds the tip of a flange, by which qR is up to 0.07 mm off.
pub(super) const CURVE: Option<CurveKind> = Some(CurveKind::Interpolation);

/// The profiles to measure, and how.
#[derive(Debug, Args)]
pub(crate) struct MeasureArguments {
    /// Files or names of built-in profiles.
    #[arg(required = true)]
    files: Vec<String>,
    /// Body of the profiles. Built-in names tell it, and so do files such as .ban, .whl, .prr, .prw.
    #[arg(long, ignore_case = true)]
    side: Option<BodyOption>,
    /// Name or file of the nominal profile, against which wear counts.
    #[arg(long, value_name = "NAME|FILE")]
    nominal: Option<String>,
    /// Alignment: none, back, tread-point, back-and-tread, field-side, web, unworn or best-fit; best-fit with a nominal.
    #[arg(long)]
    align: Option<String>,
    /// Ranges of the nominal's x that are not worn, for --align unworn, mm.
    #[arg(long, value_name = "FROM:TO", value_delimiter = ',', allow_hyphen_values = true)]
    unworn: Vec<String>,
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
    /// File to write; stdout if not given.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    #[command(flatten)]
    measured: MeasuredArguments,
}

/// Measures profiles. A file that cannot be measured is a row that says why.
///
/// # Errors
/// Wrong options, limits or a wrong nominal; an output that is one of the files.
pub(super) fn run(arguments: &MeasureArguments) -> Result<Outcome> {
    arguments.refuse_output()?;
    let options = arguments.options()?;
    let limits = arguments.limits.as_deref().map(limits).transpose()?;
    let nominal = arguments
        .nominal
        .as_ref()
        .map(|name| source(name, arguments.side, MeasuredArguments::default()).read_as(CURVE));
    let nominal = nominal.transpose().map_err(|error| error.within("--nominal"))?;
    // Options without meaning are not the fault of each file.
    if let Some(side) = arguments.side.map(Side::from) {
        options.validate(side, nominal.is_some())?;
    }
    let row = |file: &String| arguments.row(file, nominal.as_ref(), &options);
    let rows: Vec<Row> = arguments.files.par_iter().map(row).collect();
    let write = if arguments.csv {
        csv
    } else if arguments.json {
        json
    } else {
        table
    };
    put(&write(&rows, limits.as_ref()), arguments.out.as_deref())?;
    if let Some(picture) = &arguments.picture {
        arguments.draw(picture, nominal.as_ref(), &options)?;
    }
    if let Some(html) = &arguments.html {
        arguments.write_page(html, &rows, nominal.as_ref(), &options, limits.as_ref())?;
    }
    let broken = limits.is_some_and(|limits| rows.iter().any(|row| !row.broken(&limits).is_empty()));
    let none = rows.iter().any(|row| row.measured.is_err());
    Ok(if none || arguments.fail && broken { Outcome::No } else { Outcome::Done })
}

pub(super) fn source(name: &str, side: Option<BodyOption>, measured: MeasuredArguments) -> SourceArguments {
    SourceArguments { profile: name.to_owned(), side, measured }
}

impl MeasureArguments {
    fn refuse_output(&self) -> Result<()> {
        let read = self.files.iter().chain(&self.nominal).map(PathBuf::from).chain(self.limits.clone());
        let read: Vec<PathBuf> = read.filter(|path| path.exists()).collect();
        if let Some(out) = &self.out {
            refuse_taken("--out", out, &read)?;
        }
        let mut taken: Vec<PathBuf> = read.into_iter().chain(self.out.clone()).collect();
        if let Some(picture) = &self.picture {
            PictureFormat::of_file("--picture", picture)?;
            refuse_taken("--picture", picture, &taken)?;
            taken.push(picture.clone());
        }
        self.html.as_ref().map_or(Ok(()), |html| refuse_taken("--html", html, &taken))
    }

    /// Writes the page of all rows.
    fn write_page(
        &self,
        html: &Path,
        rows: &[Row],
        nominal: Option<&Source>,
        options: &MeasureOptions,
        limits: Option<&Limits>,
    ) -> Result<()> {
        let read = |file: &String| source(file, self.side, self.measured.clone()).read_as(CURVE).ok();
        let sources: Vec<Option<Source>> = self.files.par_iter().map(read).collect();
        let rows: Vec<(Row, Option<&Profile>)> = rows
            .iter()
            .cloned()
            .zip(sources.iter().map(|source| source.as_ref().map(Source::profile)))
            .collect();
        let page = measures_page(&rows, nominal.map(Source::profile), options, limits);
        write_file(html, &page.html())
    }

    /// Draws the picture of a single profile over its nominal one.
    fn draw(&self, picture: &Path, nominal: Option<&Source>, options: &MeasureOptions) -> Result<()> {
        let [file] = self.files.as_slice() else {
            let found = format!("{} profiles", self.files.len());
            return Err(Error::new("--picture", found, "a single profile", "give one profile a picture"));
        };
        let own = source(file, self.side, self.measured.clone()).read_as(CURVE)?;
        let Some((nominal, side)) = nominal.zip(own.side.or(self.side.map(Side::from))) else {
            return Ok(());
        };
        let Overlay { nominal: drawn, measured, differences, alignment } =
            overlay(own.profile(), side, nominal.profile(), options)?;
        let svg = OverlayPicture {
            title: &own.profile().name,
            about: &format!("nominal {}{SEPARATOR}{}", nominal.profile().name, alignment.text),
            nominal: &drawn,
            measured: &measured,
            differences: &differences,
        }
        .svg();
        write_file(picture, &PictureFormat::of_file("--picture", picture)?.bytes(svg)?)
    }

    fn options(&self) -> Result<MeasureOptions> {
        let from = self.gauge_from.as_deref().map(|text| one_of("--gauge-from", text)).transpose()?;
        Ok(MeasureOptions {
            tread_at: self.tread_at,
            flange_level: self.flange_level,
            tip_depth: self.tip_depth,
            width_level: self.width_level,
            gauge_level: self.gauge_level,
            gauge_from: from.unwrap_or(GaugeFrom::Measured),
            align: self.align.as_deref().map(|text| one_of("--align", text)).transpose()?,
            unworn: self.unworn.iter().map(|text| range(text)).collect::<Result<_>>()?,
        })
    }

    fn row(&self, file: &str, nominal: Option<&Source>, options: &MeasureOptions) -> Row {
        let read = source(file, self.side, self.measured.clone()).read_as(CURVE);
        let side = read.as_ref().ok().and_then(|read| read.side).or(self.side.map(Side::from));
        let measured = read.and_then(|read| measured(file, &read, side, nominal, options));
        Row { file: file.to_owned(), side, measured }
    }
}

fn measured(
    file: &str,
    source: &Source,
    side: Option<Side>,
    nominal: Option<&Source>,
    options: &MeasureOptions,
) -> Result<Measures> {
    let Some(side) = side else {
        let expected = "the body that it is of";
        return Err(Error::new(file, "segments without a body", expected, "give --side rail or wheel"));
    };
    if let Some(other) = nominal.and_then(|nominal| nominal.side).filter(|other| *other != side) {
        let word = |side| if side == Side::Rail { "rail" } else { "wheel" };
        let found = format!("a {} beside a {} as nominal", word(side), word(other));
        return Err(Error::new(file, found, "one body", "give the nominal of this body"));
    }
    let measures = measure(source.profile(), side, nominal.map(Source::profile), options)?;
    let mut measures = measures.with_diameter(source.measured().and_then(|of| of.record.diameter));
    let doubts = source.measured().map_or_else(Vec::new, |of| of.record.warnings.clone());
    measures.findings.extend(doubts.iter().map(|doubt| format!("{}: {}", doubt.place, doubt.found)));
    Ok(measures)
}

/// Reads a range "from:to".
pub(super) fn range(text: &str) -> Result<[f64; 2]> {
    let numbers: Option<Vec<f64>> = text.split(':').map(|part| part.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some([from, to]) => Ok([*from, *to]),
        _ => Err(Error::new("--unworn", format!("\"{text}\""), "a range FROM:TO in mm", "give -36:-30")),
    }
}

fn limits(path: &Path) -> Result<Limits> {
    let text = read_text(path, LARGEST_LIMITS)?;
    let limits: Result<BTreeMap<String, Limit>> = scene::parse(&text, false);
    limits.and_then(Limits::new).map_err(|error| error.within(path.display()))
}

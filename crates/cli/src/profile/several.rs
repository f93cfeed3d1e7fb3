//! Several profiles of a command, with the nominal on which they are aligned: for `measure` and `average`.

use std::path::{Path, PathBuf};

use clap::Args;
use rayon::prelude::*;

use super::options::{BodyOption, MeasuredArguments, one_of};
use super::source::{SourceArguments, SourcedProfile};
use crate::range::interval;
use wheelrail::error::{Error, Result};
use wheelrail::measure::MeasureOptions;
use wheelrail::measured::{CurveKind, Options};
use wheelrail::profile::Side;

/// The curve through measured points, if no option names one: smoothing rounds the tip of a flange and changes qR by up to 0.09 mm.
const CURVE: Option<CurveKind> = Some(CurveKind::Interpolation);

/// The profiles, their nominal, and how they are aligned.
#[derive(Debug, Args)]
pub(super) struct SeveralArguments {
    /// Files or names of built-in profiles.
    #[arg(required = true)]
    pub(super) files: Vec<String>,
    /// Body of the profiles. Built-in names tell it, and so do files such as .ban, .whl, .prr, .prw.
    #[arg(long, ignore_case = true)]
    side: Option<BodyOption>,
    /// Name or file of the nominal profile, on which each of them is aligned and against which wear counts.
    #[arg(long, value_name = "NAME|FILE")]
    nominal: Option<String>,
    /// Alignment: none, back, tread-point, back-and-tread, field-side, web, unworn or best-fit; best-fit with a nominal.
    #[arg(long)]
    align: Option<String>,
    /// Ranges of the nominal's x that are not worn, for --align unworn, mm.
    #[arg(long, value_name = "FROM:TO", value_delimiter = ',', allow_hyphen_values = true)]
    unworn: Vec<String>,
    #[command(flatten)]
    measured: MeasuredArguments,
}

impl SeveralArguments {
    /// Lists the files that are read.
    pub(super) fn read_from(&self) -> Vec<PathBuf> {
        self.files.iter().chain(&self.nominal).map(PathBuf::from).filter(|path| path.exists()).collect()
    }

    /// Returns the body that is given.
    pub(super) fn side(&self) -> Option<Side> {
        self.side.map(Side::from)
    }

    /// Reads all profiles, each with its error.
    pub(super) fn sources(&self) -> Vec<Result<SourcedProfile>> {
        self.files.par_iter().map(|file| self.source(file, self.measured.clone())).collect()
    }

    /// Reads the nominal. The options of measured files answer what its own file leaves open.
    ///
    /// # Errors
    /// A name or file that is no profile.
    pub(super) fn nominal(&self) -> Result<Option<SourcedProfile>> {
        let Some(name) = &self.nominal else { return Ok(None) };
        let alone = self.source(name, MeasuredArguments::default());
        let read = match alone {
            Err(_) if Path::new(name).exists() => self.source(name, self.measured.clone()),
            other => other,
        };
        read.map(Some).map_err(|error| error.within("--nominal"))
    }

    fn source(&self, name: &str, measured: MeasuredArguments) -> Result<SourcedProfile> {
        SourceArguments { profile: name.to_owned(), side: self.side, measured }.read_as(CURVE)
    }

    /// Returns how curves are drawn through measured points.
    ///
    /// # Errors
    /// An unknown word of an option.
    pub(super) fn curve(&self) -> Result<Options> {
        let options = self.measured.options()?;
        Ok(Options { curve: options.curve.or(CURVE), ..options })
    }

    /// Takes the alignment into the options.
    ///
    /// # Errors
    /// An unknown alignment; text that is no range.
    pub(super) fn aligned(&self, options: MeasureOptions) -> Result<MeasureOptions> {
        Ok(MeasureOptions {
            align: self.align.as_deref().map(|text| one_of("--align", text)).transpose()?,
            unworn: self
                .unworn
                .iter()
                .map(|text| interval(("mm", "-36:-30"), "--unworn", text))
                .collect::<Result<_>>()?,
            ..options
        })
    }

    /// Returns the one body of profiles, if it is known.
    ///
    /// # Errors
    /// Both wheels and rails.
    pub(super) fn body<'a>(
        &self,
        sources: impl IntoIterator<Item = &'a SourcedProfile>,
    ) -> Result<Option<Side>> {
        let mut side = self.side();
        for source in sources {
            match (side, source.side) {
                (Some(known), Some(own)) if known != own => {
                    let advice = "give wheels or rails, and a nominal of theirs";
                    return Err(Error::new(&source.profile().name, "the other body", "one body", advice));
                }
                (None, own) => side = own,
                _ => {}
            }
        }
        Ok(side)
    }
}

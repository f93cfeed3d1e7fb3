//! The profile that a command is about: a built-in one, a chain file or a measured file.

use std::path::{Path, PathBuf};

use clap::Args;

use super::options::{BodyOption, MeasuredArguments};
use crate::output::refuse_taken;
use wheelrail::error::{Error, Result};
use wheelrail::measured::{CurveKind, Format, Measured, Options, Wording, spoken_error};
use wheelrail::profile::{Profile, Side, standards};
use wheelrail::scene::{self, ProfileSource};

/// The arguments that choose a profile.
#[derive(Debug, Args)]
pub(crate) struct SourceArguments {
    /// Name of a built-in profile, or a file: segments in TOML or JSON, or measured points.
    pub(super) profile: String,
    /// Body of the profile. Built-in names tell it, and so do files such as .ban, .whl, .prr, .prw.
    #[arg(long, ignore_case = true)]
    pub(super) side: Option<BodyOption>,
    #[command(flatten)]
    pub(super) measured: MeasuredArguments,
}

/// A profile, with what is known about it.
#[derive(Debug)]
pub(super) struct SourcedProfile {
    /// Body of the profile, if it is known.
    pub side: Option<Side>,
    pub content: ProfileSource,
}

impl SourcedProfile {
    pub(super) fn profile(&self) -> &Profile {
        self.content.profile()
    }

    pub(super) fn measured(&self) -> Option<&Measured> {
        match &self.content {
            ProfileSource::Drawn(_) => None,
            ProfileSource::Measured(measured) => Some(measured),
        }
    }
}

impl SourceArguments {
    /// Rejects an output file that is the profile's own file.
    ///
    /// # Errors
    /// `out` is that file.
    pub(super) fn refuse_output(&self, out: Option<&Path>) -> Result<()> {
        let own = PathBuf::from(&self.profile);
        match out {
            Some(out) if own.exists() => refuse_taken("--out", out, &[own]),
            _ => Ok(()),
        }
    }

    /// Reads the profile.
    ///
    /// # Errors
    /// An unknown name; anything that is wrong with a file or its options.
    pub(super) fn read(&self) -> Result<SourcedProfile> {
        self.read_as(None)
    }

    /// Reads the profile. If no option names a curve, a measured file gets this kind of curve.
    ///
    /// # Errors
    /// The errors of [`SourceArguments::read`].
    pub(super) fn read_as(&self, curve: Option<CurveKind>) -> Result<SourcedProfile> {
        let path = Path::new(&self.profile);
        if !path.exists() {
            return self.built_in();
        }
        let options = self.measured.options()?;
        let side = self.side.map(Side::from);
        let drawn = options.format.is_none() && scene::is_chain_file(path);
        if drawn {
            self.measured.reject(&self.profile)?;
        }
        let options = Options { curve: options.curve.or(curve.filter(|_| !drawn)), ..options };
        let content = scene::read_profile(path, side, &options)
            .map_err(|error| spoken_error(error, Wording::CommandLine))?;
        Ok(SourcedProfile { side: side.or_else(|| Format::body_of_file(&self.profile)), content })
    }

    fn built_in(&self) -> Result<SourcedProfile> {
        let rail = standards::rail(&self.profile).is_ok();
        let named = standards::wheel(&self.profile);
        if !rail && named.is_err() && !self.profile.starts_with("EN13715-") {
            let expected = "a file, or a name of `wheelrail profile list`";
            let names: Vec<&str> = standards::rail_names().chain(standards::wheel_names()).collect();
            let advice = scene::perhaps(&self.profile, &names);
            return Err(Error::new(&self.profile, "no file and no built-in profile", expected, advice));
        }
        self.measured.reject(&self.profile)?;
        let (side, body) =
            if rail { (Side::Rail, BodyOption::Rail) } else { (Side::Wheel, BodyOption::Wheel) };
        if self.side.is_some_and(|given| given != body) {
            let found = if rail { "the name of a rail" } else { "the name of a wheel" };
            return Err(Error::new(
                &self.profile,
                found,
                "one of the --side given",
                "correct one of the two",
            ));
        }
        let profile = if rail { standards::rail(&self.profile)? } else { named? };
        Ok(SourcedProfile { side: Some(side), content: ProfileSource::Drawn(profile) })
    }
}

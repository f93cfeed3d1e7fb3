//! `wheelrail profile`: lists, shows, plots, converts, measures and averages profiles.

mod average;
mod convert;
mod measure;
mod options;
mod plot;
mod several;
mod show;
mod source;

use std::fmt::Write;
use std::path::PathBuf;

use clap::Subcommand;

use super::progress::Progress;
use crate::answer::{Outcome, print};
use source::SourceArguments;
use wheelrail::error::Result;
use wheelrail::profile::standards;

/// The work to do with profiles.
#[derive(Debug, Subcommand)]
pub(super) enum ProfileCommand {
    /// List the names and sources of the built-in profiles.
    List,
    /// Show the segments and joints of a profile; for a measured file also how it was read and fitted. The spans of a
    /// spline are left out.
    Show {
        #[command(flatten)]
        source: SourceArguments,
    },
    /// Draw points, curve, residual and curvature against arc length, as SVG or PNG.
    Plot {
        #[command(flatten)]
        source: SourceArguments,
        /// File to write, .svg or .png; SVG to stdout if not given.
        #[arg(long, value_name = "FILE")]
        out: Option<PathBuf>,
    },
    /// Write a profile in another format.
    Convert(convert::ConvertArguments),
    /// Measure wheels and rails: flange height and thickness, wear, groove; a row a file.
    // Boxed, because it has many options.
    Measure(Box<measure::MeasureArguments>),
    /// Average profiles into a representative one, with their spread.
    Average(Box<average::AverageArguments>),
}

/// Runs `wheelrail profile …`.
pub(super) fn profile(command: &ProfileCommand) -> Result<Outcome> {
    let _progress = Progress::of("profile", "points and curve");
    match command {
        ProfileCommand::List => print(&list()?),
        ProfileCommand::Show { source } => print(&show::show(&source.read()?)),
        ProfileCommand::Plot { source, out } => plot::plot(source, out.as_deref()),
        ProfileCommand::Convert(arguments) => convert::convert(arguments),
        ProfileCommand::Measure(arguments) => measure::run(arguments),
        ProfileCommand::Average(arguments) => average::run(arguments),
    }
}

fn list() -> Result<String> {
    let mut out = String::new();
    for name in standards::rail_names() {
        let _ = writeln!(out, "rail   {name:<24} {}", standards::rail(name)?.source);
    }
    for (former, _) in standards::former_rail_names() {
        let _ = writeln!(out, "rail   {former:<24} {}", standards::rail(former)?.source);
    }
    for name in standards::wheel_names() {
        let _ = writeln!(out, "wheel  {name:<24} {}", standards::wheel(name)?.source);
    }
    let _ = writeln!(out, "wheel  {}\n{:31} {}", standards::EN_13715_NAMES, "", standards::EN_13715_SOURCE);
    Ok(out)
}

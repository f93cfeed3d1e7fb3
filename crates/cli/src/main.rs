//! The command line, with one file for each command.
//!
//! Exit codes: 0 done, 1 a geometric "no" (infeasible contact, empty patch, failed check), 2 bad input. Data go to stdout,
//! progress and messages to stderr.

#![cfg_attr(not(test), warn(unused_crate_dependencies))]

mod answer;
mod check;
mod midsep;
mod output;
mod png;
mod profile;
mod progress;
mod report;
mod run;
mod sweep;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Parser, Subcommand};

use answer::{Outcome, complain, print};
use wheelrail::{Error, Result};

/// Wheel/rail contact-patch preprocessor.
#[derive(Debug, Parser)]
#[command(version, about)]
struct Arguments {
    /// Number of threads; 0 takes all cores.
    #[arg(long, global = true, default_value_t = 0, allow_negative_numbers = true)]
    threads: usize,
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Run the whole pipeline and write a folder of files.
    Run {
        /// Scene file, TOML or JSON.
        scene: PathBuf,
        /// Folder to write; by default output/<scene name>.
        #[arg(long)]
        out: Option<PathBuf>,
    },
    /// Print the midplane table and the transformed parameters.
    Midsep {
        /// Scene file, TOML or JSON.
        scene: PathBuf,
    },
    /// Check every contact of a scene against triangle meshes measured by parry3d; exit code 1 if they disagree.
    Check {
        /// Scene file, TOML or JSON.
        scene: PathBuf,
    },
    /// Sweep a wheelset over its track and print a row for each position, side and contact.
    Sweep(sweep::SweepArguments),
    /// Measure speed against error and run the hard cases; takes about two minutes.
    Report {
        /// Folder to write; by default output/report.
        #[arg(long)]
        out: Option<PathBuf>,
        /// Markdown file whose text between `<!-- report:begin -->` and `<!-- report:end -->` becomes the table.
        #[arg(long)]
        splice: Option<PathBuf>,
    },
    /// List, show, plot and convert profiles.
    #[command(subcommand)]
    Profile(Box<profile::ProfileCommand>),
    /// Print the JSON Schema of a scene.
    Schema,
}

/// Runs the command and returns its exit code.
fn main() -> ExitCode {
    let outcome = match Arguments::try_parse() {
        Ok(arguments) => on_threads(arguments),
        Err(message) if message.use_stderr() => message.exit(),
        // The text is the help or the version.
        Err(message) => print(&message.render().to_string()),
    };
    match outcome {
        Ok(Outcome::Done) => ExitCode::SUCCESS,
        Ok(Outcome::No) => ExitCode::from(1),
        Err(error) => {
            complain(&format!("error: {error}"));
            ExitCode::from(2)
        }
    }
}

/// Most threads. Starting more takes longer than any work for them.
const MOST_THREADS: usize = 4096;

fn on_threads(arguments: Arguments) -> Result<Outcome> {
    if arguments.threads > MOST_THREADS {
        let expected = format!("at most {MOST_THREADS}");
        return Err(Error::new("--threads", arguments.threads.to_string(), expected, "take fewer"));
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(arguments.threads).build().map_err(|error| {
        Error::new("--threads", error.to_string(), "a number of threads the system grants", "take fewer")
    })?;
    pool.install(|| match arguments.command {
        Command::Run { scene, out } => run::run(&scene, out.as_deref()),
        Command::Midsep { scene } => midsep::midsep(&scene),
        Command::Check { scene } => check::check(&scene),
        Command::Sweep(arguments) => sweep::sweep(&arguments),
        Command::Report { out, splice } => report::report(out.as_deref(), splice.as_deref()),
        Command::Profile(command) => profile::profile(&command),
        Command::Schema => schema(),
    })
}

fn schema() -> Result<Outcome> {
    let text = serde_json::to_string_pretty(&wheelrail::scene::schema()).unwrap_or_default();
    print(&format!("{text}\n"))
}

//! The command line: one file per command.
//!
//! Exit codes: 0 done, 1 a geometric "no" (infeasible contact, empty patch, failed check), 2 bad input. Data goes
//! to stdout, progress and complaints to stderr.

#![cfg_attr(not(test), warn(unused_crate_dependencies))]

mod check;
mod midsep;
mod output;
mod png;
mod profile;
mod progress;
mod report;
mod run;
mod sweep;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Parser, Subcommand};

use wheelrail::{Error, Result};

/// Wheel/rail contact-patch preprocessor.
#[derive(Debug, Parser)]
#[command(version, about)]
struct Arguments {
    /// Threads to compute on; 0 takes all cores.
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
    /// Sweep a wheelset over its track and print a row per position, side and contact.
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
    /// Look at profiles.
    #[command(subcommand)]
    Profile(Box<profile::ProfileCommand>),
    /// Print the JSON Schema of a scene.
    Schema,
}

/// The answer of a command that ran to its end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Outcome {
    /// The command did what was asked for.
    Done,
    /// A geometric "no".
    No,
}

fn main() -> ExitCode {
    let outcome = match Arguments::try_parse() {
        Ok(arguments) => on_threads(arguments),
        Err(message) if message.use_stderr() => message.exit(),
        // Help or the version.
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

/// Threads beyond which starting them takes longer than any work for them.
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

/// Writes data to stdout; a reader that went away early (`| head`) is not an error.
fn print(text: &str) -> Result<Outcome> {
    print_to_reader(text).map(|_| Outcome::Done)
}

/// Writes data to stdout and tells whether the reader is still there.
fn print_to_reader(text: &str) -> Result<bool> {
    use std::io::Write;
    match std::io::stdout().lock().write_all(text.as_bytes()) {
        Ok(()) => Ok(true),
        Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => Ok(false),
        Err(error) => {
            Err(Error::new("stdout", error.to_string(), "a stream that takes the data", "check the disk"))
        }
    }
}

/// Says every geometric "no" on stderr; the outcome is [`Outcome::No`] where there is one.
fn outcome(noes: impl IntoIterator<Item = String>) -> Outcome {
    let said = noes.into_iter().map(|no| complain(&format!("no: {no}"))).count();
    if said == 0 { Outcome::Done } else { Outcome::No }
}

/// A number of things in words: "1 point", "2 points".
fn counted(n: usize, thing: &str) -> String {
    format!("{n} {thing}{}", if n == 1 { "" } else { "s" })
}

/// A line to stderr; there is nobody to tell when that fails.
fn complain(text: &str) {
    use std::io::Write;
    let _ = writeln!(std::io::stderr().lock(), "{text}");
}

/// The folder that a scene's own files are relative to.
fn folder_of(scene: &Path) -> &Path {
    scene.parent().unwrap_or(Path::new("."))
}

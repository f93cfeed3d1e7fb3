//! The command line, with one file for each command.
//!
//! Exit codes: 0 done, 1 a geometric "no" (infeasible contact, empty patch, failed check), 2 bad input. Data go to stdout,
//! progress and messages to stderr. Ctrl-C, SIGTERM and SIGHUP give 130, 143 and 129.

#![cfg_attr(not(test), warn(unused_crate_dependencies))]

mod answer;
mod check;
mod conicity;
mod fleet;
mod init;
mod man;
mod march;
mod midsep;
mod output;
mod png;
mod profile;
mod progress;
mod range;
mod report;
mod run;
mod signals;
mod sweep;
mod table;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{CommandFactory, Parser, Subcommand};

use answer::{Outcome, complain, print};
use wheelrail::{Error, Result};

/// Finds where a railway wheel touches its rail, and how far apart the two are around that point.
///
/// From two profiles, drawn or measured, it gives contact points, the contact patch, conicity, wear measures, tables for
/// vehicle dynamics, and the input files of contact solvers. Begin with `wheelrail init scene.toml` and `wheelrail run
/// scene.toml`. Exit codes: 0 done, 1 a geometric "no" (infeasible contact, empty patch, failed check), 2 bad input.
#[derive(Debug, Parser)]
#[command(name = "wheelrail", version)]
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
    Run(run::RunArguments),
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
    /// Compute the contact geometry of a wheelset on its track by EN 15302: equivalent conicity, nonlinearity, contact bands.
    Conicity(Box<conicity::ConicityArguments>),
    /// March a wheelset along rails that vary and print a row for each place, side and contact.
    March(march::MarchArguments),
    /// Tabulate contact over the lateral displacement for vehicle dynamics, as polynomials with a stated error.
    Table(table::TableArguments),
    /// Compute every wheelset of a fleet on every rail section: conicity, measures, contact bands; a table and pages.
    Fleet(fleet::FleetArguments),
    /// Measure speed against error and run the hard cases; takes about three minutes.
    Report {
        /// Folder to write; by default output/report.
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
        /// Markdown file whose text between `<!-- report:begin -->` and `<!-- report:end -->` becomes the table.
        #[arg(long, value_name = "FILE.md")]
        splice: Option<PathBuf>,
    },
    /// List, show, plot, convert, measure and average profiles.
    #[command(subcommand)]
    Profile(Box<profile::ProfileCommand>),
    /// Write a commented scene to begin with.
    Init {
        /// File to write; an existing one is never replaced.
        #[arg(default_value = "scene.toml")]
        file: PathBuf,
    },
    /// Print the JSON Schema of a scene.
    Schema,
    /// Print completions for a shell, e.g. `wheelrail completions bash > /etc/bash_completion.d/wheelrail`.
    Completions {
        /// The shell.
        shell: clap_complete::Shell,
    },
    /// Print the manual pages, e.g. `wheelrail man | man -l -`, or write one file for each command.
    Man {
        /// Folder for the files wheelrail.1, wheelrail-run.1, …; made if it is not there.
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
    },
}

/// Runs the command and returns its exit code.
fn main() -> ExitCode {
    let outcome = match Arguments::try_parse() {
        Ok(arguments) => {
            signals::watch();
            on_threads(arguments)
        }
        Err(message) if message.use_stderr() => message.exit(),
        // The text is the help or the version.
        Err(message) => print(&message.render().to_string()),
    };
    signals::stay_if_ending();
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
        Command::Run(arguments) => run::run(&arguments),
        Command::Midsep { scene } => midsep::midsep(&scene),
        Command::Check { scene } => check::check(&scene),
        Command::Sweep(arguments) => sweep::sweep(&arguments),
        Command::Conicity(arguments) => conicity::run(&arguments),
        Command::March(arguments) => march::march(&arguments),
        Command::Table(arguments) => table::table(&arguments),
        Command::Fleet(arguments) => fleet::fleet(&arguments),
        Command::Report { out, splice } => report::report(out.as_deref(), splice.as_deref()),
        Command::Profile(command) => profile::profile(&command),
        Command::Init { file } => init::init(&file),
        Command::Schema => schema(),
        Command::Completions { shell } => completions(shell),
        Command::Man { out } => man::man(Arguments::command(), out.as_deref()),
    })
}

fn completions(shell: clap_complete::Shell) -> Result<Outcome> {
    let mut text = Vec::new();
    clap_complete::generate(shell, &mut Arguments::command(), "wheelrail", &mut text);
    print(&String::from_utf8_lossy(&text))
}

fn schema() -> Result<Outcome> {
    let text = serde_json::to_string_pretty(&wheelrail::scene::schema()).unwrap_or_default();
    print(&format!("{text}\n"))
}

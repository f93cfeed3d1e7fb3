//! `wheelrail run`: computes the whole pipeline and writes its folder.

mod answer;

use std::path::PathBuf;

use super::output::refuse_results_of_another;
use super::png::png;
use super::progress::Progress;
use crate::answer::{Outcome, complain, folder_of, outcome, print};
use wheelrail::case::{RUN_FOLDER, Run, write};
use wheelrail::error::Result;
use wheelrail::files::Folder;
use wheelrail::scene;

/// Files above this size \[bytes\] are announced before they are written.
const LARGE: f64 = 1e9;

/// The scene, the folder, and how much is said.
#[derive(Debug, clap::Args)]
pub(super) struct RunArguments {
    /// Scene file, TOML or JSON.
    scene: PathBuf,
    /// Folder to write; by default output/<scene name>.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print nothing on stdout, and no progress; warnings and errors stay.
    #[arg(long, short)]
    quiet: bool,
    /// Print the summaries of all contacts as JSON instead of the table.
    #[arg(long, conflicts_with = "quiet")]
    json: bool,
}

/// Runs a scene. The exit code is 1 for an infeasible contact or an empty patch; their files are written all the same.
pub(super) fn run(arguments: &RunArguments) -> Result<Outcome> {
    let path = arguments.scene.as_path();
    let progress = if arguments.quiet { Progress::silent() } else { Progress::of("run", "scene") };
    let tell = |step, share| progress.share(step, share);
    let scene = scene::load(path)?;
    let name = path.file_stem().unwrap_or(path.as_os_str()).to_string_lossy();
    let target = match &arguments.out {
        Some(out) => out.clone(),
        None => {
            let target = PathBuf::from("output").join(&*name);
            refuse_results_of_another(&target, path)?;
            target
        }
    };
    progress.at("profiles");
    let case = scene::resolve(&scene, folder_of(path), &name);
    let run = case
        .and_then(|case| Run::new(case.read_from(path), &tell))
        .map_err(|error| error.within(path.display()))?;
    let folder = Folder::create(&target, RUN_FOLDER)?;
    let bytes = run.expected_bytes();
    if bytes > LARGE && !arguments.quiet {
        complain(&format!("run: about {} of files will be written", answer::size(bytes)));
    }
    let written = write(&run, &folder, Some(png), &tell)?;
    folder.commit()?;
    drop(progress);
    for warning in run.warnings() {
        complain(&format!("warning: {warning}"));
    }
    let outcome = outcome(run.refusals());
    if arguments.json {
        print(&answer::json(&target, &written, outcome))?;
    } else if !arguments.quiet {
        print(&format!("{}{}\n", answer::table(&run, &written), target.display()))?;
    }
    Ok(outcome)
}

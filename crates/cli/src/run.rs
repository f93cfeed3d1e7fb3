//! `wheelrail run`: computes the whole pipeline and writes its folder.

use std::path::{Path, PathBuf};

use super::output::refuse_results_of_another;
use super::png::png;
use super::progress::Progress;
use crate::answer::{Outcome, complain, folder_of, outcome, print};
use wheelrail::case::{Run, write};
use wheelrail::error::Result;
use wheelrail::files::{Folder, RUN_FOLDER};
use wheelrail::scene;

/// Runs a scene. The exit code is 1 for an infeasible contact or an empty patch; their files are written all the same.
pub(super) fn run(path: &Path, out: Option<&Path>) -> Result<Outcome> {
    let progress = Progress::of("run", "scene");
    let tell = |step| progress.at(step);
    let scene = scene::load(path)?;
    let name = path.file_stem().unwrap_or(path.as_os_str()).to_string_lossy();
    let target = match out {
        Some(out) => out.to_path_buf(),
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
    write(&run, &folder, Some(png), &tell)?;
    folder.commit()?;
    for warning in run.warnings() {
        complain(&format!("warning: {warning}"));
    }
    let outcome = outcome(run.refusals());
    print(&format!("{}\n", target.display()))?;
    Ok(outcome)
}

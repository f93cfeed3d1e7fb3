//! `wheelrail run`: the whole pipeline, and the folder it writes.

mod files;
mod summary;

use std::path::{Path, PathBuf};

use super::{Outcome, complain, folder_of, print};
use crate::analysis::{Analysis, ApproachBy, Contact, Question};
use crate::error::{Error, Result};
use crate::export::{Folder, RUN_FOLDER};
use crate::scene::{self, Scene, check_points};

/// Runs a scene; exit code 1 for an infeasible contact or an empty patch, whose files are written all the same.
pub(super) fn run(path: &Path, out: Option<&Path>) -> Result<Outcome> {
    let scene = scene::load(path)?;
    let run = analyse(&scene, path).map_err(|error| error.within(path.display()))?;
    let target = out.map_or_else(|| default_folder(path), Path::to_path_buf);
    let folder = Folder::create(&target, RUN_FOLDER)?;
    files::write(&folder, &run)?;
    folder.commit()?;
    print(&format!("{}\n", target.display()))?;
    let refusals = run.refusals();
    for refusal in &refusals {
        complain(&format!("no: {refusal}"));
    }
    for warning in run.warnings() {
        complain(&format!("warning: {warning}"));
    }
    Ok(if refusals.is_empty() { Outcome::Done } else { Outcome::No })
}

/// A scene and everything computed from it.
struct Run {
    scene: Scene,
    hash: String,
    title: String,
    question: Question,
    contact: Contact,
    analysis: Analysis,
}

fn analyse(scene: &Scene, path: &Path) -> Result<Run> {
    let question = question(scene)?;
    let pair = scene.pair(folder_of(path))?;
    let [rail_x, wheel_x] = scene.contact_points()?;
    let contact = Contact::new(pair.placed(rail_x, wheel_x, 0.0)?, &question)?;
    let (xi, eta) = (axis(scene, "xi")?, axis(scene, "eta")?);
    check_points("grid", xi.len() as f64 * eta.len() as f64)?;
    let analysis = Analysis::new(&contact, xi, eta, &question);
    let name = scene_name(path);
    let title = scene.title.clone().unwrap_or(name);
    Ok(Run { scene: scene.clone(), hash: scene::hash(scene), title, question, contact, analysis })
}

fn axis(scene: &Scene, name: &str) -> Result<Vec<f64>> {
    scene
        .axis(name)?
        .ok_or_else(|| Error::new(format!("grid: {name}"), "auto", "values", "give from, to and n"))
}

/// The numerical question that a scene asks.
fn question(scene: &Scene) -> Result<Question> {
    scene.check_patch()?;
    let patch = scene.patch.as_ref();
    let approach = patch
        .and_then(|patch| patch.approach.map(ApproachBy::Given).or_else(|| patch.load.map(ApproachBy::Load)));
    Ok(Question {
        approach,
        material: scene.elastic()?,
        tolerance: scene.tolerance()?,
        method: scene.grid.method.forced(),
    })
}

impl Run {
    /// Geometric "no"s.
    fn refusals(&self) -> Vec<String> {
        let mut out = Vec::new();
        let feasibility = &self.contact.feasibility;
        if !feasibility.feasible {
            out.push(format!(
                "infeasible contact: the bodies overlap by {:.6e} mm at xi = {:.6} mm; expected s >= 0 everywhere \
                 (4.1); choose another pair of points",
                -feasibility.least_separation_mm, feasibility.at_xi_mm
            ));
        }
        if self.analysis.patch.as_ref().is_some_and(|patch| patch.components.is_empty()) {
            out.push("empty patch: s is nowhere below the approach in the window of the grid".into());
        }
        out
    }

    /// What a user should know before using the files.
    fn warnings(&self) -> Vec<String> {
        let mut out = Vec::new();
        if self.analysis.patch.as_ref().is_some_and(crate::interpenetration::Patch::cut_by_window) {
            out.push("the window of the grid cuts the patch: solvers would overestimate the pressure".into());
        }
        out
    }
}

fn scene_name(path: &Path) -> String {
    path.file_stem().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

fn default_folder(path: &Path) -> PathBuf {
    Path::new("output").join(scene_name(path))
}

//! The whole pipeline: scene → profiles → placement → separation → patch → files.

mod analysis;
mod files;
mod summary;

use std::path::Path;

pub use analysis::{Analysis, ApproachBy, Contact, Question, Timings};

use crate::error::{Error, Result};
use crate::export::Folder;
use crate::interpenetration::Patch;
use crate::scene::{self, Scene, check_points};

/// A scene and everything computed from it.
#[derive(Debug, Clone)]
pub struct Run {
    /// The scene as read.
    pub scene: Scene,
    /// SHA-256 of it.
    pub hash: String,
    /// Its title, or its name.
    pub title: String,
    /// What it asks of every contact.
    pub question: Question,
    /// One part for every grid; the first contact's first.
    pub parts: Vec<Part>,
}

/// One contact with one grid, and the folder of its files.
#[derive(Debug, Clone)]
pub struct Part {
    /// Folder below the run's own, or empty for that itself.
    pub folder: String,
    /// The placed pair.
    pub contact: Contact,
    /// Its grid and patch.
    pub analysis: Analysis,
}

impl Run {
    /// Computes a scene; its own files are relative to `folder`, `name` is the title of a scene without one.
    ///
    /// # Errors
    /// Bad input, by key. An infeasible contact or an empty patch is a result: [`Run::refusals`].
    pub fn new(scene: Scene, folder: &Path, name: &str) -> Result<Self> {
        let question = question(&scene)?;
        let pair = scene.pair(folder)?;
        let [rail_x, wheel_x] = scene.contact_points()?;
        let contact = Contact::new(pair.placed(rail_x, wheel_x, 0.0)?, &question)?;
        let (xi, eta) = (axis(&scene, "xi")?, axis(&scene, "eta")?);
        check_points("grid", xi.len() as f64 * eta.len() as f64)?;
        let analysis = Analysis::new(&contact, xi, eta, &question);
        let parts = vec![Part { folder: String::new(), contact, analysis }];
        let title = scene.title.clone().unwrap_or_else(|| name.to_string());
        Ok(Self { hash: scene::hash(&scene), scene, title, question, parts })
    }

    /// Writes all files that the scene asks for.
    ///
    /// # Errors
    /// The disk's; a format that cannot hold the grid.
    pub fn write(&self, folder: &Folder) -> Result<()> {
        self.parts.iter().try_for_each(|part| files::write(folder, self, part))
    }

    /// Geometric "no"s.
    pub fn refusals(&self) -> Vec<String> {
        self.parts.iter().flat_map(Part::refusals).collect()
    }

    /// What a user should know before using the files.
    pub fn warnings(&self) -> Vec<String> {
        self.parts.iter().flat_map(Part::warnings).collect()
    }
}

impl Part {
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

    fn warnings(&self) -> Vec<String> {
        let mut out = Vec::new();
        if self.analysis.patch.as_ref().is_some_and(Patch::cut_by_window) {
            out.push("the window of the grid cuts the patch: solvers would overestimate the pressure".into());
        }
        out
    }
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

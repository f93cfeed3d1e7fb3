//! The whole pipeline: scene → profiles → placement → separation → patch → files.

mod analysis;
mod files;
mod grids;
mod places;
mod summary;

use std::path::{Path, PathBuf};

pub use analysis::{Analysis, ApproachBy, Contact, EllipseUnder, Question, Timings};
pub use places::Found;

use crate::error::Result;
use crate::files::Folder;
use crate::measured::Record;
use crate::patch::Patch;
use crate::placement::{Pair, Placement};
use crate::scene::{self, Place, Scene};
use crate::separation::plan::Plan;
use grids::Grid;

/// Both profiles of a scene, and what was done to measured ones of rail and wheel.
pub type Profiles = (Pair, [Option<Record>; 2]);

/// Is told what a run is at, from several threads.
pub type Tell<'a> = &'a (dyn Fn(String) + Sync);

/// Turns a picture's SVG into PNG. The library draws no pixels; who wants them brings this.
pub type Rasterise = fn(&str) -> Result<Vec<u8>>;

/// A scene and everything computed from it.
#[derive(Debug, Clone)]
pub struct Run {
    /// The scene as read.
    pub scene: Scene,
    /// SHA-256 of it.
    pub hash: String,
    /// The file that it was read from, absolute and without links, for the summary.
    pub file: Option<PathBuf>,
    /// Its title, or its name.
    pub title: String,
    /// What it asks of every contact.
    pub question: Question,
    /// What was done to measured profiles of rail and wheel.
    pub measured: [Option<Record>; 2],
    /// One part for every grid; the first contact's first.
    pub parts: Vec<Part>,
}

/// One contact with one grid, and the folder of its files.
#[derive(Debug, Clone)]
pub struct Part {
    /// Folder below the run's own, or empty for that itself.
    pub folder: String,
    /// How the contact was found, unless it was chosen.
    pub found: Option<Found>,
    /// The placed pair.
    pub contact: Contact,
    /// Its grid and patch.
    pub analysis: Analysis,
    /// What the user should know of automatic axes.
    pub grid_warning: Option<String>,
}

impl Run {
    /// Computes a scene; its own files are relative to `folder`, `name` is the title of a scene without one.
    ///
    /// # Errors
    /// Bad input, by key. An infeasible contact or an empty patch is a result: [`Run::refusals`].
    pub fn new(scene: Scene, folder: &Path, name: &str) -> Result<Self> {
        Self::told(scene, folder, name, &|_| {})
    }

    /// The same, telling what it is at.
    ///
    /// # Errors
    /// Those of [`Run::new`].
    pub fn told(scene: Scene, folder: &Path, name: &str, tell: Tell<'_>) -> Result<Self> {
        let question = question(&scene)?;
        tell("profiles".into());
        let profiles = scene.pair_and_records(folder)?;
        Self::computed(scene, question, &profiles, name, tell)
    }

    /// Computes a scene whose profiles are there already: no file is opened.
    ///
    /// # Errors
    /// Those of [`Run::new`] but for the profiles'.
    pub fn over(scene: Scene, profiles: &Profiles, name: &str) -> Result<Self> {
        let question = question(&scene)?;
        Self::computed(scene, question, profiles, name, &|_| {})
    }

    fn computed(
        scene: Scene,
        question: Question,
        (pair, measured): &Profiles,
        name: &str,
        tell: Tell<'_>,
    ) -> Result<Self> {
        tell("contacts".into());
        let places = places::find(&scene.standing()?, pair, &question)?;
        let grids = places.iter().map(|place| grids::grids(&scene, place)).collect::<Result<Vec<_>>>()?;
        grids::check_memory(&scene, grids.iter().flatten())?;
        let mut parts: Vec<Part> = Vec::new();
        for (place, grids) in places.into_iter().zip(grids) {
            for (number, Grid { xi, eta, warning }) in grids.into_iter().enumerate() {
                tell(format!("{}: grid of {} x {} points", place.name(), xi.len(), eta.len()));
                let analysis = Analysis::new(&place.contact, xi, eta, &question)?;
                let folder = match (parts.is_empty(), number) {
                    (true, _) => String::new(),
                    (false, 0) => place.folder.clone(),
                    (false, _) => format!("{}patch-{}", prefix(&place.folder), number + 1),
                };
                let (found, contact) = (place.found.clone(), place.contact.clone());
                parts.push(Part { folder, found, contact, analysis, grid_warning: warning });
            }
        }
        let title = scene.title.clone().unwrap_or_else(|| name.to_string());
        let (hash, measured) = (scene::hash(&scene), measured.clone());
        Ok(Self { hash, file: None, scene, title, question, measured, parts })
    }

    /// The same, read from this file.
    #[must_use]
    pub fn read_from(self, path: &Path) -> Self {
        Self { file: path.canonicalize().ok(), ..self }
    }

    /// Puts all parts below a folder of many runs: the first as `name`, the others as `name-…`.
    #[must_use]
    pub fn filed_under(mut self, name: &str) -> Self {
        for part in &mut self.parts {
            part.folder =
                if part.folder.is_empty() { name.to_string() } else { format!("{name}-{}", part.folder) };
        }
        self
    }

    /// Writes all files that the scene asks for, in silence and without PNG.
    ///
    /// # Errors
    /// The disk's; a format that cannot hold the grid; a scene that asks for PNG.
    pub fn write(&self, folder: &Folder) -> Result<()> {
        self.write_told(folder, None, &|_| {})
    }

    /// Writes all files that the scene asks for, and tells what it is at.
    ///
    /// # Errors
    /// The disk's; a format that cannot hold the grid; a scene that asks for PNG, without what makes it.
    pub fn write_told(&self, folder: &Folder, png: Option<Rasterise>, tell: Tell<'_>) -> Result<()> {
        self.parts.iter().try_for_each(|part| files::write(folder, self, part, png, tell))
    }

    /// Geometric "no"s.
    pub fn refusals(&self) -> Vec<String> {
        self.parts.iter().flat_map(Part::refusals).collect()
    }

    /// What a user should know before using the files.
    pub fn warnings(&self) -> Vec<String> {
        let findings = self.measured.iter().flatten().flat_map(|record| &record.warnings);
        let mut out: Vec<String> =
            findings.map(|finding| format!("{}: {}", finding.place, finding.found)).collect();
        for part in &self.parts {
            let place = if part.folder.is_empty() { String::new() } else { format!("{}: ", part.folder) };
            out.extend(part.warnings(self).into_iter().map(|warning| format!("{place}{warning}")));
        }
        out
    }

    /// The load on a wheel \[N\], where the scene gives it.
    fn load(&self) -> Option<f64> {
        self.scene.patch.as_ref().and_then(|patch| patch.load)
    }

    /// Whether other parts of the same wheel carry some of its load.
    fn shares_load(&self, part: &Part) -> bool {
        let same_wheel = |other: &&Part| other.side() == part.side();
        self.load().is_some() && self.parts.iter().filter(same_wheel).count() > 1
    }

    /// What that means for the part's files.
    fn shared_load(&self, part: &Part) -> Option<String> {
        let load = self.load().filter(|_| self.shares_load(part))?;
        Some(format!(
            "the load of {load} N is shared with other contacts of this wheel, each in files of its own: contact.inp gives \
             the approach instead"
        ))
    }
}

impl Part {
    /// Side and number of a contact that was found; which part of the patch, where a chosen one has several grids.
    pub fn name(&self) -> String {
        match &self.found {
            Some(found) => found.name(),
            None if self.folder.is_empty() => "contact".into(),
            None => format!("contact, {}", self.folder),
        }
    }

    /// Side of a wheelset, if the contact was looked for.
    fn side(&self) -> Option<&'static str> {
        self.found.as_ref().map(|found| found.side)
    }

    fn refusals(&self) -> Vec<String> {
        let mut out = Vec::new();
        let feasibility = &self.contact.feasibility;
        // A further contact of the same side is closed by the approach only, by which the first one overlaps.
        let first = self.found.as_ref().is_none_or(|found| found.contact == 1);
        if first && !feasibility.feasible {
            out.push(format!(
                "infeasible contact: the bodies overlap by {:.6e} mm at xi = {:.6} mm, eta = {:.6} mm; expected s >= 0 \
                 everywhere (4.1); choose another pair of points",
                -feasibility.least_separation_mm, feasibility.at_xi_mm, feasibility.at_eta_mm
            ));
        }
        if self.analysis.patch.as_ref().is_some_and(|patch| patch.components.is_empty()) {
            let window = self.analysis.window();
            out.push(if window.xi[0] < window.xi[1] && window.eta[0] < window.eta[1] {
                "empty patch: s is nowhere below the approach in the window of the grid".into()
            } else {
                "empty patch: the grid is a single line".into()
            });
        }
        out
    }

    fn warnings(&self, run: &Run) -> Vec<String> {
        let mut out = Vec::from_iter(run.shared_load(self));
        out.extend(self.grid_warning.clone());
        if self.analysis.patch.as_ref().is_some_and(Patch::cut_by_window) {
            out.push("the window of the grid cuts the patch: solvers would overestimate the pressure".into());
        }
        let Plan { error, tolerance, .. } = self.analysis.plan;
        if error.is_nan() || error > tolerance {
            out.push(format!(
                "the separation's estimated error, {error:.1e} mm, is above grid.tolerance, {tolerance:e} mm"
            ));
        }
        out
    }
}

/// The placed pair of every contact that [`Run::new`] finds, the first one first, with their names; no grid, no patch.
///
/// # Errors
/// Bad input, by key.
pub fn contacts(scene: &Scene, pair: &Pair) -> Result<Vec<(String, Placement)>> {
    let (standing, mut question) = (scene.standing()?, question(scene)?);
    if matches!(standing.place, Place::Points { .. }) {
        // A chosen contact is one whatever the approach.
        question.approach = None;
    }
    let placed = places::find(&standing, pair, &question)?;
    Ok(placed.into_iter().map(|place| (place.name(), place.contact.placement)).collect())
}

fn prefix(folder: &str) -> String {
    if folder.is_empty() { String::new() } else { format!("{folder}-") }
}

/// The numerical question that a scene asks.
///
/// # Errors
/// Contradictory or impossible values, by key.
pub fn question(scene: &Scene) -> Result<Question> {
    scene.check_patch()?;
    let patch = scene.patch.as_ref();
    let approach = patch
        .and_then(|patch| patch.approach.map(ApproachBy::Given).or_else(|| patch.load.map(ApproachBy::Load)));
    Ok(Question {
        approach,
        material: scene.elastic()?,
        tolerance: scene.tolerance()?,
        method: scene.grid.method,
        merge: scene.merge()?,
    })
}

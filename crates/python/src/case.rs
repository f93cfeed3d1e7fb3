//! Scenes, as the command line runs them.

use std::path::{Path, PathBuf};

use pyo3::prelude::*;
use wheelrail::case::{self, RUN_FOLDER, contacts, write};
use wheelrail::files::Folder;
use wheelrail::{Result, scene};

use crate::contact::Contact;
use crate::errors::OrRaise;
use crate::long::waited;
use crate::profile::to_python;

/// A scene file (TOML or JSON), read and checked: what `wheelrail run` starts from.
///
/// Raises InputError for what is wrong with the scene, by line or key; FileError for a file that cannot be read.
#[pyclass(frozen, module = "wheelrail")]
pub(crate) struct Case {
    path: PathBuf,
    case: wheelrail::Case,
}

#[pymethods]
impl Case {
    #[new]
    fn new(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        waited(py, move |_| Ok(Self { case: resolved(&path)?, path }))
    }

    /// The file that the scene was read from.
    #[getter]
    fn path(&self) -> &Path {
        &self.path
    }

    /// Title of the scene, or the name of its file.
    #[getter]
    fn title(&self) -> &str {
        &self.case.echo().title
    }

    /// The scene as a dict.
    #[getter]
    fn scene<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        to_python(py, &self.case.echo().scene)
    }

    /// The contacts, the first one first: the chosen one, or all that a search finds under the scene's approach or load.
    ///
    /// Raises InputError for a wheel that touches nothing.
    #[getter]
    fn contacts(&self, py: Python<'_>) -> PyResult<Vec<Contact>> {
        let found = py.detach(|| contacts(&self.case)).or_raise()?;
        Ok(found.into_iter().map(|(name, placement)| Contact::placed(placement, name)).collect())
    }

    /// Compute the case and write its files into the folder `out`, which appears whole or not at all.
    ///
    /// Raises InputError for a case that cannot be computed; FileError where the disk refuses.
    fn run(&self, py: Python<'_>, out: PathBuf) -> PyResult<Run> {
        let (case, path) = (self.case.clone(), self.path.clone());
        waited(py, move |watch| {
            let run = case::Run::new(case, case::SILENT).map_err(|error| error.within(path.display()))?;
            let folder = Folder::create(&out, RUN_FOLDER)?;
            write(&run, &folder, None, case::SILENT)?;
            // Nothing is left behind by a run that nobody waits for.
            watch.go_on()?;
            folder.commit()?;
            let (refusals, warnings) = (run.refusals(), run.warnings());
            let parts = run.parts.iter().map(|part| out.join(&part.site.folder)).collect();
            Ok(Run { folder: out, parts, refusals, warnings })
        })
    }

    fn __repr__(&self) -> String {
        format!("Case({:?})", self.path)
    }
}

fn resolved(path: &Path) -> Result<wheelrail::Case> {
    let name = path.file_stem().unwrap_or(path.as_os_str()).to_string_lossy();
    let folder = path.parent().unwrap_or(Path::new("."));
    let case = scene::resolve(&scene::load(path)?, folder, &name);
    Ok(case.map_err(|error| error.within(path.display()))?.read_from(path))
}

/// Run a scene file as `wheelrail run` does, and write its files into the folder `out`.
///
/// The work does not hold the GIL. Ctrl-C ends the wait within 0.2 s and leaves the old folder as it was.
///
/// Raises InputError for what is wrong with the scene; FileError where the disk refuses. A geometric "no" (an infeasible
/// contact, an empty patch) is no error: see `Run.refusals`.
#[pyfunction]
pub(crate) fn run(py: Python<'_>, path: PathBuf, out: PathBuf) -> PyResult<Run> {
    Case::new(py, path)?.run(py, out)
}

/// What a run left.
#[pyclass(frozen, get_all, module = "wheelrail")]
pub(crate) struct Run {
    /// The folder with its files.
    folder: PathBuf,
    /// The folder of every part, the first one first: each has a summary.json.
    parts: Vec<PathBuf>,
    /// The geometric "no"s: an infeasible contact, an empty patch.
    refusals: Vec<String>,
    /// What a user should know before using the files.
    warnings: Vec<String>,
}

#[pymethods]
impl Run {
    /// The summary.json of every part, as dicts.
    #[getter]
    fn summaries<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyAny>>> {
        let (loads, path) = (py.import("json")?.getattr("loads")?, py.import("pathlib")?.getattr("Path")?);
        let summary = |folder: &PathBuf| {
            let file = path.call1((folder.join("summary.json"),))?;
            loads.call1((file.call_method1("read_text", ("utf-8",))?,))
        };
        self.parts.iter().map(summary).collect()
    }

    fn __repr__(&self) -> String {
        let (refusals, warnings) = (self.refusals.len(), self.warnings.len());
        format!(
            "Run({:?}, {} parts, {refusals} refusals, {warnings} warnings)",
            self.folder,
            self.parts.len()
        )
    }
}

//! Fleets of wheelsets on rail sections.

use std::path::{Path, PathBuf};

use pyo3::prelude::*;
use wheelrail::Result;
use wheelrail::fleet::Fleet;
use wheelrail::scene;

use crate::errors::say;
use crate::files::read_json;
use crate::long::{waited, watched};

/// Compute every wheelset of a fleet on every rail section, into the folder `out`, and return its summary.
///
/// `path` is a scene file with what all pairs share. `wheels` is a folder whose files are both wheels of a wheelset each, or a CSV file
/// with the columns wheelset, left, right and perhaps radius_left_mm, radius_right_mm, rail_left, rail_right; `rails` is a folder of
/// sections, a file or a built-in name, None for the rails of the table or the scene. The folder gets `fleet.csv`, a row for every
/// pair, `summary.json`, `fleet.html` and pages of the worst pairs. The same call goes on with a fleet that was stopped.
/// `progress` is called with the pairs done and all of them.
///
///     >>> from pathlib import Path
///     >>> from tempfile import mkdtemp
///     >>> folder = Path(mkdtemp())
///     >>> _ = (folder / "wheels.csv").write_text("wheelset,left,right\nnew,S1002,S1002\n")
///     >>> _ = (folder / "scene.toml").write_text("""
///     ... rail = { rotate = "1:40" }
///     ... wheel = { radius = 460.0 }
///     ... track = { gauge = 1435.0 }
///     ... wheelset = { back_to_back = 1360.0, flange_back_x = -70.0 }
///     ... """)
///     >>> summary = wr.fleet(folder / "scene.toml", folder / "wheels.csv", "60E1", out=folder / "out")
///     >>> summary["pairs"], summary["pairs_with_conicity"]
///     (1, 1)
///
/// Raises InputError for a wrong scene or list, FileError for the disk. What is wrong with a profile is in its row.
#[pyfunction]
#[pyo3(signature = (path, wheels, rails = None, *, out, progress = None))]
pub(crate) fn fleet<'py>(
    py: Python<'py>,
    path: PathBuf,
    wheels: PathBuf,
    rails: Option<PathBuf>,
    out: PathBuf,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let folder = out.clone();
    let warnings = watched(py, progress.as_ref().map(|shown| (shown, "pairs")), move |watch| {
        let fleet = listed(&path, &wheels, rails.as_deref())?;
        watch.at(0, fleet.pairs());
        fleet.run(&folder, &|done, all| {
            watch.at(done, all);
            watch.go_on()
        })?;
        Ok(fleet.warnings())
    })?;
    for warning in &warnings {
        say(py, "scene", warning, "see the scene")?;
    }
    read_json(py, &out.join("summary.json"))
}

/// Return the number of parts of a fleet.
#[pyfunction]
pub(crate) fn fleet_parts(
    py: Python<'_>,
    path: PathBuf,
    wheels: PathBuf,
    rails: Option<PathBuf>,
) -> PyResult<usize> {
    waited(py, move |_| Ok(listed(&path, &wheels, rails.as_deref())?.parts()))
}

/// Compute one part of a fleet, unless it is in the folder `out`.
#[pyfunction]
pub(crate) fn fleet_part(
    py: Python<'_>,
    path: PathBuf,
    wheels: PathBuf,
    rails: Option<PathBuf>,
    out: PathBuf,
    number: usize,
) -> PyResult<()> {
    waited(py, move |_| listed(&path, &wheels, rails.as_deref())?.part(&out, number))
}

fn listed(path: &Path, wheels: &Path, rails: Option<&Path>) -> Result<Fleet> {
    let rails = rails.map(|rails| rails.display().to_string());
    Fleet::new(scene::load(path)?, path.parent().unwrap_or(Path::new(".")), wheels, rails.as_deref())
}

//! Marches along rails that vary, and around wheels that do.

use std::path::PathBuf;

use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use wheelrail::Error;
use wheelrail::case::{
    ALONG, AROUND, EVENT_NUMBERS, MARCH_NUMBERS, MarchColumns, MarchStop, Tally, cut_off_warning,
    event_numbers, hole_warning,
};
use wheelrail::scene;
use wheelrail::search::Event;

use crate::arrays::values;
use crate::errors::{exception, say};
use crate::long::watched;
use crate::sweep::arrays_of;

/// March a wheelset along rails that vary, with the middle of its axle at ascending places `along` the track in mm, or turn it by
/// ascending pitches `angle` in rad, with wheels that vary around their axle.
///
/// `path` is a scene file whose rail is a list of slices, `.slcs`, without `along`, or whose wheel has `flat`, `radii`, or is a list
/// `.slcw` without `angle`. Returns two dicts of arrays: the contacts, with the columns of a sweep, `along_mm` or `angle_rad`, and
/// `contact_pitch_rad`, `approach_mm` and `normal_load_n`, of which the last two are NaN without a load in the scene; and the events, with
/// those of `wheelrail march --events`. `progress` is called with the places done and all of them.
///
///     >>> from pathlib import Path
///     >>> from tempfile import mkdtemp
///     >>> folder = Path(mkdtemp())
///     >>> for at in (0, 1000):                                      # a rail that rises by 1:1000
///     ...     wr.rail("60E1").shifted(0.0, at / 1000).to_file(folder / f"{at}.toml")
///     >>> _ = (folder / "rail.slcs").write_text("0 1\n2\n0\n1\n0 '0.toml'\n1000 '1000.toml'\n")
///     >>> _ = (folder / "scene.toml").write_text("""
///     ... rail = { file = "rail.slcs" }
///     ... wheel = { profile = "S1002", radius = 460.0 }
///     ... track = { spacing = 1500.0 }
///     ... wheelset = { spacing = 1500.0 }
///     ... """)
///     >>> rows, events = wr.march(folder / "scene.toml", [400.0, 600.0])
///     >>> [round(float(z), 3) for z in rows["z_mm"] - rows["z_mm"][0]]
///     [0.0, 0.0, 0.2, 0.2]
///
/// A flat of 60 mm is R − √(R² − 30²) deep:
///
///     >>> _ = (folder / "flat.toml").write_text("""
///     ... rail = { profile = "60E1" }
///     ... wheel = { profile = "S1002", radius = 460.0, flat = { length = 60.0 } }
///     ... track = { spacing = 1500.0 }
///     ... wheelset = { spacing = 1500.0 }
///     ... """)
///     >>> rows, events = wr.march(folder / "flat.toml", angle=[-0.2, 0.0])
///     >>> round(float(rows["z_mm"][-1] - rows["z_mm"][0]), 2)
///     -0.98
///
/// Raises InputError for anything wrong with the scene, the slices, or places that they do not reach.
#[pyfunction]
#[pyo3(signature = (path, along = None, *, angle = None, progress = None))]
pub(crate) fn march<'py>(
    py: Python<'py>,
    path: PathBuf,
    along: Option<&Bound<'py, PyAny>>,
    angle: Option<&Bound<'py, PyAny>>,
    progress: Option<Py<PyAny>>,
) -> PyResult<(Bound<'py, PyDict>, Bound<'py, PyDict>)> {
    let (course, along) = match (along, angle) {
        (Some(along), None) => (ALONG, values("along", along)?),
        (None, Some(angle)) => (AROUND, values("angle", angle)?),
        (along, _) => {
            let found = if along.is_some() { "`along` and `angle`" } else { "neither `along` nor `angle`" };
            return Err(exception(Error::new("march", found, "one of the two", "give places or pitches")));
        }
    };
    let counted = progress.as_ref().map(|shown| (shown, "positions"));
    let (rows, events, warnings) = watched(py, counted, move |watch| {
        let scene = scene::load(&path)?;
        let folder = path.parent().unwrap_or(std::path::Path::new("."));
        let case = scene::march(&scene, folder)?;
        let (mut rows, mut events, mut done) = (MarchColumns::default(), Vec::new(), 0);
        let (mut cut_off, mut holes, mut doubts) = (0, 0, Tally::default());
        case.blocks(course, &along, |stops: &[MarchStop], found: &[Event]| {
            for stop in stops {
                rows.push(done, stop);
                holes += usize::from(stop.holes.contains(&true));
                cut_off += usize::from(stop.rows.iter().any(|row| row.cut_off));
                doubts.add(stop.rows.iter().map(|row| (&row.row, row.doubts)));
                done += 1;
            }
            events.extend_from_slice(found);
            watch.at(done, along.len());
            watch.go_on().map(|()| true)
        })?;
        let radius = |side| case.profiles.on(Some(side)).pair.wheel_radius();
        let doubts = doubts.line(along.len(), radius);
        let mut warnings = case.warnings;
        warnings.extend(hole_warning(holes).into_iter().chain(cut_off_warning(cut_off)).chain(doubts));
        Ok((rows, events, warnings))
    })?;
    for warning in &warnings {
        say(py, "march", warning, "see the scene and its lists of slices")?;
    }
    let MarchColumns { along, columns, numbers } = rows;
    let columns = arrays_of(py, columns)?;
    // Words for sides and doubts, as in the table of a sweep.
    let table = py.import("wheelrail._table")?.getattr("Table")?.call1((&columns,))?;
    let rows = py.get_type::<PyDict>().call1((table,))?.cast_into::<PyDict>()?;
    rows.set_item("right", columns.get_item("right")?)?;
    rows.set_item(course.column, PyArray1::from_vec(py, along))?;
    for (name, numbers) in MARCH_NUMBERS.into_iter().zip(numbers) {
        rows.set_item(name, PyArray1::from_vec(py, numbers))?;
    }
    let told = PyDict::new(py);
    told.set_item(course.column, PyArray1::from_iter(py, events.iter().map(|event| event.along)))?;
    told.set_item("side", PyList::new(py, events.iter().map(|event| event.side.name()))?)?;
    told.set_item("event", PyList::new(py, events.iter().map(|event| event.kind.name()))?)?;
    for (k, name) in EVENT_NUMBERS.into_iter().enumerate() {
        told.set_item(name, PyArray1::from_iter(py, events.iter().map(|event| event_numbers(event)[k])))?;
    }
    Ok((rows, told))
}

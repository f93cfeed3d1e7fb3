//! Contact tables: made, read and looked up.

use std::path::{Path, PathBuf};

use numpy::PyArrayMethods;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use wheelrail::case::{self, TABLE_FOLDER, table_roll_ends, write_table};
use wheelrail::export::table_wrp;
use wheelrail::files::{Folder, read_text};
use wheelrail::table::Beginning;
use wheelrail::{Error, Interval, scene};

use crate::arrays::{unset, values};
use crate::errors::{OrRaise, exception, say};
use crate::long::{shared, waited};
use crate::sweep::ROLL_ENDS;

/// Positions of a part of a look-up, after each of which Ctrl-C is looked for: 0.15 s on one thread of a table over yaw.
const PART: usize = 1 << 16;
/// Largest table that is read \[bytes\].
const LARGEST: usize = 1 << 30;

/// Tabulate the contact of a scene's wheelset over a range of lateral displacements in mm, as polynomials with a stated error.
///
/// `lateral` is the range, `yaw` a range in rad, without which the table is under the yaw of the scene; `tolerance` is that of lengths
/// in mm; the roll is that of the scene. `hertz` adds Hertz's ellipse, approach and largest pressure under the scene's load or approach.
/// `out` is a folder that gets the table as `table.wrp`, `table.nc` and `table.csv`.
///
///     >>> from pathlib import Path
///     >>> from tempfile import mkdtemp
///     >>> scene = Path(mkdtemp()) / "scene.toml"
///     >>> _ = scene.write_text("""
///     ... rail = { profile = "60E1", rotate = "1:40" }
///     ... wheel = { profile = "S1002", radius = 460.0 }
///     ... track = { spacing = 1500.0 }
///     ... wheelset = { spacing = 1500.0 }
///     ... """)
///     >>> table = wr.table(scene, (-2.0, 2.0), tolerance=1e-3)
///     >>> radius = table([0.0, 1.5])["right"]["rolling_radius_mm"]
///     >>> bool(radius[1] > radius[0]) and table.errors["right"]["rolling_radius_mm"] < 1e-3
///     True
///
/// Raises InputError for a scene without a wheelset, a roll by loads, ellipses without a load or approach, a range or tolerance out of bounds.
#[pyfunction]
#[pyo3(signature = (path, lateral, *, yaw = None, tolerance = 1e-3, hertz = false, out = None))]
pub(crate) fn table(
    py: Python<'_>,
    path: PathBuf,
    lateral: [f64; 2],
    yaw: Option<[f64; 2]>,
    tolerance: f64,
    hertz: bool,
    out: Option<PathBuf>,
) -> PyResult<ContactTable> {
    let made = waited(py, move |watch| {
        let scene = scene::load(&path)?;
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        let case = scene::resolve(&scene, path.parent().unwrap_or(Path::new(".")), &name)?;
        let made = case::table(&case, lateral.into(), yaw.map(Interval::from), tolerance, hertz)?;
        watch.go_on()?;
        if let Some(out) = out {
            let folder = Folder::create(&out, TABLE_FOLDER)?;
            write_table(&made, scene.title.as_deref().unwrap_or(&name), &folder)?;
            folder.commit()?;
        }
        Ok(made)
    })?;
    for end in table_roll_ends(&made) {
        say(py, "roll", &end, ROLL_ENDS)?;
    }
    Ok(ContactTable { table: made })
}

/// A contact table: places, angles, radii and curvatures of both wheels over the lateral displacement, and over yaw.
///
/// `ContactTable(path)` reads a `table.wrp`. Calling it looks up: `table(lateral)`, or `table(lateral, yaw)` over yaw, gives the quantities
/// of the wheelset by their names, and under "left" and "right" those of each side, an array each; what does not exist is NaN.
/// A table can be pickled and copied.
///
///     >>> from pathlib import Path
///     >>> from tempfile import mkdtemp
///     >>> folder = Path(mkdtemp())
///     >>> scene = folder / "scene.toml"
///     >>> _ = scene.write_text("""
///     ... rail = { profile = "60E1", rotate = "1:40" }
///     ... wheel = { profile = "S1002", radius = 460.0 }
///     ... track = { spacing = 1500.0 }
///     ... wheelset = { spacing = 1500.0 }
///     ... """)
///     >>> made = wr.table(scene, (-2.0, 2.0), tolerance=1e-3, out=folder / "table")
///     >>> read = wr.ContactTable(folder / "table" / "table.wrp")
///     >>> bool(read([1.5])["right"]["rolling_radius_mm"][0] == made([1.5])["right"]["rolling_radius_mm"][0])
///     True
#[pyclass(module = "wheelrail", frozen)]
pub(crate) struct ContactTable {
    table: wheelrail::table::ContactTable,
}

#[pymethods]
impl ContactTable {
    #[new]
    fn new(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let table = waited(py, move |_| {
            let text = read_text(&path, LARGEST)?;
            wheelrail::table::ContactTable::read(&text).map_err(|error| error.within(path.display()))
        })?;
        Ok(Self { table })
    }

    /// Look the quantities up at lateral displacements in mm and yaws in rad, as many or one.
    ///
    /// Under one yaw `yaw` may be left out, and has to be that of the table. `quantities` are the names that are wanted, all unless given. It
    /// runs on all threads without the GIL.
    ///
    /// Raises InputError for another yaw than the table's one, none over a range, another number of yaws, and unknown names.
    #[pyo3(signature = (lateral, yaw = None, *, quantities = None))]
    fn __call__<'py>(
        &self,
        py: Python<'py>,
        lateral: &Bound<'py, PyAny>,
        yaw: Option<&Bound<'py, PyAny>>,
        quantities: Option<Vec<String>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let lateral = values("lateral", lateral)?;
        let yaw = self.yaws(yaw)?;
        let known = self.table.quantities();
        let wanted = |name: &str| quantities.as_ref().is_none_or(|names| names.iter().any(|own| own == name));
        let is_unknown = |name: &&String| known.iter().all(|own| own.name != **name);
        if let Some(name) = quantities.iter().flatten().find(is_unknown) {
            let found = format!("\"{name}\"");
            return Err(exception(Error::new("quantities", found, "names of `errors`", "correct it")));
        }
        let numbers: Vec<usize> = (0..known.len()).filter(|q| wanted(known[*q].name)).collect();
        let columns = unset(py, numbers.len(), lateral.len())?;
        let mut filled = columns.readwrite();
        let count = lateral.len();
        let mut left: Vec<&mut [f64]> = filled.as_slice_mut()?.chunks_exact_mut(count.max(1)).collect();
        // Yaws of another number are refused as a whole.
        let part = if [1, count].contains(&yaw.len()) { PART } else { count.max(1) };
        for from in (0..count.max(1)).step_by(part) {
            let range = from..count.min(from + part);
            let yaw = if yaw.len() == count { &yaw[range.clone()] } else { &yaw[..] };
            let next = left.iter_mut().filter_map(|column| column.split_off_mut(..range.len()));
            let (lateral, mut columns) = (&lateral[range.clone()], next.collect::<Vec<_>>());
            shared(py, || self.table.fill_columns(lateral, yaw, &numbers, &mut columns))?
                .map_err(exception)?;
            py.check_signals()?;
        }
        drop(filled);
        self.by_name(py, numbers.iter().enumerate().map(|(k, q)| Ok((*q, columns.get_item(k)?))))
    }

    /// The largest error of each quantity, by its name as the values have them.
    #[getter]
    fn errors<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let all = self.table.quantities().iter().enumerate();
        self.by_name(py, all.map(|(q, quantity)| Ok((q, quantity.error.into_pyobject(py)?.into_any()))))
    }

    /// The tolerance of each quantity, by its name as the values have them.
    #[getter]
    fn tolerances<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let all = self.table.quantities().iter().enumerate();
        self.by_name(py, all.map(|(q, quantity)| Ok((q, quantity.tolerance.into_pyobject(py)?.into_any()))))
    }

    /// The range of the lateral displacement in mm.
    #[getter]
    fn lateral(&self) -> (f64, f64) {
        self.table.about().lateral.ends().into()
    }

    /// The range of the yaw in rad; both ends are equal where all displacements have one yaw.
    #[getter]
    fn yaw(&self) -> (f64, f64) {
        self.table.about().yaw.ends().into()
    }

    /// The distance in mm from hops, joints and edges within which the table may give the values of their other side.
    #[getter]
    fn beside_curves(&self) -> f64 {
        self.table.about().beside_curves()
    }

    /// The intervals (from, to) of lateral displacements in mm in which a wheel is off its rail under a yaw in rad, so that the table has
    /// nothing there.
    #[pyo3(signature = (yaw = None))]
    fn off_rail(&self, yaw: Option<f64>) -> PyResult<Vec<(f64, f64)>> {
        Ok(self.table.off_rail(self.one_yaw(yaw)?).into_iter().map(|off| off.ends().into()).collect())
    }

    /// The lateral displacements in mm at which contact hops to another place under a yaw in rad.
    #[pyo3(signature = (yaw = None))]
    fn hops(&self, yaw: Option<f64>) -> PyResult<Vec<f64>> {
        Ok(self.table.places(Beginning::Hop, self.one_yaw(yaw)?))
    }

    /// The lateral displacements in mm at which contact crosses a joint of a profile under a yaw in rad.
    #[pyo3(signature = (yaw = None))]
    fn joints(&self, yaw: Option<f64>) -> PyResult<Vec<f64>> {
        Ok(self.table.places(Beginning::Joint, self.one_yaw(yaw)?))
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyBytes>,))> {
        let make = py.import("wheelrail._wheelrail")?.getattr("table_from_text")?;
        Ok((make, (PyBytes::new(py, table_wrp(&self.table, "").as_bytes()),)))
    }

    fn __repr__(&self) -> String {
        let [from, to] = self.table.about().lateral.ends();
        format!("ContactTable of {} cells from {from} to {to} mm", self.table.cells().len())
    }
}

/// Make a table of the text of a `table.wrp`.
#[pyfunction]
pub(crate) fn table_from_text(text: &[u8]) -> PyResult<ContactTable> {
    let text = String::from_utf8_lossy(text);
    let table = wheelrail::table::ContactTable::read(&text).map_err(|error| error.within("pickled table"));
    Ok(ContactTable { table: table.or_raise()? })
}

impl ContactTable {
    /// Gives yaws \[rad\]: one for all displacements, or one for each.
    fn yaws(&self, yaw: Option<&Bound<'_, PyAny>>) -> PyResult<Vec<f64>> {
        let about = self.table.about();
        let given = yaw.map(|yaw| yaw.extract().map_or_else(|_| values("yaw", yaw), |one| Ok(vec![one])));
        match given.transpose()? {
            Some(all) if about.over_yaw() => Ok(all),
            Some(all) => {
                all.iter().try_for_each(|yaw| self.one_yaw(Some(*yaw)).map(drop))?;
                Ok(vec![about.yaw.low])
            }
            None => Ok(vec![self.one_yaw(None)?]),
        }
    }

    /// Gives a yaw that the table has \[rad\]; it may be left out where the table is under one yaw.
    fn one_yaw(&self, yaw: Option<f64>) -> PyResult<f64> {
        let about = self.table.about();
        match yaw {
            None if about.over_yaw() => {
                let (expected, advice) = ("a yaw in rad", "the table is over yaw: give one");
                Err(exception(Error::new("yaw", "none", expected, advice)))
            }
            Some(yaw) if !about.over_yaw() && yaw != about.yaw.low => {
                let expected = format!("{} rad, the yaw of the table", about.yaw.low);
                let advice = "make a table with this yaw";
                Err(exception(Error::new("yaw", yaw.to_string(), expected, advice)))
            }
            yaw => Ok(yaw.unwrap_or(about.yaw.low)),
        }
    }

    /// Makes a dict of items by the names of their quantities, those of the sides in the dicts "left" and "right".
    fn by_name<'py>(
        &self,
        py: Python<'py>,
        items: impl Iterator<Item = PyResult<(usize, Bound<'py, PyAny>)>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let (out, left, right) = (PyDict::new(py), PyDict::new(py), PyDict::new(py));
        for item in items {
            let (q, value) = item?;
            let quantity = &self.table.quantities()[q];
            let home = match quantity.right {
                None => &out,
                Some(false) => &left,
                Some(true) => &right,
            };
            home.set_item(quantity.name, value)?;
        }
        out.set_item("left", left)?;
        out.set_item("right", right)?;
        Ok(out)
    }
}

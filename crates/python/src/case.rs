//! Scenes, as the command line runs them.

use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use wheelrail::case::{self, ApproachBy, Doubt, OutputFormat, RUN_FOLDER, sweep_page, write};
use wheelrail::files::Folder;
use wheelrail::scene::{self, Given};
use wheelrail::search::{Position, Roll, WheelsetOnTrack};
use wheelrail::{Error, Result, Scene};
use wheelrail_check::check_site;

use crate::contact::Contact;
use crate::errors::{OrRaise, exception, say, warn};
use crate::files::files;
use crate::long::waited;
use crate::place::PairContact;
use crate::positions::positions;
use crate::profile::Profile;
use crate::sweep::{AskedOfSweep, DrawnPositions, sweep};
use crate::text::{keyed, parsed, to_json, to_python};
use crate::values::made;

/// A scene, read and checked: what `wheelrail run` starts from. It carries all that a scene can say, both sides of a wheelset,
/// deviations, rollers, loads, motion and grids, and gives all that a run writes without a file.
///
/// A case is made of a file (TOML or JSON), or by `from_dict` and `from_toml`. It can be pickled and compared.
///
///     >>> case = wr.Case.from_dict({
///     ...     "rail": {"profile": wr.rail("60E1"), "rotate": "1:40"},
///     ...     "wheel": {"profile": wr.wheel("S1002"), "radius": 460.0},
///     ...     "track": {"gauge": 1435.0},
///     ...     "wheelset": {"back_to_back": 1360.0, "flange_back_x": -70.0, "lateral": 3.0, "load": 120e3},
///     ... })
///     >>> [contact.name for contact in case.contacts]
///     ['right side, contact 1', 'left side, contact 1']
///
/// Raises InputError for what is wrong with the scene, by line or key; FileError for a file that cannot be read; warns of what it
/// doubts.
#[pyclass(frozen, module = "wheelrail")]
#[derive(Clone)]
pub(crate) struct Case {
    inner: Arc<Inner>,
}

struct Inner {
    case: wheelrail::Case,
    /// The file, or the folder that paths of the scene are relative to.
    path: PathBuf,
    is_file: bool,
    given: Py<PyDict>,
    /// Everything computed from it, once it was asked for.
    run: OnceLock<Arc<wheelrail::Run>>,
}

#[pymethods]
impl Case {
    #[new]
    fn new(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let (read, file) = (path.clone(), path);
        let case = waited(py, move |_| resolved(&read))?;
        Self::warned(py, Self::of(py, case, file, true, None))
    }

    /// Make a case of a dict with the tables and keys of a scene file; `profile` may be a `Profile`, and arrays may stand for lists.
    ///
    /// Files in it are relative to `folder`. `title` is that of a scene without one.
    #[staticmethod]
    #[pyo3(signature = (scene, *, folder = PathBuf::from("."), title = "scene"))]
    fn from_dict(py: Python<'_>, scene: &Bound<'_, PyAny>, folder: PathBuf, title: &str) -> PyResult<Self> {
        let profiles = PyDict::new(py);
        let text = to_json(scene, Some(profiles.as_any()))?;
        let scene = scene::parse(&text, true).map_err(|error| keyed(&text, error).within("scene"));
        Self::resolved(py, scene.or_raise()?, folder, title, profiles)
    }

    /// Make a case of the text of a scene file in TOML. `profile` may also name one of `profiles`, a dict of them.
    ///
    /// Files in it are relative to `folder`. `title` is that of a scene without one.
    #[staticmethod]
    #[pyo3(signature = (text, *, profiles = None, folder = PathBuf::from("."), title = "scene"))]
    fn from_toml(
        py: Python<'_>,
        text: &str,
        profiles: Option<Bound<'_, PyDict>>,
        folder: PathBuf,
        title: &str,
    ) -> PyResult<Self> {
        let scene = scene::parse(text, false).map_err(|error| error.within("scene")).or_raise()?;
        let profiles = profiles.map_or_else(|| Ok(PyDict::new(py)), |profiles| profiles.copy())?;
        Self::resolved(py, scene, folder, title, profiles)
    }

    /// Write the scene as TOML. Profiles that were given are written by their segments.
    ///
    /// Raises InputError for measured profiles whose curve is no chain of lines, arcs and polynomials z(x).
    fn to_toml(&self, py: Python<'_>) -> PyResult<String> {
        let scene: Scene = parsed("scene", &self.scene(py)?)?;
        scene::to_toml(&scene).or_raise()
    }

    /// The file that the scene was read from; None for one that was made here.
    #[getter]
    fn path(&self) -> Option<&Path> {
        self.inner.is_file.then_some(&self.inner.path)
    }

    /// Title of the scene, or the name of its file.
    #[getter]
    fn title(&self) -> &str {
        &self.inner.case.echo().title
    }

    /// The scene as a dict, which `from_dict` takes.
    #[getter]
    fn scene<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let names = to_python(py, &self.inner.case.echo().scene)?;
        py.import("wheelrail._scene")?.getattr("with_profiles")?.call1((names, self.inner.given.bind(py)))
    }

    /// What in the scene and its measured files looks like a slip.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.inner.case.warnings()
    }

    /// The contacts, the right side's before the left's: the chosen one, or all that a search finds under the scene's approach or
    /// load, each with its approach and its share of the load.
    ///
    /// Raises GeometryError for a wheel that touches nothing; InputError for a load that no approach carries.
    #[getter]
    fn contacts(slf: &Bound<'_, Self>) -> PyResult<Vec<Contact>> {
        let case = slf.get().shared();
        let found = waited(slf.py(), move |_| case::find(&case, case.question().approach))?;
        let spot = |(k, contact)| PairContact::of_case(slf.clone().into_any().unbind(), k, contact);
        Ok(found.into_iter().enumerate().map(spot).map(Contact::of).collect())
    }

    /// Return what summary.json says of every part, as dicts; a patch of several parts has a part for each.
    ///
    /// Raises InputError for a case that cannot be computed.
    fn summaries<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyAny>>> {
        let run = self.computed(py)?;
        case::summaries(&run).or_raise()?.iter().map(|summary| to_python(py, summary)).collect()
    }

    /// Return why contacts are infeasible or patches empty, a line each.
    ///
    /// Raises InputError for a case that cannot be computed.
    fn refusals(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        Ok(self.computed(py)?.refusals())
    }

    /// Return the files of one format as bytes, by their paths in the folder of a run: "vtk", "npy", "netcdf", "text", "conform",
    /// "countact", "contact", "html", "gmsh", "abaqus", "stl", "ply", "vtp"; without a format the tables and pictures of every run.
    ///
    /// Raises InputError for an unknown format, and one that cannot hold the grid or has nothing to show.
    #[pyo3(signature = (format = None))]
    fn files<'py>(&self, py: Python<'py>, format: Option<&str>) -> PyResult<Bound<'py, PyDict>> {
        let run = self.computed(py)?;
        files(py, format, move |format| case::files(&run, format))
    }

    /// Return the page of all contacts, view.html, as text; a notebook shows it by itself.
    ///
    /// Raises InputError for a case that cannot be computed.
    fn view(&self, py: Python<'_>) -> PyResult<String> {
        let run = self.computed(py)?;
        let files = waited(py, move |_| case::files(&run, Some(OutputFormat::Html)))?;
        Ok(files.into_iter().map(|(_, bytes)| String::from_utf8_lossy(&bytes).into_owned()).collect())
    }

    fn _repr_html_(&self, py: Python<'_>) -> PyResult<String> {
        py.import("wheelrail._html")?.getattr("framed")?.call1((self.view(py)?,))?.extract()
    }

    /// Find the contacts of the case's wheelset at many positions, as `Wheelset.sweep` does; `yaw` and `roll` are those of the scene
    /// where they are None, and so are `within`, approach or load, and material.
    ///
    /// Raises InputError for a case without a wheelset, and as `Wheelset.sweep` does.
    #[pyo3(signature = (lateral, yaw = None, roll = None, *, conicity = true, progress = None))]
    fn sweep<'py>(
        &self,
        py: Python<'py>,
        lateral: &Bound<'py, PyAny>,
        yaw: Option<&Bound<'py, PyAny>>,
        roll: Option<&Bound<'py, PyAny>>,
        conicity: bool,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let case = &self.inner.case;
        let (system, position) = self.wheelset()?;
        let own = own_angles(py, position)?;
        let landmarks = Arc::new(case.landmarks().clone());
        let positions = positions(lateral, yaw.or(Some(&own[0])), roll.or(Some(&own[1])))?;
        let question = case.question();
        let asked = AskedOfSweep {
            within: case.setup().within,
            conicity,
            ellipses: question.approach.map(|by: ApproachBy| (by, question.modulus())),
        };
        let profiles = case.profiles();
        let left = profiles.left.as_ref().map(|left| &left.pair);
        let right = &profiles.right.pair;
        let radii = [left.unwrap_or(right), right].map(wheelrail::Pair::wheel_radius);
        sweep(py, (Arc::clone(system), landmarks, radii), positions, asked, progress.as_ref())
    }

    /// Compare every contact with triangle meshes that parry3d measures, as `wheelrail check` does.
    ///
    ///     >>> [check.agrees for check in case.check()]
    ///     [True, True]
    ///
    /// Raises InputError for a case without contacts, and for bodies whose meshes are too large.
    fn check<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyAny>>> {
        let case = self.inner.case.clone();
        let reports = waited(py, move |watch| {
            let checked = |site: &case::Site| {
                watch.go_on()?;
                check_site(site).map(|report| (site.name(), report))
            };
            case::sites(&case)?.iter().map(checked).collect::<Result<Vec<_>>>()
        })?;
        let value = |(name, report): (String, wheelrail_check::SiteReport)| {
            let values = serde_json::to_value(&report).unwrap_or_default();
            made(py, "Check", (name, report.agrees(), to_python(py, &values)?, report.to_string()))
        };
        reports.into_iter().map(value).collect()
    }

    /// Draw the page of a table of `sweep`: the usual curves, and the profiles at the position under the pointer. Returns its
    /// text; the lateral displacements have to ascend.
    ///
    /// Raises InputError for a case without a wheelset, and for displacements that do not ascend.
    fn sweep_page(&self, table: &Bound<'_, PyAny>) -> PyResult<String> {
        let (system, _) = self.wheelset()?;
        let columns = table.getattr("_columns");
        let columns = columns.map_err(|_| PyTypeError::new_err("table: expected the table of a sweep"))?;
        let DrawnPositions { columns, lateral, about } = DrawnPositions::of(columns.cast()?)?;
        let page = sweep_page(&self.inner.case, system, &columns, &lateral, &about).or_raise()?;
        Ok(String::from_utf8_lossy(&page.html()).into_owned())
    }

    /// Compute the case and write its files into the folder `out`, which appears whole or not at all.
    ///
    /// Raises InputError for a case that cannot be computed; FileError where the disk refuses.
    fn run<'py>(&self, py: Python<'py>, out: PathBuf) -> PyResult<Bound<'py, PyAny>> {
        let (known, run) = (self.inner.case.warnings(), self.computed(py)?);
        let warnings = run.warnings();
        for warning in warnings.iter().filter(|warning| !known.contains(warning)) {
            say(py, "run", warning, "see `Run.warnings`")?;
        }
        let (folder, to) = (out.clone(), out);
        let (parts, refusals) = waited(py, move |watch| {
            let folder = Folder::create(&folder, RUN_FOLDER)?;
            write(&run, &folder, None, case::SILENT)?;
            // Nothing is left behind by a run that nobody waits for.
            watch.go_on()?;
            folder.commit()?;
            let parts: Vec<String> = run.parts.iter().map(|part| part.site.folder.clone()).collect();
            Ok((parts, run.refusals()))
        })?;
        let parts: Vec<PathBuf> = parts.into_iter().map(|part| to.join(part)).collect();
        made(py, "Run", (to, parts, refusals, warnings))
    }

    fn __eq__(&self, other: &Self) -> bool {
        let [own, others] = [self, other].map(|case| &case.inner);
        own.case.echo() == others.case.echo() && own.path == others.path
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let class = py.get_type::<Self>();
        let Inner { path, is_file, .. } = self.inner.as_ref();
        if *is_file {
            return Ok((class.into_any(), (path,).into_pyobject(py)?));
        }
        let make = py.import("wheelrail._scene")?.getattr("case_of")?;
        Ok((make, (self.scene(py)?, path, self.title()).into_pyobject(py)?))
    }

    fn __repr__(&self) -> String {
        let Inner { path, is_file, .. } = self.inner.as_ref();
        if *is_file { format!("Case({path:?})") } else { format!("Case(title={:?})", self.title()) }
    }
}

impl Case {
    /// Gives the case of the library; a clone shares the profiles.
    pub(crate) fn shared(&self) -> wheelrail::Case {
        self.inner.case.clone()
    }

    fn of(
        py: Python<'_>,
        case: wheelrail::Case,
        path: PathBuf,
        is_file: bool,
        given: Option<Bound<'_, PyDict>>,
    ) -> Self {
        let given = given.unwrap_or_else(|| PyDict::new(py)).unbind();
        Self { inner: Arc::new(Inner { case, path, is_file, given, run: OnceLock::new() }) }
    }

    /// Resolves a scene, which may name profiles of the dict `profiles`.
    fn resolved(
        py: Python<'_>,
        scene: Scene,
        folder: PathBuf,
        title: &str,
        profiles: Bound<'_, PyDict>,
    ) -> PyResult<Self> {
        let mut given = Given::new();
        for (name, profile) in &profiles {
            let Profile { profile, side, .. } = profile.cast::<Profile>()?.get();
            given.insert(name.extract()?, (*side, profile.clone()));
        }
        let (title, path) = (title.to_owned(), folder.clone());
        let case = waited(py, move |_| {
            scene::resolve_given(&scene, &folder, &title, &given).map_err(|error| error.within("scene"))
        })?;
        Self::warned(py, Self::of(py, case, path, false, Some(profiles)))
    }

    /// Warns of what is doubtful in the scene.
    fn warned(py: Python<'_>, case: Self) -> PyResult<Self> {
        let inner = &case.inner.case;
        warn(py, inner.doubts().iter().cloned())?;
        let said: Vec<String> = inner.doubts().iter().map(Doubt::to_string).collect();
        for warning in inner.warnings().iter().filter(|warning| !said.contains(warning)) {
            say(py, "measured", warning, "see `Case.warnings`")?;
        }
        Ok(case)
    }

    /// Gives the wheelset of a case and its position.
    fn wheelset(&self) -> PyResult<(&Arc<WheelsetOnTrack>, &Position)> {
        let case::Arrangement::Wheelset { system, position } = &self.inner.case.setup().arrangement else {
            let expected = "[track] and [wheelset]";
            let error =
                Error::new("sweep", "a single wheel", expected, "a sweep moves a wheelset over its track");
            return Err(exception(error));
        };
        self.inner.case.profiles().swept("take `march`").or_raise()?;
        Ok((system, position))
    }

    /// Gives everything computed from the case; the first call computes it.
    fn computed(&self, py: Python<'_>) -> PyResult<Arc<wheelrail::Run>> {
        if let Some(run) = self.inner.run.get() {
            return Ok(Arc::clone(run));
        }
        let case = self.inner.case.clone();
        let place = self.path().map_or_else(|| "scene".into(), |path| path.display().to_string());
        let run =
            waited(py, move |_| case::Run::new(case, case::SILENT).map_err(|error| error.within(place)))?;
        Ok(Arc::clone(self.inner.run.get_or_init(|| Arc::new(run))))
    }
}

/// Gives yaw and roll of a scene's position as arguments of a sweep.
fn own_angles<'py>(py: Python<'py>, position: &Position) -> PyResult<[Bound<'py, PyAny>; 2]> {
    let roll = match position.roll {
        Roll::Solve => "solve".into_pyobject(py)?.into_any(),
        Roll::Neglect => "neglect".into_pyobject(py)?.into_any(),
        Roll::Fixed(angle) => angle.into_pyobject(py)?.into_any(),
    };
    Ok([position.yaw.into_pyobject(py)?.into_any(), roll])
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
///     >>> run = wr.run("scene.toml", out="folder")  # doctest: +SKIP
///
/// Raises InputError for what is wrong with the scene; FileError where the disk refuses. A geometric "no" (an infeasible
/// contact, an empty patch) is no error: see `Run.refusals`.
#[pyfunction]
pub(crate) fn run(py: Python<'_>, path: PathBuf, out: PathBuf) -> PyResult<Bound<'_, PyAny>> {
    Case::new(py, path)?.run(py, out)
}

/// Return the JSON Schema of a scene, as a dict.
///
///     >>> "wheelset" in wr.schema()["properties"]
///     True
#[pyfunction]
pub(crate) fn schema(py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
    to_python(py, &scene::schema())
}

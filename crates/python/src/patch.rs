//! Contact patches.

use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use wheelrail::case::{
    self, Analysis, AskedPressure, Grid, Part, PartPressure, PlacedContact, Profiles, Run, Site, patch_mesh,
    patch_picture, quads,
};
use wheelrail::load::Largest;
use wheelrail::mesh::{Axes, GridGroup, StripCounts, StripMesh, groups};
use wheelrail::scene::{self, Scene};
use wheelrail::{Error, Placement};

use crate::arrays;
use crate::errors::{OrRaise, exception};
use crate::files::files;
use crate::long::waited;
use crate::values::{made, mesh, vectors};

/// Two axes of a grid.
type TwoAxes<'py> = (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>);

/// The patch s < approach of a contact: where rigid bodies would overlap. Lengths in mm.
///
///     >>> patch = contact.patch(load=60e3)
///     >>> patch
///     Patch(approach=0.082004, area=159.0855, 1 components)
///     >>> sorted(patch.files("ply"))
///     ['patch.ply', 'rail.ply', 'wheel.ply']
#[pyclass(frozen, module = "wheelrail")]
pub(crate) struct Patch {
    pub(crate) patch: wheelrail::Patch,
    pub(crate) placement: Placement,
    /// The contact, and what messages call it.
    pub(crate) contact: Py<PyAny>,
    pub(crate) name: String,
    pub(crate) load: Option<f64>,
    /// E* \[N/mm²\].
    pub(crate) modulus: f64,
}

impl Patch {
    /// Gives the axes of the solver's grid over the part of the patch around C.
    fn grid(&self, spacing: Option<[f64; 2]>) -> wheelrail::Result<Axes> {
        let groups = groups(&self.patch, 0.0, spacing);
        // The part that holds C, or else the first.
        let holds = |group: &&GridGroup| group.extent.xi.contains(0.0);
        let Some(group) = groups.iter().find(holds).or(groups.first()) else {
            let (found, expected) = ("an empty patch", "a patch that the axes can be sized by");
            return Err(Error::new("patch", found, expected, "give a larger approach, or axes of your own"));
        };
        group.axes(spacing)
    }

    fn title(&self) -> String {
        let [rail, wheel] =
            [self.placement.rail(), self.placement.wheel()].map(|body| body.profile().title());
        format!("{wheel} on {rail}")
    }

    /// Gives the contact alone over a grid.
    fn site(&self, Axes { xi, eta, .. }: Axes) -> wheelrail::Result<Site> {
        let contact = PlacedContact::new(self.placement.clone(), Some(self.patch.approach), self.modulus)?;
        let grid = Grid { xi, eta, warning: None, sigma: None, groups: Vec::new() };
        Ok(Site { folder: String::new(), contact, grid, normal_load: None })
    }

    /// Computes a run of the contact alone, from which files are written.
    fn run(&self, axes: Axes) -> wheelrail::Result<Run> {
        let (pair, placement) = (self.placement.pair(), &self.placement);
        let [rail_x, wheel_x] = [placement.rail(), placement.wheel()].map(|body| body.point().station.x);
        let scene: Scene =
            scene::parse(&format!("contact = {{ rail_x = {rail_x:?}, wheel_x = {wheel_x:?} }}"), false)?;
        let case = scene::with_profiles(&scene, Profiles::drawn(pair), &self.title())?;
        let site = self.site(axes)?;
        let analysis = Analysis::new(&site, case.question())?;
        Ok(Run { case, parts: vec![Part { site, analysis, warnings: Vec::new() }] })
    }
}

#[pymethods]
impl Patch {
    /// The approach, mm, as given or as estimated from the load.
    #[getter]
    fn approach(&self) -> f64 {
        self.patch.approach
    }

    /// The load, N, that the approach was estimated from; None for a given approach.
    #[getter]
    fn load(&self) -> Option<f64> {
        self.load
    }

    /// How the approach was estimated from the load: "half-space"; None for a given one.
    #[getter]
    fn estimate(&self) -> Option<&'static str> {
        self.load.map(|_| "half-space")
    }

    /// Area of all components, mm2.
    #[getter]
    fn area(&self) -> f64 {
        self.patch.area()
    }

    /// Length of all boundaries, mm.
    #[getter]
    fn perimeter(&self) -> f64 {
        self.patch.components.iter().map(|component| component.perimeter).sum()
    }

    /// The box around the patch ((xi_min, xi_max), (eta_min, eta_max)), mm; None for an empty patch.
    #[getter]
    fn extent(&self) -> Option<((f64, f64), (f64, f64))> {
        self.patch.extent().map(|window| (window.xi.ends().into(), window.eta.ends().into()))
    }

    /// The contact that it is the patch of.
    #[getter]
    fn contact(&self, py: Python<'_>) -> Py<PyAny> {
        self.contact.clone_ref(py)
    }

    /// The connected components, by ascending xi.
    #[getter]
    fn components<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyAny>>> {
        let component = |c: &wheelrail::Component| {
            let extent: ((f64, f64), (f64, f64)) = (c.xi.ends().into(), c.eta.ends().into());
            let deepest: (f64, f64, f64) = c.deepest.into();
            let holes =
                c.holes.iter().map(|points| arrays::points(py, points)).collect::<PyResult<Vec<_>>>()?;
            let boundary = arrays::points(py, &c.boundary)?;
            made(py, "Component", (c.area, c.perimeter, extent, deepest, boundary, holes))
        };
        self.patch.components.iter().map(component).collect()
    }

    /// The boundaries of all components: closed loops, float64 (n, 2), columns xi and eta in mm, the first point not
    /// repeated. Outer ones run counter-clockwise, those of holes clockwise.
    #[getter]
    fn loops<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyArray2<f64>>>> {
        let components = self.patch.components.iter();
        let loops = components.flat_map(|c| [&c.boundary].into_iter().chain(&c.holes));
        loops.map(|points| arrays::points(py, points)).collect()
    }

    /// Return the axes (xi, eta) of a solver's grid over the part of the patch around C: cell centres in mm, C among them, two
    /// empty rows on every side. `spacing` is one step in mm or (step in xi, step in eta); without it, 16 cells lie over the
    /// patch's shorter side.
    ///
    /// Raises InputError for an empty patch and a spacing that is not positive; LimitError for too many cells.
    #[pyo3(signature = (spacing = None))]
    fn axes<'py>(&self, py: Python<'py>, spacing: Option<GridStep>) -> PyResult<TwoAxes<'py>> {
        let axes = self.grid(spacing.map(GridStep::steps)).or_raise()?;
        Ok((arrays::array(py, axes.xi), arrays::array(py, axes.eta)))
    }

    /// Make the triangle mesh of the patch on the rail's surface, with the fields separation, overlap, rail_normal and wheel_normal,
    /// and of its cells component. `size` in mm is the length of its edges; the patch decides if it is None.
    ///
    /// Raises InputError for a size that is not positive; LimitError for too many triangles.
    #[pyo3(signature = (size = None))]
    fn mesh<'py>(&self, py: Python<'py>, size: Option<f64>) -> PyResult<Bound<'py, PyAny>> {
        let size = size.map(wheelrail::mesh::checked_size).transpose().or_raise()?;
        let (placement, patch) = (self.placement.clone(), self.patch.clone());
        let found = waited(py, move |_| patch_mesh(&placement, &patch, size))?;
        let (points, cells) = (PyDict::new(py), PyDict::new(py));
        let overlap = found.separation.iter().map(|s| self.patch.approach - s).collect();
        points.set_item("overlap", arrays::array(py, overlap))?;
        points.set_item("separation", arrays::array(py, found.separation))?;
        points.set_item("rail_normal", vectors(py, &found.rail_normals)?)?;
        points.set_item("wheel_normal", vectors(py, &found.wheel_normals)?)?;
        let component = found.mesh.component.iter().map(|component| *component as i64).collect();
        cells.set_item("component", PyArray1::<i64>::from_vec(py, component))?;
        mesh(py, &found.mesh.points, ("triangle", &found.mesh.triangles), (points, cells))
    }

    /// Make the boundary-fitted mesh of quadrangles in strips across the patch, with the fields area and component of its cells; a
    /// cell at a tip repeats a node.
    fn strips<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let counts = StripCounts::default();
        let (placement, patch) = (self.placement.clone(), self.patch.clone());
        let strips = waited(py, move |_| StripMesh::new(&placement, &patch, counts))?;
        let found = quads(&strips);
        let cells = PyDict::new(py);
        cells.set_item("area", arrays::array(py, found.area))?;
        let component = found.component.iter().map(|component| *component as i64).collect();
        cells.set_item("component", PyArray1::<i64>::from_vec(py, component))?;
        mesh(py, &found.points, ("quad", &found.quads), (PyDict::new(py), cells))
    }

    /// Solve the pressures over the grid of `axes(spacing)`, as of an elastic half-space without friction that this contact alone presses.
    ///
    /// `cell` in mm is the longest side of its cells: the grid's steps are divided by odd numbers. Without it they are divided by three,
    /// or by nine where the largest pressure may then err by more than 1 %; `largest_error` says what is left of that.
    ///
    /// Raises InputError for an empty patch and a side that is not positive; LimitError for more than a million cells.
    #[pyo3(signature = (cell = None, *, spacing = None))]
    fn pressure<'py>(
        &self,
        py: Python<'py>,
        cell: Option<f64>,
        spacing: Option<GridStep>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let cell = cell.map(scene::pressure_cell).transpose().or_raise()?;
        let site = self.grid(spacing.map(GridStep::steps)).and_then(|axes| self.site(axes)).or_raise()?;
        let (asked, modulus) = (AskedPressure { cell }, self.modulus);
        let [xi, eta] = [site.grid.xi.clone(), site.grid.eta.clone()];
        let found = waited(py, move |_| PartPressure::over_grid(&site, asked, modulus))?;
        let count = [xi.len(), eta.len()];
        let values = PyArray1::from_vec(py, found.field.unwrap_or_default()).reshape(count)?;
        let outline =
            found.outline.iter().map(|line| arrays::points(py, line)).collect::<PyResult<Vec<_>>>()?;
        let Largest { pressure_n_per_mm2, at_mm } = found.largest;
        let largest = (pressure_n_per_mm2, found.largest_error, (at_mm[0], at_mm[1]));
        let fields = (arrays::array(py, xi), arrays::array(py, eta), values);
        let rest = (found.contact_area, found.load, (found.cell[0], found.cell[1]), outline);
        made(
            py,
            "Pressure",
            (fields.0, fields.1, fields.2, largest.0, largest.1, largest.2, rest.0, rest.1, rest.2, rest.3),
        )
    }

    /// Return the files of one format as bytes by their names, as `Case.files` does, on the grid of `axes(spacing)`.
    ///
    /// Raises InputError for an unknown format, one that cannot hold the grid, and an empty patch.
    #[pyo3(signature = (format = None, *, spacing = None))]
    fn files<'py>(
        slf: &Bound<'py, Self>,
        format: Option<&str>,
        spacing: Option<GridStep>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let (py, own) = (slf.py(), slf.clone().unbind());
        let axes = own.get().grid(spacing.map(GridStep::steps)).or_raise()?;
        let run = waited(py, move |_| own.get().run(axes))?;
        files(py, format, move |format| case::files(&run, format))
    }

    fn __repr__(&self) -> String {
        format!(
            "Patch(approach={:.6}, area={:.4}, {} components)",
            self.patch.approach,
            self.patch.area(),
            self.patch.components.len()
        )
    }

    fn __eq__(&self, py: Python<'_>, other: &Self) -> PyResult<bool> {
        let same = self.patch.approach == other.patch.approach && self.load == other.load;
        Ok(same && self.contact.bind(py).eq(other.contact.bind(py))?)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, PatchParts)> {
        let make = py.import("wheelrail._wheelrail")?.getattr("patch_from_parts")?;
        Ok((make, (self.contact.clone_ref(py), self.patch.approach, self.load, self.modulus)))
    }

    fn _repr_svg_(&self, py: Python<'_>) -> PyResult<Option<String>> {
        let Ok(axes) = self.grid(None) else { return Ok(None) };
        let title = [self.title(), self.name.clone()];
        let (placement, patch) = (self.placement.clone(), self.patch.clone());
        let picture = waited(py, move |_| {
            let title = title.each_ref().map(String::as_str);
            Ok(patch_picture(title, &placement, &patch, [&axes.xi, &axes.eta]))
        })?;
        Ok(Some(picture))
    }

    /// Return the picture of the patch as SVG: both profiles, the gap, and the lines of equal separation with the boundary.
    ///
    /// Raises InputError for an empty patch.
    fn svg(&self, py: Python<'_>) -> PyResult<String> {
        let empty = || {
            let error =
                Error::new("patch", "an empty patch", "a patch that can be drawn", "give a larger approach");
            exception(error)
        };
        self._repr_svg_(py)?.ok_or_else(empty)
    }
}

/// Contact, approach, load and E*.
type PatchParts = (Py<PyAny>, f64, Option<f64>, f64);

/// Step of a grid in mm.
#[derive(FromPyObject)]
pub(crate) enum GridStep {
    Both(f64),
    Each([f64; 2]),
}

impl GridStep {
    fn steps(self) -> [f64; 2] {
        match self {
            Self::Both(step) => [step; 2],
            Self::Each(steps) => steps,
        }
    }
}

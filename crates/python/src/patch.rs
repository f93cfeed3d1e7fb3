//! Contact patches.

use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use wheelrail::case::approach_under_load;
use wheelrail::case::{ApproachBy, patch_picture};
use wheelrail::mesh::{Axes, GridGroup, groups};
use wheelrail::{Error, Placement, Window};

use crate::arrays;
use crate::errors::{OrRaise, exception};

/// Two axes of a grid.
type TwoAxes<'py> = (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>);

/// The patch s < approach of a contact: where rigid bodies would overlap. Lengths in mm.
#[pyclass(frozen, module = "wheelrail")]
pub(crate) struct Patch {
    patch: wheelrail::Patch,
    placement: Placement,
    /// The contact's name.
    contact: String,
    load: Option<f64>,
}

impl Patch {
    /// Finds the patch of a contact; `modulus` is E* \[N/mm²\].
    pub(crate) fn new(
        contact: &str,
        placement: &Placement,
        by: ApproachBy,
        modulus: f64,
    ) -> wheelrail::Result<Self> {
        let (approach, load) = match by {
            ApproachBy::Given(approach) => (approach, None),
            ApproachBy::WheelLoad(load)
            | ApproachBy::WheelLoads { right: load, .. }
            | ApproachBy::AxleLoad(load) => (approach_under_load(placement, load, modulus)?, Some(load)),
        };
        let patch = wheelrail::Patch::new(placement, approach, &Window::UNBOUNDED);
        Ok(Self { patch, placement: placement.clone(), contact: contact.into(), load })
    }

    /// Gives the axes of the solver's grid over the part of the patch around C.
    fn grid(&self, spacing: Option<[f64; 2]>) -> wheelrail::Result<Axes> {
        let groups = groups(&self.patch, 0.0, spacing);
        // The part that holds C, or else the first.
        let holds = |group: &&GridGroup| group.extent.xi[0] <= 0.0 && 0.0 <= group.extent.xi[1];
        let Some(group) = groups.iter().find(holds).or(groups.first()) else {
            let (found, expected) = ("an empty patch", "a patch that the axes can be sized by");
            return Err(Error::new("patch", found, expected, "give a larger approach, or axes of your own"));
        };
        group.axes(spacing)
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
        self.patch.extent().map(|window| (window.xi.into(), window.eta.into()))
    }

    /// The connected components, by ascending xi.
    #[getter]
    fn components(&self) -> Vec<Component> {
        self.patch.components.iter().cloned().map(|component| Component { component }).collect()
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
    fn axes<'py>(&self, py: Python<'py>, spacing: Option<Spacing>) -> PyResult<TwoAxes<'py>> {
        let axes = self.grid(spacing.map(Spacing::steps)).or_raise()?;
        Ok((arrays::array(py, axes.xi), arrays::array(py, axes.eta)))
    }

    fn __repr__(&self) -> String {
        format!(
            "Patch(approach={:.6}, area={:.4}, {} components)",
            self.patch.approach,
            self.patch.area(),
            self.patch.components.len()
        )
    }

    fn _repr_html_(&self) -> Option<String> {
        let axes = self.grid(None).ok()?;
        let [rail, wheel] = [self.placement.rail(), self.placement.wheel()].map(|body| &body.profile().name);
        let title = format!("{wheel} on {rail}");
        Some(patch_picture([&title, &self.contact], &self.placement, &self.patch, [&axes.xi, &axes.eta]))
    }

    /// Return the picture of the patch as SVG: both profiles, the gap, and the lines of equal separation with the boundary.
    ///
    /// Raises InputError for an empty patch.
    fn svg(&self) -> PyResult<String> {
        let empty = || {
            let error =
                Error::new("patch", "an empty patch", "a patch that can be drawn", "give a larger approach");
            exception(error)
        };
        self._repr_html_().ok_or_else(empty)
    }
}

/// Step of a grid in mm.
#[derive(FromPyObject)]
pub(crate) enum Spacing {
    Both(f64),
    Each([f64; 2]),
}

impl Spacing {
    fn steps(self) -> [f64; 2] {
        match self {
            Self::Both(step) => [step; 2],
            Self::Each(steps) => steps,
        }
    }
}

/// One connected component of a patch. Lengths in mm.
#[pyclass(frozen, module = "wheelrail")]
pub(crate) struct Component {
    component: wheelrail::Component,
}

#[pymethods]
impl Component {
    /// Area, mm2.
    #[getter]
    fn area(&self) -> f64 {
        self.component.area
    }

    /// Length of all its boundaries, mm.
    #[getter]
    fn perimeter(&self) -> f64 {
        self.component.perimeter
    }

    /// The box around it ((xi_min, xi_max), (eta_min, eta_max)), mm.
    #[getter]
    fn extent(&self) -> ((f64, f64), (f64, f64)) {
        (self.component.xi.into(), self.component.eta.into())
    }

    /// The least separation on it and its place: (s, xi, eta), mm.
    #[getter]
    fn deepest(&self) -> (f64, f64, f64) {
        self.component.deepest.into()
    }

    /// The outer boundary: a closed loop, float64 (n, 2), columns xi and eta in mm, counter-clockwise.
    #[getter]
    fn boundary<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        arrays::points(py, &self.component.boundary)
    }

    /// The boundaries of its holes: closed loops like `boundary`, clockwise. Only a skewed wheel makes holes.
    #[getter]
    fn holes<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyArray2<f64>>>> {
        self.component.holes.iter().map(|points| arrays::points(py, points)).collect()
    }

    fn __repr__(&self) -> String {
        let [a, b] = self.component.xi;
        format!("Component(area={:.4}, xi=({a:.4}, {b:.4}))", self.component.area)
    }
}

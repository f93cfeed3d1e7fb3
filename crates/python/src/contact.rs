//! One place of contact, and what follows from it.

use std::sync::OnceLock;

use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use wheelrail::case::{ApproachBy, check_method};
use wheelrail::conformal::{NormalGap, RailArcLength, fill_normal_gap};
use wheelrail::internal::MANY;
use wheelrail::load::{Curvatures, Ellipse, curvatures, feasibility};
use wheelrail::scene::{self, MaterialData, PatchData};
use wheelrail::search;
use wheelrail::separation::{EtaAxis, Method, Plan, plan};
use wheelrail::{Error, Placement};

use crate::arrays::{array, grid, values};
use crate::errors::{OrRaise, exception};
use crate::long::detached;
use crate::patch::Patch;
use crate::profile::Profile;

/// A place of contact of a rail and a wheel, in the axes of its own side: x towards the field side, y forward, z up; the
/// left side is the mirror image of a right one.
///
/// The contact frame has its origin at the contact point C, xi along the common tangent, eta along the rail, zeta along the
/// common normal from rail to wheel. Lengths in mm, angles in rad.
#[pyclass(frozen, module = "wheelrail")]
#[derive(Clone)]
pub(crate) struct Contact {
    name: String,
    /// Side and number of a contact that was found.
    place: Option<Place>,
    found: Option<search::Contact>,
    pair: wheelrail::Pair,
    /// Made when it is first asked for.
    placement: OnceLock<Placement>,
}

/// An array (n,).
type Axis<'py> = Bound<'py, PyArray1<f64>>;

/// Where a contact was found.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Place {
    pub(crate) side: &'static str,
    /// From 1.
    pub(crate) number: usize,
}

impl Contact {
    pub(crate) fn found(pair: &wheelrail::Pair, found: search::Contact, place: Place) -> Self {
        let name = format!("{} {}", place.side, place.number);
        Self { name, place: Some(place), found: Some(found), pair: pair.clone(), placement: OnceLock::new() }
    }

    pub(crate) fn placed(placement: Placement, name: String) -> Self {
        Self { name, place: None, found: None, pair: placement.pair(), placement: placement.into() }
    }

    pub(crate) fn placement(&self) -> PyResult<&Placement> {
        if let (None, Some(found)) = (self.placement.get(), &self.found) {
            let placement = found.placed(&self.pair).or_raise()?;
            return Ok(self.placement.get_or_init(|| placement));
        }
        self.placement.get().ok_or_else(|| {
            exception(Error::new(
                "contact",
                "no placement",
                "a contact that was found or placed",
                "report this",
            ))
        })
    }
}

#[pymethods]
impl Contact {
    /// What messages call it: side and number, or "chosen".
    #[getter]
    fn name(&self) -> &str {
        &self.name
    }

    /// "left" or "right" of a wheelset, "single" of a single wheel; None for a contact at chosen points.
    #[getter]
    fn side(&self) -> Option<&'static str> {
        self.place.map(|place| place.side)
    }

    /// Number of the contact on its side, from 1, by ascending gap; None for a contact at chosen points.
    #[getter]
    fn number(&self) -> Option<usize> {
        self.place.map(|place| place.number)
    }

    /// Angle of the common tangent in the rail's axes, rad, + counter-clockwise from x to z: about 1.2 at a flange.
    #[getter]
    fn contact_angle(&self) -> PyResult<f64> {
        match &self.found {
            Some(found) => Ok(found.contact_angle),
            None => Ok(self.placement()?.rail().contact_angle()),
        }
    }

    /// The contact point (x, z) on the rail profile, mm.
    #[getter]
    fn rail_point(&self) -> PyResult<(f64, f64)> {
        let station = match &self.found {
            Some(found) => return Ok((found.rail_x, found.rail_z)),
            None => self.placement()?.rail().point().station,
        };
        Ok((station.x, station.z))
    }

    /// The contact point (x, z) on the wheel profile, mm.
    #[getter]
    fn wheel_point(&self) -> PyResult<(f64, f64)> {
        let station = match &self.found {
            Some(found) => return Ok((found.wheel_x, found.wheel_z)),
            None => self.placement()?.wheel().point().station,
        };
        Ok((station.x, station.z))
    }

    /// Position along the rail, mm, + forward, from the vertical plane across the track through the wheel's centre; 0 for a
    /// contact at chosen points.
    #[getter]
    fn y(&self) -> f64 {
        self.found.map_or(0.0, |found| found.y)
    }

    /// Vertical gap left at first touch, mm: 0, or that of a near miss.
    #[getter]
    fn gap(&self) -> f64 {
        self.found.map_or(0.0, |found| found.gap)
    }

    /// Angle about the common normal from the rail's contact frame to the wheel's, rad: 0 without yaw.
    #[getter]
    fn skew(&self) -> PyResult<f64> {
        self.found.map_or_else(|| Ok(self.placement()?.skew()), |found| Ok(found.skew))
    }

    /// Distance from the axle to the contact point, mm.
    #[getter]
    pub(crate) fn rolling_radius(&self) -> PyResult<f64> {
        self.found.map_or_else(|| Ok(self.placement()?.rolling_radius()), |found| Ok(found.rolling_radius))
    }

    /// Whether a body touches with a kink, a step or an end: s has no curvatures there.
    #[getter]
    fn kink(&self) -> PyResult<bool> {
        let smooth = |placement: &Placement| placement.rail().is_smooth() && placement.wheel().is_smooth();
        self.found.map_or_else(|| Ok(!smooth(self.placement()?)), |found| Ok(found.kink()))
    }

    /// The profiles of the rail and of the wheel.
    #[getter]
    fn profiles(&self) -> (Profile, Profile) {
        (Profile::of(self.pair.rail()), Profile::of(self.pair.wheel()))
    }

    /// Compute the separation s(xi, eta) of the undeformed bodies over a grid, in mm, + apart: float64 (n_xi, n_eta), C
    /// order, NaN where a body has no surface. The bodies touch in C: s(0, 0) = 0, before any approach.
    ///
    /// `xi` and `eta` are ascending arrays in mm. `tolerance` in mm is the largest error allowed; at 1e-12 the relative
    /// accuracy near C is kept as well. `method` is "auto", which takes the cheapest, or one of "quadratic",
    /// "constant-radius", "parabolic", "spectral", "pointwise", "report-newton".
    ///
    /// The array is filled in place, on all threads and without the GIL; any number of threads gives the same bits.
    /// 200 x 200 points take some 50 microseconds.
    ///
    /// Raises InputError for axes that do not ascend, a tolerance that is not positive, and an unknown method; LimitError for
    /// more than 10**9 points; MemoryError where there is less memory.
    #[pyo3(signature = (xi, eta, *, tolerance = 1e-12, method = "auto"))]
    fn separation<'py>(
        &self,
        py: Python<'py>,
        xi: &Bound<'py, PyAny>,
        eta: &Bound<'py, PyAny>,
        tolerance: f64,
        method: &str,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let method = named_method(method)?;
        let [xi, eta] = checked_axes(("xi", xi), eta, tolerance)?;
        let placement = self.placement()?;
        check_method(placement, method).or_raise()?;
        let array = grid(py, [("xi", &xi), ("eta", &eta)])?;
        let mut values = array.try_readwrite()?;
        let out = values.as_slice_mut()?;
        let axis = EtaAxis::new(&eta);
        let mut plan = detached(py, || plan(placement, &xi, &axis, tolerance, method))?;
        fill(py, &mut plan, placement, (&xi, &axis), out)?;
        drop(values);
        Ok(array)
    }

    /// Compute the normal gap t(sigma, eta) along the rail's own turning normal, over the rail's surface, in mm, + apart: float64
    /// (n_sigma, n_eta), C order, NaN beyond the rail's surface and where the normal misses the wheel. It is for conformal
    /// contact: an approach delta along zeta closes delta*cos(alpha) of it.
    ///
    /// `sigma`, the arc length along the rail from C, + towards +xi, and `eta` are ascending arrays in mm; `tolerance` in mm is
    /// as of `separation`. The array is filled without the GIL.
    ///
    /// Raises InputError for axes that do not ascend and a tolerance that is not positive; LimitError for more than 10**9
    /// points; MemoryError where there is less memory.
    #[pyo3(signature = (sigma, eta, *, tolerance = 1e-12))]
    fn normal_gap<'py>(
        &self,
        py: Python<'py>,
        sigma: &Bound<'py, PyAny>,
        eta: &Bound<'py, PyAny>,
        tolerance: f64,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let [sigma, eta] = checked_axes(("sigma", sigma), eta, tolerance)?;
        let placement = self.placement()?;
        let array = grid(py, [("sigma", &sigma), ("eta", &eta)])?;
        let mut values = array.try_readwrite()?;
        let out = values.as_slice_mut()?;
        detached(py, || {
            fill_normal_gap(&NormalGap::new(placement), &sigma, &EtaAxis::new(&eta), tolerance, out)
        })?;
        drop(values);
        Ok(array)
    }

    /// Find the rail's points by their arc length `sigma` from C, mm: xi and zeta in mm and alpha in rad, the angle of the
    /// outward normal (-sin(alpha), cos(alpha)) from zeta; each (n_sigma,), NaN beyond the rail's surface.
    fn rail_surface<'py>(
        &self,
        py: Python<'py>,
        sigma: &Bound<'py, PyAny>,
    ) -> PyResult<(Axis<'py>, Axis<'py>, Axis<'py>)> {
        let rail = RailArcLength::new(self.placement()?);
        let nowhere = [f64::NAN; 3];
        let point =
            |&sigma: &f64| rail.point(sigma).map_or(nowhere, |at| [at.xi, at.zeta, at.sin.atan2(at.cos)]);
        let points: Vec<[f64; 3]> = values("sigma", sigma)?.iter().map(point).collect();
        Ok([0, 1, 2].map(|k| array(py, points.iter().map(|point| point[k]).collect())).into())
    }

    /// Compute Hertz's elliptic contact under a vertical load in N, which this contact carries alone, or an approach in mm; `modulus` is E* in N/mm2, steel on steel if
    /// None.
    ///
    /// Raises InputError for neither or both of load and approach; GeometryError where s is not convex at C, at kinks.
    #[pyo3(signature = (*, load = None, approach = None, modulus = None))]
    fn hertz(&self, load: Option<f64>, approach: Option<f64>, modulus: Option<f64>) -> PyResult<Hertz> {
        let (by, modulus) = asked(load, approach, modulus)?;
        let placement = self.placement()?;
        let (curvatures, cos) = (curvatures(placement), placement.rail().point().station.cos);
        let ellipse = match by {
            ApproachBy::Given(approach) => curvatures.under_approach(approach, modulus),
            ApproachBy::WheelLoad(load)
            | ApproachBy::WheelLoads { right: load, .. }
            | ApproachBy::AxleLoad(load) => curvatures.under_load(load / cos, modulus),
        };
        let no_ellipse = || {
            let expected = "a smooth contact at which the separation is convex, and a load";
            let error = Error::new("hertz", "no ellipse", expected, "use `patch` and `separation`");
            exception(error.of_kind(wheelrail::ErrorKind::Geometry))
        };
        ellipse.map(|ellipse| Hertz { ellipse, curvatures }).ok_or_else(no_ellipse)
    }

    /// Find the patch s < approach under an approach in mm, or under the approach that a vertical load in N, which this
    /// contact carries alone, is estimated to cause:
    /// its boundary, area and perimeter. `modulus` is E* in N/mm2, steel on steel if None.
    ///
    /// The patch is where rigid bodies would overlap: about twice the true contact area.
    ///
    /// Raises InputError for neither or both of load and approach, and a load that no approach carries.
    #[pyo3(signature = (*, load = None, approach = None, modulus = None))]
    fn patch(
        &self,
        py: Python<'_>,
        load: Option<f64>,
        approach: Option<f64>,
        modulus: Option<f64>,
    ) -> PyResult<Patch> {
        let (by, modulus) = asked(load, approach, modulus)?;
        let placement = self.placement()?;
        detached(py, || Patch::new(&self.name, placement, by, modulus))?.or_raise()
    }

    /// Tell whether the bodies nowhere overlap when they touch at this contact: (4.1) of the Report, with the least
    /// separation and where it is.
    ///
    /// Raises GeometryError for bodies that nowhere lie over each other.
    fn feasibility(&self, py: Python<'_>) -> PyResult<Feasibility> {
        let placement = self.placement()?;
        let found = detached(py, || feasibility(placement))?.ok_or_else(|| {
            let expected = "two profiles that lie over each other";
            let error = Error::new("contact", "no common xi", expected, "choose other contact points");
            exception(error.of_kind(wheelrail::ErrorKind::Geometry))
        })?;
        Ok(Feasibility {
            feasible: found.feasible,
            least_separation: found.least_separation_mm,
            at: (found.at_xi_mm, found.at_eta_mm),
        })
    }

    /// Make a Tamaas model of this contact under a load in N: see `wheelrail.tamaas.problem`, whose arguments it takes.
    #[pyo3(signature = (load, **options))]
    fn to_tamaas<'py>(
        slf: &Bound<'py, Self>,
        load: f64,
        options: Option<&Bound<'py, pyo3::types::PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let problem = slf.py().import("wheelrail.tamaas")?.getattr("problem")?;
        problem.call((slf, load), options)
    }

    fn __repr__(&self) -> PyResult<String> {
        let ((x, z), angle) = (self.rail_point()?, self.contact_angle()?);
        Ok(format!("Contact({:?}, rail_point=({x:.4}, {z:.4}), contact_angle={angle:.5})", self.name))
    }
}

/// Reads the axes of a grid \[mm\], and checks them and the tolerance.
fn checked_axes(
    (name, first): (&str, &Bound<'_, PyAny>),
    eta: &Bound<'_, PyAny>,
    tolerance: f64,
) -> PyResult<[Vec<f64>; 2]> {
    let (first, eta) = (values(name, first)?, values("eta", eta)?);
    scene::check_axis(name, &first).or_raise()?;
    scene::check_axis("eta", &eta).or_raise()?;
    if tolerance > 0.0 && tolerance.is_finite() {
        return Ok([first, eta]);
    }
    let (found, expected) = (tolerance.to_string(), "a positive length in mm");
    Err(exception(Error::new("tolerance", found, expected, "1e-12 gives all digits")))
}

/// Fills a grid. Methods and wheels that take microseconds a point are filled in parts, between which Ctrl-C is looked for.
fn fill(
    py: Python<'_>,
    plan: &mut Plan,
    placement: &Placement,
    (xi, axis): (&[f64], &EtaAxis),
    out: &mut [f64],
) -> PyResult<()> {
    /// Points of a part: below 0.1 s by the slowest method on one thread.
    const PART: usize = 1 << 20;
    let strips = plan.choice.method < Method::Pointwise && placement.skew() == 0.0;
    if strips || out.len() <= PART {
        return detached(py, || plan.fill(placement, xi, axis, out));
    }
    let columns = (PART / axis.eta().len()).next_multiple_of(MANY);
    for (xi, out) in xi.chunks(columns).zip(out.chunks_mut(columns * axis.eta().len())) {
        detached(py, || plan.fill(placement, xi, axis, out))?;
        py.check_signals()?;
    }
    Ok(())
}

fn named_method(name: &str) -> PyResult<Option<Method>> {
    if name == "auto" {
        return Ok(None);
    }
    Method::ALL.into_iter().find(|method| method.name() == name).map(Some).ok_or_else(|| {
        let names: Vec<&str> = ["auto"].into_iter().chain(Method::ALL.map(Method::name)).collect();
        let advice = scene::perhaps(name, &names);
        exception(Error::new("method", format!("\"{name}\""), format!("one of {}", names.join(", ")), advice))
    })
}

/// Checks a load \[N\] or approach \[mm\] and E* \[N/mm²\].
pub(crate) fn asked(
    load: Option<f64>,
    approach: Option<f64>,
    modulus: Option<f64>,
) -> PyResult<(ApproachBy, f64)> {
    scene::approach(&PatchData { load, approach, ..PatchData::default() })
        .or_raise()
        .and_then(|by| Ok((by, checked_modulus(modulus)?)))
}

/// Checks E* \[N/mm²\]; that of steel on steel if it is not given.
pub(crate) fn checked_modulus(modulus: Option<f64>) -> PyResult<f64> {
    let Some(modulus) = modulus else { return scene::modulus(&MaterialData::default()).or_raise() };
    if modulus > 0.0 && modulus.is_finite() {
        return Ok(modulus);
    }
    let expected = "a positive modulus in N/mm²";
    Err(exception(Error::new("modulus", modulus.to_string(), expected, "steel on steel has 113932")))
}

/// Return E* in N/mm2 of two bodies from Young's moduli in N/mm2 and Poisson's ratios; by default of steel.
///
/// Raises InputError for a modulus that is not positive and a ratio beyond (-1, 0.5].
#[pyfunction]
#[pyo3(signature = (*, rail = (2.1e5, 0.28), wheel = (2.1e5, 0.28)))]
pub(crate) fn effective_modulus(rail: (f64, f64), wheel: (f64, f64)) -> PyResult<f64> {
    let material = MaterialData {
        rail_youngs_modulus: rail.0,
        rail_poissons_ratio: rail.1,
        wheel_youngs_modulus: wheel.0,
        wheel_poissons_ratio: wheel.1,
    };
    scene::modulus(&material).or_raise()
}

/// Hertz's ellipse at a contact: half-axes in mm, approach in mm, load in N, pressures in N/mm2.
#[pyclass(frozen, module = "wheelrail")]
pub(crate) struct Hertz {
    ellipse: Ellipse,
    curvatures: Curvatures,
}

#[pymethods]
impl Hertz {
    /// Long semi-axis, mm.
    #[getter]
    fn long_semi_axis(&self) -> f64 {
        self.ellipse.a_mm
    }

    /// Short semi-axis, mm.
    #[getter]
    fn short_semi_axis(&self) -> f64 {
        self.ellipse.b_mm
    }

    /// Angle of the long axis from xi towards eta, rad, in (-pi/2, pi/2].
    #[getter]
    fn long_axis_angle(&self) -> f64 {
        self.curvatures.long_axis_rad
    }

    /// The semi-axes nearest to xi (across the rail) and to eta (along it), mm.
    #[getter]
    fn semi_axes(&self) -> (f64, f64) {
        self.curvatures.along(&self.ellipse).into()
    }

    /// Approach of the bodies, mm.
    #[getter]
    fn approach(&self) -> f64 {
        self.ellipse.approach_mm
    }

    /// Normal load, N.
    #[getter]
    fn load(&self) -> f64 {
        self.ellipse.load_n
    }

    /// Largest pressure, N/mm2.
    #[getter]
    fn max_pressure(&self) -> f64 {
        self.ellipse.pressure_n_per_mm2
    }

    /// Area of the ellipse, mm2.
    #[getter]
    fn area(&self) -> f64 {
        std::f64::consts::PI * self.ellipse.a_mm * self.ellipse.b_mm
    }

    fn __repr__(&self) -> String {
        let Ellipse { load_n, pressure_n_per_mm2, .. } = self.ellipse;
        let (xi, eta) = self.semi_axes();
        format!(
            "Hertz(load={load_n:.1}, max_pressure={pressure_n_per_mm2:.3}, semi_axes=({xi:.4}, {eta:.4}), \
             approach={:.6})",
            self.ellipse.approach_mm
        )
    }
}

/// Whether the bodies nowhere overlap at first touch.
#[pyclass(frozen, get_all, module = "wheelrail")]
pub(crate) struct Feasibility {
    /// Whether the least separation is 0, to rounding.
    feasible: bool,
    /// The least separation, mm, negative where the bodies overlap.
    least_separation: f64,
    /// (xi, eta) of it, mm.
    at: (f64, f64),
}

#[pymethods]
impl Feasibility {
    fn __bool__(&self) -> bool {
        self.feasible
    }

    fn __repr__(&self) -> String {
        let (xi, eta) = self.at;
        let feasible = if self.feasible { "True" } else { "False" };
        format!(
            "Feasibility(feasible={feasible}, least_separation={:e}, at=({xi:.4}, {eta:.4}))",
            self.least_separation
        )
    }
}

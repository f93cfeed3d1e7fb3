//! One place of contact, and what follows from it.

use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyTuple};
use wheelrail::case::{ApproachBy, approach_under_load, check_method, usual};
use wheelrail::conformal::{NormalGap, RailArcLength, fill_normal_gap};
use wheelrail::load::{Curvatures, Ellipse, curvatures, feasibility};
use wheelrail::mesh::{Surface, equal_steps};
use wheelrail::profile::Side;
use wheelrail::scene;
use wheelrail::separation::{EtaAxis, Evaluator, midplane_table, plan};
use wheelrail::{Error, Placement, Window};

use crate::arrays::{array, checked_shape, values};
use crate::asked::{asked, checked_modulus};
use crate::errors::{OrRaise, exception, warn};
use crate::filling::{PART, checked_axes, filled, named_method, part};
use crate::long::{detached, waited};
use crate::patch::Patch;
use crate::place::{ContactOrigin, FoundAt, PairContact, joined};
use crate::profile::Profile;
use crate::values::{made, mesh, vectors};

/// A place of contact of a rail and a wheel, in the axes of its own side: x towards the field side, y forward, z up; the
/// left side is the mirror image of a right one.
///
/// The contact frame has its origin at the contact point C, xi along the common tangent, eta along the rail, zeta along the
/// common normal from rail to wheel. Lengths in mm, angles in rad. A contact can be pickled and compared.
///
///     >>> contact = track.touch(lateral=3.0).right[0]
///     >>> contact
///     Contact("right 1", rail_point=(-12.6702, -0.6127), contact_angle=0.08980)
///     >>> contact.separation(np.linspace(-5, 5, 11), np.linspace(-8, 8, 17)).shape
///     (11, 17)
#[pyclass(frozen, module = "wheelrail")]
pub(crate) struct Contact {
    spot: PairContact,
}

/// An array (n,).
type AxisArray<'py> = Bound<'py, PyArray1<f64>>;

/// Two arrays (n, m, 3).
type NormalArrays<'py> = (Bound<'py, PyArray3<f64>>, Bound<'py, PyArray3<f64>>);

impl Contact {
    pub(crate) fn of(spot: PairContact) -> Self {
        Self { spot }
    }

    fn placement(&self) -> PyResult<&Placement> {
        self.spot.placement()
    }

    /// Checks a load \[N\] or an approach \[mm\], or takes the approach of the case, and E* \[N/mm²\]; warns of what is doubtful.
    fn asked(
        &self,
        py: Python<'_>,
        (load, approach, modulus): (Option<f64>, Option<f64>, Option<f64>),
    ) -> PyResult<(ApproachBy, f64)> {
        if let (None, None, Some(own)) = (load, approach, self.spot.approach) {
            return Ok((ApproachBy::Given(own), checked_modulus(py, modulus)?));
        }
        let asked = asked(py, load, approach, modulus)?;
        if let ApproachBy::Given(approach) = asked.0 {
            warn(py, usual::approach(self.spot.pair.rail(), approach, false))?;
        }
        Ok(asked)
    }
}

#[pymethods]
impl Contact {
    /// What messages call it: side and number, or "chosen".
    #[getter]
    fn name(&self) -> &str {
        &self.spot.name
    }

    /// "left" or "right" of a wheelset, "single" of a single wheel; None for a contact at chosen points.
    #[getter]
    fn side(&self) -> Option<&'static str> {
        self.spot.place.map(|place| place.side)
    }

    /// Number of the contact on its side, from 1, by ascending gap; None for a contact at chosen points.
    #[getter]
    fn number(&self) -> Option<usize> {
        self.spot.place.map(|place| place.number)
    }

    /// Angle of the common tangent in the rail's axes, rad, + counter-clockwise from x to z: about 1.2 at a flange.
    #[getter]
    fn contact_angle(&self) -> PyResult<f64> {
        match self.spot.search() {
            Some(found) => Ok(found.contact_angle),
            None => Ok(self.placement()?.rail().contact_angle()),
        }
    }

    /// The contact point (x, z) on the rail profile, mm.
    #[getter]
    fn rail_point(&self) -> PyResult<(f64, f64)> {
        let station = match self.spot.search() {
            Some(found) => return Ok((found.rail_x, found.rail_z)),
            None => self.placement()?.rail().point().station,
        };
        Ok((station.x, station.z))
    }

    /// The contact point (x, z) on the wheel profile, mm.
    #[getter]
    fn wheel_point(&self) -> PyResult<(f64, f64)> {
        let station = match self.spot.search() {
            Some(found) => return Ok((found.wheel_x, found.wheel_z)),
            None => self.placement()?.wheel().point().station,
        };
        Ok((station.x, station.z))
    }

    /// Position along the rail, mm, + forward, from the vertical plane across the track through the wheel's centre; 0 for a
    /// contact at chosen points.
    #[getter]
    fn y(&self) -> f64 {
        self.spot.y
    }

    /// Vertical gap left at first touch, mm: 0, or that of a near miss.
    #[getter]
    fn gap(&self) -> f64 {
        self.spot.gap
    }

    /// Approach of a case's contact, mm, as given or as estimated from the load; None for other contacts.
    #[getter]
    fn approach(&self) -> Option<f64> {
        self.spot.approach
    }

    /// Normal force, N, of a case's contact: its share of the load of its wheel or axle; None without a load.
    #[getter]
    fn normal_load(&self) -> Option<f64> {
        self.spot.normal_load
    }

    /// Angle about the common normal from the rail's contact frame to the wheel's, rad: 0 without yaw.
    #[getter]
    fn skew(&self) -> PyResult<f64> {
        self.spot.search().map_or_else(|| Ok(self.placement()?.skew()), |found| Ok(found.skew))
    }

    /// Distance from the axle to the contact point, mm.
    #[getter]
    fn rolling_radius(&self) -> PyResult<f64> {
        self.spot
            .search()
            .map_or_else(|| Ok(self.placement()?.rolling_radius()), |found| Ok(found.rolling_radius))
    }

    /// Whether a body touches with a kink, a step or an end: s has no curvatures there.
    #[getter]
    fn kink(&self) -> PyResult<bool> {
        let smooth = |placement: &Placement| placement.rail().is_smooth() && placement.wheel().is_smooth();
        self.spot.search().map_or_else(|| Ok(!smooth(self.placement()?)), |found| Ok(found.kink()))
    }

    /// The profiles of the rail and of the wheel.
    #[getter]
    fn profiles(&self) -> (Profile, Profile) {
        (Profile::of(self.spot.pair.rail(), Side::Rail), Profile::of(self.spot.pair.wheel(), Side::Wheel))
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
        let axis = EtaAxis::new(&eta);
        let mut plan = detached(py, || plan(placement, &xi, &axis, tolerance, method))?;
        let points = part(&plan, placement);
        filled(py, placement, (("xi", xi), axis), points, move |placement, xi, axis, out| {
            plan.fill(placement, xi, axis, out);
        })
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
        let (placement, axis) = (self.placement()?, EtaAxis::new(&eta));
        filled(py, placement, (("sigma", sigma), axis), PART, move |placement, sigma, axis, out| {
            fill_normal_gap(&NormalGap::new(placement), sigma, axis, tolerance, out);
        })
    }

    /// Find the rail's points by their arc length `sigma` from C, mm: xi and zeta in mm and alpha in rad, the angle of the
    /// outward normal (-sin(alpha), cos(alpha)) from zeta; each (n_sigma,), NaN beyond the rail's surface.
    fn rail_surface<'py>(
        &self,
        py: Python<'py>,
        sigma: &Bound<'py, PyAny>,
    ) -> PyResult<(AxisArray<'py>, AxisArray<'py>, AxisArray<'py>)> {
        let (placement, sigma) = (self.placement()?.clone(), values("sigma", sigma)?);
        let points: Vec<[f64; 3]> = waited(py, move |_| {
            let rail = RailArcLength::new(&placement);
            let nowhere = [f64::NAN; 3];
            let point =
                |&sigma: &f64| rail.point(sigma).map_or(nowhere, |at| [at.xi, at.zeta, at.sin.atan2(at.cos)]);
            Ok(sigma.iter().map(point).collect())
        })?;
        Ok([0, 1, 2].map(|k| array(py, points.iter().map(|point| point[k]).collect())).into())
    }

    /// Compute the outward unit normals of rail and wheel over a grid, in the contact frame: (rail, wheel), each float64 (n_xi,
    /// n_eta, 3), NaN where a body has no surface. `xi` and `eta` are as of `separation`.
    ///
    /// Raises InputError for axes that do not ascend; LimitError for more than 10**9 numbers.
    fn normals<'py>(
        &self,
        py: Python<'py>,
        xi: &Bound<'py, PyAny>,
        eta: &Bound<'py, PyAny>,
    ) -> PyResult<NormalArrays<'py>> {
        let [xi, eta] = checked_axes(("xi", xi), eta, 1.0)?;
        let placement = self.placement()?.clone();
        checked_shape([("xi", &xi), ("eta", &eta)], 2 * 3)?;
        let shape = [xi.len(), eta.len(), 3];
        let [rail, wheel] = waited(py, move |_| {
            let mut evaluator = Evaluator::new(&placement);
            let mut all = [const { Vec::new() }; 2];
            for (&xi, &eta) in xi.iter().flat_map(|xi| eta.iter().map(move |eta| (xi, eta))) {
                let normals = evaluator.normals(xi, eta);
                for (out, normal) in all.iter_mut().zip([normals.rail, normals.wheel]) {
                    out.extend(normal.map_or([f64::NAN; 3], |normal| [normal.x, normal.y, normal.z]));
                }
            }
            Ok(all)
        })?;
        Ok((array(py, rail).reshape(shape)?, array(py, wheel).reshape(shape)?))
    }

    /// Compute Hertz's elliptic contact under a vertical load in N, which this contact carries alone, or an approach in mm;
    /// `modulus` is E* in N/mm2, steel on steel if None. A case's contact has its own approach.
    ///
    /// Raises InputError for neither or both of load and approach; GeometryError where s is not convex at C, at kinks; warns of
    /// values in another unit.
    #[pyo3(signature = (*, load = None, approach = None, modulus = None))]
    fn hertz<'py>(
        &self,
        py: Python<'py>,
        load: Option<f64>,
        approach: Option<f64>,
        modulus: Option<f64>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (by, modulus) = self.asked(py, (load, approach, modulus))?;
        let placement = self.placement()?;
        let (curvatures, cos) = (curvatures(placement), placement.upright());
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
        hertz(py, &curvatures, &ellipse.ok_or_else(no_ellipse)?)
    }

    /// Find the patch s < approach under an approach in mm, or under the approach that a vertical load in N, which this
    /// contact carries alone, is estimated to cause: its boundary, area and perimeter. `modulus` is E* in N/mm2, steel on
    /// steel if None. A case's contact has its own approach.
    ///
    /// The patch is where rigid bodies would overlap: about twice the true contact area.
    ///
    /// Raises InputError for neither or both of load and approach, and a load that no approach carries; warns of values in
    /// another unit.
    #[pyo3(signature = (*, load = None, approach = None, modulus = None))]
    fn patch(
        slf: &Bound<'_, Self>,
        load: Option<f64>,
        approach: Option<f64>,
        modulus: Option<f64>,
    ) -> PyResult<Patch> {
        let (py, own) = (slf.py(), slf.get());
        let (by, modulus) = own.asked(py, (load, approach, modulus))?;
        let (approach, load) = match by {
            ApproachBy::Given(approach) => (approach, None),
            ApproachBy::WheelLoad(load)
            | ApproachBy::WheelLoads { right: load, .. }
            | ApproachBy::AxleLoad(load) => {
                let placement = own.placement()?.clone();
                let approach = waited(py, move |_| approach_under_load(&placement, load, modulus))?;
                warn(py, usual::approach(own.spot.pair.rail(), approach, true))?;
                (approach, Some(load))
            }
        };
        patch_from_parts(slf, approach, load, modulus)
    }

    /// Make meshes of both bodies around the contact over intervals of `xi` and `eta` in mm: (rail, wheel), with the fields
    /// separation and normal. `approach` in mm, if given, decides how fine they are.
    ///
    /// Raises InputError for intervals that do not ascend or are wider than the wheel.
    #[pyo3(signature = (xi, eta, *, approach = None))]
    fn surfaces<'py>(
        &self,
        py: Python<'py>,
        xi: [f64; 2],
        eta: [f64; 2],
        approach: Option<f64>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        scene::check_axis("xi", &xi).and_then(|()| scene::check_axis("eta", &eta)).or_raise()?;
        let placement = self.placement()?;
        let own = placement.clone();
        let [rail, wheel] =
            waited(py, move |_| Surface::around(&own, &Window { xi: xi.into(), eta: eta.into() }, approach))?;
        let surface = |surface: &Surface| {
            let fields = PyDict::new(py);
            fields.set_item("separation", array(py, surface.separations(placement)))?;
            fields.set_item("normal", vectors(py, &surface.normals)?)?;
            mesh(py, &surface.points, ("triangle", &surface.triangles()), (fields, PyDict::new(py)))
        };
        Ok((surface(&rail)?, surface(&wheel)?))
    }

    /// Return the Report's midplane table as text: the transformed parameters, and both heights and the gap at every `xi` in mm,
    /// 101 values over both bodies if None.
    #[pyo3(signature = (xi = None))]
    fn midsep(&self, py: Python<'_>, xi: Option<&Bound<'_, PyAny>>) -> PyResult<String> {
        let placement = self.placement()?;
        if let Some(varying) = placement.varying() {
            let expected = "bodies of one profile each, which have a midplane";
            return Err(exception(Error::new("contact", varying, expected, "take `separation`")));
        }
        let over = || placement.overlap().map_or_else(Vec::new, |over| equal_steps(over.low, over.high, 101));
        let xi = xi.map_or_else(|| Ok(over()), |xi| values("xi", xi))?;
        scene::check_axis("xi", &xi).or_raise()?;
        let placement = placement.clone();
        waited(py, move |_| Ok(midplane_table(&placement, &xi)))
    }

    /// Tell whether the bodies nowhere overlap when they touch at this contact: (4.1) of the Report, with the least
    /// separation and where it is.
    ///
    /// Raises GeometryError for bodies that nowhere lie over each other.
    fn feasibility<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let placement = self.placement()?.clone();
        let found = waited(py, move |_| Ok(feasibility(&placement)))?.ok_or_else(|| {
            let expected = "two profiles that lie over each other";
            let error = Error::new("contact", "no common xi", expected, "choose other contact points");
            exception(error.of_kind(wheelrail::ErrorKind::Geometry))
        })?;
        let at = (found.at_xi_mm, found.at_eta_mm);
        made(py, "Feasibility", (found.feasible, found.least_separation_mm, at))
    }

    /// Make a Tamaas model of this contact under a load in N: see `wheelrail.tamaas.problem`, whose arguments it takes.
    #[pyo3(signature = (load, **options))]
    fn to_tamaas<'py>(
        slf: &Bound<'py, Self>,
        load: f64,
        options: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let problem = slf.py().import("wheelrail.tamaas")?.getattr("problem")?;
        problem.call((slf, load), options)
    }

    fn __repr__(&self) -> PyResult<String> {
        let ((x, z), angle) = (self.rail_point()?, self.contact_angle()?);
        Ok(format!("Contact({:?}, rail_point=({x:.4}, {z:.4}), contact_angle={angle:.5})", self.spot.name))
    }

    fn __eq__(&self, py: Python<'_>, other: &Self) -> PyResult<bool> {
        self.spot.same(py, &other.spot)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let (found, chosen) = match &self.spot.origin {
            ContactOrigin::OfCase(case, number) => {
                let make = py.import("wheelrail._scene")?.getattr("contact_of")?;
                return Ok((make, (case.bind(py), *number).into_pyobject(py)?));
            }
            ContactOrigin::Found(found) => (Some(postcard::to_allocvec(found).map_err(lost)?), None),
            ContactOrigin::Chosen(points) => (None, Some(*points)),
        };
        let make = py.import("wheelrail._wheelrail")?.getattr("contact_from_parts")?;
        let pair = &self.spot.pair;
        let bodies = (self.profiles(), (pair.wheel_radius(), pair.roller_radius()));
        let place = self.spot.place.map(|place| (place.side, place.number));
        let found = found.map(|bytes| PyBytes::new(py, &bytes));
        Ok((make, (bodies, place, found, chosen).into_pyobject(py)?))
    }
}

/// Rail and wheel, and the radii of wheel and roller.
type BodiesAndRadii = ((Profile, Profile), (f64, Option<f64>));

/// Make a contact of its bodies, with its side and number and what a search found, or with the points that were chosen.
#[pyfunction]
#[pyo3(signature = (bodies, place, found, chosen))]
pub(crate) fn contact_from_parts(
    bodies: BodiesAndRadii,
    place: Option<(String, usize)>,
    found: Option<&[u8]>,
    chosen: Option<[f64; 3]>,
) -> PyResult<Contact> {
    let ((rail, wheel), (radius, roller)) = bodies;
    let pair = joined(rail.profile, wheel.profile, radius, roller).or_raise()?;
    if let Some([rail_x, wheel_x, skew]) = chosen {
        let placement = pair.placed(rail_x, wheel_x, skew).or_raise()?;
        return Ok(Contact::of(PairContact::chosen(placement, [rail_x, wheel_x, skew])));
    }
    let known = |name: &str| ["left", "right", "single"].into_iter().find(|known| *known == name);
    let parts = place.and_then(|(side, number)| Some(FoundAt { side: known(&side)?, number })).zip(found);
    let Some((place, found)) = parts else {
        let expected = "the parts of a pickled contact of this version";
        return Err(exception(Error::new("contact", "other parts", expected, "pickle it anew")));
    };
    Ok(Contact::of(PairContact::found(&pair, postcard::from_bytes(found).map_err(lost)?, place)))
}

fn lost(error: postcard::Error) -> PyErr {
    let expected = "the parts of a pickled contact of this version";
    exception(Error::new("contact", error.to_string(), expected, "pickle it anew"))
}

/// Make the patch of a contact under an approach in mm, which was estimated from a load in N; `modulus` is E* in N/mm2.
#[pyfunction]
#[pyo3(signature = (contact, approach, load, modulus))]
pub(crate) fn patch_from_parts(
    contact: &Bound<'_, Contact>,
    approach: f64,
    load: Option<f64>,
    modulus: f64,
) -> PyResult<Patch> {
    let (py, spot) = (contact.py(), &contact.get().spot);
    let (placement, name) = (spot.placement()?.clone(), spot.name.clone());
    let own = placement.clone();
    let patch = waited(py, move |_| Ok(wheelrail::Patch::new(&own, approach, &Window::UNBOUNDED)))?;
    let contact = contact.clone().into_any().unbind();
    Ok(Patch { patch, placement, contact, name, load, modulus })
}

/// Makes `wheelrail.Hertz` of an ellipse.
fn hertz<'py>(py: Python<'py>, curvatures: &Curvatures, ellipse: &Ellipse) -> PyResult<Bound<'py, PyAny>> {
    let Ellipse { a_mm, b_mm, approach_mm, load_n, pressure_n_per_mm2, .. } = *ellipse;
    let axes: (f64, f64) = curvatures.along(ellipse).into();
    made(py, "Hertz", (a_mm, b_mm, curvatures.long_axis_rad, axes, approach_mm, load_n, pressure_n_per_mm2))
}

//! Profiles.

use std::path::PathBuf;

use numpy::PyArray2;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use wheelrail::Error;
use wheelrail::measured::Options;
use wheelrail::profile::{Side, standards, trace};
use wheelrail::scene::{self, ProfileSource, Rotation};

use crate::arrays;
use crate::errors::{OrRaise, exception};
use crate::long::waited;
use crate::pictures;

/// A rail or wheel profile: a chain of lines, arcs and polynomials, x lateral towards the field side, z up, in mm.
///
/// Profiles are made by `rail`, `wheel` and `read_profile`. They cannot be changed; `rotated`, `shifted` and `mirrored`
/// make others. They can be pickled and compared: a copy gives the same bits.
#[pyclass(frozen, eq, module = "wheelrail")]
#[derive(Clone, PartialEq)]
pub(crate) struct Profile {
    pub(crate) profile: wheelrail::Profile,
    /// What was done to a measured one, as JSON.
    record: Option<String>,
}

impl Profile {
    pub(crate) fn of(profile: &wheelrail::Profile) -> Self {
        Self { profile: profile.clone(), record: None }
    }
}

/// Distance of the two sides of a joint, in roundings of the profile's extent, up to which they are one point.
const JOINT_ROUNDINGS: f64 = 64.0;

/// An angle in rad, or a ratio such as "1:40".
#[derive(FromPyObject)]
pub(crate) enum Turn {
    /// rad.
    Radians(f64),
    /// "1:n".
    Ratio(String),
}

#[pymethods]
impl Profile {
    /// Name of the standard, or of the file.
    #[getter]
    fn name(&self) -> &str {
        &self.profile.name
    }

    /// Where the numbers come from.
    #[getter]
    fn source(&self) -> &str {
        &self.profile.source
    }

    /// The larger side of the box around the profile, mm.
    #[getter]
    fn extent(&self) -> f64 {
        self.profile.extent()
    }

    /// What was read, decided, repaired and fitted, as a dict; None for a profile that was not measured.
    #[getter]
    fn record<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.record.as_ref().map(|text| py.import("json")?.getattr("loads")?.call1((text,))).transpose()
    }

    /// Return the profile turned about its origin, counter-clockwise seen with x to the right and z up: by an angle in
    /// rad, or by a ratio such as "1:40", which leans a right-hand rail towards the track's centre.
    ///
    /// Raises InputError for an angle that is not finite and a text that is no ratio.
    fn rotated(&self, angle: Turn) -> PyResult<Self> {
        let rotation = match angle {
            Turn::Radians(angle) => Rotation::Radians(angle),
            Turn::Ratio(text) => Rotation::Ratio(text),
        };
        let turn = rotation.turn().map_err(|error| error.within("rotated")).or_raise()?;
        Ok(self.moved(self.profile.rotated(turn)))
    }

    /// Return the profile moved by x and z, mm.
    ///
    /// Raises InputError for a number that is not finite.
    #[pyo3(signature = (x = 0.0, z = 0.0))]
    fn shifted(&self, x: f64, z: f64) -> PyResult<Self> {
        let finite = |value| wheelrail::error::finite("shifted", value).or_raise();
        Ok(self.moved(self.profile.shifted(finite(x)?, finite(z)?)))
    }

    /// Return the mirror image under x -> -x.
    fn mirrored(&self) -> Self {
        self.moved(self.profile.mirrored())
    }

    /// Return points of the profile from left to right, at most `step` mm apart along it, every joint among them, no point
    /// twice: float64 (n, 2), columns x and z in mm. A step of a drawing has both of its ends.
    ///
    /// Raises InputError for a step that is not positive, and one that makes more than 10**7 points.
    #[pyo3(signature = (step = 0.5))]
    fn points<'py>(&self, py: Python<'py>, step: f64) -> PyResult<Bound<'py, PyArray2<f64>>> {
        /// Points of a profile that anybody looks at.
        const MOST: f64 = 1e7;
        let least = 4.0 * self.profile.extent() / MOST;
        if step.is_nan() || step < least {
            let expected = format!("a step of {least:e} mm or more");
            return Err(exception(Error::new("points: step", step.to_string(), expected, "correct it")));
        }
        let marks = trace(&self.profile, step);
        let mut points: Vec<[f64; 2]> = marks.iter().map(|mark| [mark.station.x, mark.station.z]).collect();
        // Both sides of a smooth joint are one point, in spite of rounding.
        let joint = JOINT_ROUNDINGS * f64::EPSILON * self.profile.extent();
        points.dedup_by(|next, last| (next[0] - last[0]).hypot(next[1] - last[1]) <= joint);
        arrays::points(py, &points)
    }

    /// The number of segments of the chain.
    fn __len__(&self) -> usize {
        self.profile.segments().len()
    }

    fn __repr__(&self) -> String {
        format!("Profile({:?}, {} segments)", self.profile.name, self.profile.segments().len())
    }

    fn _repr_html_(&self) -> String {
        pictures::profile(&self.profile)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyBytes>,))> {
        let bytes = postcard::to_allocvec(&(&self.profile, &self.record)).map_err(damaged)?;
        let make = py.import("wheelrail._wheelrail")?.getattr("profile_from_bytes")?;
        Ok((make, (PyBytes::new(py, &bytes),)))
    }
}

impl Profile {
    /// Another place of the same profile.
    fn moved(&self, profile: wheelrail::Profile) -> Self {
        Self { profile, record: self.record.clone() }
    }
}

/// Make a profile from the bytes of a pickled one.
///
/// Raises InputError for bytes that are none.
#[pyfunction]
pub(crate) fn profile_from_bytes(bytes: &[u8]) -> PyResult<Profile> {
    let (profile, record) = postcard::from_bytes(bytes).map_err(damaged)?;
    Ok(Profile { profile, record })
}

fn damaged(error: postcard::Error) -> PyErr {
    let expected = "the bytes of a pickled profile of this version";
    exception(Error::new("profile", error.to_string(), expected, "pickle it anew"))
}

/// Return a built-in rail: upright, origin at the top of its crown.
///
/// Raises InputError for an unknown name, with the nearest known one.
#[pyfunction]
pub(crate) fn rail(name: &str) -> PyResult<Profile> {
    built_in(standards::rail(name), "rail_names")
}

/// Return a built-in wheel: right-hand, flange at negative x, origin where its standard has it.
///
/// Raises InputError for an unknown name, with the nearest known one.
#[pyfunction]
pub(crate) fn wheel(name: &str) -> PyResult<Profile> {
    built_in(standards::wheel(name), "wheel_names")
}

/// Gives a built-in profile; the error of an unknown name speaks of the function that has all names.
fn built_in(profile: wheelrail::Result<wheelrail::Profile>, names: &str) -> PyResult<Profile> {
    let with_names = |mut error: Error| {
        error.advice = format!("see `wheelrail.{names}()`, or read a file by `wheelrail.read_profile`");
        error
    };
    profile.map(|profile| Profile { profile, record: None }).map_err(with_names).or_raise()
}

/// Return the names of the built-in rails.
#[pyfunction]
pub(crate) fn rail_names() -> Vec<&'static str> {
    standards::rail_names().collect()
}

/// Return the names of the built-in wheels.
#[pyfunction]
pub(crate) fn wheel_names() -> Vec<&'static str> {
    standards::wheel_names().collect()
}

/// Read a profile from a file: measured points (MiniProf .ban .whl .mpt, SIMPACK .prr .prw, GENSYS .rail .wheel, text,
/// CSV), or segments (.toml, .json).
///
/// `side` is "rail" or "wheel", where the file does not say so. The other options are the keys of a measured file in a
/// scene, with the same words and defaults: format, columns, section, mirror, flip_z, unit, origin, gauge_height,
/// tape_distance, already_inclined, repair, curve, cutoff_wavelength, kink_angle, arc_tolerance.
///
/// Raises InputError for what is wrong with the file, its points or the options; FileError for a file that cannot be read.
#[pyfunction]
#[pyo3(signature = (path, side = None, **options))]
pub(crate) fn read_profile(
    py: Python<'_>,
    path: PathBuf,
    side: Option<&str>,
    options: Option<&Bound<'_, PyDict>>,
) -> PyResult<Profile> {
    let side = side.map(named_side).transpose()?;
    let options = measured_options(py, options)?;
    waited(py, move |_| {
        Ok(match scene::read_profile(&path, side, &options)? {
            ProfileSource::Drawn(profile) => Profile { profile, record: None },
            ProfileSource::Measured(measured) => {
                let record = serde_json::to_string(&measured.record).ok();
                Profile { profile: measured.profile, record }
            }
        })
    })
}

fn named_side(name: &str) -> PyResult<Side> {
    match name {
        "rail" => Ok(Side::Rail),
        "wheel" => Ok(Side::Wheel),
        _ => Err(exception(Error::new("side", format!("\"{name}\""), "\"rail\" or \"wheel\"", "correct it"))),
    }
}

/// Takes keywords for the keys of a scene: by way of JSON, which knows their words.
fn measured_options(py: Python<'_>, options: Option<&Bound<'_, PyDict>>) -> PyResult<Options> {
    let Some(options) = options else { return Ok(Options::default()) };
    let text: String = py.import("json")?.getattr("dumps")?.call1((options,))?.extract()?;
    scene::parse(&text, true).map_err(|error| error.at("read_profile")).or_raise()
}

/// Makes Python's dicts and lists of a value, by way of JSON.
pub(crate) fn to_python<'py>(py: Python<'py>, value: &impl serde::Serialize) -> PyResult<Bound<'py, PyAny>> {
    let text = serde_json::to_string(value).unwrap_or_default();
    py.import("json")?.getattr("loads")?.call1((text,))
}

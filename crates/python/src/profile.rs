//! Profiles.

use std::hash::{Hash, Hasher};
use std::path::PathBuf;
use std::sync::Arc;

use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyString};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use wheelrail::case::{about_profile, profile_picture, usual};
use wheelrail::error::finite;
use wheelrail::measured::{self, Format, Measured, Options, write};
use wheelrail::nalgebra::{Point2, UnitComplex};
use wheelrail::profile::{Mark, Side, trace};
use wheelrail::scene::{self, ProfileSource, Rotation};
use wheelrail::{Error, files};

use crate::arrays;
use crate::errors::{OrRaise, exception, say, warn, warn_of_points};
use crate::long::waited;
use crate::text::{parsed, to_json, to_python};

/// A rail or wheel profile: a chain of lines, arcs and polynomials, x lateral towards the field side, z up, in mm.
///
/// Profiles are made by `rail`, `wheel`, `read_profile`, `Profile.from_points` and `Profile.from_segments`. They cannot be
/// changed; `rotated`, `shifted` and `mirrored` make others. They can be pickled, compared and hashed: a copy gives the same
/// bits.
///
///     >>> rail = wr.rail("60E1").rotated("1:40")
///     >>> rail
///     Profile("60E1", 7 segments)
///     >>> rail.points(step=0.5).shape[1]
///     2
#[pyclass(frozen, eq, hash, from_py_object, module = "wheelrail")]
#[derive(Clone)]
pub(crate) struct Profile {
    pub(crate) profile: wheelrail::Profile,
    /// The body, where it is known.
    pub(crate) side: Option<Side>,
    fitted: Option<Arc<MeasuredFacts>>,
}

/// What is known of a measured profile.
#[derive(Clone, Serialize, Deserialize)]
struct MeasuredFacts {
    /// What was done, as JSON.
    record: String,
    /// The record in one line.
    about: String,
    /// The points \[mm\] in the profile's axes.
    points: Vec<[f64; 2]>,
}

impl PartialEq for Profile {
    fn eq(&self, other: &Self) -> bool {
        self.profile == other.profile
    }
}

impl Hash for Profile {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.profile.name.hash(state);
        for segment in self.profile.segments() {
            let end = segment.end();
            // 0 and −0 are equal.
            [end.x, end.z].map(|value| (value + 0.0).to_bits()).hash(state);
        }
    }
}

/// Distance of the two sides of a joint, in roundings of the profile's extent, up to which they are one point.
const JOINT_ROUNDINGS: f64 = 64.0;

/// Two arrays (n,).
type TwoColumns<'py> = (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>);

/// An angle in rad, or a ratio such as "1:40".
#[derive(FromPyObject)]
pub(crate) enum AngleOrRatio {
    /// rad.
    Radians(f64),
    /// "1:n".
    Ratio(String),
}

#[pymethods]
impl Profile {
    /// Make a profile of measured points: `x` and `z`, arrays (n,) in the order along the profile.
    ///
    /// `side` is "rail" or "wheel", `name` what messages call it. The other options are those of `read_profile` for a text
    /// file, under the same names: unit, mirror, flip_z, origin, gauge_height, tape_distance, already_inclined, repair, curve,
    /// cutoff_wavelength, kink_angle, arc_tolerance. Axes that the shape does not prove have to be given.
    ///
    ///     >>> x, z = wr.wheel("S1002").points(0.2).T
    ///     >>> worn = wr.Profile.from_points(x, z + 0.3 * np.exp(-(x / 20) ** 2), side="wheel", cutoff_wavelength=5.0)
    ///
    /// Raises InputError for what is wrong with the points or the options; warns of what it doubts in the points.
    #[staticmethod]
    #[pyo3(signature = (x, z, *, side, name = "points", **options))]
    fn from_points(
        py: Python<'_>,
        x: &Bound<'_, PyAny>,
        z: &Bound<'_, PyAny>,
        side: &str,
        name: &str,
        options: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let (x, z) = (arrays::values("x", x)?, arrays::values("z", z)?);
        if x.len() != z.len() {
            let found = format!("{} values beside {} of x", z.len(), x.len());
            return Err(exception(Error::new("z", found, "arrays of one length", "correct it")));
        }
        let (side, options): (_, Options) = (named_side(side)?, keywords(py, "from_points", options)?);
        let points: Vec<[f64; 2]> = x.into_iter().zip(z).map(|(x, z)| [x, z]).collect();
        let name = name.to_owned();
        let measured = waited(py, move |_| measured::of_points(&name, &points, side, &options))?;
        Self::measured(py, measured, Some(side))
    }

    /// Make a profile of segments in order of x: dicts with one of `line`, `arc` and `polynomial`, as scenes and profile files
    /// write them.
    ///
    /// `start`, the first point (x, z), and `unit` are as in a scene. `side` is "rail" or "wheel".
    ///
    ///     >>> crown = wr.Profile.from_segments(
    ///     ...     [{"arc": {"center": [0.0, -300.0], "radius": 300.0, "half": "upper", "x": [-30.0, 30.0]}}], side="rail")
    ///     >>> len(crown)
    ///     1
    ///
    /// Raises InputError for what is wrong with the segments; warns of kinks.
    #[staticmethod]
    #[pyo3(signature = (segments, *, start = None, unit = None, side = None, name = "segments"))]
    fn from_segments(
        py: Python<'_>,
        segments: &Bound<'_, PyAny>,
        start: Option<&Bound<'_, PyAny>>,
        unit: Option<&str>,
        side: Option<&str>,
        name: &str,
    ) -> PyResult<Self> {
        let side = side.map(named_side).transpose()?;
        let file = PyDict::new(py);
        file.set_item("segments", segments)?;
        file.set_item("name", name)?;
        if let Some(start) = start {
            file.set_item("start", start)?;
        }
        if let Some(unit) = unit {
            file.set_item("unit", unit)?;
        }
        let text = to_json(file.as_any(), None)?;
        let made = scene::profile_from_text("", &text, true);
        let profile = made.map_err(|error| crate::text::keyed(&text, error)).or_raise()?;
        warn(py, usual::kinks(name, &profile))?;
        Ok(Self { profile, side, fitted: None })
    }

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

    /// "rail" or "wheel"; None where nothing said so.
    #[getter]
    fn side(&self) -> Option<&'static str> {
        self.side.map(|side| if side == Side::Rail { "rail" } else { "wheel" })
    }

    /// The larger side of the box around the profile, mm.
    #[getter]
    fn extent(&self) -> f64 {
        self.profile.extent()
    }

    /// What was read, decided, repaired and fitted, as a dict; None for a profile that was not measured.
    #[getter]
    fn record<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let record = self.fitted.as_ref().map(|fitted| &fitted.record);
        record.map(|text| py.import("json")?.getattr("loads")?.call1((text,))).transpose()
    }

    /// Joints of the segments from left to right, as dicts: `left` (number of the segment, from 0), `x` and `gap` in mm, `kink` in
    /// rad and `curvature_jump` in 1/mm.
    #[getter]
    fn joints<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        to_python(py, &self.profile.continuity())
    }

    /// Return the profile turned about its origin, counter-clockwise seen with x to the right and z up: by an angle in
    /// rad, or by a ratio such as "1:40", which leans a right-hand rail towards the track's centre.
    ///
    /// Raises InputError for an angle that is not finite and a text that is no ratio; warns of turns that are no inclination.
    fn rotated(&self, py: Python<'_>, angle: AngleOrRatio) -> PyResult<Self> {
        let rotation = match angle {
            AngleOrRatio::Radians(angle) => Rotation::Radians(angle),
            AngleOrRatio::Ratio(text) => Rotation::Ratio(text),
        };
        let turn = rotation.turn().map_err(|error| error.within("rotated")).or_raise()?;
        let written = if let Rotation::Radians(angle) = rotation { angle } else { turn.angle() };
        warn(py, usual::turn("rotated", written, self.side == Some(Side::Rail)))?;
        Ok(self.moved(self.profile.rotated(turn), |[x, z]| turned(turn, [x, z])))
    }

    /// Return the profile moved by x and z, mm.
    ///
    /// Raises InputError for a number that is not finite.
    #[pyo3(signature = (x = 0.0, z = 0.0))]
    fn shifted(&self, x: f64, z: f64) -> PyResult<Self> {
        let (x, z) = (finite("x", x).or_raise()?, finite("z", z).or_raise()?);
        Ok(self.moved(self.profile.shifted(x, z), |[a, b]| [a + x, b + z]))
    }

    /// Return the mirror image under x -> -x.
    fn mirrored(&self) -> Self {
        self.moved(self.profile.mirrored(), |[x, z]| [-x, z])
    }

    /// Return points of the profile from left to right, at most `step` mm apart along it, every joint among them, no point
    /// twice: float64 (n, 2), columns x and z in mm. A step of a drawing has both of its ends.
    ///
    /// Raises InputError for a step that is not positive, and one that makes more than 10**7 points.
    #[pyo3(signature = (step = 0.5))]
    fn points<'py>(&self, py: Python<'py>, step: f64) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let marks = self.marks(py, step)?;
        let mut points: Vec<[f64; 2]> = marks.iter().map(|mark| [mark.station.x, mark.station.z]).collect();
        // Both sides of a smooth joint are one point, in spite of rounding.
        let joint = JOINT_ROUNDINGS * f64::EPSILON * self.profile.extent();
        points.dedup_by(|next, last| (next[0] - last[0]).hypot(next[1] - last[1]) <= joint);
        arrays::points(py, &points)
    }

    /// Return the curvature along the profile: (s, curvature), each (n,), s the arc length from the left end in mm, at most `step`
    /// mm apart, curvature in 1/mm, positive with the hollow side up. Joints are there twice, with the curvature of each side.
    ///
    /// Raises InputError as `points` does.
    #[pyo3(signature = (step = 0.5))]
    fn curvature<'py>(&self, py: Python<'py>, step: f64) -> PyResult<TwoColumns<'py>> {
        let marks = self.marks(py, step)?;
        let column = |value: fn(&Mark) -> f64| arrays::array(py, marks.iter().map(value).collect());
        Ok((column(|mark| mark.s), column(|mark| mark.curvature)))
    }

    /// Return the segments as dicts, which `from_segments` takes; side faces are cut off where they are vertical, with a warning.
    ///
    /// Raises InputError for what is no graph z(x): undercuts, and measured profiles but those read with `curve="arcs"`.
    fn segments<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let write::Segments { segments, cut } = write::segments(&self.profile).or_raise()?;
        left_out(py, &cut)?;
        to_python(py, &segments)
    }

    /// Write the profile as the text of a file: points in the `format` "miniprof", "simpack", "gensys", "text", "csv" or "vampire", or segments
    /// as "toml".
    ///
    /// The points are the measured ones, or `step` mm apart along the curve (0.2 for a drawn profile). `side` is needed for the
    /// axes of MiniProf and SIMPACK where the profile has none.
    ///
    /// Raises InputError for an unknown format and for segments that no file can hold.
    #[pyo3(signature = (format, *, step = None, side = None))]
    fn to_text(
        &self,
        py: Python<'_>,
        format: &str,
        step: Option<f64>,
        side: Option<&str>,
    ) -> PyResult<String> {
        self.text(py, file_format(py, format)?, step, side)
    }

    /// Write the profile into a file that `read_profile` reads, as `to_text` does; without a `format` the extension tells.
    ///
    /// Raises InputError for an unknown format or extension and for segments that no file can hold; FileError where the disk
    /// refuses.
    #[pyo3(signature = (path, *, format = None, step = None, side = None))]
    fn to_file(
        &self,
        py: Python<'_>,
        path: PathBuf,
        format: Option<&str>,
        step: Option<f64>,
        side: Option<&str>,
    ) -> PyResult<()> {
        let toml = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml"));
        let format = match format {
            Some(format) => file_format(py, format)?,
            None if toml => None,
            None => Some(Format::of_file(&path.to_string_lossy()).or_raise()?),
        };
        files::write_file(&path, self.text(py, format, step, side)?.as_bytes()).or_raise()
    }

    /// Return the picture of the profile as SVG: points, curve and curvature, and how far measured points are off the curve.
    fn svg(&self) -> String {
        let drawn = || about_profile(&self.profile, None);
        let (about, points) = self.fitted.as_ref().map_or_else(
            || (drawn(), [].as_slice()),
            |fitted| (fitted.about.clone(), fitted.points.as_slice()),
        );
        profile_picture(&self.profile, &about, points)
    }

    fn _repr_svg_(&self) -> String {
        self.svg()
    }

    /// The number of segments of the chain.
    fn __len__(&self) -> usize {
        self.profile.segments().len()
    }

    fn __repr__(&self) -> String {
        format!("Profile({:?}, {} segments)", self.profile.name, self.profile.segments().len())
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyBytes>,))> {
        let wheel = self.side.map(|side| side == Side::Wheel);
        let bytes =
            postcard::to_allocvec(&(&self.profile, wheel, self.fitted.as_deref())).map_err(damaged)?;
        let make = py.import("wheelrail._wheelrail")?.getattr("profile_from_bytes")?;
        Ok((make, (PyBytes::new(py, &bytes),)))
    }
}

impl Profile {
    /// Makes a profile of which only the body is known.
    pub(crate) fn of(profile: &wheelrail::Profile, side: Side) -> Self {
        Self { profile: profile.clone(), side: Some(side), fitted: None }
    }

    /// Writes the profile in a format of points, or as TOML of its segments for `None`.
    fn text(
        &self,
        py: Python<'_>,
        format: Option<Format>,
        step: Option<f64>,
        side: Option<&str>,
    ) -> PyResult<String> {
        let Some(format) = format else {
            let (text, cut) = write::chain(&self.profile).or_raise()?;
            left_out(py, &cut)?;
            return Ok(text);
        };
        let side = side.map(named_side).transpose()?.or(self.side);
        let measured = self.fitted.as_ref().map(|fitted| fitted.points.as_slice());
        let (text, near) = write::profile(&self.profile, (measured, step), (format, side)).or_raise()?;
        if near > 0 {
            left_out(py, &[format!("{near} points nearer than {} mm to another", write::LEAST_DISTANCE)])?;
        }
        Ok(text)
    }

    /// Returns a value of the record of measured points; null without one.
    pub(crate) fn recorded(&self, key: &str) -> serde_json::Value {
        let fitted = self.fitted.as_ref();
        let record = fitted.and_then(|fitted| serde_json::from_str(&fitted.record).ok());
        record.map_or(serde_json::Value::Null, |mut record: serde_json::Value| record[key].take())
    }

    /// Takes over a measured profile, and warns of what was found in its points.
    pub(crate) fn measured(py: Python<'_>, measured: Measured, side: Option<Side>) -> PyResult<Self> {
        let Measured { profile, points, record } = measured;
        warn_of_points(py, &record.warnings)?;
        let fitted = MeasuredFacts {
            about: about_profile(&profile, Some(&record)),
            record: serde_json::to_string(&record).unwrap_or_default(),
            points: points.iter().map(measured::Point::xz).collect(),
        };
        Ok(Self { profile, side, fitted: Some(Arc::new(fitted)) })
    }

    /// Makes the moved profile, with the measured points moved by `point`.
    fn moved(&self, profile: wheelrail::Profile, point: impl Fn([f64; 2]) -> [f64; 2]) -> Self {
        let moved = |fitted: &Arc<MeasuredFacts>| {
            let points = fitted.points.iter().copied().map(&point).collect();
            Arc::new(MeasuredFacts { points, ..MeasuredFacts::clone(fitted) })
        };
        Self { profile, side: self.side, fitted: self.fitted.as_ref().map(moved) }
    }

    /// Gives marks along the profile, at most `step` \[mm\] apart.
    fn marks(&self, py: Python<'_>, step: f64) -> PyResult<Vec<Mark>> {
        /// Largest number of points of a profile.
        const MOST: f64 = 1e7;
        let least = 4.0 * self.profile.extent() / MOST;
        if step.is_nan() || step < least {
            let expected = format!("a step of {least:e} mm or more");
            return Err(exception(Error::new("step", step.to_string(), expected, "correct it")));
        }
        let profile = self.profile.clone();
        waited(py, move |_| Ok(trace(&profile, step)))
    }
}

fn turned(turn: UnitComplex<f64>, [x, z]: [f64; 2]) -> [f64; 2] {
    (turn * Point2::new(x, z)).into()
}

/// Warns of parts of a profile that a file or a list of segments does not have.
fn left_out(py: Python<'_>, parts: &[String]) -> PyResult<()> {
    let advice = "they are in the profile, and not in what was written";
    parts.iter().try_for_each(|part| say(py, "left-out", &format!("left out, {part}"), advice))
}

/// Make a profile from the bytes of a pickled one.
///
/// Raises InputError for bytes that are none.
#[pyfunction]
pub(crate) fn profile_from_bytes(bytes: &[u8]) -> PyResult<Profile> {
    let (profile, wheel, fitted): (_, Option<bool>, Option<MeasuredFacts>) =
        postcard::from_bytes(bytes).map_err(damaged)?;
    let side = wheel.map(|wheel| if wheel { Side::Wheel } else { Side::Rail });
    Ok(Profile { profile, side, fitted: fitted.map(Arc::new) })
}

fn damaged(error: postcard::Error) -> PyErr {
    let expected = "the bytes of a pickled profile of this version";
    exception(Error::new("profile", error.to_string(), expected, "pickle it anew"))
}

/// Read a profile from a file: measured points (MiniProf .ban .whl .mpt, SIMPACK .prr .prw, GENSYS .rail .wheel, Vampire .rai .whe,
/// slices .slcs .slcw, text, CSV), or segments (.toml, .json).
///
/// `side` is "rail" or "wheel", where the file does not say so. The other options are the keys of a measured file in a
/// scene, with the same words and defaults: format, columns, section, along, angle, mirror, flip_z, unit, origin,
/// gauge_height, tape_distance, already_inclined, repair, curve, cutoff_wavelength, kink_angle, arc_tolerance.
///
///     >>> worn = wr.read_profile("worn.whl", cutoff_wavelength=5.0)  # doctest: +SKIP
///
/// Raises InputError for what is wrong with the file, its points or the options; FileError for a file that cannot be read;
/// warns of what it doubts in the points.
#[pyfunction]
#[pyo3(signature = (path, side = None, **options))]
pub(crate) fn read_profile(
    py: Python<'_>,
    path: PathBuf,
    side: Option<&str>,
    options: Option<&Bound<'_, PyDict>>,
) -> PyResult<Profile> {
    let side = side.map(named_side).transpose()?;
    let options: Options = keywords(py, "read_profile", options)?;
    let named = side.or_else(|| Format::body_of_file(&path.to_string_lossy()));
    match waited(py, move |_| scene::read_profile(&path, side, &options))? {
        ProfileSource::Drawn(profile) => Ok(Profile { profile, side: named, fitted: None }),
        ProfileSource::Measured(measured) => Profile::measured(py, *measured, named),
    }
}

/// Reads the name of a format of files; `None` stands for TOML.
fn file_format(py: Python<'_>, name: &str) -> PyResult<Option<Format>> {
    if name == "toml" { Ok(None) } else { parsed("format", PyString::new(py, name).as_any()).map(Some) }
}

pub(crate) fn named_side(name: &str) -> PyResult<Side> {
    match name {
        "rail" => Ok(Side::Rail),
        "wheel" => Ok(Side::Wheel),
        _ => Err(exception(Error::new("side", format!("\"{name}\""), "\"rail\" or \"wheel\"", "correct it"))),
    }
}

/// Takes keywords for options.
pub(crate) fn keywords<T: Default + DeserializeOwned + Serialize>(
    py: Python<'_>,
    function: &str,
    options: Option<&Bound<'_, PyDict>>,
) -> PyResult<T> {
    let Some(options) = options else { return Ok(T::default()) };
    // A keyword that is None counts as not given.
    let given = PyDict::new(py);
    for (key, value) in options.iter().filter(|(_, value)| !value.is_none()) {
        given.set_item(key, value)?;
    }
    parsed(function, given.as_any())
}

//! Measures of profiles.

use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use wheelrail::measure::{
    AveragePoint, MeasureOptions, MeasureRow, PointNoise, RowColumns, average, measure, measure_noisy,
    repeated,
};
use wheelrail::measured::{CurveKind, Options, StatedValue, of_points};
use wheelrail::{Error, Side};

use crate::errors::exception;
use crate::long::waited;
use crate::profile::{Profile, keywords, named_side};
use crate::text::to_python;

/// Measure a wheel or rail: flange height and thickness, wear against a `nominal` profile, groove. Return a dict with the columns of
/// `wheelrail profile measure --csv` as keys; None for what cannot be had, and under "finding" why.
///
/// `side` is "rail" or "wheel", where the profile does not know it. `noise` is the standard deviation of the points across the profile
/// in mm, of points every `step` mm: the dict then also has the columns of `--noise`, with the interval that holds 95 % of `samples`,
/// the same bits on any number of threads. The other options, lengths in mm: tread_at (70), flange_level (10), tip_depth (2),
/// width_level (14), gauge_level (14), gauge_from ("measured" or "nominal"), align ("none", "back", "tread-point",
/// "back-and-tread", "field-side", "web", "unworn" or "best-fit") and unworn, a list of ranges [from, to] of the nominal's x.
///
///     >>> round(wr.measure_profile(wr.wheel("S1002"))["flange_height_mm"], 6)
///     28.0
///     >>> found = wr.measure_profile(wr.wheel("S1002"), noise=0.02, samples=40)
///     >>> found["flange_width_mm_low"] < found["flange_width_mm"] < found["flange_width_mm_high"]
///     True
///
/// Raises InputError for options or noise without meaning and profiles of two bodies.
#[pyfunction]
#[pyo3(signature = (profile, nominal = None, *, side = None, noise = None, step = 0.2, samples = 400, seed = 1, **options))]
#[expect(clippy::too_many_arguments, reason = "these are keywords")]
pub(crate) fn measure_profile<'py>(
    py: Python<'py>,
    profile: &Profile,
    nominal: Option<&Profile>,
    side: Option<&str>,
    noise: Option<f64>,
    step: f64,
    samples: usize,
    seed: u64,
    options: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    let options: MeasureOptions = keywords(py, "measure_profile", options)?;
    let side = known(side.map(named_side).transpose()?.or(profile.side))?;
    one_body(side, [profile, nominal.unwrap_or(profile)])?;
    let noise = noise.map(|sigma| PointNoise { sigma, step, samples, seed, curve: curve(profile) });
    let spread = noise.is_some().then_some("noise");
    let (own, nominal) = (profile.profile.clone(), nominal.map(|nominal| nominal.profile.clone()));
    let measures = waited(py, move |_| match noise {
        None => measure(&own, side, nominal.as_ref(), &options),
        Some(noise) => measure_noisy(&own, side, nominal.as_ref(), &options, &noise),
    })?;
    let measures = measures.with_diameter(profile.recorded("diameter").as_f64()).compared(&stated(profile));
    let row = MeasureRow { file: profile.profile.name.clone(), side: Some(side), measured: Ok(measures) };
    to_python(py, &row.values(RowColumns { spread, limits: None }))
}

/// Measure repeated measurements of one profile. Return a dict with the columns of `wheelrail profile measure --repeats --csv`: the
/// mean of each quantity, its standard deviation and the interval in which a further measurement lies with 95 %, by Student's t.
///
/// `nominal`, `side` and the other options are those of `measure_profile`.
///
///     >>> wheel = wr.wheel("S1002")
///     >>> found = wr.measure_repeats([wheel, wheel.rotated(0.001), wheel.rotated(-0.001)])
///     >>> round(found["flange_height_mm"], 2), found["flange_height_mm_samples"]
///     (28.0, 3)
///
/// Raises InputError for options without meaning, profiles of two bodies, and fewer than two profiles.
#[pyfunction]
#[pyo3(signature = (profiles, nominal = None, *, side = None, **options))]
pub(crate) fn measure_repeats<'py>(
    py: Python<'py>,
    profiles: Vec<PyRef<'py, Profile>>,
    nominal: Option<&Profile>,
    side: Option<&str>,
    options: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    let options: MeasureOptions = keywords(py, "measure_repeats", options)?;
    let side = body(&profiles, nominal, side)?;
    let records = profiles.iter().map(|own| (own.recorded("diameter").as_f64(), stated(own)));
    let records: Vec<_> = records.collect();
    let own: Vec<wheelrail::Profile> = profiles.iter().map(|profile| profile.profile.clone()).collect();
    let nominal = nominal.map(|nominal| nominal.profile.clone());
    let mean = waited(py, move |_| {
        let measured = |(own, (diameter, stated)): (&wheelrail::Profile, (Option<f64>, Vec<StatedValue>))| {
            let measures = measure(own, side, nominal.as_ref(), &options)?;
            Ok(measures.with_diameter(diameter).compared(&stated))
        };
        let all = own.iter().zip(records).map(measured).collect::<Result<Vec<_>, Error>>()?;
        repeated(&all.iter().collect::<Vec<_>>())
    })?;
    let file = format!("mean of {} repeats", profiles.len());
    let row = MeasureRow { file, side: Some(side), measured: Ok(mean) };
    to_python(py, &row.values(RowColumns { spread: Some("repeats"), limits: None }))
}

/// Returns the values that the file of a profile states.
fn stated(profile: &Profile) -> Vec<StatedValue> {
    serde_json::from_value(profile.recorded("stated")).unwrap_or_default()
}

/// Returns how the curve of a profile was drawn through its points; by interpolation where it has none.
fn curve(profile: &Profile) -> Options {
    let of = profile.recorded("curve");
    let kind = serde_json::from_value(of["kind"].clone()).unwrap_or(CurveKind::Interpolation);
    Options {
        curve: Some(kind),
        cutoff_wavelength: of["cutoff_wavelength"].as_f64(),
        arc_tolerance: of["tolerance"].as_f64(),
        ..Options::default()
    }
}

/// A column of an average: its name, and its value at a point.
type AverageColumn = (&'static str, fn(&AveragePoint) -> f64);

fn known(side: Option<Side>) -> PyResult<Side> {
    let advice = "give `side`, rail or wheel";
    side.ok_or_else(|| exception(Error::new("side", "none", "the body of the profile", advice)))
}

/// Returns the one body of profiles and their nominal.
fn body(profiles: &[PyRef<'_, Profile>], nominal: Option<&Profile>, side: Option<&str>) -> PyResult<Side> {
    let all = || profiles.iter().map(|profile| &**profile).chain(nominal);
    let side = side.map(named_side).transpose()?.or_else(|| all().find_map(|profile| profile.side));
    let side = known(side)?;
    one_body(side, all())?;
    Ok(side)
}

fn one_body<'a>(side: Side, profiles: impl IntoIterator<Item = &'a Profile>) -> PyResult<()> {
    let other = |profile: &&Profile| profile.side.is_some_and(|own| own != side);
    let Some(profile) = profiles.into_iter().find(other) else { return Ok(()) };
    let advice = "give wheels or rails, and a nominal of theirs";
    let place = format!("profiles: {}", profile.profile.name);
    Err(exception(Error::new(place, "the other body", "one body", advice)))
}

/// Average profiles of one body along the normals of their average. Return a dict: "profile", through the points of the average; arrays
/// x_mm, z_mm, spread_mm (standard deviation along the normal), least_mm, largest_mm (offsets of the outermost profiles) and profiles
/// (how many are there), as of `wheelrail profile average --band`; "finding", a list of texts.
///
/// The profiles are aligned on `nominal`; without one, they stay in their own axes, wheels with X = 0 at the flange back. `side` and the
/// other options are those of `measure_profile`.
///
///     >>> wheel = wr.wheel("S1002")
///     >>> average = wr.average_profiles([wheel, wheel.shifted(0.0, 0.2)])
///     >>> round(float(average["spread_mm"][500]), 3)
///     0.141
///
/// Raises InputError for options without meaning, profiles of two bodies, and fewer than two that can be aligned.
#[pyfunction]
#[pyo3(signature = (profiles, nominal = None, *, side = None, **options))]
pub(crate) fn average_profiles<'py>(
    py: Python<'py>,
    profiles: Vec<PyRef<'py, Profile>>,
    nominal: Option<&Profile>,
    side: Option<&str>,
    options: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyDict>> {
    let options: MeasureOptions = keywords(py, "average_profiles", options)?;
    let side = body(&profiles, nominal, side)?;
    let all: Vec<wheelrail::Profile> = profiles.iter().map(|profile| profile.profile.clone()).collect();
    let nominal = nominal.map(|nominal| nominal.profile.clone());
    let (average, measured) = waited(py, move |_| {
        let average = average(&all.iter().collect::<Vec<_>>(), side, nominal.as_ref(), &options)?;
        let as_they_are = Options {
            mirror: Some(false),
            flip_z: Some(false),
            curve: Some(CurveKind::Interpolation),
            ..Options::default()
        };
        let measured = of_points("average", &average.xz(), side, &as_they_are)?;
        Ok((average, measured))
    })?;
    let out = PyDict::new(py);
    out.set_item("profile", Profile::measured(py, measured, Some(side))?)?;
    let columns: [AverageColumn; 5] = [
        ("x_mm", |point| point.at[0]),
        ("z_mm", |point| point.at[1]),
        ("spread_mm", |point| point.spread),
        ("least_mm", |point| point.range.low),
        ("largest_mm", |point| point.range.high),
    ];
    for (name, of) in columns {
        out.set_item(name, PyArray1::from_iter(py, average.points.iter().map(of)))?;
    }
    out.set_item("profiles", PyArray1::from_iter(py, average.points.iter().map(|point| point.count as u64)))?;
    out.set_item("finding", average.findings)?;
    Ok(out)
}

//! Measures of profiles.

use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use wheelrail::measure::{AveragePoint, MeasureOptions, Row, average, measure};
use wheelrail::measured::{CurveKind, Options, of_points};
use wheelrail::{Error, Side};

use crate::errors::exception;
use crate::long::waited;
use crate::profile::{Profile, keywords, named_side};
use crate::text::to_python;

/// Measure a wheel or rail: flange height and thickness, wear against a `nominal` profile, groove. Return a dict with the columns of
/// `wheelrail profile measure --csv` as keys; None for what cannot be had, and under "finding" why.
///
/// `side` is "rail" or "wheel", where the profile does not know it. The other options, lengths in mm: tread_at (70), flange_level
/// (10), tip_depth (2), width_level (14), gauge_level (14), gauge_from ("measured" or "nominal"), align ("none", "back",
/// "tread-point", "back-and-tread", "field-side", "web", "unworn" or "best-fit") and unworn, a list of ranges [from, to] of the
/// nominal's x.
///
///     >>> round(wr.measure_profile(wr.wheel("S1002"))["flange_height_mm"], 6)
///     28.0
///
/// Raises InputError for options without meaning and profiles of two bodies.
#[pyfunction]
#[pyo3(signature = (profile, nominal = None, *, side = None, **options))]
pub(crate) fn measure_profile<'py>(
    py: Python<'py>,
    profile: &Profile,
    nominal: Option<&Profile>,
    side: Option<&str>,
    options: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    let options: MeasureOptions = keywords(py, "measure_profile", options)?;
    let side = known(side.map(named_side).transpose()?.or(profile.side))?;
    if nominal.and_then(|nominal| nominal.side).is_some_and(|other| other != side) {
        let advice = "give the nominal of this body";
        return Err(exception(Error::new("nominal", "the other body", "the body of the profile", advice)));
    }
    let (own, nominal) = (profile.profile.clone(), nominal.map(|nominal| nominal.profile.clone()));
    let measures = waited(py, move |_| measure(&own, side, nominal.as_ref(), &options))?;
    let measures = measures.with_diameter(profile.diameter());
    let row = Row { file: profile.profile.name.clone(), side: Some(side), measured: Ok(measures) };
    to_python(py, &row.values(None))
}

fn known(side: Option<Side>) -> PyResult<Side> {
    let advice = "give `side`, rail or wheel";
    side.ok_or_else(|| exception(Error::new("side", "none", "the body of the profile", advice)))
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
    let given = side.map(named_side).transpose()?;
    let own =
        || profiles.iter().map(|profile| profile.side).chain([nominal.and_then(|of| of.side)]).flatten();
    let side = known(given.or_else(|| own().next()))?;
    if own().any(|other| other != side) {
        let advice = "average wheels or rails, on a nominal of theirs";
        return Err(exception(Error::new("profiles", "the other body", "one body", advice)));
    }
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
    let columns: [(&str, fn(&AveragePoint) -> f64); 5] = [
        ("x_mm", |point| point.at[0]),
        ("z_mm", |point| point.at[1]),
        ("spread_mm", |point| point.spread),
        ("least_mm", |point| point.range[0]),
        ("largest_mm", |point| point.range[1]),
    ];
    for (name, of) in columns {
        out.set_item(name, PyArray1::from_iter(py, average.points.iter().map(of)))?;
    }
    out.set_item("profiles", PyArray1::from_iter(py, average.points.iter().map(|point| point.count as u64)))?;
    out.set_item("finding", average.findings)?;
    Ok(out)
}

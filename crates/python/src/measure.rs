//! Measures of profiles.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use wheelrail::Error;
use wheelrail::measure::{MeasureOptions, Row, measure};

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
    let Some(side) = side.map(named_side).transpose()?.or(profile.side) else {
        let advice = "give `side`, rail or wheel";
        return Err(exception(Error::new("side", "none", "the body of the profile", advice)));
    };
    if nominal.and_then(|nominal| nominal.side).is_some_and(|other| other != side) {
        let advice = "give the nominal of this body";
        return Err(exception(Error::new("nominal", "the other body", "the body of the profile", advice)));
    }
    let (own, nominal) = (profile.profile.clone(), nominal.map(|nominal| nominal.profile.clone()));
    let measures = waited(py, move |_| measure(&own, side, nominal.as_ref(), &options))?;
    let row = Row { file: profile.profile.name.clone(), side: Some(side), measured: Ok(measures) };
    to_python(py, &row.values(None))
}

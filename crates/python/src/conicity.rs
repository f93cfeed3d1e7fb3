//! The contact geometry of a wheelset by EN 15302.

use numpy::{PyArray1, PyArray2};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde::{Deserialize, Serialize};
use wheelrail::case::{
    ConicityOptions, ConicityReport, DOUBT, FUNCTIONS, KEY_FIGURES, Noise, conicity as of_case,
    contact_geometry,
};

use crate::arrays::values;
use crate::case::Case;
use crate::long::waited;
use crate::positions::RollArgument;
use crate::text::{parsed, to_python};
use crate::wheelset::Wheelset;

/// Standard deviations of a measurement, mm.
#[derive(Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Deviations {
    points: f64,
    radius: f64,
    gauge: f64,
    step: f64,
}

impl Default for Deviations {
    fn default() -> Self {
        let Noise { points, radius, gauge, step, .. } = Noise::default();
        Self { points, radius, gauge, step }
    }
}

/// Find the contact geometry of a wheelset on its track by EN 15302: a dict of "key_figures" (None where there is none), "functions" over
/// the lateral displacement (arrays, and a list of words for "doubt"), the "map" of equivalent conicity over gauge and amplitude, "uncertainty", "findings" and
/// "definitions" of every name.
///
/// `wheelset` is a `Wheelset`, or a `Case` with its own roll. `amplitude` is the largest displacement and amplitude, `step` that of the
/// displacements, `gauges` changes of the gauge for the map (-5 to 15), all in mm; `roll` is "solve" or "neglect". `noise` has the standard
/// deviations "points", "radius" and "gauge" in mm, and the "step" of the points; "uncertainty" then tells how far `samples` of them move
/// the figures, with the same bits on any number of threads.
///
///     >>> found = wr.conicity(track, roll="neglect")
///     >>> round(found["key_figures"]["conicity_3mm"], 3)
///     0.174
///     >>> found["functions"]["delta_r_mm"].shape
///     (161,)
///
/// Raises InputError for options without meaning, a roll in rad, and a case without wheelset.
#[pyfunction]
#[pyo3(signature = (wheelset, *, roll = None, amplitude = 8.0, step = 0.1, gauges = None, noise = None, samples = 400, seed = 1))]
#[expect(clippy::too_many_arguments, reason = "these are keywords")]
pub(crate) fn conicity<'py>(
    py: Python<'py>,
    wheelset: &Bound<'py, PyAny>,
    roll: Option<RollArgument>,
    amplitude: f64,
    step: f64,
    gauges: Option<&Bound<'py, PyAny>>,
    noise: Option<&Bound<'py, PyAny>>,
    samples: usize,
    seed: u64,
) -> PyResult<Bound<'py, PyDict>> {
    let mut options = ConicityOptions { amplitude, step, ..ConicityOptions::default() };
    if let Some(gauges) = gauges {
        options.gauges = values("gauges", gauges)?;
    }
    if let Some(noise) = noise {
        let Deviations { points, radius, gauge, step } = parsed("noise", noise)?;
        options.noise = Some(Noise { points, radius, gauge, step, samples, seed });
    }
    let report = if let Ok(case) = wheelset.cast::<Case>() {
        if roll.is_some() {
            return Err(PyTypeError::new_err("a Case has its own roll"));
        }
        let case = case.get().shared();
        waited(py, move |_| of_case(&case, &options, &|_| {}))?
    } else {
        let roll = roll.map_or(Ok(wheelrail::Roll::Solve), |roll| roll.roll())?;
        let (system, pairs) = wheelset.cast::<Wheelset>()?.get().parts();
        waited(py, move |_| contact_geometry(&system, [&pairs[0], &pairs[1]], roll, &options, &|_| {}))?
    };
    dict_of(py, report)
}

/// Makes the dict of a report.
fn dict_of(py: Python<'_>, report: ConicityReport) -> PyResult<Bound<'_, PyDict>> {
    let [figures, functions, map, definitions, out] = [(); 5].map(|()| PyDict::new(py));
    for ((name, _), value) in KEY_FIGURES.iter().zip(report.key_figures) {
        figures.set_item(*name, (!value.is_nan()).then_some(value))?;
    }
    for (name, meaning) in KEY_FIGURES.iter().chain(&FUNCTIONS).chain([&DOUBT]) {
        definitions.set_item(*name, *meaning)?;
    }
    for ((name, _), values) in FUNCTIONS.iter().zip(report.functions) {
        functions.set_item(*name, PyArray1::from_vec(py, values))?;
    }
    let doubts: Vec<String> = report.doubts.iter().map(ToString::to_string).collect();
    functions.set_item(DOUBT.0, doubts)?;
    map.set_item("gauge_change_mm", PyArray1::from_vec(py, report.map.gauge_change_mm))?;
    map.set_item("gauge_mm", PyArray1::from_vec(py, report.map.gauge_mm))?;
    map.set_item("amplitude_mm", PyArray1::from_vec(py, report.map.amplitude_mm))?;
    map.set_item("conicity", PyArray2::from_vec2(py, &report.map.conicity)?)?;
    out.set_item("key_figures", figures)?;
    out.set_item("functions", functions)?;
    out.set_item("map", map)?;
    let uncertainty = report.uncertainty.as_ref().map(wheelrail::case::uncertainty_values);
    out.set_item("uncertainty", to_python(py, &uncertainty)?)?;
    out.set_item("findings", report.findings)?;
    out.set_item("definitions", definitions)?;
    Ok(out)
}

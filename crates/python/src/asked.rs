//! What is asked of a contact: a load or an approach, and the modulus of elasticity.

use pyo3::prelude::*;
use wheelrail::Error;
use wheelrail::case::{ApproachBy, usual};
use wheelrail::scene::{self, MaterialData, PatchData};

use crate::errors::{OrRaise, exception, warn};

/// Checks a load \[N\] or approach \[mm\] and E* \[N/mm²\], and warns of values in another unit.
pub(crate) fn asked(
    py: Python<'_>,
    load: Option<f64>,
    approach: Option<f64>,
    modulus: Option<f64>,
) -> PyResult<(ApproachBy, f64)> {
    let by = scene::approach(&PatchData { load, approach, ..PatchData::default() }).or_raise()?;
    let modulus = checked_modulus(py, modulus)?;
    warn(py, load.and_then(|load| usual::load("load", load)))?;
    Ok((by, modulus))
}

/// Checks E* \[N/mm²\]; that of steel on steel if it is not given.
pub(crate) fn checked_modulus(py: Python<'_>, modulus: Option<f64>) -> PyResult<f64> {
    let Some(modulus) = modulus else { return scene::modulus(&MaterialData::default()).or_raise() };
    if modulus > 0.0 && modulus.is_finite() {
        warn(py, usual::modulus("modulus", modulus))?;
        return Ok(modulus);
    }
    let expected = "a positive modulus in N/mm²";
    Err(exception(Error::new("modulus", modulus.to_string(), expected, "steel on steel has 113932")))
}

/// Return E* in N/mm2 of two bodies from Young's moduli in N/mm2 and Poisson's ratios; by default of steel.
///
///     >>> round(wr.effective_modulus())
///     113932
///
/// Raises InputError for a modulus that is not positive and a ratio beyond (-1, 0.5].
#[pyfunction]
#[pyo3(signature = (*, rail = (2.1e5, 0.28), wheel = (2.1e5, 0.28)))]
pub(crate) fn effective_modulus(py: Python<'_>, rail: (f64, f64), wheel: (f64, f64)) -> PyResult<f64> {
    let material = MaterialData {
        rail_youngs_modulus: rail.0,
        rail_poissons_ratio: rail.1,
        wheel_youngs_modulus: wheel.0,
        wheel_poissons_ratio: wheel.1,
    };
    let modulus = scene::modulus(&material).or_raise()?;
    warn(
        py,
        [("rail", rail), ("wheel", wheel)].into_iter().filter_map(|(body, of)| usual::modulus(body, of.0)),
    )?;
    Ok(modulus)
}

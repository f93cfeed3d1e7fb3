//! Built-in profiles.

use pyo3::prelude::*;
use wheelrail::profile::{Side, standards};

use crate::errors::OrRaise;
use crate::profile::Profile;

/// Return a built-in rail: upright, origin at the top of its crown.
///
///     >>> wr.rail("60E1").name
///     '60E1'
///
/// Raises InputError for an unknown name, with the nearest known one.
#[pyfunction]
pub(crate) fn rail(name: &str) -> PyResult<Profile> {
    standards::rail(name).map(|profile| Profile::of(&profile, Side::Rail)).or_raise()
}

/// Return a built-in wheel: right-hand, flange at negative x, origin where its standard has it. Besides `wheel_names()` there are
/// those of EN 13715 with any of its flanges and slopes: "EN13715-S1002-h30-e30.5-6.7%".
///
///     >>> wr.wheel("S1002").side
///     'wheel'
///
/// Raises InputError for an unknown name, with the nearest known one.
#[pyfunction]
pub(crate) fn wheel(name: &str) -> PyResult<Profile> {
    standards::wheel(name).map(|profile| Profile::of(&profile, Side::Wheel)).or_raise()
}

/// Return the names of the built-in rails.
///
///     >>> "60E1" in wr.rail_names()
///     True
#[pyfunction]
pub(crate) fn rail_names() -> Vec<&'static str> {
    standards::rail_names().collect()
}

/// Return the names of the built-in wheels.
///
///     >>> "S1002" in wr.wheel_names()
///     True
#[pyfunction]
pub(crate) fn wheel_names() -> Vec<&'static str> {
    standards::wheel_names().collect()
}

//! Python's dicts and the library's tables of keys, by way of JSON.

use pyo3::prelude::*;
use serde::Serialize;
use serde::de::DeserializeOwned;
use wheelrail::{Error, scene};

use crate::errors::OrRaise;

/// Makes Python's dicts and lists of a value.
pub(crate) fn to_python<'py>(py: Python<'py>, value: &impl Serialize) -> PyResult<Bound<'py, PyAny>> {
    let text = serde_json::to_string(value).unwrap_or_default();
    py.import("json")?.getattr("loads")?.call1((text,))
}

/// Writes Python's values as JSON, a key a line. Profiles among them get names and go into the dict `profiles`; without it their
/// segments are written.
///
/// # Errors
/// InputError for values that are no numbers, words, lists, dicts or arrays of them, and for numbers that are not finite.
pub(crate) fn to_json(value: &Bound<'_, PyAny>, profiles: Option<&Bound<'_, PyAny>>) -> PyResult<String> {
    value.py().import("wheelrail._scene")?.getattr("to_json")?.call1((value, profiles))?.extract()
}

/// Reads Python's values as the library's; messages name the key below `place`.
///
/// # Errors
/// Those of [`to_json`]; InputError for unknown keys and wrong types.
pub(crate) fn parsed<T: DeserializeOwned + Serialize>(place: &str, value: &Bound<'_, PyAny>) -> PyResult<T> {
    let text = to_json(value, None)?;
    scene::parse(&text, true).map_err(|error| keyed(&text, error).within(place)).or_raise()
}

/// Names the key at which reading JSON ended, in place of its line, which the user has not written.
pub(crate) fn keyed(text: &str, mut error: Error) -> Error {
    let Some(rest) = error.place.split("line ").nth(1) else { return error };
    let Some(number) = rest.split(',').next().and_then(|number| number.parse().ok()) else { return error };
    let mut keys: Vec<(usize, &str)> = Vec::new();
    for line in text.lines().take(number) {
        let depth = line.len() - line.trim_start().len();
        keys.retain(|(above, _)| *above < depth);
        if let Some((key, _)) = line.trim_start().strip_prefix('"').and_then(|line| line.split_once("\": ")) {
            keys.push((depth, key));
        }
    }
    error.place = keys.iter().map(|(_, key)| *key).collect::<Vec<_>>().join(": ");
    error
}

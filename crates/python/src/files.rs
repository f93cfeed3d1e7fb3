//! Files of a run, in memory.

use std::path::Path;

use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyString};
use wheelrail::Result;
use wheelrail::case::OutputFormat;
use wheelrail::files::read_text;

use crate::errors::OrRaise;
use crate::long::waited;
use crate::text::parsed;

/// Makes the files of a format, and gives them as bytes.
pub(crate) fn files<'py>(
    py: Python<'py>,
    format: Option<&str>,
    make: impl FnOnce(Option<OutputFormat>) -> Result<Vec<(String, Vec<u8>)>> + Send + 'static,
) -> PyResult<Bound<'py, PyDict>> {
    let format = format.map(|format| parsed("format", PyString::new(py, format).as_any())).transpose()?;
    let out = PyDict::new(py);
    for (name, bytes) in waited(py, move |_| make(format))? {
        out.set_item(name, PyBytes::new(py, &bytes))?;
    }
    Ok(out)
}

/// Largest file of values \[bytes\] that is read back.
const LARGEST: usize = 1 << 28;

/// Gives the values of a JSON file.
///
/// # Errors
/// A FileError for one that cannot be read.
pub(crate) fn read_json<'py>(py: Python<'py>, path: &Path) -> PyResult<Bound<'py, PyAny>> {
    let text = read_text(path, LARGEST).or_raise()?;
    py.import("json")?.getattr("loads")?.call1((text,))
}

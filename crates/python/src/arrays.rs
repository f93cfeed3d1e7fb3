//! NumPy arrays in and out.

use numpy::{AllowTypeChange, PyArray1, PyArray2, PyArrayLike1, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::prelude::*;

/// A one-dimensional array of numbers, or what NumPy makes one of: a list, other types, strides.
pub(crate) type Numbers<'py> = PyArrayLike1<'py, f64, AllowTypeChange>;

/// Gives the numbers of an array.
///
/// # Errors
/// Those of NumPy, where it has to copy.
pub(crate) fn values(numbers: &Numbers<'_>) -> PyResult<Vec<f64>> {
    if !numbers.data().is_aligned() {
        // What comes out of a message or a file may begin at any byte; no number of Rust does.
        return values(&numbers.call_method0("copy")?.extract()?);
    }
    Ok(match numbers.as_slice() {
        Ok(slice) => slice.to_vec(),
        // Strided.
        Err(_) => numbers.as_array().iter().copied().collect(),
    })
}

/// Makes an array (n,) of numbers, whose memory it takes over.
pub(crate) fn array(py: Python<'_>, numbers: Vec<f64>) -> Bound<'_, PyArray1<f64>> {
    PyArray1::from_vec(py, numbers)
}

/// Makes an array (n, 2) of points.
pub(crate) fn points<'py>(py: Python<'py>, points: &[[f64; 2]]) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let flat = PyArray1::from_slice(py, points.as_flattened());
    flat.reshape([flat.len() / 2, 2])
}

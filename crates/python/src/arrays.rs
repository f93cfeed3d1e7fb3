//! NumPy arrays in and out.

use numpy::{AllowTypeChange, Element, PyArray1, PyArray2, PyArrayLike1, PyArrayMethods};
use pyo3::exceptions::PyMemoryError;
use pyo3::prelude::*;
use wheelrail::{Error, ErrorKind};

use crate::errors::exception;

/// A one-dimensional array of numbers, or what NumPy makes one of: a list, other types, strides.
type Numbers<'py> = PyArrayLike1<'py, f64, AllowTypeChange>;

/// Gives the numbers of the argument with this name.
///
/// # Errors
/// InputError for another shape than (n,) and what is no number; those of NumPy, where it has to copy.
pub(crate) fn values(name: &str, argument: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
    let numbers = argument.extract::<Numbers<'_>>().map_err(|_| no_axis(name, argument))?;
    if !numbers.data().is_aligned() {
        // An array from a message or a file may begin at any byte, which Rust's slices of numbers may not.
        return values(name, &numbers.call_method0("copy")?);
    }
    Ok(match numbers.as_slice() {
        Ok(slice) => slice.to_vec(),
        // Strided.
        Err(_) => numbers.as_array().iter().copied().collect(),
    })
}

/// Makes the error of an argument that is no list of numbers.
fn no_axis(name: &str, argument: &Bound<'_, PyAny>) -> PyErr {
    let shape = argument.py().import("numpy").and_then(|numpy| numpy.call_method1("shape", (argument,)));
    let shape: Vec<usize> = shape.and_then(|shape| shape.extract()).unwrap_or_default();
    let (found, advice) = match shape.len() {
        0 | 1 => {
            let kind =
                argument.get_type().name().map_or_else(|_| "no numbers".into(), |name| name.to_string());
            (format!("a {kind} that holds no row of numbers"), "pass an array, a list or a range of numbers")
        }
        _ => {
            let shape = format!("an array of shape {shape:?}");
            (
                shape,
                "pass the axis itself, of shape (n,), and not a meshgrid or a column: `ravel` or `unique` gives it",
            )
        }
    };
    exception(Error::new(name, found, "numbers, of shape (n,)", advice))
}

/// Makes an array (n,) of numbers, whose memory it takes over.
pub(crate) fn array(py: Python<'_>, numbers: Vec<f64>) -> Bound<'_, PyArray1<f64>> {
    PyArray1::from_vec(py, numbers)
}

/// Makes an array (n, N) of points.
pub(crate) fn points<'py, T: Element + Copy, const N: usize>(
    py: Python<'py>,
    points: &[[T; N]],
) -> PyResult<Bound<'py, PyArray2<T>>> {
    let flat = PyArray1::from_vec(py, points.as_flattened().to_vec());
    flat.reshape([points.len(), N])
}

/// Makes an array of zeros over two axes with their names.
///
/// # Errors
/// LimitError for more than 10⁹ points; MemoryError where NumPy does not get the memory.
pub(crate) fn grid<'py>(
    py: Python<'py>,
    [(first, rows), (second, columns)]: [(&str, &[f64]); 2],
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let shape = checked_shape([(first, rows), (second, columns)], 1)?;
    // NumPy's own function raises where an allocation fails; its C interface gives a null pointer.
    Ok(py.import("numpy")?.getattr("zeros")?.call1((shape,))?.cast_into()?)
}

/// Returns the numbers of rows and columns over two axes with their names, for arrays with so many numbers a point.
///
/// # Errors
/// LimitError for more than 10⁹ numbers.
pub(crate) fn checked_shape(
    [(first, rows), (second, columns)]: [(&str, &[f64]); 2],
    numbers: usize,
) -> PyResult<(usize, usize)> {
    /// Most numbers over a grid, 8 GB. A larger grid has axes in a wrong unit, or should be computed in blocks.
    const MOST: usize = 1_000_000_000;
    let (n, m) = (rows.len(), columns.len());
    if n.checked_mul(m).is_some_and(|points| points <= MOST / numbers) {
        return Ok((n, m));
    }
    let bytes = 8.0 * numbers as f64 * n as f64 * m as f64;
    let (found, expected) = (
        format!("{n} x {m} points, which take {bytes:.3e} bytes"),
        format!("at most {} points", MOST / numbers),
    );
    let error = Error::new(format!("{first}, {second}"), found, expected, "take the grid in several blocks");
    Err(exception(error.of_kind(ErrorKind::Limit)))
}

/// Gets memory for so many numbers, which another thread may fill.
///
/// # Errors
/// MemoryError where the system does not give it.
pub(crate) fn reserved(count: usize) -> PyResult<Vec<f64>> {
    let mut memory = Vec::new();
    let missing = |_| PyMemoryError::new_err(format!("no memory for {count} numbers"));
    memory.try_reserve_exact(count).map_err(missing)?;
    Ok(memory)
}

/// Makes an array (rows, columns) whose numbers are not set, for work that sets them all. NumPy asks for large pages, which Rust does not:
/// 230 bytes of a look-up then cost 15 ns instead of 100.
///
/// # Errors
/// MemoryError where NumPy does not get the memory.
pub(crate) fn unset(py: Python<'_>, rows: usize, columns: usize) -> PyResult<Bound<'_, PyArray2<f64>>> {
    Ok(py.import("numpy")?.getattr("empty")?.call1(((rows, columns),))?.cast_into()?)
}

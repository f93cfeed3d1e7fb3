//! Makes plain values, whose classes are written in Python.

use numpy::PyArray2;
use pyo3::call::PyCallArgs;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use wheelrail::nalgebra::{Point3, Vector3};

use crate::arrays;

/// Makes a value of a class of `wheelrail._values` from its fields.
pub(crate) fn made<'py>(
    py: Python<'py>,
    class: &str,
    fields: impl PyCallArgs<'py>,
) -> PyResult<Bound<'py, PyAny>> {
    py.import("wheelrail._values")?.getattr(class)?.call1(fields)
}

/// Makes an array (n, 3) of points.
pub(crate) fn in_space<'py>(py: Python<'py>, points: &[Point3<f64>]) -> PyResult<Bound<'py, PyArray2<f64>>> {
    arrays::points(py, &points.iter().map(|point| [point.x, point.y, point.z]).collect::<Vec<_>>())
}

/// Makes an array (n, 3) of vectors.
pub(crate) fn vectors<'py>(py: Python<'py>, vectors: &[Vector3<f64>]) -> PyResult<Bound<'py, PyArray2<f64>>> {
    arrays::points(py, &vectors.iter().map(|vector| [vector.x, vector.y, vector.z]).collect::<Vec<_>>())
}

/// Makes a mesh of cells of one kind; fields of points and cells are dicts of arrays.
pub(crate) fn mesh<'py, const N: usize>(
    py: Python<'py>,
    points: &[Point3<f64>],
    (kind, cells): (&str, &[[usize; N]]),
    (point_data, cell_data): (Bound<'py, PyDict>, Bound<'py, PyDict>),
) -> PyResult<Bound<'py, PyAny>> {
    let cells: Vec<[i64; N]> = cells.iter().map(|cell| cell.map(|node| node as i64)).collect();
    made(py, "Mesh", (in_space(py, points)?, kind, arrays::points(py, &cells)?, point_data, cell_data))
}

//! Grids of a contact: their axes, the method, and how they are filled.

use numpy::{PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use wheelrail::internal::MANY;
use wheelrail::scene;
use wheelrail::separation::{EtaAxis, Method, Plan};
use wheelrail::{Error, Placement};

use crate::arrays::{array, checked_shape, grid, reserved, values};
use crate::errors::{OrRaise, exception};
use crate::long::{shared, waited};

/// Points of a part of a grid, after each of which Ctrl-C is looked for: some 0.1 s on one thread, but of bodies that vary.
pub(crate) const PART: usize = 1 << 19;
/// Points of a part by strips of columns: as long.
const PART_OF_STRIPS: usize = 1 << 24;
/// Points that a short column costs as much as.
const LEAST_COLUMN: usize = 64;

/// Reads the axes of a grid \[mm\], and checks them and the tolerance.
pub(crate) fn checked_axes(
    (name, first): (&str, &Bound<'_, PyAny>),
    eta: &Bound<'_, PyAny>,
    tolerance: f64,
) -> PyResult<[Vec<f64>; 2]> {
    let (first, eta) = (values(name, first)?, values("eta", eta)?);
    scene::check_axis(name, &first).or_raise()?;
    scene::check_axis("eta", &eta).or_raise()?;
    if tolerance > 0.0 && tolerance.is_finite() {
        return Ok([first, eta]);
    }
    let (found, expected) = (tolerance.to_string(), "a positive length in mm");
    Err(exception(Error::new("tolerance", found, expected, "1e-12 gives all digits")))
}

/// Returns the number of points of a part of a grid by the method of a plan.
pub(crate) fn part(plan: &Plan, placement: &Placement) -> usize {
    let strips = plan.choice.method < Method::Pointwise && placement.skew() == 0.0;
    if strips { PART_OF_STRIPS } else { PART }
}

/// Makes a grid over two axes, the first with its name, and fills it in parts of so many points; Ctrl-C is looked for after each. A part
/// of bodies that vary takes long: Ctrl-C does not wait for its end.
///
/// # Errors
/// LimitError for more than 10⁹ points; MemoryError where there is less memory; KeyboardInterrupt.
pub(crate) fn filled<'py>(
    py: Python<'py>,
    placement: &Placement,
    ((name, first), axis): ((&str, Vec<f64>), EtaAxis),
    points: usize,
    mut fill: impl FnMut(&Placement, &[f64], &EtaAxis, &mut [f64]) + Send + 'static,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let axes = [(name, &first[..]), ("eta", axis.eta())];
    if placement.varying().is_some() {
        let (shape, placement) = (checked_shape(axes, 1)?, placement.clone());
        let mut out = reserved(shape.0 * shape.1)?;
        let values = waited(py, move |watch| {
            out.resize(shape.0 * shape.1, 0.0);
            for (first, out) in parts(points, &first, &axis, &mut out) {
                fill(&placement, first, &axis, out);
                watch.go_on()?;
            }
            Ok(out)
        })?;
        return array(py, values).reshape(shape);
    }
    let array = grid(py, axes)?;
    let mut values = array.try_readwrite()?;
    for (first, out) in parts(points, &first, &axis, values.as_slice_mut()?) {
        shared(py, || fill(placement, first, &axis, out))?;
        py.check_signals()?;
    }
    drop(values);
    Ok(array)
}

/// Divides a grid into parts of whole blocks of columns, which do not depend on each other.
fn parts<'a>(
    points: usize,
    first: &'a [f64],
    axis: &EtaAxis,
    out: &'a mut [f64],
) -> impl Iterator<Item = (&'a [f64], &'a mut [f64])> {
    let rows = axis.eta().len().max(1);
    let columns = (points / rows.max(LEAST_COLUMN)).max(1).next_multiple_of(MANY);
    first.chunks(columns).zip(out.chunks_mut(columns * rows))
}

pub(crate) fn named_method(name: &str) -> PyResult<Option<Method>> {
    if name == "auto" {
        return Ok(None);
    }
    Method::ALL.into_iter().find(|method| method.name() == name).map(Some).ok_or_else(|| {
        let names: Vec<&str> = ["auto"].into_iter().chain(Method::ALL.map(Method::name)).collect();
        let advice = scene::perhaps(name, &names);
        exception(Error::new("method", format!("\"{name}\""), format!("one of {}", names.join(", ")), advice))
    })
}

//! Grids of a contact: their axes, the method, and how they are filled.

use numpy::{PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use wheelrail::internal::MANY;
use wheelrail::scene;
use wheelrail::separation::{EtaAxis, Method, Plan};
use wheelrail::{Error, Placement};

use crate::arrays::{array, values};
use crate::errors::{OrRaise, exception};
use crate::long::{shared, waited};

/// Points of a part of a skewed wheel, or by single points: some 0.1 s on one thread.
pub(crate) const PART: usize = 1 << 19;
/// Points of a part by strips of columns: as long, and more than the caches hold.
const PART_OF_STRIPS: usize = 1 << 24;
/// Points of a part of bodies that vary: 0.1 s on one thread.
const PART_BY_POINTS: usize = 1 << 14;
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

/// Fills a grid of bodies that do not vary, in parts.
pub(crate) fn fill(
    py: Python<'_>,
    plan: &mut Plan,
    placement: &Placement,
    (xi, axis): (&[f64], &EtaAxis),
    out: &mut [f64],
) -> PyResult<()> {
    let strips = plan.choice.method < Method::Pointwise && placement.skew() == 0.0;
    let points = if strips { PART_OF_STRIPS } else { PART };
    in_parts(py, points, xi, axis, out, |xi, out| plan.fill(placement, xi, axis, out))
}

/// Fills a grid in parts of so many points, with a check for Ctrl-C in between.
pub(crate) fn in_parts(
    py: Python<'_>,
    points: usize,
    first: &[f64],
    axis: &EtaAxis,
    out: &mut [f64],
    mut fill: impl FnMut(&[f64], &mut [f64]) + Send,
) -> PyResult<()> {
    for (first, out) in parts(points, first, axis, out) {
        shared(py, || fill(first, out))?;
        py.check_signals()?;
    }
    Ok(())
}

/// Makes a grid of bodies that vary, whose points are computed one by one: new memory costs nothing beside them, so that Ctrl-C need
/// not wait for the end of a part.
pub(crate) fn by_points(
    py: Python<'_>,
    first: Vec<f64>,
    axis: EtaAxis,
    mut fill: impl FnMut(&[f64], &EtaAxis, &mut [f64]) + Send + 'static,
) -> PyResult<Bound<'_, PyArray2<f64>>> {
    let shape = [first.len(), axis.eta().len()];
    let values = waited(py, move |watch| {
        let mut out = vec![0.0; shape[0] * shape[1]];
        for (first, out) in parts(PART_BY_POINTS, &first, &axis, &mut out) {
            fill(first, &axis, out);
            watch.go_on()?;
        }
        Ok(out)
    })?;
    array(py, values).reshape(shape)
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

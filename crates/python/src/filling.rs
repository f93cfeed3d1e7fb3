//! Grids of a contact: their axes, the method, and how they are filled.

use pyo3::prelude::*;
use wheelrail::internal::MANY;
use wheelrail::scene;
use wheelrail::separation::{EtaAxis, Method, Plan};
use wheelrail::{Error, Placement};

use crate::arrays::values;
use crate::errors::{OrRaise, exception};
use crate::long::shared;

/// Points of a part: below 0.1 s by the slowest method on one thread.
const PART: usize = 1 << 20;

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

/// Fills a grid. Where the method is slow or the wheel skewed, large grids are filled in parts, with a check for Ctrl-C in between.
pub(crate) fn fill(
    py: Python<'_>,
    plan: &mut Plan,
    placement: &Placement,
    (xi, axis): (&[f64], &EtaAxis),
    out: &mut [f64],
) -> PyResult<()> {
    let strips = plan.choice.method < Method::Pointwise && placement.skew() == 0.0;
    if strips || out.len() <= PART {
        return shared(py, || plan.fill(placement, xi, axis, out));
    }
    in_parts(py, xi, axis, out, |xi, out| plan.fill(placement, xi, axis, out))
}

/// Fills a grid in parts of whole blocks of columns, which do not depend on each other, with a check for Ctrl-C in between.
pub(crate) fn in_parts(
    py: Python<'_>,
    first: &[f64],
    axis: &EtaAxis,
    out: &mut [f64],
    mut fill: impl FnMut(&[f64], &mut [f64]) + Send,
) -> PyResult<()> {
    let rows = axis.eta().len().max(1);
    let columns = (PART / rows).max(1).next_multiple_of(MANY);
    for (first, out) in first.chunks(columns).zip(out.chunks_mut(columns * rows)) {
        shared(py, || fill(first, out))?;
        py.check_signals()?;
    }
    Ok(())
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

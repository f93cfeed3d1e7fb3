//! Choosing the cheapest method that meets a tolerance, with an estimate of its error.

use super::Evaluator;
use super::axis::EtaAxis;
use super::column::WheelSurface;
use super::grid::{Choice, Method};
use super::spectral::{Demand, Spectral};
use crate::placement::Placement;
use crate::profile::Section;

/// At this tolerance \[mm\] and below, the relative accuracy near C is kept as well.
///
/// s falls below any absolute tolerance near C; someone who asks for 1e-12 mm asks for all digits.
pub const FULL_PRECISION: f64 = 1e-12;

/// Relative truncation allowed at full precision: a fiftieth of the promised 1e-13, some roundings.
const FULL_RELATIVE: f64 = 2e-15;

/// Columns of the grid at which an approximate method is compared with the point-wise one: its error is smooth between
/// joints and largest at edges, which are among them.
const SAMPLED_COLUMNS: usize = 65;

/// Values of η there.
const SAMPLED_ETA: usize = 9;

/// Columns at which the degree of spectral ones is looked for: it hardly changes over a window.
const FITTED_COLUMNS: usize = 17;

/// Share by which the sampled maximum is raised, for what lies between the samples.
const BETWEEN_SAMPLES: f64 = 1.25;

/// A choice, why it was made, and the error to expect.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// What to run.
    pub choice: Choice,
    /// Estimated largest error of s over the grid \[mm\], truncation and rounding.
    pub error: f64,
    /// Largest error asked for \[mm\].
    pub tolerance: f64,
    /// One sentence for the summary.
    pub reason: String,
}

/// The demand on s for a tolerance \[mm\].
pub fn demand(tolerance: f64) -> Demand {
    let relative = if tolerance <= FULL_PRECISION { FULL_RELATIVE } else { f64::INFINITY };
    Demand { absolute: tolerance, relative }
}

/// The cheapest method whose estimated error over the grid is below `tolerance` \[mm\], or the `forced` one.
///
/// The candidates are the quadratic form and spectral columns. What lies between them on the ladder errs more than spectral
/// columns and takes no less time: every column has a gap of its own, and under a skewed wheel every point.
/// At [`FULL_PRECISION`] and below the quadratic form is taken only where it is exact to rounding.
pub fn plan(
    placement: &Placement,
    xi: &[f64],
    axis: &EtaAxis,
    tolerance: f64,
    forced: Option<Method>,
) -> Plan {
    let samples = Samples::new(placement, xi, axis);
    let demand = demand(tolerance);
    let tried = |method| {
        let (coefficients, truncation) =
            if method == Method::Spectral { samples.polynomials(demand) } else { (1, 0.0) };
        let choice = Choice { method, demand, coefficients };
        (choice, samples.error(&choice, truncation))
    };
    if let Some(method) = forced {
        let (choice, error) = tried(method);
        return Plan { choice, error, tolerance, reason: "asked for by the scene".into() };
    }
    let (choice, error) = tried(Method::Quadratic);
    let exact = error <= samples.rounding;
    if error <= tolerance && (tolerance > FULL_PRECISION || exact) {
        let reason = format!("cheapest of all, within {tolerance:e} mm");
        return Plan { choice, error, tolerance, reason };
    }
    let reason =
        format!("cheapest within {tolerance:e} mm; {} is off by {error:.1e} mm", Method::Quadratic.name());
    let (choice, error) = tried(Method::Spectral);
    Plan { choice, error, tolerance, reason }
}

/// Point-wise values at a few columns.
struct Samples<'a> {
    placement: &'a Placement,
    xi: Vec<f64>,
    whole: &'a EtaAxis,
    axis: EtaAxis,
    exact: Vec<f64>,
    rounding: f64,
}

impl<'a> Samples<'a> {
    fn new(placement: &'a Placement, xi: &[f64], whole: &'a EtaAxis) -> Self {
        let xi = thinned(xi, SAMPLED_COLUMNS);
        let axis = EtaAxis::new(&thinned(&whole.eta, SAMPLED_ETA));
        let mut evaluator = Evaluator::new(placement);
        let mut exact = vec![f64::NAN; xi.len() * axis.eta.len()];
        for (&xi, out) in xi.iter().zip(exact.chunks_mut(axis.eta.len().max(1))) {
            evaluator.column(xi, &axis.eta, out);
        }
        let rounding = rounding(placement, &xi, &exact);
        Self { placement, xi, whole, axis, exact, rounding }
    }

    /// Raised largest difference from the point-wise values, or truncation where that is larger, plus rounding.
    fn error(&self, choice: &Choice, truncation: f64) -> f64 {
        let mut values = vec![f64::NAN; self.exact.len()];
        choice.fill(self.placement, &self.xi, &self.axis, &mut values);
        let differences = values.iter().zip(&self.exact).filter(|(_, exact)| !exact.is_nan());
        let largest = differences.map(|(s, exact)| (s - exact).abs()).fold(0.0, nan_max);
        BETWEEN_SAMPLES * nan_max(largest, truncation) + self.rounding
    }

    /// Coefficients with which most spans of spectral columns are done, and their largest truncation error \[mm\].
    fn polynomials(&self, demand: Demand) -> (usize, f64) {
        let mut spectral = Spectral::new(self.placement, &self.axis, demand, 1);
        if self.placement.skew != 0.0 {
            let mut out = vec![f64::NAN; self.whole.eta.len()];
            let columns = thinned(&self.xi, FITTED_COLUMNS).into_iter();
            let errors = columns.map(|xi| spectral.skewed_column(xi, &self.whole.eta, &mut out));
            return (1, errors.fold(0.0, f64::max));
        }
        let u_max = self.axis.reach * self.axis.reach;
        let wheel = WheelSurface::new(self.placement);
        let (mut needed, mut truncation, mut spans) = (Vec::new(), 0f64, Vec::new());
        for xi in thinned(&self.xi, FITTED_COLUMNS) {
            wheel.spans(xi, u_max, &mut spans);
            for fit in spans.iter().filter_map(|span| spectral.polynomial(xi, span, u_max, 1)) {
                needed.push(fit.n);
                truncation = truncation.max(fit.error);
            }
        }
        needed.sort_unstable();
        (needed.get(needed.len() / 2).copied().unwrap_or(1), truncation)
    }
}

/// Roundings of s over the contact segments: gap, rise, and their interpolation over ξ.
const CONTACT_ROUNDINGS: f64 = 8.0;

/// Rounding error of s: a few units of its own last place over the contact segments; elsewhere, of the heights by
/// which joints are placed in the frame, ζ = Δz cosθ − Δx sinθ, with z_C rounded in Δz.
fn rounding(placement: &Placement, xi: &[f64], exact: &[f64]) -> f64 {
    let largest = |values: &mut dyn Iterator<Item = f64>| {
        values.filter(|v| !v.is_nan()).fold(0.0, |m: f64, v| m.max(v.abs()))
    };
    let sections = [&placement.rail.section, &placement.wheel.section];
    let contact = |section: &Section, xi: f64| {
        section.piece_at(xi).is_none_or(|piece| section.contact == Some(piece.branch))
    };
    let s = largest(&mut exact.iter().copied());
    if xi.iter().all(|&xi| sections.into_iter().all(|section| contact(section, xi))) {
        return CONTACT_ROUNDINGS * f64::EPSILON * s;
    }
    let joints = sections.map(|section| {
        let heights = largest(&mut xi.iter().map(|&xi| section.height(xi)));
        section.frame.z.abs() + heights + section.frame.sin.abs() * largest(&mut xi.iter().copied())
    });
    // Both bodies' joints are off at once.
    2.0 * f64::EPSILON * s.max(joints[0] + joints[1])
}

/// The larger of two, NaN if either is.
fn nan_max(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }
}

/// At most `n` of the values, evenly spread, ends included.
fn thinned(values: &[f64], n: usize) -> Vec<f64> {
    if values.len() <= n {
        return values.to_vec();
    }
    (0..n).map(|k| values[k * (values.len() - 1) / (n - 1)]).collect()
}

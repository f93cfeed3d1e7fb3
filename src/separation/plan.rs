//! Choosing the cheapest method that meets a tolerance, with an estimate of its error.

use super::Evaluator;
use super::axis::EtaAxis;
use super::column::WheelSurface;
use super::grid::{Choice, Method};
use super::spectral::{Demand, Spectral};
use crate::numerics::nan_max;
use crate::placement::Placement;
use crate::profile::Section;

/// At this tolerance \[mm\] and below, the relative accuracy near C is kept as well.
///
/// s falls below any absolute tolerance near C; someone who asks for 1e-12 mm asks for all digits.
pub const FULL_PRECISION: f64 = 1e-12;

/// Relative truncation allowed at full precision: a fiftieth of the promised 1e-13, some roundings.
const FULL_RELATIVE: f64 = 2e-15;

/// Columns of the grid at which an approximate method is compared with the point-wise one, evenly spread. Its error is
/// smooth between joints: the columns next to these and half way between them are taken as well.
const SAMPLED_COLUMNS: usize = 65;

/// Values of η there.
const SAMPLED_ETA: usize = 9;

/// Where in a span, as a share of its u, the truncation error is measured beside its end, where it may pass through zero.
const MEASURED: [f64; 4] = [0.1, 0.3, 0.55, 0.8];

/// Share by which the sampled maximum is raised, for what lies between the samples.
const BETWEEN_SAMPLES: f64 = 1.5;

/// A choice, why it was made, and the error to expect.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// What to run.
    pub choice: Choice,
    /// Estimated largest error of s over the grid \[mm\], truncation and rounding.
    pub error: f64,
    /// The share of rounding in it \[mm\].
    pub rounding: f64,
    /// Largest error asked for \[mm\].
    pub tolerance: f64,
    /// One sentence for the summary.
    pub reason: String,
}

impl Plan {
    /// Fills the grid that the plan is for; completes its estimate by the truncation errors that are measured on the way.
    pub fn fill(&mut self, placement: &Placement, xi: &[f64], axis: &EtaAxis, out: &mut [f64]) {
        let truncation = self.choice.fill(placement, xi, axis, out);
        self.error = nan_max(self.error, BETWEEN_SAMPLES * truncation + self.rounding);
    }
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
    let rounding = samples.rounding;
    let demand = demand(tolerance);
    let tried = |method| {
        let (coefficients, truncation) =
            if method == Method::Spectral { samples.polynomials(demand) } else { (1, 0.0) };
        let choice = Choice { method, demand, coefficients };
        (choice, samples.error(&choice, truncation))
    };
    if let Some(method) = forced {
        let (choice, error) = tried(method);
        return Plan { choice, error, rounding, tolerance, reason: "asked for by the scene".into() };
    }
    let (choice, error) = tried(Method::Quadratic);
    let exact = error <= rounding;
    if error <= tolerance && (tolerance > FULL_PRECISION || exact) {
        let reason = format!("cheapest of all, within {tolerance:e} mm");
        return Plan { choice, error, rounding, tolerance, reason };
    }
    let reason =
        format!("cheapest within {tolerance:e} mm; {} is off by {error:.1e} mm", Method::Quadratic.name());
    let (choice, error) = tried(Method::Spectral);
    Plan { choice, error, rounding, tolerance, reason }
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
        let xi = sampled_columns(placement, xi);
        let axis = EtaAxis::new(&thinned(&whole.eta, SAMPLED_ETA));
        let mut evaluator = Evaluator::new(placement);
        let mut exact = vec![f64::NAN; xi.len() * axis.eta.len()];
        for (&xi, out) in xi.iter().zip(exact.chunks_mut(axis.eta.len().max(1))) {
            evaluator.column(xi, &axis.eta, out);
        }
        let rounding = rounding(placement, &xi, &whole.eta, &exact);
        Self { placement, xi, whole, axis, exact, rounding }
    }

    /// Raised largest difference from the point-wise values, or truncation where that is larger, plus rounding.
    fn error(&self, choice: &Choice, truncation: f64) -> f64 {
        let mut values = vec![f64::NAN; self.exact.len()];
        choice.fill(self.placement, &self.xi, &self.axis, &mut values);
        // A number where there is no surface is as wrong as none where there is one.
        let differences = values.iter().zip(&self.exact).filter(|(s, exact)| !(s.is_nan() && exact.is_nan()));
        let largest = differences.map(|(s, exact)| (s - exact).abs()).fold(0.0, nan_max);
        BETWEEN_SAMPLES * nan_max(largest, truncation) + self.rounding
    }

    /// Coefficients with which two thirds of the spans of spectral columns are done, and their largest truncation error \[mm\].
    fn polynomials(&self, demand: Demand) -> (usize, f64) {
        let mut spectral = Spectral::new(self.placement, &self.axis, demand, 1);
        if self.placement.skew != 0.0 {
            let mut out = vec![f64::NAN; self.whole.eta.len()];
            let errors = self.xi.iter().map(|&xi| spectral.skewed_column(xi, &self.whole.eta, &mut out));
            return (1, errors.fold(0.0, f64::max));
        }
        let u_max = self.axis.reach * self.axis.reach;
        let wheel = WheelSurface::new(self.placement);
        let (mut needed, mut truncation, mut spans) = (Vec::new(), 0f64, Vec::new());
        for &xi in &self.xi {
            wheel.spans(xi, u_max, &mut spans);
            for span in &spans {
                let Some(fit) = spectral.polynomial(xi, span, u_max, 1) else { continue };
                needed.push(fit.n);
                let run = span.u[1].min(u_max) - span.u[0];
                let inside =
                    MEASURED.map(|share| spectral.truncation(xi, span, &fit, span.u[0] + share * run));
                truncation = inside.into_iter().fold(truncation.max(fit.error), f64::max);
            }
        }
        needed.sort_unstable();
        (needed.get(needed.len() * 2 / 3).copied().unwrap_or(1), truncation)
    }
}

/// Roundings of s over the contact segments: gap, rise, and their interpolation over ξ; under yaw that in powers of η.
const CONTACT_ROUNDINGS: [f64; 2] = [8.0, 32.0];

/// … and elsewhere: both bodies' joints are off at once.
const PLACE_ROUNDINGS: f64 = 2.0;

/// Rounding error of s: a few units of its own last place over the contact segments; elsewhere, of the heights by
/// which joints are placed in the frame, ζ = Δz cosθ − Δx sinθ, with z_C rounded in Δz, and of the rounded ξ times slope.
fn rounding(placement: &Placement, xi: &[f64], eta: &[f64], exact: &[f64]) -> f64 {
    let largest = |values: &mut dyn Iterator<Item = f64>| {
        values.filter(|v| !v.is_nan()).fold(0.0, |m: f64, v| m.max(v.abs()))
    };
    // Beside the midplane columns lie over other places of the wheel's profile.
    let mut evaluator = Evaluator::new(placement);
    let mut below = xi.to_vec();
    for &eta in [eta.first(), eta.last()].into_iter().flatten() {
        below.extend(xi.iter().map(|&xi| evaluator.foot_abscissa(xi, eta)));
    }
    let bodies = [(&placement.rail.section, xi), (&placement.wheel.section, &below)];
    let contact = |section: &Section, x: f64| {
        section.piece_at(x).is_none_or(|piece| section.contact == Some(piece.branch))
    };
    let s = largest(&mut exact.iter().copied());
    if bodies.into_iter().all(|(section, places)| places.iter().all(|&x| contact(section, x))) {
        return CONTACT_ROUNDINGS[usize::from(placement.skew != 0.0)] * f64::EPSILON * s;
    }
    let joints = bodies.map(|(section, places)| {
        let heights = largest(&mut places.iter().map(|&x| section.height(x)));
        let slopes = |x: &f64| section.branch_at(*x).map_or(f64::NAN, |branch| branch.chord_slope(*x, *x));
        let width = largest(&mut places.iter().copied()) + section.frame.x.abs();
        let steep = width * largest(&mut places.iter().map(slopes).filter(|slope| slope.is_finite()));
        section.frame.z.abs() + heights + steep.max(section.frame.sin.abs() * width)
    });
    PLACE_ROUNDINGS * f64::EPSILON * s.max(joints[0] + joints[1])
}

/// Columns of the grid, evenly spread, and those next to the joints of both bodies and to the middle between two.
fn sampled_columns(placement: &Placement, xi: &[f64]) -> Vec<f64> {
    let mut columns = thinned(xi, SAMPLED_COLUMNS);
    let (Some(&first), Some(&last)) = (xi.first(), xi.last()) else { return columns };
    if columns.len() < xi.len() {
        let joints = placement.joints(first, last);
        let middles = joints.windows(2).map(|pair| pair[0] + (pair[1] - pair[0]) / 2.0);
        for place in joints.iter().copied().chain(middles) {
            let beyond = xi.partition_point(|&xi| xi < place);
            // Beside a column on the joint as well.
            columns.extend(&xi[beyond.saturating_sub(1)..xi.len().min(beyond + 2)]);
        }
        columns.sort_by(f64::total_cmp);
        columns.dedup();
    }
    columns
}

/// At most `n` of the values, evenly spread, ends included.
fn thinned(values: &[f64], n: usize) -> Vec<f64> {
    if values.len() <= n {
        return values.to_vec();
    }
    (0..n).map(|k| values[k * (values.len() - 1) / (n - 1)]).collect()
}

//! Chooses the cheapest method that meets a tolerance, and estimates its error.

use super::axis::EtaAxis;
use super::columns::fit::Fitter;
use super::columns::strip::Strip;
use super::columns::strips::strips;
use super::columns::{skewed, truncation};
use super::crossings::beside_steps;
use super::demand::{Demand, FULL_PRECISION};
use super::evaluator::Evaluator;
use super::grid::{Choice, Method};
use super::mask::covered;
use super::methods::quadratic::quadratic_form;
use super::relief::Relief;
use super::rounding::rounding;
use super::samples::{Samples, difference, places, thinned};
use crate::lofted::FramedLoft;
use crate::numerics::nan_max;
use crate::placement::Placement;

/// Number of columns in no strip whose truncation errors are measured, evenly spread. The others are measured while the
/// grid is filled.
const COLUMNS_ALONE: usize = 32;

/// Number of columns of a skewed wheel that are filled to measure their errors.
const SKEWED_COLUMNS: usize = 17;

/// Number of η in these columns at which they are compared with single points.
const SKEWED_ETA: usize = 5;

/// Number of values along each axis at which the quadratic form is tried first: the ends and the middle.
const PROBED: usize = 3;

/// Number of values along each axis that are probed next if a body has no surface at some of the first ones.
const PROBED_BESIDE_ENDS: usize = 24;

/// Factor on the largest sampled error, for the places between the samples.
const BETWEEN_SAMPLES: f64 = 1.5;

/// A chosen method, the reason for it, and its estimated error.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// The method to run and its accuracy.
    pub choice: Choice,
    /// Estimated largest error of s over the grid \[mm\]: truncation and rounding.
    pub error: f64,
    /// The part of `error` that is rounding \[mm\].
    pub rounding: f64,
    /// Largest error that was asked for \[mm\].
    pub tolerance: f64,
    /// Reason for the choice: one sentence for the summary.
    pub reason: String,
    /// The strips of spectral columns: of the wheel, and of a roller.
    strips: Vec<Vec<Strip>>,
}

impl Plan {
    /// Fills the grid for which the plan was made. If larger truncation errors are measured meanwhile, the estimate is
    /// raised to them.
    pub fn fill(&mut self, placement: &Placement, xi: &[f64], axis: &EtaAxis, out: &mut [f64]) {
        let truncation = match self.choice.method {
            Method::Spectral => self.choice.fill_by_strips(placement, xi, axis, &self.strips, out),
            _ => self.choice.fill(placement, xi, axis, out),
        };
        self.error = nan_max(self.error, BETWEEN_SAMPLES * truncation + self.rounding);
    }
}

/// Finds the cheapest method whose estimated error over the grid is below `tolerance` \[mm\], or plans the `forced` one.
///
/// The candidates are the quadratic form and spectral columns; under a wheel that varies around its axle, single points take the
/// place of spectral columns. The methods between them on the ladder have larger errors
/// than spectral columns and take no less time, because every column (under a skewed wheel every point) needs a gap of its
/// own. At [`FULL_PRECISION`] and below, the quadratic form is chosen only if it is exact to rounding.
///
/// The estimate: spectral columns measure their truncation error in every strip, at its nodes and between them, and in some
/// of the columns outside strips; the columns on both sides of the places where a step of the wheel crosses the grid are
/// compared with single points. A quadratic form is compared with single points at some 50 places, other methods at some 4,000; while
/// they fill a grid over which a body ends or the wheel steps, everywhere. Cost: for spectral columns about that of filling the grid,
/// for a quadratic form half of it.
///
/// # Examples
/// ```
/// # use wheelrail::{Arc, Half, Pair, Profile, Segment};
/// use wheelrail::separation::{EtaAxis, FULL_PRECISION, plan};
/// # let rail = Arc::about([0.0, -300.0], 300.0, Half::Upper, [-35.0, 35.0])?;
/// # let rail = Profile::new("crown", "", vec![Segment::arc(rail)])?;
/// # let wheel = Profile::new("cylinder", "", vec![Segment::arc(Arc::line([-60.0, 0.0], [60.0, 0.0])?)])?;
/// # let pair = Pair::new(rail, wheel, 460.0)?;
/// let placement = pair.placed(0.0, 0.0, 0.0)?; // a crown of 300 mm below a cylinder of 460 mm
/// let (xi, eta) = (vec![0.0, 2.0], EtaAxis::new(&[-5.0, 0.0, 5.0]));
/// let mut plan = plan(&placement, &xi, &eta, FULL_PRECISION, None);
/// let mut s = vec![0.0; 6];
/// plan.fill(&placement, &xi, &eta, &mut s);
/// assert_eq!(s[1], 0.0); // C itself: ξ = η = 0
/// assert!((s[2] - (460.0 - f64::sqrt(460.0 * 460.0 - 5.0 * 5.0))).abs() < 1e-13);
/// assert!(plan.error < FULL_PRECISION);
/// # Ok::<(), wheelrail::Error>(())
/// ```
pub fn plan(
    placement: &Placement,
    xi: &[f64],
    axis: &EtaAxis,
    tolerance: f64,
    forced: Option<Method>,
) -> Plan {
    let grid = Planned { placement, xi, axis, tolerance };
    match forced {
        Some(Method::Spectral) if placement.lofted_wheel().is_none() => {
            grid.spectral(&Probe::new(&grid), "asked for by the scene".into())
        }
        Some(method) => grid.sampled(method, &Probe::new(&grid), "asked for by the scene".into()),
        None => grid.cheapest(),
    }
}

/// The grid for which a plan is made, with its tolerance.
struct Planned<'a> {
    placement: &'a Placement,
    xi: &'a [f64],
    axis: &'a EtaAxis,
    tolerance: f64,
}

impl Planned<'_> {
    fn cheapest(&self) -> Plan {
        let probe = Probe::new(self);
        let tolerance = self.tolerance;
        let acceptable = |error: f64, rounding: f64| {
            error <= tolerance && (tolerance > FULL_PRECISION || error <= rounding)
        };
        let mut found = BETWEEN_SAMPLES * probe.quadratic + probe.rounding;
        if acceptable(found, probe.rounding) && covered(self.placement, self.xi, self.axis) {
            let plan =
                self.sampled(Method::Quadratic, &probe, format!("cheapest of all, within {tolerance:e} mm"));
            if acceptable(plan.error, plan.rounding) {
                return plan;
            }
            found = plan.error;
        }
        let quadratic = Method::Quadratic.name();
        let why = if found.is_nan() || acceptable(found, probe.rounding) {
            format!("{quadratic} knows no ends, steps or kinks")
        } else {
            format!("{quadratic} is off by {found:.1e} mm or more")
        };
        if let Some(varying) = self.placement.varying().filter(|_| self.placement.lofted_wheel().is_some()) {
            return self.sampled(
                Method::Pointwise,
                &probe,
                format!("columns have no form for {varying}; {why}"),
            );
        }
        self.spectral(&probe, format!("cheapest within {tolerance:e} mm; {why}"))
    }

    /// Plans a method whose error is estimated by comparison with single points, from which those of [`Method::Pointwise`] do not differ.
    fn sampled(&self, method: Method, probe: &Probe, reason: String) -> Plan {
        let choice = Choice { method, demand: Demand::for_tolerance(self.tolerance), coefficients: 1 };
        let difference = match method {
            Method::Pointwise => 0.0,
            _ => Samples::new(self.placement, self.xi, self.axis, method).difference(&choice),
        };
        let rounding = probe.rounding;
        let error = BETWEEN_SAMPLES * difference + rounding;
        Plan { choice, error, rounding, tolerance: self.tolerance, reason, strips: Vec::new() }
    }

    fn spectral(&self, probe: &Probe, reason: String) -> Plan {
        let demand = Demand::for_tolerance(self.tolerance);
        let (mut strips, mut coefficients, mut truncation) = (Vec::new(), 1, 0.0);
        for relief in Relief::all(self.placement) {
            let mut fitter = Fitter::new(relief, demand, 1);
            if fitter.relief.is_skewed() {
                strips.push(Vec::new());
                truncation += self.skewed(&mut fitter);
                continue;
            }
            let (own, count, error) = self.measured(&mut fitter);
            strips.push(own);
            coefficients = count.max(coefficients);
            truncation += error;
        }
        let choice = Choice { method: Method::Spectral, demand, coefficients };
        let rounding = probe.rounding;
        let truncation = nan_max(truncation, self.beside_steps(&choice, &strips));
        let error = BETWEEN_SAMPLES * truncation + rounding;
        Plan { choice, error, rounding, tolerance: self.tolerance, reason, strips }
    }

    /// Measures the largest difference \[mm\] of spectral columns from single points beside the steps of the wheel.
    fn beside_steps(&self, choice: &Choice, strips: &[Vec<Strip>]) -> f64 {
        let beside = |relief| beside_steps(&relief, self.xi, self.axis);
        let mut columns: Vec<f64> = Relief::all(self.placement).flat_map(beside).collect();
        columns.sort_by(f64::total_cmp);
        columns.dedup();
        if columns.is_empty() {
            return 0.0;
        }
        let (eta, mut evaluator) = (&self.axis.eta, Evaluator::new(self.placement));
        let [mut values, mut exact] = [(); 2].map(|()| vec![f64::NAN; columns.len() * eta.len()]);
        choice.fill_by_strips(self.placement, &columns, self.axis, strips, &mut values);
        for (&xi, exact) in columns.iter().zip(exact.chunks_mut(eta.len().max(1))) {
            evaluator.column(xi, eta, exact);
        }
        difference(&values, &exact)
    }

    /// Makes the strips. Returns them, the number of coefficients with which columns in no strip start (enough for two
    /// thirds of them), and the largest measured truncation error \[mm\].
    fn measured(&self, fitter: &mut Fitter<'_>) -> (Vec<Strip>, usize, f64) {
        let u_max = self.axis.reach * self.axis.reach;
        let strips = strips(fitter, self.xi, u_max);
        let mut most = strips.iter().map(|strip| strip.truncation).fold(0.0, f64::max);
        let mut needed: Vec<usize> = strips.iter().map(|strip| strip.coefficients).collect();
        for strip in &strips {
            most = nan_max(most, truncation::of_strip(fitter, strip, u_max));
        }
        let alone = thinned(&alone(&strips, self.xi), COLUMNS_ALONE);
        most = nan_max(most, truncation::of_columns(fitter, &alone, u_max, &mut needed));
        needed.sort_unstable();
        (strips, needed.get(needed.len() * 2 / 3).copied().unwrap_or(1), most)
    }

    /// Measures the largest error \[mm\] in some columns of a skewed wheel.
    fn skewed(&self, fitter: &mut Fitter<'_>) -> f64 {
        let eta = &self.axis.eta;
        let Fitter { relief, arch, demand, .. } = fitter;
        let mut out = vec![f64::NAN; eta.len()];
        let mut error = 0f64;
        for xi in thinned(self.xi, SKEWED_COLUMNS) {
            error = error.max(skewed::fill(relief, (*arch, *demand), xi, eta, &mut out));
            for at in places(eta.len(), SKEWED_ETA) {
                let exact = relief.height(xi, eta[at]);
                error = nan_max(error, difference(&out[at..=at], &[exact]));
            }
        }
        error
    }
}

/// Finds the columns that are in no strip.
fn alone(strips: &[Strip], xi: &[f64]) -> Vec<f64> {
    let mut alone = Vec::new();
    let mut rest = xi;
    for strip in strips {
        let (before, others) = rest.split_at(rest.partition_point(|&xi| xi <= strip.xi.low));
        alone.extend_from_slice(before);
        rest = &others[others.partition_point(|&xi| xi < strip.xi.high)..];
    }
    alone.extend_from_slice(rest);
    alone
}

/// Errors at a few places of the grid, evenly spread over both axes.
struct Probe {
    /// Largest error of the quadratic form \[mm\].
    quadratic: f64,
    /// Rounding error of s \[mm\].
    rounding: f64,
}

impl Probe {
    fn new(grid: &Planned<'_>) -> Self {
        let Planned { placement, xi, axis, .. } = *grid;
        let [along, mixed, across] = quadratic_form(placement);
        let mut evaluator = Evaluator::new(placement);
        let (mut most, mut quadratic) = (0f64, 0f64);
        for count in [PROBED, PROBED_BESIDE_ENDS] {
            for xi in places(xi.len(), count).map(|k| xi[k]) {
                for eta in places(axis.eta.len(), count).map(|k| axis.eta[k]) {
                    let [exact, size] = evaluator.separation_and_size(xi, eta);
                    let form = along * xi * xi + eta * (mixed * xi + across * eta);
                    most = most.max(size);
                    quadratic = nan_max(quadratic, difference(&[form], &[exact]));
                }
            }
            // NaN: a body has no surface at one of these places, or touches with a kink.
            if !quadratic.is_nan() {
                break;
            }
        }
        let of_reliefs = Relief::all(placement).map(|relief| rounding(&relief, xi, axis, most));
        let of_feet = placement.lofted().map_or(0.0, |_| FramedLoft::ROUNDING);
        Self { quadratic, rounding: of_reliefs.sum::<f64>() + of_feet }
    }
}

//! The accuracy ladder, and how each of its methods fills a grid.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::axis::EtaAxis;
use super::columns::fit::Fitter;
use super::columns::strip::Strip;
use super::columns::strips::strips;
use super::demand::Demand;
use super::kernel::Kernel;
use super::mask::{Masked, covered};
use super::methods::parabolic::Parabolic;
use super::methods::pointwise::Pointwise;
use super::methods::quadratic::Quadratic;
use super::methods::report_newton::{self, ReportNewton};
use super::methods::spectral::Spectral;
use super::relief::Relief;
use crate::lofted::{Feet, FramedLoft};
use crate::numerics::lanes::MANY;
use crate::numerics::nan_max;
use crate::placement::Placement;

/// Number of columns of one block, which is the unit of work of a thread.
pub const BLOCK: usize = MANY;

/// Most points of a grid that is filled by one thread, because waking another takes some 50 µs: for methods that fill
/// columns, and for methods that work point by point.
const FEW_POINTS: [usize; 2] = [65536, 4096];

/// The methods of the accuracy ladder, from the simplest formula to the historical baseline.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(feature = "files", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Second-order expansion of s at C (Hertz).
    Quadratic,
    /// g(ξ) + η²/2R.
    ConstantRadius,
    /// g(ξ) + q(ξ, 0) η².
    Parabolic,
    /// Polynomial columns that keep the tolerance.
    Spectral,
    /// Sagitta iteration at every point.
    Pointwise,
    /// The Report's Newton iteration on (6.13), as printed.
    ReportNewton,
}

impl Method {
    /// All methods, in order of the ladder.
    pub const ALL: [Self; 6] = [
        Self::Quadratic,
        Self::ConstantRadius,
        Self::Parabolic,
        Self::Spectral,
        Self::Pointwise,
        Self::ReportNewton,
    ];

    /// Returns the name of the method in scenes and reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Quadratic => "quadratic",
            Self::ConstantRadius => "constant-radius",
            Self::Parabolic => "parabolic",
            Self::Spectral => "spectral",
            Self::Pointwise => "pointwise",
            Self::ReportNewton => "report-newton",
        }
    }

    /// Names the feature of a placed pair for which the method has no formula; its values are then NaN. Returns `None` if it has formulas
    /// for everything.
    pub fn missing(self, placement: &Placement) -> Option<&'static str> {
        match self {
            Self::ConstantRadius | Self::Parabolic | Self::Spectral => {
                placement.lofted_wheel().and_then(|_| placement.varying())
            }
            Self::ReportNewton => report_newton::missing(placement),
            Self::Quadratic | Self::Pointwise => None,
        }
    }
}

/// A method with the accuracy to which it runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Choice {
    /// The method.
    pub method: Method,
    /// The accuracy demanded of s. Its `absolute` is also the tolerance on the steps of the Report's method.
    pub demand: Demand,
    /// Number of coefficients that spectral columns start with.
    pub coefficients: usize,
}

impl Choice {
    /// Writes s \[mm\] over the grid, at index i_ξ · n_η + i_η; NaN where a body has no surface, and everywhere if
    /// [`Method::missing`] names a feature. Returns the largest truncation error \[mm\] that was measured meanwhile; 0 if none is
    /// measured. A method without an error measure of its own is compared with single points if a body ends or the wheel steps
    /// within the grid.
    ///
    /// It runs on the threads of the current rayon pool. Any number of threads gives the same bits.
    pub fn fill(&self, placement: &Placement, xi: &[f64], axis: &EtaAxis, out: &mut [f64]) -> f64 {
        if axis.eta.is_empty() {
            return 0.0;
        }
        if self.method.missing(placement).is_some() {
            out.fill(f64::NAN);
            return 0.0;
        }
        let bare: &(dyn Fn() -> Box<dyn Kernel> + Sync) = match self.method {
            Method::Quadratic => &|| Box::new(Quadratic::new(placement, axis)),
            Method::ConstantRadius => &|| {
                let radii = [placement.wheel(), placement.rail()].map(|body| body.generator().radius());
                summed(placement, axis, |k, relief| {
                    Box::new(Parabolic::constant_radius(relief, radii[k], axis))
                })
            },
            Method::Parabolic => {
                &|| summed(placement, axis, |_, relief| Box::new(Parabolic::local(relief, axis)))
            }
            Method::Spectral => {
                let strips = |relief| strips(&mut self.fitter(relief), xi, axis.reach * axis.reach);
                let strips: Vec<_> = Relief::all(placement).map(strips).collect();
                return self.fill_by_strips(placement, xi, axis, &strips, out);
            }
            Method::Pointwise => &|| Box::new(Pointwise::new(placement, axis)),
            Method::ReportNewton => &|| Box::new(ReportNewton::new(placement, axis, self.demand.absolute)),
        };
        let masked = self.method != Method::Pointwise && !covered(placement, xi, axis);
        let kernel = || if masked { Box::new(Masked::new(bare(), placement, axis)) } else { bare() };
        let by_columns = self.method < Method::Pointwise && !masked;
        fill_all(kernel, by_columns, xi, out)
    }

    /// Fills the grid by spectral columns, with given strips of every relief of this pair and grid.
    pub(super) fn fill_by_strips(
        &self,
        placement: &Placement,
        xi: &[f64],
        axis: &EtaAxis,
        strips: &[Vec<Strip>],
        out: &mut [f64],
    ) -> f64 {
        if axis.eta.is_empty() {
            return 0.0;
        }
        let largest = |strips: &Vec<Strip>| strips.iter().map(|strip| strip.truncation).fold(0.0, f64::max);
        let of_strips: f64 = strips.iter().map(largest).sum();
        let kernel = || {
            summed(placement, axis, |k, relief| {
                Box::new(Spectral::new(self.fitter(relief), axis, &strips[k]))
            })
        };
        fill_all(kernel, true, xi, out).max(of_strips)
    }

    fn fitter<'a>(&self, relief: Relief<'a>) -> Fitter<'a> {
        Fitter::new(relief, self.demand, self.coefficients)
    }
}

/// Makes the kernel of a pair from those of its reliefs; `make` gets the number of the relief.
fn summed<'a>(
    placement: &'a Placement,
    axis: &'a EtaAxis,
    make: impl Fn(usize, Relief<'a>) -> Box<dyn Kernel + 'a>,
) -> Box<dyn Kernel + 'a> {
    let wheel = make(0, Relief::new(placement));
    if let Some(rail) = placement.lofted_rail() {
        return Box::new(OverLoft { wheel, rail, axis });
    }
    match placement.under() {
        Some(under) => Box::new(ReliefSum::new(wheel, make(1, Relief::new(under)))),
        None => wheel,
    }
}

/// The relief of a wheel over the tangent plane, less the height of a rail that varies along the track.
struct OverLoft<'a> {
    wheel: Box<dyn Kernel + 'a>,
    rail: &'a FramedLoft,
    axis: &'a EtaAxis,
}

impl Kernel for OverLoft<'_> {
    fn column(&mut self, xi: f64, out: &mut [f64]) {
        self.columns(&[xi], out);
    }

    fn columns(&mut self, xi: &[f64], out: &mut [f64]) {
        let eta = &self.axis.eta;
        self.wheel.columns(xi, out);
        for (&xi, out) in xi.iter().zip(out.chunks_exact_mut(eta.len())) {
            // Every column begins with feet of its own, so that any number of threads gives the same bits.
            let mut feet = Feet::new(self.rail);
            out.iter_mut().zip(eta).for_each(|(s, &eta)| *s -= feet.height(xi, eta));
        }
    }

    fn truncation(&self) -> f64 {
        self.wheel.truncation()
    }
}

/// The sum of the heights of a wheel over a profile, and of this profile over a roller.
pub struct ReliefSum<'a> {
    wheel: Box<dyn Kernel + 'a>,
    roller: Box<dyn Kernel + 'a>,
    /// Values of the roller \[mm\].
    falls: Vec<f64>,
}

impl<'a> ReliefSum<'a> {
    /// Makes the sum of two kernels.
    pub fn new(wheel: Box<dyn Kernel + 'a>, roller: Box<dyn Kernel + 'a>) -> Self {
        Self { wheel, roller, falls: Vec::new() }
    }
}

impl Kernel for ReliefSum<'_> {
    fn column(&mut self, xi: f64, out: &mut [f64]) {
        self.columns(&[xi], out);
    }

    fn columns(&mut self, xi: &[f64], out: &mut [f64]) {
        self.falls.resize(out.len(), f64::NAN);
        self.wheel.columns(xi, out);
        self.roller.columns(xi, &mut self.falls);
        out.iter_mut().zip(&self.falls).for_each(|(s, fall)| *s += fall);
    }

    fn truncation(&self) -> f64 {
        self.wheel.truncation() + self.roller.truncation()
    }
}

/// Fills all columns by one kernel. Returns the largest truncation error \[mm\].
fn fill_with(kernel: &mut dyn Kernel, xi: &[f64], out: &mut [f64]) -> f64 {
    kernel.columns(xi, out);
    kernel.truncation()
}

/// Fills all columns, many points by one kernel for each thread. `by_columns` says that the kernel needs less time for a column than
/// for its points. Returns the largest truncation error \[mm\].
pub fn fill_all<'k>(
    kernel: impl Fn() -> Box<dyn Kernel + 'k> + Sync,
    by_columns: bool,
    xi: &[f64],
    out: &mut [f64],
) -> f64 {
    if out.len() <= FEW_POINTS[usize::from(!by_columns)] {
        return fill_with(&mut *kernel(), xi, out);
    }
    let length = out.len() / xi.len().max(1);
    let blocks = out.par_chunks_mut(BLOCK * length).zip(xi.par_chunks(BLOCK));
    blocks.map_init(&kernel, |kernel, (out, xi)| fill_with(&mut **kernel, xi, out)).reduce(|| 0.0, nan_max)
}

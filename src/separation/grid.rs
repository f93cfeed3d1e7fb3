//! The ladder of methods behind one interface, and the grid they fill.

use rayon::prelude::*;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::approximate::{Parabolic, Quadratic};
use super::axis::EtaAxis;
use super::columns::MANY;
use super::pointwise::Pointwise;
use super::report_newton::ReportNewton;
use super::spectral::{Demand, Spectral};
use super::strips::{Strip, strips};
use super::values::Residence;
use crate::placement::Placement;

/// Columns of one block: the unit of work of a thread.
const BLOCK: usize = MANY;

/// Up to so many points are not worth waking another thread, some 50 µs: of whole columns, and of points one by one.
const FEW_POINTS: [usize; 2] = [65536, 4096];

/// A way to evaluate s over columns of constant ξ.
pub trait Kernel {
    /// Writes s(ξ, η_j) for all η_j of the axis \[mm\]; NaN where a body has no surface.
    fn column(&mut self, xi: f64, out: &mut [f64]);

    /// Writes neighbouring columns, one after the other.
    fn columns(&mut self, xi: &[f64], out: &mut [f64]) {
        let length = out.len() / xi.len().max(1);
        for (&xi, out) in xi.iter().zip(out.chunks_exact_mut(length)) {
            self.column(xi, out);
        }
    }

    /// Largest truncation error \[mm\] that was measured so far.
    fn truncation(&self) -> f64 {
        0.0
    }
}

/// The accuracy ladder, from the simplest formula to the historical baseline.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Second-order expansion at C (Hertz).
    Quadratic,
    /// g(ξ) + η²/2R.
    ConstantRadius,
    /// g(ξ) + q(ξ, 0) η².
    Parabolic,
    /// Polynomial columns to the tolerance.
    Spectral,
    /// Sagitta iteration at every point.
    Pointwise,
    /// The Report's Newton iteration on (6.13), as printed.
    ReportNewton,
}

impl Method {
    /// All of them, in order of the ladder.
    pub const ALL: [Self; 6] = [
        Self::Quadratic,
        Self::ConstantRadius,
        Self::Parabolic,
        Self::Spectral,
        Self::Pointwise,
        Self::ReportNewton,
    ];

    /// Its name in scenes and reports.
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
}

/// A method ready to run to a tolerance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Choice {
    /// The method.
    pub method: Method,
    /// What s is held to; its `absolute` is the tolerance on the Report's steps.
    pub demand: Demand,
    /// Coefficients that spectral columns start with.
    pub coefficients: usize,
}

impl Choice {
    /// s over the grid, index i_ξ · n_η + i_η, on the threads of the current rayon pool. The same bits come
    /// out for any number of threads; fastest where `out` is [`super::values::Values`]. Returns the largest truncation error
    /// \[mm\] that was measured on the way, 0 where none is.
    pub fn fill(&self, placement: &Placement, xi: &[f64], axis: &EtaAxis, out: &mut [f64]) -> f64 {
        if axis.eta.is_empty() {
            return 0.0;
        }
        let kernel: &(dyn Fn() -> Box<dyn Kernel> + Sync) = match self.method {
            Method::Quadratic => &|| Box::new(Quadratic::new(placement, axis)),
            Method::ConstantRadius => &|| Box::new(Parabolic::constant_radius(placement, axis)),
            Method::Parabolic => &|| Box::new(Parabolic::local(placement, axis)),
            Method::Spectral => {
                let mut spectral = self.spectral(placement, axis);
                let strips = strips(&mut spectral, placement, xi, axis.reach * axis.reach);
                return self.fill_by_strips(placement, xi, axis, &strips, out);
            }
            Method::Pointwise => &|| Box::new(Pointwise::new(placement, axis)),
            Method::ReportNewton => &|| Box::new(ReportNewton::new(placement, axis, self.demand.absolute)),
        };
        let by_columns = self.method < Method::Pointwise;
        if out.len() <= FEW_POINTS[usize::from(!by_columns)] {
            return fill_with(&mut *kernel(), xi, out);
        }
        fill_in_blocks(kernel, xi, out)
    }

    /// The same by spectral columns with the strips of this pair and grid.
    pub(super) fn fill_by_strips(
        &self,
        placement: &Placement,
        xi: &[f64],
        axis: &EtaAxis,
        strips: &[Strip],
        out: &mut [f64],
    ) -> f64 {
        if axis.eta.is_empty() {
            return 0.0;
        }
        let of_strips = strips.iter().map(|strip| strip.truncation).fold(0.0, f64::max);
        let residence = Residence::of(out.len());
        let kernel = || self.spectral(placement, axis).with_strips(strips, residence);
        if out.len() <= FEW_POINTS[0] {
            return fill_with(&mut kernel(), xi, out).max(of_strips);
        }
        fill_in_blocks(|| Box::new(kernel()), xi, out).max(of_strips)
    }

    fn spectral<'a>(&self, placement: &'a Placement, axis: &'a EtaAxis) -> Spectral<'a> {
        Spectral::new(placement, axis, self.demand, self.coefficients)
    }
}

/// All columns by one kernel; the largest truncation error \[mm\].
fn fill_with(kernel: &mut dyn Kernel, xi: &[f64], out: &mut [f64]) -> f64 {
    kernel.columns(xi, out);
    kernel.truncation()
}

/// All columns by the threads' kernels; the largest truncation error \[mm\].
fn fill_in_blocks<'k>(kernel: impl Fn() -> Box<dyn Kernel + 'k> + Sync, xi: &[f64], out: &mut [f64]) -> f64 {
    let length = out.len() / xi.len().max(1);
    let blocks = out.par_chunks_mut(BLOCK * length).zip(xi.par_chunks(BLOCK));
    blocks.map_init(&kernel, |kernel, (out, xi)| fill_with(&mut **kernel, xi, out)).reduce(|| 0.0, f64::max)
}

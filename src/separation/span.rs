//! Parts of columns that lie over one branch of the wheel, and points on them, by their sagittae.

use crate::numerics::interval::Interval;
use crate::numerics::lanes::Lanes;
use crate::profile::{BranchPoint, BranchPoints, Branches};

/// The part of a column that lies over one branch of the wheel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Span {
    /// Range of e \[mm\]; the end may be infinite.
    pub e: Interval,
    /// Range of u = η² \[mm²\]; the end may be infinite.
    pub u: Interval,
    /// Index of the branch.
    pub branch: usize,
    /// Index of the piece of the envelope.
    pub(super) piece: usize,
    /// ζ of the wheel at the beginning of the span \[mm\].
    pub height: f64,
    /// Axle distance w at the beginning of the span \[mm\].
    pub w: f64,
    /// The profile point at the beginning of the span.
    pub(super) begin: BranchPoint,
}

/// A point of the wheel over one span of a column, found by its sagitta.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SagittaPoint {
    /// Sagitta e \[mm\].
    pub e: f64,
    /// ζ above its value at the beginning of the span \[mm\].
    pub rise: f64,
    /// Axle distance w \[mm\].
    pub w: f64,
    /// u = η² \[mm²\].
    pub u: f64,
}

/// One span of N columns. Each begins where its column enters its branch and ends where it leaves it.
#[derive(Debug)]
pub struct SpanLanes<'a, const N: usize> {
    /// The branches over which the columns lie.
    pub branches: Branches<'a, N>,
    /// The profile points at the beginning of the span.
    pub points: BranchPoints<N>,
    /// ζ of the wheel at the beginning of the span \[mm\].
    pub height: Lanes<N>,
    /// Axle distance at the beginning of the span \[mm\].
    pub w: Lanes<N>,
    /// Range of e \[mm\]; the end may be infinite.
    pub e: [Lanes<N>; 2],
    /// Range of u \[mm²\].
    pub u: [Lanes<N>; 2],
}

/// Points of the wheel by their sagittae, one for each of N columns.
pub struct SagittaPoints<const N: usize> {
    /// Sagitta \[mm\].
    pub e: Lanes<N>,
    /// ζ above its value at the beginning of the span \[mm\].
    pub rise: Lanes<N>,
    /// Axle distance \[mm\].
    pub w: Lanes<N>,
    /// u \[mm²\].
    pub u: Lanes<N>,
    /// u less its value at the beginning of the span \[mm²\]; the difference does not cancel.
    pub v: Lanes<N>,
}

impl From<SagittaPoints<1>> for SagittaPoint {
    #[inline(always)]
    fn from(SagittaPoints { e: [e], rise: [rise], w: [w], u: [u], .. }: SagittaPoints<1>) -> Self {
        Self { e, rise, w, u }
    }
}

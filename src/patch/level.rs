//! The gap of which one level bounds a patch: over the tangent plane or over the rail's own surface.

use crate::conformal::{GapColumn, NormalGap, RailPoint, Reference};
use crate::numerics::interval::Interval;
use crate::placement::Placement;
use crate::separation::Evaluator;

/// Half the step \[mm\] of a difference along σ. A turn of the gap that is found with it is off by less than 1e-6 mm, and its depth by
/// less than rounding.
const HALF_STEP: f64 = 1e-5;

/// The gap whose level δ bounds the patch.
#[derive(Debug)]
pub(super) enum Level<'a> {
    /// s(ξ, η).
    Plane(Evaluator<'a>),
    /// t(σ, η) + δ (1 − cos α), which is δ where t is δ cos α.
    Rail {
        /// t.
        gap: NormalGap<'a>,
        /// δ \[mm\].
        approach: f64,
        /// The column of the last point.
        column: Option<GapColumn>,
    },
}

impl<'a> Level<'a> {
    /// Makes that of a placed pair over a surface, for an approach δ \[mm\].
    pub(super) fn new(placement: &'a Placement, approach: f64, reference: Reference) -> Self {
        match reference {
            Reference::Plane => Self::Plane(Evaluator::new(placement)),
            Reference::Rail => Self::Rail { gap: NormalGap::new(placement), approach, column: None },
        }
    }

    /// Returns the normal gap over the rail's surface; `None` over the tangent plane.
    pub(super) fn normal_gap(&self) -> Option<&NormalGap<'a>> {
        match self {
            Self::Plane(_) => None,
            Self::Rail { gap, .. } => Some(gap),
        }
    }

    /// Returns the gap \[mm\]; NaN where a body has no surface.
    pub(super) fn gap(&mut self, xi: f64, eta: f64) -> f64 {
        match self {
            Self::Plane(evaluator) => evaluator.separation(xi, eta),
            Self::Rail { gap, approach, column } => known(gap, column, xi).map_or(f64::NAN, |column| {
                // 1 − cos α without a difference of nearly equal numbers.
                let RailPoint { cos, sin, .. } = column.rail;
                gap.gap_in(column, eta) + *approach * (sin * sin / (1.0 + cos))
            }),
        }
    }

    /// Returns \[∂/∂ξ, ∂/∂η\] of the gap. Over the rail's surface ∂/∂σ is a difference over 2e-5 mm, which is right where the gap turns but
    /// not to all digits.
    pub(super) fn gradient(&mut self, xi: f64, eta: f64) -> [f64; 2] {
        match self {
            Self::Plane(evaluator) => evaluator.separation_and_gradient(xi, eta).1,
            Self::Rail { gap, .. } => {
                let reach = gap.rail().reach().unwrap_or(Interval::of(f64::NAN));
                let ends = Interval::of(xi).grown(HALF_STEP).cut(reach);
                [ends.map(|xi| self.gap(xi, eta)).width() / ends.width(), self.slope(xi, eta)]
            }
        }
    }

    /// Returns ∂/∂η of the gap.
    pub(super) fn slope(&mut self, xi: f64, eta: f64) -> f64 {
        match self {
            Self::Plane(evaluator) => evaluator.separation_and_gradient(xi, eta).1[1],
            Self::Rail { gap, column, .. } => {
                known(gap, column, xi).map_or(f64::NAN, |column| gap.slope_in(column, eta))
            }
        }
    }
}

/// Takes the last column if it is that of σ \[mm\].
fn known<'c>(
    gap: &NormalGap<'_>,
    column: &'c mut Option<GapColumn>,
    sigma: f64,
) -> Option<&'c mut GapColumn> {
    if column.as_ref().is_none_or(|column| column.rail.sigma != sigma) {
        *column = gap.column(sigma);
    }
    column.as_mut()
}

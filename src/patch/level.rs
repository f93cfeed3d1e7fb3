//! The gap of which one level bounds a patch: over the tangent plane or over the rail's own surface.

use crate::conformal::{GapColumn, NormalGap, RailPoint, Reference};
use crate::numerics::interval::Interval;
use crate::placement::Placement;
use crate::profile::Section;
use crate::separation::{Evaluator, GapSlopes};

/// Least step of a profile, in roundings of its size. A smaller one is a smooth joint whose two sides round differently.
const STEP_ROUNDINGS: f64 = 64.0;

/// The gap whose level δ bounds the patch.
#[derive(Debug)]
pub(super) enum Level<'a> {
    /// s(ξ, η).
    Plane(Evaluator<'a>),
    /// t(σ, η) + δ (1 − cos α), which is δ where t is δ cos α.
    Rail {
        /// Computes t.
        gap: NormalGap<'a>,
        /// δ \[mm\].
        approach: f64,
        /// The column of the last point.
        column: Option<GapColumn>,
    },
}

impl<'a> Level<'a> {
    /// Makes the gap of a placed pair over a surface, for an approach δ \[mm\].
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
            Self::Rail { gap, approach, column } => known(gap, column, xi)
                .map_or(f64::NAN, |column| gap.gap_in(column, eta) + *approach * versine(&column.rail)),
        }
    }

    /// Returns whether swept bodies have surfaces at a place of a line that has the profile below.
    pub(super) fn has_surface(&mut self, xi: f64, eta: f64) -> bool {
        match self {
            Self::Plane(evaluator) => evaluator.has_surface(xi, eta),
            Self::Rail { .. } => !self.gap(xi, eta).is_nan(),
        }
    }

    /// Returns the gap, its slopes along ξ and η, and the abscissae of the profiles' points. Where a body has no surface the result is
    /// `None`, or the gap is NaN.
    pub(super) fn at(&mut self, xi: f64, eta: f64) -> Option<GapSlopes> {
        match self {
            Self::Plane(evaluator) => evaluator.gap_and_slopes(xi, eta),
            Self::Rail { gap, approach, column } => {
                let column = known(gap, column, xi)?;
                let mut at = gap.slopes_in(column, eta)?;
                at.gap += *approach * versine(&column.rail);
                at.slopes[0] += *approach * column.rail.sin * column.rail.curvature;
                Some(at)
            }
        }
    }

    /// Returns \[∂/∂ξ, ∂/∂η\] of the gap; ∂/∂ξ is NaN where a body has no surface.
    pub(super) fn gradient(&mut self, xi: f64, eta: f64) -> [f64; 2] {
        self.at(xi, eta).map_or([f64::NAN; 2], |at| at.slopes)
    }

    /// Returns ∂/∂η of the gap.
    pub(super) fn slope(&mut self, xi: f64, eta: f64) -> f64 {
        self.gradient(xi, eta)[1]
    }
}

/// Returns the ξ inside an interval \[mm\] at which the rail has joints, or over its surface the σ.
pub(super) fn joints(placement: &Placement, over_rail: Option<&NormalGap<'_>>, over: Interval) -> Vec<f64> {
    if placement.lofted_rail().is_some() {
        // Its cells' sides are no lines of constant ξ.
        return Vec::new();
    }
    let joints = match over_rail {
        Some(gap) => gap.rail().joints(),
        None => placement.rail().section.joints(over).map(|(xi, _)| xi).collect(),
    };
    joints.into_iter().filter(|xi| over.surrounds(*xi)).collect()
}

/// Returns the ξ between the ends of a range \[mm\] at which a body's surface steps or ends because its profile overhangs. `extent` is
/// that of the profile \[mm\].
pub(super) fn steps(section: &Section, xi: Interval, extent: f64) -> impl Iterator<Item = f64> {
    let rounding = STEP_ROUNDINGS * f64::EPSILON * extent;
    let torn = move |k: usize| {
        let [left, right] = [&section.pieces[k - 1], &section.pieces[k]];
        left.xi.high != right.xi.low || (left.heights[1] - right.heights[0]).abs() > rounding
    };
    let torn = (1..section.pieces.len()).filter(move |&k| torn(k));
    let ends = torn.flat_map(|k| [section.pieces[k - 1].xi.high, section.pieces[k].xi.low]);
    ends.filter(move |end| xi.surrounds(*end))
}

/// Returns 1 − cos α, without a difference of nearly equal numbers.
fn versine(&RailPoint { cos, sin, .. }: &RailPoint) -> f64 {
    sin * sin / (1.0 + cos)
}

/// Returns the last column if it is that of σ \[mm\], else a new one in its place; `None` beyond the rail's range.
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

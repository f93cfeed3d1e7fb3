//! Marks the points of a grid where a body has no surface, the same points for every method.

use super::axis::EtaAxis;
use super::evaluator::Evaluator;
use super::kernel::Kernel;
use super::relief::Relief;
use super::wheel_surface::sagitta;
use crate::numerics::interval::Interval;
use crate::numerics::nan_max;
use crate::placement::Placement;
use crate::profile::Section;

/// Share of a profile's least distance from the axle, at the ends of its pieces, below which it has no point. It covers what
/// bulges towards the axle between the ends.
const NEAREST_TO_AXLE: f64 = 0.5;

/// Returns whether both bodies have a surface over the whole grid and the wheel's has no step there. No point then needs a mask.
///
/// It is decided from the extents of the profiles and the largest sagitta of the grid. A grid that ends close to the end of a
/// profile may therefore count as not covered, and with a body that varies no grid counts as covered.
pub fn covered(placement: &Placement, xi: &[f64], axis: &EtaAxis) -> bool {
    // Where a body that varies has a surface is not known beforehand.
    placement.lofted().is_none() && Relief::all(placement).all(|relief| covers(&relief, xi, axis))
}

/// Returns whether a relief has a value over the whole grid, without a step of its wheel.
fn covers(relief: &Relief<'_>, xi: &[f64], axis: &EtaAxis) -> bool {
    let (Some(&first), Some(&last)) = (xi.first(), xi.last()) else { return true };
    let (Some(&low), Some(&high)) = (axis.eta.first(), axis.eta.last()) else { return true };
    let wheel = &relief.wheel;
    let (mut over, mut u) = (Interval::NONE, 0f64);
    for [xi, eta] in [[first, low], [first, high], [last, low], [last, high]] {
        let [shift, eta_w] = relief.skew.own(xi, eta);
        (over, u) = (over.with(xi + shift), u.max(eta_w * eta_w));
    }
    let ends =
        wheel.section.pieces.iter().flat_map(|piece| [0, 1].map(|end| (piece.xi[end], piece.heights[end])));
    let radii = ends.map(|(xi, height)| wheel.axle_distance(xi, height));
    let radius = NEAREST_TO_AXLE * radii.fold(f64::INFINITY, f64::min);
    // e = ρ − √(ρ² − u); it is NaN where the circle does not reach that far.
    let farthest = sagitta((radius * radius - u).sqrt(), u);
    let along = farthest * wheel.sin;
    is_whole(relief.below, Interval::new(first, last))
        && is_whole(wheel.section, Interval::new(over.low - along.max(0.0), over.high - along.min(0.0)))
        && farthest.is_finite()
}

/// Returns whether a section has a surface without steps over an interval.
fn is_whole(section: &Section, xi: Interval) -> bool {
    let pieces = &section.pieces;
    let stepped = |&step: &usize| pieces[step - 1].xi.high <= xi.high && xi.low <= pieces[step].xi.low;
    section.reach().is_some_and(|reach| reach.holds(xi)) && !section.steps.iter().any(stepped)
}

/// A method over a grid that is not [`covered`]. Every column is compared with single points, which have a number exactly
/// where both bodies have a surface.
pub struct Masked<'a> {
    method: Box<dyn Kernel + 'a>,
    evaluator: Evaluator<'a>,
    axis: &'a EtaAxis,
    /// s at the points of one column \[mm\].
    exact: Vec<f64>,
    /// Largest difference from single points so far \[mm\].
    difference: f64,
}

impl<'a> Masked<'a> {
    /// Masks a method.
    pub fn new(method: Box<dyn Kernel + 'a>, placement: &'a Placement, axis: &'a EtaAxis) -> Self {
        let exact = vec![f64::NAN; axis.eta.len()];
        Self { method, evaluator: Evaluator::new(placement), axis, exact, difference: 0.0 }
    }
}

impl Kernel for Masked<'_> {
    fn column(&mut self, xi: f64, out: &mut [f64]) {
        self.method.column(xi, out);
        self.evaluator.column(xi, &self.axis.eta, &mut self.exact);
        for (s, exact) in out.iter_mut().zip(&self.exact) {
            if exact.is_nan() {
                *s = f64::NAN;
            } else {
                self.difference = nan_max(self.difference, (*s - exact).abs());
            }
        }
    }

    fn truncation(&self) -> f64 {
        self.difference
    }
}

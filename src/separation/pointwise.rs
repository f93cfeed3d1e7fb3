//! Point-wise sagitta iteration at every point of the grid.

use super::Evaluator;
use super::axis::EtaAxis;
use super::grid::Kernel;
use crate::placement::Placement;

/// Every point on its own; the reference for all other methods.
#[derive(Debug)]
pub struct Pointwise<'a> {
    evaluator: Evaluator<'a>,
    axis: &'a EtaAxis,
}

impl<'a> Pointwise<'a> {
    /// Over a placed pair.
    pub fn new(placement: &'a Placement, axis: &'a EtaAxis) -> Self {
        Self { evaluator: Evaluator::new(placement), axis }
    }
}

impl Kernel for Pointwise<'_> {
    fn column(&mut self, xi: f64, out: &mut [f64]) {
        self.evaluator.column(xi, &self.axis.eta, out);
    }
}

//! Evaluates every point of a grid by its own sagitta iteration.

use crate::placement::Placement;
use crate::separation::axis::EtaAxis;
use crate::separation::evaluator::Evaluator;
use crate::separation::kernel::Kernel;

/// Evaluates every point on its own: the reference for all other methods.
#[derive(Debug)]
pub struct Pointwise<'a> {
    evaluator: Evaluator<'a>,
    axis: &'a EtaAxis,
}

impl<'a> Pointwise<'a> {
    /// Makes the method for a placed pair.
    pub fn new(placement: &'a Placement, axis: &'a EtaAxis) -> Self {
        Self { evaluator: Evaluator::new(placement), axis }
    }
}

impl Kernel for Pointwise<'_> {
    fn column(&mut self, xi: f64, out: &mut [f64]) {
        self.evaluator.column(xi, &self.axis.eta, out);
    }
}

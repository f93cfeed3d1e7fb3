//! Cuts off the slices of a patch at the edges of a window.

use super::slice::Slicer;
use super::window::Window;
use crate::conformal::Reference;
use crate::numerics::interval::Interval;
use crate::placement::Placement;

/// Slices of the patch {s < δ}, cut off at a window.
#[derive(Debug)]
pub struct Outline<'a> {
    pub(super) slicer: Slicer<'a>,
    pub(super) window: Window,
}

impl<'a> Outline<'a> {
    /// Makes the outline of a placed pair's patch at approach δ \[mm\] inside a window of ξ and η, or over the rail's surface of σ and η.
    pub fn new(placement: &'a Placement, approach: f64, window: &Window, reference: Reference) -> Self {
        Self { slicer: Slicer::over(placement, approach, (reference, window.eta)), window: *window }
    }

    /// Returns both ends of the slice at ξ, or of that of a lane; `None` outside the patch or the window.
    pub(crate) fn edges(&mut self, lane: Option<usize>, xi: f64) -> Option<[f64; 2]> {
        let [low, high] = self.slicer.edges(xi, lane)?;
        let cut = self.window.eta.cut(Interval::new(low, high));
        (cut.low <= cut.high).then_some(cut.ends())
    }

    /// Returns η \[mm\] of the least gap that bounds the patch at ξ within the window: the lowest place, or the window's edge next to it.
    pub(super) fn floor(&mut self, xi: f64) -> f64 {
        self.window.eta.nearest(self.slicer.valley(None, xi))
    }

    /// Returns \[s, ξ, η\] of the least s at ξ within the window.
    pub(super) fn lowest(&mut self, xi: f64) -> [f64; 3] {
        let eta = self.window.eta.nearest(self.slicer.nearest_to_rail(xi));
        [self.slicer.separation(xi, eta), xi, eta]
    }
}

//! Cuts off the slices of a patch at the edges of a window.

use serde::Serialize;

use super::skewed::slicer::Edge;
use super::slice::Slicer;
use crate::placement::Placement;

/// A rectangle of the ξ–η plane \[mm\] inside which a patch is sought.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Window {
    /// Range of ξ \[mm\].
    pub xi: [f64; 2],
    /// Range of η \[mm\].
    pub eta: [f64; 2],
}

impl Window {
    /// The whole plane: only the ends of the bodies bound the patch.
    pub const UNBOUNDED: Self =
        Self { xi: [f64::NEG_INFINITY, f64::INFINITY], eta: [f64::NEG_INFINITY, f64::INFINITY] };
}

/// What bounds a component at one of its ends in ξ.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum End {
    /// A tip: the two branches meet in a single point with s(ξ, η) = δ.
    Tip,
    /// The window cuts the component.
    Window,
    /// One of the bodies ends, or steps away from the other body behind an overhang.
    ProfileEnd,
}

/// Slices of the patch {s < δ}, cut off at a window.
#[derive(Debug)]
pub struct Outline<'a> {
    pub(super) slicer: Slicer<'a>,
    pub(super) window: Window,
}

impl<'a> Outline<'a> {
    /// Makes the outline of a placed pair's patch at approach δ \[mm\] inside a window.
    pub fn new(placement: &'a Placement, approach: f64, window: &Window) -> Self {
        Self { slicer: Slicer::new(placement, approach), window: *window }
    }

    /// Returns both ends of the slice at ξ; with skew, of the slice that holds `valley`. Returns `None` outside the patch
    /// or the window.
    pub(crate) fn edges(&mut self, valley: Option<usize>, xi: f64) -> Option<[Edge; 2]> {
        let edges = self.slicer.edges(xi, valley)?;
        self.clipped(edges)
    }

    /// Returns both ends of the slice at ξ, and dη/dξ of both branches there, which is 0 along the window. With skew the
    /// slice is the one that holds `valley`.
    pub(super) fn edges_and_slopes(
        &mut self,
        valley: Option<usize>,
        xi: f64,
    ) -> Option<([Edge; 2], [f64; 2])> {
        let (whole, slopes) = self.slicer.edges_and_slopes(xi, valley)?;
        let edges = self.clipped(whole)?;
        Some((edges, [0, 1].map(|k| if edges[k].eta == whole[k].eta { slopes[k] } else { 0.0 })))
    }

    fn clipped(&self, [mut low, mut high]: [Edge; 2]) -> Option<[Edge; 2]> {
        let [from, to] = self.window.eta;
        if low.eta < from {
            low = Edge { eta: from, ledge: false };
        }
        if high.eta > to {
            high = Edge { eta: to, ledge: false };
        }
        (low.eta <= high.eta).then_some([low, high])
    }

    /// Returns η \[mm\] of the least s at ξ within the window. It is the place of the valley (η = 0 without skew), or the
    /// window's edge next to it, because s rises away from the valley.
    pub(super) fn floor(&mut self, valley: Option<usize>, xi: f64) -> f64 {
        let ([from, to], lowest) = (self.window.eta, self.slicer.valley(valley, xi));
        // NaN stays NaN: there is no surface.
        if lowest < from {
            from
        } else if lowest > to {
            to
        } else {
            lowest
        }
    }

    /// Returns s − δ \[mm\] at the place of a valley, or at the window's edge next to it. It is infinite if s rises above δ
    /// between the valley and that edge.
    pub(super) fn depth(&mut self, valley: Option<usize>, xi: f64) -> f64 {
        let floor = self.floor(valley, xi);
        match (&mut self.slicer.skewed, valley) {
            (Some(skewed), Some(valley)) => {
                let spot = skewed.valleys.spot(valley, xi);
                if spot.eta == floor || floor.is_nan() {
                    return skewed.depth_at(xi, &spot);
                }
                let reached =
                    skewed.edges(xi, valley).is_some_and(|[low, high]| low.eta <= floor && floor <= high.eta);
                if !reached {
                    return f64::INFINITY;
                }
            }
            _ if floor == 0.0 => return self.slicer.depth(xi),
            _ => {}
        }
        self.slicer.separation(xi, floor) - self.slicer.approach()
    }

    /// Returns \[s, ξ, η\] of the least s at ξ within the window; with skew, over `valley`.
    pub(super) fn lowest(&mut self, valley: Option<usize>, xi: f64) -> [f64; 3] {
        let floor = self.floor(valley, xi);
        let eta = self.slicer.on_surface(xi, floor);
        [self.slicer.separation(xi, eta), xi, eta]
    }

    /// Returns s(ξ, η) \[mm\].
    pub fn separation(&mut self, xi: f64, eta: f64) -> f64 {
        self.slicer.separation(xi, eta)
    }

    /// Returns ζ \[mm\] of the lower body's surface.
    pub(crate) fn lower_height(&mut self, xi: f64, eta: f64) -> f64 {
        self.slicer.evaluator.lower_height(xi, eta)
    }

    /// Writes s(ξ, η) at all η of one column to `out` \[mm\].
    pub(crate) fn column(&mut self, xi: f64, eta: &[f64], out: &mut [f64]) {
        self.slicer.column(xi, eta, out);
    }
}

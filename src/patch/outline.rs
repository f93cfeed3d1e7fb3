//! Cuts off the slices of a patch at the edges of a window.

use super::in_valleys::circle::{BESIDE, Turned};
use super::slice::Slicer;
use super::window::Window;
use crate::conformal::Reference;
use crate::numerics::interval::Interval;
use crate::numerics::lanes::Lanes;
use crate::numerics::sign_changes::sign_changes;
use crate::placement::Placement;

/// Size of a slope of s below which its sign does not count. Turns that are missed change s by less than 1e-11 of their distance.
const SLOPE_NOISE: f64 = 1e-11;

/// Slices of the patch {s < δ}, cut off at a window.
#[derive(Debug)]
pub struct Outline<'a> {
    pub(super) slicer: Slicer<'a>,
    pub(super) window: Window,
}

impl<'a> Outline<'a> {
    /// Makes the outline of a placed pair's patch at approach δ \[mm\] inside a window of ξ and η, or over the rail's surface of σ and η.
    pub fn new(placement: &'a Placement, approach: f64, window: &Window, reference: Reference) -> Self {
        Self { slicer: Slicer::over(placement, approach, reference), window: *window }
    }

    /// Returns both ends of the slice at ξ; with skew, of the slice that holds `valley`. Returns `None` outside the patch
    /// or the window.
    pub(crate) fn edges(&mut self, valley: Option<usize>, xi: f64) -> Option<[f64; 2]> {
        let edges = self.slicer.edges(xi, valley)?;
        self.clipped(edges)
    }

    /// Returns both ends of a range of ξ \[mm\], and all ξ between them at which s along the line of constant η may turn or step,
    /// ascending.
    pub(super) fn turns_along(&mut self, eta: f64, over: Interval) -> Vec<f64> {
        let placement = self.slicer.placement();
        let (turned, wheel) = (Turned::new(placement), &placement.wheel().section);
        let beside = BESIDE * placement.rolling_radius();
        let ends = wheel.pieces.iter().enumerate().flat_map(|(k, piece)| piece.xi.ends().map(|p| (k, p)));
        let crossed = ends.map(|(k, p)| turned.xi_at(k, p, eta)).flat_map(|xi| [xi - beside, xi + beside]);
        let crossed = crossed.flat_map(|xi| match &self.slicer.in_valleys {
            Some(in_valleys) => in_valleys.raised.sigmas(xi, over),
            None => vec![xi],
        });
        let joints = self.slicer.joints(over).into_iter().flat_map(|xi| [xi, xi.next_up()]);
        let mut places: Vec<f64> =
            crossed.chain(joints).chain(over.ends()).filter(|xi| over.contains(*xi)).collect();
        places.sort_by(f64::total_cmp);
        places.dedup();
        let mut turns = Vec::new();
        for pair in places.windows(2) {
            let slope = |xi: &Lanes| xi.map(|xi| self.slicer.slope_along(xi, eta));
            sign_changes(slope, Interval::new(pair[0], pair[1]), SLOPE_NOISE, &mut turns);
        }
        places.append(&mut turns);
        places.sort_by(f64::total_cmp);
        places
    }

    fn clipped(&self, [low, high]: [f64; 2]) -> Option<[f64; 2]> {
        let cut = self.window.eta.cut(Interval::new(low, high));
        (cut.low <= cut.high).then_some(cut.ends())
    }

    /// Returns η \[mm\] of the least s at ξ within the window. It is the place of the valley (η = 0 without skew), or the
    /// window's edge next to it, because s rises away from the valley.
    pub(super) fn floor(&mut self, valley: Option<usize>, xi: f64) -> f64 {
        self.window.eta.nearest(self.slicer.valley(valley, xi))
    }

    /// Returns s − δ \[mm\] at the place of a valley, or at the window's edge next to it. It is infinite if s rises above δ
    /// between the valley and that edge.
    pub(super) fn depth(&mut self, valley: Option<usize>, xi: f64) -> f64 {
        let floor = self.floor(valley, xi);
        if let (Some(in_valleys), Some(valley)) = (&mut self.slicer.in_valleys, valley) {
            let spot = in_valleys.spot(valley, xi);
            if spot.eta == floor || floor.is_nan() {
                return in_valleys.depth_at(xi, &spot);
            }
            let edges = in_valleys.edges(xi, valley);
            if !edges.is_some_and(|[low, high]| low <= floor && floor <= high) {
                return f64::INFINITY;
            }
        }
        self.slicer.miss(xi, floor)
    }

    /// Appends the σ inside a range \[mm\] at which the least t over a valley turns.
    pub(super) fn turns_over_rail(&mut self, valley: usize, over: Interval, turns: &mut Vec<f64>) {
        let mut slope = |sigma: f64| {
            let eta = self.nearest_to_rail(Some(valley), sigma);
            self.slicer.gradient(sigma, eta)[0]
        };
        sign_changes(|sigma: &Lanes| sigma.map(&mut slope), over, SLOPE_NOISE, turns);
    }

    /// Returns η \[mm\] of the least gap over a valley at ξ within the window.
    fn nearest_to_rail(&mut self, valley: Option<usize>, xi: f64) -> f64 {
        self.window.eta.nearest(self.slicer.nearest_to_rail(valley, xi))
    }

    /// Returns \[s, ξ, η\] of the least s at ξ within the window; with skew, over `valley`.
    pub(super) fn lowest(&mut self, valley: Option<usize>, xi: f64) -> [f64; 3] {
        let floor = self.nearest_to_rail(valley, xi);
        let [s, eta] = self.slicer.on_surface(xi, floor);
        [s, xi, eta]
    }
}

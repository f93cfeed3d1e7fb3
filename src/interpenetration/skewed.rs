//! Slices of a skewed wheel: from a valley outwards to s = δ.
//!
//! Between its lowest and highest points, and the ends and steps of the wheel's surface, s is monotone along a line of
//! constant ξ. All of them are known, so that the ends of a slice are found by following them.

use super::slice::{Edge, STEP_ROUNDINGS, Slicer};
use super::valleys::Spot;
use crate::numerics::roots::{bracketed, last_where};

/// Newton's steps to s = δ.
const NEWTON_STEPS: usize = 6;

/// A step below this share of the way leaves its square: nothing.
const QUADRATIC: f64 = 1e-8;

/// Half the interval, in roundings of η, in which Newton's result is confirmed by a change of sign.
const NEWTON_ROUNDINGS: f64 = 64.0;

/// Share of R by which a point is beside an end or step: a million roundings, and less than any segment.
const BESIDE: f64 = 1e-9;

/// Steps of fourfold length in which a point on the surface is looked for next to its end: up to the root of rounding,
/// where lines of constant ξ but touch it.
const NUDGES: i32 = 14;

impl Slicer<'_> {
    /// Where a valley or ridge is at ξ.
    pub(super) fn spot(&self, crease: usize, xi: f64) -> Spot {
        self.valleys.as_ref().map_or(Spot { eta: f64::NAN, rim: None }, |valleys| valleys.spot(crease, xi))
    }

    /// s − δ at the place of a valley or ridge \[mm\].
    pub(super) fn depth_of(&mut self, crease: usize, xi: f64) -> f64 {
        let spot = self.spot(crease, xi);
        self.depth_at(xi, &spot)
    }

    pub(super) fn depth_at(&mut self, xi: f64, spot: &Spot) -> f64 {
        let s = match spot.rim {
            // The surface may end there, by a rounding too early.
            Some([height, _]) => height - self.placement.rail.section.height(xi),
            None => self.evaluator.separation(xi, spot.eta),
        };
        s - self.approach
    }

    /// d(depth)/dξ along a valley or ridge.
    pub(super) fn depth_slope_of(&mut self, crease: usize, xi: f64) -> f64 {
        let spot = self.spot(crease, xi);
        match spot.rim {
            Some([_, slope]) => slope - self.evaluator.rail_slope(xi),
            // Its own motion does not count, since s_η is zero there.
            None => self.gradient(xi, spot.eta)[0],
        }
    }

    /// η, or next to it where the surface ends by a rounding too early.
    pub(super) fn on_surface(&mut self, xi: f64, eta: f64) -> f64 {
        if self.valleys.is_none() {
            return eta;
        }
        let rounding = f64::EPSILON * self.placement.rolling_radius();
        let steps = std::iter::once(0.0).chain((0..NUDGES).flat_map(|k| [4f64.powi(k), -4f64.powi(k)]));
        let mut near = steps.map(|n| eta + n * rounding);
        near.find(|&eta| !self.evaluator.separation(xi, eta).is_nan()).unwrap_or(eta)
    }

    /// The valleys over ξ.
    pub(super) fn valleys_over(&self, xi: f64) -> Vec<usize> {
        let Some(valleys) = &self.valleys else { return Vec::new() };
        valleys.over(xi).filter(|&k| valleys.creases[k].is_valley).collect()
    }

    /// The valley with the least s at ξ; `None` without skew, and where there is none.
    pub(super) fn lowest_valley(&mut self, xi: f64) -> Option<usize> {
        let depths: Vec<_> = self.valleys_over(xi).into_iter().map(|k| (self.depth_of(k, xi), k)).collect();
        let known = depths.into_iter().filter(|(depth, _)| !depth.is_nan());
        known.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, k)| k)
    }

    /// Both ends of the slice that holds a valley.
    pub(super) fn skewed_edges(&mut self, xi: f64, valley: usize) -> Option<[Edge; 2]> {
        let spot = self.spot(valley, xi);
        let depth = -self.depth_at(xi, &spot);
        if depth.is_nan() || depth < 0.0 {
            return None;
        }
        let stops = self.stops(xi);
        // The wheel rises by about η²/2R: twice that width is enough but for steep profiles.
        let radius = self.placement.rolling_radius();
        let reach = (2.0 * (2.0 * radius * depth).sqrt()).max(STEP_ROUNDINGS * f64::EPSILON * radius);
        Some([-1.0, 1.0].map(|side| self.outward(xi, spot.eta, side * reach, &stops)))
    }

    /// η at which s may turn or end, if there is more than one valley at ξ.
    fn stops(&self, xi: f64) -> Vec<f64> {
        let Some(valleys) = self.valleys.as_ref().filter(|valleys| valleys.over(xi).nth(1).is_some()) else {
            return Vec::new();
        };
        let ridges = valleys.over(xi).filter(|&k| !valleys.creases[k].is_valley);
        ridges.map(|k| valleys.spot(k, xi).eta).chain(valleys.rims(xi)).collect()
    }

    /// The end of the slice on one side of its lowest point.
    fn outward(&mut self, xi: f64, lowest: f64, reach: f64, stops: &[f64]) -> Edge {
        let beside = (BESIDE * self.placement.rolling_radius()).copysign(reach);
        let mut from = self.on_surface(xi, lowest);
        let s = self.evaluator.separation(xi, from);
        let beyond = self.evaluator.separation(xi, from + beside);
        if s.is_nan() || (from != lowest && (beyond.is_nan() || beyond >= self.approach)) {
            return Edge { eta: from, ledge: true };
        }
        let away = |stop: &f64| (stop - lowest) * reach.signum();
        let mut stops: Vec<f64> = stops.iter().copied().filter(|stop| away(stop) > -beside.abs()).collect();
        stops.sort_by(|a, b| away(a).total_cmp(&away(b)));
        for stop in stops {
            for place in [stop - beside, stop + beside] {
                if (place - from) * reach <= 0.0 {
                    continue;
                }
                let s = self.evaluator.separation(xi, place);
                if s.is_nan() || s >= self.approach {
                    return self.edge(xi, from, reach, place);
                }
                from = place;
            }
        }
        self.edge(xi, from, reach, f64::INFINITY.copysign(reach))
    }

    /// The end of the slice before `limit`, between which and `from` s only rises.
    fn edge(&mut self, xi: f64, from: f64, mut reach: f64, limit: f64) -> Edge {
        let clipped = |reach: f64| if (from + reach - limit) * reach > 0.0 { limit } else { from + reach };
        let (mut far, mut there) = (clipped(reach), self.evaluator.separation(xi, clipped(reach)));
        // Ends at the latest where the column leaves the wheel's own ring.
        while there < self.approach {
            reach *= 2.0;
            far = clipped(reach);
            there = self.evaluator.separation(xi, far);
        }
        if there.is_nan() { self.end_between(xi, from, far) } else { self.level_between(xi, from, far) }
    }

    /// The end of the slice before the surface ends between `from` and `off`.
    fn end_between(&mut self, xi: f64, from: f64, off: f64) -> Edge {
        let end = self.surface_end(xi, from, off);
        if self.evaluator.separation(xi, end) < self.approach {
            return Edge { eta: end, ledge: true };
        }
        self.level_between(xi, from, end)
    }

    fn level_between(&mut self, xi: f64, from: f64, far: f64) -> Edge {
        let eta = self.level(xi, from, far).unwrap_or(from);
        let step = STEP_ROUNDINGS * f64::EPSILON * self.placement.wheel.profile.extent();
        Edge { eta, ledge: (self.evaluator.separation(xi, eta) - self.approach).abs() > step }
    }

    /// η with s(ξ, η) = δ between `from` and `far`, on whose two sides s − δ has different signs.
    ///
    /// Method: s is nearly a parabola and convex, so that Newton's steps from half way come from outside and reach rounding
    /// within four. The result is taken if s − δ changes sign within some roundings of it; a bracketed root replaces one
    /// that a joint has misled.
    fn level(&mut self, xi: f64, from: f64, far: f64) -> Option<f64> {
        let approach = self.approach;
        let mut eta = from + (far - from) / 2.0;
        let mut settled = false;
        for _ in 0..NEWTON_STEPS {
            let (s, [_, slope]) = self.evaluator.separation_and_slopes(xi, eta);
            let step = (s - approach) / slope;
            eta -= step;
            settled = step.abs() <= QUADRATIC * (eta - from).abs();
            if settled {
                break;
            }
        }
        let near = NEWTON_ROUNDINGS * f64::EPSILON * eta.abs().max((eta - from).abs());
        let near = near.copysign(far - from);
        settled &= (eta - from) * (far - eta) >= 0.0;
        let mut depth = |eta: f64| self.evaluator.separation(xi, eta) - approach;
        let confirmed = settled && depth(eta - near) <= 0.0 && depth(eta + near) >= 0.0;
        if confirmed { Some(eta) } else { bracketed(depth, from, far) }
    }

    /// The last η with a surface between `on`, which has one, and `off`, which has none.
    fn surface_end(&mut self, xi: f64, mut on: f64, mut off: f64) -> f64 {
        let beside = (BESIDE * self.placement.rolling_radius()).copysign(off - on);
        let between = |rim: &f64| (rim - on) * (off - rim) > 0.0;
        let rims = self.valleys.iter().flat_map(|valleys| valleys.rims(xi)).filter(between);
        let nearest = rims.min_by(|a, b| (a - on).abs().total_cmp(&(b - on).abs()));
        for place in nearest.into_iter().flat_map(|rim| [rim - beside, rim + beside]) {
            if (place - on) * (off - place) > 0.0 {
                if self.evaluator.separation(xi, place).is_nan() { off = place } else { on = place }
            }
        }
        last_where(|eta| !self.evaluator.separation(xi, eta).is_nan(), on, off)
    }
}

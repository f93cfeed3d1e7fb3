//! Finds the slices under a skewed wheel, beyond the end of a tilted one, and over the rail's surface, from a valley outwards to s = δ.
//!
//! Along a line of constant ξ, s is monotone between neighbouring special places: the lowest and highest points of the
//! wheel, and the ends and steps of its surface. All these places are known, and the search moves outwards from one to the
//! next. Over the rail's surface the line runs through the raised point at σ; what is said of ξ and s − δ here holds for σ and the
//! wheel's height over that point.

use super::circle::BESIDE;
use super::valleys::{ValleySpot, Valleys};
use crate::conformal::RailArcLength;
use crate::numerics::roots::{bracketed, last_where};
use crate::patch::raised::Raised;
use crate::placement::Placement;

/// Least step of the wheel along a column, in roundings of its height. A smaller one is a smooth joint whose two sides
/// round differently.
pub(in crate::patch) const STEP_ROUNDINGS: f64 = 64.0;

/// Most Newton steps to s = δ.
const NEWTON_STEPS: usize = 6;

/// Newton step, as a share of η's distance from the start, after which iteration ends: the error is its square.
pub(in crate::patch) const QUADRATIC: f64 = 1e-8;

/// Distance from a guessed edge, as a share of the slice, up to which a root is the edge that was guessed: another interval is farther
/// away.
pub(in crate::patch) const NEAR_GUESS: f64 = 0.1;

/// Half the interval, in roundings of η, in which Newton's result is confirmed by a change of sign.
const NEWTON_ROUNDINGS: f64 = 64.0;

/// Number of fourfold steps in which a point on the surface is sought next to its end. They reach the square root of
/// rounding, which is the error where lines of constant ξ only touch the end.
const NUDGES: i32 = 14;

/// Returns η \[mm\] of one end of a slice by Newton's steps from a guess. `miss` gives the gap less δ \[mm\] and its slope along η. Returns
/// `None` unless the steps settle no farther than `near` \[mm\] from the guess, and the gap rises in the direction `outward` there.
pub(in crate::patch) fn newton_from(
    mut miss: impl FnMut(f64) -> Option<[f64; 2]>,
    guess: f64,
    outward: f64,
    near: f64,
) -> Option<f64> {
    let mut eta = guess;
    for _ in 0..NEWTON_STEPS {
        let [over, slope] = miss(eta)?;
        let step = over / slope;
        eta -= step;
        // NaN ends the steps, too.
        if !(slope * outward > 0.0 && (eta - guess).abs() <= near) {
            return None;
        }
        if step.abs() <= QUADRATIC * near {
            return Some(eta);
        }
    }
    None
}

/// Returns what `of` gives at η, and η \[mm\]; at a place next to η if rounding ends the surface too early.
pub(in crate::patch) fn on_surface(
    placement: &Placement,
    eta: f64,
    mut of: impl FnMut(f64) -> f64,
) -> [f64; 2] {
    let rounding = f64::EPSILON * placement.rolling_radius();
    let steps = std::iter::once(0.0).chain((0..NUDGES).flat_map(|k| [4f64.powi(k), -4f64.powi(k)]));
    let mut near = steps.map(|n| eta + n * rounding).map(|eta| [of(eta), eta]);
    near.find(|[found, _]| !found.is_nan()).unwrap_or([f64::NAN, eta])
}

/// Finds the slices under a skewed wheel, or over the rail's surface, at one approach.
#[derive(Debug)]
pub(in crate::patch) struct InValleys<'a> {
    placement: &'a Placement,
    pub(in crate::patch) raised: Raised<'a>,
    /// The wheel's valleys and ridges.
    pub(in crate::patch) valleys: Valleys<'a>,
    /// The η \[mm\] at which s may turn or end along the present line of constant ξ.
    stops: Vec<f64>,
}

impl<'a> InValleys<'a> {
    /// Makes the slices of a placed pair for approach δ \[mm\], over the tangent plane or over the rail's `surface`.
    pub(in crate::patch) fn new(
        placement: &'a Placement,
        approach: f64,
        surface: Option<RailArcLength<'a>>,
    ) -> Self {
        let (raised, valleys) = (Raised::new(placement, approach, surface), Valleys::new(placement));
        Self { placement, raised, valleys, stops: Vec::new() }
    }

    /// Returns the place of a valley or ridge at ξ.
    pub(in crate::patch) fn spot(&self, crease: usize, xi: f64) -> ValleySpot {
        self.valleys.spot(crease, self.raised.xi(xi))
    }

    /// Returns the indices of the valleys and ridges over ξ.
    pub(in crate::patch) fn over(&self, xi: f64) -> impl Iterator<Item = usize> {
        self.valleys.over(self.raised.xi(xi))
    }

    /// Returns the η at which the line of constant ξ meets ends and steps of the wheel's surface \[mm\].
    pub(in crate::patch) fn rims(&self, xi: f64) -> impl Iterator<Item = f64> {
        self.valleys.rims(self.raised.xi(xi))
    }

    /// Returns s − δ at the place of a valley or ridge \[mm\].
    pub(in crate::patch) fn depth(&mut self, crease: usize, xi: f64) -> f64 {
        let spot = self.spot(crease, xi);
        self.depth_at(xi, &spot)
    }

    /// Returns s − δ at a place of a valley or ridge that is already known \[mm\].
    pub(in crate::patch) fn depth_at(&mut self, xi: f64, spot: &ValleySpot) -> f64 {
        let (at, raised) = (self.raised.at(xi), &mut self.raised);
        let below = raised.rail().height(at.foot);
        let over = |moved: f64| raised.over_profile(xi + moved, spot.eta);
        self.valleys.separation(spot, below, over) - at.moved[1]
    }

    /// Returns the valley with the least s at ξ; `None` where there is no valley.
    pub(in crate::patch) fn lowest_valley(&mut self, xi: f64) -> Option<usize> {
        let mut lowest: Option<(f64, usize)> = None;
        let place = self.raised.xi(xi);
        for k in 0..self.valleys.creases.len() {
            let crease = &self.valleys.creases[k];
            if !crease.is_valley || place < crease.xi.low || crease.xi.high < place {
                continue;
            }
            let depth = self.depth(k, xi);
            if !depth.is_nan() && lowest.is_none_or(|(least, _)| depth < least) {
                lowest = Some((depth, k));
            }
        }
        lowest.map(|(_, k)| k)
    }

    /// Returns both ends of the slice that holds a valley \[mm\]; `None` outside the patch.
    pub(in crate::patch) fn edges(&mut self, xi: f64, valley: usize) -> Option<[f64; 2]> {
        let spot = self.spot(valley, xi);
        let depth = -self.depth_at(xi, &spot);
        if depth.is_nan() || depth < 0.0 {
            return None;
        }
        let mut stops = std::mem::take(&mut self.stops);
        self.stops_at(xi, &mut stops);
        // The wheel rises by about η²/2R. Twice that width is enough except for steep profiles.
        let radius = self.placement.rolling_radius();
        let reach = (2.0 * (2.0 * radius * depth).sqrt()).max(STEP_ROUNDINGS * f64::EPSILON * radius);
        let upper = self.outward(xi, spot.eta, reach, &mut stops);
        let lower = if self.valleys.is_mirrored(valley) {
            -upper
        } else {
            self.outward(xi, spot.eta, -reach, &mut stops)
        };
        self.stops = stops;
        Some([lower, upper])
    }

    /// Collects the η at which s may turn or end. There are none if only one valley is at ξ.
    fn stops_at(&self, xi: f64, stops: &mut Vec<f64>) {
        stops.clear();
        if self.over(xi).nth(1).is_some() {
            let ridges = self.over(xi).filter(|&k| !self.valleys.creases[k].is_valley);
            stops.extend(ridges.map(|k| self.spot(k, xi).eta).chain(self.rims(xi)));
        }
    }

    /// Returns the end of the slice on one side of its lowest point.
    fn outward(&mut self, xi: f64, lowest: f64, reach: f64, stops: &mut [f64]) -> f64 {
        let beside = (BESIDE * self.placement.rolling_radius()).copysign(reach);
        let [depth, mut from] = on_surface(self.placement, lowest, |eta| self.raised.gap(xi, eta));
        let beyond = self.raised.gap(xi, from + beside);
        if depth.is_nan() || (from != lowest && (beyond.is_nan() || beyond >= 0.0)) {
            return from;
        }
        let away = |stop: &f64| (stop - lowest) * reach.signum();
        stops.sort_by(|a, b| away(a).total_cmp(&away(b)));
        for &stop in stops.iter().filter(|stop| away(stop) > -beside.abs()) {
            for place in [stop - beside, stop + beside] {
                if (place - from) * reach <= 0.0 {
                    continue;
                }
                let depth = self.raised.gap(xi, place);
                if depth.is_nan() || depth >= 0.0 {
                    return self.edge(xi, from, reach, place);
                }
                from = place;
            }
        }
        self.edge(xi, from, reach, f64::INFINITY.copysign(reach))
    }

    /// Returns the end of the slice between `from` and `limit`, over which s only rises.
    fn edge(&mut self, xi: f64, from: f64, mut reach: f64, limit: f64) -> f64 {
        let clipped = |reach: f64| if (from + reach - limit) * reach > 0.0 { limit } else { from + reach };
        let (mut far, mut there) = (clipped(reach), self.raised.gap(xi, clipped(reach)));
        // The search ends at the latest where the column leaves the wheel.
        while there < 0.0 {
            reach *= 2.0;
            far = clipped(reach);
            there = self.raised.gap(xi, far);
        }
        if there.is_nan() {
            self.end_between(xi, from, far)
        } else {
            self.level(xi, from, far).unwrap_or(from)
        }
    }

    /// Returns the end of the slice if the surface ends between `from` and `off`.
    fn end_between(&mut self, xi: f64, from: f64, off: f64) -> f64 {
        let end = self.surface_end(xi, from, off);
        if self.raised.gap(xi, end) < 0.0 {
            return end;
        }
        self.level(xi, from, end).unwrap_or(from)
    }

    /// Returns η with s(ξ, η) = δ between `from` and `far`, where s − δ must have different signs.
    ///
    /// Method: s is nearly a parabola and convex. Newton's steps from half-way therefore come from outside and reach
    /// rounding within four. The result is accepted if s − δ changes its sign within a few roundings of it. Otherwise a
    /// joint has misled the steps, and a bracketed root replaces the result.
    fn level(&mut self, xi: f64, from: f64, far: f64) -> Option<f64> {
        let mut eta = from + (far - from) / 2.0;
        let mut settled = false;
        for _ in 0..NEWTON_STEPS {
            let Some([depth, slope]) = self.raised.gap_and_slope(xi, eta) else { break };
            let step = depth / slope;
            eta -= step;
            settled = step.abs() <= QUADRATIC * (eta - from).abs();
            if settled {
                break;
            }
        }
        let near = NEWTON_ROUNDINGS * f64::EPSILON * eta.abs().max((eta - from).abs());
        let near = near.copysign(far - from);
        settled &= (eta - from) * (far - eta) >= 0.0;
        let mut depth = |eta: f64| self.raised.gap(xi, eta);
        let confirmed = settled && depth(eta - near) <= 0.0 && depth(eta + near) >= 0.0;
        if confirmed { Some(eta) } else { bracketed(depth, from, far) }
    }

    /// Returns the last η with a surface between `on`, which has one, and `off`, which has none.
    fn surface_end(&mut self, xi: f64, mut on: f64, mut off: f64) -> f64 {
        let beside = (BESIDE * self.placement.rolling_radius()).copysign(off - on);
        let between = |rim: &f64| (rim - on) * (off - rim) > 0.0;
        let rims = self.rims(xi).filter(between);
        let nearest = rims.min_by(|a, b| (a - on).abs().total_cmp(&(b - on).abs()));
        for place in nearest.into_iter().flat_map(|rim| [rim - beside, rim + beside]) {
            if (place - on) * (off - place) > 0.0 {
                if self.raised.gap(xi, place).is_nan() { off = place } else { on = place }
            }
        }
        let end = last_where(|eta| !self.raised.gap(xi, eta).is_nan(), on, off);
        // Less is what the squares of numbers near 0 lose.
        let rounding = f64::EPSILON * self.placement.rolling_radius();
        if (end - on).abs() < rounding { on } else { end }
    }
}

//! Finds the slices of a patch by roots: of a wheel on a roller, with and without skew, over the tangent plane and over the roller's own
//! surface.
//!
//! Along a line of constant ξ or σ both bodies bend away from each other, so that the gap falls to one lowest place and rises on
//! either side of it. Without skew that place is η = 0. A skewed wheel has a second one only where a hollow of its profile has
//! a curvature κ so large that κ sin²χ > 1/ϱ_W + 1/ϱ_R, with ϱ the distances from the axles: at a hollow kink. Where the second place
//! matters, slices are found from samples instead.

mod bounds;
mod tilts;
pub(super) mod turns;

use bounds::GapBounds;

use super::divided::opening;
use super::in_valleys::circle::{FARTHEST_SINE, Turned};
use super::in_valleys::slicer::QUADRATIC;
use super::level::Level;
use crate::numerics::interval::Interval;
use crate::numerics::roots::{bracketed, last_where};
use crate::placement::Placement;
use crate::profile::Section;

/// Factor by which an end of a slice is sought farther out.
const WIDER: f64 = 1.25;

/// Most secant steps to the lowest place of a line. The gap is nearly a parabola along it.
const SECANTS: usize = 10;

/// Distance \[mm\] from the end of a surface at which its slope is taken. Where there is no surface at η = 0, one is looked for first at this
/// distance from there.
const BESIDE_END: f64 = 1e-6;

/// Slope, in roundings of 1, up to which a place counts as the lowest one: it is then within 1e-12 mm.
const SLOPE_ROUNDINGS: f64 = 8.0;

/// Returns the sections along which a line of constant ξ or σ moves as η grows: the wheel's, and that of a roller.
pub(super) fn sections(placement: &Placement) -> [Option<&Section>; 2] {
    [Some(&placement.wheel().section), placement.under().map(|under| &under.wheel().section)]
}

/// The slices of a placed pair at one approach.
#[derive(Debug)]
pub(super) struct ByRoots<'a> {
    pub(super) level: Level<'a>,
    bounds: GapBounds<'a>,
    /// Whether the lowest place along η may be off η = 0.
    skewed: bool,
    /// Approach δ \[mm\].
    approach: f64,
    /// Coefficient \[1/mm\] of η² at C, without skew.
    opening: f64,
    /// Distance \[mm\] from η = 0 up to which a surface is looked for.
    farthest: f64,
    /// η \[mm\] at which lines of constant ξ touch the circles of the wheel's ends, or come nearest to that.
    turning: [f64; 2],
    /// Intervals of each profile's ξ \[mm\] at which its surface has a step or a hole.
    steps: [Vec<Interval>; 2],
}

impl<'a> ByRoots<'a> {
    /// Makes the slices of a placed pair at a level of its gap, which is that of an approach δ \[mm\]; `None` on a rail.
    pub(super) fn new(placement: &'a Placement, approach: f64, level: Level<'a>) -> Option<Self> {
        let opening = opening(placement);
        let steps = sections(placement).map(|section| section.map_or_else(Vec::new, Section::steps));
        let crown = level.normal_gap().map(|gap| gap.rail().clone());
        let bounds = GapBounds::new(placement, crown, (approach, opening))?;
        let (skewed, farthest) = (placement.skew() != 0.0, FARTHEST_SINE * placement.rolling_radius());
        let turned = Turned::new(placement);
        let turning = [0, 1].map(|end| turned.touched(end).map_or(0.0, |(place, _)| place.eta));
        Some(Self { level, bounds, skewed, approach, opening, farthest, turning, steps })
    }

    /// Whether the least gap inside a window of η is that of the midplane of two profiles, whose turns have formulas.
    pub(super) fn in_midplane(&self, window: Interval) -> bool {
        !self.skewed && window.contains(0.0) && self.level.normal_gap().is_none()
    }

    /// Returns η \[mm\] of the least gap at ξ: 0 without skew. With skew it is the end of a surface if the gap falls up to there, and NaN where
    /// a body has no surface on the whole line.
    pub(super) fn lowest(&mut self, xi: f64) -> f64 {
        if !self.skewed {
            return 0.0;
        }
        let (mut begin, mut slope) = (0.0, self.level.slope(xi, 0.0));
        if slope.is_nan() {
            let end = self.beginning(xi);
            // At an end a surface may stand upright; beside it slopes have a sign.
            begin = end + BESIDE_END.copysign(end);
            slope = self.level.slope(xi, begin);
            // From there the surface goes on outwards.
            if end * slope > 0.0 || slope.is_nan() {
                return end;
            }
        }
        if slope == 0.0 {
            return begin;
        }
        let first = -slope / self.opening;
        if let Some(lowest) = self.lowest_by_secants(xi, (begin, slope), 0.5 * first) {
            return lowest;
        }
        let (mut near, mut far) = (0.0, first);
        while self.level.slope(xi, begin + far) * slope > 0.0 {
            (near, far) = (far, WIDER * far);
        }
        let mut end = far;
        if self.level.slope(xi, begin + far).is_nan() {
            end = last_where(|off| !self.level.slope(xi, begin + off).is_nan(), near, far);
            far = end - BESIDE_END.min(end.abs()).copysign(end);
        }
        // Without a root the gap falls up to the end of the surface.
        begin + bracketed(|off| self.level.slope(xi, begin + off), near, far).unwrap_or(end)
    }

    /// Returns the η \[mm\] nearest to 0 at which both bodies have a surface on the line of ξ, which has none at η = 0; NaN if there is none.
    ///
    /// Method: beyond an end of a wheel's profile the line meets its surface on one side of an η, or between two, which lie on either side of
    /// where the circle of the end is parallel to η.
    fn beginning(&mut self, xi: f64) -> f64 {
        let mut has_surface = |eta: f64| !self.level.slope(xi, eta).is_nan();
        let doubled = std::iter::successors(Some(BESIDE_END), |far| Some(2.0 * far));
        let either_side = doubled.take_while(|far| *far < self.farthest).flat_map(|far| [far, -far]);
        let met = either_side.chain(self.turning).find(|eta| has_surface(*eta));
        met.map_or(f64::NAN, |eta| last_where(has_surface, eta, 0.0))
    }

    /// Returns η \[mm\] of the least gap at ξ. It is sought from η = `begin`, where the gap has this slope, and first at `guess` \[mm\] from
    /// there; `None` where the steps do not settle.
    fn lowest_by_secants(&mut self, xi: f64, (begin, slope): (f64, f64), guess: f64) -> Option<f64> {
        let (mut last, mut before, mut off) = (0.0, slope, guess);
        for _ in 0..SECANTS {
            let slope = self.level.slope(xi, begin + off);
            if slope.is_nan() && last == 0.0 {
                // The first guess may lie off a body.
                off /= 2.0;
                continue;
            }
            if slope.abs() <= SLOPE_ROUNDINGS * f64::EPSILON {
                return Some(begin + off);
            }
            // The gap opens as η grows.
            let opens = (slope - before) * (off - last) > 0.0;
            if !opens {
                return None;
            }
            let step = slope * ((off - last) / (slope - before));
            (last, before, off) = (off, slope, off - step);
            if step.abs() <= QUADRATIC * guess.abs() {
                return Some(begin + off);
            }
        }
        None
    }

    /// Returns the gap less δ \[mm\] at the lowest place of ξ.
    pub(super) fn depth(&mut self, xi: f64) -> f64 {
        let eta = self.lowest(xi);
        self.level.gap(xi, eta) - self.approach
    }

    /// Returns both ends of the slice at ξ \[mm\]; `None` outside the patch.
    pub(super) fn edges(&mut self, xi: f64) -> Option<[f64; 2]> {
        let lowest = self.lowest(xi);
        let depth = self.approach - self.level.gap(xi, lowest);
        if depth.is_nan() || depth < 0.0 {
            return None;
        }
        let reach = (depth / self.opening).sqrt();
        let upper = self.edge(xi, lowest, reach);
        Some([if self.skewed { self.edge(xi, lowest, -reach) } else { -upper }, upper])
    }

    /// Returns the end of a slice on one side of its lowest place. `reach` \[mm\] is about its distance from there, with the sign of
    /// the side.
    fn edge(&mut self, xi: f64, lowest: f64, reach: f64) -> f64 {
        let approach = self.approach;
        let mut miss = |eta: f64| self.level.gap(xi, eta) - approach;
        if reach == 0.0 {
            return lowest;
        }
        let (mut near, mut far) = (0.0, reach);
        while miss(lowest + far) < 0.0 {
            (near, far) = (far, WIDER * far);
        }
        if miss(lowest + far).is_nan() {
            far = last_where(|off| !miss(lowest + off).is_nan(), near, far);
        }
        // Without a root the surface ends inside the patch.
        lowest + bracketed(|off| miss(lowest + off), near, far).unwrap_or(far)
    }

    /// Returns the gap less δ \[mm\] and its slope along η; `None` where a body has no surface.
    pub(super) fn miss_and_slope(&mut self, xi: f64, eta: f64) -> Option<[f64; 2]> {
        let at = self.level.at(xi, eta)?;
        Some([at.gap - self.approach, at.slopes[1]])
    }

    /// Returns whether a surface may step between two places on the line of ξ \[mm\].
    pub(super) fn may_step(&mut self, xi: f64, [low, high]: [f64; 2]) -> bool {
        if self.steps.iter().all(Vec::is_empty) {
            return false;
        }
        let places = [low, low + (high - low) / 2.0, high].map(|eta| self.level.at(xi, eta));
        (0..2).any(|body| {
            let over = Interval::around(places.iter().flatten().map(|at| at.abscissae[body]));
            // Between these three places the line moves along a profile like a parabola.
            self.steps[body].iter().any(|step| step.meets(over.grown(over.width())))
        })
    }
}

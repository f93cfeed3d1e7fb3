//! Slices of lines along which the gap of swept bodies falls to one lowest place and rises from there.
//!
//! Both bodies bend away from each other along a line of constant ξ or σ. Without skew the lowest place is η = 0. A skewed wheel has a
//! second one only where a hollow of its profile has a curvature κ so large that κ sin²χ > 1/ϱ_W + 1/ϱ_R, with ϱ the distances from the
//! axles.

mod answers;
pub(super) mod bands;
mod bounds;
mod ends;
mod gap;
pub(super) mod joints;
mod laid;
pub(super) mod lanes;
pub(super) mod least;
pub(super) mod line;
pub(super) mod newton;
pub(super) mod open;
mod place;
pub(super) mod ranges;
pub(super) mod rims;
mod round;
mod tree;

pub(super) use gap::{PatchGap, opening, sections};

use gap::BoxSlopes;
use newton::{QUADRATIC, newton_from};
use place::LowestPlace;
use rims::{FARTHEST_SINE, Rims};

use crate::conformal::Reference;
use crate::numerics::interval::Interval;
use crate::numerics::roots::{bracketed, last_where};
use crate::placement::Placement;
use crate::profile::Section;

/// Factor by which an end of a slice is sought farther out.
const WIDER: f64 = 1.25;

/// Distance of the end of a slice from that of a parabola with the opening at C, as a share of its length, up to which Newton's steps are
/// trusted.
const NEAR_PARABOLA: f64 = 0.5;

/// Most secant steps to the lowest place of a line. The gap is nearly a parabola along it.
const SECANTS: usize = 10;

/// Distance \[mm\] from the end of a surface at which its slope is taken. Where there is no surface at η = 0, one is looked for first at this
/// distance from there.
const BESIDE_END: f64 = 1e-6;

/// Distance of a place beside an end or step of a surface, as a share of R. It is a million roundings, and less than any segment.
const BESIDE: f64 = 1e-9;

/// Share of the slope or gap from which steps began, up to which they end at a lowest place or tip: it then is as near as the last step is short.
const LEVELLED: f64 = 1e-4;

/// Slope, in roundings of 1, up to which a place counts as the lowest one: it is then within 1e-12 mm.
const SLOPE_ROUNDINGS: f64 = 8.0;

/// Height, in roundings of R, of one lowest place of a line over another up to which the higher one does not count.
const SHALLOW_VALLEY: f64 = 1.0;

/// Share by which a range of η is widened that is to hold all lowest places.
const FARTHER_VALLEY: f64 = 0.125;

/// Most doublings of a range that is to hold the gap, or the lowest places along η.
const WIDENINGS: usize = 6;

/// Width, as a share of R, up to which a part of a line or a box is not halved again.
const NARROWEST: f64 = 2e-12;

/// The lines of a placed pair at one approach.
#[derive(Debug)]
pub(super) struct Lines<'a> {
    pub(super) gap: PatchGap<'a>,
    /// Distance \[mm\] from η = 0 up to which a surface is looked for.
    farthest: f64,
    /// η \[mm\] at which lines of constant ξ touch the circles of the bodies' ends, or come nearest to that.
    turning: Vec<f64>,
    /// Circles at which the wheel or a roller ends or steps.
    rims: Rims,
    /// Intervals of each profile's ξ \[mm\] at which its surface has a step or a hole.
    steps: [Vec<Interval>; 2],
    /// Neighbouring lines between which the least gap is known, once the ranges of the patch are.
    cells: Vec<[LowestPlace; 2]>,
}

impl<'a> Lines<'a> {
    /// Makes the lines of a placed pair at approach δ \[mm\], over the tangent plane or over the surface of the rail or roller.
    pub(super) fn new(placement: &'a Placement, approach: f64, reference: Reference) -> Self {
        Self::of(placement, PatchGap::new(placement, approach, reference))
    }

    /// Makes the lines of t + δ (1 − cos α) over the surface of the rail or roller.
    pub(super) fn along_normals(placement: &'a Placement, approach: f64) -> Self {
        Self::of(placement, PatchGap::along_normals(placement, approach))
    }

    fn of(placement: &'a Placement, gap: PatchGap<'a>) -> Self {
        let steps = sections(placement).map(|section| section.map_or_else(Vec::new, Section::steps));
        let rims = Rims::new(placement);
        let turning = rims.turning();
        let farthest = FARTHEST_SINE * placement.rolling_radius();
        Self { gap, farthest, turning, rims, steps, cells: Vec::new() }
    }

    /// Returns the width \[mm\] up to which nothing is halved again.
    fn narrowest(&self) -> f64 {
        NARROWEST * self.gap.placement().rolling_radius()
    }

    /// Returns η \[mm\] of the least gap at ξ, sought from a guess: 0 without skew. With skew it is the end of a surface, or a step up, if the gap
    /// falls up to there, and NaN where a body has no surface on the whole line.
    pub(super) fn lowest(&mut self, xi: f64, guess: f64) -> f64 {
        if !self.gap.is_skewed() {
            return 0.0;
        }
        let lowest = self.level_place(xi, guess);
        if self.steps.iter().all(Vec::is_empty) {
            return lowest;
        }
        let known = self.gap.gap(xi, guess);
        if self.gap.gap(xi, lowest) > known {
            let beside = guess + (BESIDE * self.gap.placement().rolling_radius()).copysign(lowest - guess);
            let mut is_lower = |eta: f64| self.gap.gap(xi, eta) <= known;
            return if is_lower(beside) { last_where(is_lower, beside, lowest) } else { guess };
        }
        lowest
    }

    /// Returns η \[mm\] of a place of the line of ξ, sought from a guess, up to which the gap of a skewed wheel falls, as for
    /// [`Self::lowest`].
    fn level_place(&mut self, xi: f64, guess: f64) -> f64 {
        let (mut begin, mut slope) = (guess, self.gap.across(xi, guess));
        if slope.is_nan() {
            (begin, slope) = (0.0, self.gap.across(xi, 0.0));
        }
        if slope.is_nan() {
            let end = self.beginning(xi);
            // At an end a surface may stand upright; beside it slopes have a sign.
            begin = end + BESIDE_END.copysign(end);
            slope = self.gap.across(xi, begin);
            // From there the surface goes on outwards.
            if end * slope > 0.0 || slope.is_nan() {
                return end;
            }
        }
        if slope == 0.0 {
            return begin;
        }
        let first = -slope / self.gap.opening;
        if let Some(lowest) = self.lowest_by_secants(xi, (begin, slope), 0.5 * first) {
            return lowest;
        }
        let known = self.gap.gap(xi, begin);
        let falls = |gap: &mut PatchGap<'_>, off: f64| {
            gap.at(xi, begin + off).is_some_and(|at| at.across * slope > 0.0 && at.gap <= known)
        };
        let (mut near, mut far) = (0.0, first);
        while falls(&mut self.gap, far) {
            (near, far) = (far, WIDER * far);
        }
        let turn = bracketed(|off| self.gap.across(xi, begin + off), near, far);
        // Without a root the gap falls up to the end of the surface, or farther out another part of it lies higher.
        begin + turn.unwrap_or_else(|| last_where(|off| falls(&mut self.gap, off), near, far))
    }

    /// Returns the η \[mm\] nearest to 0 at which both bodies have a surface on the line of ξ, which has none at η = 0; NaN if there is none.
    ///
    /// Method: beyond an end of a wheel's profile the line meets its surface on one side of an η, or between two, which lie on either side of
    /// where the circle of the end is parallel to η.
    fn beginning(&mut self, xi: f64) -> f64 {
        let mut has_surface = |eta: f64| !self.gap.across(xi, eta).is_nan();
        let doubled = std::iter::successors(Some(BESIDE_END), |far| Some(2.0 * far));
        let either_side = doubled.take_while(|far| *far < self.farthest).flat_map(|far| [far, -far]);
        let met = either_side.chain(self.turning.iter().copied()).find(|eta| has_surface(*eta));
        met.map_or(f64::NAN, |eta| last_where(has_surface, eta, 0.0))
    }

    /// Returns η \[mm\] of the least gap at ξ, sought from a place; `None` where no body is there, or steps from there do not settle.
    fn lowest_beside(&mut self, xi: f64, begin: f64) -> Option<f64> {
        let slope = self.gap.across(xi, begin);
        if slope == 0.0 || !self.gap.is_skewed() {
            return Some(begin);
        }
        self.lowest_by_secants(xi, (begin, slope), -0.5 * slope / self.gap.opening)
    }

    /// Returns η \[mm\] of the least gap at ξ. It is sought from η = `begin`, where the gap has this slope, and first at `guess` \[mm\] from
    /// there; `None` where the steps do not settle.
    fn lowest_by_secants(&mut self, xi: f64, (begin, slope): (f64, f64), guess: f64) -> Option<f64> {
        let (first, mut last, mut before, mut off) = (slope, 0.0, slope, guess);
        for _ in 0..SECANTS {
            let slope = self.gap.across(xi, begin + off);
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
            // At a kink slopes do not fall as steps do.
            if step.abs() <= QUADRATIC * guess.abs() {
                return (slope.abs() <= LEVELLED * first.abs()).then_some(begin + off);
            }
        }
        None
    }

    /// Returns both ends of the slice at ξ \[mm\]; `None` outside the patch.
    pub(super) fn edges(&mut self, xi: f64) -> Option<[f64; 2]> {
        let lowest = self.lowest(xi, 0.0);
        let depth = -self.gap.gap(xi, lowest);
        if depth.is_nan() || depth < 0.0 {
            return None;
        }
        let reach = (depth / self.gap.opening).sqrt();
        let upper = self.edge(xi, lowest, reach);
        Some([if self.gap.is_skewed() { self.edge(xi, lowest, -reach) } else { -upper }, upper])
    }

    /// Returns the end of a slice on one side of its lowest place. `reach` \[mm\] is about its distance from there, with the sign of
    /// the side.
    fn edge(&mut self, xi: f64, lowest: f64, reach: f64) -> f64 {
        if reach == 0.0 {
            return lowest;
        }
        // Normals of a roller may meet another sheet of the wheel next to the first one.
        if self.gap.has_plain_bounds() && self.steps.iter().all(Vec::is_empty) {
            let at = |eta: f64| self.gap.at(xi, eta).map(|at| [at.gap, at.across]);
            if let Some(eta) = newton_from(at, lowest + reach, reach.signum(), NEAR_PARABOLA * reach.abs()) {
                return eta;
            }
        }
        let mut gap = |off: f64| self.gap.gap(xi, lowest + off);
        let (mut near, mut far) = (0.0, reach);
        while gap(far) < 0.0 {
            (near, far) = (far, WIDER * far);
        }
        if gap(far).is_nan() {
            far = last_where(|off| self.gap.has_surface(xi, lowest + off), near, far);
        }
        // Without a root the surface ends inside the patch.
        lowest + bracketed(|off| self.gap.gap(xi, lowest + off), near, far).unwrap_or(far)
    }

    /// Returns whether a surface may step between two places on the line of ξ \[mm\].
    pub(super) fn may_step(&mut self, xi: f64, [low, high]: [f64; 2]) -> bool {
        if self.steps.iter().all(Vec::is_empty) {
            return false;
        }
        let places = [low, low + (high - low) / 2.0, high].map(|eta| self.gap.abscissae(xi, eta));
        (0..2).any(|body| {
            let over = Interval::around(places.iter().map(|at| at[body]).filter(|at| !at.is_nan()));
            // Between these three places the line moves along a profile like a parabola.
            self.steps[body].iter().any(|step| step.meets(over.grown(over.width())))
        })
    }

    /// Whether each line of a range is proved to have one lowest place in a range of η, around that of its middle, and to rise from there.
    fn is_plain(&self, (xi, eta): (Interval, Interval), middle: f64, budget: &mut usize) -> bool {
        let Some((valley, _)) = self.valley(xi, Interval::of(middle), Interval::ALL) else {
            *budget = budget.saturating_sub(1);
            return false;
        };
        self.gap.is_convex(xi, valley, self.gap.roundings(SHALLOW_VALLEY))
            && self.opens(xi, Interval::new(valley.high, eta.high), 1.0, budget)
            && self.opens(xi, Interval::new(eta.low, valley.low), -1.0, budget)
    }

    /// Returns whether the gap is proved to rise (1) or fall (−1) along η over a box, wherever the bodies are not above each other by their
    /// heights.
    fn opens(&self, xi: Interval, eta: Interval, sign: f64, budget: &mut usize) -> bool {
        let mut waiting = vec![(xi, eta)];
        while let Some((xi, eta)) = waiting.pop() {
            if !eta.has_width() {
                continue;
            }
            if *budget == 0 {
                return false;
            }
            *budget -= 1;
            let slopes = self.gap.slopes(xi, eta, Interval::ALL);
            let rises = slopes.is_some_and(|slopes| (slopes.across * sign).low >= 0.0);
            if rises || self.gap.is_high(xi, eta) {
                continue;
            }
            waiting.extend(eta.halves().map(|eta| (xi, eta)));
            if eta.width() < xi.width() {
                return false;
            }
        }
        true
    }

    /// Returns a range of η \[mm\] that holds the lowest places of all lines of a range, from some of them, and bounds of the slopes there;
    /// `None` where none is proved. Along normals it is where G + δ lies in a range.
    fn valley(&self, xi: Interval, known: Interval, gap: Interval) -> Option<(Interval, BoxSlopes)> {
        self.valley_of(known, |eta| self.gap.slopes(xi, eta, gap))
    }

    /// As [`Self::valley`]; `slopes` gives bounds of the slopes over a range of η.
    ///
    /// Method: a range is tried, and widened, until all places in it at which the gap may be level lie inside: then the gap falls at its lower
    /// end and rises at its upper one.
    fn valley_of(
        &self,
        known: Interval,
        slopes: impl Fn(Interval) -> Option<BoxSlopes>,
    ) -> Option<(Interval, BoxSlopes)> {
        if !self.gap.is_skewed() {
            let midplane = Interval::of(0.0);
            return Some((midplane, slopes(midplane)?));
        }
        let mut valley = known.grown(FARTHER_VALLEY * known.width() + self.narrowest());
        for _ in 0..WIDENINGS {
            let slopes = slopes(valley)?;
            if valley.low < slopes.level_at.low && slopes.level_at.high < valley.high {
                return Some((valley, slopes));
            }
            let wider = known.hull(slopes.level_at);
            valley = wider.grown(FARTHER_VALLEY * wider.width() + self.narrowest());
        }
        None
    }

    /// Returns bounds of the slope of the gap along a rim between two lines of ξ or σ, from the range of its η \[mm\]; `None` as for
    /// [`PatchGap::along_rim`].
    fn along_rim(&self, rim: usize, xi: Interval, eta: Interval) -> Option<Interval> {
        let places = Interval::around(xi.ends().map(|xi| self.gap.xi_and_run(xi).0));
        self.gap.along_rim((self.rims.body(rim), self.rims.slopes(rim, places)), xi, eta)
    }

    /// Returns whether the least s of a line over the tangent plane is proved to be a convex function of ξ over a range of ξ or σ, some of
    /// whose lowest places are known.
    fn is_bowl(&self, xi: Interval, known: Interval) -> bool {
        let xi = self.gap.feet(xi)[0];
        let valley = self.valley_of(known, |eta| self.gap.plane_slopes(xi, eta));
        valley.is_some_and(|(valley, _)| self.gap.is_bowl(xi, valley, self.gap.roundings(SHALLOW_VALLEY)))
    }
}

//! Finds where the least gap between a wheel and a roller may pass δ, and where it is least of all. Bounds of its slope prove both.

use super::ByRoots;
use super::bounds::LowestPlace;
use crate::numerics::interval::Interval;
use crate::numerics::roots::bracketed;
use crate::separation::GapSlopes;

/// Depth \[mm\] up to which a part of the patch, or what parts it, does not count: some roundings of the bodies' coordinates.
const SHALLOW: f64 = 1e-12;

/// Difference \[mm\] up to which one least gap of several may be taken for the least of all.
const LEVEL: f64 = 1e-10;

/// Width, as a share of the first range, up to which a range is not halved again: a body ends or steps there.
const SHORTEST: f64 = 1e-14;

/// Width, as a share of the first range, up to which a range without C is not halved again where no bounds are known: a surface steps or
/// stands upright there, normals of a roller meet a sheet of the wheel that others hide from C, or a body is missing at both ends.
const UNKNOWN: f64 = 1.0 / 512.0;

/// Number of ranges after which none is halved again: a hundred times those of usual pairs.
const MOST_RANGES: usize = 1 << 14;

/// Share of a depth by which the least gap may be uncertain.
const FAR_ABOVE: f64 = 0.75;

/// Half the width, as a share of the range, of the first bracket around a place to which the search for the least gap has come.
const FIRST_BRACKET: f64 = 1e-6;

/// Most doublings of that bracket.
const DOUBLINGS: usize = 8;

/// What is known of the least gap between two places.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Between {
    /// It is below δ.
    Inside,
    /// It is not below δ.
    Outside,
    /// A body is missing.
    Missing,
    /// It passes δ once, or ends or steps.
    Passing,
}

/// The least gap of all lines of a range.
#[derive(Debug)]
pub(in crate::patch) struct LeastGap<'s, 'a> {
    pub(in crate::patch) slices: &'s mut ByRoots<'a>,
    /// Range of ξ or σ \[mm\].
    pub(in crate::patch) over: Interval,
    /// Range of η \[mm\].
    pub(in crate::patch) window: Interval,
}

impl LeastGap<'_, '_> {
    /// Returns both ends of the range and places between them, ascending, so that from one to the next the least gap passes δ at most
    /// once. At `torn` places it may step; they are among those returned.
    ///
    /// Method: between two places the least gap stays between straight lines of its largest and least slope. A range is halved until
    /// these prove that the gap does not pass δ, or does not turn. Cost: the least gaps at some hundred places.
    pub(in crate::patch) fn turns(mut self, torn: Vec<f64>) -> Vec<f64> {
        let mut turns = vec![self.over.low];
        let mut count = 0;
        for range in self.ranges(torn) {
            let mut last = None;
            let mut waiting = vec![range.ends().map(|xi| self.place(xi, 0.0, 0.0))];
            while let Some([a, b]) = waiting.pop() {
                count += 1;
                let mut known = self.between([&a, &b]);
                if known.is_none() {
                    if let Some(xi) = self.middle([&a, &b], count) {
                        let middle = self.place(xi, halfway(a.eta, b.eta), 0.0);
                        waiting.extend([[middle, b], [a, middle]]);
                        continue;
                    }
                    known = Some(Between::Passing);
                }
                if known == last && known != Some(Between::Passing) {
                    turns.pop();
                }
                last = known;
                turns.push(b.xi);
            }
        }
        turns
    }

    /// Returns ξ or σ \[mm\] of the least gap of all; `None` if a body is missing all over the range. C is chosen if nothing is lower than it
    /// to rounding.
    ///
    /// Method: as [`Self::turns`]; a range is left out where the bounds of its least gap lie above the least that is known.
    pub(in crate::patch) fn least_of_all(mut self) -> Option<f64> {
        let mut least: Option<LowestPlace> = None;
        let take = |gap: &mut Self, least: &mut Option<LowestPlace>, xi: f64, eta: f64| {
            let known = least.map_or(f64::INFINITY, |least| least.depth.high);
            let place = gap.place(xi, eta, known);
            if place.depth.high < known {
                *least = Some(place);
            }
            place
        };
        let c = self.over.contains(0.0).then(|| take(&mut self, &mut least, 0.0, 0.0));
        let ranges = self.ranges(vec![0.0]);
        let ends = |range: Interval| range.ends().map(|xi| take(&mut self, &mut least, xi, 0.0));
        let mut waiting: Vec<_> = ranges.into_iter().map(ends).collect();
        let mut count = 0;
        while let Some([a, b]) = waiting.pop() {
            count += 1;
            let known = if a.is_missing() || b.is_missing() {
                self.between([&a, &b]).is_some()
            } else {
                let (slopes, depths) = self.depths([&a, &b]);
                let higher = least.is_some_and(|least| depths.low >= least.depth.high - LEVEL);
                self.is_unknown(slopes, [&a, &b]) || higher || is_monotone(slopes)
            };
            if let Some(xi) = self.middle([&a, &b], count).filter(|_| !known) {
                let middle = take(&mut self, &mut least, xi, halfway(a.eta, b.eta));
                waiting.extend([[middle, b], [a, middle]]);
            }
        }
        let least = least?;
        if let Some(c) = c.filter(|c| c.depth.low <= least.depth.high + SHALLOW) {
            return Some(c.xi);
        }
        Some(self.turn_near(least).unwrap_or(least.xi))
    }

    /// Parts the range at given places, and where the least gap may step: over the tangent plane at steps of the profiles, over the roller's
    /// surface at its kinks. Right of one, a part begins beside it.
    fn ranges(&self, mut torn: Vec<f64>) -> Vec<Interval> {
        let ByRoots { bounds, steps, level, .. } = &*self.slices;
        match level.normal_gap() {
            Some(_) => torn.extend(bounds.kinks()),
            None => torn.extend(steps.iter().flatten().flat_map(|step| step.ends())),
        }
        let beside = |low: f64| if low == self.over.low { low } else { low.next_up() };
        self.over.parts(torn).map(|part| Interval::new(beside(part.low), part.high)).collect()
    }

    /// Returns the middle between two places; `None` where they are too close together, or too many before them, to part them.
    fn middle(&self, [a, b]: [&LowestPlace; 2], count: usize) -> Option<f64> {
        let between = Interval::new(a.xi, b.xi);
        let whole = self.share([a, b]) > SHORTEST && between.surrounds(between.middle());
        (whole && count < MOST_RANGES).then(|| between.middle())
    }

    /// Returns what bounds of the least gap's slope prove of it between two places; `None` where they prove nothing.
    fn between(&self, [a, b]: [&LowestPlace; 2]) -> Option<Between> {
        if a.is_missing() || b.is_missing() {
            let missing = a.is_missing() && b.is_missing() && self.is_narrow([a, b]);
            return missing.then_some(Between::Missing);
        }
        let (slopes, Interval { low, high }) = self.depths([a, b]);
        let unknown = self.is_unknown(slopes, [a, b]);
        let (all_out, all_in) = (unknown || low > -SHALLOW, unknown || high < SHALLOW);
        match [a, b].map(|place| place.depth.high < 0.0) {
            [true, true] => all_in.then_some(Between::Inside),
            [false, false] => all_out.then_some(Between::Outside),
            _ => (is_monotone(slopes) || (all_out && all_in)).then_some(Between::Passing),
        }
    }

    /// Returns by which share of the range two places are apart.
    fn share(&self, [a, b]: [&LowestPlace; 2]) -> f64 {
        (b.xi - a.xi) / self.over.width()
    }

    /// Whether nothing more is to be known between two places.
    fn is_unknown(&self, slopes: Interval, places: [&LowestPlace; 2]) -> bool {
        slopes == Interval::ALL && self.is_narrow(places)
    }

    /// Whether two places are too near to each other for what lies between to count without bounds. C, which is in every patch, counts.
    fn is_narrow(&self, [a, b]: [&LowestPlace; 2]) -> bool {
        self.share([a, b]) <= UNKNOWN && !Interval::new(a.xi, b.xi).surrounds(0.0)
    }

    /// Returns bounds of the slope of the least gap between two places, and of the least gap less δ \[mm\].
    fn depths(&self, [a, b]: [&LowestPlace; 2]) -> (Interval, Interval) {
        let slopes = self.slices.bounds.slopes([a, b], self.slices.skewed, self.window);
        let width = b.xi - a.xi;
        let low = least_between([a, b].map(|place| place.depth.low), width, slopes);
        let high = -least_between([a, b].map(|place| -place.depth.high), width, -slopes);
        (slopes, Interval::new(low, high))
    }

    /// Returns the ξ or σ \[mm\] next to a place at which the least gap turns from falling to rising, unless it is larger there.
    fn turn_near(&mut self, near: LowestPlace) -> Option<f64> {
        let mut slope = |xi: f64| {
            let eta = self.window.nearest(self.slices.lowest(xi));
            self.slices.level.gradient(xi, eta)[0]
        };
        let mut reach = FIRST_BRACKET * self.over.width();
        for _ in 0..DOUBLINGS {
            let Interval { low, high } = Interval::of(near.xi).grown(reach).cut(self.over);
            if slope(low) < 0.0 && slope(high) > 0.0 {
                let turn = bracketed(&mut slope, low, high)?;
                return Some(turn).filter(|&turn| self.lowest_place(turn).depth.high <= near.depth.high);
            }
            reach *= 2.0;
        }
        None
    }

    /// Returns the least gap at ξ. `eta` is a guess of its place: if the gap there is far above a depth \[mm\] with which it is compared,
    /// it is not sought further.
    ///
    /// Method: a parabola with the gap and slope at η falls below that gap by slope²/4a, with a the opening; slope²/a is allowed for.
    fn place(&mut self, xi: f64, eta: f64, compared: f64) -> LowestPlace {
        let ByRoots { level, skewed, approach, opening, .. } = &mut *self.slices;
        let guess = Some(eta).filter(|eta| !eta.is_nan() && *eta != 0.0);
        for eta in guess.into_iter().chain([0.0]).filter(|_| *skewed) {
            let eta = self.window.nearest(eta);
            let Some(GapSlopes { gap, slopes, .. }) = level.at(xi, eta) else { continue };
            let (depth, allowed) = (gap - *approach, slopes[1] * slopes[1] / *opening);
            if allowed <= FAR_ABOVE * (depth - compared) {
                return LowestPlace { xi, eta, depth: Interval::new(depth - allowed, depth) };
            }
        }
        self.lowest_place(xi)
    }

    /// Returns the least gap at ξ.
    fn lowest_place(&mut self, xi: f64) -> LowestPlace {
        let eta = self.slices.lowest(xi);
        let gap = self.slices.level.gap(xi, self.window.nearest(eta));
        LowestPlace { xi, eta, depth: Interval::of(gap - self.slices.approach) }
    }
}

/// Returns the middle of two numbers; that which is known if the other is NaN.
fn halfway(a: f64, b: f64) -> f64 {
    if a.is_nan() {
        b
    } else if b.is_nan() {
        a
    } else {
        a + (b - a) / 2.0
    }
}

/// Whether bounds of a slope leave it one sign.
fn is_monotone(slopes: Interval) -> bool {
    slopes.low >= 0.0 || slopes.high <= 0.0
}

/// Returns the least value that a function may have over a width if its values at both ends and bounds of its slope are known.
fn least_between([a, b]: [f64; 2], width: f64, slopes: Interval) -> f64 {
    let Interval { low, high } = slopes;
    // The lowest lines through both ends; a bound that is infinite leaves the other line.
    let place = ((b - high * width - a) / (low - high)).clamp(0.0, width);
    let crossing = match [low, high].map(f64::is_finite) {
        [true, true] => a + low.min(0.0) * place,
        [true, false] => a + low.min(0.0) * width,
        [false, true] => b - high.max(0.0) * width,
        [false, false] => f64::NEG_INFINITY,
    };
    crossing.min(a).min(b)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conformal::Reference;
    use crate::error::Result;
    use crate::patch::Slicer;
    use crate::placement::Pair;
    use crate::profile::standards;

    /// Numbers of ranges and of places in each.
    const RANGES: usize = 60;
    const PLACES: usize = 8;

    #[test]
    fn the_least_gap_runs_within_its_bounds() -> Result<()> {
        let pair =
            Pair::new(standards::rail("60E1")?, standards::wheel("S1002")?, 460.0)?.on_roller(350.0)?;
        for (rail_x, wheel_x) in [(4.0, 6.0), (-20.0, -24.0), (-34.0, -33.0), (-35.5, -42.0)] {
            for (skew, reference) in [-0.05, 0.003, 0.02]
                .into_iter()
                .flat_map(|skew| [(skew, Reference::Plane), (skew, Reference::Rail)])
            {
                let placement = pair.placed(rail_x, wheel_x, skew)?;
                let mut slicer = Slicer::over(&placement, 0.1, reference);
                let over = slicer.reach().expect("bodies over each other").cut(Interval::symmetric(25.0));
                let mut least = slicer.least_gap(over, Interval::ALL).expect("a skewed wheel");
                let (whole, mut known) = (least.ranges(Vec::new()), 0);
                let cells =
                    (0..RANGES).flat_map(|k| [1.0, 0.05, 1e-3].map(|width| (over.step(k, RANGES), width)));
                for cell in cells.map(|(low, width)| Interval::new(low, low + width)) {
                    let [a, b] = cell.ends().map(|xi| least.lowest_place(xi));
                    let (slopes, depths) = least.depths([&a, &b]);
                    if !whole.iter().any(|range| range.holds(cell)) || slopes == Interval::ALL {
                        continue;
                    }
                    known += 1;
                    for xi in (0..=PLACES).map(|k| cell.step(k, PLACES)) {
                        let depth = least.lowest_place(xi).depth.high;
                        let name = format!("{rail_x}, {skew}, {reference:?}, {xi} in {cell:?}");
                        assert!(depths.grown(SHALLOW).contains(depth), "{name}: {depth} beyond {depths:?}");
                    }
                }
                assert!(known > RANGES, "{rail_x}, {skew}, {reference:?}: {known}");
            }
        }
        Ok(())
    }

    #[test]
    fn the_least_value_between_two_ends_lies_where_the_steepest_lines_meet() {
        let least = |ends, slopes: [f64; 2]| least_between(ends, 2.0, slopes.into());
        assert_eq!(least([1.0, 1.0], [-1.0, 1.0]), 0.0);
        assert_eq!(least([1.0, 2.0], [0.5, 0.75]), 1.0);
        assert_eq!(least([3.0, 1.0], [-2.0, f64::INFINITY]), -1.0);
        assert_eq!(least([3.0, 1.0], [f64::NEG_INFINITY, 0.5]), 0.0);
        assert_eq!(least([3.0, 1.0], [f64::NEG_INFINITY, f64::INFINITY]), f64::NEG_INFINITY);
    }
}

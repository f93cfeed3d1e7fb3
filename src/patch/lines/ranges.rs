//! Finds the ranges of ξ over which the least gap of a line is below δ, and where it is least of all. Bounds of its slope prove both.

use super::gap::BoxSlopes;
use super::place::LowestPlace;
use super::{Lines, SHALLOW_VALLEY, WIDENINGS};
use crate::numerics::interval::Interval;
use crate::numerics::roots::bracketed;
use crate::patch::turning_points;

/// Depth, in roundings of R, up to which a part of the patch, or what parts it, does not count: some of the bodies' coordinates.
pub(super) const SHALLOW: f64 = 10.0;

/// Difference, in roundings of R, up to which one least gap of several may be taken for the least of all.
pub(super) const LEVEL: f64 = 1000.0;

/// Width, as a share of the first range, up to which a range is not halved again: a body ends or steps there.
const SHORTEST: f64 = 1e-14;

/// Width, as a share of the first range, up to which a range without C is not halved again where no bounds are known: a surface steps or
/// stands upright there, normals of a roller meet a sheet of the wheel that others hide from C, or a body is missing at both ends.
pub(super) const UNKNOWN: f64 = 1.0 / 512.0;

/// Number of ranges after which none is halved again: a hundred times those of usual pairs.
const MOST_RANGES: usize = 1 << 14;

/// Share of a depth by which the least gap may be uncertain.
const FAR_ABOVE: f64 = 0.75;

/// Most steps to a lowest place that is known well enough to be compared.
pub(super) const STEPS: usize = 4;

/// Factor by which the range that is to hold the gap along normals is widened.
const WIDER: f64 = 4.0;

/// Half the width, as a share of the range, of the first bracket around a place to which the search for the least gap has come.
const FIRST_BRACKET: f64 = 1e-6;

/// Most doublings of that bracket: up to ranges that are not halved.
const DOUBLINGS: usize = 11;

/// What is known of the least gap between two lines.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Between {
    /// It is below δ.
    Inside,
    /// It is not below δ, or a body is missing.
    Outside,
    /// It passes δ once, or ends or steps.
    Passing,
}

/// The least gap of all lines of a range.
#[derive(Debug)]
pub(in crate::patch) struct LeastGap<'s, 'a> {
    pub(in crate::patch) lines: &'s mut Lines<'a>,
    /// Range of ξ or σ \[mm\].
    pub(in crate::patch) over: Interval,
    /// Range of η \[mm\].
    pub(in crate::patch) window: Interval,
}

impl LeastGap<'_, '_> {
    /// Parts the range into ranges, ascending, over each of which the least gap is below δ, or not, or passes it once.
    ///
    /// Method: between two places the least gap stays between straight lines of its largest and least slope. A range is halved until
    /// these prove that the gap does not pass δ, or does not turn, or until second derivatives prove it convex. Cost: the least gaps at some
    /// thirty places.
    pub(super) fn parts(&mut self) -> Vec<[LowestPlace; 2]> {
        let mut parts: Vec<([LowestPlace; 2], Between)> = Vec::new();
        let mut cells = Vec::new();
        let mut count = 0;
        if self.is_in_midplane() {
            return self.midplane_parts();
        }
        for range in self.ranges() {
            let (begin, mut waiting) = (parts.len(), self.parted_at_c(range));
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
                let known = known.unwrap_or(Between::Passing);
                // Inside the patch the gap is lower than where it is not below δ.
                if known != Between::Outside {
                    cells.push([a, b]);
                }
                match parts[begin..]
                    .last_mut()
                    .filter(|(_, last)| *last == known && known != Between::Passing)
                {
                    Some((part, _)) => part[1] = b,
                    None => parts.push(([a, b], known)),
                }
            }
        }
        self.lines.cells = cells;
        parts.into_iter().map(|(part, _)| part).collect()
    }

    /// Whether the least gaps inside the window are those of two profiles in the midplane, whose turns have formulas.
    fn is_in_midplane(&self) -> bool {
        let gap = &self.lines.gap;
        gap.is_over_plane() && !gap.is_skewed() && self.window.contains(0.0)
    }

    /// Parts the range where the gap of the profiles may turn, end or step.
    fn midplane_parts(&mut self) -> Vec<[LowestPlace; 2]> {
        let mut parts = Vec::new();
        for range in self.ranges() {
            let turns = turning_points(self.lines.gap.placement(), range.low, range.high);
            let places: Vec<LowestPlace> = turns.into_iter().map(|xi| self.place(xi, 0.0, 0.0)).collect();
            for pair in places.windows(2) {
                // A joint may be the end of a surface: the range from there on begins beside it.
                let beside = pair[0].is_missing() && !pair[1].is_missing();
                let from = if beside { self.place(pair[0].xi.next_up(), 0.0, 0.0) } else { pair[0] };
                parts.push([from, pair[1]]);
            }
        }
        self.lines.cells = parts.clone();
        parts
    }

    /// Returns ξ or σ \[mm\] of the least gap of all; `None` if a body is missing all over the range. C is chosen if nothing is lower than it
    /// to rounding.
    ///
    /// Method: as [`Self::parts`]; a range is left out where the bounds of its least gap lie above the least that is known, and at C where s is
    /// convex.
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
        let within = |[a, b]: &[LowestPlace; 2]| a.xi < self.over.high && self.over.low < b.xi;
        let mut waiting: Vec<_> = self.lines.cells.iter().filter(|cell| within(cell)).copied().collect();
        if waiting.is_empty() {
            waiting = self.ranges().into_iter().flat_map(|range| self.parted_at_c(range)).collect();
        }
        let over = self.over;
        for place in waiting.iter_mut().flatten().filter(|place| over.contains(place.xi)) {
            let known = least.map_or(f64::INFINITY, |least| least.depth.high);
            if place.depth.low < known {
                *place = self.lowest_place(place.xi, place.eta);
            }
            if place.depth.high < known {
                least = Some(*place);
            }
        }
        let mut count = 0;
        while let Some([a, b]) = waiting.pop() {
            count += 1;
            let known = if self.is_in_midplane() {
                true
            } else if a.is_missing() || b.is_missing() {
                self.between([&a, &b]).is_some()
            } else {
                self.rises_from_c([&a, &b]) || {
                    let (slopes, depths) = self.depths([&a, &b], self.valley([&a, &b]));
                    let higher = least.is_some_and(|least| {
                        depths.low >= least.depth.high - self.lines.gap.roundings(LEVEL)
                    });
                    self.is_unknown(slopes, [&a, &b]) || higher || is_monotone(slopes)
                }
            };
            if let Some(xi) = self.middle([&a, &b], count).filter(|_| !known) {
                let middle = take(&mut self, &mut least, xi, halfway(a.eta, b.eta));
                waiting.extend([[middle, b], [a, middle]]);
            }
        }
        let least = least?;
        if let Some(c) = c.filter(|c| c.depth.low <= least.depth.high + self.lines.gap.roundings(SHALLOW)) {
            return Some(c.xi);
        }
        Some(self.turn_near(least).unwrap_or(least.xi))
    }

    /// Returns both ends of a range, and C, which is in every patch, between them, in pairs of neighbours, the last pair first.
    fn parted_at_c(&mut self, range: Interval) -> Vec<[LowestPlace; 2]> {
        let [first, last] = range.ends().map(|xi| self.place(xi, 0.0, 0.0));
        if !range.surrounds(0.0) {
            return vec![[first, last]];
        }
        let c = self.place(0.0, 0.0, 0.0);
        vec![[c, last], [first, c]]
    }

    /// Parts the range where the least gap may step. Right of such a place, a part begins beside it.
    fn ranges(&self) -> Vec<Interval> {
        let torn = self.lines.gap.torn(Interval::ALL);
        let beside = |low: f64| if torn.contains(&low) { low.next_up() } else { low };
        self.over.parts(torn.clone()).map(|part| Interval::new(beside(part.low), part.high)).collect()
    }

    /// Returns the middle between two places; `None` where they are too close together, or too many before them, to part them.
    fn middle(&self, [a, b]: [&LowestPlace; 2], count: usize) -> Option<f64> {
        let between = Interval::new(a.xi, b.xi);
        let whole = self.share([a, b]) > SHORTEST && between.surrounds(between.middle());
        (whole && count < MOST_RANGES).then(|| between.middle())
    }

    /// Returns what bounds of the least gap and its slope prove between two places; `None` where they prove nothing.
    fn between(&self, [a, b]: [&LowestPlace; 2]) -> Option<Between> {
        let inside = [a, b].map(LowestPlace::is_inside);
        if a.is_missing() || b.is_missing() {
            let out = inside == [false; 2];
            let missing = a.is_missing() && b.is_missing() && self.is_narrow([a, b]);
            return (out && (missing || self.is_above([a, b]))).then_some(Between::Outside);
        }
        let valley = self.valley([a, b]);
        let lowest = valley.as_ref().map(|(valley, _)| *valley);
        let (slopes, Interval { low, high }) = self.depths([a, b], valley);
        let unknown = self.is_unknown(slopes, [a, b]);
        let shallow = self.lines.gap.roundings(SHALLOW);
        let (all_out, all_in) = (unknown || low > -shallow, unknown || high < shallow);
        let is_bowl = || lowest.is_some_and(|lowest| self.is_bowl([a, b], lowest));
        match inside {
            [true, true] => (all_in || is_bowl()).then_some(Between::Inside),
            [false, false] => {
                let above = slopes == Interval::ALL && self.is_above([a, b]);
                (all_out || above).then_some(Between::Outside)
            }
            _ => (is_monotone(slopes) || (all_out && all_in) || is_bowl()).then_some(Between::Passing),
        }
    }

    /// Returns a range of η \[mm\] that holds the lowest places between two, and bounds of the slopes there; `None` where none is proved, and
    /// along normals, where both vary with the gap.
    fn valley(&self, [a, b]: [&LowestPlace; 2]) -> Option<(Interval, BoxSlopes)> {
        let known = Interval::around([a.eta, b.eta]);
        let plain = self.lines.gap.has_plain_bounds();
        plain.then(|| self.lines.valley(Interval::new(a.xi, b.xi), known, Interval::ALL)).flatten()
    }

    /// Whether the least gap is proved to be a convex function of ξ between two places, the lowest ones of which lie in `valley`.
    fn is_bowl(&self, [a, b]: [&LowestPlace; 2], valley: Interval) -> bool {
        let gap = &self.lines.gap;
        let free = gap.is_over_plane() && self.window.holds(valley);
        free && gap.is_bowl(Interval::new(a.xi, b.xi), valley, gap.roundings(SHALLOW_VALLEY))
    }

    /// Whether C, one of two places, is proved to be the lowest between them: it is a stationary place of s, and where s is not below 0 no
    /// gap along normals is.
    fn rises_from_c(&self, [a, b]: [&LowestPlace; 2]) -> bool {
        let xi = Interval::new(a.xi, b.xi);
        let has_c = xi.contains(0.0) && self.window.contains(0.0);
        has_c && self.lines.is_bowl(xi, Interval::around([a.eta, b.eta]))
    }

    /// Whether heights alone prove that no line between two places meets the patch.
    fn is_above(&self, [a, b]: [&LowestPlace; 2]) -> bool {
        let (gap, xi) = (&self.lines.gap, Interval::new(a.xi, b.xi));
        let lines = if gap.is_skewed() {
            gap.within(xi).cut(self.window)
        } else {
            Interval::of(self.window.nearest(0.0))
        };
        gap.is_above(xi, lines)
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
    fn depths(
        &self,
        [a, b]: [&LowestPlace; 2],
        valley: Option<(Interval, BoxSlopes)>,
    ) -> (Interval, Interval) {
        let slopes = self.slopes([a, b], valley).unwrap_or(Interval::ALL);
        let width = b.xi - a.xi;
        let low = least_between([a, b].map(|place| place.depth.low), width, slopes);
        let high = -least_between([a, b].map(|place| -place.depth.high), width, -slopes);
        (slopes, Interval::new(low, high))
    }

    /// Returns bounds of the slope of the least gap between two places; `None` where none are known.
    ///
    /// Method: from line to line the least gap changes as the gap does along ξ at the lowest place.
    fn slopes(&self, [a, b]: [&LowestPlace; 2], valley: Option<(Interval, BoxSlopes)>) -> Option<Interval> {
        let (lines, xi) = (&*self.lines, Interval::new(a.xi, b.xi));
        let held = |(eta, slopes): (Interval, BoxSlopes), gap: Interval| {
            if self.window.holds(eta) {
                return Some((slopes.lowest, slopes));
            }
            let slopes = lines.gap.slopes(xi, eta.map(|eta| self.window.nearest(eta)), gap)?;
            Some((slopes.along, slopes))
        };
        if lines.gap.has_plain_bounds() {
            return held(valley?, Interval::ALL).map(|(lowest, _)| lowest);
        }
        let gaps = a.depth.hull(b.depth);
        let gaps = gaps.hull(gaps + lines.gap.approach());
        let mut margin = xi.width();
        for _ in 0..WIDENINGS {
            let gap = gaps.grown(margin);
            let valley = lines.valley(xi, Interval::around([a.eta, b.eta]), gap)?;
            let width = valley.0.width();
            let (lowest, slopes) = held(valley, gap)?;
            if slopes.along.magnitude() * xi.width() + slopes.across.magnitude() * width <= margin {
                return Some(lowest);
            }
            margin *= WIDER;
        }
        None
    }

    /// Returns ξ or σ and η \[mm\] of the least gap next to a place that is nearly the least: that place if nothing next to it is lower.
    pub(in crate::patch) fn least_near(&mut self, [xi, eta]: [f64; 2]) -> [f64; 2] {
        let known = self.lines.gap.or_infinite(xi, eta);
        let near = self.lowest_place(xi, eta);
        let turn = self.turn_near(near).unwrap_or(xi);
        let place = self.lowest_place(turn, near.eta);
        if place.depth.high <= known { [turn, self.window.nearest(place.eta)] } else { [xi, eta] }
    }

    /// Returns the ξ or σ \[mm\] next to a place at which the least gap turns from falling to rising, unless it is larger there.
    fn turn_near(&mut self, near: LowestPlace) -> Option<f64> {
        let mut slope = |xi: f64| {
            let eta = self.window.nearest(self.lines.lowest(xi, near.eta));
            self.lines.gap.at(xi, eta).map_or(f64::NAN, |at| at.along)
        };
        let mut reach = FIRST_BRACKET * self.over.width();
        for _ in 0..DOUBLINGS {
            let Interval { low, high } = Interval::of(near.xi).grown(reach).cut(self.over);
            if slope(low) < 0.0 && slope(high) > 0.0 {
                let turn = bracketed(&mut slope, low, high)?;
                return Some(turn)
                    .filter(|&turn| self.lowest_place(turn, near.eta).depth.high <= near.depth.high);
            }
            reach *= 2.0;
        }
        None
    }

    /// Returns the least gap at ξ, as exactly as it takes to compare it with a depth \[mm\]. `guess` is about its η.
    ///
    /// Method: a parabola with the gap and slope at η falls below that gap by slope²/4a, with a the opening; slope²/a is allowed for.
    fn place(&mut self, xi: f64, guess: f64, compared: f64) -> LowestPlace {
        let lines = &mut *self.lines;
        let mut eta = if guess.is_nan() { 0.0 } else { guess };
        for _ in 0..if lines.gap.is_skewed() { STEPS } else { 0 } {
            let Some(at) = lines.gap.at(xi, eta) else { break };
            let allowed = at.across * at.across / lines.gap.opening;
            if allowed <= FAR_ABOVE * (at.gap - compared).abs() && self.window.contains(eta) {
                return LowestPlace { xi, eta, depth: Interval::new(at.gap - allowed, at.gap) };
            }
            eta -= at.across / (2.0 * lines.gap.opening);
        }
        self.lowest_place(xi, eta)
    }

    /// Returns the least gap at ξ, whose place is sought from a guess.
    pub(super) fn lowest_place(&mut self, xi: f64, guess: f64) -> LowestPlace {
        let eta = self.lines.lowest(xi, guess);
        LowestPlace { xi, eta, depth: Interval::of(self.lines.gap.gap(xi, self.window.nearest(eta))) }
    }
}

/// Returns the middle of two numbers; that which is known if the other is NaN.
pub(super) fn halfway(a: f64, b: f64) -> f64 {
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
pub(super) fn least_between([a, b]: [f64; 2], width: f64, slopes: Interval) -> f64 {
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
        let rail = Pair::new(standards::rail("60E1")?, standards::wheel("S1002")?, 460.0)?;
        let roller = rail.on_roller(350.0)?;
        let points = [(4.0, 6.0), (-20.0, -24.0), (-34.0, -33.0), (-35.5, -42.0)];
        let mut bowls = 0;
        for (pair, (rail_x, wheel_x)) in
            [&rail, &roller].into_iter().flat_map(|pair| points.map(|at| (pair, at)))
        {
            for (skew, reference) in [-0.05, 0.003, 0.02]
                .into_iter()
                .flat_map(|skew| [(skew, Reference::Plane), (skew, Reference::Rail)])
            {
                let placement = pair.placed(rail_x, wheel_x, skew)?;
                let mut slicer = Slicer::over(&placement, 0.1, (reference, Interval::ALL));
                let over = slicer
                    .lines
                    .as_ref()
                    .and_then(|lines| lines.gap.reach())
                    .expect("bodies over each other")
                    .cut(Interval::symmetric(25.0));
                let mut least = slicer.least_gap(over, Interval::ALL).expect("a skewed wheel");
                let (whole, mut known) = (least.ranges(), 0);
                let cells =
                    (0..RANGES).flat_map(|k| [1.0, 0.05, 1e-3].map(|width| (over.step(k, RANGES), width)));
                for cell in cells.map(|(low, width)| Interval::new(low, low + width)) {
                    let [a, b] = cell.ends().map(|xi| least.lowest_place(xi, 0.0));
                    let valley = least.valley([&a, &b]);
                    let convex = valley.as_ref().is_some_and(|(valley, _)| least.is_bowl([&a, &b], *valley));
                    let (slopes, depths) = least.depths([&a, &b], valley);
                    if !whole.iter().any(|range| range.holds(cell)) || slopes == Interval::ALL {
                        continue;
                    }
                    (known, bowls) = (known + 1, bowls + usize::from(convex));
                    let name = format!("{rail_x}, {skew}, {reference:?}, {cell:?}");
                    let places =
                        (0..=PLACES).map(|k| least.lowest_place(cell.step(k, PLACES), 0.0).depth.high);
                    let places: Vec<f64> = places.collect();
                    for depth in &places {
                        assert!(depths.grown(1e-12).contains(*depth), "{name}: {depth} beyond {depths:?}");
                    }
                    for three in places.windows(3).filter(|_| convex) {
                        let bend = three[0] - 2.0 * three[1] + three[2];
                        assert!(bend > -4e-12, "{name}: {bend} where the least gap is convex");
                    }
                }
                assert!(known > RANGES, "{rail_x}, {skew}, {reference:?}: {known}");
            }
        }
        assert!(bowls > RANGES, "{bowls}");
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

//! The ranges of ξ whose lines may meet the patch, and whether each of them does so in one slice at most.

use super::Lines;
use super::ranges::{SHALLOW, UNKNOWN};
use crate::numerics::interval::Interval;
use crate::profile::Section;

/// Most boxes by which the lines of a range are proved to have one lowest place.
const MOST_BOXES: usize = 24;

/// A range of ξ or σ whose lines may meet the patch.
#[derive(Debug, Clone, Copy)]
pub(in crate::patch) struct OpenRange {
    /// \[mm\]
    pub(in crate::patch) xi: Interval,
    /// Range of η \[mm\] outside which no line meets the patch inside the window.
    pub(in crate::patch) eta: Interval,
    /// Whether each line is proved to meet it in one slice at most.
    pub(in crate::patch) is_plain: bool,
}

/// Parts a range of ξ or σ, ascending, into ranges whose lines may meet the patch inside a window of η.
///
/// Method: strips of η over a range are left out where heights prove that both bodies are above each other. In the strips that are left
/// the lowest places of a range lie between an η at which the gap falls along η all over the range and one at which it rises; between
/// them each line has one lowest place, and outwards the gap only rises. Where that is not proved, the range is halved.
pub(in crate::patch) fn open(lines: &mut Lines<'_>, over: Interval, window: Interval) -> Vec<OpenRange> {
    if have_one_slice(lines, over) {
        return vec![OpenRange { xi: over, eta: window, is_plain: true }];
    }
    let shortest = UNKNOWN * over.width();
    let torn = lines.gap.torn(over);
    let strips = strips(lines, lines.gap.within(over).cut(window));
    let mut waiting: Vec<(Interval, Vec<Interval>)> =
        over.parts(torn.clone()).map(|xi| (xi, strips.clone())).collect();
    waiting.reverse();
    let mut found = Vec::<OpenRange>::new();
    while let Some((xi, mut strips)) = waiting.pop() {
        strips.retain(|eta| !lines.gap.is_high(xi, *eta));
        if strips.is_empty() {
            continue;
        }
        let eta = strips.iter().fold(Interval::NONE, |all, strip| all.hull(*strip));
        let middle = lines.lowest_beside(xi.middle(), eta.nearest(0.0));
        let is_plain = middle.is_some_and(|middle| lines.is_plain((xi, eta), middle, &mut { MOST_BOXES }));
        if !is_plain && xi.width() > shortest {
            let [low, high] = xi.halves();
            waiting.extend([(high, strips.clone()), (low, strips)]);
            continue;
        }
        let goes_on = |last: &&mut OpenRange| last.xi.high == xi.low && last.is_plain == is_plain;
        // Bands from single lines end where the gap may step.
        match found.last_mut().filter(goes_on).filter(|_| is_plain || !torn.contains(&xi.low)) {
            Some(last) => (last.xi.high, last.eta) = (xi.high, last.eta.hull(eta)),
            None => found.push(OpenRange { xi, eta, is_plain }),
        }
    }
    found
}

/// Parts a range of η into strips, each as wide as all that are nearer to the midplane.
fn strips(lines: &Lines<'_>, over: Interval) -> Vec<Interval> {
    let first = (lines.gap.approach().max(lines.gap.roundings(SHALLOW)) / lines.gap.opening).sqrt();
    let doubled = std::iter::successors(Some(first), |far| Some(2.0 * far));
    let places = doubled.take_while(|far| *far < over.magnitude()).flat_map(|far| [far, -far]);
    over.parts(places.collect()).collect()
}

/// Whether no line of a range meets the patch in several slices: without skew, where a line only rises from the midplane up to an end or step
/// of a body, and along the normals of a roller, whose lines are sampled where they may.
pub(in crate::patch) fn have_one_slice(lines: &Lines<'_>, over: Interval) -> bool {
    let (placement, wheel) = (lines.gap.placement(), &lines.gap.placement().wheel().section);
    let is_whole = |section: &Section| {
        section.steps.is_empty() && section.reach().is_some_and(|reach| reach.holds(over))
    };
    let are_whole =
        || is_whole(wheel) && placement.under().is_none_or(|under| is_whole(&under.wheel().section));
    !lines.gap.has_plain_bounds() || (!lines.gap.is_skewed() && are_whole())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conformal::Reference;
    use crate::error::Result;
    use crate::numerics::random::Random;
    use crate::patch::lines::lanes::line;
    use crate::placement::{Pair, Placement};
    use crate::profile::{Arc, Profile, Segment};

    /// Points of a line at which the gap is looked at.
    const POINTS: usize = 200;

    /// A yawed pair of chains of five lines.
    fn chains(dice: &mut Random) -> Result<Placement> {
        let mut chain = |bend: f64| {
            let mut last = [-20.0, 0.0];
            let lines = (1..6).map(|k| {
                let next = [8.0 * f64::from(k) - 20.0, bend * dice.normal()];
                Ok(Segment::arc(Arc::line(std::mem::replace(&mut last, next), next)?))
            });
            Profile::new("chain", "", lines.collect::<Result<_>>()?)
        };
        let pair = Pair::new(chain(0.5)?, chain(1.0)?, 460.0)?;
        pair.placed(dice.between(-15.0, 15.0), dice.between(-15.0, 15.0), dice.between(-0.1, 0.1))
    }

    #[test]
    fn what_is_not_open_holds_nothing_of_the_patch_and_plain_lines_one_slice() -> Result<()> {
        let mut kinds = [0; 2];
        for number in 0..30 {
            let dice = &mut Random::stream(66, number);
            let placement = chains(dice)?;
            for reference in [Reference::Plane, Reference::Rail] {
                let mut lines = Lines::new(&placement, 0.1, reference);
                let Some(over) = lines.gap.reach() else { continue };
                let ranges = open(&mut lines, over, Interval::ALL);
                for xi in (0..POINTS).map(|_| dice.between(over.low, over.high)) {
                    let here = ranges.iter().find(|range| range.xi.contains(xi));
                    let eta = here.map_or(Interval::NONE, |range| range.eta);
                    for place in (0..POINTS).map(|k| Interval::symmetric(60.0).step(k, POINTS)) {
                        let is_in = lines.gap.gap(xi, place) < 0.0;
                        assert!(!is_in || eta.contains(place), "{number}: {xi}, {place} beside {here:?}");
                    }
                    let Some(range) = here else { continue };
                    let slices = line(&mut lines, xi, Interval::ALL).slices.len();
                    kinds[usize::from(range.is_plain)] += 1;
                    assert!(!range.is_plain || slices <= 1, "{number}: {slices} slices at {xi} of {range:?}");
                }
            }
        }
        assert!(kinds.iter().all(|count| *count > 100), "{kinds:?}");
        Ok(())
    }
}

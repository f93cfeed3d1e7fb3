//! Newton's method to the least gap near a place of a lofted body, within the strip that it is on.

use super::above::{PointAbove, SweptAbove};
use crate::lofted::{LoftStrip, SPACING, SpacePoint};
use crate::numerics::interval::Interval;

/// Most steps. Newton's method takes four to six from a place within a tenth of a millimetre.
const STEPS: usize = 40;

/// Longest step: in cells across, and in mm along the track.
const LONGEST: [f64; 2] = [2.0, 10.0];

/// Step at which a place is found, in the same units: the gap then errs by its square.
const FOUND: [f64; 2] = [1e-9, 1e-8];

/// Most halvings of a step that does not lower the gap.
const HALVINGS: usize = 30;

/// A place of the varying body with the swept one above it.
#[derive(Debug, Clone, Copy)]
pub(super) struct SettledPlace {
    /// Parameters u and y \[mm\] of the strip.
    pub place: [f64; 2],
    /// The varying body's point.
    pub below: SpacePoint,
    /// The swept body's point above it.
    pub above: PointAbove,
    /// Whether it lies at an end of the strip: across, along.
    pub at_end: [bool; 2],
    /// Whether no derivative vanishes there although it lies inside: at a kink of the swept body.
    pub kink: bool,
    /// Whether it is one of a stretch of places with the same gap.
    pub stretch: bool,
}

/// The gap of a swept body over a strip.
#[derive(Debug, Clone, Copy)]
pub(super) struct StripGap<'a> {
    pub strip: &'a LoftStrip,
    pub over: &'a SweptAbove<'a>,
    /// Coordinate of the axle's middle in the list, or of the wheel's lowest meridian \[mm\].
    pub along: f64,
}

/// A place of contact with its strip.
#[derive(Debug, Clone, Copy)]
pub(super) struct FoundPlace {
    pub strip: usize,
    pub settled: SettledPlace,
}

impl StripGap<'_> {
    /// Finds the varying body's point at a place, and the swept body's above it; `None` where the swept body does not reach.
    pub fn at(&self, [u, y]: [f64; 2]) -> Option<(SpacePoint, PointAbove)> {
        let below = self.over.laid(self.along).point(self.strip.point(u, y));
        let above = self.over.above(self.over.seen(below.at))?;
        Some((below, above))
    }

    /// Computes gradient and second derivatives (uu, uy, yy) of the gap with respect to a place; the latter are exact where the gradient
    /// is 0.
    pub fn derivatives(&self, below: &SpacePoint, above: &PointAbove) -> ([f64; 2], [f64; 3]) {
        let ([a, b], [aa, ab, bb]) = (above.slopes, above.bends);
        // The height of the swept body less z, along a direction of its axes.
        let rise = |v: [f64; 3]| a * v[0] + b * v[1] - v[2];
        let rate = -rise(self.over.up);
        let [across, along] = [below.across, below.along].map(|v| self.over.turned(v));
        let second = |v: [f64; 3], p: [f64; 3], q: [f64; 3]| {
            let bend = aa * p[0] * q[0] + ab * (p[0] * q[1] + p[1] * q[0]) + bb * p[1] * q[1];
            (rise(self.over.turned(v)) + bend) / rate
        };
        let gradient = [rise(across) / rate, rise(along) / rate];
        let bends = [
            second(below.across2, across, across),
            second(below.mixed, across, along),
            second(below.along2, along, along),
        ];
        (gradient, bends)
    }

    /// Follows the gap down to its least value near a place; `None` where the swept body does not reach. Steps that do not settle end at
    /// the lowest place that they reached, as at a kink.
    pub fn settle(&self, from: [f64; 2]) -> Option<SettledPlace> {
        let ends = [Interval::new(0.0, self.strip.cells() as f64), self.strip.reach()];
        let mut place = from;
        let (mut below, mut above) = self.at(place)?;
        let rounding = self.over.rounding();
        for _ in 0..STEPS {
            let (gradient, bends) = self.derivatives(&below, &above);
            let held = [0, 1].map(|k| {
                (place[k] <= ends[k].low && gradient[k] >= 0.0)
                    || (place[k] >= ends[k].high && gradient[k] <= 0.0)
            });
            let level = self.level(gradient, bends);
            let step = descent(gradient, bends, [0, 1].map(|k| held[k] || level[k]));
            let stretch = (0..2).any(|k| level[k] && !held[k]);
            let found = |at_kink| SettledPlace { place, below, above, at_end: held, kink: at_kink, stretch };
            if (0..2).all(|k| step[k].abs() <= FOUND[k]) {
                return Some(self.at_beginning(found(false), [0, 1].map(|k| level[k] && !held[k])));
            }
            let lower = |step: [f64; 2]| {
                let mut share = (0..2).map(|k| LONGEST[k] / step[k].abs()).fold(1.0, f64::min);
                for _ in 0..HALVINGS {
                    let next = [0, 1].map(|k| (place[k] + share * step[k]).clamp(ends[k].low, ends[k].high));
                    let reached = self.at(next).filter(|(_, to)| to.gap < above.gap + rounding);
                    if let Some((from, to)) = reached {
                        return Some((next, from, to));
                    }
                    share *= 0.5;
                }
                None
            };
            let slid = || {
                lower(self.slide(&below, gradient, bends)).filter(|(next, ..)| apart(*next, place) > FOUND[1])
            };
            match lower(step).or_else(slid) {
                Some(next) => (place, below, above) = next,
                None => return Some(found(true)),
            }
        }
        Some(SettledPlace { place, below, above, at_end: [false; 2], kink: true, stretch: false })
    }

    /// Moves a place on a stretch with one gap to the strip's beginning, if that has the same gap: from all parts of the stretch Newton's
    /// method then ends at one place.
    fn at_beginning(&self, mut settled: SettledPlace, level: [bool; 2]) -> SettledPlace {
        let begin = [0.0, self.strip.reach().low];
        for k in (0..2).filter(|&k| level[k]) {
            let mut place = settled.place;
            place[k] = begin[k];
            let same = |above: &PointAbove| (above.gap - settled.above.gap).abs() <= self.over.rounding();
            if let Some((below, above)) = self.at(place).filter(|(_, above)| same(above)) {
                settled = SettledPlace { place, below, above, ..settled };
            }
        }
        settled
    }

    /// Tells across and along whether the longest step changes the gap by its rounding only.
    fn level(&self, gradient: [f64; 2], bends: [f64; 3]) -> [bool; 2] {
        let rounding = self.over.rounding();
        let least =
            |slope: f64, bend: f64, longest: f64| (slope.abs() + bend.abs() * longest) * longest <= rounding;
        [least(gradient[0], bends[0], LONGEST[0]), least(gradient[1], bends[2], LONGEST[1])]
    }

    /// Computes Newton's step along a kink of the swept body: at one abscissa of its profile.
    fn slide(&self, below: &SpacePoint, [f, g]: [f64; 2], [a, b, c]: [f64; 3]) -> [f64; 2] {
        let run = |v: [f64; 3]| self.over.turned(v)[0];
        let aside = -run(below.along) / run(below.across);
        let (slope, bend) = (f * aside + g, (a * aside + 2.0 * b) * aside + c);
        if bend > 0.0 && aside.is_finite() { [-slope / bend * aside, -slope / bend] } else { [0.0; 2] }
    }
}

/// Computes Newton's step down, over the coordinates that are not held; the longest step downwards where the gap is not convex.
fn descent([f, g]: [f64; 2], [a, b, c]: [f64; 3], held: [bool; 2]) -> [f64; 2] {
    let alone = |slope: f64, bend: f64, longest: f64| match slope {
        0.0 => 0.0,
        _ if bend > 0.0 => -slope / bend,
        _ => longest.copysign(-slope),
    };
    match held {
        [true, true] => [0.0; 2],
        [true, false] => [0.0, alone(g, c, LONGEST[1])],
        [false, true] => [alone(f, a, LONGEST[0]), 0.0],
        [false, false] => {
            let determinant = a * c - b * b;
            if a > 0.0 && determinant > 0.0 {
                [(b * g - c * f) / determinant, (b * f - a * g) / determinant]
            } else {
                [alone(f, a, LONGEST[0]), alone(g, c, LONGEST[1])]
            }
        }
    }
}

/// Gives the distance \[mm\] of two places: the larger one of both directions.
pub(super) fn apart(a: [f64; 2], b: [f64; 2]) -> f64 {
    (SPACING * (a[0] - b[0]).abs()).max((a[1] - b[1]).abs())
}

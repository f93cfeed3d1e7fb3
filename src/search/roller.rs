//! First touch of a wheel on a roller: a body of revolution below, whose axle lies at y = 0, parallel to x.
//!
//! At a contact the common normal lies in the roller's meridian plane, which stands at an angle ν ahead of the crown. An
//! observer who turns by ν about the roller's axle sees a rail there: the roller's profile, extruded along the tangent. To this
//! observer the wheel, a body of revolution, has another yaw, roll and place ([`Meridian`]), and the search over a rail finds where the two
//! outlines meet. The place is a contact of the roller if it lies in the observer's own plane: y′ = 0. So ν is a root, one for every
//! place of contact.
//!
//! The roller lies within every such rail. A place's gap over the rail of any ν is therefore no larger than its gap over the roller, and
//! a search at one ν bounds the gaps of all places. Without yaw, ν is 0 for a wheel above the crown, and a roller is a rail.

use super::candidates::{Candidate, Meeting};
use super::locus::Attitude;
use super::over_rail::RailSearch;
use crate::numerics::interval::Interval;

/// Most steps to the ν of a place. Each gains a digit or more; halving alone takes some 60.
const STEPS: usize = 80;

/// Number of passes after each of which ν moves to that of the best place. Then ν is kept, and a pass reaches as far as the bounds ask for.
const FREE_PASSES: usize = 2;

/// Most passes over all pairs: the free ones, one that finds how far the places reach, one that covers them.
const PASSES: usize = FREE_PASSES + 2;

/// Height \[mm\] above the lowest place up to which a place that has left its elements is searched: near misses beyond it are of no
/// interest.
const FOLLOWED_REACH: f64 = 2.0;

/// A wheel as an observer sees it who has turned by ν about the roller's axle, + forward.
#[derive(Debug, Clone, Copy)]
pub(super) struct Meridian {
    /// Attitude of the wheel over the rail that the observer sees.
    pub attitude: Attitude,
    /// Height of the wheel's profile origin over that of the rail if both are level without the turn \[mm\].
    level: f64,
    /// Distance \[mm\] from the roller's axle up to the wheel's, if both profile origins are level without the turn.
    up: f64,
    /// sin ν.
    sin: f64,
    /// cos ν.
    cos: f64,
}

impl Meridian {
    /// Turns the observer of an attitude over a roller of this radius \[mm\] by ν \[rad\].
    pub fn new(attitude: &Attitude, roller: f64, turn: f64) -> Self {
        let (sin, cos) = turn.sin_cos();
        let Attitude { sin_yaw, cos_yaw, sin_roll, cos_roll, radius, .. } = *attitude;
        // The axle's direction, turned.
        let forward = sin_yaw * cos + cos_yaw * sin_roll * sin;
        let down = cos_yaw * sin_roll * cos - sin_yaw * sin;
        let right = cos_yaw * cos_roll;
        let level_part = right.hypot(down);
        let rolled = [down / level_part, right / level_part];
        // R (cos φ − cos φ′) without a difference of nearly equal numbers.
        let lowered = (rolled[0] - sin_roll) * (rolled[0] + sin_roll) / (cos_roll + rolled[1]);
        let half = (turn / 2.0).sin();
        let up = radius * cos_roll + roller;
        let offset = attitude.offset + radius * (sin_roll - rolled[0]);
        Self {
            attitude: Attitude::of_directions(offset, [forward, level_part], rolled, radius),
            level: attitude.along * sin - 2.0 * up * half * half + radius * lowered,
            up,
            sin,
            cos,
        }
    }

    /// Returns a candidate of the observer with its vertical gap over the roller's rail \[mm\], and y′ of its place \[mm\] when it
    /// touches.
    fn seen(&self, candidate: Candidate, along: f64) -> (Candidate, f64) {
        let gap = (candidate.gap + self.level) / self.cos;
        let Candidate { wheel, .. } = candidate;
        let ahead = wheel.x - (self.attitude.radius - wheel.z) * wheel.sin / wheel.cos;
        let beside = along * self.cos - (self.up - gap) * self.sin + self.attitude.sin_yaw * ahead;
        (Candidate { gap, ..candidate }, beside)
    }
}

/// Returns the lowest candidate over a roller of this radius \[mm\], and leaves all others up to `within` above it in the
/// buffer. Gaps are vertical.
///
/// Method: a search at one ν collects candidates, and each is followed to its own ν. A further search then reaches as far as
/// any place may be whose gap over the roller counts.
pub(super) fn lower_on_roller(
    search: &mut RailSearch<'_>,
    attitude: &Attitude,
    roller: f64,
    within: f64,
) -> Option<Candidate> {
    let mut turn = attitude.along / (attitude.radius + roller);
    let (mut reach, mut found) = (within, Vec::new());
    for pass in 0..PASSES {
        let meridian = Meridian::new(attitude, roller, turn);
        let lowest = search.lower(&meridian.attitude, reach)?.gap;
        let seen = std::mem::take(&mut search.candidates);
        found.clear();
        found.extend(seen.iter().filter_map(|candidate| {
            let meeting = Meeting { turn, ..candidate.meeting };
            at_own_turn(search, attitude, roller, &meeting, Some(candidate))
        }));
        search.candidates = seen;
        let best = *found.iter().min_by(|a, b| a.gap.total_cmp(&b.gap))?;
        // Any other place up to there has no larger gap over the rail of this ν.
        let needed = (best.gap + within) * meridian.cos - meridian.level - lowest;
        if needed <= reach {
            break;
        }
        reach = needed;
        if pass < FREE_PASSES {
            turn = best.meeting.turn;
        }
    }
    std::mem::swap(&mut search.candidates, &mut found);
    search.candidates.iter().min_by(|a, b| a.gap.total_cmp(&b.gap)).copied()
}

/// Follows a place of contact to the ν at which it lies in the observer's own plane; `None` if it vanishes on the way.
///
/// Method: secants of y′(ν), which falls by nearly the sum of both radii \[mm/rad\]; halving once the root is enclosed and a
/// secant leaves the interval. `first` is the candidate at the first ν, if it is known.
pub(super) fn at_own_turn(
    search: &mut RailSearch<'_>,
    attitude: &Attitude,
    roller: f64,
    meeting: &Meeting,
    first: Option<&Candidate>,
) -> Option<Candidate> {
    let mut slope = -(attitude.radius + roller);
    let rounding = f64::EPSILON * -slope;
    let (mut ends, mut meeting, mut last) = (Interval::ALL, *meeting, None);
    let mut first = first.copied();
    for _ in 0..STEPS {
        let turn = meeting.turn;
        let meridian = Meridian::new(attitude, roller, turn);
        let here = first.take().or_else(|| follow_at(search, &meridian.attitude, &meeting))?;
        let (mut seen, beside) = meridian.seen(here, attitude.along);
        seen.meeting.turn = turn;
        if beside.abs() <= rounding {
            return Some(seen);
        }
        if beside < 0.0 {
            ends.high = turn;
        } else {
            ends.low = turn;
        }
        if let Some((before, value)) = last
            && before != turn
        {
            let secant = (beside - value) / (turn - before);
            slope = if secant < 0.0 { secant } else { slope };
        }
        last = Some((turn, beside));
        let next = turn - beside / slope;
        let next = if ends.surrounds(next) { next } else { ends.middle() };
        if next == turn || next == ends.low || next == ends.high {
            return Some(seen);
        }
        meeting = Meeting { turn: next, ..seen.meeting };
    }
    None
}

/// Returns the place of least gap near a former one over the rail of one ν; `None` if there is none.
fn follow_at(search: &mut RailSearch<'_>, attitude: &Attitude, meeting: &Meeting) -> Option<Candidate> {
    if let Some(found) = search.follow(attitude, meeting) {
        return Some(found);
    }
    // It has left its elements: the candidate that is nearest to it has taken its place.
    let [wheel, rail] = search.places_of(meeting);
    search.lower(attitude, FOLLOWED_REACH)?;
    let distance = |c: &Candidate| (c.wheel.x - wheel).abs() + (c.rail.x - rail).abs();
    search.candidates.iter().min_by(|a, b| distance(a).total_cmp(&distance(b))).copied()
}

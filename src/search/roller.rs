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
use super::element::ElementCurve;
use super::locus::Attitude;
use super::over_rail::RailSearch;
use crate::numerics::interval::Interval;
use crate::numerics::roots::bracketed;

/// Most steps to the ν of a place. Each gains a digit or more; halving alone takes some 60.
const STEPS: usize = 80;

/// Most searches, each at the ν of the best place of the one before.
const PASSES: usize = 3;

/// Difference \[mm\] of the lowest gaps over the roller and over the rail of one ν, up to which they are equal: some roundings.
const SAME_GAP: f64 = 1e-11;

/// Largest distance \[mm\] along the wheel's profile between two points of a walk. A dip of the gap that lies between two points is not
/// seen: on profiles of railways it is less than a tenth of a micrometre deep.
const WALKED: f64 = 0.25;

/// Largest difference of the sines of the profile's tangents between two points of a walk.
const TURNED: f64 = 0.02;

/// y′ \[mm\] up to which a point of a walk lies in the observer's own plane.
const NEARLY: f64 = 1e-3;

/// Largest difference of the sines of two tangents at a smooth place of contact; at a kink they jump.
const SMOOTH: f64 = 1e-6;

/// y′ \[mm\] at the end of a search for ν, up to which it is rounding; beyond, the search has gone from one place to another.
const IN_PLANE: f64 = 1e-6;

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
/// Method: a search at one ν collects candidates, and each is followed to its own ν, where the next search is made. A place whose gap over
/// the roller is the least over the rail of one ν is proved to be the lowest. Where none is, because places with different ν
/// compete, a walk along the wheel's profile finds the places.
pub(super) fn lower_on_roller(
    search: &mut RailSearch<'_>,
    attitude: &Attitude,
    roller: f64,
    within: f64,
) -> Option<Candidate> {
    let mut places = PlacesOnRoller { search, attitude, roller, found: Vec::new() };
    let mut turn = attitude.along / (attitude.radius + roller);
    let mut proven = false;
    for _ in 0..PASSES {
        places.found.clear();
        let lowest = places.collect(turn, within)?;
        let Some(best) = places.best() else { break };
        proven = best.gap - lowest <= SAME_GAP;
        if proven {
            break;
        }
        turn = best.meeting.turn;
    }
    if !proven {
        places.collect_along_wheel();
    }
    let best = places.best();
    search.candidates = places.found;
    best
}

/// The places of contact with a roller that searches at several ν have found.
struct PlacesOnRoller<'s, 'a> {
    search: &'s mut RailSearch<'a>,
    attitude: &'s Attitude,
    /// Distance \[mm\] from the roller's axle to the origin of its profile.
    roller: f64,
    found: Vec<Candidate>,
}

impl PlacesOnRoller<'_, '_> {
    /// Adds the places to which all candidates over the rail of one ν lead, up to `reach` \[mm\] above the lowest, and returns the
    /// lowest's gap over that rail \[mm\]; `None` if no part of the wheel is over it.
    fn collect(&mut self, turn: f64, reach: f64) -> Option<f64> {
        let meridian = Meridian::new(self.attitude, self.roller, turn);
        let lowest = self.search.lower(&meridian.attitude, reach / meridian.cos)?;
        let seen = std::mem::take(&mut self.search.candidates);
        self.found.extend(seen.iter().filter_map(|candidate| {
            let meeting = Meeting { turn, ..candidate.meeting };
            at_own_turn(self.search, self.attitude, self.roller, &meeting, Some(candidate))
        }));
        self.search.candidates = seen;
        Some(meridian.seen(lowest, self.attitude.along).0.gap)
    }

    /// Returns the lowest place.
    fn best(&self) -> Option<Candidate> {
        self.found.iter().min_by(|a, b| a.gap.total_cmp(&b.gap)).copied()
    }

    /// Adds the places of contact that a walk along the wheel's profile finds, each at its own ν: also those where the gap is largest over
    /// the rail of that ν, and yet least over the roller, which falls away from that rail.
    ///
    /// Method: each point of the wheel's profile has a ν at which it lies in the observer's own plane. The sine of the tangent there less
    /// that of the roller's below changes its sign at a place of contact, and jumps where the roller has a kink.
    fn collect_along_wheel(&mut self) {
        let wheel = &self.search.pair.wheel;
        for (index, element) in wheel.elements.iter().enumerate() {
            let [first, last] = element.ends;
            let length = (last.x - first.x).hypot(last.z - first.z);
            let count = (length / WALKED).max((last.sin - first.sin).abs() / TURNED).ceil().max(1.0) as usize;
            let mut turn = self.attitude.along / (self.attitude.radius + self.roller);
            let mut before: Option<(f64, Candidate, f64)> = None;
            for k in 0..=count {
                let p = element.range.step(k, count);
                let Some((here, rise)) = self.facing(index, p, &mut turn, NEARLY) else {
                    before = None;
                    continue;
                };
                let rises = |(_, there, last): &(f64, Candidate, f64)| {
                    (*last > 0.0) != (rise > 0.0) && (rise - last) * (here.rail.x - there.rail.x) > 0.0
                };
                let place =
                    before.filter(rises).and_then(|(from, ..)| self.place_between(index, [from, p], turn));
                self.found.extend(place);
                before = Some((p, here, rise));
            }
        }
    }

    /// Returns the place of contact between two parameters of an element of the wheel, where the tangent's sine passes the roller's; `None`
    /// if it passes at a hollow kink. `turn` is a ν nearby.
    fn place_between(&self, index: usize, [from, to]: [f64; 2], mut turn: f64) -> Option<Candidate> {
        let mut at = |p: f64| self.facing(index, p, &mut turn, 0.0);
        let root = bracketed(|p| at(p).map_or(f64::NAN, |(_, rise)| rise), from, to)?;
        let (place, rise) = at(root)?;
        if rise.abs() <= SMOOTH { Some(place) } else { self.on_kink(place) }
    }

    /// Moves a place over a kink or an end of the rail onto the fan of its normals; `None` if there is none with that tangent.
    fn on_kink(&self, place: Candidate) -> Option<Candidate> {
        let rail = &self.search.pair.rail.elements;
        let outline =
            Meridian::new(self.attitude, self.roller, place.meeting.turn).attitude.outline(&place.wheel);
        let near = place.meeting.elements[1] as usize;
        let (index, fan) = (near.saturating_sub(1)..rail.len().min(near + 2)).find_map(|k| {
            let ElementCurve::Arc(arc) = &rail[k].shape else { return None };
            let here = (arc.centre[0] - place.rail.x).abs() <= 16.0 * f64::EPSILON * self.search.pair.extent;
            (arc.radius == 0.0 && here && rail[k].range.contains(outline.sin)).then_some((k, arc))
        })?;
        let meeting = Meeting {
            elements: [place.meeting.elements[0], index as u32],
            parameters: [place.meeting.parameters[0], outline.sin],
            ..place.meeting
        };
        Some(Candidate { rail: fan.at(outline.sin, outline.cos), rail_radius: fan.radius, meeting, ..place })
    }

    /// Returns the point of the wheel at a parameter of one of its elements, over the roller's point below it, and the sine of the outline's
    /// tangent less that of the roller's. Beside the roller its end stands for the point below, and the difference is −1 on the track side, 1
    /// on the field side. `None` where the wheel has no outline.
    ///
    /// `turn` is a first ν, and becomes the one at which the point lies in the observer's own plane to an accuracy \[mm\].
    fn facing(
        &self,
        index: usize,
        parameter: f64,
        turn: &mut f64,
        accuracy: f64,
    ) -> Option<(Candidate, f64)> {
        let [above, below] = [&self.search.pair.wheel, &self.search.pair.rail];
        let wheel = &above.elements[index];
        let own = wheel.place(&above.coefficients, parameter);
        let slope = -(self.attitude.radius + self.roller);
        let mut steps = 0;
        loop {
            let meridian = Meridian::new(self.attitude, self.roller, *turn);
            let outline = meridian.attitude.outline(&own.station);
            if !(outline.x.is_finite() && outline.cos > 0.0) {
                return None;
            }
            let x = below.extent[0].nearest(outline.x);
            let (under, foot_parameter, foot) = below.point_at(x);
            let (elements, parameters) = ([index as u32, under], [parameter, foot_parameter]);
            let candidate = Candidate {
                gap: outline.z - foot.station.z,
                rail: foot.station,
                wheel: own.station,
                wheel_radius: wheel.radius(&own),
                rail_radius: below.elements[under as usize].radius(&foot),
                meeting: Meeting { elements, parameters, turn: *turn },
            };
            let (place, beside) = meridian.seen(candidate, self.attitude.along);
            let next = *turn - beside / slope;
            if beside.abs() <= accuracy || next == *turn || steps == STEPS {
                let beyond = outline.x - x;
                let rise = if beyond == 0.0 { outline.sin - foot.station.sin } else { beyond.signum() };
                return Some((place, rise));
            }
            (*turn, steps) = (next, steps + 1);
        }
    }
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
            return (beside.abs() <= IN_PLANE).then_some(seen);
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

//! Marches: a wheelset goes along rails that vary, or turns with wheels that vary, and touches at every place.

use std::f64::consts::TAU;

use rayon::prelude::*;

use super::position::Position;
use super::sweep::{Sweep, SweepRow, TrackSide};
use super::touch::{Contact, ONE_CONTACT, Selection};
use super::wheelset::WheelsetOnTrack;
use crate::error::{Error, Result, in_order};
use crate::numerics::interval::Interval;

/// Places of one block: enough work for all threads, and little memory.
const BLOCK: usize = 1024;

/// Distance along the track \[mm\] to which the place of an event is refined.
const REFINED: f64 = 0.01;

/// A wheelset that goes along its track, or turns about its axle, at one lateral position and yaw.
#[derive(Debug, Clone)]
pub struct March {
    /// The wheelset on its track; at least one of its rails or wheels varies.
    pub system: WheelsetOnTrack,
    /// Its position across the track.
    pub position: Position,
    /// Which places of contact are reported.
    pub selection: Selection,
    /// Where all rails that vary have slices \[mm\]; without end where none varies.
    pub reach: Interval,
    /// Pitch at which it goes along the track \[rad\]: see [`super::WheelsetSearch::stand_at`].
    pub pitch: f64,
}

/// What a march goes along.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum MarchAxis {
    /// The track \[mm\].
    Track,
    /// The pitch of the wheelset \[rad\].
    Pitch,
}

/// First touch with the middle of the axle at one place, or at one pitch.
#[derive(Debug, Clone, PartialEq)]
pub struct Stop {
    /// The place along the track \[mm\], or the pitch \[rad\].
    pub along: f64,
    /// Contacts of both sides, the left one first; none where a wheel has no rail, and over a hole.
    pub rows: Vec<SweepRow>,
    /// Whether the left and the right wheel stand over a hole of a list of slices, or would touch at its edge.
    pub holes: [bool; 2],
}

/// What happens to a wheel between two places.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EventKind {
    /// The wheel goes over from one place of its rail to another.
    Transfer,
    /// A second place comes within the reach of near misses.
    SecondBegins,
    /// The second place leaves the reach of near misses.
    SecondEnds,
    /// The second place is nearest to touching since it came within reach.
    LeastClearance,
    /// The wheelset is on its rails again.
    Begins,
    /// The wheelset leaves its rails: under one wheel or both there is none.
    Ends,
}

/// An event of a march.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event {
    /// What happens.
    pub kind: EventKind,
    /// Side of the wheel to which it happens.
    pub side: TrackSide,
    /// Place along the track \[mm\], or pitch \[rad\], refined to 0.01 mm on the track or around the wheel; a least clearance is known to
    /// the step of the march.
    pub along: f64,
    /// The lowest contact before; `None` where there is none.
    pub before: Option<Contact>,
    /// The lowest contact after; of a least clearance, the second place. `None` where there is none.
    pub after: Option<Contact>,
    /// Vertical gap of the second place \[mm\], where one is within reach.
    pub gap: Option<f64>,
    /// Slope of the axle's path before and after: mm up per mm along the track, or per mm that the wheel turns on its circumference; NaN
    /// without a contact.
    pub slopes: [f64; 2],
}

impl EventKind {
    /// Gives its name in tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Transfer => "transfer",
            Self::SecondBegins => "second-begins",
            Self::SecondEnds => "second-ends",
            Self::LeastClearance => "least-clearance",
            Self::Begins => "begins",
            Self::Ends => "ends",
        }
    }
}

impl Event {
    /// Gives the change of the rolling radius \[mm\]; NaN without a contact before and after.
    pub fn radius_jump(&self) -> f64 {
        self.both(|contact| contact.rolling_radius)
    }

    /// Gives the change of the angle of the wheel's path \[rad\], + where it turns up and the wheel strikes; NaN without a contact before
    /// and after.
    pub fn impact_angle(&self) -> f64 {
        self.slopes[1].atan() - self.slopes[0].atan()
    }

    fn both(&self, of: fn(&Contact) -> f64) -> f64 {
        self.before.zip(self.after).map_or(f64::NAN, |(before, after)| of(&after) - of(&before))
    }
}

impl Stop {
    /// Lists the contacts of a side, the lowest first.
    pub fn of(&self, side: TrackSide) -> impl Iterator<Item = &Contact> {
        self.rows.iter().filter(move |row| row.side == side).map(|row| &row.contact)
    }

    /// Tells whether a wheel stands over a hole.
    fn over_hole(&self) -> bool {
        self.holes.contains(&true)
    }
}

const SIDES: [TrackSide; 2] = [TrackSide::Left, TrackSide::Right];

/// Tells whether two lowest contacts are too far apart for the wheel to roll from one to the other.
fn far(a: &Contact, b: &Contact) -> bool {
    [a.rail_x - b.rail_x, a.wheel_x - b.wheel_x, a.y - b.y].iter().any(|apart| apart.abs() > ONE_CONTACT)
}

/// A march along one course.
#[derive(Clone, Copy)]
struct Way<'a> {
    march: &'a March,
    course: MarchAxis,
}

impl March {
    /// Hands the stops at ascending places \[mm\] to `sink`, block by block, each with the events since the block before, as long as
    /// `sink` returns true.
    ///
    /// It runs on the threads of the current rayon pool; any number of threads gives the same bits. Cost: about 1 ms for a stop, and some
    /// ten more stops for an event.
    ///
    /// # Errors
    /// Rails of one profile each; places that do not ascend, or where a rail has no slices; a position with values that are not finite,
    /// or angles beyond ±0.5 rad; the errors of `sink`.
    pub fn blocks(&self, along: &[f64], sink: impl FnMut(&[Stop], &[Event]) -> Result<bool>) -> Result<()> {
        Way { march: self, course: MarchAxis::Track }.blocks(along, sink)
    }

    /// Hands the stops at ascending pitches \[rad\] to `sink`, as [`Self::blocks`] does: the wheelset turns about its axle, and the part
    /// of a wheel that lies at −pitch is lowest. Everything repeats after a whole turn.
    ///
    /// # Errors
    /// Wheels of one profile each, rails that vary; pitches that do not ascend; the other errors of [`Self::blocks`].
    pub fn turns(&self, pitches: &[f64], sink: impl FnMut(&[Stop], &[Event]) -> Result<bool>) -> Result<()> {
        Way { march: self, course: MarchAxis::Pitch }.blocks(pitches, sink)
    }

    /// Finds first touch at one place along the track \[mm\].
    ///
    /// # Errors
    /// The errors of [`Self::blocks`].
    pub fn at(&self, along: f64) -> Result<Stop> {
        let way = Way { march: self, course: MarchAxis::Track };
        way.goes()?;
        way.stop(&mut way.begin(), along)
    }

    /// Finds first touch at one pitch \[rad\].
    ///
    /// # Errors
    /// The errors of [`Self::turns`].
    pub fn turned(&self, pitch: f64) -> Result<Stop> {
        let way = Way { march: self, course: MarchAxis::Pitch };
        way.goes()?;
        way.stop(&mut way.begin(), pitch)
    }

    /// Lists the holes of the lists of slices under both wheels that reach into a range of places \[mm\], or where the rails do not vary of
    /// pitches \[rad\]: where no surface is defined, in order. Between them and contacts at their edges a march has neither rows nor events.
    pub fn holes(&self, range: Interval) -> Vec<Interval> {
        let along_rails = self.reach.low.is_finite();
        let mut found = Vec::new();
        for right in [false, true] {
            let side = if right { self.system.right() } else { self.system.left() };
            let holes = side.pair.holes().into_iter();
            if along_rails {
                let ahead = self.system.along(right, &self.position, 0.0);
                found.extend(holes.map(|hole| hole + -ahead));
            } else {
                let turns = (range.low / TAU).floor() as i32 - 1..=(range.high / TAU).ceil() as i32 + 1;
                found.extend(
                    holes.flat_map(|hole| turns.clone().map(move |turn| hole + TAU * f64::from(turn))),
                );
            }
        }
        found.retain(|hole| hole.overlaps(range));
        found.sort_by(|a, b| a.low.total_cmp(&b.low).then(a.high.total_cmp(&b.high)));
        found.dedup();
        found
    }
}

impl<'a> Way<'a> {
    fn blocks(&self, places: &[f64], mut sink: impl FnMut(&[Stop], &[Event]) -> Result<bool>) -> Result<()> {
        self.goes()?;
        if let Some(pair) = places.windows(2).find(|pair| pair[0] >= pair[1]) {
            let (name, unit) = self.course.name();
            let found = format!("{} {unit} after {} {unit}", pair[1], pair[0]);
            return Err(Error::new(name, found, "ascending places", "sort them"));
        }
        // Before the threads begin, so that the error is that of the first such place.
        places.iter().try_for_each(|&at| self.reaches(at))?;
        let mut last: Option<Stop> = None;
        let mut clearance = [None; 2];
        for block in places.chunks(BLOCK) {
            let stops = block.par_iter().map_init(|| self.begin(), |sweep, &at| self.stop(sweep, at));
            let stops = in_order(stops)?;
            let before = last.iter().chain(&stops);
            let pairs: Vec<(&Stop, &Stop)> =
                before.zip(stops.iter().skip(usize::from(last.is_none()))).collect();
            let between = pairs.into_par_iter().map_init(
                || self.begin(),
                |sweep, (a, b)| {
                    let mut events = Vec::new();
                    self.between(sweep, a, b, &mut events).map(|()| events)
                },
            );
            let mut found: Vec<Event> = in_order(between)?.into_iter().flatten().collect();
            for (k, side) in SIDES.into_iter().enumerate() {
                found.extend(self.clearances(&stops, side, &mut clearance[k]));
            }
            found.sort_by(|a, b| a.along.total_cmp(&b.along));
            last = stops.last().cloned();
            if !sink(&stops, &found)? {
                return Ok(());
            }
        }
        let open: Vec<Event> = clearance.into_iter().flatten().collect();
        if open.is_empty() { Ok(()) } else { sink(&[], &open).map(drop) }
    }

    fn begin(&self) -> Sweep<'a> {
        Sweep::new(&self.march.system, self.march.selection, None)
    }

    fn stop(&self, sweep: &mut Sweep<'_>, along: f64) -> Result<Stop> {
        self.reaches(along)?;
        let mut rows = Vec::new();
        match self.course {
            MarchAxis::Track => sweep.stand_at(along, self.march.pitch),
            MarchAxis::Pitch => sweep.stand_at(0.0, along),
        }
        sweep.position(&self.march.position, &mut rows)?;
        Ok(Stop { along, rows, holes: sweep.over_holes() })
    }

    /// Rejects bodies that do not vary along the course.
    fn goes(&self) -> Result<()> {
        let along_rails = self.march.reach.low.is_finite();
        match self.course {
            MarchAxis::Track if !along_rails => {
                let expected = "a rail that varies: a list .slcs of slices without `along`";
                Err(Error::new("rail", "rails of one profile each", expected, "or march over angles"))
            }
            MarchAxis::Pitch if along_rails => {
                let expected = "rails of one profile each, on which a wheelset turns";
                Err(Error::new("rail", "rails that vary along the track", expected, "or march along them"))
            }
            MarchAxis::Pitch if !self.march.system.turning() => {
                let expected =
                    "a wheel that varies: `flat`, `radii`, or a list .slcw of slices without `angle`";
                Err(Error::new("wheel", "wheels of one profile each", expected, "or march along the track"))
            }
            MarchAxis::Pitch if self.march.pitch != 0.0 => {
                let found = format!("{} rad", self.march.pitch);
                let expected = "no pitch of a march around the axle, which has its own";
                Err(Error::new("wheelset: pitch", found, expected, "remove it"))
            }
            _ => Ok(()),
        }
    }

    /// Rejects a place \[mm\] where a rail has no slices, and a pitch that is no number.
    fn reaches(&self, at: f64) -> Result<()> {
        let reach = self.march.reach;
        if reach.contains(at) && at.is_finite() {
            return Ok(());
        }
        let (name, unit) = self.course.name();
        let expected = match self.course {
            MarchAxis::Track => {
                format!("a place from {} to {} mm, where all slices are", reach.low, reach.high)
            }
            MarchAxis::Pitch => "an angle".into(),
        };
        Err(Error::new(name, format!("{at} {unit}"), expected, "march where the lists reach"))
    }

    /// Appends the events between two stops, each refined by halving. Up to a hole there may be some, across it there are none.
    fn between(&self, sweep: &mut Sweep<'_>, a: &Stop, b: &Stop, events: &mut Vec<Event>) -> Result<()> {
        let changes = SIDES.map(|side| self.change(a, b, side));
        if changes == [None; 2] && a.over_hole() == b.over_hole() {
            return Ok(());
        }
        let refined = match self.course {
            MarchAxis::Track => REFINED,
            MarchAxis::Pitch => REFINED / self.march.system.reference_radius(),
        };
        let middle = 0.5 * (a.along + b.along);
        if b.along - a.along <= refined || middle <= a.along || middle >= b.along {
            events.extend(changes.into_iter().flatten());
            return Ok(());
        }
        let middle = self.stop(sweep, middle)?;
        self.between(sweep, a, &middle, events)?;
        self.between(sweep, &middle, b, events)
    }

    /// Says what happens to a side from one stop to the next; `None` if it rolls on, and over a hole.
    fn change(&self, before: &Stop, after: &Stop, side: TrackSide) -> Option<Event> {
        if before.over_hole() || after.over_hole() {
            return None;
        }
        let [was, is] = [before, after].map(|stop| stop.of(side).next().copied());
        let [had, has] = [before, after].map(|stop| self.second(stop, side).map(|contact| contact.gap));
        let kind = match (was, is) {
            (Some(was), Some(is)) if far(&was, &is) => EventKind::Transfer,
            (Some(_), None) => EventKind::Ends,
            (None, Some(_)) => EventKind::Begins,
            _ if had.is_none() && has.is_some() => EventKind::SecondBegins,
            _ if had.is_some() && has.is_none() => EventKind::SecondEnds,
            _ => return None,
        };
        Some(self.event(kind, side, after.along, [was, is], has.or(had)))
    }

    /// Gives the place second to the lowest. Without a reach of near misses there is none: where two places touch at once the wheel goes
    /// over from one to the other.
    fn second(&self, stop: &Stop, side: TrackSide) -> Option<Contact> {
        let reach = self.march.selection.within > 0.0;
        stop.of(side).nth(1).filter(|_| reach).copied()
    }

    /// Finds the least clearances of second places that end in a block; `open` is the one that has not ended yet.
    fn clearances(&self, stops: &[Stop], side: TrackSide, open: &mut Option<Event>) -> Vec<Event> {
        let (mut ended, mut before) = (Vec::new(), f64::NAN);
        for stop in stops {
            if stop.over_hole() {
                // A clearance that still falls at the edge of a hole may be less inside.
                ended.extend(open.take().filter(|least| least.along != before));
                continue;
            }
            before = stop.along;
            let (lowest, second) = (stop.of(side).next().copied(), self.second(stop, side));
            let gap = second.map(|second| second.gap);
            match gap {
                None => ended.extend(open.take()),
                Some(own) if open.is_none_or(|least| least.gap.is_none_or(|gap| own < gap)) => {
                    let kind = EventKind::LeastClearance;
                    *open = Some(self.event(kind, side, stop.along, [lowest, second], gap));
                }
                Some(_) => {}
            }
        }
        ended
    }

    fn event(
        &self,
        kind: EventKind,
        side: TrackSide,
        along: f64,
        [before, after]: [Option<Contact>; 2],
        gap: Option<f64>,
    ) -> Event {
        let slope = |contact: Contact| match self.course {
            MarchAxis::Track => contact.slope_along(),
            MarchAxis::Pitch => {
                let yaw = if side == TrackSide::Right { 1.0 } else { -1.0 } * self.march.position.yaw;
                slope_of_turning(&contact, yaw)
            }
        };
        let slopes = [before, after].map(|contact| contact.map_or(f64::NAN, slope));
        Event { kind, side, along, before, after, gap, slopes }
    }
}

/// Gives the slope of the axle's path per length by which a wheel turns, forward at the bottom: a contact ahead of the place where a round
/// wheel would touch moves up with the wheel, and the axle comes down.
fn slope_of_turning(contact: &Contact, yaw: f64) -> f64 {
    let round = yaw.sin() * (contact.wheel_x - contact.rolling_radius * contact.wheel_angle.tan());
    0.0 - (contact.y - round) / contact.rolling_radius
}

impl MarchAxis {
    /// Gives name and unit of its places.
    fn name(self) -> (&'static str, &'static str) {
        match self {
            Self::Track => ("along", "mm"),
            Self::Pitch => ("angle", "rad"),
        }
    }
}

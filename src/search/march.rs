//! Marches: a wheelset goes along rails that vary, and touches at every place.

use rayon::prelude::*;

use super::position::Position;
use super::sweep::{Sweep, SweepRow, TrackSide};
use super::touch::{Contact, ONE_CONTACT, Selection};
use super::wheelset::WheelsetOnTrack;
use crate::error::{Error, Result};

/// Places of one block: enough work for all threads, and little memory.
const BLOCK: usize = 1024;

/// Distance along the track \[mm\] to which the place of an event is refined.
const REFINED: f64 = 0.01;

/// A wheelset that goes along its track at one lateral position and yaw.
#[derive(Debug, Clone)]
pub struct March {
    /// The wheelset on its track; at least one of its rails varies.
    pub system: WheelsetOnTrack,
    /// Its position across the track.
    pub position: Position,
    /// Which places of contact are reported.
    pub selection: Selection,
    /// Where all rails that vary have slices \[mm\].
    pub reach: [f64; 2],
}

/// First touch with the middle of the axle at one place.
#[derive(Debug, Clone, PartialEq)]
pub struct Stop {
    /// The place along the track \[mm\].
    pub along: f64,
    /// Contacts of both sides, the left one first; none where a wheel has no rail.
    pub rows: Vec<SweepRow>,
}

/// What happens to a wheel between two places.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EventKind {
    /// The wheel goes over from one place of its rail to another.
    Transfer,
    /// A second place comes within the reach of near misses.
    SecondBegins,
    /// It leaves that reach.
    SecondEnds,
    /// The second place is nearest to touching since it came within reach.
    LeastClearance,
    /// The wheelset stands on its rails again.
    Begins,
    /// A wheel has no rail any more.
    Ends,
}

/// An event of a march.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event {
    /// What happens.
    pub kind: EventKind,
    /// To which wheel.
    pub side: TrackSide,
    /// Where \[mm\], refined to 0.01 mm; least clearances to the step of the march.
    pub along: f64,
    /// The lowest contact before; `None` where there is none.
    pub before: Option<Contact>,
    /// The lowest contact after.
    pub after: Option<Contact>,
    /// Vertical gap of the second place \[mm\], where one is within reach.
    pub gap: Option<f64>,
}

impl EventKind {
    /// Its name in tables.
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
    /// Change of the rolling radius \[mm\]; NaN without a contact before and after.
    pub fn radius_jump(&self) -> f64 {
        self.both(|contact| contact.rolling_radius)
    }

    /// Change of the angle of the wheel's path \[rad\], − where it turns down and the wheel strikes; NaN without a contact before and
    /// after.
    pub fn impact_angle(&self) -> f64 {
        self.both(|contact| contact.slope_along().atan())
    }

    fn both(&self, of: fn(&Contact) -> f64) -> f64 {
        self.before.zip(self.after).map_or(f64::NAN, |(before, after)| of(&after) - of(&before))
    }
}

impl Stop {
    /// The contacts of a side, the lowest first.
    pub fn of(&self, side: TrackSide) -> impl Iterator<Item = &Contact> {
        self.rows.iter().filter(move |row| row.side == side).map(|row| &row.contact)
    }
}

const SIDES: [TrackSide; 2] = [TrackSide::Left, TrackSide::Right];

/// Tells whether two lowest contacts are places that the wheel does not roll between.
fn far(a: &Contact, b: &Contact) -> bool {
    [a.rail_x - b.rail_x, a.wheel_x - b.wheel_x, a.y - b.y].iter().any(|apart| apart.abs() > ONE_CONTACT)
}

/// Says what happens to a side from one stop to the next; `None` if it rolls on.
fn change(before: &Stop, after: &Stop, side: TrackSide) -> Option<Event> {
    let [was, is] = [before, after].map(|stop| stop.of(side).next().copied());
    let [had, has] = [before, after].map(|stop| stop.of(side).nth(1).map(|contact| contact.gap));
    let kind = match (was, is) {
        (Some(was), Some(is)) if far(&was, &is) => EventKind::Transfer,
        (Some(_), None) => EventKind::Ends,
        (None, Some(_)) => EventKind::Begins,
        _ if had.is_none() && has.is_some() => EventKind::SecondBegins,
        _ if had.is_some() && has.is_none() => EventKind::SecondEnds,
        _ => return None,
    };
    Some(Event { kind, side, along: after.along, before: was, after: is, gap: has.or(had) })
}

impl March {
    /// Hands the stops at ascending places \[mm\] to `sink`, block by block, each with the events since the one before; as long as it
    /// wants more.
    ///
    /// It runs on the threads of the current rayon pool; any number of threads gives the same bits. Cost: about 1 ms for a stop, and some
    /// ten more stops for an event.
    ///
    /// # Errors
    /// Places that do not ascend, or where a rail has no slices; a position with values that are not finite, or angles beyond ±0.5 rad;
    /// the errors of `sink`.
    pub fn blocks(
        &self,
        along: &[f64],
        mut sink: impl FnMut(&[Stop], &[Event]) -> Result<bool>,
    ) -> Result<()> {
        if let Some(pair) = along.windows(2).find(|pair| pair[0] >= pair[1]) {
            let found = format!("{} mm after {} mm", pair[1], pair[0]);
            return Err(Error::new("along", found, "ascending places", "sort them"));
        }
        // The first place in order, whatever thread would come upon one first.
        along.iter().try_for_each(|&at| self.reaches(at))?;
        let mut last: Option<Stop> = None;
        let mut clearance = [None; 2];
        for block in along.chunks(BLOCK) {
            let stops = block.par_iter().map_init(|| self.begin(), |sweep, &at| self.stop(sweep, at));
            let stops = stops.collect::<Result<Vec<_>>>()?;
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
            let mut found: Vec<Event> = between.collect::<Result<Vec<_>>>()?.into_iter().flatten().collect();
            for (k, side) in SIDES.into_iter().enumerate() {
                found.extend(clearances(&stops, side, &mut clearance[k]));
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

    fn begin(&self) -> Sweep<'_> {
        Sweep::new(&self.system, self.selection, None)
    }

    /// Finds first touch at one place along the track \[mm\].
    ///
    /// # Errors
    /// The errors of [`Self::blocks`].
    pub fn at(&self, along: f64) -> Result<Stop> {
        self.stop(&mut self.begin(), along)
    }

    fn stop(&self, sweep: &mut Sweep<'_>, along: f64) -> Result<Stop> {
        self.reaches(along)?;
        let mut rows = Vec::new();
        sweep.stand_at(along);
        sweep.position(&self.position, &mut rows)?;
        Ok(Stop { along, rows })
    }

    /// Rejects a place \[mm\] where a rail has no slices.
    fn reaches(&self, along: f64) -> Result<()> {
        let [from, to] = self.reach;
        if (from..=to).contains(&along) {
            return Ok(());
        }
        let expected = format!("a place from {from} to {to} mm, where all slices are");
        Err(Error::new("along", format!("{along} mm"), expected, "march where the lists reach"))
    }

    /// Appends the events between two stops, each refined by halving.
    fn between(&self, sweep: &mut Sweep<'_>, a: &Stop, b: &Stop, events: &mut Vec<Event>) -> Result<()> {
        let changes = SIDES.map(|side| change(a, b, side));
        if changes == [None; 2] {
            return Ok(());
        }
        if b.along - a.along <= REFINED {
            events.extend(changes.into_iter().flatten());
            return Ok(());
        }
        let middle = self.stop(sweep, 0.5 * (a.along + b.along))?;
        self.between(sweep, a, &middle, events)?;
        self.between(sweep, &middle, b, events)
    }
}

/// Finds the least clearances of second places that end in a block; `open` is the one that has not ended yet.
fn clearances(stops: &[Stop], side: TrackSide, open: &mut Option<Event>) -> Vec<Event> {
    let mut ended = Vec::new();
    for stop in stops {
        let mut contacts = stop.of(side);
        let (lowest, second) = (contacts.next().copied(), contacts.next());
        match second {
            None => ended.extend(open.take()),
            Some(second) if open.is_none_or(|least| least.gap.is_none_or(|gap| second.gap < gap)) => {
                *open = Some(Event {
                    kind: EventKind::LeastClearance,
                    side,
                    along: stop.along,
                    before: lowest,
                    after: Some(*second),
                    gap: Some(second.gap),
                });
            }
            Some(_) => {}
        }
    }
    ended
}

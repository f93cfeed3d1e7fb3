//! First touch of two bodies, one of which varies: a rail along the track, or a wheel around its axle.
//!
//! The vertical gap is a function over the varying body's surface. Its least value is found by branch and bound: parts of that surface,
//! down to pieces of one cell, stand against parts of the other body's profile, which is swept. A plane that touches a part of the
//! swept body from below bounds the gap over a part of the surface from below, to second order of their sizes. What is left is followed
//! down by Newton's method. A wheel that varies is a surface that is wrapped around its axle, and upside down the rail is the
//! swept body above it (`above`).

mod above;
mod cut;
mod node;
mod place;
mod settle;

use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::f64::consts::PI;
use std::mem;
use std::sync::Arc;

use super::body::SearchBody;
use super::candidates::{Candidate, Meeting};
use super::locus::Attitude;
use super::over_rail::Work;
use super::touch::{Contact, Pose, Selection, Touch, beside_its_rail, over_hole};
use crate::error::{Error, Result};
use crate::lofted::{Loft, LoftStrip, LoftedBody, LoftedWheel, turned};
use crate::numerics::interval::Interval;
use crate::placement::Pair;
use crate::profile::{Profile, Section, Side};
use above::SweptAbove;
pub use cut::Cut;
use cut::{cut_rail, cut_wheel};
use node::{BoundPart, VaryingPart};
use place::{candidate, contact};
use settle::{FoundPlace, SettledPlace, StripGap, apart};

/// Largest run of a part of the swept profile \[mm\]: its chord is off by 2.4 µm on a 13 mm radius.
const SWEPT_PARTS: f64 = 0.5;

/// Most parts of a swept profile of unusual size.
const MOST_PARTS: f64 = 4096.0;

/// Distance \[mm\] below which two places of Newton's method are one.
const ONE_PLACE: f64 = 1e-6;

/// Most pairs of parts that one search looks at, of some hundred bytes each. Searches look at some hundreds of pairs, and at some ten
/// thousand with near misses of a millimetre.
const MOST_LOOKED_AT: u64 = 1_000_000;

/// Largest angle \[rad\] from a wheel's lowest meridian that is searched. A flange of 70° under a yaw of 0.3 rad touches at 1.0.
const WINDOW: f64 = 1.3;

/// A rail and a wheel, one of which varies, prepared for searches.
#[derive(Debug, Clone)]
pub struct LoftedPair {
    loft: Arc<Loft>,
    varying: Side,
    /// The other body, upside down where that is the rail.
    swept: SearchBody,
    section: Section,
    /// Nominal rolling radius \[mm\].
    radius: f64,
    /// Angle \[rad\] at the middle of the surface of a wheel; every part of the wheel lies within π of it.
    middle: f64,
}

/// Searches over a pair in which one body varies; keeps its buffers.
#[derive(Debug, Clone)]
pub(super) struct LoftedSearch<'a> {
    pair: &'a LoftedPair,
    /// Coordinate of the axle's middle in the list of a rail, or of the lowest meridian in that of a wheel \[mm\].
    along: f64,
    parts: Vec<BoundPart>,
    queue: BinaryHeap<Open>,
    found: Vec<FoundPlace>,
    contacts: Vec<Contact>,
    /// Whether a search had too many parts to look at; no other search is made until [`Self::answered`] is called.
    gave_up: bool,
    pub work: Work,
}

/// A part of the varying body and a node of the other's tree between which the gap may be least.
#[derive(Debug, Clone, Copy)]
struct Open {
    bound: f64,
    part: usize,
    node: usize,
}

impl PartialEq for Open {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Open {}

impl PartialOrd for Open {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Open {
    /// Orders by falling bound, so that the largest has the least bound; of equal bounds the one that was made first is larger.
    fn cmp(&self, other: &Self) -> Ordering {
        let own = |open: &Self| (open.part, open.node);
        other.bound.total_cmp(&self.bound).then_with(|| own(other).cmp(&own(self)))
    }
}

impl LoftedPair {
    /// Prepares a rail that varies and a wheel of this nominal rolling radius \[mm\].
    ///
    /// # Errors
    /// A wheel profile with no part that faces the rail.
    pub fn new(loft: Arc<Loft>, wheel: &Profile, radius: f64) -> Result<Self> {
        Self::of(loft, Side::Rail, wheel, [radius, 0.0])
    }

    /// Lowers a single wheel until it touches. Gives the height \[mm\] of its profile's origin over the rail's, and the contacts of the
    /// selection, the lowest first. That origin is at `along` \[mm\] of the list of a rail that varies; a wheel that varies is turned by
    /// `pitch` \[rad\], + forward at the bottom.
    ///
    /// # Errors
    /// A wheel no part of which is over the rail, of the kind [`ErrorKind::NoContact`](crate::ErrorKind::NoContact); surfaces that follow
    /// each other so closely that no places of contact can be told apart.
    pub fn touch(
        &self,
        pose: &Pose,
        [along, pitch]: [f64; 2],
        selection: &Selection,
    ) -> Result<(f64, Vec<Contact>)> {
        let mut search = self.search();
        search.stand_at(along, pitch);
        let attitude = pose.attitude(self.radius);
        let lowest = search.lower(&attitude, selection.within);
        search.answered()?;
        let lowest = lowest.ok_or_else(beside_its_rail)?;
        if search.over_hole(&attitude, Some(&lowest.meeting)) {
            return Err(over_hole("contact", "the wheel"));
        }
        let height = -lowest.gap;
        Ok((height, search.collect(&attitude, height, selection).contacts.to_vec()))
    }

    /// Prepares a pair in which `varying` stands in place of one body.
    ///
    /// # Errors
    /// A profile of the other body with no part that faces `varying`.
    pub fn of_pair(pair: &Pair, varying: &LoftedBody) -> Result<Self> {
        match varying {
            LoftedBody::Rail(loft) => Self::new(Arc::clone(loft), pair.wheel(), pair.wheel_radius()),
            LoftedBody::Wheel(wheel) => Self::turning(wheel, pair.rail()),
        }
    }

    /// Prepares a wheel that varies and a rail of one profile.
    ///
    /// # Errors
    /// A rail profile with no part that faces the wheel.
    pub fn turning(wheel: &LoftedWheel, rail: &Profile) -> Result<Self> {
        Self::of(Arc::clone(&wheel.loft), Side::Wheel, &rail.upside_down(), [wheel.radius, wheel.middle])
    }

    fn of(loft: Arc<Loft>, varying: Side, swept: &Profile, [radius, middle]: [f64; 2]) -> Result<Self> {
        let section = Section::own_axes(swept, Side::Wheel);
        let longest = SWEPT_PARTS.max(swept.extent() / MOST_PARTS);
        let body = SearchBody::with_arcs_up_to(longest, &section, swept.extent(), Side::Wheel);
        let body = body.ok_or_else(|| {
            let expected = "a profile travelled from left to right";
            Error::new(&swept.name, "no surface", expected, "reverse or mirror it")
        })?;
        Ok(Self { loft, varying, swept: body, section, radius, middle })
    }

    /// Makes a search; the axle's middle is at 0 of a rail's list, and a wheel's 0 lies lowest.
    pub(super) fn search(&self) -> LoftedSearch<'_> {
        let mut search = LoftedSearch {
            pair: self,
            along: 0.0,
            parts: Vec::new(),
            queue: BinaryHeap::new(),
            found: Vec::new(),
            contacts: Vec::new(),
            gave_up: false,
            work: Work::default(),
        };
        search.stand_at(0.0, 0.0);
        search
    }

    /// Makes the error of bodies that touch at so many places at once that no search tells these apart.
    fn too_close(&self) -> Error {
        let (place, other) = match self.varying {
            Side::Rail => ("rail", "wheel"),
            Side::Wheel => ("wheel", "rail"),
        };
        let expected = format!("slices over which rail and wheel touch at places, not all over the {other}");
        let advice = "look at the slices nearby, or lower `within`";
        Error::new(place, "a surface too close to the other one", expected, advice)
    }

    /// Lists where the list defines no surface: along a rail \[mm\], or as pitches at which such a part of a wheel lies lowest \[rad\],
    /// of one turn.
    pub(super) fn holes(&self) -> Vec<Interval> {
        let holes = self.loft.holes.iter();
        if self.varying == Side::Rail {
            return holes.copied().collect();
        }
        let turned = |angle: f64| (angle - self.middle).abs() <= PI;
        let pitches = holes.map(|hole| Interval::new(-hole.high / self.radius, -hole.low / self.radius));
        pitches.filter(|pitch| turned(-pitch.high)).collect()
    }

    /// Tells whether it is the wheel that varies.
    pub(super) fn turning_wheel(&self) -> bool {
        self.varying == Side::Wheel
    }

    /// Cuts the body that varies by the plane across the track which lies `ahead` \[mm\] of the wheel profile's origin. This origin is at
    /// `along` \[mm\] of a rail's list; of a wheel, yawed by `yaw` \[rad\], −pitch \[rad\] lies lowest.
    pub(super) fn cut(&self, [along, pitch]: [f64; 2], yaw: f64, ahead: f64) -> Cut {
        match self.varying {
            Side::Rail => cut_rail(&self.loft, along + ahead),
            Side::Wheel => cut_wheel(&self.loft, self.radius, self.lowest(pitch), yaw, ahead),
        }
    }

    /// Gives the coordinate in a wheel's list \[mm\] of what lies lowest at a pitch \[rad\].
    fn lowest(&self, pitch: f64) -> f64 {
        self.radius * turned(-pitch, self.middle)
    }

    /// Gives the swept body at an attitude.
    fn over<'a>(&'a self, attitude: &'a Attitude) -> SweptAbove<'a> {
        SweptAbove::new(&self.section, attitude, self.varying)
    }
}

impl<'a> LoftedSearch<'a> {
    /// Makes sure that all searches since the last call had an answer.
    ///
    /// # Errors
    /// A search that ended without one: a body that varies and follows the other one's shape all over.
    pub fn answered(&mut self) -> Result<()> {
        if mem::take(&mut self.gave_up) { Err(self.pair.too_close()) } else { Ok(()) }
    }

    /// Moves the axle's middle to a place \[mm\] of the list of a rail that varies, or turns a wheel that varies by a pitch \[rad\], +
    /// forward at the bottom: −pitch of it lies lowest.
    pub fn stand_at(&mut self, along: f64, pitch: f64) {
        self.along = match self.pair.varying {
            Side::Rail => along,
            Side::Wheel => self.pair.lowest(pitch),
        };
    }

    /// Returns the lowest place of contact, and keeps all others up to `within` \[mm\] above it; `None` if no part of the wheel is over
    /// the rail.
    pub fn lower(&mut self, attitude: &Attitude, within: f64) -> Option<Candidate> {
        if self.gave_up {
            return None;
        }
        let pair = self.pair;
        let over = pair.over(attitude);
        self.parts.clear();
        self.queue.clear();
        self.found.clear();
        self.work.searches += 1;
        let mut lowest = f64::INFINITY;
        self.open(&over, &mut lowest, within);
        let start = self.work.pairs;
        while let Some(Open { bound, part, node }) = self.queue.pop() {
            if bound > lowest + within {
                break;
            }
            if self.work.pairs - start > MOST_LOOKED_AT {
                self.gave_up = true;
                return None;
            }
            let own = self.parts[part];
            let of = &pair.swept.nodes[node];
            if of.right != 0 && (of.size > own.size || own.is_small()) {
                for child in [node + 1, of.right as usize] {
                    self.push(&over, part, child, lowest + within);
                }
            } else if own.is_small() {
                self.settle(&over, part, &mut lowest, within);
            } else {
                for half in own.halves(&pair.loft) {
                    self.add(&over, half, node, &mut lowest, within);
                }
            }
        }
        let gap = |found: &FoundPlace| found.settled.above.gap;
        let lowest = *self.found.iter().min_by(|a, b| gap(a).total_cmp(&gap(b)))?;
        self.found.retain(|found| gap(found) <= gap(&lowest) + within);
        Some(candidate(&over, &lowest))
    }

    /// Opens all bays of the varying body that lie below the other one.
    fn open(&mut self, over: &SweptAbove<'_>, lowest: &mut f64, within: f64) {
        let pair = self.pair;
        let (ahead, far) = match pair.varying {
            Side::Rail => (over.attitude.along, pair.radius),
            Side::Wheel => (0.0, WINDOW * pair.radius),
        };
        let reach = Interval::of(self.along).grown(far) + ahead;
        for (strip, own) in pair.loft.strips.iter().enumerate() {
            for bay in own.bays() {
                let y = bay.y().cut(reach);
                if y.has_width() {
                    let shares = Interval::new(0.0, 1.0);
                    let part = VaryingPart { strip, bay: bay.index(), node: 1, shares, y };
                    self.add(over, part, 0, lowest, within);
                }
            }
        }
    }

    /// Adds a part of the varying body against a node of the other.
    fn add(&mut self, over: &SweptAbove<'_>, part: VaryingPart, node: usize, lowest: &mut f64, within: f64) {
        let loft = &self.pair.loft;
        if part.bay(loft).cells(part.node).is_empty() {
            return;
        }
        if part.cell(loft).is_some() {
            let gap = StripGap { strip: &loft.strips[part.strip], over, along: self.along };
            if let Some((_, above)) = gap.at(part.middle(loft)) {
                *lowest = lowest.min(above.gap);
            }
        }
        self.parts.push(part.bound(loft, over, self.along));
        if !self.push(over, self.parts.len() - 1, node, *lowest + within) {
            self.parts.pop();
        }
    }

    /// Queues a part against a node of the swept body; returns whether the gap between them may be least.
    fn push(&mut self, over: &SweptAbove<'_>, part: usize, node: usize, ceiling: f64) -> bool {
        self.work.pairs += 1;
        let (own, of) = (&self.parts[part], &self.pair.swept.nodes[node].bounds);
        let bound = own.gap_below(over, of);
        let may = bound <= ceiling && own.may_be_level(&self.pair.loft, over, of);
        if may {
            self.queue.push(Open { bound, part, node });
        }
        may
    }

    /// Follows the gap down from the middle of a small part, and keeps the place if it is a new one.
    fn settle(&mut self, over: &SweptAbove<'_>, part: usize, lowest: &mut f64, within: f64) {
        let loft = &self.pair.loft;
        let own = &mut self.parts[part];
        if std::mem::replace(&mut own.settled, true) {
            return;
        }
        let part = own.part;
        let gap = StripGap { strip: &loft.strips[part.strip], over, along: self.along };
        self.work.solves += 1;
        let Some(settled) = gap.settle(part.middle(loft)) else { return };
        let rounding = over.rounding();
        if settled.above.gap > *lowest + within + rounding || self.goes_on(over, part.strip, &settled) {
            return;
        }
        *lowest = lowest.min(settled.above.gap);
        // Only the first place of a stretch with one gap, as under a cylinder, counts.
        let known = |found: &FoundPlace| {
            let level = (found.settled.above.gap - settled.above.gap).abs() <= rounding;
            let stretch = found.settled.stretch && settled.stretch && level;
            found.strip == part.strip && (stretch || apart(found.settled.place, settled.place) <= ONE_PLACE)
        };
        if !self.found.iter().any(known) {
            self.found.push(FoundPlace { strip: part.strip, settled });
        }
    }

    /// Tells whether the surface goes on to a smaller gap beyond the end of the strip at which a place lies.
    fn goes_on(&self, over: &SweptAbove<'_>, strip: usize, settled: &SettledPlace) -> bool {
        let strips = &self.pair.loft.strips;
        let (own, [u, y]) = (&strips[strip], settled.place);
        let (left, first) = (u <= 0.0, y <= own.reach().low);
        let smaller = |other: &LoftStrip, place: [f64; 2], axis: usize, back: bool| {
            let gap = StripGap { strip: other, over, along: self.along };
            gap.at(place).is_some_and(|(below, above)| {
                let same = (0..2).all(|k| (below.own.at[k] - settled.below.own.at[k]).abs() <= ONE_PLACE);
                let gradient = gap.derivatives(&below, &above).0[axis];
                same && if back { gradient > 0.0 } else { gradient < 0.0 }
            })
        };
        strips.iter().any(|other| {
            let reach = other.reach();
            let beside = if left { other.part + 1 == own.part } else { other.part == own.part + 1 };
            let cells = other.cells() as f64;
            let across = settled.at_end[0]
                && beside
                && reach.contains(y)
                && smaller(other, [if left { cells } else { 0.0 }, y], 0, left);
            let next = other.part == own.part && y == if first { reach.high } else { reach.low };
            let ahead = [u * (cells / own.cells() as f64), y];
            across || (settled.at_end[1] && next && smaller(other, ahead, 1, first))
        })
    }

    /// Tells whether the list defines no surface where the wheel stands, or where it would touch at the place that [`Self::lower`] found
    /// lowest: at the edge of such a hole.
    pub fn over_hole(&self, attitude: &Attitude, lowest: Option<&Meeting>) -> bool {
        let stands = match self.pair.varying {
            Side::Rail => self.along + attitude.along,
            Side::Wheel => self.along,
        };
        self.pair.loft.holes.iter().any(|hole| hole.low < stands && stands < hole.high)
            || lowest.is_some_and(|lowest| self.at_hole(lowest.parameters))
    }

    /// Tells whether a place (u, y) lies at the edge of a hole.
    fn at_hole(&self, [_, y]: [f64; 2]) -> bool {
        self.pair.loft.holes.iter().any(|hole| hole.ends().contains(&y))
    }

    /// Returns the place of least gap near a former one at another attitude; `None` if it is lost.
    pub fn follow(&mut self, attitude: &Attitude, meeting: &Meeting) -> Option<Candidate> {
        let over = self.pair.over(attitude);
        let strip = meeting.elements[1] as usize;
        let gap = StripGap { strip: &self.pair.loft.strips[strip], over: &over, along: self.along };
        let settled = gap.settle(meeting.parameters)?;
        Some(candidate(&over, &FoundPlace { strip, settled }))
    }

    /// Collects the contacts of `selection` among the places that [`Self::lower`] left, at the height that it gave. At the edge of a hole
    /// no gap is least: the surface goes on unseen.
    pub fn collect(&mut self, attitude: &Attitude, height: f64, selection: &Selection) -> Touch<'_> {
        let over = self.pair.over(attitude);
        self.found.sort_by(|a, b| a.settled.above.gap.total_cmp(&b.settled.above.gap));
        self.contacts.clear();
        let within = |found: &&FoundPlace| found.settled.above.gap + height <= selection.within;
        for found in self.found.iter().filter(within) {
            if self.at_hole(found.settled.place) {
                continue;
            }
            let contact = contact(&over, found, self.along, height);
            let near = |c: &Contact| {
                (c.rail_x - contact.rail_x).abs() <= selection.apart
                    && (c.wheel_x - contact.wheel_x).abs() <= selection.apart
                    && (c.y - contact.y).abs() <= selection.apart
            };
            if !self.contacts.iter().any(near) {
                self.contacts.push(contact);
            }
        }
        Touch { height, contacts: &self.contacts }
    }
}

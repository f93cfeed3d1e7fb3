//! First touch of a wheel on a rail that varies along the track.
//!
//! The vertical gap is a function over the rail's surface. Its least value is found by branch and bound: parts of the rail, down to
//! pieces of one cell, stand against parts of the wheel's profile. A plane that touches a part of the wheel from below bounds the gap over a
//! part of the rail from below, to second order of their sizes. What is left is followed down by Newton's method.

mod node;
mod settle;
mod wheel;

use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::sync::Arc;

use super::body::SearchBody;
use super::candidates::{Candidate, Meeting};
use super::locus::Attitude;
use super::over_rail::Work;
use super::touch::{Contact, Pose, Selection, Touch};
use crate::error::{Error, Result};
use crate::lofted::Loft;
use crate::profile::{Profile, Section, Side, Station};
use node::{BoundPart, Part};
use settle::{Gap, Settled, apart};
use wheel::WheelAbove;

/// Largest run of a part of the wheel's profile \[mm\]: its chord is off by 2.4 µm on a 13 mm radius.
const WHEEL_PARTS: f64 = 0.5;

/// Most such parts of a wheel of an unusual size.
const MOST_PARTS: f64 = 4096.0;

/// Distance \[mm\] below which two places of Newton's method are one.
const ONE_PLACE: f64 = 1e-6;

/// Most pairs of parts that one search looks at: of some hundred bytes each. A search looks at some hundreds, and at some ten thousand
/// with near misses of a millimetre.
const MOST_LOOKED_AT: u64 = 1_000_000;

/// A lofted rail and a wheel, prepared for searches.
#[derive(Debug, Clone)]
pub struct LoftedPair {
    loft: Arc<Loft>,
    wheel: SearchBody,
    section: Section,
    radius: f64,
}

/// Searches over such a pair; keeps its buffers.
#[derive(Debug, Clone)]
pub(super) struct LoftedSearch<'a> {
    pair: &'a LoftedPair,
    /// Coordinate of the axle's middle in the list \[mm\].
    pub along: f64,
    parts: Vec<BoundPart>,
    queue: BinaryHeap<Open>,
    found: Vec<Found>,
    contacts: Vec<Contact>,
    /// Whether a search had too many parts to look at; none is made until this is taken back.
    pub gave_up: bool,
    pub work: Work,
}

/// A place of contact with its strip.
#[derive(Debug, Clone, Copy)]
struct Found {
    strip: usize,
    settled: Settled,
}

/// A part of the rail and a node of the wheel's tree between which the gap may be least.
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
    /// The largest is the one with the least bound; of equal bounds the one that was made first.
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
        let section = Section::own_axes(wheel, Side::Wheel);
        let longest = WHEEL_PARTS.max(wheel.extent() / MOST_PARTS);
        let body = SearchBody::with_arcs_up_to(longest, &section, wheel.extent(), Side::Wheel);
        let body = body.ok_or_else(|| {
            let expected = "a profile travelled from left to right";
            Error::new(&wheel.name, "no surface", expected, "reverse or mirror it")
        })?;
        Ok(Self { loft, wheel: body, section, radius })
    }

    /// The rail's surface.
    pub fn loft(&self) -> &Arc<Loft> {
        &self.loft
    }

    /// Lowers a single wheel, whose profile's origin stands at `along` \[mm\] of the list, until it touches: the height \[mm\] of that origin
    /// over the slices' one, and the contacts of the selection, the lowest first. `None` if no part of it is over the rail.
    ///
    /// # Errors
    /// A rail that follows the wheel's shape all over.
    pub fn touch(
        &self,
        pose: &Pose,
        along: f64,
        selection: &Selection,
    ) -> Result<Option<(f64, Vec<Contact>)>> {
        let mut search = self.search();
        search.along = along;
        let attitude = pose.attitude(self.radius);
        let lowest = search.lower(&attitude, selection.within);
        if search.gave_up {
            let expected = "slices over which a wheel touches at places, not all over";
            return Err(Error::new("rail", "too many places", expected, "check the slices and the wheel"));
        }
        Ok(lowest.map(|lowest| {
            let touch = search.collect(&attitude, -lowest.gap, selection);
            (touch.height, touch.contacts.to_vec())
        }))
    }

    /// Makes a search; the axle's middle is at 0 of the list.
    pub(super) fn search(&self) -> LoftedSearch<'_> {
        LoftedSearch {
            pair: self,
            along: 0.0,
            parts: Vec::new(),
            queue: BinaryHeap::new(),
            found: Vec::new(),
            contacts: Vec::new(),
            gave_up: false,
            work: Work::default(),
        }
    }
}

impl LoftedSearch<'_> {
    /// Returns the lowest place of contact, and keeps all others up to `within` \[mm\] above it; `None` if no part of the wheel is over
    /// the rail.
    pub fn lower(&mut self, attitude: &Attitude, within: f64) -> Option<Candidate> {
        if self.gave_up {
            return None;
        }
        let pair = self.pair;
        let wheel = WheelAbove::new(&pair.section, attitude);
        self.parts.clear();
        self.queue.clear();
        self.found.clear();
        self.work.searches += 1;
        let mut lowest = f64::INFINITY;
        self.open(&wheel, &mut lowest, within);
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
            let of = &pair.wheel.nodes[node];
            if of.right != 0 && (of.size > own.size || own.is_small()) {
                for child in [node + 1, of.right as usize] {
                    self.push(&wheel, part, child, lowest + within);
                }
            } else if own.is_small() {
                self.settle(&wheel, part, &mut lowest, within);
            } else {
                for half in own.halves(&pair.loft) {
                    self.add(&wheel, half, node, &mut lowest, within);
                }
            }
        }
        let gap = |found: &Found| found.settled.wheel.gap;
        let lowest = *self.found.iter().min_by(|a, b| gap(a).total_cmp(&gap(b)))?;
        self.found.retain(|found| gap(found) <= gap(&lowest) + within);
        Some(candidate(&wheel, &lowest))
    }

    /// Opens all intervals of the rail that lie below the wheel.
    fn open(&mut self, wheel: &WheelAbove<'_>, lowest: &mut f64, within: f64) {
        let pair = self.pair;
        let reach = [self.along - pair.radius, self.along + pair.radius].map(|y| y + wheel.attitude.along);
        for (strip, own) in pair.loft.strips.iter().enumerate() {
            for interval in own.intervals() {
                let [from, to] = interval.y();
                let y = [from.max(reach[0]), to.min(reach[1])];
                if y[0] < y[1] {
                    let part = Part { strip, interval: interval.index(), node: 1, shares: [0.0, 1.0], y };
                    self.add(wheel, part, 0, lowest, within);
                }
            }
        }
    }

    /// Adds a part of the rail against a node of the wheel.
    fn add(&mut self, wheel: &WheelAbove<'_>, part: Part, node: usize, lowest: &mut f64, within: f64) {
        let loft = &self.pair.loft;
        if part.interval(loft).cells(part.node).is_empty() {
            return;
        }
        if part.cell(loft).is_some() {
            let gap = Gap { strip: &loft.strips[part.strip], wheel, along: self.along };
            if let Some((_, above)) = gap.at(part.middle(loft)) {
                *lowest = lowest.min(above.gap);
            }
        }
        self.parts.push(part.bound(loft, wheel, self.along));
        if !self.push(wheel, self.parts.len() - 1, node, *lowest + within) {
            self.parts.pop();
        }
    }

    /// Queues a part against a node of the wheel; returns whether the gap between them may be least.
    fn push(&mut self, wheel: &WheelAbove<'_>, part: usize, node: usize, ceiling: f64) -> bool {
        self.work.pairs += 1;
        let (own, of) = (&self.parts[part], &self.pair.wheel.nodes[node].bounds);
        let bound = own.gap_below(wheel, of);
        let may = bound <= ceiling && own.may_be_level(&self.pair.loft, wheel, of);
        if may {
            self.queue.push(Open { bound, part, node });
        }
        may
    }

    /// Follows the gap down from the middle of a small part, and keeps the place if it is a new one.
    fn settle(&mut self, wheel: &WheelAbove<'_>, part: usize, lowest: &mut f64, within: f64) {
        let loft = &self.pair.loft;
        let own = &mut self.parts[part];
        if std::mem::replace(&mut own.settled, true) {
            return;
        }
        let part = own.part;
        let gap = Gap { strip: &loft.strips[part.strip], wheel, along: self.along };
        self.work.solves += 1;
        let Some(settled) = gap.settle(part.middle(loft)) else { return };
        let rounding = 16.0 * f64::EPSILON * self.pair.radius;
        if settled.wheel.gap > *lowest + within + rounding || self.goes_on(wheel, part.strip, &settled) {
            return;
        }
        *lowest = lowest.min(settled.wheel.gap);
        let known = |found: &Found| {
            found.strip == part.strip && apart(found.settled.place, settled.place) <= ONE_PLACE
        };
        if !self.found.iter().any(known) {
            self.found.push(Found { strip: part.strip, settled });
        }
    }

    /// Tells whether the surface goes on beyond the end of the strip at which a place lies, to a smaller gap.
    fn goes_on(&self, wheel: &WheelAbove<'_>, strip: usize, settled: &Settled) -> bool {
        if !settled.at_end[0] {
            return false;
        }
        let strips = &self.pair.loft.strips;
        let (own, y) = (&strips[strip], settled.place[1]);
        let left = settled.place[0] <= 0.0;
        let beside = |other: &crate::lofted::Strip| {
            let reach = other.reach();
            let next = if left { other.part + 1 == own.part } else { other.part == own.part + 1 };
            if !next || y < reach[0] || y > reach[1] {
                return false;
            }
            let place = [if left { other.cells() as f64 } else { 0.0 }, y];
            let gap = Gap { strip: other, wheel, along: self.along };
            gap.at(place).is_some_and(|(rail, above)| {
                let same = (0..2).all(|k| (rail.at[k] - settled.rail.at[k]).abs() <= ONE_PLACE);
                let [across, _] = gap.derivatives(&rail, &above).0;
                same && if left { across > 0.0 } else { across < 0.0 }
            })
        };
        strips.iter().any(beside)
    }

    /// Returns the place of least gap near a former one at another attitude; `None` if it is lost.
    pub fn follow(&mut self, attitude: &Attitude, meeting: &Meeting) -> Option<Candidate> {
        let wheel = WheelAbove::new(&self.pair.section, attitude);
        let strip = meeting.elements[1] as usize;
        let gap = Gap { strip: &self.pair.loft.strips[strip], wheel: &wheel, along: self.along };
        let settled = gap.settle(meeting.parameters)?;
        Some(candidate(&wheel, &Found { strip, settled }))
    }

    /// Collects the contacts of `selection` among the places that [`Self::lower`] left, at the height that it gave.
    pub fn collect(&mut self, attitude: &Attitude, height: f64, selection: &Selection) -> Touch<'_> {
        let wheel = WheelAbove::new(&self.pair.section, attitude);
        self.found.sort_by(|a, b| a.settled.wheel.gap.total_cmp(&b.settled.wheel.gap));
        self.contacts.clear();
        for found in self.found.iter().filter(|found| found.settled.wheel.gap + height <= selection.within) {
            let contact = contact(&wheel, found, self.along, height);
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

/// Upward unit normal of the rail's surface at a place, in the rail's axes; at an end or kink of the rail that of the wheel.
fn normal(wheel: &WheelAbove<'_>, settled: &Settled) -> [f64; 3] {
    let Settled { rail, wheel: above, at_end, .. } = settled;
    let [x, y, z] = if at_end.contains(&true) {
        wheel.turned_back([-above.slopes[0], -above.slopes[1], 1.0])
    } else {
        let ([xu, zu], [xy, zy]) = (rail.across, rail.along);
        [-zu, zu * xy - xu * zy, xu]
    };
    let length = x.hypot(y).hypot(z);
    [x / length, y / length, z / length]
}

fn candidate(wheel: &WheelAbove<'_>, found: &Found) -> Candidate {
    let Settled { place, rail, wheel: above, .. } = &found.settled;
    let [x, _, z] = normal(wheel, &found.settled);
    let length = x.hypot(z);
    Candidate {
        gap: above.gap,
        rail: Station { x: rail.at[0], z: rail.at[1], cos: z / length, sin: -x / length },
        wheel: Station {
            x: above.at[0],
            z: wheel.attitude.radius - rolling_radius(wheel, found),
            cos: above.tangent[1],
            sin: above.tangent[0],
        },
        wheel_radius: above.curvature.recip(),
        rail_radius: section_curvature(found).recip(),
        meeting: Meeting { elements: [0, found.strip as u32], parameters: *place, turn: 0.0 },
    }
}

/// Distance of the wheel's point from the axle \[mm\].
fn rolling_radius(wheel: &WheelAbove<'_>, found: &Found) -> f64 {
    let [_, y, z] = found.settled.wheel.at;
    (wheel.attitude.radius - z).hypot(y)
}

/// Curvature of the rail's section across the track \[1/mm\], + with the hollow side up.
fn section_curvature(found: &Found) -> f64 {
    if found.settled.at_end[0] {
        return f64::NEG_INFINITY;
    }
    let ([x, z], [xx, zz]) = (found.settled.rail.across, found.settled.rail.across2);
    (x * zz - z * xx) / x.hypot(z).powi(3)
}

fn contact(wheel: &WheelAbove<'_>, found: &Found, along: f64, height: f64) -> Contact {
    let Settled { rail, wheel: above, at_end, kink, .. } = &found.settled;
    let normal = normal(wheel, &found.settled);
    let (theta, ahead) = ((-normal[0]).atan2(normal[2]), normal[1].asin());
    let (cos, sin) = (theta.cos(), theta.sin());
    // ξ lies in the section across the track, η completes ξ, η, ζ.
    let eta = [normal[1] * sin, normal[2] * cos - normal[0] * sin, -normal[1] * cos];
    let radius = rolling_radius(wheel, found);
    let [s, c] = above.tangent;
    let around = [above.at[1] / radius, (wheel.attitude.radius - above.at[2]) / radius];
    let meridian = wheel.turned_back([c, -s * around[0], s * around[1]]);
    let on = |axis: [f64; 3]| (0..3).map(|k| meridian[k] * axis[k]).sum::<f64>();
    Contact {
        rail_x: rail.at[0],
        wheel_x: above.at[0],
        rail_z: rail.at[1],
        wheel_z: wheel.attitude.radius - radius,
        y: rail.y - along - wheel.attitude.along,
        turn: ahead,
        contact_angle: theta,
        wheel_angle: s.atan2(c),
        skew: on(eta).atan2(on([cos, 0.0, sin])),
        gap: above.gap + height,
        rolling_radius: radius,
        rail_curvature: section_curvature(found),
        wheel_curvature: if *kink { f64::INFINITY } else { above.curvature },
        rail_kink: at_end.contains(&true),
        wheel_kink: *kink,
    }
}

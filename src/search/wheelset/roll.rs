//! The roll at which both wheels touch: Newton's method on kept places of contact, then both sides lowered, then brackets.

use super::{LowestPlaces, SIGNS, WheelsetSearch};
use crate::search::candidates::{Candidate, Meeting};
use crate::search::far::{Far, LARGEST_ROLL};
use crate::search::locus::Attitude;
use crate::search::position::Position;
use crate::search::side::SideOnTrack;

/// Most times that both sides are lowered for one roll. Newton's method takes two to six; a contact beyond
/// 73° makes it leave the root, and from the far side of the flange it takes as many again. Halving alone
/// would take half of these, except where a wheel leaves its rail: there is no roll then.
const MOST_LEVELS: u32 = 64;

/// Number of Newton's levels without a change of sign before one is looked for.
const NEWTON_LEVELS: u32 = 5;

/// Newton steps with the places of contact kept: quadratic, from 1e-3 rad.
const FOLLOWED: u32 = 6;

/// Of so many rolls tried one is the middle between the ends.
const HALVED: u32 = 4;

/// Both sides on given places of contact at one roll; arrays are \[left, right\].
#[derive(Debug, Clone, Copy)]
pub(super) struct KeptPlaces {
    pub roll: f64,
    /// Heights of the axle's middle above R over the top of rail \[mm\].
    pub z: [f64; 2],
    /// Derivative of the difference of `z` with respect to the roll \[mm/rad\].
    pub slope: f64,
}

/// Both sides lowered at one roll; arrays are \[left, right\].
#[derive(Debug, Clone, Copy)]
pub(super) struct Lowered {
    pub kept: KeptPlaces,
    pub attitudes: [Attitude; 2],
    /// Heights of the wheel's profile origin over the rail's \[mm\].
    pub heights: [f64; 2],
    /// The lowest place of contact of each side.
    pub meetings: [Meeting; 2],
}

impl WheelsetSearch<'_> {
    /// Lowers both sides at the roll at which both wheels touch at the places of a touch nearby; `None` where these are not the lowest.
    pub(super) fn confirmed(
        &mut self,
        position: &Position,
        near: &LowestPlaces,
        within: f64,
    ) -> Option<Lowered> {
        let kept = self.kept(position, near.roll, &near.meetings)?;
        let kept = self.follow(position, kept, &near.meetings).ok()?;
        let level = self.level(position, kept.roll, within)?;
        let same = level.meetings.map(|meeting| meeting.elements) == near.elements();
        (same && level.kept.difference().abs() <= self.rounding()).then_some(level)
    }

    /// Lowers both sides at the roll at which both wheels touch; `None` if there is no such roll.
    ///
    /// Method: Newton's, with the places of contact kept until their heights agree. Then both sides are lowered, which confirms the places
    /// or shows the next ones. Once the sign has changed, the root is bracketed.
    pub(super) fn solve_roll(&mut self, position: &Position) -> Option<Lowered> {
        let mut ends = [None, None];
        let mut level = self.level(position, 0.0, 0.0)?;
        let mut far = None;
        for count in 1..MOST_LEVELS {
            let difference = level.kept.difference();
            if difference.abs() <= self.rounding() {
                return Some(level);
            }
            ends[usize::from(difference > 0.0)] = Some(level);
            let next = match ends {
                [Some(below), Some(above)] => self.between(position, [below, above], &level, count)?,
                _ => self.outward(position, &level, &mut far, count)?,
            };
            level = match self.level(position, next, 0.0) {
                Some(level) => level,
                // A wheel is beside its rail.
                None => {
                    let mut rest = far.take().unwrap_or_else(|| Far::new(difference));
                    let level = rest.find_map(|roll| self.level(position, roll, 0.0))?;
                    far = Some(rest);
                    level
                }
            };
        }
        None
    }

    /// Returns the next roll to try before any change of sign: Newton's, or a far one once Newton's has failed.
    fn outward(
        &mut self,
        position: &Position,
        level: &Lowered,
        far: &mut Option<Far>,
        count: u32,
    ) -> Option<f64> {
        if far.is_none() {
            let next = self.followed(position, level);
            if count < NEWTON_LEVELS && next.abs() <= LARGEST_ROLL && next != level.kept.roll {
                return Some(next);
            }
        }
        far.get_or_insert_with(|| Far::new(level.kept.difference())).next()
    }

    /// Returns the next roll to try between two rolls with different signs of the height difference: the root with the places of contact
    /// kept from the end that is nearer to touching, or else from the other end, or else the middle. Every fourth roll is the middle.
    fn between(
        &mut self,
        position: &Position,
        ends: [Lowered; 2],
        last: &Lowered,
        count: u32,
    ) -> Option<f64> {
        let [a, b] = ends.map(|end| end.kept.roll);
        let middle = a + (b - a) / 2.0;
        if middle == a || middle == b {
            // No number is between: the height jumps where a wheel leaves its rail.
            return None;
        }
        let inside = |roll: &f64| (roll - a) * (roll - b) < 0.0;
        if count.is_multiple_of(HALVED) {
            return Some(middle);
        }
        let other = if last.kept.roll == a { ends[1] } else { ends[0] };
        let [off, off_last] = [&other, last].map(|level| level.kept.difference().abs());
        let nearer = if off < off_last { [&other, last] } else { [last, &other] };
        let followed = nearer.into_iter().map(|level| self.followed(position, level)).find(inside);
        Some(followed.unwrap_or(middle))
    }

    /// Returns the roll at which both wheels touch with the places of contact of a level, or the roll at
    /// which these leave their elements on the way; NaN if there is none.
    fn followed(&mut self, position: &Position, level: &Lowered) -> f64 {
        self.follow(position, level.kept, &level.meetings).map_or_else(|roll| roll, |kept| kept.roll)
    }

    /// Turns the wheelset until both wheels touch at given places of contact.
    ///
    /// # Errors
    /// The roll at which these leave their elements on the way, or which is not settled; NaN if there is none.
    pub(super) fn follow(
        &mut self,
        position: &Position,
        mut kept: KeptPlaces,
        meetings: &[Meeting; 2],
    ) -> std::result::Result<KeptPlaces, f64> {
        for _ in 0..FOLLOWED {
            let next = kept.roll - kept.difference() / kept.slope;
            if next == kept.roll {
                return Ok(kept);
            }
            if next.is_nan() || next.abs() > LARGEST_ROLL {
                return Err(next);
            }
            kept = self.kept(position, next, meetings).ok_or(next)?;
            if kept.difference().abs() <= 0.5 * self.rounding() {
                return Ok(kept);
            }
        }
        Err(kept.roll)
    }

    /// Puts both sides on given places of contact at a roll; `None` where these have left their elements.
    pub(super) fn kept(
        &mut self,
        position: &Position,
        roll: f64,
        meetings: &[Meeting; 2],
    ) -> Option<KeptPlaces> {
        let (mut z, mut slope) = ([0.0; 2], 0.0);
        for (k, meeting) in meetings.iter().enumerate() {
            let (attitude, datum) = self.system.attitude(position, roll, k);
            let candidate = self.sides[k].follow(&attitude, meeting)?;
            z[k] = datum - candidate.gap;
            slope += self.lever(position, k, z[k], &candidate);
        }
        Some(KeptPlaces { roll, z, slope })
    }

    /// Returns the rounding of a difference of heights \[mm\].
    fn rounding(&self) -> f64 {
        let size = |side: &SideOnTrack| side.wheelset.wheel_x + side.wheelset.radius;
        2.0 * f64::EPSILON * self.system.sides.iter().map(size).fold(0.0, f64::max)
    }

    /// Lowers both sides at a given roll, and leaves the candidates up to `within` above first touch in their
    /// buffers.
    pub(super) fn level(&mut self, position: &Position, roll: f64, within: f64) -> Option<Lowered> {
        let placed = [0, 1].map(|side| self.system.attitude(position, roll, side));
        let attitudes = placed.map(|(attitude, _)| attitude);
        let (mut heights, mut z, mut slope) = ([0.0; 2], [0.0; 2], 0.0);
        let mut lowest = [None; 2];
        for (k, (attitude, datum)) in placed.iter().enumerate() {
            let candidate = self.sides[k].lower(attitude, within)?;
            heights[k] = -candidate.gap;
            z[k] = datum + heights[k];
            slope += self.lever(position, k, z[k], &candidate);
            lowest[k] = Some(candidate.meeting);
        }
        let [left, right] = lowest;
        Some(Lowered { kept: KeptPlaces { roll, z, slope }, attitudes, heights, meetings: [left?, right?] })
    }

    /// Returns the part of one side in the derivative of the difference of heights with respect to the roll
    /// \[mm/rad\].
    ///
    /// Turning by dα about c moves the point of contact, at (p_x, p_z) from c, by (p_z, −p_x) dα; the wheel
    /// then has to rise by (p_x + p_z tanθ) dα. The roll in the left side's axes is the negative, so the two
    /// parts add. At ν ahead of a roller's crown the common normal is turned by ν about x.
    fn lever(&self, position: &Position, side: usize, z: f64, candidate: &Candidate) -> f64 {
        let rail = &candidate.rail;
        let track = &self.system.sides[side].track;
        let x = rail.x + track.rail_x - SIGNS[side] * position.lateral;
        let above = track.rail_z - z - self.system.reference_radius();
        match self.system.sides[side].pair.roller().filter(|_| candidate.meeting.turn != 0.0) {
            Some(roller) => {
                let (sin, cos) = candidate.meeting.turn.sin_cos();
                let height = rail.z * cos - roller * sin * sin / (1.0 + cos);
                x + (height + above) * rail.sin / (rail.cos * cos)
            }
            None => x + (rail.z + above) * rail.sin / rail.cos,
        }
    }
}

impl KeptPlaces {
    /// Returns the height of the right side less that of the left \[mm\].
    fn difference(&self) -> f64 {
        self.z[1] - self.z[0]
    }
}

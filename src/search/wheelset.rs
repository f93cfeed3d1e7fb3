//! A wheelset on its track: both sides lowered, with the roll solved, neglected or given.
//!
//! The wheelset is turned about the middle of its axle, c: a point p of it, relative to c, goes to
//! c + A p, with A of [`wheel_rotation`](super::wheel_rotation). So with the yaw ψ and the roll φ the right-hand profile origin, S out
//! along the axle and R below it, is at c + (S cosψ cosφ − R sinφ, S sinψ, −S cosψ sinφ − R cosφ).

use nalgebra::{Isometry2, Vector2};

use super::candidates::{Candidate, Meeting};
use super::far::{Far, LARGEST_ROLL};
use super::locus::Attitude;
use super::over_rail::Work;
use super::position::{Position, Roll};
use super::side::{SideOnTrack, SidePair, SideSearch};
use super::touch::{Selection, no_contact, over_hole, small_angle};
use super::wheelset_touch::{LowestPlaces, SideTouch, WheelsetTouch};
use crate::error::{Result, finite};
use crate::placement::{Pair, RailDistance, Track, WheelDistance, Wheelset};

/// A wheelset on its track: a profile pair on both sides, each in its own axes.
///
/// The axes of both sides are those of a right-hand side, so that the left side is the mirror image of what is described.
///
/// # Examples
/// ```
/// use wheelrail::{ONE_CONTACT, Pair, Position, RailDistance, Roll, Selection, WheelDistance, WheelsetOnTrack, standards};
///
/// let pair = Pair::new(standards::rail("60E1")?, standards::wheel("S1002")?, 460.0)?;
/// let system = WheelsetOnTrack::new(&pair, RailDistance::Spacing(1500.0), WheelDistance::Spacing(1500.0))?;
/// let mut search = system.search();
/// let centred = Position { lateral: 0.0, yaw: 0.0, roll: Roll::Solve };
/// let touch = search.touch(&centred, &Selection { within: 0.0, apart: ONE_CONTACT })?;
/// let [left, right] = touch.sides.map(|side| side.touch.contacts[0].rolling_radius);
/// assert!((left - right).abs() < 1e-9);
/// # Ok::<(), wheelrail::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct WheelsetOnTrack {
    /// Left and right side.
    pub(super) sides: [SideOnTrack; 2],
    /// Whether the left side is the mirror image of the right one.
    symmetric: bool,
}

impl WheelsetOnTrack {
    /// Prepares a pair of profiles on both sides of a track, the left side being the mirror image.
    ///
    /// # Errors
    /// The errors of [`SideOnTrack::new`], [`Track::new`] and [`Wheelset::new`].
    pub fn new(pair: &Pair, rails: RailDistance, wheels: WheelDistance) -> Result<Self> {
        let track = Track::new(pair.rail(), rails)?;
        SideOnTrack::new(pair, track, Wheelset::new(wheels, pair.wheel_radius())?).map(Self::symmetrical)
    }

    /// Takes the same side on both sides of the track, the left one as its mirror image.
    pub fn symmetrical(side: SideOnTrack) -> Self {
        Self { sides: [side.clone(), side], symmetric: true }
    }

    /// Joins two different sides, each in its own axes.
    pub fn of_sides(left: SideOnTrack, right: SideOnTrack) -> Self {
        Self { sides: [left, right], symmetric: false }
    }

    /// Returns whether a wheel varies around its axle.
    pub fn turning(&self) -> bool {
        self.sides.iter().any(|side| side.pair.turning())
    }

    /// Returns whether the left side is the mirror image of the right one, so that Δr is odd.
    pub fn symmetric(&self) -> bool {
        self.symmetric
    }

    /// Returns the right-hand side, which a symmetric wheelset has on both.
    pub fn right(&self) -> &SideOnTrack {
        &self.sides[1]
    }

    /// Returns the left-hand side.
    pub fn left(&self) -> &SideOnTrack {
        &self.sides[0]
    }

    /// Returns the coordinate \[mm\] along the track that [`Contact::y`](super::Contact::y) of a side counts from, when the middle of the
    /// axle is at `along`: that of the wheel profile's origin.
    pub fn along(&self, right: bool, position: &Position, along: f64) -> f64 {
        let side = usize::from(right);
        along + SIGNS[side] * position.yaw.sin() * self.sides[side].wheelset.wheel_x
    }

    /// Returns whether every rail and wheel has one profile, and no rail is a roller.
    pub(crate) fn on_plain_rails(&self) -> bool {
        self.sides.iter().all(|side| matches!(side.pair, SidePair::Swept(_)) && side.pair.roller().is_none())
    }

    /// Returns the wheelset on a track whose gauge is wider by so much \[mm\]: each rail half of it further out.
    ///
    /// # Errors
    /// Rails that would meet; a value that is not finite.
    pub fn widened(&self, by: f64) -> Result<Self> {
        let mut wider = self.clone();
        for side in &mut wider.sides {
            side.track = side.track.moved(by / 2.0, 0.0)?;
        }
        Ok(wider)
    }

    /// Returns the nominal rolling radius \[mm\] from which heights of the axle's middle count: the right-hand wheel's.
    pub(super) fn reference_radius(&self) -> f64 {
        self.sides[1].wheelset.radius
    }
}

/// Searches both sides; keeps its buffers, so that a search allocates nothing.
#[derive(Debug, Clone)]
pub struct WheelsetSearch<'a> {
    system: &'a WheelsetOnTrack,
    sides: [SideSearch<'a>; 2],
    /// Which wheels stood over a hole of a list of slices, or would have touched at its edge, at the last position.
    over_holes: [bool; 2],
}

/// Signs of x of the left and the right side, in the order of every pair of sides.
const SIGNS: [f64; 2] = [-1.0, 1.0];

/// Most times that both sides are lowered for one roll. Newton's method takes two to six; a contact beyond
/// 73° makes it leave the root, and from the far side of the flange it takes as many again. Halving alone
/// would take half of these, except where a wheel leaves its rail: there is no roll then.
const MOST_LEVELS: u32 = 64;

/// Number of Newton's levels without a change of sign before one is looked for.
const NEWTON_LEVELS: u32 = 5;

/// Newton steps with the places of contact kept: quadratic, from 1e-3 rad.
const FOLLOWED: u32 = 6;

/// Both sides on given places of contact at one roll; arrays are \[left, right\].
#[derive(Debug, Clone, Copy)]
struct KeptPlaces {
    roll: f64,
    /// Heights of the axle's middle above R over the top of rail \[mm\].
    z: [f64; 2],
    /// Derivative of the difference of `z` with respect to the roll \[mm/rad\].
    slope: f64,
}

/// Both sides lowered at one roll; arrays are \[left, right\].
#[derive(Debug, Clone, Copy)]
struct Lowered {
    kept: KeptPlaces,
    attitudes: [Attitude; 2],
    /// Heights of the wheel's profile origin over the rail's \[mm\].
    heights: [f64; 2],
    /// The lowest place of contact of each side.
    meetings: [Meeting; 2],
}

impl WheelsetOnTrack {
    /// Makes a search over this system. On rails that vary the middle of the axle is at 0 of their lists.
    pub fn search(&self) -> WheelsetSearch<'_> {
        let sides = self.sides.each_ref().map(|side| side.pair.search());
        WheelsetSearch { system: self, sides, over_holes: [false; 2] }
    }

    /// Returns where a wheel's profile is in the axes of its rail's profile, in the section through the axle: the isometry takes
    /// (x, z) of the wheel to (x, z) of the rail \[mm\]. `roll` \[rad\] is that of the wheelset, `z` \[mm\] the height of its middle
    /// above R over the top of rail, as [`SideTouch::z`] is. Yaw moves the section, but does not foreshorten it.
    pub fn section(&self, right: bool, position: &Position, roll: f64, z: f64) -> Isometry2<f64> {
        let side = usize::from(right);
        let (attitude, level) = self.attitude(position, roll, side);
        Isometry2::new(Vector2::new(attitude.offset, z - level), -SIGNS[side] * roll)
    }

    /// Returns the attitude of one side (0 left, 1 right), and the height of the axle's middle above R over the
    /// top of rail when the wheel's profile origin is level with the rail's \[mm\].
    pub(super) fn attitude(&self, position: &Position, roll: f64, side: usize) -> (Attitude, f64) {
        let SideOnTrack { track, wheelset, .. } = &self.sides[side];
        let (sign, radius, half) = (SIGNS[side], wheelset.radius, wheelset.wheel_x);
        let mut attitude = Attitude::new(0.0, sign * position.yaw, sign * roll, radius);
        let across = half * attitude.cos_yaw;
        attitude.along = half * attitude.sin_yaw;
        attitude.offset =
            sign * position.lateral - track.rail_x + across * attitude.cos_roll - radius * attitude.sin_roll;
        // c_z − R with R(1 − cos) free of cancellation.
        let half_sine = (sign * roll / 2.0).sin();
        let level = track.rail_z + across * attitude.sin_roll - 2.0 * radius * half_sine * half_sine;
        (attitude, level + (radius - self.reference_radius()))
    }
}

impl WheelsetSearch<'_> {
    /// Moves the middle of the axle to a place along the track \[mm\], in the coordinate of the lists of slices, and turns the wheelset
    /// about its axle by a pitch \[rad\], + forward at the bottom: −pitch of a wheel is lowest. Without effect on bodies of one profile.
    pub fn stand_at(&mut self, along: f64, pitch: f64) {
        self.sides.iter_mut().for_each(|side| side.stand_at(along, pitch));
    }

    /// Lowers the wheelset until it touches.
    ///
    /// The difference of the two sides' heights grows with the roll as long as contact is on treads and
    /// flanks flatter than about atan(D/R) ≈ 73°, D the distance of the contacts. Beyond that angle, turning
    /// about the axle moves a flange sideways faster than down. The result is the root that Newton's method
    /// reaches from zero roll, else the one between zero and a flange on top of its rail.
    /// Accuracy: heights and roll to rounding at the size of the wheelset, about 1e-13 mm and 1e-16 rad.
    /// Cost: the two sides are lowered two to four times on treads, up to ten times where a flange is steeper than 73°, never more than 64
    /// times.
    ///
    /// # Errors
    /// Values that are not finite; angles beyond ±0.5 rad; a rail that varies and follows the wheel's shape all over. Of the kind
    /// [`ErrorKind::NoContact`](crate::ErrorKind::NoContact): a side with no wheel over its rail; a roll to be solved where within
    /// ±0.1 rad there is none at which both wheels touch; a hole of a list of slices under a wheel.
    pub fn touch(&mut self, position: &Position, selection: &Selection) -> Result<WheelsetTouch<'_>> {
        let expected = "wheels over their rails, and a roll within ±0.1 rad at which both sides touch";
        match self.lowered(position, selection, None)? {
            Some(level) => Ok(self.collected(&level, selection)),
            None => Err(match self.over_holes {
                [false, false] => no_contact("wheelset: lateral", expected, "check lateral, gauge and signs"),
                [true, true] => over_hole("wheelset: along", "both wheels"),
                [true, false] => over_hole("wheelset: along", "the left wheel"),
                [false, true] => over_hole("wheelset: along", "the right wheel"),
            }),
        }
    }

    /// Lowers the wheelset as [`WheelsetSearch::touch`] does, from the places of a touch nearby; `None` where there is no contact. Where
    /// these places are still the lowest, they save the search for a roll; elsewhere they are not used. Where contacts are steeper than
    /// 73°, several rolls may have contact on both sides, and the nearby one is found.
    ///
    /// # Errors
    /// Those of [`WheelsetSearch::touch`], other than that there is no contact.
    pub(crate) fn touch_near(
        &mut self,
        position: &Position,
        selection: &Selection,
        near: Option<&LowestPlaces>,
    ) -> Result<Option<WheelsetTouch<'_>>> {
        let level = self.lowered(position, selection, near)?;
        Ok(level.map(|level| self.collected(&level, selection)))
    }

    /// Tells which wheels stood over a hole of a list of slices, or would have touched at its edge, at the last position: left, right. There
    /// is no contact then.
    pub fn over_holes(&self) -> [bool; 2] {
        self.over_holes
    }

    /// Lowers both sides, and leaves the candidates in their buffers; `None` where there is no contact, or no surface under a wheel.
    fn lowered(
        &mut self,
        position: &Position,
        selection: &Selection,
        near: Option<&LowestPlaces>,
    ) -> Result<Option<Lowered>> {
        finite("wheelset: lateral", position.lateral)?;
        small_angle("wheelset: yaw", position.yaw)?;
        let system = self.system;
        let placed = [0, 1].map(|k| system.attitude(position, 0.0, k).0);
        self.over_holes = [0, 1].map(|k| self.sides[k].over_hole(&placed[k], None));
        if self.over_holes.contains(&true) {
            return Ok(None);
        }
        let reach = selection.within;
        let level = match position.roll {
            Roll::Neglect => self.level(position, 0.0, reach),
            Roll::Fixed(roll) => self.level(position, small_angle("wheelset: roll", roll)?, reach),
            Roll::Solve => match near.and_then(|near| self.confirmed(position, near, reach)) {
                None => match self.solve_roll(position) {
                    // Near misses are looked for once, at the end.
                    Some(level) if reach > 0.0 => self.level(position, level.kept.roll, reach),
                    level => level,
                },
                level => level,
            },
        };
        let [left, right] = &mut self.sides;
        left.answered().and(right.answered())?;
        let Some(level) = level else { return Ok(None) };
        self.over_holes =
            [0, 1].map(|k| self.sides[k].over_hole(&level.attitudes[k], Some(&level.meetings[k])));
        Ok((!self.over_holes.contains(&true)).then_some(level))
    }

    /// Collects the contacts of `selection` among the candidates of both sides.
    fn collected(&mut self, level: &Lowered, selection: &Selection) -> WheelsetTouch<'_> {
        let Lowered { kept: KeptPlaces { roll, z, slope }, heights, attitudes, meetings } = *level;
        let steadiness = slope / self.system.sides.iter().map(|side| side.track.rail_x).sum::<f64>();
        let [left, right] = &mut self.sides;
        let sides = [
            SideTouch { z: z[0], touch: left.collect(&attitudes[0], heights[0], selection) },
            SideTouch { z: z[1], touch: right.collect(&attitudes[1], heights[1], selection) },
        ];
        WheelsetTouch { roll, sides, places: LowestPlaces { roll, meetings, steadiness } }
    }

    /// Returns the heights of the axle's middle \[mm\], of the left and the right side, at which the wheels touch at the places of a
    /// touch nearby, whether or not others are lower; `None` where these have left their elements.
    pub(crate) fn heights(&mut self, position: &Position, near: &LowestPlaces) -> Option<[f64; 2]> {
        let roll = match position.roll {
            Roll::Solve => near.roll,
            Roll::Neglect => 0.0,
            Roll::Fixed(roll) => roll,
        };
        let kept = self.kept(position, roll, &near.meetings)?;
        match position.roll {
            Roll::Solve => self.follow(position, kept, &near.meetings).ok().map(|kept| kept.z),
            Roll::Neglect | Roll::Fixed(_) => Some(kept.z),
        }
    }

    /// Lowers both sides at the roll at which both wheels touch at the places of a touch nearby; `None` where these are not the lowest.
    fn confirmed(&mut self, position: &Position, near: &LowestPlaces, within: f64) -> Option<Lowered> {
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
    fn solve_roll(&mut self, position: &Position) -> Option<Lowered> {
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
    fn follow(
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
    fn kept(&mut self, position: &Position, roll: f64, meetings: &[Meeting; 2]) -> Option<KeptPlaces> {
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
    fn level(&mut self, position: &Position, roll: f64, within: f64) -> Option<Lowered> {
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

    /// Returns what the searches of both sides have done so far.
    pub fn work(&self) -> [Work; 2] {
        [self.sides[0].work(), self.sides[1].work()]
    }
}

impl KeptPlaces {
    /// Returns the height of the right side less that of the left \[mm\].
    fn difference(&self) -> f64 {
        self.z[1] - self.z[0]
    }
}

/// Of so many rolls tried one is the middle between the ends.
const HALVED: u32 = 4;

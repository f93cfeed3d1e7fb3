//! A wheelset on its track: both sides lowered, with the roll solved, neglected or given.
//!
//! The wheelset is turned about the middle of its axle, c: a point p of it, relative to c, goes to
//! c + R_y(roll) R_z(yaw) p. So the right-hand profile origin, S out along the axle and R below it, is at
//! c + (S cosψ cosφ − R sinφ, S sinψ, −S cosψ sinφ − R cosφ).

use super::locus::Attitude;
use super::{ContactSearch, ProfilePair, Selection, Touch, small_angle};
use crate::error::{Result, finite};
use crate::numerics::roots::bracketed;
use crate::placement::Pair;
use crate::placement::track::{RailDistance, Track, WheelDistance, Wheelset};

/// How the roll of a wheelset is found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Roll {
    /// Both wheels touch.
    Solve,
    /// None (the convention of EN 15302): each side is lowered on its own.
    Neglect,
    /// Given \[rad\], + lowers the right-hand wheel: each side is lowered on its own.
    Fixed(f64),
}

/// Where a wheelset stands over its track.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Position {
    /// Lateral displacement of the axle's middle \[mm\], + to the right.
    pub lateral: f64,
    /// Yaw ψ \[rad\], + moves the right-hand wheel forward.
    pub yaw: f64,
    /// Roll.
    pub roll: Roll,
}

/// A profile pair on both sides of a track, the left side mirrored.
#[derive(Debug, Clone)]
pub struct WheelsetOnTrack {
    /// The profiles, in the right side's axes.
    pub pair: ProfilePair,
    /// Where the rails are.
    pub track: Track,
    /// Where the wheels are.
    pub wheelset: Wheelset,
}

impl WheelsetOnTrack {
    /// A pair on both sides of a track.
    ///
    /// # Errors
    /// As [`ProfilePair::new`], [`Track::new`] and [`Wheelset::new`].
    pub fn new(pair: &Pair, rails: RailDistance, wheels: WheelDistance) -> Result<Self> {
        Ok(Self {
            pair: ProfilePair::new(&pair.rail, &pair.wheel, pair.wheel_radius)?,
            track: Track::new(&pair.rail, rails)?,
            wheelset: Wheelset::new(wheels, pair.wheel_radius)?,
        })
    }
}

/// Searches both sides; keeps its buffers, so that searching allocates nothing.
#[derive(Debug, Clone)]
pub struct WheelsetSearch<'a> {
    system: &'a WheelsetOnTrack,
    sides: [ContactSearch<'a>; 2],
}

/// First touch of both wheels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WheelsetTouch<'a> {
    /// The roll \[rad\], solved or given.
    pub roll: f64,
    /// Left and right side.
    pub sides: [SideTouch<'a>; 2],
}

/// First touch of one side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SideTouch<'a> {
    /// Height \[mm\] of the axle's middle above R over the top of rail when this side touches, + up: −0.18 for a
    /// centred S1002 on 60E1 at 1:40. The same on both sides when the roll is solved.
    pub z: f64,
    /// The side's contacts in its own axes.
    pub touch: Touch<'a>,
}

/// Left and right, in the order of every pair of sides.
const SIGNS: [f64; 2] = [-1.0, 1.0];

/// Largest roll that is looked for \[rad\]: a wheelset tilted by this has one flange on top of the rail.
const LARGEST_ROLL: f64 = 0.1;

/// Newton's method converges quadratically and changes contact a few times at most; after this many steps the bracket
/// that it keeps is halved instead.
const NEWTON_STEPS: u32 = 12;

/// First step \[rad\] of the search outwards, and the factor of every further one. Two roots closer together than a step
/// would be missed; they exist only where contact passes through the steepest part of a flange.
const FIRST_STEP: f64 = 1e-4;
/// See [`FIRST_STEP`].
const STEP_GROWTH: f64 = 1.25;

/// Both sides lowered at one roll, left and right.
#[derive(Debug, Clone, Copy)]
struct Level {
    roll: f64,
    attitudes: [Attitude; 2],
    /// Of the wheel's profile origin over the rail's.
    heights: [f64; 2],
    /// Of the axle's middle above R over the top of rail.
    z: [f64; 2],
    /// Derivative of the difference of `z` with the roll.
    slope: f64,
}

impl WheelsetOnTrack {
    /// A search over this system.
    pub fn search(&self) -> WheelsetSearch<'_> {
        WheelsetSearch { system: self, sides: [self.pair.search(), self.pair.search()] }
    }

    /// The attitude of one side (sign −1 left, +1 right) and the height of the axle's middle above R over the top of
    /// rail when the wheel's profile origin is level with the rail's.
    fn attitude(&self, position: &Position, roll: f64, sign: f64) -> (Attitude, f64) {
        let (radius, half) = (self.wheelset.radius, self.wheelset.wheel_x);
        let mut attitude = Attitude::new(0.0, sign * position.yaw, sign * roll, radius);
        let along = half * attitude.cos_yaw;
        attitude.offset = sign * position.lateral - self.track.rail_x + along * attitude.cos_roll
            - radius * attitude.sin_roll;
        // c_z − R with R(1 − cos) free of cancellation.
        let half_sine = (sign * roll / 2.0).sin();
        let level = self.track.rail_z + along * attitude.sin_roll - 2.0 * radius * half_sine * half_sine;
        (attitude, level)
    }
}

impl WheelsetSearch<'_> {
    /// Lowers the wheelset until it touches; `None` when a side has no wheel over its rail or, with the roll to be
    /// solved, when within ±0.1 rad there is no roll at which both wheels touch.
    ///
    /// The difference of the two sides' heights grows with the roll as long as contact is on treads and flanks
    /// flatter than about atan(D/R) ≈ 73°, D the distance of the contacts; beyond, turning about the axle moves a flange
    /// sideways faster than down. The root reached from zero roll by Newton's method is taken, else the one nearest to
    /// zero that a search outwards brackets.
    /// Accuracy: heights and roll to rounding at the size of the wheelset, about 1e-13 mm and 1e-16 rad.
    ///
    /// # Errors
    /// Values that are not finite; angles beyond ±0.5 rad.
    pub fn touch(&mut self, position: &Position, selection: &Selection) -> Result<Option<WheelsetTouch<'_>>> {
        finite("wheelset: lateral", position.lateral)?;
        small_angle("wheelset: yaw", position.yaw)?;
        let reach = selection.within;
        let level = match position.roll {
            Roll::Neglect => self.level(position, 0.0, reach),
            Roll::Fixed(roll) => self.level(position, small_angle("wheelset: roll", roll)?, reach),
            Roll::Solve => self.solve_roll(position, reach),
        };
        let Some(Level { roll, z, heights, attitudes, .. }) = level else { return Ok(None) };
        let [left, right] = &mut self.sides;
        let sides = [
            SideTouch { z: z[0], touch: left.collect(&attitudes[0], heights[0], selection) },
            SideTouch { z: z[1], touch: right.collect(&attitudes[1], heights[1], selection) },
        ];
        Ok(Some(WheelsetTouch { roll, sides }))
    }

    /// Both sides lowered at the roll at which both wheels touch.
    fn solve_roll(&mut self, position: &Position, within: f64) -> Option<Level> {
        let rounding = 2.0 * f64::EPSILON * (self.system.wheelset.wheel_x + self.system.wheelset.radius);
        let (mut below, mut above) = (None, None);
        let mut level = self.level(position, 0.0, within)?;
        let mut last = None;
        for _ in 0..NEWTON_STEPS {
            let next = level.next(last.as_ref());
            if level.difference().abs() <= rounding || next == level.roll {
                return Some(level);
            }
            let bound = if level.difference() < 0.0 { &mut below } else { &mut above };
            *bound = Some(level.roll);
            let inside = match (below, above) {
                (Some(a), Some(b)) => (next - a) * (next - b) < 0.0,
                _ => next.abs() <= LARGEST_ROLL,
            };
            if !inside {
                break;
            }
            last = Some(level);
            level = self.level(position, next, within)?;
        }
        let (a, b) = below.zip(above).or_else(|| self.nearest_change(position))?;
        let apart = |roll: f64| self.level(position, roll, 0.0).map_or(f64::NAN, |level| level.difference());
        let roll = bracketed(apart, a, b)?;
        self.level(position, roll, within)
    }

    /// A bracket of the roll, looked for outwards from zero in growing steps.
    fn nearest_change(&mut self, position: &Position) -> Option<(f64, f64)> {
        let mut sign = |roll: f64| self.level(position, roll, 0.0).map(|level| level.difference() > 0.0);
        let start = sign(0.0)?;
        let (mut inner, mut outer) = (0.0, FIRST_STEP);
        while inner < LARGEST_ROLL {
            for direction in SIGNS {
                if sign(direction * outer).is_some_and(|s| s != start) {
                    return Some((direction * inner, direction * outer));
                }
            }
            (inner, outer) = (outer, outer * STEP_GROWTH);
        }
        None
    }

    /// Lowers both sides at a given roll, leaving candidates up to `within` above first touch in their buffers.
    fn level(&mut self, position: &Position, roll: f64, within: f64) -> Option<Level> {
        let attitudes = SIGNS.map(|sign| self.system.attitude(position, roll, sign));
        let mut level =
            Level { roll, attitudes: attitudes.map(|a| a.0), heights: [0.0; 2], z: [0.0; 2], slope: 0.0 };
        for (k, (attitude, datum)) in attitudes.into_iter().enumerate() {
            level.heights[k] = self.sides[k].lower(&attitude, within)?;
            level.z[k] = datum + level.heights[k];
            // Turning by dα about c moves the point of contact, at (p_x, p_z) from c, by (p_z, −p_x) dα; the wheel then
            // has to rise by (p_x + p_z tanθ) dα. The left side's own roll is the negative: the slopes add.
            let rail = self.sides[k].lowest()?.rail;
            let x = rail.x + self.system.track.rail_x - SIGNS[k] * position.lateral;
            let down = rail.z + self.system.track.rail_z - level.z[k] - self.system.wheelset.radius;
            level.slope += x + down * rail.sin / rail.cos;
        }
        Some(level)
    }
}

impl Level {
    /// Right height less left height \[mm\].
    fn difference(&self) -> f64 {
        self.z[1] - self.z[0]
    }

    /// The next roll to try: Newton's, or where there was a step before the zero of the inverse cubic with both values
    /// and slopes, as long as it only refines Newton's; across a change of contact it would not.
    fn next(&self, last: Option<&Self>) -> f64 {
        let step = -self.difference() / self.slope;
        let Some(last) = last else { return self.roll + step };
        let span = self.difference() - last.difference();
        let t = -last.difference() / span;
        let back = (1.0 - t) * (1.0 - t);
        let refined = back * (1.0 + 2.0 * t) * (last.roll - self.roll)
            + span * (t * back / last.slope + t * t * (t - 1.0) / self.slope);
        self.roll + if (refined - step).abs() <= REFINEMENT * step.abs() { refined } else { step }
    }
}

/// Share of Newton's step by which the cubic may differ from it; it does so by its own small error only where the
/// contact stays on the same pair of segments.
const REFINEMENT: f64 = 0.1;

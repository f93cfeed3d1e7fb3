//! `[contact]`, `[track]` and `[wheelset]`: where the bodies stand.

use super::data::{ContactData, RollData, RollWord, Scene, TrackData, WheelsetData};
use crate::error::{Error, Result, finite, given};
use crate::placement::track::{RailDistance, WheelDistance};
use crate::search::Pose;
use crate::search::wheelset::{Position, Roll};

/// Depth below the top of rail at which gauge is measured unless the scene says otherwise \[mm\].
const GAUGE_HEIGHT: f64 = 14.0;

/// Where the bodies of a scene stand, and how far near misses are looked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Standing {
    /// What is placed, and where.
    pub place: Place,
    /// Largest vertical gap \[mm\] of a near miss that is to be reported.
    pub within: f64,
}

/// The three ways to place bodies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Place {
    /// In contact at chosen abscissae \[mm\] of rail and wheel, the Report's way.
    Points {
        /// On the rail profile.
        rail_x: f64,
        /// On the wheel profile.
        wheel_x: f64,
    },
    /// A single wheel, lowered until it touches.
    Wheel(Pose),
    /// A wheelset on a track.
    Wheelset {
        /// Between the rails.
        rails: RailDistance,
        /// Between the wheels.
        wheels: WheelDistance,
        /// Displacement, yaw and roll.
        position: Position,
    },
}

impl Scene {
    /// Where the bodies stand.
    ///
    /// # Errors
    /// None or several of the ways to say so; missing or contradictory keys.
    pub fn standing(&self) -> Result<Standing> {
        match (&self.contact, &self.track, &self.wheelset) {
            (Some(contact), None, None) => single(contact).map_err(|e| e.within("contact")),
            (None, Some(track), Some(wheelset)) => {
                let position = Position {
                    lateral: finite("wheelset: lateral", wheelset.lateral)?,
                    yaw: finite("wheelset: yaw", wheelset.yaw)?,
                    roll: roll(wheelset.roll)?,
                };
                let place = Place::Wheelset { rails: rails(track)?, wheels: wheels(wheelset)?, position };
                Ok(Standing { place, within: within(wheelset.within)? })
            }
            (None, None, None) => {
                let expected = "[contact], or [track] and [wheelset]";
                Err(Error::new("", "no placement", expected, "say where the bodies stand"))
            }
            _ => {
                let expected = "either [contact], or both [track] and [wheelset]";
                let found = given(&[
                    ("contact", self.contact.is_some()),
                    ("track", self.track.is_some()),
                    ("wheelset", self.wheelset.is_some()),
                ]);
                Err(Error::new("", found, expected, "keep one placement, with all it needs"))
            }
        }
    }
}

impl Scene {
    /// The same scene with its wheelset at another position; without a wheelset, the scene itself.
    pub fn at(&self, position: &Position) -> Self {
        let roll = match position.roll {
            Roll::Solve => RollData::Word(RollWord::Solve),
            Roll::Neglect => RollData::Word(RollWord::Neglect),
            Roll::Fixed(angle) => RollData::Radians(angle),
        };
        let (lateral, yaw) = (position.lateral, position.yaw);
        let moved = |wheelset: &WheelsetData| WheelsetData { lateral, yaw, roll, ..wheelset.clone() };
        Self { wheelset: self.wheelset.as_ref().map(moved), ..self.clone() }
    }
}

fn single(contact: &ContactData) -> Result<Standing> {
    let within = within(contact.within)?;
    let place = match (contact.rail_x, contact.wheel_x, contact.offset) {
        (Some(rail_x), Some(wheel_x), None) if contact.roll.is_none() && contact.yaw.is_none() => {
            Place::Points { rail_x: finite("rail_x", rail_x)?, wheel_x: finite("wheel_x", wheel_x)? }
        }
        (None, None, Some(offset)) => {
            Place::Wheel(Pose::new(offset, contact.yaw.unwrap_or(0.0), contact.roll.unwrap_or(0.0))?)
        }
        _ => {
            let expected = "either `rail_x` and `wheel_x`, or `offset` with perhaps `roll` and `yaw`";
            let found = given(&[
                ("rail_x", contact.rail_x.is_some()),
                ("wheel_x", contact.wheel_x.is_some()),
                ("offset", contact.offset.is_some()),
                ("roll", contact.roll.is_some()),
                ("yaw", contact.yaw.is_some()),
            ]);
            return Err(Error::new("", found, expected, "keep one of the two forms"));
        }
    };
    Ok(Standing { place, within })
}

fn within(within: Option<f64>) -> Result<f64> {
    match within {
        Some(gap) if finite("within", gap)? < 0.0 => {
            Err(Error::new("within", gap.to_string(), "a gap of 0 mm or more", "correct the sign"))
        }
        gap => Ok(gap.unwrap_or(0.0)),
    }
}

fn rails(track: &TrackData) -> Result<RailDistance> {
    match (track.gauge, track.spacing) {
        (Some(gauge), None) => {
            Ok(RailDistance::Gauge { gauge, height: track.gauge_height.unwrap_or(GAUGE_HEIGHT) })
        }
        (None, Some(spacing)) if track.gauge_height.is_none() => Ok(RailDistance::Spacing(spacing)),
        _ => {
            let expected = "either `gauge` with perhaps `gauge_height`, or `spacing`";
            let found = given(&[
                ("gauge", track.gauge.is_some()),
                ("gauge_height", track.gauge_height.is_some()),
                ("spacing", track.spacing.is_some()),
            ]);
            Err(Error::new("track", found, expected, "keep one of the two forms"))
        }
    }
}

fn wheels(wheelset: &WheelsetData) -> Result<WheelDistance> {
    match (wheelset.back_to_back, wheelset.flange_back_x, wheelset.spacing) {
        (Some(distance), Some(flange_back_x), None) => {
            Ok(WheelDistance::BackToBack { distance, flange_back_x })
        }
        (None, None, Some(spacing)) => Ok(WheelDistance::Spacing(spacing)),
        _ => {
            let expected = "either `back_to_back` and `flange_back_x`, or `spacing`";
            let found = given(&[
                ("back_to_back", wheelset.back_to_back.is_some()),
                ("flange_back_x", wheelset.flange_back_x.is_some()),
                ("spacing", wheelset.spacing.is_some()),
            ]);
            Err(Error::new("wheelset", found, expected, "keep one of the two forms"))
        }
    }
}

fn roll(roll: RollData) -> Result<Roll> {
    Ok(match roll {
        RollData::Word(RollWord::Solve) => Roll::Solve,
        RollData::Word(RollWord::Neglect) => Roll::Neglect,
        RollData::Radians(angle) => Roll::Fixed(finite("wheelset: roll", angle)?),
    })
}

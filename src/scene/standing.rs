//! Reads where the bodies stand: `[contact]`, `[track]` and `[wheelset]`.

use std::sync::Arc;

use super::data::{ContactData, RollData, RollWord, Scene, TrackData, WheelsetData};
use crate::case::{Place, Standing};
use crate::error::{Error, Result, finite, given};
use crate::placement::{Pair, RailDistance, WheelDistance};
use crate::search::{Pose, Position, ProfilePair, Roll, WheelsetOnTrack};

/// Depth \[mm\] below the top of rail at which the gauge is measured, if the scene gives no other.
const GAUGE_HEIGHT: f64 = 14.0;

/// Finds where the bodies stand, and prepares the search over them.
///
/// # Errors
/// No table or several tables that say where the bodies stand; missing or contradictory keys; profiles that cannot be
/// searched.
pub(super) fn standing(scene: &Scene, pair: &Pair) -> Result<Standing> {
    match (&scene.contact, &scene.track, &scene.wheelset) {
        (Some(contact), None, None) => single(contact, pair),
        (None, Some(track), Some(wheelset)) => on_track(track, wheelset, pair),
        (None, None, None) => {
            let expected = "[contact], or [track] and [wheelset]";
            Err(Error::new("", "no placement", expected, "say where the bodies stand"))
        }
        _ => {
            let expected = "either [contact], or both [track] and [wheelset]";
            let found = given(&[
                ("contact", scene.contact.is_some()),
                ("track", scene.track.is_some()),
                ("wheelset", scene.wheelset.is_some()),
            ]);
            Err(Error::new("", found, expected, "keep one placement, with all it needs"))
        }
    }
}

fn on_track(track: &TrackData, wheelset: &WheelsetData, pair: &Pair) -> Result<Standing> {
    let position = Position {
        lateral: finite("wheelset: lateral", wheelset.lateral)?,
        yaw: finite("wheelset: yaw", wheelset.yaw)?,
        roll: roll(wheelset.roll)?,
    };
    let (rails, wheels, within) = (rails(track)?, wheels(wheelset)?, within(wheelset.within)?);
    let system = Arc::new(WheelsetOnTrack::new(pair, rails, wheels)?);
    Ok(Standing { place: Place::Wheelset { system, position }, within })
}

fn single(contact: &ContactData, pair: &Pair) -> Result<Standing> {
    let in_table = |error: Error| error.within("contact");
    let within = within(contact.within).map_err(in_table)?;
    let place = match (contact.rail_x, contact.wheel_x, contact.offset) {
        (Some(rail_x), Some(wheel_x), None) if contact.roll.is_none() && contact.yaw.is_none() => {
            Place::Points {
                rail_x: finite("rail_x", rail_x).map_err(in_table)?,
                wheel_x: finite("wheel_x", wheel_x).map_err(in_table)?,
            }
        }
        (None, None, Some(offset)) => {
            let pose = Pose::new(offset, contact.yaw.unwrap_or(0.0), contact.roll.unwrap_or(0.0));
            Place::Wheel { pose: pose.map_err(in_table)?, profiles: Arc::new(ProfilePair::new(pair)?) }
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
            return Err(Error::new("contact", found, expected, "keep one of the two forms"));
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

//! Reads where the bodies stand: `[contact]`, `[track]` and `[wheelset]`.

use std::sync::Arc;

use nalgebra::UnitComplex;

use super::data::{ContactData, RollData, RollWord, Scene, TrackData, WheelsetData};
use super::side_data::{DeviationData, SideData};
use crate::case::{Arrangement, Profiles, RollByLoad, Setup, SideProfiles};
use crate::error::{Error, Result, finite, given};
use crate::lofted::LoftedBody;
use crate::measured::Unit;
use crate::placement::{RailDistance, Track, WheelDistance, Wheelset};
use crate::profile::Side;
use crate::search::{
    LoftedPair, Pose, Position, ProfilePair, Roll, SideOnTrack, WheelsetOnTrack, small_angle,
};

/// Depth \[mm\] below the top of rail at which the gauge is measured, if the scene gives no other.
const GAUGE_HEIGHT: f64 = 14.0;

/// Finds where the bodies stand, and prepares the search over them; turns the profile of a rail that deviates.
///
/// # Errors
/// None or several of the ways to say so; missing or contradictory keys; profiles that cannot be searched.
pub(super) fn setup(scene: &Scene, mut profiles: Profiles) -> Result<(Setup, Profiles)> {
    let setup = match (&scene.contact, &scene.track, &scene.wheelset) {
        (Some(contact), None, None) => {
            for (side, data) in [("left", &scene.left), ("right", &scene.right)] {
                if data.is_some() {
                    let expected = "sides only of a wheelset: with [track] and [wheelset]";
                    return Err(Error::new(side, "a side beside [contact]", expected, "remove it"));
                }
            }
            single(contact, &profiles.right, [scene.along()?, turned(scene)?])
        }
        (None, Some(track), Some(wheelset)) => on_track(scene, track, wheelset, &mut profiles),
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
    };
    Ok((setup?, profiles))
}

fn on_track(
    scene: &Scene,
    track: &TrackData,
    wheelset: &WheelsetData,
    profiles: &mut Profiles,
) -> Result<Setup> {
    let position = position(wheelset)?;
    let (rails, wheels, within) = (rails(track)?, wheels(wheelset)?, within(wheelset.within)?);
    let deviation = |side: &Option<SideData>| side.as_ref().and_then(|side| side.deviation);
    let deviations = [&scene.left, &scene.right].map(deviation);
    let along = scene.along()?;
    let varying: Vec<Side> = profiles.varying().collect();
    without_effect(["wheelset: along", ALONG], along, varying.contains(&Side::Rail))?;
    let pitch = turned(scene)?;
    without_effect(["wheelset: pitch", PITCH], pitch, varying.contains(&Side::Wheel))?;
    let system = if profiles.left.is_none() && deviations == [None, None] {
        WheelsetOnTrack::symmetrical(side(
            &mut profiles.right,
            (rails, wheels),
            DeviationData::default(),
            1.0,
        )?)
    } else {
        let left = profiles.left.get_or_insert_with(|| profiles.right.clone());
        let own = |own: &mut SideProfiles, deviation: Option<DeviationData>, name: &str, sign: f64| {
            let side = side(own, (rails, wheels), deviation.unwrap_or_default(), sign);
            side.map_err(|error| error.within(name))
        };
        let [off_left, off_right] = deviations;
        let left = own(left, off_left, "left", -1.0)?;
        WheelsetOnTrack::of_sides(left, own(&mut profiles.right, off_right, "right", 1.0)?)
    };
    let roll_by_load = match wheelset.roll {
        Some(RollData::Word(RollWord::Load)) => RollByLoad::Asked,
        None if wheelset.load.is_some() => RollByLoad::Unasked,
        _ => RollByLoad::No,
    };
    let of_side = |side: &Option<SideData>| side.as_ref().is_some_and(|side| side.load.is_some());
    let loaded = wheelset.load.is_some()
        || scene.patch.as_ref().is_some_and(|patch| patch.load.is_some())
        || of_side(&scene.left);
    if roll_by_load == RollByLoad::Asked && !loaded {
        let expected = "\"load\" with a load in [wheelset], [patch], or [left] and [right]";
        return Err(Error::new(
            "wheelset: roll",
            "\"load\" without a load",
            expected,
            "give one, or another roll",
        ));
    }
    Ok(Setup {
        arrangement: Arrangement::Wheelset { system: Arc::new(system), position },
        within,
        roll_by_load,
        along: along.unwrap_or(0.0),
        pitch: pitch.unwrap_or(0.0),
    })
}

/// Reads the position of a wheelset.
pub(super) fn position(wheelset: &WheelsetData) -> Result<Position> {
    Ok(Position {
        lateral: finite("wheelset: lateral", wheelset.lateral)?,
        yaw: finite("wheelset: yaw", wheelset.yaw)?,
        roll: roll(wheelset.roll.unwrap_or_default())?,
    })
}

/// Places one side, whose x is the track's times `sign`: the rail at its nominal place, then moved and turned by its deviation.
fn side(
    profiles: &mut SideProfiles,
    (rails, wheels): (RailDistance, WheelDistance),
    deviation: DeviationData,
    sign: f64,
) -> Result<SideOnTrack> {
    let within = |error: Error| error.within("deviation");
    let SideProfiles { pair, varying, .. } = &mut *profiles;
    let axle = Wheelset::new(wheels, pair.wheel_radius())?;
    let nominal = match (&varying, rails) {
        (None | Some(LoftedBody::Wheel(_)), _) => Track::new(pair.rail(), rails)?,
        (Some(LoftedBody::Rail(_)), RailDistance::Spacing(spacing)) => Track::between_origins(spacing)?,
        (Some(LoftedBody::Rail(_)), RailDistance::Gauge { .. }) => {
            let expected = "`spacing` of the profile origins: rails that vary have no one gauge point";
            return Err(Error::new("track", "a gauge", expected, "give spacing instead of gauge"));
        }
    };
    let track = nominal.moved(sign * deviation.lateral, deviation.vertical).map_err(within)?;
    let roll = small_angle("roll", deviation.roll).map_err(within)?;
    if let Some(LoftedBody::Rail(_)) = varying.as_ref().filter(|_| roll != 0.0) {
        let expected = "lateral and vertical deviations of rails that vary along the track";
        return Err(Error::new("deviation: roll", "a roll", expected, "turn the slices by `rotate`"));
    }
    if roll != 0.0 {
        // Profiles turn counter-clockwise, and the right-hand side's roll is clockwise.
        let rail = pair.rail().clone().rotated(UnitComplex::new(-sign * roll));
        *pair = pair.with_rail(rail)?;
    }
    profiles.on_track(track, axle)
}

fn single(contact: &ContactData, profiles: &SideProfiles, [along, pitch]: [Option<f64>; 2]) -> Result<Setup> {
    let in_table = |error: Error| error.within("contact");
    let SideProfiles { pair, varying, .. } = profiles;
    let side = varying.as_ref().map(LoftedBody::side);
    without_effect(["contact: along", ALONG], along, side == Some(Side::Rail))?;
    without_effect(["contact: pitch", PITCH], pitch, side == Some(Side::Wheel))?;
    let within = within(contact.within).map_err(in_table)?;
    let arrangement = match (contact.rail_x, contact.wheel_x, contact.offset) {
        (Some(_), ..) if side.is_some() => {
            let body = side.map_or("", LoftedBody::name);
            let expected = format!("`offset` with perhaps `roll` and `yaw`, with {body}");
            return Err(Error::new(
                "contact: rail_x",
                "a chosen point",
                expected,
                "let the wheel be lowered",
            ));
        }
        (Some(rail_x), Some(wheel_x), None) if contact.roll.is_none() && contact.yaw.is_none() => {
            Arrangement::Points {
                rail_x: finite("rail_x", rail_x).map_err(in_table)?,
                wheel_x: finite("wheel_x", wheel_x).map_err(in_table)?,
            }
        }
        (None, None, Some(offset)) => {
            let pose = Pose::new(offset, contact.yaw.unwrap_or(0.0), contact.roll.unwrap_or(0.0));
            let pose = pose.map_err(in_table)?;
            match varying {
                Some(body) => {
                    Arrangement::OnSlices { pose, pair: Arc::new(LoftedPair::of_pair(pair, body)?) }
                }
                None => Arrangement::Wheel { pose, profiles: Arc::new(ProfilePair::new(pair)?) },
            }
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
    Ok(Setup {
        arrangement,
        within,
        roll_by_load: RollByLoad::No,
        along: along.unwrap_or(0.0),
        pitch: pitch.unwrap_or(0.0),
    })
}

/// Gives the pitch of wheels that vary \[rad\]; `None` of 0, which every scene may have.
fn turned(scene: &Scene) -> Result<Option<f64>> {
    Ok(Some(scene.pitch()?).filter(|pitch| *pitch != 0.0))
}

/// What a place along the track and a pitch belong to.
const ALONG: &str = "a place along a rail that varies: a list .slcs of slices without its own `along`";
const PITCH: &str =
    "a pitch of a wheel that varies: with `flat`, `radii`, or a list .slcw of slices without `angle`";

/// Refuses a place along rails of one profile each, and a pitch of such wheels.
fn without_effect([key, expected]: [&str; 2], given: Option<f64>, varies: bool) -> Result<()> {
    match given.filter(|_| !varies) {
        Some(value) => Err(Error::new(key, format!("{value} without effect"), expected, "remove it")),
        None => Ok(()),
    }
}

/// Returns the largest gap of a near miss \[mm\], 0 if none is given.
///
/// # Errors
/// A gap that is negative or not finite.
pub fn within(within: Option<f64>) -> Result<f64> {
    match within {
        Some(gap) if finite("within", gap)? < 0.0 => {
            Err(Error::new("within", gap.to_string(), "a gap of 0 mm or more", "correct the sign"))
        }
        gap => Ok(gap.unwrap_or(0.0)),
    }
}

/// Least distance of rails or wheels \[mm\]: below the gauge of miniature railways for passengers, 184 mm.
const LEAST_DISTANCE: f64 = 150.0;

/// Gauges of railways \[mm\], for guesses at a unit.
const GAUGES: std::ops::RangeInclusive<f64> = 300.0..=2500.0;

/// Returns a distance of rails or wheels \[mm\] as it is; one that is not positive is refused where it is used.
///
/// # Errors
/// A distance in another unit, with the unit that it seems to be in.
pub fn distance(key: &str, value: f64) -> Result<f64> {
    if !(value > 0.0 && value < LEAST_DISTANCE) {
        return Ok(value);
    }
    let units = [Unit::Metre, Unit::Inch, Unit::Centimetre, Unit::Foot];
    let meant = units.into_iter().find(|unit| GAUGES.contains(&(unit.millimetres() * value)));
    // Whole micrometres, so that no rounding shows.
    let millimetres = |unit: Unit| (unit.millimetres() * value * 1e3).round() / 1e3;
    let advice = meant.map_or_else(
        || "give it in mm".to_owned(),
        |unit| format!("give it in mm: {value} {} are {} mm", unit.name(), millimetres(unit)),
    );
    Err(Error::new(key, value.to_string(), "a distance in mm", advice))
}

pub(super) fn rails(track: &TrackData) -> Result<RailDistance> {
    match (track.gauge, track.spacing) {
        (Some(gauge), None) => {
            let gauge = distance("track: gauge", gauge)?;
            Ok(RailDistance::Gauge { gauge, height: track.gauge_height.unwrap_or(GAUGE_HEIGHT) })
        }
        (None, Some(spacing)) if track.gauge_height.is_none() => {
            distance("track: spacing", spacing).map(RailDistance::Spacing)
        }
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

pub(super) fn wheels(wheelset: &WheelsetData) -> Result<WheelDistance> {
    match (wheelset.back_to_back, wheelset.flange_back_x, wheelset.spacing) {
        (Some(back_to_back), Some(flange_back_x), None) => {
            let distance = distance("wheelset: back_to_back", back_to_back)?;
            Ok(WheelDistance::BackToBack { distance, flange_back_x })
        }
        (None, None, Some(spacing)) => distance("wheelset: spacing", spacing).map(WheelDistance::Spacing),
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
        // The roll at which loads balance is sought from the roll of first touch.
        RollData::Word(RollWord::Solve | RollWord::Load) => Roll::Solve,
        RollData::Word(RollWord::Neglect) => Roll::Neglect,
        RollData::Radians(angle) => Roll::Fixed(finite("wheelset: roll", angle)?),
    })
}

//! Makes the march of a scene: a wheelset on rails that vary along the track, or with wheels that vary around their axle.

use std::path::Path;
use std::sync::Arc;

use super::data::Scene;
use super::doubts::doubts_of_keys;
use super::profiles::{Given, Resolved, rail_of};
use super::resolve::{echo, with_profiles};
use super::setup::{position, rails, wheels, within};
use super::varying::{WheelBody, both_vary, list_of, loft, wheel};
use crate::case::{Case, MarchCase, Profiles, SideProfiles, usual};
use crate::error::{Error, Result, finite};
use crate::lofted::{Loft, LoftedBody, LoftedWheel, section};
use crate::numerics::bodies::Bodies;
use crate::numerics::interval::Interval;
use crate::placement::{Pair, RailDistance, Track, WheelDistance, Wheelset};
use crate::profile::Side;
use crate::search::{March, ONE_CONTACT, Selection, SideOnTrack, WheelsetOnTrack};

/// Resolves a scene into a march along its rails, at least one of which is a list of slices without `along`, or around its wheels, at
/// least one of which has a flat, is out of round or is a list of slices without `angle`. Paths in the scene are relative to `folder`.
///
/// # Errors
/// Anything that is wrong; the error names the key.
pub fn march(scene: &Scene, folder: &Path) -> Result<MarchCase> {
    let (Some(track), Some(wheelset)) = (&scene.track, &scene.wheelset) else {
        let expected = "[track] and [wheelset]";
        return Err(Error::new("", "a single wheel", expected, "a march moves a wheelset along its track"));
    };
    if scene.roller.is_some() {
        return Err(Error::new("roller", "rollers", "rails that vary along the track", "remove [roller]"));
    }
    let (position, within) = (position(wheelset)?, within(wheelset.within)?);
    let sides = MarchSides { scene, folder, rails: rails(track)?, wheels: wheels(wheelset)? };
    let warnings = doubts_of_keys(scene).iter().map(ToString::to_string).collect();
    let mut lists = Lists { reach: Interval::ALL, warnings };
    let (own, right) = sides.side(true, &mut lists)?;
    let (system, left) = if scene.left.is_none() && scene.right.is_none() {
        (WheelsetOnTrack::symmetrical(right), None)
    } else {
        let (other, left) = sides.side(false, &mut lists)?;
        (WheelsetOnTrack::of_sides(left, right), Some(other))
    };
    let profiles = Profiles { right: own, left };
    let reach = lists.reach;
    if reach.low == f64::NEG_INFINITY && !system.turning() {
        let expected = "a rail that varies: a list .slcs of slices without `along`; or such a wheel";
        return Err(Error::new("rail", "rails of one profile each", expected, "or take `wheelrail sweep`"));
    }
    let pitch = finite("wheelset: pitch", wheelset.pitch)?;
    if pitch != 0.0 && !system.turning() {
        let expected = "no pitch of wheels of one profile each";
        return Err(Error::new("wheelset: pitch", format!("{pitch} rad"), expected, "remove it"));
    }
    if !reach.has_width() {
        let found = "rails whose lists have no place in common";
        return Err(Error::new("rail", found, "lists that overlap along the track", "correct the offsets"));
    }
    let selection = Selection { within, apart: ONE_CONTACT };
    let march = March { system, position, selection, reach, pitch };
    let loaded = loaded(scene, &profiles)?;
    let landmarks = profiles.landmarks();
    Ok(MarchCase { march, profiles, loaded, landmarks, warnings: lists.warnings, echo: echo(scene, "march") })
}

/// Makes the case of a wheelset under the loads of a scene; `None` without loads.
fn loaded(scene: &Scene, profiles: &Profiles) -> Result<Option<Case>> {
    if !scene.loaded() {
        return Ok(None);
    }
    // The march sets the place along the track at every stop; it has no motion.
    let mut here = Scene { motion: None, ..scene.clone() };
    if let Some(wheelset) = &mut here.wheelset {
        wheelset.along = profiles.varying().any(|side| side == Side::Rail).then_some(0.0);
    }
    with_profiles(&here, profiles.clone(), "march").map(Some)
}

/// What both sides are made of.
struct MarchSides<'a> {
    scene: &'a Scene,
    folder: &'a Path,
    rails: RailDistance,
    wheels: WheelDistance,
}

impl MarchSides<'_> {
    /// Makes one side, whose rail or wheel varies, or neither.
    fn side(&self, right: bool, lists: &mut Lists) -> Result<(SideProfiles, SideOnTrack)> {
        let Self { scene, folder, rails, wheels } = *self;
        let (name, own) = if right { ("right", &scene.right) } else { ("left", &scene.left) };
        let own = own.as_ref();
        let [rail, own_wheel] =
            [own.and_then(|side| side.rail.as_ref()), own.and_then(|side| side.wheel.as_ref())];
        let [rail_key, wheel_key] = [("rail", rail), ("wheel", own_wheel)]
            .map(|(body, own)| if own.is_some() { format!("{name}: {body}") } else { body.to_owned() });
        let (rail, given) = (rail.unwrap_or(&scene.rail), Given::new());
        let data = own_wheel.unwrap_or(&scene.wheel);
        let WheelBody { resolved, radius, varying } =
            wheel(scene, (data, &wheel_key), None, (folder, &given))?;
        lists.take_wheel(&wheel_key, (&resolved, radius), varying.as_ref());
        let axle = Wheelset::new(wheels, radius)?;
        let deviation = own.and_then(|side| side.deviation).unwrap_or_default();
        if deviation.roll != 0.0 {
            let place = format!("{name}: deviation: roll");
            let expected = "lateral and vertical deviations of rails that are marched along";
            return Err(Error::new(place, "a roll", expected, "turn the profile by `rotate`"));
        }
        let sign = if right { 1.0 } else { -1.0 };
        let moved = |track: Track| track.moved(sign * deviation.lateral, deviation.vertical);
        let Some(list) = list_of(rail, Side::Rail) else {
            let rail = rail_of(rail, &rail_key, (folder, &given))?;
            lists.take_findings(&rail_key, &rail);
            let rail = rail.profile;
            let track = moved(Track::new(&rail, rails)?)?;
            let varying = varying.map(|wheel| LoftedBody::Wheel(Arc::new(wheel)));
            return on_track((Pair::new(rail, resolved.profile, radius)?, varying), track, axle);
        };
        let RailDistance::Spacing(spacing) = rails else {
            let expected = "`spacing` of the profile origins: rails that vary have no one gauge point";
            return Err(Error::new("track", "a gauge", expected, "give spacing instead of gauge"));
        };
        if varying.is_some() {
            return Err(both_vary(&wheel_key));
        }
        let loft = loft(rail, &folder.join(list)).map_err(|error| error.within(&rail_key))?;
        lists.take(&loft, &rail_key);
        let first = loft.strips.first().map_or(0.0, |strip| strip.reach().low);
        let mut section = section(&loft, loft.widest(first).unwrap_or(0), first)?;
        // The march cuts another section at every place.
        section.name = list.file_name().unwrap_or(list.as_os_str()).to_string_lossy().into_owned();
        let varying = Some(LoftedBody::Rail(Arc::new(loft)));
        let track = moved(Track::between_origins(spacing)?)?;
        on_track((Pair::new(section, resolved.profile, radius)?, varying), track, axle)
    }
}

/// Puts rail and wheel of one side, one of which may vary, on the track.
fn on_track(
    (pair, varying): (Pair, Option<LoftedBody>),
    track: Track,
    axle: Wheelset,
) -> Result<(SideProfiles, SideOnTrack)> {
    let profiles = SideProfiles { pair, measured: Bodies::default(), varying };
    let side = profiles.on_track(track, axle)?;
    Ok((profiles, side))
}

/// What the slices of both sides have in common: the range along the track \[mm\]; and the warnings about both sides.
struct Lists {
    reach: Interval,
    warnings: Vec<String>,
}

impl Lists {
    fn take_findings(&mut self, key: &str, own: &Resolved) {
        let findings = own.measured.iter().flat_map(|record| &record.warnings);
        self.warnings.extend(findings.map(|finding| format!("{key}: {}: {}", finding.place, finding.found)));
    }

    fn take_wheel(&mut self, key: &str, (own, radius): (&Resolved, f64), varying: Option<&LoftedWheel>) {
        self.take_findings(key, own);
        let surface = varying.into_iter().flat_map(|wheel| wheel.warnings());
        self.warnings.extend(surface.map(|warning| format!("{key}: {warning}")));
        self.warnings.extend(usual::radius(&format!("{key}: radius"), radius).map(|doubt| doubt.to_string()));
    }

    fn take(&mut self, loft: &Loft, place: &str) {
        self.reach = self.reach.cut(loft.reach());
        self.warnings.extend(loft.warnings.iter().map(|warning| format!("{place}: {warning}")));
    }
}

//! What is allowed in a scene but seldom meant, key by key.

use super::data::{RollData, Scene};
use super::profile_data::{ProfileData, Rotation};
use super::side_data::SideData;
use super::varying::list_of;
use crate::case::{Doubt, Landmarks, Profiles, SideLandmarks, SideProfiles, usual};
use crate::profile::Side;
use crate::profile::standards::is_built_in;
use crate::search::TrackSide;

/// Lists what is doubtful in a scene, by key, with number and likely cause.
pub(super) fn doubts(scene: &Scene, profiles: &Profiles, landmarks: &SideLandmarks) -> Vec<Doubt> {
    let mut out = doubts_of_keys(scene);
    for (side, own) in profiles.sides() {
        let marks = landmarks.on(side.unwrap_or(TrackSide::Right));
        wheel(scene, side, (own, marks), &mut out);
        kinks(scene, side, own, &mut out);
    }
    out
}

/// Lists what is doubtful in the keys alone, whatever the profiles.
pub fn doubts_of_keys(scene: &Scene) -> Vec<Doubt> {
    let mut out = Vec::new();
    rotations(scene, &mut out);
    angles(scene, &mut out);
    units(scene, &mut out);
    distances(scene, &mut out);
    out
}

fn rotations(scene: &Scene, out: &mut Vec<Doubt>) {
    let of_sides = [("left", &scene.left), ("right", &scene.right)].into_iter().flat_map(|(name, side)| {
        let side = side.as_ref();
        [
            ("rail", side.and_then(|side| side.rail.as_ref())),
            ("wheel", side.and_then(|side| side.wheel.as_ref())),
        ]
        .map(|(body, data)| (format!("{name}: {body}"), data))
    });
    let own = [("rail".to_string(), Some(&scene.rail)), ("wheel".to_string(), Some(&scene.wheel))];
    for (place, data) in own.into_iter().chain(of_sides) {
        let written = match data.and_then(|data| data.rotate.as_ref()) {
            Some(Rotation::Radians(angle)) => Some(*angle),
            // An inclination has no unit to mistake, but its two numbers may be exchanged: "40:1".
            Some(ratio) => ratio.turn().ok().map(|turn| turn.angle()),
            None => None,
        };
        let rail = place.ends_with("rail");
        out.extend(written.and_then(|turn| usual::turn(&format!("{place}: rotate"), turn, rail)));
    }
}

fn angles(scene: &Scene, out: &mut Vec<Doubt>) {
    let rolled = |roll: RollData| match roll {
        RollData::Radians(roll) => Some(roll),
        RollData::Word(_) => None,
    };
    let contact = scene.contact.as_ref();
    let wheelset = scene.wheelset.as_ref();
    let deviation = |side: &Option<SideData>| side.as_ref()?.deviation.map(|deviation| deviation.roll);
    let all = [
        ("contact: yaw", contact.and_then(|contact| contact.yaw)),
        ("contact: roll", contact.and_then(|contact| contact.roll)),
        ("wheelset: yaw", wheelset.map(|wheelset| wheelset.yaw)),
        ("wheelset: roll", wheelset.and_then(|wheelset| rolled(wheelset.roll?))),
        ("left: deviation: roll", deviation(&scene.left)),
        ("right: deviation: roll", deviation(&scene.right)),
    ];
    out.extend(all.into_iter().filter_map(|(place, angle)| usual::angle(place, angle?)));
}

fn units(scene: &Scene, out: &mut Vec<Doubt>) {
    let of_side = |side: &Option<SideData>| side.as_ref().and_then(|side| side.load);
    let loads = [
        ("patch: load", scene.patch.as_ref().and_then(|patch| patch.load)),
        ("wheelset: load", scene.wheelset.as_ref().and_then(|wheelset| wheelset.load)),
        ("left: load", of_side(&scene.left)),
        ("right: load", of_side(&scene.right)),
    ];
    out.extend(loads.into_iter().filter_map(|(place, load)| usual::load(place, load?)));
    let moduli = [
        ("material: rail_youngs_modulus", scene.material.rail_youngs_modulus),
        ("material: wheel_youngs_modulus", scene.material.wheel_youngs_modulus),
    ];
    out.extend(moduli.into_iter().filter_map(|(place, modulus)| usual::modulus(place, modulus)));
    out.extend(scene.motion.as_ref().and_then(|motion| usual::speed("motion: speed", motion.speed)));
}

/// Adds what is doubtful in the distances of the track and the wheelset.
fn distances(scene: &Scene, out: &mut Vec<Doubt>) {
    let (Some(track), Some(wheelset)) = (&scene.track, &scene.wheelset) else { return };
    out.extend(track.gauge_height.and_then(|height| usual::gauge_height("track: gauge_height", height)));
    let places = ["track: gauge", "wheelset: back_to_back"];
    let given = track.gauge.zip(wheelset.back_to_back);
    out.extend(given.and_then(|(gauge, back)| usual::gauge(places, gauge, back)));
}

/// Adds what is doubtful in a wheel's radius, the side of its flange and the place of its flange back.
fn wheel(
    scene: &Scene,
    side: Option<TrackSide>,
    (own, marks): (&SideProfiles, &Landmarks),
    out: &mut Vec<Doubt>,
) {
    let place = own_place(side, "wheel");
    out.extend(usual::radius(&format!("{place}: radius"), own.pair.wheel_radius()));
    out.extend(usual::flange_side(&place, marks));
    let given = scene.wheelset.as_ref().and_then(|wheelset| wheelset.flange_back_x);
    out.extend(given.and_then(|x| usual::flange_back_x(["wheelset: flange_back_x", &place], x, marks)));
}

/// Names a body of a side.
fn own_place(side: Option<TrackSide>, body: &str) -> String {
    side.map_or_else(|| body.to_string(), |side| format!("{side}: {body}"))
}

fn kinks(scene: &Scene, side: Option<TrackSide>, own: &SideProfiles, out: &mut Vec<Doubt>) {
    let of_side = match side {
        Some(TrackSide::Left) => scene.left.as_ref(),
        Some(_) => scene.right.as_ref(),
        None => None,
    };
    let data: [&ProfileData; 2] = [
        of_side.and_then(|side| side.rail.as_ref()).unwrap_or(&scene.rail),
        of_side.and_then(|side| side.wheel.as_ref()).unwrap_or(&scene.wheel),
    ];
    let bodies = [(Side::Rail, "rail", own.pair.rail()), (Side::Wheel, "wheel", own.pair.wheel())];
    for (k, (body, name, profile)) in bodies.into_iter().enumerate() {
        // Kinks of built-in and measured profiles and of slices come from their sources: they are no slips of a drawing.
        let of_slices = list_of(data[k], body).is_some();
        if !of_slices && !is_built_in(profile, body) && own.measured.both()[k].is_none() {
            out.extend(usual::kinks(&own_place(side, name), profile));
        }
    }
}

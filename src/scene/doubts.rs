//! What is allowed in a scene but seldom meant: values that look like another unit, and drawings with kinks.

use super::data::{RollData, Scene};
use super::profile_data::Rotation;
use super::side_data::SideData;
use crate::case::{Profiles, SideProfiles};
use crate::profile::Profile;

/// Steepest inclination of a rail that is not spoken of \[rad\]: 1:5.
const STEEPEST: f64 = 0.2;

/// Largest yaw or roll that is not spoken of \[rad\]: almost 6°.
const LARGE_ANGLE: f64 = 0.1;

/// Least load of a wheel or axle that is not spoken of \[N\].
const LIGHT: f64 = 1000.0;

/// Young's moduli of what wheels and rails are made of \[N/mm²\].
const MODULI: [f64; 2] = [1e4, 1e6];

/// Largest kink between drawn segments that is not spoken of \[degrees\].
const KINK: f64 = 5.0;

/// Lists what is doubtful in a scene, by key, with number and likely cause.
pub(super) fn doubts(scene: &Scene, profiles: &Profiles) -> Vec<String> {
    let mut out = Vec::new();
    rotations(scene, &mut out);
    angles(scene, &mut out);
    units(scene, &mut out);
    for (side, own) in profiles.sides() {
        kinks(scene, side, own, &mut out);
    }
    out
}

fn rotations(scene: &Scene, out: &mut Vec<String>) {
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
            // An inclination is no slip of the unit, but may be one of its ends: "40:1".
            Some(ratio) => ratio.turn().ok().map(|turn| turn.angle()),
            None => None,
        };
        if let Some(turn) = written.filter(|turn| turn.abs() > STEEPEST) {
            out.push(format!(
                "{place}: rotate: {turn} rad is {:.1} degrees, steeper than 1:5: angles are in rad, and inclinations like \"1:40\"",
                turn.to_degrees()
            ));
        }
    }
}

fn angles(scene: &Scene, out: &mut Vec<String>) {
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
        ("wheelset: roll", wheelset.and_then(|wheelset| rolled(wheelset.roll))),
        ("left: deviation: roll", deviation(&scene.left)),
        ("right: deviation: roll", deviation(&scene.right)),
    ];
    for (place, angle) in all {
        if let Some(angle) = angle.filter(|angle| angle.abs() > LARGE_ANGLE) {
            out.push(format!(
                "{place}: {angle} rad is {:.1} degrees: wheelsets turn by less than 2; angles are in rad",
                angle.to_degrees()
            ));
        }
    }
}

fn units(scene: &Scene, out: &mut Vec<String>) {
    let of_side = |side: &Option<SideData>| side.as_ref().and_then(|side| side.load);
    let loads = [
        ("patch: load", scene.patch.as_ref().and_then(|patch| patch.load)),
        ("wheelset: load", scene.wheelset.as_ref().and_then(|wheelset| wheelset.load)),
        ("left: load", of_side(&scene.left)),
        ("right: load", of_side(&scene.right)),
    ];
    for (place, load) in loads {
        if let Some(load) = load.filter(|load| *load > 0.0 && *load < LIGHT) {
            out.push(format!(
                "{place}: {load} N is the weight of {:.1} kg: loads are in N, not in kN",
                load / 9.81
            ));
        }
    }
    let moduli = [
        ("rail_youngs_modulus", scene.material.rail_youngs_modulus),
        ("wheel_youngs_modulus", scene.material.wheel_youngs_modulus),
    ];
    for (key, modulus) in moduli {
        if !(MODULI[0]..=MODULI[1]).contains(&modulus) {
            let unit = if modulus < MODULI[0] { "GPa" } else { "Pa" };
            out.push(format!(
                "material: {key}: {modulus:e} N/mm² is no metal's: steel has 2.1e5; it looks like {unit}"
            ));
        }
    }
}

fn kinks(scene: &Scene, side: Option<&str>, own: &SideProfiles, out: &mut Vec<String>) {
    let of_side = match side {
        Some("left") => scene.left.as_ref(),
        Some(_) => scene.right.as_ref(),
        None => None,
    };
    let data = [
        of_side.and_then(|side| side.rail.as_ref()).unwrap_or(&scene.rail),
        of_side.and_then(|side| side.wheel.as_ref()).unwrap_or(&scene.wheel),
    ];
    let bodies: [(&str, &Profile); 2] = [("rail", own.pair.rail()), ("wheel", own.pair.wheel())];
    for (k, (body, profile)) in bodies.into_iter().enumerate() {
        // The kinks of standards are theirs, and those of measured profiles their files'.
        if data[k].profile.is_some() || own.measured[k].is_some() {
            continue;
        }
        let place = side.map_or_else(|| body.to_string(), |side| format!("{side}: {body}"));
        let sharp = profile.continuity().into_iter().filter(|joint| joint.kink.to_degrees().abs() > KINK);
        for joint in sharp {
            out.push(format!(
                "{place}: segments {} and {} meet at x = {:.3} mm with a kink of {:.1} degrees: check their ends, unless the corner is meant",
                joint.left + 1,
                joint.left + 2,
                joint.x,
                joint.kink.to_degrees()
            ));
        }
    }
}

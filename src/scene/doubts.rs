//! What is allowed in a scene but seldom meant: values that look like another unit or sign, and drawings with kinks.

use std::ops::RangeInclusive;

use super::data::{RollData, Scene};
use super::profile_data::{ProfileData, Rotation};
use super::side_data::SideData;
use crate::case::{Doubt, DoubtKind, Landmarks, Profiles, SideProfiles};
use crate::profile::Profile;
use crate::search::TrackSide;

/// Steepest inclination that is no doubt \[rad\]: 1:5.
const STEEPEST: f64 = 0.2;

/// Steepest inclination of a rail away from the middle of the track that is no doubt \[rad\]: 1:100, what a measured profile may be
/// turned back by.
const OUTWARDS: f64 = 0.01;

/// Largest yaw or roll that is no doubt \[rad\]: almost 6°.
const LARGE_ANGLE: f64 = 0.1;

/// Least load of a wheel or axle that is no doubt \[N\].
const LIGHT: f64 = 1000.0;

/// Young's moduli of what wheels and rails are made of \[N/mm²\].
const MODULI: RangeInclusive<f64> = 1e4..=1e6;

/// Largest kink between drawn segments that is no doubt \[degrees\].
const KINK: f64 = 5.0;

/// Nominal radii of railway wheels \[mm\], from wagons for lorries (180) to locomotives (625).
const RADII: RangeInclusive<f64> = 150.0..=700.0;

/// Radii that another unit may have been meant for \[mm\]: those of most wheels.
const USUAL_RADII: RangeInclusive<f64> = 250.0..=650.0;

/// Gauge less back-to-back distance \[mm\], from trams on grooved rails (50) to broad gauge (85).
const PLAY: RangeInclusive<f64> = 40.0..=110.0;

/// Depths below the top of rail at which gauges are measured \[mm\]: 9 (trams) to 16 (5/8 in).
const GAUGE_HEIGHTS: RangeInclusive<f64> = 5.0..=30.0;

/// Height of the profile's end over the flange's tip from which on the end is the flange's back \[mm\], and the largest
/// difference of its abscissa from the given one \[mm\]: backs that are not measured to their whole height end at a rounding of
/// some 10 mm.
const BACK: [f64; 2] = [5.0, 10.0];

/// Largest speed that is no doubt \[m/s\]: 360 km/h.
const FAST: f64 = 100.0;

/// Lists what is doubtful in a scene, by key, with number and likely cause.
pub(super) fn doubts(scene: &Scene, profiles: &Profiles) -> Vec<Doubt> {
    let mut out = Vec::new();
    rotations(scene, &mut out);
    angles(scene, &mut out);
    units(scene, &mut out);
    distances(scene, &mut out);
    for (side, own) in profiles.sides() {
        wheel(scene, side, own, &mut out);
        kinks(scene, side, own, &mut out);
    }
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
            // An inclination is no slip of the unit, but may be one of its ends: "40:1".
            Some(ratio) => ratio.turn().ok().map(|turn| turn.angle()),
            None => None,
        };
        let Some(turn) = written else { continue };
        let (rail, degrees) = (place.ends_with("rail"), turn.to_degrees());
        if turn.abs() > STEEPEST {
            let found = format!("{place}: rotate: {turn} rad is {degrees:.1} degrees, steeper than 1:5");
            out.push(Doubt::new(DoubtKind::Inclination, found));
        } else if rail && turn < -OUTWARDS {
            let found =
                format!("{place}: rotate: {turn:.4} rad inclines the rail away from the middle of the track");
            out.push(Doubt::new(DoubtKind::Outwards, found));
        }
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
        ("wheelset: roll", wheelset.and_then(|wheelset| rolled(wheelset.roll))),
        ("left: deviation: roll", deviation(&scene.left)),
        ("right: deviation: roll", deviation(&scene.right)),
    ];
    for (place, angle) in all {
        if let Some(angle) = angle.filter(|angle| angle.abs() > LARGE_ANGLE) {
            let found = format!("{place}: {angle} rad is {:.1} degrees", angle.to_degrees());
            out.push(Doubt::new(DoubtKind::Angle, found));
        }
    }
}

fn units(scene: &Scene, out: &mut Vec<Doubt>) {
    let of_side = |side: &Option<SideData>| side.as_ref().and_then(|side| side.load);
    let loads = [
        ("patch: load", scene.patch.as_ref().and_then(|patch| patch.load)),
        ("wheelset: load", scene.wheelset.as_ref().and_then(|wheelset| wheelset.load)),
        ("left: load", of_side(&scene.left)),
        ("right: load", of_side(&scene.right)),
    ];
    for (place, load) in loads {
        if let Some(load) = load.filter(|load| *load > 0.0 && *load < LIGHT) {
            let found = format!("{place}: {load} N is the weight of {:.1} kg", load / 9.81);
            out.push(Doubt::new(DoubtKind::Load, found));
        }
    }
    let moduli = [
        ("rail_youngs_modulus", scene.material.rail_youngs_modulus),
        ("wheel_youngs_modulus", scene.material.wheel_youngs_modulus),
    ];
    for (key, modulus) in moduli {
        if !MODULI.contains(&modulus) {
            let found = format!("material: {key}: {modulus:e} N/mm² is no metal's");
            out.push(Doubt::new(DoubtKind::Modulus, found));
        }
    }
    let speed = scene.motion.as_ref().map(|motion| motion.speed);
    if let Some(speed) = speed.filter(|speed| speed.abs() > FAST) {
        let found = format!("motion: speed: {speed} m/s is {} km/h", 3.6 * speed);
        out.push(Doubt::new(DoubtKind::Speed, found));
    }
}

/// Of the track and the wheelset.
fn distances(scene: &Scene, out: &mut Vec<Doubt>) {
    let (Some(track), Some(wheelset)) = (&scene.track, &scene.wheelset) else { return };
    if let Some(height) = track.gauge_height.filter(|height| !GAUGE_HEIGHTS.contains(height)) {
        let found = format!("track: gauge_height: {height} mm below the top of rail");
        out.push(Doubt::new(DoubtKind::GaugeHeight, found));
    }
    let (Some(gauge), Some(back)) = (track.gauge, wheelset.back_to_back) else { return };
    let play = gauge - back;
    if !PLAY.contains(&play) {
        let found = format!("track: gauge: {gauge} mm is {play} mm more than wheelset: back_to_back");
        out.push(Doubt::new(DoubtKind::Gauge, found));
    }
}

/// Of a wheel's radius and flange.
fn wheel(scene: &Scene, side: Option<TrackSide>, own: &SideProfiles, out: &mut Vec<Doubt>) {
    let radius = own.pair.wheel_radius();
    let place = own_place(side, "wheel");
    if !RADII.contains(&radius) {
        let read =
            [(0.5, "as a diameter"), (25.4, "in inches"), (12.7, "as a diameter in inches"), (10.0, "in cm")];
        let fitting = read.into_iter().filter(|(unit, _)| USUAL_RADII.contains(&(unit * radius)));
        let meant: String = fitting.map(|(unit, how)| format!(", {:.1} mm {how}", unit * radius)).collect();
        let found = format!("{place}: radius: {radius} mm is no railway wheel's{meant}");
        out.push(Doubt::new(DoubtKind::Radius, found));
    }
    let marks = Landmarks::new(&own.pair);
    let Some(tip) = marks.tip else { return };
    let [left, right] = marks.ends;
    if tip.x > left + (right - left) / 2.0 {
        let found = format!(
            "{place}: the tip of its flange is at x = {:.1} mm, its other end at {left:.1} mm",
            tip.x
        );
        out.push(Doubt::new(DoubtKind::FlangeSide, found));
        return;
    }
    let given = scene.wheelset.as_ref().and_then(|wheelset| wheelset.flange_back_x);
    let [height, off] = BACK;
    if let Some(given) = given.filter(|given| marks.back > height && (given - left).abs() > off) {
        let found =
            format!("wheelset: flange_back_x: {given} mm, and the back of {place} is at x = {left:.1} mm");
        out.push(Doubt::new(DoubtKind::FlangeBackX, found));
    }
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
    let bodies: [(&str, &Profile); 2] = [("rail", own.pair.rail()), ("wheel", own.pair.wheel())];
    for (k, (body, profile)) in bodies.into_iter().enumerate() {
        // The kinks of standards are theirs, and those of measured profiles their files'.
        if data[k].profile.is_some() || own.measured.both()[k].is_some() {
            continue;
        }
        let place = own_place(side, body);
        let sharp = profile.continuity().into_iter().filter(|joint| joint.kink.to_degrees().abs() > KINK);
        out.extend(sharp.map(|joint| {
            let segments = format!("segments {} and {}", joint.left + 1, joint.left + 2);
            let kink = format!("x = {:.3} mm with a kink of {:.1} degrees", joint.x, joint.kink.to_degrees());
            Doubt::new(DoubtKind::Kink, format!("{place}: {segments} meet at {kink}"))
        }));
    }
}

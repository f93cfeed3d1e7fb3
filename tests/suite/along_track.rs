//! Rails that vary along the track: closed forms, brute force in space, and CONTACT's results.

use crate::common::repository;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde_json::Value;
use wheelrail::error::Result;
use wheelrail::internal::Random;
use wheelrail::lofted::{Joining, Loft, LoftSlice};
use wheelrail::nalgebra;
use wheelrail::placement::{Track, Wheelset};
use wheelrail::scene::{self, Scene};
use wheelrail::search::{
    Contact, EventKind, LoftedPair, March, ONE_CONTACT, Position, Roll, Selection, SideOnTrack, TrackSide,
    WheelsetOnTrack,
};
use wheelrail::{Half, Pair, Profile, RailDistance, Segment, WheelDistance, standards};

use super::campaign::scenes;

/// Distance of the profile origins \[mm\].
const SPACING: f64 = 1500.0;
pub(super) const RADIUS: f64 = 460.0;

pub(super) fn slices(at: &[f64], profile: impl Fn(f64) -> Profile) -> Vec<LoftSlice> {
    let slice = |&at: &f64| LoftSlice {
        at,
        name: format!("at {at}"),
        profile: profile(at),
        features: Vec::new(),
        measured_along: None,
    };
    at.iter().map(slice).collect()
}

/// A march over the same lofted rail on both sides.
pub(super) fn march_over(
    slices: &[LoftSlice],
    wheel: Profile,
    position: Position,
    within: f64,
) -> Result<March> {
    let loft = Arc::new(Loft::new(slices, Joining::Monotone)?);
    let reach = loft.reach();
    let pair = Arc::new(LoftedPair::new(loft, &wheel, RADIUS)?);
    let axle = Wheelset::new(WheelDistance::Spacing(SPACING), RADIUS)?;
    let side = SideOnTrack::lofted(pair, Track::between_origins(SPACING)?, axle);
    let selection = Selection { within, apart: ONE_CONTACT };
    Ok(March { system: WheelsetOnTrack::symmetrical(side), position, selection, reach, pitch: 0.0 })
}

pub(super) fn position(lateral: f64, yaw: f64, roll: f64) -> Position {
    Position { lateral, yaw, roll: Roll::Fixed(roll) }
}

pub(super) fn right(march: &March, along: f64) -> Contact {
    *march.at(along).unwrap().of(TrackSide::Right).next().unwrap_or_else(|| panic!("no contact at {along}"))
}

/// A head of one crown with its corners, z = 0 at the top.
fn head(x: f64, z: f64) -> Profile {
    let arc = |centre: [f64; 2], radius, x| {
        Segment::arc(wheelrail::Arc::about(centre, radius, Half::Upper, x).unwrap())
    };
    let shoulder = 300.0 - (300.0f64 * 300.0 - 400.0).sqrt();
    let crown = arc([0.0, -300.0], 300.0, [-20.0, 20.0]);
    // Corners of 13 mm, with the crown's tangents at ±20.
    let (sin, cos) = (20.0 / 300.0, 1.0 - shoulder / 300.0);
    let (a, b) = (20.0 - 13.0 * sin, -shoulder - 13.0 * cos);
    let [left, right] = [arc([-a, b], 13.0, [-a - 12.9, -20.0]), arc([a, b], 13.0, [20.0, a + 12.9])];
    Profile::new("head", "", vec![left, crown, right]).unwrap().shifted(x, z)
}

#[test]
fn a_cylinder_on_a_nose_that_rises_at_a_rate_has_a_closed_form() -> Result<()> {
    for rate in [0.1, -0.1, 0.02] {
        let rail = slices(&[-100.0, -35.0, 10.0, 60.0, 100.0], |y| head(0.0, rate * y));
        let tread =
            Profile::new("tread", "", vec![Segment::arc(wheelrail::Arc::line([-40.0, 0.0], [40.0, 0.0])?)])?;
        let march = march_over(&rail, tread, position(0.0, 0.0, 0.0), 0.0)?;
        for along in [-20.0, 0.0, 33.3] {
            let (stop, contact) = (march.at(along)?, right(&march, along));
            let length = f64::hypot(1.0, rate);
            let height = rate * along + RADIUS * (length - 1.0);
            assert!((stop.rows[1].z - height).abs() < 1e-10, "{} {height}", stop.rows[1].z);
            assert!((contact.y - RADIUS * rate / length).abs() < 1e-5, "{contact:?}");
            assert!(contact.rail_x.abs() < 1e-5 && contact.contact_angle.abs() < 1e-7, "{contact:?}");
            assert!((contact.slope_along() - rate).abs() < 1e-7, "{contact:?}");
            assert!((contact.rail_curvature + 1.0 / 300.0).abs() < 1e-6, "{contact:?}");
        }
    }
    Ok(())
}

/// A spline through points h apart is off by some 0.03 h² Δκ where the curvature jumps by Δκ, here from 1/13 to 1/300 \[mm\].
const JOINT: f64 = 0.03 * 0.25 * 0.25 * (1.0 / 13.0 - 1.0 / 300.0);

#[test]
fn equal_slices_are_an_extruded_rail_under_any_yaw_and_roll() -> Result<()> {
    // The second wheel has kinks.
    ["S1002", "EN15302-A"].into_iter().try_for_each(|wheel| equal_slices(standards::wheel(wheel)?))
}

fn equal_slices(wheel: Profile) -> Result<()> {
    let rail = head(0.0, 0.0);
    let lofted = slices(&[-300.0, -40.0, 5.0, 45.0, 300.0], |_| rail.clone());
    let mut march = march_over(&lofted, wheel.clone(), position(0.0, 0.0, 0.0), 0.0)?;
    let pair = Pair::new(rail, wheel, RADIUS)?;
    let system =
        WheelsetOnTrack::new(&pair, RailDistance::Spacing(SPACING), WheelDistance::Spacing(SPACING))?;
    let mut search = system.search();
    let mut random = Random::new(34);
    for _ in 0..scenes() {
        let at =
            position(random.between(-9.0, 9.0), random.between(-0.03, 0.03), random.between(-0.005, 0.005));
        march.position = at;
        let touch = search.touch(&at, &march.selection)?;
        let stop = march.at(random.between(-50.0, 50.0))?;
        for (row, side) in stop.rows.iter().zip(touch.sides) {
            let swept = side.touch.contacts[0];
            let place = format!("{at:?}: {:?} instead of {swept:?}", row.contact);
            assert!((row.z - side.z).abs() < JOINT, "{place}");
            assert!((row.contact.contact_angle - swept.contact_angle).abs() < 1e-3, "{place}");
            assert!((row.contact.rolling_radius - swept.rolling_radius).abs() < 0.02, "{place}");
            assert!((row.contact.skew - swept.skew).abs() < 1e-4, "{place}");
            assert!((row.contact.y - swept.y).abs() < 0.05 && row.contact.turn.abs() < 1e-9, "{place}");
        }
    }
    Ok(())
}

/// The crossing of the examples, and its march.
fn crossing() -> March {
    let folder = repository("examples/crossing");
    scene::march(&scene::load(&folder.join("crossing.toml")).unwrap(), &folder).unwrap().march
}

/// Least vertical gap of a wheel over the points of a surface: every fourth part of a millimetre along the track, and two points a
/// cell across. The wheel is a polygon of its profile's lower side.
fn brute(loft: &Loft, wheel: &[[f64; 2]], [offset, ahead]: [f64; 2], at: &Position, along: f64) -> f64 {
    let Roll::Fixed(roll) = at.roll else { panic!("a roll") };
    let rotation = at.rotation(roll).inverse();
    let up = rotation * nalgebra::Vector3::z();
    let height = |x: f64| {
        let k = wheel.partition_point(|p| p[0] <= x);
        let (a, b) = (wheel.get(k.checked_sub(1)?)?, wheel.get(k)?);
        Some(a[1] + (b[1] - a[1]) * (x - a[0]) / (b[0] - a[0]))
    };
    let mut least = f64::INFINITY;
    for strip in &loft.strips {
        let [from, to] = strip.reach().ends();
        for step in -240..=240 {
            // A wheel may touch where a part begins or ends.
            let y = (along + 0.25 * f64::from(step)).clamp(from, to);
            if (y - along).abs() > 60.0 {
                continue;
            }
            for half in 0..=2 * strip.cells() {
                let [x, z] = strip.point(0.5 * half as f64, y).at;
                let q = rotation * nalgebra::Vector3::new(x - offset, y - along - ahead, z);
                let (mut gap, mut reached) = (0.0, true);
                for _ in 0..12 {
                    let p = q + up * gap;
                    let Some(h) = height(p.x) else {
                        reached = false;
                        break;
                    };
                    let rolling: f64 = RADIUS - h;
                    gap += RADIUS - (rolling * rolling - p.y * p.y).sqrt() - p.z;
                }
                least = if reached { least.min(gap) } else { least };
            }
        }
    }
    least
}

#[test]
fn no_place_of_the_surface_is_lower_than_first_touch() -> Result<()> {
    let mut march = crossing();
    let folder = repository("examples/crossing");
    let wheel = standards::wheel("S1002")?;
    let section = wheelrail::profile::Section::own_axes(&wheel, wheelrail::Side::Wheel);
    let polygon: Vec<[f64; 2]> = (-6900..=6400)
        .map(|k| 0.01 * f64::from(k))
        .map(|x| [x, section.height(x)])
        .filter(|point| point[1].is_finite())
        .collect();
    let scene = scene::load(&folder.join("crossing.toml"))?;
    let list =
        scene::loft(scene.right.as_ref().unwrap().rail.as_ref().unwrap(), &folder.join("crossing.slcs"))?;
    let mut random = Random::new(341);
    for _ in 0..scenes().div_ceil(4) {
        let (lateral, yaw, roll) =
            (random.between(-6.0, 6.0), random.between(-0.02, 0.02), random.between(-0.002, 0.002));
        let along = random.between(-90.0, 290.0);
        march.position = position(lateral, yaw, roll);
        let z = march.at(along)?.rows.iter().find(|row| row.side == TrackSide::Right).unwrap().z;
        // The wheel's profile origin: SPACING/2 out along the axle and RADIUS below it.
        let origin = march.position.rotation(roll) * nalgebra::Vector3::new(SPACING / 2.0, 0.0, -RADIUS);
        let offset = [origin.x + lateral - SPACING / 2.0, origin.y];
        let found = z + RADIUS + origin.z;
        let expected = -brute(&list, &polygon, offset, &march.position, along);
        let place =
            format!("{:?} at {along}: {found} and {expected} {:?}", march.position, right(&march, along));
        assert!(found >= expected - 1e-6 && found < expected + 0.003, "{place}");
    }
    Ok(())
}

#[test]
fn a_wheel_goes_over_from_the_wing_to_the_nose_once() -> Result<()> {
    let march = crossing();
    let along: Vec<f64> = (-10..=30).map(|k| 10.0 * f64::from(k)).collect();
    let (mut stops, mut events) = (0, Vec::new());
    march.blocks(&along, |own, found| {
        stops += own.len();
        events.extend_from_slice(found);
        Ok(true)
    })?;
    let over: Vec<_> = events
        .iter()
        .filter(|event| event.kind == EventKind::Transfer && event.radius_jump() > 1.0)
        .collect();
    let [over] = over.as_slice() else { panic!("{events:?}") };
    assert_eq!((stops, over.side), (41, TrackSide::Right));
    // To 0.01 mm: both places touch there.
    let [before, after] = [over.along - 0.02, over.along + 0.02].map(|along| right(&march, along));
    assert!(before.rail_x > 40.0 && after.rail_x < -20.0, "{before:?} {after:?}");
    assert!(over.gap.is_some_and(|gap| gap < 0.002), "{over:?}");
    // The wheel comes down the wing, and goes up the nose by 1:20.
    assert!((after.slope_along() - 0.05).abs() < 1e-3 && before.slope_along() < 0.0, "{before:?} {after:?}");
    assert!(events.iter().any(|event| event.kind == EventKind::LeastClearance), "{events:?}");
    Ok(())
}

#[test]
fn slices_that_make_no_surface_are_refused_by_name() {
    let found = |slices: &[LoftSlice]| {
        Loft::new(slices, Joining::Monotone).err().map(|e| e.to_string()).unwrap_or_default()
    };
    let list = slices(&[0.0, 10.0, 20.0], |_| head(0.0, 0.0));
    let with = |change: fn(&mut Vec<LoftSlice>)| {
        let mut list = list.clone();
        change(&mut list);
        found(&list)
    };
    for (error, part) in [
        (with(|list| list.truncate(1)), "slices: found 1 slice; expected two slices or more"),
        (with(|list| list.swap(0, 1)), "at 0: found a slice at 0 mm after one at 10 mm; expected ascending"),
        (
            with(|list| list[1].features = vec![0.0, 20.0]),
            "at 10: found 2 features; expected 0, as the slice before",
        ),
        (
            with(|list| list.iter_mut().for_each(|slice| slice.features = vec![0.0, 30.0, 20.0])),
            "at 0: found feature 3 at 20 mm after one at 30 mm; expected ascending arc lengths",
        ),
        (
            with(|list| {
                list[1].features = vec![-1.0, -1.0];
                list[0].features = vec![0.0, 20.0];
                list[2].features = vec![0.0, 20.0];
            }),
            "slices: found no such part; expected a part that two successive slices have",
        ),
    ] {
        assert!(error.starts_with(part), "{error}");
    }
    let march = march_over(&list, standards::wheel("S1002").unwrap(), position(0.0, 0.0, 0.0), 0.0).unwrap();
    let error = march.at(20.5).unwrap_err().to_string();
    assert!(error.starts_with("along: found 20.5 mm; expected a place from 0 to 20 mm"), "{error}");
}

#[test]
fn a_list_without_features_ends_where_its_slices_do_not_correspond() -> Result<()> {
    let list = slices(&[0.0, 50.0, 100.0, 150.0], |y| head(if y < 75.0 { 0.0 } else { 30.0 }, 0.0));
    let loft = Loft::new(&list, Joining::Monotone)?;
    assert_eq!(
        loft.strips.iter().map(|strip| strip.reach().ends()).collect::<Vec<_>>(),
        [[0.0, 50.0], [100.0, 150.0]]
    );
    assert_eq!(loft.warnings.len(), 1);
    assert!(loft.warnings[0].starts_with(
        "no surface between at 50 at 50.00 mm and at 100 at 100.00 mm: an end moves by 30.0 mm"
    ));
    Ok(())
}

/// The cases of the reference file, one group after another.
pub(super) fn cases() -> Vec<Value> {
    let path = repository("tests/reference_along/along_track.json");
    let file: Value = serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap();
    file["cases"].as_array().unwrap().clone()
}

/// A march of a case over the profiles of a copy of CONTACT.
fn march_of(profiles: &Path, case: &Value, surface: &str) -> Result<March> {
    let scene: Scene = scene::parse(&scene_of(case, surface, ""), false)?;
    scene::march(&scene, profiles).map(|found| found.march)
}

/// The scene of a case, with more keys of [wheelset].
pub(super) fn scene_of(case: &Value, surface: &str, more: &str) -> String {
    let rail = case["rail"].as_str().unwrap();
    let wheel = case["wheel"].as_str().unwrap();
    let metres = if rail.starts_with("uk_") { "unit = \"m\"\nflip_z = true\nmirror = false" } else { "" };
    let [lateral, yaw, roll] = ["y", "yaw", "roll"].map(|key| case[key].as_f64().unwrap());
    format!(
        "[rail]\nfile = {rail:?}\nsurface = {surface:?}\ncurve = \"interpolation\"\n{metres}\n\
         [wheel]\nfile = {wheel:?}\ncurve = \"interpolation\"\nradius = 460.0\n\
         [track]\nspacing = 1500.0\n\
         [wheelset]\nback_to_back = 1360.0\nflange_back_x = -70.0\nlateral = {lateral}\nyaw = {yaw}\nroll = {roll:?}\n\
         {more}"
    )
}

/// Height of the axle's middle when the right-hand wheel touches, down as CONTACT's \[mm\].
fn down(march: &March, along: f64) -> f64 {
    let stop = march.at(along).unwrap();
    let found = stop.rows.iter().find(|row| row.side == TrackSide::Right);
    -found.unwrap_or_else(|| panic!("no contact at {along}")).z
}

/// Heights differ from CONTACT's by no more than this with its own surface \[mm\].
const CUBIC: f64 = 0.0015;

/// Places where CONTACT's spline along the track rings, next to slices that do not correspond: here the surface ends there.
const RINGING: [(&str, i32); 9] = [
    ("uk_crossing.slcs", -480),
    ("uk_crossing.slcs", -520),
    ("uk_crossing.slcs", -640),
    ("uk_crossing.slcs", -80),
    ("uk_crossing.slcs", 1240),
    ("uk_crossing.slcs", 1280),
    ("uk_crossing.slcs", 1640),
    ("uk_crossing.slcs", 840),
    ("uk_crossing.slcs", 880),
];

/// And from a brute force's, which sampled the surface.
const BRUTE: f64 = 2e-4;

#[test]
fn heights_of_first_touch_are_contact_s_and_a_brute_force_s() -> Result<()> {
    let Some(copy) = std::env::var_os("WHEELRAIL_CONTACT").map(PathBuf::from) else { return Ok(()) };
    let profiles = copy.join("testbank/profiles");
    let mut last: Option<(String, [March; 2])> = None;
    let mut compared = [0, 0, 0];
    for case in cases() {
        let file = case["rail"].as_str().unwrap();
        if !file.ends_with(".slcs") {
            continue;
        }
        if last.as_ref().is_none_or(|(other, ..)| other != file) {
            last = Some((
                file.into(),
                [march_of(&profiles, &case, "monotone")?, march_of(&profiles, &case, "cubic")?],
            ));
        }
        let Some((_, marches)) = &mut last else { continue };
        let s = case["s"].as_f64().unwrap();
        let place = format!("{} at {}, y = {}", case["group"], case["s"], case["y"]);
        // z is up here and down in CONTACT.
        let [monotone, cubic] = marches.each_mut().map(|march| {
            march.position.lateral = case["y"].as_f64().unwrap();
            down(march, s)
        });
        let within = |found: f64, key: &str, most: f64| {
            let Some(expected) = case[key].as_f64() else { return 0 };
            assert!((found - expected).abs() <= most, "{place}: {found:.5} instead of {key} {expected}");
            1
        };
        let most = match case["class"].as_str() {
            Some("sound") => 0.005,
            Some("fair") => 0.02,
            _ => 0.01,
        };
        let rings = RINGING.contains(&(file, s as i32));
        compared[0] += within(cubic, "z_first_touch", if rings { 0.015 } else { CUBIC });
        compared[1] += within(monotone, "z_first_touch", most);
        compared[2] += within(monotone, "z_first_touch_monotone", BRUTE);
    }
    assert_eq!(compared, [87, 87, 49]);
    Ok(())
}

#[test]
fn what_is_doubtful_is_warned_of() {
    let own = repository("examples/crossing");
    let folder = tempfile::tempdir().unwrap();
    let list = std::fs::read_to_string(own.join("crossing.slcs")).unwrap();
    let list = list.replace("   1              method", "   2              method");
    let list = list.replace("'slice_", &format!("'{}/slice_", own.display()));
    std::fs::write(folder.path().join("crossing.slcs"), list).unwrap();
    let text = std::fs::read_to_string(own.join("crossing.toml")).unwrap();
    let text =
        text.replace("radius = 460.0", "radius = 46.0").replace("lateral = 0.0", "lateral = 0.0\nyaw = 0.3");
    let warnings = scene::march(&scene::parse(&text, false).unwrap(), folder.path()).unwrap().warnings;
    for part in ["wheelset: yaw", "wheel: radius", "an approximating spline"] {
        assert!(warnings.iter().any(|warning| warning.contains(part)), "{part}: {warnings:?}");
    }
    let warnings = scene::march(&scene::load(&own.join("crossing.toml")).unwrap(), &own).unwrap().warnings;
    assert!(warnings.is_empty(), "{warnings:?}");
}

//! Wheels that vary around their axle: closed forms, brute force in space, and CONTACT's results.

use crate::common::repository;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde_json::Value;
use wheelrail::error::Result;
use wheelrail::internal::Random;
use wheelrail::lofted::{Flat, Joining, LoftSlice, LoftedWheel};
use wheelrail::nalgebra;
use wheelrail::placement::{Track, Wheelset};
use wheelrail::profile::Section;
use wheelrail::scene;
use wheelrail::search::{
    EventKind, LoftedPair, March, ONE_CONTACT, Position, Roll, Selection, SideOnTrack, Stop, TrackSide,
    WheelsetOnTrack,
};
use wheelrail::{
    Arc as Segments, Half, Pair, Profile, RailDistance, Segment, Side, WheelDistance, standards,
};

use super::campaign::scenes;

/// Distance of the profile origins \[mm\].
const SPACING: f64 = 1500.0;
pub(super) const RADIUS: f64 = 460.0;

/// A march of the same wheel on the same rail on both sides.
pub(super) fn turning(wheel: &LoftedWheel, rail: &Profile, position: Position, within: f64) -> Result<March> {
    let pair = Arc::new(LoftedPair::turning(wheel, rail)?);
    let axle = Wheelset::new(WheelDistance::Spacing(SPACING), RADIUS)?;
    let side = SideOnTrack::lofted(pair, Track::new(rail, RailDistance::Spacing(SPACING))?, axle);
    let selection = Selection { within, apart: ONE_CONTACT };
    let reach = wheelrail::Interval::ALL;
    Ok(March { system: WheelsetOnTrack::symmetrical(side), position, selection, reach, pitch: 0.0 })
}

pub(super) fn position(lateral: f64, yaw: f64, roll: f64) -> Position {
    Position { lateral, yaw, roll: Roll::Fixed(roll) }
}

/// A profile of one line.
fn line(half: f64) -> Result<Profile> {
    Profile::new("line", "", vec![Segment::arc(Segments::line([-half, 0.0], [half, 0.0])?)])
}

pub(super) fn crown() -> Result<Profile> {
    let arc = Segments::about([0.0, -300.0], 300.0, Half::Upper, [-30.0, 30.0])?;
    Profile::new("crown", "", vec![Segment::arc(arc)])
}

pub(super) fn of_right(stop: &Stop) -> Result<wheelrail::search::SweepRow> {
    let row = stop.rows.iter().find(|row| row.side == TrackSide::Right);
    Ok(*row.unwrap_or_else(|| panic!("no contact at {}", stop.along)))
}

#[test]
fn a_radius_that_does_not_vary_is_a_wheel_under_any_yaw_roll_and_pitch() -> Result<()> {
    // The second wheel has kinks.
    [("S1002", 0.5), ("EN15302-A", 0.0)].into_iter().try_for_each(|(name, deviation)| {
        let (wheel, rail) = (standards::wheel(name)?, standards::rail("60E1")?);
        // A deviation of all radii is another radius.
        let lofted = LoftedWheel::out_of_round(&wheel, RADIUS, &[[-2.0, deviation], [1.0, deviation]])?;
        let mut march = turning(&lofted, &rail, position(0.0, 0.0, 0.0), 0.0)?;
        let pair = Pair::new(rail, wheel, RADIUS + deviation)?;
        let (rails, wheels) = (RailDistance::Spacing(SPACING), WheelDistance::Spacing(SPACING));
        let system = WheelsetOnTrack::new(&pair, rails, wheels)?;
        let mut search = system.search();
        let mut random = Random::new(340);
        for _ in 0..scenes() {
            let (lateral, yaw) = (random.between(-9.0, 9.0), random.between(-0.03, 0.03));
            let at = position(lateral, yaw, random.between(-0.005, 0.005));
            march.position = at;
            let touch = search.touch(&at, &march.selection)?;
            let stop = march.turned(random.between(-7.0, 7.0))?;
            for (row, side) in stop.rows.iter().zip(touch.sides) {
                let swept = side.touch.contacts[0];
                let place = format!("{name} {at:?}: {row:?} instead of {swept:?}");
                let apart = row.z - side.z - deviation;
                assert!(apart.abs() < 1e-10, "{place} {apart}");
                assert!((row.contact.contact_angle - swept.contact_angle).abs() < 1e-3, "{place}");
                assert!((row.contact.wheel_angle - swept.wheel_angle).abs() < 1e-3, "{place}");
                assert!((row.contact.rolling_radius - swept.rolling_radius).abs() < 0.02, "{place}");
                assert!((row.contact.skew - swept.skew).abs() < 1e-4, "{place}");
                assert!((row.contact.y - swept.y).abs() < 0.05 && row.contact.turn == 0.0, "{place}");
            }
        }
        Ok(())
    })
}

/// Height of the axle less R over a flat of this chord and edge radius \[mm\], whose middle is at an angle from the lowest meridian: the
/// support function of a circle, a chord and the circles of its edges.
fn lowered(length: f64, edge: f64, angle: f64) -> f64 {
    let away = (angle + std::f64::consts::PI).rem_euclid(std::f64::consts::TAU) - std::f64::consts::PI;
    let chord = (RADIUS * RADIUS - length * length / 4.0).sqrt();
    let end = ((chord - edge) / (RADIUS - edge)).acos();
    if away.abs() >= end { 0.0 } else { (RADIUS - edge) * ((end - away.abs()).cos() - 1.0) }
}

#[test]
fn a_chord_with_edges_lowers_a_cylinder_by_its_support_function() -> Result<()> {
    let cylinder = line(60.0)?;
    for (length, angle, edge) in [(60.0, 0.0, 0.0), (60.0, 3.0, 40.0), (20.0, -1.0, 1.0), (200.0, 6.0, 0.0)] {
        let wheel = LoftedWheel::with_flat(&cylinder, RADIUS, &Flat { length, angle, edge_radius: edge })?;
        // On a plane they touch along a line, and on the flat all over.
        for rail in [crown()?, line(2.0)?] {
            let march = turning(&wheel, &rail, position(0.0, 0.0, 0.0), 0.0)?;
            let half = (length / 2.0 / RADIUS).asin();
            let near = [0.0, -0.7, 1.0, 1.05].map(|share| share * half);
            for at in near.into_iter().chain((-12..12).map(|k| 0.26 * f64::from(k) + 0.01)) {
                let stop = march.turned(at - angle)?;
                let (z, expected) = (of_right(&stop)?.z, lowered(length, edge, at));
                assert!((z - expected).abs() < 1e-9, "{length} {edge} at {at}: {z} {expected}");
            }
        }
    }
    Ok(())
}

#[test]
fn a_polygon_of_waves_has_the_height_of_its_radii() -> Result<()> {
    // On a crown the lowest point of cos(nφ) waves lies at a crest, and in a trough beside it.
    let rows: Vec<[f64; 2]> =
        (0..360).map(|k| f64::from(k).to_radians()).map(|a| [a, 0.3 * (6.0 * a).cos()]).collect();
    let wheel = LoftedWheel::out_of_round(&line(60.0)?, RADIUS, &rows)?;
    let march = turning(&wheel, &crown()?, position(0.0, 0.0, 0.0), 0.0)?;
    for pitch in [0.0, 0.1, -0.27, 1.9, 4.0] {
        let radius = |a: f64| RADIUS + 0.3 * (6.0 * a).cos();
        let height = (-200_000..=200_000).map(|k| f64::from(k) * 1e-6).map(|w| radius(w - pitch) * w.cos());
        let expected = height.fold(0.0, f64::max) - RADIUS;
        let z = of_right(&march.turned(pitch)?)?.z;
        assert!((z - expected).abs() < 1e-6, "{pitch}: {z} {expected}");
    }
    Ok(())
}

#[test]
fn a_wheel_on_a_flat_goes_over_from_edge_to_edge_once() -> Result<()> {
    let (profile, rail) = (standards::wheel("S1002")?, standards::rail("60E1")?);
    // A whole turn; at an offset of 0 one stop lies on the flat all over.
    for (edge_radius, offset) in [(0.0, 0.0), (0.0, 0.003), (20.0, 0.0), (20.0, 0.007)] {
        let flat = Flat { length: 60.0, angle: 0.5, edge_radius };
        let wheel = LoftedWheel::with_flat(&profile, RADIUS, &flat)?;
        let march = turning(&wheel, &rail, position(0.0, 0.0, 0.0), 0.0)?;
        let pitches: Vec<f64> = (-20..=44).map(|k| 0.1 * f64::from(k) + offset).collect();
        let (mut stops, mut events) = (0, Vec::new());
        march.turns(&pitches, |own, found| {
            stops += own.len();
            events.extend_from_slice(found);
            Ok(true)
        })?;
        let over: Vec<_> = events.iter().filter(|event| event.side == TrackSide::Right).collect();
        let [over] = over.as_slice() else { panic!("{edge_radius} {offset}: {over:?}") };
        assert_eq!((stops, over.kind, events.len()), (65, EventKind::Transfer, 2));
        assert!((over.along + 0.5).abs() < 0.01 / RADIUS, "{over:?}");
        let [before, after] = [over.before, over.after].map(|contact| contact.expect("a contact"));
        if edge_radius == 0.0 {
            // The tread's contact lies 1.2 mm farther out than R, and so do its edges; the wheel strikes by the angle of its chord.
            let share = before.rolling_radius / RADIUS;
            assert!(
                (before.y - 30.0 * share).abs() < 0.01 && (after.y + 30.0 * share).abs() < 0.01,
                "{over:?}"
            );
            assert!((over.impact_angle() - 2.0 * (30.0f64 / RADIUS).atan()).abs() < 1e-4, "{over:?}");
            assert!(!before.rail_kink, "{before:?}");
        }
        assert!(before.y > 25.0 && after.y < -25.0, "{over:?}");
    }
    Ok(())
}

/// Least vertical gap of points of a wheel's surface over a rail: every fifth of a millimetre around it, and every tenth across.
fn brute(
    wheel: &[[f64; 2]],
    rail: &Section,
    share: impl Fn(f64) -> f64,
    origin: [f64; 2],
    at: &Position,
) -> f64 {
    let Roll::Fixed(roll) = at.roll else { panic!("a roll") };
    let rotation = at.rotation(roll);
    let mut least = f64::INFINITY;
    for step in -400..=400 {
        let angle = 0.2 * f64::from(step) / RADIUS;
        let (sin, cos) = angle.sin_cos();
        for [x, z] in wheel {
            let rolling = share(angle) * (RADIUS - z);
            let p = rotation * nalgebra::Vector3::new(*x, rolling * sin, -rolling * cos);
            let height = rail.height(p.x + origin[0]);
            let gap = p.z + origin[1] - height;
            least = if gap.is_nan() { least } else { least.min(gap) };
        }
    }
    least
}

#[test]
fn no_place_of_a_wheel_is_lower_than_first_touch() -> Result<()> {
    let (profile, rail) = (standards::wheel("S1002")?, standards::rail("60E1")?);
    let section = Section::own_axes(&profile, Side::Wheel);
    let below = Section::own_axes(&rail, Side::Rail);
    let polygon: Vec<[f64; 2]> = (-690..=640)
        .map(|k| 0.1 * f64::from(k))
        .map(|x| [x, section.height(x)])
        .filter(|point| point[1].is_finite())
        .collect();
    let (length, turned) = (70.0, 0.4);
    let wheel = LoftedWheel::with_flat(&profile, RADIUS, &Flat { length, angle: turned, edge_radius: 0.0 })?;
    let half = (length / 2.0 / RADIUS).asin();
    // Every circle of the profile has the same chord.
    let share = |angle: f64| if angle.abs() < half { half.cos() / angle.cos() } else { 1.0 };
    let mut march = turning(&wheel, &rail, position(0.0, 0.0, 0.0), 0.0)?;
    let mut random = Random::new(342);
    let top = Track::new(&rail, RailDistance::Spacing(SPACING))?;
    for _ in 0..scenes().div_ceil(4) {
        let (lateral, yaw, roll) =
            (random.between(-9.0, 9.0), random.between(-0.02, 0.02), random.between(-0.002, 0.002));
        let away = random.between(-0.1, 0.1);
        march.position = position(lateral, yaw, roll);
        let found = of_right(&march.turned(away - turned)?)?;
        // The axle's middle at the height R over the top of rail: the wheel's centre SPACING/2 out along the axle.
        let centre = march.position.rotation(roll) * nalgebra::Vector3::new(SPACING / 2.0, 0.0, 0.0);
        let origin = [centre.x + lateral - top.rail_x(), centre.z + RADIUS - top.rail_z()];
        let expected = -brute(&polygon, &below, |angle| share(angle - away), origin, &march.position);
        let place = format!("{:?} at {away}: {} and {expected} {found:?}", march.position, found.z);
        // An edge may be missed by a tenth of a millimetre, of a slope of 35/460.
        assert!(found.z >= expected - 1e-6 && found.z < expected + 0.01, "{place}");
    }
    Ok(())
}

/// A march of a scene of text, in a folder.
fn scene_of(text: &str, folder: &Path) -> Result<(March, Vec<String>)> {
    scene::march(&scene::parse(text, false)?, folder).map(|found| (found.march, found.warnings))
}

const REST: &str = "[rail]\nprofile = \"60E1\"\n[track]\nspacing = 1500.0\n[wheelset]\nspacing = 1500.0\nroll = \"neglect\"\n";

#[test]
fn a_list_of_slices_around_a_wheel_is_the_wheel_of_its_radii() -> Result<()> {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let slice = |name: &str, z: f64| {
        let text = format!(
            "segments = [{{ line = {{ from = [-60.0, {}], to = [-10.0, {}] }} }}, \
             {{ line = {{ from = [-10.0, {}], to = [60.0, {}] }} }}]\n",
            z + 5.0,
            z,
            z,
            z - 3.5
        );
        std::fs::write(here.join(name), text).unwrap();
    };
    // Features count from the field side: the kink is 70.09 mm from there.
    let (deviations, mut list) = ([0.0, -0.2, 0.1, 0.05], String::from("0 1\n4\n3\n1\n"));
    let kink = 70.0f64.hypot(3.5);
    let angles = [-2.0, -0.5, 0.7, 2.5];
    for (k, deviation) in deviations.iter().enumerate() {
        slice(&format!("{k}.toml"), -deviation);
        list += &format!("{} '{k}.toml'\n", angles[k]);
    }
    for angle in angles {
        list += &format!("{angle} 0.0 {kink} 999.0\n");
    }
    std::fs::write(here.join("wheel.slcw"), list).unwrap();
    let wheel = "[wheel]\nradius = 460.0\n";
    let (listed, warnings) =
        scene_of(&format!("{wheel}file = \"wheel.slcw\"\nsurface = \"cubic\"\n{REST}"), here)?;
    assert!(warnings.is_empty(), "{warnings:?}");
    let rows: Vec<[f64; 2]> = angles.into_iter().zip(deviations).map(|(a, b)| [a, b]).collect();
    let (round, _) = scene_of(&format!("{wheel}file = \"0.toml\"\nradii = {rows:?}\n{REST}"), here)?;
    for pitch in [-3.0, -1.7, -0.2, 0.0, 0.5, 1.1, 2.8] {
        let [a, b] = [of_right(&listed.turned(pitch)?)?, of_right(&round.turned(pitch)?)?];
        assert!((a.z - b.z).abs() < 1e-9 && (a.contact.y - b.contact.y).abs() < 1e-4, "{pitch}: {a:?} {b:?}");
    }
    // At a slice the deviation of its radius counts, but for what its slope takes.
    let z = of_right(&listed.turned(2.0)?)?.z - of_right(&listed.turned(0.5)?)?.z;
    assert!((z - 0.2).abs() < 2e-3, "{z}");
    Ok(())
}

fn slice_of(at: f64) -> Result<LoftSlice> {
    let (name, profile) = (format!("at {at}"), line(60.0)?);
    Ok(LoftSlice { at, name, profile, features: Vec::new(), measured_along: None })
}

#[test]
fn wheels_that_make_no_surface_are_refused_by_the_key() -> Result<()> {
    let here = tempfile::tempdir().unwrap();
    std::fs::write(here.path().join("one.slcw"), "0 1\n1\n0\n1\n0 'a.toml'\n").unwrap();
    std::fs::write(
        here.path().join("a.toml"),
        "segments = [{ line = { from = [-60.0, 0.0], to = [60.0, 0.0] } }]\n",
    )
    .unwrap();
    let wheel = "[wheel]\nprofile = \"S1002\"\nradius = 460.0\n";
    for (keys, part) in [
        (
            "flat = { length = 920.0 }",
            "wheel: flat: length: found 920 mm; expected from 0.01 mm to less than the diameter of 920",
        ),
        ("flat = { length = -1.0 }", "wheel: flat: length: found -1 mm"),
        ("flat = { length = 60.0, edge_radius = 460.0 }", "wheel: flat: edge_radius: found 460 mm"),
        ("flat = { length = 60.0, angle = nan }", "wheel: flat: angle"),
        (
            "flat = { length = 60.0, angle = 90.0 }",
            "wheel: flat: angle: found 90 rad; expected an angle around the wheel within ±2π rad; give it in rad",
        ),
        ("radii = [[0.0, 0.1]]", "wheel: radii: found 1 rows"),
        (
            "radii = [[0.0, 0.1], [1.0, 0.0], [0.5, 0.0]]",
            "wheel: radii: row 3: found 0.5 rad after 1 rad; expected ascending",
        ),
        (
            "radii = [[0.0, 0.1], [180.0, 0.0]]",
            "wheel: radii: found angles from 0 to 180 rad; expected less than a turn",
        ),
        ("radii = [[0.0, 0.1], [1.0, 460.1]]", "wheel: radii: row 2: found 460.1 mm; expected a deviation"),
        (
            "radii = [[0.0, 0.1], [1.0, 0.1]]\nflat = { length = 60.0 }",
            "wheel: found `flat` and `radii`; expected one of the two",
        ),
        ("flat = { length = 60.0 }\nsurface = \"cubic\"", "wheel: surface: found an option without effect"),
    ] {
        let error = scene_of(&format!("{wheel}{keys}\n{REST}"), here.path()).unwrap_err().to_string();
        assert!(error.starts_with(part), "{keys}: {error}");
    }
    let a = slice_of(1.0)?;
    let error =
        LoftedWheel::new(&[a.clone(), slice_of(0.5)?], RADIUS, Joining::Monotone).unwrap_err().to_string();
    assert!(error.starts_with("at 0.5: found a section at 0.5 rad after one at 1 rad"), "{error}");
    let error = LoftedWheel::new(&[a, slice_of(8.0)?], RADIUS, Joining::Monotone).unwrap_err().to_string();
    assert!(error.starts_with("at 8: found sections from 1 to 8 rad"), "{error}");
    let small = format!("{}flat = {{ length = 1.0 }}\n{REST}", wheel.replace("460.0", "2.0"));
    let error = scene_of(&small, here.path()).unwrap_err().to_string();
    assert!(error.starts_with("wheel: profile: found a surface up to z = "), "{error}");
    let negative = small.replace("2.0", "-460.0");
    let error = scene_of(&negative, here.path()).unwrap_err().to_string();
    assert!(error.starts_with("wheel: radius: found -460 mm; expected a positive length in mm"), "{error}");
    let error = scene_of(&format!("[wheel]\nradius = 460.0\nfile = \"one.slcw\"\n{REST}"), here.path());
    let error = error.unwrap_err().to_string();
    assert!(error.contains("slices: found 1 slice; expected two slices or more"), "{error}");
    let (march, _) = scene_of(&format!("{wheel}flat = {{ length = 60.0 }}\n{REST}"), here.path()).unwrap();
    let error = march.at(0.0).unwrap_err().to_string();
    assert!(error.starts_with("rail: found rails of one profile each"), "{error}");
    let error = march.turned(f64::NAN).unwrap_err().to_string();
    assert!(error.starts_with("angle: found NaN rad"), "{error}");
    let pitched = REST.replace("roll", "pitch = 0.1\nroll");
    let error = scene_of(&format!("{wheel}{pitched}"), here.path()).unwrap_err().to_string();
    assert!(error.starts_with("rail: found rails of one profile each"), "{error}");
    let pitched =
        scene_of(&format!("{wheel}flat = {{ length = 60.0 }}\n{pitched}"), here.path())?.0.turned(0.0);
    let error = pitched.unwrap_err().to_string();
    assert!(
        error.starts_with("wheelset: pitch: found 0.1 rad; expected no pitch of a march around"),
        "{error}"
    );
    Ok(())
}

/// The cases of a group of the reference file.
pub(super) fn cases(group: &str) -> Vec<Value> {
    let path = repository("tests/reference_along/along_track.json");
    let file: Value = serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap();
    file["cases"].as_array().unwrap().iter().filter(|case| case["group"] == group).cloned().collect()
}

#[test]
fn heights_on_flats_are_contact_s() -> Result<()> {
    let Some(copy) = std::env::var_os("WHEELRAIL_CONTACT").map(PathBuf::from) else { return Ok(()) };
    let flats = [
        (
            "rounded_flat_d09",
            "testbank/profiles",
            "[rail]\nfile = \"circ_r300.prr\"\ncurve = \"interpolation\"\n\
             [wheel]\nfile = \"flat_d09.slcw\"\nradius = 450.0\ncurve = \"interpolation\"\nmirror = false\nflip_z = true\n\
             [track]\nspacing = 1500.0\n[wheelset]\nspacing = 1500.0\nroll = 0.0\n",
            0.01,
        ),
        (
            "chalmers_flat_fz125",
            "examples",
            "[rail]\nfile = \"r300_wide.prr\"\ncurve = \"interpolation\"\nrotate = 0.02\n\
             [wheel]\nfile = \"S1002_flat.slcw\"\nradius = 490.0\ncurve = \"interpolation\"\n\
             [track]\ngauge = 1435.0\n[wheelset]\nback_to_back = 1360.0\nflange_back_x = -70.0\nroll = 0.0\n",
            0.02,
        ),
    ];
    for (group, folder, text, most) in flats {
        let (march, _) = scene_of(text, &copy.join(folder))?;
        for case in cases(group) {
            let [pitch, expected] = ["pitch", "z_first_touch"].map(|key| case[key].as_f64().unwrap());
            let stop = march.turned(pitch)?;
            let found = of_right(&stop)?;
            // z is up here and down in CONTACT.
            assert!((-found.z - expected).abs() <= most, "{group} at {pitch}: {} {expected}", -found.z);
        }
    }
    Ok(())
}

/// A radius that does not vary is the plain wheel of any built-in profile under any yaw: a place is a kink where it is one there, and
/// Hertz's form of the gap is the same. Where the radius varies, no place is a kink that is none on the plain wheel nearby.
#[test]
fn wheels_that_vary_or_not_have_the_kinds_of_contact_of_plain_ones() -> Result<()> {
    let mut random = Random::new(6515);
    let rails: Vec<&str> = standards::rail_names().collect();
    let wheels: Vec<&str> = standards::wheel_names().collect();
    let defect = scene::load(&repository("tests/defects/kink-on-varying-wheel.toml"))?;
    let placed = wheelrail::case::contacts(&scene::resolve(&defect, Path::new("."), "kink")?)?;
    let curvatures = wheelrail::load::curvatures(&placed[0].1);
    assert!(curvatures.a_per_mm > 0.0 && curvatures.b_per_mm > 0.0, "{curvatures:?}");
    let (mut smooth, mut compared) = (0, 0);
    for number in 0..scenes() {
        let (rail, wheel, offset) = (*random.pick(&rails), *random.pick(&wheels), random.between(-6.0, 6.0));
        let (radii, yaw) = (random.between(0.3, 2.0), *random.pick(&[0.0, 0.01, -0.03]));
        // At −radii and radii, from 0 in the middle.
        let deviation = if number % 4 == 3 { random.between(-0.4, 0.4) } else { 0.0 };
        let placed = |radii: &str| {
            let text = format!(
                "rail = {{ profile = {rail:?}, rotate = \"1:40\" }}\n\
                 wheel = {{ profile = {wheel:?}, radius = {RADIUS:?}{radii} }}\n\
                 contact = {{ offset = {offset:?}, yaw = {yaw:?} }}\npatch = {{ approach = 0.05 }}\n"
            );
            let case = scene::resolve(&scene::parse(&text, false)?, Path::new("."), "plain")?;
            Ok::<_, wheelrail::Error>(wheelrail::case::contacts(&case)?.swap_remove(0).1)
        };
        let radii =
            format!(", radii = [[-{radii:?}, {deviation:?}], [0.0, 0.0], [{radii:?}, {deviation:?}]]");
        let (plain, varying) = (placed("")?, placed(&radii)?);
        let place =
            format!("{number}: {rail} under {wheel}, offset {offset}, yaw {yaw}, deviation {deviation}");
        let x = |placement: &wheelrail::Placement| placement.rail().point().station.x;
        if (x(&plain) - x(&varying)).abs() > 1e-3 {
            // Two places as low as each other, one of a stretch, or moved by the deviation.
            continue;
        }
        compared += 1;
        let is_smooth = |placement: &wheelrail::Placement| {
            [placement.rail(), placement.wheel()].map(wheelrail::placement::Body::is_smooth)
        };
        assert_eq!(is_smooth(&plain), is_smooth(&varying), "{place}");
        let [own, other] = [&plain, &varying].map(wheelrail::load::curvatures);
        assert_eq!(own.a_per_mm.is_nan(), other.a_per_mm.is_nan(), "{place}: {own:?} {other:?}");
        if own.a_per_mm.is_nan() || deviation != 0.0 {
            continue;
        }
        smooth += 1;
        let close = |a: f64, b: f64| (a - b).abs() < 1e-6 * own.b_per_mm.abs().max(1e-3);
        assert!(
            close(own.a_per_mm, other.a_per_mm) && close(own.b_per_mm, other.b_per_mm),
            "{place}: {own:?} {other:?}"
        );
    }
    assert!(2 * compared > scenes() && 3 * smooth > scenes(), "{smooth} smooth of {compared}");
    Ok(())
}

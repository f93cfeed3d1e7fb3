//! Rails that vary along the track: closed forms, brute force in space, and CONTACT's results.

use std::path::{Path, PathBuf};

use serde_json::Value;
use wheelrail::error::Result;
use wheelrail::scene::{self, Scene};
use wheelrail::search::{March, TrackSide};

/// The cases of the reference file, one group after another.
fn cases() -> Vec<Value> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/reference_along/along_track.json");
    let file: Value = serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap();
    file["cases"].as_array().unwrap().clone()
}

/// A march of a case over the profiles of a copy of CONTACT.
fn march_of(profiles: &Path, case: &Value, surface: &str) -> Result<March> {
    let rail = case["rail"].as_str().unwrap();
    let wheel = case["wheel"].as_str().unwrap();
    let metres = if rail.starts_with("uk_") { "unit = \"m\"\nflip_z = true\nmirror = false" } else { "" };
    let [lateral, yaw, roll] = ["y", "yaw", "roll"].map(|key| case[key].as_f64().unwrap());
    let text = format!(
        "[rail]\nfile = {rail:?}\nsurface = {surface:?}\ncurve = \"interpolation\"\n{metres}\n\
         [wheel]\nfile = {wheel:?}\ncurve = \"interpolation\"\nradius = 460.0\n\
         [track]\nspacing = 1500.0\n\
         [wheelset]\nback_to_back = 1360.0\nflange_back_x = -70.0\nlateral = {lateral}\nyaw = {yaw}\nroll = {roll:?}\n"
    );
    let scene: Scene = scene::parse(&text, false)?;
    scene::march(&scene, profiles).map(|(march, _)| march)
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
            last = Some((file.into(), [march_of(&profiles, &case, "monotone")?, march_of(&profiles, &case, "cubic")?]));
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

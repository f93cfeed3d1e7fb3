//! What is possible but seldom meant is a warning with its number; what engineers mean is none.

use crate::common::repository;
use std::path::{Path, PathBuf};

use wheelrail::case::{DoubtKind, Landmarks, Run, SILENT, SideLandmarks};
use wheelrail::internal::Random;
use wheelrail::placement::{Pair, RailDistance, WheelDistance};
use wheelrail::profile::{Profile, inclination, standards, trace};
use wheelrail::search::{ONE_CONTACT, Position, Roll, Selection, Sweep, SweepRow, WheelsetOnTrack};
use wheelrail::{Result, scene};

use crate::campaign;

/// Returns the warnings of a scene.
fn warnings(text: &str, folder: &Path) -> Result<Vec<String>> {
    let case = scene::resolve(&scene::parse(text, false)?, folder, "doubts")?;
    Ok(Run::new(case, SILENT)?.warnings())
}

fn pair(rail: &str, wheel: &str, rest: &str) -> String {
    format!(
        "[rail]\nprofile = \"60E1\"\n{rail}\n[wheel]\nprofile = \"S1002\"\nradius = 460.0\n{wheel}\n{rest}\n[output]\nformats = []\n"
    )
}

#[test]
fn slips_are_spoken_of_with_their_number() -> Result<()> {
    let touching = "[contact]\noffset = 0.0\n[patch]\napproach = 0.05";
    let cases = [
        (pair("rotate = 0.25", "", touching), "rail: rotate: 0.25 rad is 14.3 degrees"),
        (pair("", "", "[contact]\noffset = 0.0\n[patch]\nload = 80.0"), "patch: load: 80 N is the weight of 8.2 kg"),
        (
            pair("", "", &format!("{touching}\n[material]\nrail_youngs_modulus = 210.0")),
            "material: rail_youngs_modulus: 2.1e2 N/mm² is no metal's: steel has 2.1e5; it looks like GPa",
        ),
        (
            pair("", "", "[contact]\nrail_x = -20.0\nwheel_x = 0.0\n[patch]\napproach = 0.05"),
            "contact: the tangents at rail_x and wheel_x differ by 7.07",
        ),
        (pair("", "", "[contact]\noffset = 0.0\n[patch]\napproach = 1.5"), "an approach of 1.5000 mm: wheels and rails"),
        (pair("", "", "[contact]\noffset = 60.0\n[patch]\napproach = 0.05"), "stands on the tip of its flange"),
        (pair("", "shift = [0.0, 20.0]", touching), "the rolling radius, 441."),
        (
            pair("", "", touching).replace(
                "profile = \"60E1\"",
                "segments = [{ line = { from = [-40.0, -8.0], to = [0.0, 0.0] } }, { line = { from = [0.0, 0.0], to = [40.0, -2.0] } }]",
            ),
            "rail: segments 1 and 2 meet at x = 0.000 mm with a kink of -14.2 degrees",
        ),
    ];
    for (text, expected) in cases {
        let found = warnings(&text, Path::new("."))?;
        assert!(found.iter().any(|warning| warning.contains(expected)), "{expected}: {found:?}");
    }
    Ok(())
}

#[test]
fn a_wheel_drawn_in_a_file_has_its_kinks_named_with_a_flat_as_without() -> Result<()> {
    let folder = tempfile::tempdir().unwrap();
    let line =
        |from: [f64; 2], to: [f64; 2]| format!("[[segments]]\nline = {{ from = {from:?}, to = {to:?} }}\n");
    let chain = line([-60.0, 30.0], [0.0, 0.0]) + &line([0.0, 0.0], [60.0, 3.0]);
    std::fs::write(folder.path().join("drawn.toml"), chain).unwrap();
    for flat in ["", "flat = { length = 40.0, angle = 0.0 }"] {
        let text = pair("", flat, "[contact]\noffset = 0.0\n[patch]\napproach = 0.05");
        let found = warnings(&text.replace("profile = \"S1002\"", "file = \"drawn.toml\""), folder.path())?;
        let expected = "wheel: segments 1 and 2 meet at x = 0.000 mm with a kink of";
        assert!(found.iter().any(|warning| warning.contains(expected)), "{flat}: {found:?}");
    }
    Ok(())
}

/// A wheelset of S1002 wheels on 60E1 rails with other numbers.
fn wheelset(was: &str, is: &str) -> String {
    let track = "[track]\ngauge = 1435.0\ngauge_height = 14.0\n[wheelset]\nback_to_back = 1360.0\nflange_back_x = -70.0\n\
                 lateral = 0.0\n[patch]\nload = 60000.0\n[motion]\nspeed = 30.0";
    let text = pair("rotate = \"1:40\"", "", track);
    assert!(text.contains(was), "{was}");
    text.replace(was, is)
}

#[test]
fn wrong_units_signs_and_origins_are_spoken_of_with_their_number() -> Result<()> {
    assert_eq!(warnings(&wheelset("60E1", "60E1"), Path::new("."))?, [""; 0]);
    let cases = [
        (
            "radius = 460.0",
            "radius = 18.0",
            "wheel: radius: 18 mm is no railway wheel's, 457.2 mm in inches: R is half",
        ),
        (
            "radius = 460.0",
            "radius = 920.0",
            "wheel: radius: 920 mm is no railway wheel's, 460.0 mm as a diameter",
        ),
        ("radius = 460.0", "radius = 46.0", "584.2 mm as a diameter in inches, 460.0 mm in cm"),
        (
            "1435.0",
            "1524.0",
            "track: gauge: 1524 mm is 164 mm more than wheelset: back_to_back: gauge and back_to_back of one",
        ),
        ("1435.0", "1524.0", "the wheel touches 91."),
        ("1435.0", "1360.0", "track: gauge: 1360 mm is 0 mm more than"),
        (
            "-70.0",
            "0.0",
            "wheelset: flange_back_x: 0 mm, and the back of wheel is at x = -70.0 mm: measured profiles have",
        ),
        ("-70.0", "-0.07", "wheelset: flange_back_x: -0.07 mm, and"),
        (
            "\"1:40\"",
            "\"-1:40\"",
            "rail: rotate: -0.0250 rad inclines the rail away from the middle of the track",
        ),
        ("\"1:40\"", "-0.05", "rail: rotate: -0.0500 rad inclines the rail away"),
        (
            "gauge_height = 14.0",
            "gauge_height = 0.014",
            "track: gauge_height: 0.014 mm below the top of rail: the gauge is",
        ),
        ("speed = 30.0", "speed = 120.0", "motion: speed: 120 m/s is 432 km/h: speeds are in m/s"),
        ("radius = 460.0", "radius = 460.0\nmirror = true", "wheel: the tip of its flange is at x = 5"),
        ("radius = 460.0", "radius = 460.0\nshift = [0.0, 23.0]", "the rolling radius, 436."),
        (
            "radius = 460.0",
            "radius = 460.0\nshift = [70.0, 40.0]",
            "the wheel stands on the tip of its flange",
        ),
        (
            "load = 60000.0",
            "approach = 8e-5",
            "an approach of 8e-5 mm, which would be 0.08 mm if it were in m: wheels",
        ),
        ("lateral = 0.0", "lateral = 10.0", "the wheel's tread is"),
    ];
    for (was, is, expected) in cases {
        let found = warnings(&wheelset(was, is), Path::new("."))?;
        assert!(found.iter().any(|warning| warning.contains(expected)), "{is}: {expected}: {found:?}");
    }
    // What ends in an error names the slip first.
    let error = warnings(&wheelset("-70.0", "70.0"), Path::new(".")).err().map(|error| error.to_string());
    let expected = "no contact; expected wheels over their rails";
    let error = error.unwrap_or_default();
    assert!(
        error.contains(expected) && error.contains("; wheelset: flange_back_x: 70 mm, and the back"),
        "{error}"
    );
    Ok(())
}

/// The rails of main lines: those whose names begin with such a mass, or with letters.
fn main_line_rails() -> impl Iterator<Item = &'static str> {
    let mass = |name: &str| name.chars().take_while(char::is_ascii_digit).collect::<String>().parse().ok();
    standards::rail_names().filter(move |name| mass(name).is_none_or(|mass: u32| mass >= MAIN_LINES))
}

/// Least mass of a rail by its name \[kg/m\]: 7 mm aside, the wide flanges of APTA climb the narrow heads of lighter ones.
const MAIN_LINES: u32 = 46;

/// Standard wheels on rails of main lines; those of APTA have their origin at the gauge point.
fn standard_pairs() -> Result<Vec<(Pair, f64)>> {
    let mut out = Vec::new();
    for (rail, wheel) in main_line_rails().flat_map(|rail| standards::wheel_names().map(move |w| (rail, w))) {
        let apta = wheel.starts_with("APTA");
        let profile = standards::wheel(wheel)?.shifted(0.0, if apta { -15.875 } else { 0.0 });
        let n = if out.len().is_multiple_of(2) { 20.0 } else { 40.0 };
        let back = profile.segments()[0].start().x.max(-70.0);
        let rail = standards::rail(rail)?.rotated(inclination(1.0, n)?);
        out.push((Pair::new(rail, profile, 460.0)?, if wheel.starts_with("cone") { -70.0 } else { back }));
    }
    Ok(out)
}

fn on_track((pair, back): &(Pair, f64)) -> Result<WheelsetOnTrack> {
    let rails = RailDistance::Gauge { gauge: 1435.0, height: 14.0 };
    WheelsetOnTrack::new(pair, rails, WheelDistance::BackToBack { distance: 1360.0, flange_back_x: *back })
}

fn rows(system: &WheelsetOnTrack, lateral: f64, roll: Roll) -> Result<Vec<SweepRow>> {
    let selection = Selection { within: 0.0, apart: ONE_CONTACT };
    let mut out = Vec::new();
    Sweep::new(system, selection, None).position(&Position { lateral, yaw: 0.0, roll }, &mut out)?;
    Ok(out)
}

#[test]
fn standard_pairs_in_ordinary_positions_leave_no_doubt() -> Result<()> {
    let pairs = standard_pairs()?;
    assert!(pairs.len() > 300, "{}", pairs.len());
    for own in &pairs {
        let (system, doubts) = (on_track(own)?, SideLandmarks::new(Landmarks::new(&own.0), None));
        for lateral in [-7.0, -6.0, -4.5, -2.0, 0.0, 3.0, 5.0, 6.5] {
            for (row, found) in doubts.of_rows(&rows(&system, lateral, Roll::Solve)?) {
                let names = [own.0.rail(), own.0.wheel()].map(|profile| profile.name.as_str());
                assert_eq!(found.list().count(), 0, "{names:?} at {lateral}: {found:?}, {row:?}");
            }
        }
    }
    Ok(())
}

/// Heights of a profile by points every 0.02 mm: the extreme one at an abscissa, towards `sign`.
fn height(points: &[[f64; 2]], x: f64, sign: f64) -> Option<f64> {
    let at = points.windows(2).filter(|pair| (pair[0][0] - x) * (pair[1][0] - x) <= 0.0).map(|pair| {
        let [a, b] = [pair[0], pair[1]];
        if a[0] == b[0] { a[1] } else { a[1] + (b[1] - a[1]) * (x - a[0]) / (b[0] - a[0]) }
    });
    at.max_by(|a, b| (sign * a).total_cmp(&(sign * b)))
}

/// Lift \[mm\], and whether the wheel stands on tip or back or beyond its tread, by points of both profiles in space, without roll.
fn brute(pair: &Pair, row: &SweepRow) -> (f64, [Option<bool>; 3]) {
    let points = |profile: &Profile| -> Vec<[f64; 2]> {
        trace(profile, 0.02).iter().map(|mark| [mark.station.x, mark.station.z]).collect()
    };
    let (rail, wheel) = (points(pair.rail()), points(pair.wheel()));
    let c = &row.contact;
    let placed: Vec<[f64; 2]> =
        wheel.iter().map(|[x, z]| [c.rail_x + x - c.wheel_x, c.rail_z + z - c.wheel_z]).collect();
    let top = rail.iter().max_by(|a, b| a[1].total_cmp(&b[1])).unwrap();
    let lift = height(&placed, top[0], -1.0).map_or(0.0, |over| over - top[1]);
    let tip = wheel.iter().min_by(|a, b| a[1].total_cmp(&b[1])).unwrap();
    let on_tip = c.wheel_z < tip[1] + 2.0;
    // The tip is found to 0.05 mm: nearer to a limit either answer is right.
    let sure = |value: f64, limit: f64| ((value - limit).abs() > 0.2).then_some(value > limit);
    let far = sure((c.wheel_x - tip[0]).abs(), 90.0);
    (lift, [Some(on_tip), Some(!on_tip && c.wheel_x < tip[0]), far])
}

#[test]
fn doubts_of_sweeps_are_those_of_brute_force() -> Result<()> {
    let pairs = standard_pairs()?;
    let (mut random, mut told) = (Random::new(30), [0; 4]);
    for _ in 0..campaign::scenes() {
        let own = random.pick(&pairs);
        if own.0.wheel().name.starts_with("cone") {
            continue;
        }
        let (system, doubts) = (on_track(own)?, SideLandmarks::new(Landmarks::new(&own.0), None));
        let rows = rows(&system, random.between(-60.0, 60.0), Roll::Neglect)?;
        let lifts: Vec<f64> = rows.iter().map(|row| brute(&own.0, row).0).collect();
        for (k, (row, found)) in doubts.of_rows(&rows).enumerate().filter(|(_, (row, _))| row.number == 0) {
            let other = rows.iter().position(|other| other.number == 0 && other.side != row.side).unwrap();
            let (lift, [tip, back, beyond]) = brute(&own.0, row);
            let lifted = lift > 8.0 && (lifts[k] + lifts[other]) / 2.0 > 8.0;
            let has = |kind| found.list().find(|(own, _)| *own == kind).map(|(_, value)| value);
            // The top of the rail is found to 0.05 mm, over which a flange's face rises by 0.14 mm.
            let near = (lift - 8.0).abs() < 0.2 || (lift + lifts[other] - 16.0).abs() < 0.4;
            assert!(near || has(DoubtKind::Lifted).is_some() == lifted, "{lift}: {row:?}");
            assert!(has(DoubtKind::Lifted).is_none_or(|told| (told - lift).abs() < 0.2), "{lift}: {found:?}");
            for (n, (kind, expected)) in
                [(DoubtKind::FlangeTip, tip), (DoubtKind::FlangeBack, back), (DoubtKind::BeyondTread, beyond)]
                    .into_iter()
                    .enumerate()
            {
                let Some(expected) = expected else { continue };
                assert_eq!(has(kind).is_some(), expected, "{kind:?}: {row:?}");
                told[n] += u32::from(expected);
            }
            told[3] += u32::from(lifted);
        }
    }
    assert!(told[0] > 0 && told[2] > 0 && told[3] > 0, "{told:?}");
    Ok(())
}

#[test]
fn real_scenes_that_went_wrong_in_silence_leave_a_doubt() -> Result<()> {
    let Some(contact) = std::env::var_os("WHEELRAIL_CONTACT").map(PathBuf::from) else { return Ok(()) };
    let profiles = contact.join("testbank/profiles");
    let text = |rail: &str, wheel: &str, rest: &str| {
        format!(
            "[rail]\nfile = \"{rail}\"\n[wheel]\nfile = \"{wheel}\"\norigin = \"tape-line\"\nradius = 460.0\n[track]\n\
             gauge = 1435.0\n[wheelset]\nback_to_back = 1360.0\nflange_back_x = -70.0\n{rest}\n[output]\nformats = []\n"
        )
    };
    let lifted = text(
        "uk_crossing.slcs\"\nunit = \"m\"\nalong = 5500.0\nflip_z = true\nmirror = false #",
        "whl_left_iter795.whl",
        "yaw = 0.02\nlateral = 7.9\n[patch]\nload = 60000.0",
    );
    let found = warnings(&lifted, &profiles)?;
    assert!(found.iter().any(|warning| warning.contains("the wheel's tread is 2")), "{found:?}");
    let swept = text("cross+wing.slcs\"\nalong = 420.0 #", "whl_left_iter288.whl", "yaw = 0.005");
    let case = scene::resolve(&scene::parse(&swept, false)?, &profiles, "swept")?;
    let wheelrail::case::Arrangement::Wheelset { system, .. } = &case.setup().arrangement else {
        panic!("a wheelset")
    };
    let doubts = SideLandmarks::new(Landmarks::new(&case.profiles().right.pair), None);
    for lateral in [-8.0, -4.0, 4.0, 8.0] {
        let rows = rows(system, lateral, Roll::Solve)?;
        let words: Vec<String> = doubts.of_rows(&rows).map(|(_, found)| found.kinds().to_string()).collect();
        assert!(words.iter().any(|words| words.contains("flange-back")), "{lateral}: {words:?}");
    }
    Ok(())
}

#[test]
fn the_page_on_sweeps_lists_every_doubt() {
    let page = include_str!("../../src/docs/sweeps.md");
    for kind in DoubtKind::ALL {
        assert!(page.contains(&format!("`{}`", kind.word())), "{}", kind.word());
        assert_eq!(serde_json::to_value(kind).unwrap(), kind.word());
    }
}

#[test]
fn the_examples_leave_no_doubt() -> Result<()> {
    let folder = repository("examples/scenes");
    let mut read = 0;
    for entry in std::fs::read_dir(&folder).unwrap() {
        let path = entry.unwrap().path();
        let Ok(case) = scene::resolve(&scene::load(&path)?, &folder, "example") else {
            panic!("{}", path.display());
        };
        let doubts: Vec<String> = Run::new(case, SILENT)?.warnings();
        let slips = [
            "angles are in rad",
            "tilted",
            "loads are in N",
            "no metal's",
            "flange: check",
            "rolling radius",
        ];
        let slipped = doubts.iter().find(|doubt| slips.iter().any(|slip| doubt.contains(slip)));
        assert_eq!(slipped, None, "{}", path.display());
        read += 1;
    }
    assert!(read >= 5, "{read}");
    Ok(())
}

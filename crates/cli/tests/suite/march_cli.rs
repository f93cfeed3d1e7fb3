//! `wheelrail march` through the binary: its tables, its picture, and what bad calls get.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use tempfile::TempDir;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn march(folder: &Path, arguments: &[&str]) -> Output {
    let scene = root().join("examples/crossing/crossing.toml");
    let binary = env!("CARGO_BIN_EXE_wheelrail");
    Command::new(binary).current_dir(folder).arg("march").arg(scene).args(arguments).output().unwrap()
}

fn complaint(folder: &Path, text: &str, arguments: &[&str]) -> String {
    std::fs::write(folder.join("scene.toml"), text).unwrap();
    let binary = env!("CARGO_BIN_EXE_wheelrail");
    let output = Command::new(binary)
        .current_dir(folder)
        .args(["march", "scene.toml"])
        .args(arguments)
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2), "{text}: {output:?}");
    assert!(output.stdout.is_empty(), "{text}: {output:?}");
    String::from_utf8(output.stderr).unwrap()
}

#[test]
fn a_march_has_a_row_for_each_place_and_its_events() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    let output = march(here, &["--along", "-100:300:10", "--events", "events.csv", "--threads", "1"]);
    assert!(output.status.success(), "{output:?}");
    let table = String::from_utf8(output.stdout).unwrap();
    let head = table.lines().next().unwrap();
    assert!(head.starts_with("along_mm,lateral_mm,yaw_rad,roll_rad,side,contact,z_mm,rail_x_mm,"), "{head}");
    assert!(head.ends_with(",doubt,contact_pitch_rad,approach_mm,normal_load_n"), "{head}");
    let rows: Vec<Vec<&str>> = table.lines().skip(1).map(|row| row.split(',').collect()).collect();
    assert!(rows.iter().all(|row| row.len() == head.split(',').count()), "{table}");
    let lowest = |side: &str| rows.iter().filter(|row| row[4] == side && row[5] == "1").count();
    assert_eq!([lowest("left"), lowest("right")], [41, 41]);
    let events = std::fs::read_to_string(here.join("events.csv")).unwrap();
    let over: Vec<Vec<&str>> = events
        .lines()
        .map(|row| row.split(',').collect::<Vec<_>>())
        .filter(|row| row[2] == "transfer" && row[9].parse::<f64>().unwrap() > 1.0)
        .collect();
    let [over] = over.as_slice() else { panic!("{events}") };
    let [before, after, impact] = [3, 4, 12].map(|k| over[k].parse::<f64>().unwrap());
    assert!(over[1] == "right" && before > 40.0 && after < -20.0 && impact > 0.05, "{over:?}");
    // Any number of threads gives the same bits.
    let other = march(here, &["--along", "-100:300:10", "--threads", "2"]);
    assert_eq!(String::from_utf8(other.stdout).unwrap(), table);
}

#[test]
fn the_picture_of_the_manual_is_what_the_command_draws() {
    let folder = TempDir::new().unwrap();
    let output =
        march(folder.path(), &["--along", "-100:300:2", "--out", "march.csv", "--picture", "march.svg"]);
    assert!(output.status.success() && output.stdout.is_empty(), "{output:?}");
    let [drawn, kept] = [folder.path().join("march.svg"), root().join("src/docs/along_track.svg")]
        .map(|path| std::fs::read_to_string(path).unwrap());
    // Digits of machines may differ; headings, axes and the number of curves do not.
    let words = |text: &str| -> Vec<String> {
        text.split('<').filter(|part| part.starts_with("text")).map(Into::into).collect()
    };
    assert_eq!(words(&drawn), words(&kept));
    assert_eq!(drawn.matches("<p").count(), kept.matches("<p").count());
}

#[test]
fn a_march_around_has_a_row_for_each_pitch_and_its_picture() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    let run = |arguments: &[&str]| {
        let scene = root().join("examples/wheel_flat/wheel_flat.toml");
        let binary = env!("CARGO_BIN_EXE_wheelrail");
        let output = Command::new(binary).current_dir(here).arg("march").arg(scene).args(arguments).output();
        output.unwrap()
    };
    let output = run(&["--angle", "-0.1:0.1:0.001", "--events", "events.csv", "--picture", "march.svg"]);
    // A slow machine sees progress.
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success() && said.lines().all(|line| line.starts_with("march: ")), "{said}");
    let table = String::from_utf8(output.stdout).unwrap();
    assert!(table.starts_with("angle_rad,lateral_mm,yaw_rad,roll_rad,side,contact,z_mm,"), "{table}");
    let rows: Vec<Vec<&str>> = table.lines().skip(1).map(|row| row.split(',').collect()).collect();
    assert_eq!(rows.iter().filter(|row| row[4] == "right" && row[5] == "1").count(), 201);
    let events = std::fs::read_to_string(here.join("events.csv")).unwrap();
    assert!(events.starts_with("angle_rad,side,event,rail_x_before_mm"), "{events}");
    assert_eq!(events.lines().filter(|row| row.contains(",right,transfer,")).count(), 1, "{events}");
    // The picture of the manual is what the command draws, but for digits of machines.
    let [drawn, kept] = [here.join("march.svg"), root().join("src/docs/around_the_wheel.svg")]
        .map(|path| std::fs::read_to_string(path).unwrap());
    let words = |text: &str| -> Vec<String> {
        text.split('<').filter(|part| part.starts_with("text")).map(Into::into).collect()
    };
    assert_eq!(words(&drawn), words(&kept));
    for (arguments, message) in [
        (&["--angle", "0:x:1"][..], "--angle: found 0:x:1; expected FROM:TO:STEP in rad"),
        (&["--along", "0:1:1"], "rail: found rails of one profile each"),
        (&["--along", "0:1:1", "--angle", "0:1:1"], "cannot be used with"),
        (&[], "required"),
    ] {
        let output = run(arguments);
        let error = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.code() == Some(2) && error.contains(message), "{error}");
    }
    let output = march(here, &["--angle", "0:1:1"]);
    let error = String::from_utf8(output.stderr).unwrap();
    assert!(error.contains("rail: found rails that vary along the track"), "{error}");
}

#[test]
fn bad_calls_name_the_key_and_leave_nothing() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    let list = root().join("examples/crossing/crossing.slcs").display().to_string();
    let rest = "[wheel]\nprofile = \"S1002\"\nradius = 460.0\n[wheelset]\nspacing = 1500.0\n";
    let lofted = format!("[rail]\nfile = {list:?}\n");
    let spaced = "[track]\nspacing = 1500.0\n";
    let range = &["--along", "0:10:5"][..];
    for (text, arguments, message) in [
        (
            format!("{lofted}{rest}[track]\ngauge = 1435.0\n"),
            range,
            "track: found a gauge; expected `spacing`",
        ),
        (
            format!("[rail]\nprofile = \"60E1\"\n{rest}{spaced}"),
            range,
            "rail: found rails of one profile each",
        ),
        (
            format!("[rail]\nprofile = \"60E1\"\nsurface = \"cubic\"\n{rest}{spaced}"),
            range,
            "surface: found an option",
        ),
        (
            format!("{lofted}surface = \"linear\"\n{rest}{spaced}"),
            range,
            "found `linear`; expected one of monotone, cubic",
        ),
        (format!("{lofted}unit = \"m\"\n{rest}{spaced}"), range, "found `unit`"),
        (
            format!("{lofted}{rest}{spaced}"),
            &["--along", "0:400:10"][..],
            "along: found 360 mm; expected a place from -150 to 350 mm",
        ),
        (
            format!("{lofted}{rest}{spaced}"),
            &["--along", "0:x:10"][..],
            "--along: found 0:x:10; expected FROM:TO:STEP",
        ),
        (format!("{lofted}{rest}{spaced}[roller]\nradius = 350.0\n"), range, "roller: found rollers"),
        (
            format!("{lofted}{rest}{spaced}[right.deviation]\nroll = 0.01\n"),
            range,
            "right: deviation: roll: found a roll",
        ),
        (
            format!("{lofted}[wheel]\nprofile = \"S1002\"\nradius = 460.0\n[contact]\noffset = 0.0\n"),
            range,
            "found a single wheel",
        ),
        (
            format!("{lofted}{}{spaced}", rest.replace("460.0", "460.0\nflat = { length = 60.0 }")),
            range,
            "wheel: found a wheel that varies on a rail that varies",
        ),
        (
            format!("{lofted}{rest}pitch = 0.1\n{spaced}"),
            range,
            "wheelset: pitch: found 0.1 rad; expected no pitch of wheels of one profile each",
        ),
    ] {
        let arguments = [arguments, &["--out", "march.csv"]].concat();
        let error = complaint(here, &text, &arguments);
        assert!(error.contains(message), "{error}");
        assert!(!here.join("march.csv").exists(), "{error}");
    }
    // `run` and `sweep` take one section of a list.
    std::fs::write(here.join("scene.toml"), format!("{lofted}{rest}{spaced}[patch]\napproach = 0.05\n"))
        .unwrap();
    let output =
        Command::new(env!("CARGO_BIN_EXE_wheelrail")).current_dir(here).args(["run", "scene.toml"]).output();
    let error = String::from_utf8(output.unwrap().stderr).unwrap();
    assert!(error.contains("along: found no `along` for 14 slices"), "{error}");
}

/// Between slices that show different parts there is no surface: table, picture and page say so, and there is no event.
#[test]
fn a_march_says_where_its_rail_has_a_hole() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    // So curved that a wheel touches the crown: on a flatter one it is the end of the slices that a flange's root touches.
    for (name, from) in [("whole.toml", -30.0), ("half.toml", 5.0)] {
        let arc = format!("center = [0.0, -100.0], radius = 100.0, half = \"upper\", x = [{from:?}, 30.0]");
        std::fs::write(here.join(name), format!("segments = [{{ arc = {{ {arc} }} }}]\n")).unwrap();
    }
    let slices = "0 1\n5\n0\n1\n0 'whole.toml'\n100 'whole.toml'\n150 'half.toml'\n200 'whole.toml'\n300 'whole.toml'\n";
    std::fs::write(here.join("rail.slcs"), slices).unwrap();
    let scene = "rail = { file = \"rail.slcs\" }\nwheel = { profile = \"S1002\", radius = 460.0 }\n\
                 track = { spacing = 1500.0 }\nwheelset = { spacing = 1500.0 }\n";
    std::fs::write(here.join("scene.toml"), scene).unwrap();
    let arguments = [
        "march",
        "scene.toml",
        "--along",
        "25:275:25",
        "--events",
        "e.csv",
        "--picture",
        "p.svg",
        "--html",
        "p.html",
    ];
    let binary = env!("CARGO_BIN_EXE_wheelrail");
    let output = Command::new(binary).current_dir(here).args(arguments).output().unwrap();
    assert!(output.status.success(), "{output:?}");
    let complaints = String::from_utf8(output.stderr).unwrap();
    assert!(complaints.contains("march: a hole at 3 places"), "{complaints}");
    let table = String::from_utf8(output.stdout).unwrap();
    let rows: Vec<Vec<&str>> = table.lines().skip(1).map(|row| row.split(',').collect()).collect();
    let doubt = table.lines().next().unwrap().split(',').position(|name| name == "doubt").unwrap();
    for row in &rows {
        let along: f64 = row[0].parse().unwrap();
        let hole = 100.0 < along && along < 200.0;
        assert_eq!((row[doubt], row[5]), if hole { ("hole", "0") } else { ("", "1") }, "{row:?}");
    }
    assert_eq!(rows.len(), 22, "{table}");
    assert_eq!(std::fs::read_to_string(here.join("e.csv")).unwrap().lines().count(), 1);
    for file in ["p.svg", "p.html"] {
        let text = std::fs::read_to_string(here.join(file)).unwrap();
        assert!(text.contains("holes without a surface: 100.00 to 200.00"), "{file}");
        assert!(!text.contains("section at"), "{file}");
    }
}

//! `wheelrail sweep` through the binary: conicity by position, and what bad calls get.

use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::Duration;

use tempfile::TempDir;

const SCENE: &str = "[rail]\nprofile = \"60E1\"\n[wheel]\nprofile = \"cone-1:20\"\nradius = 460.0\n\
                     [track]\nspacing = 1500.0\n[wheelset]\nspacing = 1500.0\n";

fn sweep(folder: &Path, arguments: &[&str]) -> Output {
    let binary = env!("CARGO_BIN_EXE_wheelrail");
    Command::new(binary).current_dir(folder).arg("sweep").args(arguments).output().unwrap()
}

/// A folder with `scene.toml`, the scene followed by `rest`.
fn folder(rest: &str) -> TempDir {
    let folder = TempDir::new().unwrap();
    std::fs::write(folder.path().join("scene.toml"), format!("{SCENE}{rest}")).unwrap();
    folder
}

/// (lateral_mm, conicity) of the rows of the right side.
fn conicities(table: &str) -> Vec<(String, String)> {
    let rows = table.lines().map(|row| row.split(',').collect::<Vec<_>>());
    rows.filter(|row| row[3] == "right").map(|row| (row[0].into(), row[12].into())).collect()
}

#[test]
fn a_given_roll_has_no_conicity_and_a_solved_one_has_whatever_the_scene_says() {
    for scene_roll in ["roll = 0.002\n", "roll = \"neglect\"\n", ""] {
        let folder = folder(scene_roll);
        let positions = "lateral_mm,roll_rad\n2,\n3,0.001\n0,\n9,0\n";
        std::fs::write(folder.path().join("positions.csv"), positions).unwrap();
        let output = sweep(folder.path(), &["scene.toml", "--positions", "positions.csv"]);
        let table = String::from_utf8(output.stdout).unwrap();
        let found = conicities(&table);
        let empty: Vec<bool> = found.iter().map(|(_, conicity)| conicity.is_empty()).collect();
        assert_eq!(empty, [false, true, true, true], "{scene_roll}{table}");
        let conicity: f64 = found[0].1.parse().unwrap();
        // The roll that goes with the displacement adds 4 % to the cone's own.
        assert!((conicity - 0.052).abs() < 1e-3, "{table}");
    }
}

#[test]
fn a_range_prints_the_displacements_asked_for() {
    let folder = folder("");
    let output = sweep(folder.path(), &["scene.toml", "--lateral", "-0.6:0.6:0.3"]);
    let table = String::from_utf8(output.stdout).unwrap();
    let lateral: Vec<String> = conicities(&table).into_iter().map(|(lateral, _)| lateral).collect();
    assert_eq!(lateral, ["-0.6", "-0.3", "0", "0.3", "0.6"]);
}

#[test]
fn bad_calls_end_with_code_2_and_leave_the_inputs() {
    let folder = folder("");
    let here = folder.path();
    std::fs::write(here.join("positions.csv"), "lateral_mm\n1\n").unwrap();
    std::fs::write(here.join("down.csv"), "lateral_mm\n2\n1\n").unwrap();
    std::fs::write(here.join("empty.csv"), "lateral_mm,yaw_rad\n,0.1\n").unwrap();
    std::fs::write(here.join("yaw.csv"), "lateral_mm,yaw\n1,0.1\n").unwrap();
    let chain = "segments = [{ line = { from = [-60, 3], to = [60, -3] } }]\n";
    std::fs::write(here.join("wheel.toml"), chain).unwrap();
    let own = SCENE.replace("profile = \"cone-1:20\"", "file = \"wheel.toml\"");
    std::fs::write(here.join("own.toml"), own).unwrap();
    std::os::unix::fs::symlink("scene.toml", here.join("link.toml")).unwrap();
    let range = ["--lateral", "0:1:1"];
    let listed = ["--positions", "positions.csv"];
    std::fs::create_dir(here.join("folder")).unwrap();
    let cases: [(&str, &[&str], &[&str], &str); 17] = [
        (
            "scene.toml",
            &range,
            &["--out", "folder"],
            "folder: found a folder; expected a file, or nothing yet",
        ),
        ("scene.toml", &range, &["--out", "nowhere/a.csv"], "nowhere/a.csv: found No such file"),
        (
            "scene.toml",
            &["--positions", "down.csv"],
            &["--picture", "a.svg"],
            "--picture: found 1 mm after 2 mm;",
        ),
        (
            "scene.toml",
            &["--lateral", "0:1:1e-9"],
            &[],
            "--lateral: found 1.000000001e9 positions; expected at most",
        ),
        ("scene.toml", &["--positions", "empty.csv"], &[], "empty.csv: line 2: found an empty lateral_mm"),
        ("scene.toml", &["--positions", "yaw.csv"], &[], "perhaps `yaw_rad` is meant"),
        ("scene.toml", &["--positions", "none.csv"], &[], "none.csv: found no such file; expected"),
        ("nowhere.toml", &range, &[], "nowhere.toml: found no such file; expected"),
        (
            "scene.toml",
            &range,
            &["--out", "scene.toml"],
            "--out: found scene.toml, which the same command reads",
        ),
        ("scene.toml", &range, &["--out", "link.toml"], "--out: found scene.toml, which"),
        ("scene.toml", &listed, &["--out", "./positions.csv"], "--out: found positions.csv, which"),
        ("own.toml", &range, &["--out", "wheel.toml"], "--out: found wheel.toml, which"),
        ("own.toml", &range, &["--picture", "wheel.toml"], "expected a name that ends in .svg or .png"),
        (
            "scene.toml",
            &range,
            &["--picture", "curves.jpg"],
            "--picture: found \"curves.jpg\"; expected a name",
        ),
        ("scene.toml", &range, &["--out", "a.svg", "--picture", "./a.svg"], "--picture: found a.svg, which"),
        ("scene.toml", &range, &["--out", "a.html", "--html", "./a.html"], "--html: found a.html, which"),
        ("scene.toml", &["--positions", "down.csv"], &["--html", "a.html"], "--html: found 1 mm after 2 mm;"),
    ];
    let files = ["scene.toml", "own.toml", "wheel.toml", "positions.csv"];
    let contents = || files.map(|file| std::fs::read(here.join(file)).unwrap());
    let before = contents();
    for (scene, positions, outputs, message) in cases {
        let arguments = [&[scene], positions, outputs].concat();
        let output = sweep(here, &arguments);
        let complaint = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {complaint}");
        assert!(complaint.contains(message), "{arguments:?}: {complaint}");
    }
    assert_eq!(contents(), before);
    let there = [
        "down.csv",
        "empty.csv",
        "folder",
        "link.toml",
        "own.toml",
        "positions.csv",
        "scene.toml",
        "wheel.toml",
        "yaw.csv",
    ];
    assert_eq!(names(here), there, "an output, or what was to become one");
}

/// Points of a rail crown or a cone, as a measured file has them.
fn points(height: fn(f64) -> f64) -> String {
    (-60..=60).map(|k| f64::from(k) / 2.0).map(|x| format!("{x} {}\n", height(x))).collect()
}

#[test]
fn no_command_opens_a_file_twice() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    let own = "\"\nmirror = false\nflip_z = false";
    let scene = SCENE
        .replace("profile = \"60E1\"", &format!("file = \"rail.txt{own}"))
        .replace("profile = \"cone-1:20\"", &format!("file = \"wheel.txt{own}"));
    let files = [
        ("rail.txt", points(|x| -x * x / 600.0)),
        ("wheel.txt", points(|x| x / 20.0)),
        ("scene.toml", format!("{scene}[patch]\napproach = 0.05\n[output]\nformats = [\"text\"]\n")),
        ("positions.csv", "lateral_mm\n-2\n-1\n0\n1\n2\n".into()),
    ];
    // What was written into a pipe can be read once: whoever opens it again waits for ever.
    for (name, _) in &files {
        assert!(Command::new("mkfifo").arg(here.join(name)).status().unwrap().success());
    }
    let sweep = ["--positions", "positions.csv", "--patches", "out", "--picture", "a.svg", "--out", "a.csv"];
    for (command, arguments, read) in
        [("sweep", &sweep[..], 4), ("run", &[], 3), ("check", &[], 3), ("midsep", &[], 3)]
    {
        for (name, text) in files[..read].iter().cloned() {
            let path = here.join(name);
            std::thread::spawn(move || std::fs::write(path, text));
        }
        let mut child = Command::new(env!("CARGO_BIN_EXE_wheelrail"));
        let child = child.current_dir(here).args([command, "scene.toml"]).args(arguments);
        let mut child = child.stdout(Stdio::null()).spawn().unwrap();
        // A program that opens a pipe again never ends, and neither does this test.
        assert_eq!(child.wait().unwrap().code(), Some(0), "{command} waits for a file that it has read");
    }
    assert!(here.join("out/position-0005/boundary.csv").exists());
}

/// Names in a folder, those that begin with a dot too.
fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut names: Vec<_> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn a_killed_sweep_leaves_what_was_there_and_the_next_one_clears_up() {
    const ALL: [&str; 6] = ["--out", "out.csv", "--picture", "out.svg", "--patches", "out"];
    let folder = folder("roll = \"neglect\"\n[patch]\napproach = 0.05\n[output]\nformats = [\"text\"]\n");
    let here = folder.path();
    let arguments = |range: &'static str, outputs: &'static [&str]| {
        [&["--threads", "1", "scene.toml", "--lateral", range], outputs].concat()
    };
    // What stands in the outputs.
    let found = || ["out.csv", "out.svg", "out/summary.json"].map(|name| std::fs::read(here.join(name)).ok());
    // Some twenty blocks, or so many folders, of which one thread takes a second; killed when it has begun to write them.
    let long: [(&'static str, &'static [&str], &str, &str); 2] =
        [("-8:8:0.0001", &ALL[..4], "out.csv.", ""), ("-1:1:0.01", &ALL, "out.", "/position-0001")];
    let killed = |(range, outputs, file, part): (&'static str, &'static [&str], &str, &str)| {
        let mut child = Command::new(env!("CARGO_BIN_EXE_wheelrail"))
            .current_dir(here)
            .arg("sweep")
            .args(arguments(range, outputs))
            .spawn()
            .unwrap();
        let ours = |name: &String| name.starts_with(".wheelrail-tmp.");
        let begun = |name: String| {
            let written = here.join(format!("{name}{part}")).metadata();
            name.starts_with(&format!(".wheelrail-tmp.{file}"))
                && written.is_ok_and(|found| found.is_dir() || found.len() > 1000)
        };
        while !names(here).into_iter().any(begun) && child.try_wait().unwrap().is_none() {
            std::thread::sleep(Duration::from_millis(1));
        }
        child.kill().unwrap();
        assert!(!child.wait().unwrap().success(), "it had ended");
        assert_eq!(names(here).iter().filter(|name| ours(name)).count(), outputs.len() / 2);
    };
    let whole = || {
        let output = sweep(here, &arguments("-1:1:1", &ALL));
        assert!(output.status.success() && output.stdout.is_empty());
        assert_eq!(names(here), ["out", "out.csv", "out.svg", "scene.toml"]);
        found()
    };
    long.into_iter().for_each(killed);
    assert_eq!(found(), [const { None }; 3]);
    let before = whole();
    assert_eq!(before[0], Some(sweep(here, &["scene.toml", "--lateral", "-1:1:1"]).stdout));
    long.into_iter().for_each(killed);
    assert_eq!(found(), before);
    assert_eq!(whole(), before);
}

#[test]
fn a_sweep_ends_with_its_reader() {
    let folder = folder("");
    // Minutes of work, of which a processor may do one.
    let mut sweep = Command::new("bash")
        .current_dir(folder.path())
        .args(["-c", "ulimit -t 60; exec \"$0\" \"$@\"", env!("CARGO_BIN_EXE_wheelrail")])
        .args(["sweep", "scene.toml", "--lateral", "-8:8:0.000002"])
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut line = String::new();
    let mut reader = std::io::BufReader::new(sweep.stdout.take().unwrap());
    std::io::BufRead::read_line(&mut reader, &mut line).unwrap();
    assert!(line.starts_with("lateral_mm,"), "{line}");
    drop(reader);
    assert_eq!(sweep.wait().unwrap().code(), Some(0), "still at work");
}

/// As a table does, a sweep says where the one roll ends, once, whatever its step; on one side of it nothing.
#[test]
fn where_the_roll_ends_is_said() {
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/defects/table-fold-of-roll.toml");
    let folder = TempDir::new().unwrap();
    for (range, ends) in [("4.6:4.7:0.01", 1), ("4.6:4.7:0.1", 1), ("-6:6:1", 2), ("4:4.67:0.01", 0)] {
        let output = sweep(folder.path(), &[scene, "--lateral", range]);
        let said = String::from_utf8(output.stderr).unwrap();
        let lines: Vec<&str> = said.lines().filter(|line| line.contains("the roll jumps by -3.0")).collect();
        assert_eq!(lines.len(), ends, "{range}: {said}");
        assert!(lines.iter().all(|line| line.contains("4.67764")), "{range}: {said}");
    }
}

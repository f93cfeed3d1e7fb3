//! `wheelrail sweep` through the binary: conicity by position, and what bad calls get.

use std::path::Path;
use std::process::{Command, Output};

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
    // Another sweep that is at it.
    let busy = std::fs::File::create(here.join(".busy.csv.partial")).unwrap();
    busy.lock().unwrap();
    let cases: [(&str, &[&str], &[&str], &str); 15] = [
        ("scene.toml", &range, &["--out", "folder"], "found a folder or device"),
        ("scene.toml", &range, &["--out", "busy.csv"], "found another sweep that writes it"),
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
    assert!(!here.join("a.svg").exists());
}

/// Points of a rail crown or a cone, as a measured file has them.
fn points(height: fn(f64) -> f64) -> String {
    (-60..=60).map(|k| f64::from(k) / 2.0).map(|x| format!("{x} {}\n", height(x))).collect()
}

#[test]
fn measured_files_are_not_opened_again_for_every_position() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    let files = [("rail.txt", points(|x| -x * x / 600.0)), ("wheel.txt", points(|x| x / 20.0))];
    for (name, text) in &files {
        std::fs::write(here.join(name), text).unwrap();
    }
    let scene = SCENE
        .replace("profile = \"60E1\"", "file = \"rail.txt\"\nmirror = false\nflip_z = false")
        .replace("profile = \"cone-1:20\"", "file = \"wheel.txt\"\nmirror = false\nflip_z = false");
    let rest = "[patch]\napproach = 0.05\n[output]\nformats = [\"text\"]\n";
    std::fs::write(here.join("scene.toml"), format!("{scene}{rest}")).unwrap();
    let arguments =
        ["--threads", "1", "scene.toml", "--lateral", "-2:2:1", "--patches", "out", "--out", "out.csv"];
    let binary = env!("CARGO_BIN_EXE_wheelrail");
    let mut child = Command::new(binary).current_dir(here).arg("sweep").args(arguments).spawn().unwrap();
    // The first position of many is written: the files have been read.
    let begun = || {
        let folders = std::fs::read_dir(here).unwrap().map(|entry| entry.unwrap().path());
        folders.filter(|path| path.is_dir()).any(|path| path.join("position-0001").exists())
    };
    while !begun() && child.try_wait().unwrap().is_none() {
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    for (name, _) in &files {
        std::fs::remove_file(here.join(name)).unwrap();
    }
    assert!(child.wait().unwrap().success());
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
fn a_killed_sweep_goes_on_where_it_was_and_one_of_another_scene_begins_anew() {
    let folder = folder("roll = \"neglect\"\n");
    let here = folder.path();
    // Some twenty blocks, of which one thread takes a second.
    let range = ["--lateral", "-8:8:0.0001", "--out", "out.csv"];
    let arguments = [&["--threads", "1", "scene.toml"], &range[..]].concat();
    let killed = || {
        let binary = env!("CARGO_BIN_EXE_wheelrail");
        let mut child = Command::new(binary).current_dir(here).arg("sweep").args(&arguments).spawn().unwrap();
        // Its key, the head of the table, and a block.
        let begun =
            || std::fs::read_to_string(here.join(".out.csv.progress")).is_ok_and(|t| t.lines().count() > 2);
        while !begun() && child.try_wait().unwrap().is_none() {
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
        child.kill().unwrap();
        child.wait().unwrap();
        assert_eq!(names(here), [".out.csv.partial", ".out.csv.progress", "scene.toml"]);
    };
    let resumed = || {
        let output = sweep(here, &arguments);
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success(), "{said}");
        assert_eq!(names(here), ["out.csv", "scene.toml"]);
        said
    };
    killed();
    let said = resumed();
    assert!(said.starts_with("sweep: going on after "), "{said}");
    let table = std::fs::read(here.join("out.csv")).unwrap();
    assert_eq!(
        table,
        sweep(here, &arguments[..arguments.len() - 2]).stdout,
        "not what an unbroken sweep writes"
    );

    std::fs::remove_file(here.join("out.csv")).unwrap();
    killed();
    std::fs::write(here.join("scene.toml"), SCENE.replace("460.0", "461.0")).unwrap();
    assert!(!resumed().contains("going on"));
    assert_ne!(std::fs::read(here.join("out.csv")).unwrap(), table);
}

#[test]
fn a_sweep_ends_with_its_reader() {
    let folder = folder("");
    // A minute's work, and more.
    let mut sweep = Command::new(env!("CARGO_BIN_EXE_wheelrail"))
        .current_dir(folder.path())
        .args(["sweep", "scene.toml", "--lateral", "-8:8:0.000004"])
        .stdout(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    let start = std::time::Instant::now();
    let mut line = String::new();
    let mut reader = std::io::BufReader::new(sweep.stdout.take().unwrap());
    std::io::BufRead::read_line(&mut reader, &mut line).unwrap();
    assert!(line.starts_with("lateral_mm,"), "{line}");
    drop(reader);
    while sweep.try_wait().unwrap().is_none() && start.elapsed().as_secs() < 20 {
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    let code = sweep.try_wait().unwrap().map(|status| status.code());
    sweep.kill().unwrap();
    assert_eq!(code, Some(Some(0)), "still at work");
}

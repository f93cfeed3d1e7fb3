//! `wheelrail run`, `midsep` and `schema` through the binary: progress, folders, sizes, and what bad scenes get.

use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Command, Output, Stdio};

use tempfile::TempDir;
use wheelrail::case::OutputFormat;

const BODIES: &str =
    "[rail]\nprofile = \"60E1\"\nrotate = \"1:40\"\n[wheel]\nprofile = \"S1002\"\nradius = 460.0\n";

/// A small grid, and few files.
const SMALL: &str = "[grid]\nxi = { from = -6.0, to = 6.0, n = 13 }\neta = { from = -8.0, to = 8.0, n = 17 }\n\
                     [output]\nformats = [\"npy\"]\n";

fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_wheelrail"));
    command.current_dir(folder).args(arguments);
    command
}

fn wheelrail(folder: &Path, arguments: &[&str]) -> Output {
    command(folder, arguments).output().unwrap()
}

/// What a call says on stderr when it ends with this code.
fn complaint(folder: &Path, arguments: &[&str], code: i32) -> String {
    let output = wheelrail(folder, arguments);
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {text}");
    text
}

fn write(folder: &Path, name: &str, text: &str) {
    std::fs::create_dir_all(folder.join(name).parent().unwrap()).unwrap();
    std::fs::write(folder.join(name), text).unwrap();
}

fn summary(folder: &Path) -> serde_json::Value {
    serde_json::from_slice(&std::fs::read(folder.join("summary.json")).unwrap()).unwrap()
}

#[test]
fn a_long_run_tells_what_it_is_at_and_an_ordinary_one_nothing_else() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    let rest = format!("[contact]\noffset = 0.0\n[patch]\napproach = 0.05\n{SMALL}");
    write(here, "short.toml", &format!("{BODIES}{rest}"));
    // On a machine that has much else to do no run is short.
    let said = complaint(here, &["run", "short.toml"], 0);
    assert!(said.lines().all(|line| line.starts_with("run: ") && line.ends_with(" s)")), "{said}");
    // A wheel that is long in coming.
    let slow = BODIES.replace("profile = \"S1002\"", "file = \"wheel.toml\"");
    write(here, "long.toml", &format!("{slow}{rest}"));
    let wheel = here.join("wheel.toml");
    assert!(Command::new("mkfifo").arg(&wheel).status().unwrap().success());
    let begun = [
        ("run: profiles (", &["run", "long.toml"][..]),
        ("midsep: contacts (", &["midsep", "long.toml"]),
        ("profile: points and curve (", &["profile", "show", "wheel.toml"]),
    ]
    .map(|(said, arguments)| {
        let mut command = command(here, arguments);
        (said, command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap())
    });
    let [run, others @ ..] = begun.map(|(said, mut child)| {
        let mut lines = BufReader::new(child.stderr.take().unwrap()).lines();
        let line = lines.next().unwrap().unwrap();
        assert!(line.starts_with(said) && line.ends_with(" s)"), "{line}");
        child
    });
    for mut other in others {
        other.kill().unwrap();
        other.wait().unwrap();
    }
    std::fs::write(&wheel, "segments = [{ line = { from = [-60, 3], to = [60, -3] } }]\n").unwrap();
    let output = run.wait_with_output().unwrap();
    assert!(output.status.success());
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(said.ends_with("\noutput/long\n"), "stdout is data: {said}");
}

#[test]
fn results_of_a_scene_of_the_same_name_elsewhere_are_not_replaced() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    let scene =
        |approach: f64| format!("{BODIES}[contact]\noffset = 0.0\n[patch]\napproach = {approach}\n{SMALL}");
    let approach = |folder: &str| summary(&here.join(folder))["approach_mm"].as_f64().unwrap();
    write(here, "a/scene.toml", &scene(0.01));
    write(here, "b/scene.toml", &scene(0.02));
    complaint(here, &["run", "a/scene.toml"], 0);
    assert_eq!(summary(&here.join("output/scene"))["scene_file"], "../../a/scene.toml");
    let said = complaint(here, &["run", "b/scene.toml"], 2);
    assert!(said.starts_with("error: output/scene: found results of ") && said.contains("--out"), "{said}");
    assert_eq!(approach("output/scene"), 0.01);
    // The same file edited, by another path, and whatever --out says, replaces them.
    write(here, "a/scene.toml", &scene(0.03));
    complaint(here, &["run", "./b/../a/scene.toml"], 0);
    assert_eq!(approach("output/scene"), 0.03);
    complaint(here, &["run", "b/scene.toml", "--out", "output/scene"], 0);
    assert_eq!(approach("output/scene"), 0.02);
    complaint(here, &["run", "a/scene.toml"], 2);
    // So does a scene that has moved: its old file is no more.
    std::fs::rename(here.join("b"), here.join("c")).unwrap();
    complaint(here, &["run", "c/scene.toml"], 0);
}

#[test]
fn grids_are_bounded_before_memory_is_asked_for() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    let scene = |n_xi: u64, n_eta: u64| {
        format!(
            "{BODIES}[contact]\noffset = 0.0\n[patch]\napproach = 0.05\n[grid]\n\
             xi = {{ from = -6.0, to = 6.0, n = {n_xi} }}\neta = {{ from = -8.0, to = 8.0, n = {n_eta} }}\n"
        )
    };
    for (n_xi, n_eta, found) in [
        (1_000_000_000, 3, "grid: xi: found 1e9 values; expected at most 1e6 values"),
        (3, u64::MAX >> 1, "grid: eta: found 9.223372036854776e18 values"),
        (900_000, 900_000, "grid: found 810000000000 points; expected at most 1e8 points"),
    ] {
        write(here, "large.toml", &scene(n_xi, n_eta));
        let said = complaint(here, &["run", "large.toml"], 2);
        assert!(said.contains(found), "{said}");
    }
    // A check needs the window alone.
    let output = wheelrail(here, &["check", "large.toml"]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    // Memory that the system does not grant: 1.3 GB.
    write(here, "large.toml", &scene(6000, 6000));
    let binary = env!("CARGO_BIN_EXE_wheelrail");
    let limited = format!("ulimit -v 1000000; exec {binary} --threads 1 run large.toml");
    let output = Command::new("bash").current_dir(here).args(["-c", &limited]).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("36000000 points, which take 1188000000 bytes of memory"), "{said}");
    assert!(!here.join("output").exists());
}

#[test]
fn an_automatic_grid_stays_small_over_an_absurd_patch() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    let line = "segments = [{ line = { from = [-60.0, 0.0], to = [60.0, 0.0] } }]\n";
    let scene = format!(
        "[rail]\n{line}[wheel]\n{line}radius = 460.0\n[contact]\nrail_x = 0.0\nwheel_x = 0.0\n\
         [patch]\napproach = 1e-9\n[output]\nformats = [\"npy\"]\n"
    );
    write(here, "line.toml", &scene);
    let said = complaint(here, &["run", "line.toml"], 0);
    assert!(
        said.contains("warning: the patch is so long and thin that") && said.contains("grid.spacing"),
        "{said}"
    );
    let grid = &summary(&here.join("output/line"))["grid"];
    let [xi, eta] = ["n_xi", "n_eta"].map(|key| grid[key].as_u64().unwrap());
    assert!(eta == 21 && xi * eta <= 100_000, "{xi} x {eta}");
}

#[test]
fn rough_profiles_do_not_fill_the_disk_with_parts() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    // 120 bumps of 1 mm under a plane.
    let bump = |k: i32| {
        let x = f64::from(k) - 60.0;
        format!(
            "{{ arc = {{ center = [{}, -1.0], radius = 1.0, half = \"upper\", x = [{x}, {}] }} }},\n",
            x + 0.5,
            x + 1.0
        )
    };
    let bumps: String = (0..120).map(bump).collect();
    let scene = |contact: &str, grid: &str| {
        format!(
            "[rail]\nsegments = [\n{bumps}]\n[wheel]\nradius = 460.0\n\
             segments = [{{ line = {{ from = [-70.0, 0.0], to = [70.0, 0.0] }} }}]\n[contact]\n{contact}\n\
             [patch]\napproach = 0.001\n[grid]\n{grid}\n[output]\nformats = [\"npy\"]\n"
        )
    };
    for (contact, found) in [
        ("rail_x = 0.5\nwheel_x = 0.0", "grid: found a patch of 120 parts; expected at most 100;"),
        (
            "offset = 0.0",
            "contact: found more than 100 places of contact of one wheel; expected at most 100;",
        ),
    ] {
        write(here, "rough.toml", &scene(contact, ""));
        let said = complaint(here, &["run", "rough.toml"], 2);
        assert!(said.contains(found) && said.contains("grid.merge"), "{said}");
    }
    write(here, "rough.toml", &scene("rail_x = 0.5\nwheel_x = 0.0", "merge = 2.0"));
    complaint(here, &["run", "rough.toml"], 0);
}

#[test]
fn midsep_prints_every_contact() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    write(here, "single.toml", &format!("{BODIES}[contact]\noffset = 0.0\n{SMALL}"));
    let place = "[track]\ngauge = 1435.0\n[wheelset]\nback_to_back = 1360.0\nflange_back_x = -70.0\n";
    write(here, "set.toml", &format!("{BODIES}{place}lateral = 3.0\n{SMALL}"));
    let text = |scene: &str| {
        let output = wheelrail(here, &["midsep", scene]);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    };
    let single = text("single.toml");
    assert!(single.starts_with("# MIDSEP: "), "{single}");
    let set = text("set.toml");
    let heads: Vec<&str> = set.lines().filter(|line| line.contains("side, contact")).collect();
    assert_eq!(heads, ["# right side, contact 1", "# left side, contact 1"]);
    // α, β of two profiles, and a row for every ξ, in each.
    let rows = |text: &str| text.lines().filter(|line| !line.starts_with('#') && !line.is_empty()).count();
    assert_eq!(rows(&set), 2 * rows(&single));
    assert!(set.matches("# midplane, eta = 0").count() == 2 && set.contains("\n\n# left side"), "{set}");
    write(here, "off.toml", &format!("{BODIES}[contact]\noffset = 500.0\n"));
    let said = complaint(here, &["midsep", "off.toml"], 2);
    assert!(
        said.contains("off.toml: contact: offset: found no contact; expected a wheel over its rail;"),
        "{said}"
    );
}

#[test]
fn the_schema_takes_every_example_and_refuses_a_misspelt_key() {
    let folder = TempDir::new().unwrap();
    let output = wheelrail(folder.path(), &["schema"]);
    assert!(output.status.success());
    std::fs::write(folder.path().join("schema.json"), output.stdout).unwrap();
    let scenes = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/scenes");
    crate::programs::check("check_schema.py", &folder.path().join("schema.json"), &[scenes]);
}

#[test]
fn an_infeasible_scene_is_no_agreement_for_the_command() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = folder.path().join("scene.toml");
    let text = "[rail]\nprofile = \"60E1\"\n[wheel]\nprofile = \"S1002\"\nradius = 460.0\n[contact]\nrail_x = 20.0\n\
                wheel_x = -20.0\n[patch]\napproach = 0.1\n[grid]\nxi = { from = -10.0, to = 10.0, n = 21 }\n\
                eta = { from = -10.0, to = 10.0, n = 21 }\n";
    std::fs::write(&scene, text).expect("a file");
    let command =
        std::process::Command::new(env!("CARGO_BIN_EXE_wheelrail")).arg("check").arg(&scene).output();
    let output = command.expect("the program");
    let [said, complained] =
        [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).expect("text"));
    assert_eq!(output.status.code(), Some(1), "{said}{complained}");
    assert!(
        said.starts_with("contact: agrees") && complained.contains("infeasible contact"),
        "{said}{complained}"
    );
}

#[test]
fn check_measures_the_normal_gap_of_grids_over_the_rails_surface() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    let grid = "[grid]\nreference = \"rail\"\n";
    for (name, contact) in [
        ("corner", "offset = 3.5\n[patch]\napproach = 0.05"),
        ("yawed", "offset = 6.0\nyaw = 0.01\n[patch]\napproach = 0.08"),
    ] {
        write(here, &format!("{name}.toml"), &format!("{BODIES}[contact]\n{contact}\n{grid}"));
        let output = wheelrail(here, &["check", &format!("{name}.toml")]);
        let said = String::from_utf8(output.stdout).unwrap();
        assert!(output.status.success(), "{name}: {said}{}", String::from_utf8_lossy(&output.stderr));
        let line = said.lines().find(|line| line.contains("normal gap t: agrees with closest distances at "));
        let points = line.and_then(|line| line.split(' ').rev().nth(1)?.parse::<usize>().ok());
        assert!(points.is_some_and(|points| points > 40), "{name}: {said}");
        let aligned = said
            .lines()
            .find_map(|line| line.trim().strip_prefix("where both normals are one line to 3 degrees, "));
        let aligned = aligned.and_then(|rest| rest.split(' ').next()?.parse::<usize>().ok());
        assert!(aligned.is_some_and(|aligned| aligned > 3), "{name}: {said}");
    }
}

#[test]
fn the_template_names_the_formats_that_are_not_written_unasked() {
    let sentence = include_str!("../../src/init.toml").split_once("without it all but ").unwrap().1;
    let named: Vec<&str> = sentence.lines().next().unwrap().split('"').skip(1).step_by(2).collect();
    let others: Vec<String> = OutputFormat::ALL
        .iter()
        .filter(|format| !format.unasked())
        .map(|format| serde_json::to_value(format).unwrap().as_str().unwrap().to_owned())
        .collect();
    assert_eq!(named, others);
}

//! `wheelrail fleet` through the binary: made wheels, stops and resumes, bad files.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::thread::sleep;
use std::time::Duration;

use serde_json::Value;
use tempfile::TempDir;
use wheelrail::measured::{Format, write};
use wheelrail::{Side, standards};

const SCENE: &str = "title = \"A made fleet\"
rail = { rotate = \"1:40\" }
wheel = { radius = 460.0 }
track = { gauge = 1435.0 }
wheelset = { back_to_back = 1360.0, flange_back_x = -70.0 }
";

/// Wheels of a test; `WHEELRAIL_FLEET` says how many more thorough ones make.
fn count() -> usize {
    std::env::var("WHEELRAIL_FLEET").ok().and_then(|text| text.parse().ok()).unwrap_or(70)
}

/// Numbers from 0 to 1 that are the same on every run.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Writes worn S1002 wheels with 5 µm of noise as an instrument would, and a scene.
fn made(folder: &Path, count: usize) {
    let wheels = folder.join("wheels");
    fs::create_dir(&wheels).unwrap();
    let points = write::sample(&standards::wheel("S1002").unwrap(), 0.4).unwrap();
    let mut numbers = Numbers(35);
    for k in 0..count {
        let [depth, width, flange] =
            [3.0 * numbers.next(), 12.0 + 15.0 * numbers.next(), 2.0 * numbers.next()];
        let worn: Vec<[f64; 2]> = points
            .iter()
            .map(|&[x, z]| {
                let tread = if x > -30.0 { depth * (-((x - 2.0) / width).powi(2)).exp() } else { 0.0 };
                let face = if z < -3.0 && x > -55.0 {
                    flange * (1.0 - ((z + 14.0) / 14.0).powi(2)).max(0.0)
                } else {
                    0.0
                };
                [x - face, z + tread + 0.005 * (2.0 * numbers.next() - 1.0)]
            })
            .collect();
        let text = write::points(&worn, Format::MiniProf, Side::Wheel, "made");
        fs::write(wheels.join(format!("w{k:04}.whl")), text).unwrap();
    }
    fs::write(folder.join("fleet.toml"), SCENE).unwrap();
}

fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_wheelrail"));
    command.current_dir(folder).args(["fleet", "fleet.toml"]).args(arguments);
    command
}

fn run(folder: &Path, arguments: &[&str], code: i32) -> Output {
    let output = command(folder, arguments).output().unwrap();
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {}", said(&output));
    output
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Every file below a folder.
fn files(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut all = BTreeMap::new();
    let mut open = vec![folder.to_path_buf()];
    while let Some(next) = open.pop() {
        for entry in fs::read_dir(next).unwrap().flatten() {
            if entry.path().is_dir() {
                open.push(entry.path());
            } else {
                all.insert(
                    entry.path().strip_prefix(folder).unwrap().into(),
                    fs::read(entry.path()).unwrap(),
                );
            }
        }
    }
    all
}

fn rows(out: &Path) -> Vec<BTreeMap<String, String>> {
    let mut reader = csv::Reader::from_path(out.join("fleet.csv")).unwrap();
    let names = reader.headers().unwrap().clone();
    let row =
        |row: csv::StringRecord| names.iter().zip(row.iter()).map(|(a, b)| (a.into(), b.into())).collect();
    reader.records().map(|record| row(record.unwrap())).collect()
}

#[test]
fn a_killed_fleet_goes_on_and_ends_with_the_same_bytes() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    made(here, count());
    let arguments = |out| ["--wheels", "wheels", "--rails", "60E1", "--out", out];
    run(here, &arguments("whole"), 0);
    let mut killed = command(here, &arguments("stopped")).stderr(Stdio::null()).spawn().unwrap();
    let first = here.join("stopped/parts/part-000000.json");
    while !first.exists() && killed.try_wait().unwrap().is_none() {
        sleep(Duration::from_millis(2));
    }
    killed.kill().unwrap();
    killed.wait().unwrap();
    assert!(!here.join("stopped/summary.json").exists(), "it was not stopped half way");
    let resumed = run(here, &[&arguments("stopped")[..], &["--threads", "1"]].concat(), 0);
    assert!(
        said(&resumed).contains("fleet: 1 part were there") || said(&resumed).contains(" parts were there")
    );
    let [whole, stopped] = ["whole", "stopped"].map(|out| files(&here.join(out)));
    assert!(whole == stopped, "{:?} {:?}", whole.keys(), stopped.keys());

    let summary: Value = serde_json::from_slice(&whole[Path::new("summary.json")]).unwrap();
    assert_eq!(
        (summary["pairs"].as_u64(), summary["worst"].as_array().unwrap().len()),
        (Some(count() as u64), 10)
    );
    let page = String::from_utf8(whole[Path::new("fleet.html")].clone()).unwrap();
    for worst in summary["worst"].as_array().unwrap() {
        let file = worst["page"].as_str().unwrap();
        assert!(page.contains(file) && whole[Path::new(file)].starts_with(b"<!DOCTYPE html>"), "{worst}");
    }
    let values: Vec<f64> =
        rows(&here.join("whole")).iter().map(|row| row["conicity"].parse().unwrap()).collect();
    let largest = values.iter().copied().fold(0.0, f64::max);
    assert_eq!(summary["worst"][0]["conicity"].as_f64(), Some(largest));

    // A wheel that changed is noticed, the other parts stay.
    fs::copy(here.join("wheels/w0000.whl"), here.join("wheels/w0066.whl")).unwrap();
    let again = said(&run(here, &arguments("stopped"), 0));
    assert!(again.contains("fleet: 1 part computed again: scene, list or files have changed"), "{again}");
    let again = rows(&here.join("stopped"));
    assert_eq!(again[0]["conicity"], again[66]["conicity"]);
}

#[test]
fn a_bad_file_is_a_row_that_says_why() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    made(here, 1);
    let text = fs::read_to_string(here.join("wheels/w0000.whl")).unwrap();
    let (head, points) = text.split_once("\n\n").unwrap();
    let of_tread = points.lines().filter(|line| {
        let x: f64 = line.split_whitespace().next().unwrap_or("nan").parse().unwrap_or(f64::NAN);
        x > -10.0
    });
    let cut: String = of_tread.map(|line| format!("{line}\n")).collect();
    fs::write(here.join("wheels/cut.whl"), format!("{head}\n\n{cut}")).unwrap();
    fs::write(here.join("wheels/empty.whl"), "").unwrap();
    fs::write(here.join("wheels/rail.ban"), "0 0\n1 1\n").unwrap();
    let table = "wheelset,left,right,radius_left_mm,radius_right_mm,rail_left,rail_right
good,wheels/w0000.whl,wheels/w0000.whl,,,60E1,60E1
other radii,wheels/w0000.whl,S1002,455,460.5,60E1,54E1
cut,wheels/cut.whl,wheels/cut.whl,,,60E1,60E1
empty,wheels/empty.whl,S1002,,,60E1,60E1
a rail,wheels/rail.ban,S1002,,,60E1,60E1
lost,wheels/nowhere.whl,S1002,,,60E1,60E1
swapped,S1002,S1002,,,S1002,60E1
";
    fs::write(here.join("fleet.csv"), table).unwrap();
    let output = run(here, &["--wheels", "fleet.csv", "--out", "out"], 0);
    assert!(said(&output).contains("of 7 pairs"), "{}", said(&output));
    let rows = rows(&here.join("out"));
    let number = |row: usize, name: &str| rows[row][name].parse::<f64>().ok();
    assert!(
        number(0, "conicity").is_some()
            && number(0, "left_qr_mm").is_some()
            && !rows[0]["finding"].contains("flange"),
        "{:?}",
        rows[0]
    );
    assert_eq!((number(1, "radius_left_mm"), &*rows[1]["rail_right"]), (Some(455.0), "54E1"));
    // Without a flange: the tread still rolls.
    assert!(
        number(2, "left_flange_height_mm").is_none() && rows[2]["finding"].contains("flange"),
        "{:?}",
        rows[2]
    );
    let [four, five] = [rows[3]["finding"].contains("empty.whl"), rows[4]["finding"].contains("rail.ban")];
    assert!(four && five && rows[5]["finding"].contains("no such file"), "{rows:?}");
    // What can be had is there: the right-hand wheel's measures.
    assert!(number(3, "conicity").is_none() && number(3, "right_qr_mm").is_some());
    assert!(rows[6]["finding"].contains("a wheel; expected a rail profile"), "{:?}", rows[6]);
    let page = fs::read_to_string(here.join("out/fleet.html")).unwrap();
    assert!(page.contains("nowhere.whl") && page.contains("worst/worst-01.html"));
}

#[test]
fn what_no_pair_can_be_made_of_ends_the_run_before_it_begins() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    made(here, 1);
    fs::create_dir(here.join("taken")).unwrap();
    fs::write(here.join("taken/thesis.doc"), "x").unwrap();
    fs::create_dir(here.join("none")).unwrap();
    fs::write(
        here.join("single.toml"),
        SCENE.replace("track", "#").replace("wheelset = ", "contact = { offset = 0.0 }\n# "),
    )
    .unwrap();
    for (scene, arguments, expected) in [
        (
            "fleet.toml",
            ["--wheels", "wheels", "--rails", "60e1", "--out", "o"],
            "60e1: found nothing of this name;",
        ),
        ("fleet.toml", ["--wheels", "none", "--rails", "60E1", "--out", "o"], "none: found no files;"),
        (
            "fleet.toml",
            ["--wheels", "nowhere", "--rails", "60E1", "--out", "o"],
            "nowhere: found no such file;",
        ),
        (
            "fleet.toml",
            ["--wheels", "wheels", "--rails", "60E1", "--out", "taken"],
            "taken: found a folder with other files;",
        ),
        (
            "single.toml",
            ["--wheels", "wheels", "--rails", "60E1", "--out", "o"],
            "scene: found a single wheel;",
        ),
    ] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_wheelrail"));
        let output = command.current_dir(here).args(["fleet", scene]).args(arguments).output().unwrap();
        assert!(
            output.status.code() == Some(2) && said(&output).contains(expected),
            "{arguments:?}: {}",
            said(&output)
        );
    }
    let output = run(here, &["--wheels", "wheels", "--out", "o"], 2);
    assert!(said(&output).contains("rails: found none; expected a folder of sections"), "{}", said(&output));
}

/// Wheels of different radii: a movement that turns far from the middle.
#[test]
fn wheelsets_that_differ_have_the_figures_of_their_motion() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    let defect = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/defects/fleet-unequal");
    for file in ["fleet.toml", "w.csv", "w2.csv"] {
        fs::copy(defect.join(file), here.join(file)).unwrap();
    }
    for (wheels, rails, wheelset, column, expected) in [
        ("w.csv", "60E1", "d02", "nonlinearity_per_mm", 0.0628),
        ("w2.csv", "54E1", "d01", "conicity", 0.0345),
        ("w2.csv", "54E1", "d01", "nonlinearity_per_mm", -0.0003),
    ] {
        run(here, &["--wheels", wheels, "--rails", rails, "--out", wheels.trim_end_matches(".csv")], 0);
        let rows = rows(&here.join(wheels.trim_end_matches(".csv")));
        let row = rows.iter().find(|row| row["wheelset"] == wheelset).unwrap();
        let found: f64 = row[column].parse().unwrap();
        assert!((found - expected).abs() < 1e-4, "{wheelset} on {rails}, {column}: {found}");
        assert!(!row["finding"].contains("in two steps"), "{row:?}");
    }
}

#[test]
fn a_wheelset_on_the_tips_of_its_flanges_is_doubted() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    fs::write(here.join("fleet.toml"), SCENE.replace("1435.0", "1315.0")).unwrap();
    fs::write(here.join("w.csv"), "wheelset,left,right\nnew,S1002,S1002\n").unwrap();
    let _ = command(here, &["--wheels", "w.csv", "--rails", "60E1", "--out", "out"]).output().unwrap();
    let rows = rows(&here.join("out"));
    assert!(rows[0]["doubt"].contains("flange-tip"), "{:?}", rows[0]);
    assert!(rows[0]["finding"].contains("flange-tip at"), "{:?}", rows[0]);
}

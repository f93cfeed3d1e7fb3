//! `wheelrail conicity` through the binary: figures, columns, noise, outputs and refusals.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;
use tempfile::TempDir;

/// S1002 on 60E1 at 1:40, with its table of the track.
fn scene(folder: &Path, track: &str) -> String {
    let path = folder.join("scene.toml");
    let text = format!(
        "[rail]\nprofile = \"60E1\"\nrotate = \"1:40\"\n[wheel]\nprofile = \"S1002\"\nradius = 460.0\n{track}\n"
    );
    fs::write(&path, text).unwrap();
    path.to_str().unwrap().to_owned()
}

const TRACK: &str =
    "[track]\ngauge = 1435.0\n[wheelset]\nback_to_back = 1360.0\nflange_back_x = -70.0\nroll = \"neglect\"";

fn conicity(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_wheelrail")).arg("conicity").args(arguments).output().unwrap()
}

fn text(arguments: &[&str]) -> String {
    let output = conicity(arguments);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn figures_functions_and_map_say_the_same() {
    let folder = TempDir::new().unwrap();
    let scene = scene(folder.path(), TRACK);
    let json: Value = serde_json::from_str(&text(&[&scene, "--json", "--gauges", "-1:1:1"])).unwrap();
    let figure = |name: &str| json["key_figures"][name].as_f64().unwrap_or(f64::NAN);
    assert!((figure("conicity_3mm") - 0.1741).abs() < 1e-3, "{}", figure("conicity_3mm"));
    assert!(figure("conicity_3mm_difference").abs() < 2e-3, "{}", figure("conicity_3mm_difference"));
    assert!((figure("clearance_mm") - 10.0).abs() < 1e-3);
    // Mirror images.
    assert!((figure("left_rail_to_mm") - figure("right_rail_to_mm")).abs() < 1e-9);
    let csv = text(&[&scene, "--csv", "--gauges", "0:0:1"]);
    let mut reader = csv::Reader::from_reader(csv.as_bytes());
    let header = reader.headers().unwrap().clone();
    assert!(header.iter().eq(json["functions"].as_object().unwrap().keys().map(String::as_str)));
    assert!(header.iter().all(|name| json["definitions"][name].is_string()), "{header:?}");
    let rows: Vec<_> = reader.records().map(Result::unwrap).collect();
    assert_eq!(rows.len(), 161);
    let column = |name: &str| header.iter().position(|own| own == name).unwrap();
    let at = |row: &csv::StringRecord, name: &str| row[column(name)].parse::<f64>().unwrap_or(f64::NAN);
    let three = rows.iter().find(|row| (at(row, "lateral_mm") - 3.0).abs() < 1e-9).unwrap();
    assert_eq!(at(three, "conicity"), figure("conicity_3mm"));
    // Straight on there is neither an amplitude nor a curve.
    assert!(at(&rows[80], "conicity").is_nan() && rows[80][column("conicity_two_step")].is_empty());
    // Redtenbacher: e r0/Δr with the contacts 1500 mm apart.
    let radius = 1.5 * 460.0 / at(three, "delta_r_mm");
    assert!((at(three, "curve_radius_m") / radius - 1.0).abs() < 0.02, "{radius}");
    assert_eq!(json["map"]["gauge_mm"].as_array().unwrap().len(), 3);
    let middle = json["map"]["conicity"][1][5].as_f64().unwrap();
    assert!((middle - figure("conicity_3mm")).abs() < 1e-4 * middle, "{middle}");
}

#[test]
fn noise_gives_the_same_bits_on_any_number_of_threads() {
    let folder = TempDir::new().unwrap();
    let scene = scene(folder.path(), TRACK);
    let options = ["--json", "--gauges", "0:0:1", "--amplitude", "4", "--samples", "40", "--noise"];
    let run = |noise: &str, more: &[&str]| {
        let arguments = [&[scene.as_str()][..], &options, &[noise], more].concat();
        serde_json::from_str::<Value>(&text(&arguments)).unwrap()["uncertainty"].clone()
    };
    let noise = "points=0.02,radius=0.1,gauge=0.5";
    let one = run(noise, &["--threads", "1"]);
    assert_eq!(one, run(noise, &["--threads", "3"]));
    assert_ne!(one["spreads"], run(noise, &["--seed", "2"])["spreads"]);
    assert_eq!(one["failed"], 0);
    let of = |uncertainty: &Value, name: &str, key: &str| uncertainty["spreads"][name][key].as_f64().unwrap();
    assert!(of(&one, "conicity_3mm", "deviation") > 5.0 * of(&one, "conicity_3mm", "mean_error"));
    // A wider gauge of σ alone: the centred contact stays in the mean.
    let gauge = run("gauge=0.5", &[]);
    assert!(of(&gauge, "left_rail_x_mm", "low") < of(&gauge, "left_rail_x_mm", "high"));
    assert!(of(&gauge, "centre_mm", "deviation") < 1e-6, "{gauge}");
    // Radii of σ = 0.1 mm: the centre moves by √2 σ over the slope of Δr.
    assert!(of(&run("radius=0.1", &[]), "centre_mm", "deviation") > 0.05);
}

#[test]
fn pictures_and_pages_are_written_and_findings_are_said() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    let scene = scene(here, TRACK);
    let [picture, page, out] =
        ["c.svg", "c.html", "c.csv"].map(|name| here.join(name).to_str().unwrap().to_owned());
    let arguments = [&scene, "--csv", "--out", &out, "--picture", &picture, "--html", &page];
    let output =
        conicity(&[&arguments[..], &["--amplitude", "100", "--step", "5", "--gauges", "-1:1:1"]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains("no contact on both sides from"), "{said}");
    let svg = fs::read_to_string(&picture).unwrap();
    for words in ["two-step", "Δ tan γ", "over gauge and amplitude", "nonlinearity parameter"] {
        assert!(svg.contains(words), "{words}");
    }
    assert!(!svg.contains("NaN"));
    let html = fs::read_to_string(&page).unwrap();
    assert!(
        html.contains("in the table of the conicity")
            && html.contains("nonlinearity_per_mm")
            && html.contains("no contact on both sides")
    );
    assert!(fs::read_to_string(&out).unwrap().starts_with("lateral_mm,roll_rad,delta_r_mm,conicity,"));
}

/// A wheel that is coned the wrong way has no conicity: empty cells and a finding, not an end.
#[test]
fn a_movement_that_does_not_come_back_is_said() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("scene.toml");
    let wheel = "[wheel]\nradius = 460.0\nsegments = [{ line = { from = [-60.0, 3.0], to = [60.0, -3.0] } }]";
    let text = format!(
        "[rail]\nprofile = \"60E1\"\n{wheel}\n[track]\nspacing = 1500.0\n[wheelset]\nspacing = 1500.0\n"
    );
    fs::write(&path, text).unwrap();
    let json: Value =
        serde_json::from_str(&self::text(&[path.to_str().unwrap(), "--json", "--gauges", "0:0:1"])).unwrap();
    assert!(json["key_figures"]["conicity_3mm"].is_null() && json["key_figures"]["delta"].is_null());
    let findings = json["findings"].to_string();
    assert!(findings.contains("no conicity at 3 mm: the movement does not come back"), "{findings}");
    assert!(findings.contains("no clearance"), "{findings}");
}

#[test]
fn what_cannot_be_is_refused() {
    let folder = TempDir::new().unwrap();
    let scene = scene(folder.path(), TRACK);
    let refused = |arguments: &[&str], words: &str| {
        let output = conicity(arguments);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {said}");
        assert!(said.contains(words), "{arguments:?}: {said}");
    };
    refused(&[&scene, "--amplitude", "-1"], "a positive number");
    refused(&[&scene, "--step", "1e-9"], "take larger steps");
    refused(&[&scene, "--noise", "point=1"], "points, radius, gauge or step");
    refused(&[&scene, "--noise", "points=0"], "above 0");
    refused(&[&scene, "--noise", "gauge=1", "--samples", "10"], "40 to");
    refused(&[&scene, "--noise", "gauge=nan"], "a finite number");
    refused(&[&scene, "--out", &scene], "a file of its own");
    let single = self::scene(folder.path(), "[contact]\noffset = 0.0");
    refused(&[&single], "[track] and [wheelset]");
    let held = self::scene(folder.path(), &TRACK.replace("\"neglect\"", "0.001"));
    refused(&[&held], "roll solved or neglected");
}

/// A file of the scenes that once went wrong.
fn defect(name: &str) -> String {
    format!("{}/../../tests/defects/{name}", env!("CARGO_MANIFEST_DIR"))
}

/// The left wheel is 0.2 mm smaller: the movement turns at a flange on the left, far from there on the right.
#[test]
fn wheels_that_differ_have_the_conicity_of_their_motion_whatever_else_is_asked_for() {
    let scene = defect("conicity-unequal.toml");
    let column = |arguments: &[&str], number: usize| -> Vec<(f64, f64)> {
        let output = Command::new(env!("CARGO_BIN_EXE_wheelrail")).args(arguments).output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(!said.contains("in two steps"), "{said}");
        let mut reader = csv::Reader::from_reader(output.stdout.as_slice());
        let rows = reader.records().map(Result::unwrap);
        rows.filter_map(|row| Some((row[0].parse().ok()?, row[number].parse().ok()?))).collect()
    };
    let wide = column(&["conicity", &scene, "--csv", "--gauges", "0:0:1"], 3);
    let at = |all: &[(f64, f64)], amplitude: f64| {
        all.iter().find(|(y, _)| (y - amplitude).abs() < 1e-9).map_or(f64::NAN, |(_, value)| *value)
    };
    // A quadrature over 12,610 touches has 0.65005, the two-step integration with its steps of 0.1 mm 0.653.
    assert!((at(&wide, 8.0) - 0.65005).abs() < 1e-4, "{}", at(&wide, 8.0));
    for (range, rows) in [("-3:3:1", 12), ("-8:8:1", 32), ("0:12:1", 24)] {
        let swept = column(&["sweep", &scene, "--lateral", range], 12);
        assert_eq!(swept.len(), rows, "{range}: {swept:?}");
        for (y, value) in swept.iter().filter(|(y, _)| y.abs() <= 8.0) {
            let expected = at(&wide, y.abs());
            assert!((value / expected - 1.0).abs() < 2e-4, "{range} at {y}: {value}, not {expected}");
        }
    }
}

/// Radii that differ move the centre by millimetres, beyond every amplitude that is asked for: no sample is lost by that.
#[test]
fn noise_of_the_radii_is_not_that_of_the_samples_that_stay_near_the_middle() {
    let scene = defect("conicity-noise.toml");
    let options = ["--json", "--gauges", "0:0:1", "--noise", "radius=0.1", "--samples", "200"];
    let json: Value = serde_json::from_str(&text(&[&[scene.as_str()][..], &options].concat())).unwrap();
    let uncertainty = &json["uncertainty"];
    assert_eq!(uncertainty["lost"]["conicity_3mm"], 0, "{uncertainty}");
    let of = |key: &str| uncertainty["spreads"]["conicity_3mm"][key].as_f64().unwrap();
    assert!((of("mean") - 0.041).abs() < 2e-3 && (of("deviation") - 0.035).abs() < 2e-3, "{uncertainty}");
}

/// Cones with radii that differ by millimetres have equal radii nowhere on their rails.
#[test]
fn samples_without_a_quantity_are_counted_and_said() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("scene.toml");
    let text = "[rail]\nprofile = \"60E1\"\nrotate = \"1:40\"\n[wheel]\nprofile = \"cone-1:40\"\nradius = 460.0\n[track]\nspacing = 1500.0\n\
                [wheelset]\nspacing = 1500.0\nroll = \"neglect\"\n";
    fs::write(&path, text).unwrap();
    let path = path.to_str().unwrap();
    let options = [path, "--json", "--gauges", "0:0:1", "--noise", "radius=3", "--samples", "60"];
    let output = conicity(&options);
    let json: Value = serde_json::from_slice(&output.stdout).unwrap();
    let lost = json["uncertainty"]["lost"]["conicity_3mm"].as_u64().unwrap();
    assert!((4..=60).contains(&lost), "{lost}");
    assert!(json["uncertainty"]["spreads"]["conicity_3mm"].is_null());
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(
        said.contains(&format!("{lost} of 60 samples of the noise have no conicity_3mm: no spread is given")),
        "{said}"
    );
}

/// A wheelset whose wheels stand on the tips of their flanges: every form of the output says so, as a sweep does.
#[test]
fn a_conicity_of_flange_tips_is_doubted() {
    let folder = TempDir::new().unwrap();
    let scene = scene(folder.path(), &TRACK.replace("1435.0", "1315.0"));
    let output = conicity(&[&scene, "--csv", "--gauges", "0:0:1"]);
    let table = String::from_utf8(output.stdout).unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains("in the column doubt; flange-tip at"), "{said}");
    assert!(table.lines().next().unwrap().ends_with(",right_rolling_radius_mm,doubt"));
    assert!(table.lines().skip(1).any(|line| line.contains("flange-tip")), "{table}");
    assert!(text(&[&scene, "--gauges", "0:0:1"]).contains("flange-tip"));
    let json = text(&[&scene, "--json", "--gauges", "0:0:1"]);
    let json: Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["functions"]["doubt"].as_array().unwrap().len(), 161);
    assert!(json["definitions"]["doubt"].is_string() && json["findings"].to_string().contains("flange-tip"));
}

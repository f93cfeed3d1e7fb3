//! Scenes with files that scanners spoilt: `tests/defects`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use tempfile::TempDir;

fn defects() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/defects")
}

fn wheelrail(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_wheelrail")).args(arguments).output().unwrap()
}

fn on_stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// A scene of `tests/defects`, with its rail repaired.
fn repaired(scene: &str, folder: &Path) -> String {
    for name in ["LMA.prw", "40_zero0_3.txt", "41_zero_gauge_corner.txt"] {
        fs::copy(defects().join(name), folder.join(name)).unwrap();
    }
    let text = fs::read_to_string(defects().join(scene)).unwrap();
    let path = folder.join(scene);
    fs::write(&path, text.replacen("[rail]\n", "[rail]\nrepair = [\"remove-spikes\"]\n", 1)).unwrap();
    path.to_str().unwrap().to_owned()
}

/// The equivalent conicity at 3 mm.
fn at_three(scene: &str) -> f64 {
    let output = wheelrail(&["conicity", scene, "--csv"]);
    assert_eq!(output.status.code(), Some(0), "{scene}: {}", on_stderr(&output));
    let text = String::from_utf8(output.stdout).unwrap();
    let row = text.lines().find(|row| row.starts_with("3,")).unwrap();
    row.split(',').nth(3).unwrap().parse().unwrap()
}

#[test]
fn zeros_of_a_scanner_are_named_and_repaired() {
    let folder = TempDir::new().unwrap();
    for (scene, named) in [
        ("dropouts-zeros.toml", "7 points in a row, point 21 (line 21) to point 27 (line 27), up to "),
        ("dropouts-crown.toml", "3 points in a row, point 181 (line 181) to point 183 (line 183), up to "),
    ] {
        for command in ["conicity", "run"] {
            let path = defects().join(scene);
            let out = folder.path().join("out");
            let more = ["--out", out.to_str().unwrap()];
            let arguments =
                [&[command, path.to_str().unwrap()], &more[..if command == "run" { 2 } else { 0 }]].concat();
            let output = wheelrail(&arguments);
            let said = on_stderr(&output);
            assert_eq!(output.status.code(), Some(2), "{scene}: {said}");
            assert!(said.contains(named) && said.contains("remove-spikes"), "{scene}: {said}");
        }
        let conicity = at_three(&repaired(scene, folder.path()));
        assert!((conicity - 0.0332).abs() < 1e-3, "{scene}: {conicity}");
    }
}

#[test]
fn a_dense_scan_is_read_to_its_noise() {
    let scene = defects().join("dense-scan.toml");
    let conicity = at_three(scene.to_str().unwrap());
    assert!((conicity - 0.0332).abs() < 2e-3, "{conicity}");
}

#[test]
fn a_notch_between_blade_and_stock_rail_is_read() {
    let scene = defects().join("v-notch.toml");
    let output = wheelrail(&["sweep", scene.to_str().unwrap(), "--lateral=-2:2:2"]);
    let said = on_stderr(&output);
    assert_eq!(output.status.code(), Some(0), "{said}");
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    // Where the slope of the rail, whose heights have four digits, is that of the wheel: 1 in 40.
    let at = |row: &str| row.split(',').nth(6).and_then(|x| x.parse::<f64>().ok());
    let of_middle = text.lines().filter(|row| row.starts_with("0,")).filter_map(at);
    assert!(of_middle.clone().count() == 2 && of_middle.clone().all(|x| (-7.8..-7.2).contains(&x)), "{text}");
}

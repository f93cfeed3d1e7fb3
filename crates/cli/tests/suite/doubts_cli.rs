//! Doubts and messages through the binary: the column and the line of a sweep, and what tables leave out.

use std::path::Path;
use std::process::{Command, Output};

use tempfile::TempDir;

const BODIES: &str =
    "[rail]\nprofile = \"60E1\"\nrotate = \"1:40\"\n[wheel]\nprofile = \"S1002\"\nradius = 460.0\n";

const TRACK: &str = "[track]\ngauge = 1435.0\n[wheelset]\nback_to_back = 1360.0\nflange_back_x = -70.0\n";

fn wheelrail(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_wheelrail")).current_dir(folder).args(arguments).output().unwrap()
}

/// (stdout, stderr) of a call that must end with a code.
fn said(folder: &Path, arguments: &[&str], code: i32) -> (String, String) {
    let Output { status, stdout, stderr } = wheelrail(folder, arguments);
    let [out, err] = [stdout, stderr].map(|text| String::from_utf8(text).unwrap());
    assert_eq!(status.code(), Some(code), "{arguments:?}: {err}");
    (out, err)
}

fn scene(text: &str) -> TempDir {
    let folder = TempDir::new().unwrap();
    std::fs::write(folder.path().join("scene.toml"), text).unwrap();
    folder
}

/// The last column of a table, by lateral displacement and side.
fn doubts(table: &str) -> Vec<[&str; 3]> {
    let rows = table.lines().skip(1).map(|line| line.split(',').collect::<Vec<_>>());
    rows.map(|row| [row[0], row[3], row[row.len() - 1]]).collect()
}

#[test]
fn a_sweep_names_doubts_in_its_last_column_and_in_one_line() {
    let folder = scene(&format!("{BODIES}{TRACK}"));
    let (table, line) = said(folder.path(), &["sweep", "scene.toml", "--lateral", "-6:6:3"], 0);
    assert!(table.lines().next().unwrap().ends_with(",hertz_eta_mm,doubt"), "{table}");
    assert!(doubts(&table).iter().all(|row| row[2].is_empty()) && line.is_empty(), "{table}{line}");
    let (table, line) = said(folder.path(), &["sweep", "scene.toml", "--lateral", "0:30:10"], 0);
    let found = doubts(&table);
    assert_eq!(found[..2], [["0", "left", ""], ["0", "right", ""]], "{table}");
    assert_eq!(found[found.len() - 1], ["30", "right", "flange-tip lifted"], "{table}");
    assert_eq!(line.matches('\n').count(), 1, "{line}");
    assert!(
        line.starts_with("sweep: doubts at 3 of 4 positions, in the column doubt; flange-tip at "),
        "{line}"
    );
    for part in [
        "; lifted at 3, most at ",
        "right side: the wheel's tread is ",
        " mm above the top of the rail: the wheel",
    ] {
        assert!(line.contains(part), "{part}: {line}");
    }
}

#[test]
fn a_sweep_warns_of_its_scene() {
    let folder = scene(&format!("{}{TRACK}", BODIES.replace("460.0", "920.0")));
    let (_, line) = said(folder.path(), &["sweep", "scene.toml", "--lateral", "0:0:1"], 0);
    assert!(
        line.starts_with("warning: wheel: radius: 920 mm is no railway wheel's, 460.0 mm as a diameter"),
        "{line}"
    );
}

#[test]
fn hertz_s_pressure_is_left_out_where_a_half_space_decided() {
    let by_offset = ["offset = 0.0", "offset = -3.0", "offset = 4.5"];
    let cases = by_offset.map(|offset| (offset, "load = 60000.0\nframe = \"contact\"", false));
    for (offset, patch, by_hertz) in cases.into_iter().chain([("offset = 4.5", "approach = 0.05", true)]) {
        let formats = "[output]\nformats = [\"html\"]\n";
        let folder = scene(&format!("{BODIES}[contact]\n{offset}\n[patch]\n{patch}\n{formats}"));
        let (table, _) = said(folder.path(), &["run", "scene.toml", "--out", "out"], 0);
        assert_eq!(table.contains("est. by half-space"), !by_hertz, "{table}");
        assert_eq!(table.contains("Hertz's"), by_hertz, "{table}");
        let read = |name: &str| std::fs::read_to_string(folder.path().join("out").join(name)).unwrap();
        assert_eq!(read("view.html").contains("Hertz's pressure"), by_hertz, "{offset}");
        let summary: serde_json::Value = serde_json::from_str(&read("summary.json")).unwrap();
        assert_eq!(summary["approach_estimated_by"] == "half-space", !by_hertz, "{offset}");
        let ellipse = &summary["hertz_ellipse"];
        assert!(
            ellipse["a_mm"].is_number() && ellipse["pressure_n_per_mm2"].is_number() == by_hertz,
            "{ellipse}"
        );
        assert!(ellipse.as_object().unwrap().contains_key("pressure_n_per_mm2"), "{ellipse}");
    }
}

#[test]
fn an_empty_patch_has_the_area_0() {
    let window = "[grid]\nxi = { from = 20.0, to = 22.0, n = 5 }\neta = { from = 20.0, to = 22.0, n = 5 }\n[output]\nformats = []\n";
    let folder = scene(&format!("{BODIES}[contact]\noffset = 0.0\n[patch]\napproach = 0.05\n{window}"));
    let (table, _) = said(folder.path(), &["run", "scene.toml", "--out", "out"], 1);
    let area = table.lines().find(|line| line.starts_with("patch: area")).unwrap();
    assert!(area.ends_with(" 0.00"), "{table}");
    let summary = std::fs::read_to_string(folder.path().join("out/summary.json")).unwrap();
    assert!(
        summary.contains("\"area_mm2\": 0.0,") && summary.contains("\"perimeter_mm\": 0.0,"),
        "{summary}"
    );
}

#[test]
fn intervals_that_end_at_the_window_are_marked() {
    let cut = |from: f64, to: f64| {
        let window = format!(
            "[grid]\nxi = {{ from = -2.0, to = 2.0, n = 5 }}\neta = {{ from = {from:?}, to = {to:?}, n = 5 }}\n[output]\nformats = []\n"
        );
        let folder = scene(&format!("{BODIES}[contact]\noffset = 0.0\n[patch]\napproach = 0.05\n{window}"));
        said(folder.path(), &["run", "scene.toml", "--out", "out"], 0);
        let table = std::fs::read_to_string(folder.path().join("out/interpen.csv")).unwrap();
        let mut rows = table.lines().map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
        assert_eq!(rows.next().unwrap(), ["xi", "component", "eta_min", "eta_max", "cut"]);
        let marks: Vec<String> = rows.map(|mut row| row.pop().unwrap()).collect();
        assert!(!marks.is_empty() && marks.iter().all(|mark| *mark == marks[0]), "{table}");
        marks[0].clone()
    };
    let found = [cut(-20.0, 20.0), cut(-1.0, 20.0), cut(-20.0, 1.0), cut(-1.0, 1.0)];
    assert_eq!(found, ["0", "1", "2", "3"]);
}

#[test]
fn files_tell_their_body_by_their_extension() {
    let folder = TempDir::new().unwrap();
    let here = folder.path();
    for (name, file, needed) in
        [("S1002", "w.whl", "false"), ("60E1", "r.ban", "true"), ("S1002", "w.prw", "false")]
    {
        let format = if file.ends_with("prw") { "simpack" } else { "miniprof" };
        said(here, &["profile", "convert", name, "--to", format, "--out", file], 0);
        let (_, error) = said(
            here,
            &["profile", "convert", file, "--to", "simpack", "--out", "out", "--mirror", needed],
            0,
        );
        assert!(!error.contains("no --side"), "{error}");
        let text = std::fs::read_to_string(here.join("out")).unwrap();
        let kind = format!("type           =  {}", u8::from(file.starts_with('w')));
        assert!(text.contains(&kind), "{file}: {text}");
        std::fs::remove_file(here.join("out")).unwrap();
    }
}

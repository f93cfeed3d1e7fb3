//! The report, measured small: every section, every file, every column.

use crate::common::repository;
use std::sync::LazyLock;

use wheelrail::measured::CUTOFF_WAVELENGTH;
use wheelrail::scene::{Scene, parse};
use wheelrail_report::measured::{CurveChoice, worst};
use wheelrail_report::measurements::{Effort, Measurements, measure};
use wheelrail_report::page::{FILES, PAGE, excerpt, page, sections};
use wheelrail_report::processes::PROCESSES;
use wheelrail_report::rates::Extent;
use wheelrail_report::reference::{FILES as SCENES, references};
use wheelrail_report::speed::{Timing, race};
use wheelrail_report::table::{markdown, quoted};

/// Measured once.
static MEASUREMENTS: LazyLock<Measurements> = LazyLock::new(|| {
    let effort = Effort {
        sides: vec![8, 20],
        seconds: 0.0,
        growth: vec![10, 20],
        every_pair: 50,
        every_case: 15,
        spacings: vec![0.5],
        sweeps: Extent { positions: 3, amplitude: 0.2, instruments: vec![[0.5, 3.0]] },
        case_side: 20,
    };
    measure(&effort, &mut |_| {}).expect("a measurement")
});

#[test]
fn every_section_and_file_is_there() {
    let sections = sections(&MEASUREMENTS);
    let origin = vec![("command", "wheelrail report".to_string())];
    let text = page(&origin, &sections);
    for section in &sections {
        assert!(text.contains(&format!("\n## {}\n", section.title)), "{}", section.title);
    }
    let mut names: Vec<&str> = sections.iter().flat_map(|s| s.files.iter().map(|(name, _)| *name)).collect();
    names.sort_unstable();
    let mut expected: Vec<&str> = FILES.into_iter().filter(|name| *name != PAGE).collect();
    expected.sort_unstable();
    assert_eq!(names, expected);
    for name in expected {
        assert!(text.contains(name), "{name} is nowhere linked");
    }
    assert!(excerpt(&MEASUREMENTS, &origin).contains("`wheelrail report`"));
}

#[test]
fn accuracy_csv_has_its_columns_and_every_row() {
    let sections = sections(&MEASUREMENTS);
    let file = sections.iter().flat_map(|s| &s.files).find(|(name, _)| *name == "accuracy.csv");
    let text = String::from_utf8(file.expect("accuracy.csv").1.clone()).expect("UTF-8");
    let mut lines = text.lines();
    assert_eq!(
        lines.next(),
        Some(
            "scene,method,tolerance_mm,points,seconds,mpoints_per_s,max_abs_error_mm,max_rel_error,\
             q99_rel_error,worst_xi,worst_eta"
        )
    );
    // Store, five methods, and spectral columns at four tolerances, on two grids.
    assert_eq!(lines.clone().count(), SCENES.len() * 10 * 2);
    for line in lines {
        let cells: Vec<&str> = line.split(',').collect();
        assert_eq!(cells.len(), 11, "{line}");
        let seconds: f64 = cells[4].parse().expect("seconds");
        assert!(seconds >= 0.0, "{line}");
        assert_eq!(cells[1] == "store", cells[6].is_empty(), "{line}");
        if let ("spectral", Ok(tolerance)) = (cells[1], cells[2].parse::<f64>()) {
            let error: f64 = cells[6].parse().expect("an error");
            assert!(error <= tolerance.max(2e-12), "{line}");
        }
    }
    assert!(MEASUREMENTS.threads.iter().all(|row| row.same_bits));
}

/// The scenes that are timed as whole processes stand alone, and say what the examples say.
#[test]
fn timed_processes_are_those_of_the_examples() {
    for (process, example) in PROCESSES.iter().zip(["wheelset", "60e1_s1002"]) {
        let path = repository(&format!("examples/scenes/{example}.toml"));
        let text = std::fs::read_to_string(path).expect("an example");
        let [mut timed, mut example]: [Scene; 2] =
            [process.scene, &text].map(|text| parse(text, false).expect("a scene"));
        (timed.output, example.output) = Default::default();
        example.title = None;
        assert_eq!(timed, example, "{}", process.name);
    }
}

#[test]
fn every_reference_file_is_embedded() {
    let folder = repository("crates/report/src/reference");
    let mut on_disk: Vec<String> = std::fs::read_dir(folder)
        .expect("the folder of reference values")
        .filter_map(|entry| {
            entry.ok()?.file_name().into_string().ok()?.strip_suffix(".json").map(String::from)
        })
        .collect();
    on_disk.sort();
    let embedded: Vec<String> = references().expect("references").into_iter().map(|r| r.name).collect();
    assert_eq!(on_disk, embedded);
}

#[test]
fn noise_ruins_interpolation_and_not_the_default() {
    let pressure = |curve| worst(&MEASUREMENTS.evidence, curve, 0.5, 1.0)[0];
    let interpolated = pressure(CurveChoice::Interpolation);
    let smoothed = pressure(CurveChoice::Smoothing(CUTOFF_WAVELENGTH));
    assert!(smoothed < 0.1 && interpolated > 3.0 * smoothed, "off by {interpolated} and {smoothed}");
}

#[test]
fn whoever_had_least_time_runs_next_until_the_time_is_up() {
    let mut order = Vec::new();
    let mut timings = [Timing::NONE; 3];
    let mut run = |k| {
        order.push(k);
        [0.5, 0.125, 32.0][k]
    };
    race(&mut timings, 1.0, 3, &mut run);
    assert_eq!(timings[0], Timing { best: 0.5, spent: 1.5, runs: 3 });
    assert_eq!(timings[1], Timing { best: 0.125, spent: 1.0, runs: 8 });
    // The run is too long for a second one.
    assert_eq!(timings[2], Timing { best: 32.0, spent: 32.0, runs: 1 });
    // A later race continues where the first one ended.
    race(&mut timings, 2.0, 3, &mut run);
    assert_eq!(timings.map(|timing| timing.runs), [4, 16, 1]);
    assert_eq!(order[..9], [0, 1, 2, 1, 1, 1, 0, 1, 1]);
}

#[test]
fn cells_are_quoted_and_aligned() {
    assert_eq!(quoted("a \"b\", c"), "\"a \"\"b\"\", c\"");
    let table = markdown(&["a", "b"], 1, &[vec!["x".into(), "1".into()]]);
    assert_eq!(table, "| a | b |\n| --- | ---: |\n| x | 1 |\n");
}

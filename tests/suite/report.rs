//! The report, measured small: every section, every file, every column.

use wheelrail::scene::{Scene, parse};
use wheelrail_report::measurements::{Effort, Measurements, measure};
use wheelrail_report::page::{FILES, PAGE, excerpt, page, sections};
use wheelrail_report::processes::PROCESSES;
use wheelrail_report::rates::Extent;
use wheelrail_report::reference::{FILES as SCENES, references};

fn small() -> Measurements {
    let effort = Effort {
        sides: vec![8, 20],
        seconds: 0.0,
        growth: vec![10, 20],
        every_pair: 50,
        every_case: 15,
        spacings: vec![2.0],
        sweeps: Extent { positions: 3, amplitude: 0.2, instruments: vec![[0.5, 3.0]] },
        case_side: 20,
    };
    measure(&effort, &mut |_| {}).expect("a measurement")
}

#[test]
fn every_section_and_file_is_there() {
    let measurements = small();
    let sections = sections(&measurements);
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
    assert!(excerpt(&measurements, &origin).contains("`wheelrail report`"));
}

#[test]
fn accuracy_csv_has_its_columns_and_every_row() {
    let measurements = small();
    let sections = sections(&measurements);
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
    assert!(measurements.threads.iter().all(|row| row.same_bits));
}

/// The scenes that are timed as whole processes stand alone, and say what the examples say.
#[test]
fn timed_processes_are_those_of_the_examples() {
    for (process, example) in PROCESSES.iter().zip(["wheelset", "60e1_s1002"]) {
        let path = format!("{}/examples/scenes/{example}.toml", env!("CARGO_MANIFEST_DIR"));
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
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/crates/report/src/reference");
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

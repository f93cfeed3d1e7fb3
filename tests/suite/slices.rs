//! Scenes over rails that vary along the track and wheels that vary around: `tests/profiles/slices`.

use crate::common::repository;
use std::path::PathBuf;

use wheelrail::case::{Run, SILENT};
use wheelrail::profile::{Section, Side};
use wheelrail::scene::{self, Scene};

fn folder() -> PathBuf {
    repository("tests/profiles/slices")
}

fn scene(rail: &str, wheel: &str) -> Scene {
    let text = format!(
        "[rail]\n{rail}\n[wheel]\n{wheel}\nradius = 460.0\n[contact]\noffset = 0.0\n[patch]\napproach = 0.05\n[motion]\n\
         speed = 20.0\n"
    );
    scene::parse(&text, false).unwrap()
}

const RAIL: &str = "file = \"rail.slcs\"\nmirror = false\nflip_z = false\nalong = ";
const WHEEL: &str = "file = \"wheel.slcw\"\nmirror = false\nflip_z = false\nangle = ";

fn complaint(rail: &str, wheel: &str) -> String {
    scene::resolve(&scene(rail, wheel), &folder(), "")
        .err()
        .map(|error| error.to_string())
        .unwrap_or_default()
}

#[test]
fn a_section_runs_and_its_summary_says_where_it_is() {
    let scene = scene(&format!("{RAIL}130.0"), &format!("{WHEEL}0.35"));
    let run = Run::new(scene::resolve(&scene, &folder(), "").unwrap(), SILENT).unwrap();
    assert!(run.refusals().is_empty(), "{:?}", run.refusals());
    let [rail, wheel] =
        run.case.measured().both().map(|record| record.as_ref().unwrap().cut.clone().unwrap());
    assert_eq!((rail.along, rail.angle), (Some(130.0), None));
    let files: Vec<_> = rail.slices.iter().map(|slice| slice.file.as_str()).collect();
    assert_eq!(files, ["rail-b.txt", "rail-c.txt"]);
    assert_eq!((wheel.along, wheel.angle, wheel.slices.len()), (None, Some(0.35), 2));
    let creepages = run.creepages(&run.parts[0]).unwrap().unwrap();
    assert!(creepages.longitudinal.abs() < 1e-15, "{creepages:?}");
}

/// A flat is a wheel that is higher by its depth there. Between slices a point slides along the path by what their lengths
/// differ by, 0.03 mm times its share, which the slope turns into height.
#[test]
fn the_middle_of_a_flat_is_as_deep_as_its_slice() {
    let height = |angle: f64| {
        let scene = scene(&format!("{RAIL}0.0"), &format!("{WHEEL}{angle}\ncurve = \"interpolation\""));
        let case = scene::resolve(&scene, &folder(), "").unwrap();
        let run = Run::new(case, SILENT).unwrap();
        Section::own_axes(run.parts[0].site.contact.placement.wheel().profile(), Side::Wheel).height(0.0)
    };
    let degree = std::f64::consts::PI / 180.0;
    for (angle, depth) in [(20.0, 0.9), (18.5, 0.45), (22.0, 0.3), (90.0, 0.0), (380.0, 0.9)] {
        let found = height(angle * degree);
        let bound = if angle == 18.5 || angle == 22.0 { 2e-5 } else { 1e-9 };
        assert!((found - depth).abs() < bound, "{angle}: {found}");
    }
}

#[test]
fn bad_scenes_name_the_file_and_the_key() {
    let (rail, wheel) = (format!("{RAIL}50.0"), format!("{WHEEL}0.3"));
    for (rail, wheel, expected) in [
        (RAIL.replace("\nalong = ", ""), wheel.clone(), "rail.slcs: along: found no `along` for 3 slices;"),
        (
            format!("{RAIL}-1.0"),
            wheel.clone(),
            "rail.slcs: along: found -1 mm; expected a place from 0 to 200 mm;",
        ),
        (rail.clone(), rail.clone(), "found slices of a rail; expected slices of a wheel, in a file .slcw;"),
        (
            wheel.clone(),
            wheel.clone(),
            "found slices of a wheel; expected slices of a rail, in a file .slcs;",
        ),
        (rail.replace("rail.slcs", "none.slcs"), wheel.clone(), "none.slcs: found no such file;"),
        (
            "file = \"rail-a.txt\"\nalong = 5.0".into(),
            wheel.clone(),
            "along: found an option without effect;",
        ),
        (
            "profile = \"60E1\"\nalong = 5.0".into(),
            wheel.clone(),
            "rail: found `along`; expected keys of measured",
        ),
    ] {
        let found = complaint(&rail, &wheel);
        assert!(found.contains(expected), "{rail}: {found}");
    }
    let folder = tempfile::tempdir().unwrap();
    std::fs::copy(self::folder().join("rail.slcs"), folder.path().join("rail.slcs")).unwrap();
    let scene = scene(&rail, "profile = \"S1002\"");
    let found =
        scene::resolve(&scene, folder.path(), "").err().map(|error| error.to_string()).unwrap_or_default();
    assert!(found.contains("rail.slcs: ") && found.contains("rail-a.txt: found no such file;"), "{found}");
}

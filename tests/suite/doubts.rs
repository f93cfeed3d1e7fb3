//! What is possible but seldom meant is a warning with its number; what engineers mean is none.

use std::path::Path;

use wheelrail::case::{Run, SILENT};
use wheelrail::{Result, scene};

/// Returns the warnings of a scene.
fn warnings(text: &str, folder: &Path) -> Result<Vec<String>> {
    let case = scene::resolve(&scene::parse(text, false)?, folder, "doubts")?;
    Ok(Run::new(case, SILENT)?.warnings())
}

fn pair(rail: &str, wheel: &str, rest: &str) -> String {
    format!(
        "[rail]\nprofile = \"60E1\"\n{rail}\n[wheel]\nprofile = \"S1002\"\nradius = 460.0\n{wheel}\n{rest}\n[output]\nformats = []\n"
    )
}

#[test]
fn slips_are_spoken_of_with_their_number() -> Result<()> {
    let touching = "[contact]\noffset = 0.0\n[patch]\napproach = 0.05";
    let cases = [
        (pair("rotate = 0.25", "", touching), "rail: rotate: 0.25 rad is 14.3 degrees"),
        (pair("", "", "[contact]\noffset = 0.0\n[patch]\nload = 80.0"), "patch: load: 80 N is the weight of 8.2 kg"),
        (
            pair("", "", &format!("{touching}\n[material]\nrail_youngs_modulus = 210.0")),
            "material: rail_youngs_modulus: 2.1e2 N/mm² is no metal's: steel has 2.1e5; it looks like GPa",
        ),
        (
            pair("", "", "[contact]\nrail_x = -20.0\nwheel_x = 0.0\n[patch]\napproach = 0.05"),
            "contact: the tangents at rail_x and wheel_x differ by 7.07",
        ),
        (pair("", "", "[contact]\noffset = 0.0\n[patch]\napproach = 1.5"), "an approach of 1.5000 mm: wheels and rails"),
        (pair("", "", "[contact]\noffset = 60.0\n[patch]\napproach = 0.05"), "stands on the tip of its flange"),
        (pair("", "shift = [0.0, 20.0]", touching), "the rolling radius, 441."),
        (
            pair("", "", touching).replace(
                "profile = \"60E1\"",
                "segments = [{ line = { from = [-40.0, -8.0], to = [0.0, 0.0] } }, { line = { from = [0.0, 0.0], to = [40.0, -2.0] } }]",
            ),
            "rail: segments 1 and 2 meet at x = 0.000 mm with a kink of -14.2 degrees",
        ),
    ];
    for (text, expected) in cases {
        let found = warnings(&text, Path::new("."))?;
        assert!(found.iter().any(|warning| warning.contains(expected)), "{expected}: {found:?}");
    }
    Ok(())
}

#[test]
fn the_examples_leave_no_doubt() -> Result<()> {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/examples/scenes"));
    let mut read = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let Ok(case) = scene::resolve(&scene::load(&path)?, folder, "example") else {
            panic!("{}", path.display());
        };
        let doubts: Vec<String> = Run::new(case, SILENT)?.warnings();
        let slips = [
            "angles are in rad",
            "tilted",
            "loads are in N",
            "no metal's",
            "flange: check",
            "rolling radius",
        ];
        let slipped = doubts.iter().find(|doubt| slips.iter().any(|slip| doubt.contains(slip)));
        assert_eq!(slipped, None, "{}", path.display());
        read += 1;
    }
    assert!(read >= 5, "{read}");
    Ok(())
}

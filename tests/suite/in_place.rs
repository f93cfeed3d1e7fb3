//! Contacts, bodies and patches lie where they are on the track.

use std::path::Path;

use tempfile::TempDir;
use wheelrail::case::{RUN_FOLDER, Run, SILENT, WrittenPart, write};
use wheelrail::files::Folder;
use wheelrail::mesh::axle_point;
use wheelrail::nalgebra::{Matrix4, Point3};
use wheelrail::search::TrackSide;
use wheelrail::{Result, scene};

/// Rounding of places on a track \[mm\].
const ROUNDING: f64 = 1e-8;

/// Distance of the middle of the axle from the wheel profiles' origins of the scenes \[mm\].
const HALF: f64 = 750.0;

fn wheelset(lateral: f64, yaw: f64) -> String {
    format!(
        "[rail]\nprofile = \"UIC60\"\nrotate = \"1:20\"\n[wheel]\nprofile = \"S1002\"\nradius = 460.0\n[right.wheel]\nradius = 459.0\n\
         profile = \"S1002\"\n[left.deviation]\nvertical = 1.0\nlateral = 0.5\nroll = 0.002\n[track]\ngauge = 1435.0\n\
         [wheelset]\nback_to_back = 1360.0\nflange_back_x = -70.0\nlateral = {lateral:?}\nyaw = {yaw:?}\n[patch]\napproach = 0.05\n\
         [output]\nformats = [\"vtk\"]\n"
    )
}

/// Runs a scene, and gives the run, what was written, and the folder.
fn written(text: &str) -> Result<(Run, Vec<WrittenPart>, TempDir)> {
    let case = scene::resolve(&scene::parse(text, false)?, Path::new("."), "in place")?;
    let (run, dir) = (Run::new(case, SILENT)?, TempDir::new().unwrap());
    let folder = Folder::create(&dir.path().join("out"), RUN_FOLDER)?;
    let parts = write(&run, &folder, None, SILENT)?;
    folder.commit()?;
    Ok((run, parts, dir))
}

fn transform(part: &WrittenPart) -> Matrix4<f64> {
    let rows = &part.summary["contact_to_track"];
    Matrix4::from_fn(|row, column| rows[row][column].as_f64().unwrap())
}

/// Both sides put the middle of the axle at one place: at the lateral displacement, with y = 0, at one height.
#[test]
fn both_sides_agree_where_the_axle_is() -> Result<()> {
    for (lateral, yaw) in [(0.0, 0.0), (3.0, 0.0), (-2.0, 0.01), (5.5, -0.008)] {
        let (run, parts, _dir) = written(&wheelset(lateral, yaw))?;
        let mut middles = Vec::new();
        for (part, written) in run.parts.iter().zip(&parts) {
            let place = transform(written);
            let side = part.site.side().unwrap();
            let turned = place.fixed_view::<3, 3>(0, 0).determinant();
            assert!(
                (turned - if side == TrackSide::Left { -1.0 } else { 1.0 }).abs() < 1e-12,
                "{side}: {turned}"
            );
            let middle = place.transform_point(&axle_point(&part.site.contact.placement, -HALF));
            assert!((middle.x - lateral).abs() < ROUNDING && middle.y.abs() < ROUNDING, "{side}: {middle}");
            let found = part.site.contact.found.as_ref().unwrap();
            if found.contact == 1 {
                middles.push(middle);
            }
        }
        assert_eq!(middles.len(), 2);
        assert!((middles[0] - middles[1]).norm() < ROUNDING, "{lateral} {yaw}: {middles:?}");
    }
    Ok(())
}

/// A single wheel's contact lies at its place in the rail profile's axes.
#[test]
fn a_single_contact_lies_on_its_rail() -> Result<()> {
    let text = "[rail]\nprofile = \"60E1\"\n[wheel]\nprofile = \"S1002\"\nradius = 460.0\n[contact]\noffset = 2.0\nyaw = 0.01\n\
                [patch]\napproach = 0.05\n[output]\nformats = [\"vtk\"]\n";
    let (run, parts, dir) = written(text)?;
    let station = run.parts[0].site.contact.placement.rail().point().station;
    let point = transform(&parts[0]).transform_point(&Point3::origin());
    assert_eq!([point.x, point.z], [station.x, station.z]);
    let found = run.parts[0].site.contact.found.as_ref().unwrap();
    assert!((point.y - found.place.y_mm).abs() < ROUNDING, "{point} {found:?}");
    // Every block of the file exists beside it.
    let text = std::fs::read_to_string(dir.path().join("out/wheelset.vtm")).unwrap();
    let files: Vec<&str> = text.split("file=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
    assert_eq!(files.len(), 5, "{text}");
    for file in files {
        assert!(dir.path().join("out").join(file).is_file(), "{file}");
        assert!(parts[0].files.iter().any(|written| written.name == file && written.size > 0), "{file}");
    }
    Ok(())
}

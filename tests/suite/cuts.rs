//! Sections through bodies that vary go through the places of contact.

use crate::common::repository;
use wheelrail::error::Result;
use wheelrail::scene::{self, Scene};
use wheelrail::search::{Cut, March, SweepRow, TrackSide};

/// Largest distance \[mm\] of a place from the polyline of a section: what a chord of 0.5 mm of a 13 mm radius is off by.
const NEAR: f64 = 3e-3;

/// A march of one of the examples, with the wheelset yawed.
fn example(name: &str, yaw: f64) -> Result<March> {
    let folder = repository("examples").join(name);
    let mut scene: Scene = scene::load(&folder.join(format!("{name}.toml")))?;
    if let Some(wheelset) = &mut scene.wheelset {
        wheelset.yaw = yaw;
    }
    scene::march(&scene, &folder).map(|found| found.march)
}

/// Distance of a point from the nearest of some polylines.
fn distance(pieces: &[Vec<[f64; 2]>], [x, z]: [f64; 2]) -> f64 {
    let of_line = |[[x0, z0], [x1, z1]]: [[f64; 2]; 2]| {
        let [dx, dz] = [x1 - x0, z1 - z0];
        let share = ((x - x0) * dx + (z - z0) * dz) / (dx * dx + dz * dz);
        let share = if share.is_nan() { 0.0 } else { share.clamp(0.0, 1.0) };
        (x - x0 - share * dx).hypot(z - z0 - share * dz)
    };
    let lines = pieces.iter().flat_map(|piece| piece.windows(2).map(|pair| [pair[0], pair[1]]));
    lines.map(of_line).fold(f64::INFINITY, f64::min)
}

/// The cut of a side through the place of a row.
fn cut(march: &March, row: &SweepRow, [along, pitch]: [f64; 2]) -> Option<Cut> {
    let right = row.side == TrackSide::Right;
    let (side, sign) = if right { (march.system.right(), 1.0) } else { (march.system.left(), -1.0) };
    let stands = [march.system.along(right, &march.position, along), pitch];
    side.cut(stands, sign * march.position.yaw, row.contact.y)
}

#[test]
fn the_section_of_a_crossing_holds_its_places_of_contact() -> Result<()> {
    for yaw in [0.0, 0.01] {
        let march = example("crossing", yaw)?;
        for along in [-100.0, 0.0, 122.0, 123.0, 150.0, 299.0] {
            for row in march.at(along)?.rows {
                let place = format!("yaw {yaw}, {along} mm, {row:?}");
                let (TrackSide::Right, Some(Cut::Rail(pieces))) = (row.side, cut(&march, &row, [along, 0.0]))
                else {
                    // The left-hand rail has one profile.
                    assert!(row.side == TrackSide::Left && cut(&march, &row, [along, 0.0]).is_none());
                    continue;
                };
                assert!(distance(&pieces, [row.contact.rail_x, row.contact.rail_z]) < NEAR, "{place}");
                assert!(pieces.iter().map(Vec::len).sum::<usize>() > 100, "{place}");
            }
        }
        let beyond = march.system.right().cut([1e4, 0.0], yaw, 0.0);
        assert_eq!(beyond, Some(Cut::Rail(Vec::new())));
    }
    Ok(())
}

#[test]
fn the_section_of_a_wheel_with_a_flat_holds_its_places_of_contact() -> Result<()> {
    for yaw in [0.0, 0.01] {
        let march = example("wheel_flat", yaw)?;
        for pitch in [-0.2, -0.06, -0.03, 0.0, 0.001, 0.05] {
            for row in march.turned(pitch)?.rows {
                let Some(Cut::Wheel(pieces)) = cut(&march, &row, [0.0, pitch]) else { panic!("no wheel") };
                let place = [row.contact.wheel_x, 460.0 - row.contact.rolling_radius];
                let off = distance(&pieces, place);
                assert!(off < NEAR && pieces.len() == 1, "yaw {yaw}, {pitch} rad: {off} mm off, {row:?}");
            }
        }
        // A plane beyond the wheel cuts none of it.
        assert_eq!(march.system.right().cut([0.0; 2], yaw, 600.0), Some(Cut::Wheel(Vec::new())));
    }
    Ok(())
}

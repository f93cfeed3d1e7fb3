//! What the page of a sweep shows: the usual curves, and the pair of profiles at every position.

use super::columns::Columns;
use super::curves::curves;
use super::input::Case;
use super::polylines::pairs;
use crate::error::Result;
use crate::export::{CurvesPanel, CurvesPicture, PlottedCurve, SweepCurve, SweepPage, SweepPanel, SweepSide};
use crate::search::{Position, Roll, WheelsetOnTrack};

/// Makes the page of a sweep from its columns, over the lateral displacements \[mm\] of all its positions; these have to ascend,
/// and `columns` may lack those without contact. `about` stands below the names of the profiles.
///
/// # Errors
/// Lateral displacements that do not ascend.
pub fn sweep_page(
    case: &Case,
    system: &WheelsetOnTrack,
    columns: &Columns,
    lateral: &[f64],
    about: &str,
) -> Result<SweepPage> {
    // The title of the scene may name its one position.
    let picture = curves(columns, lateral, &case.profiles.right.names(), about)?;
    Ok(page_of(case, system, columns, lateral, picture))
}

/// Makes the page of the panels of a picture.
pub(super) fn page_of(
    case: &Case,
    system: &WheelsetOnTrack,
    columns: &Columns,
    lateral: &[f64],
    picture: CurvesPicture,
) -> SweepPage {
    SweepPage {
        title: picture.title,
        about: picture.about,
        version: env!("CARGO_PKG_VERSION").into(),
        abscissa: picture.abscissa,
        lateral: lateral.to_vec(),
        panels: picture.quantities.into_iter().map(panel).collect(),
        pairs: pairs(&case.profiles),
        sides: [false, true].map(|right| side(case, system, columns, lateral, right)).into(),
        figures: Vec::new(),
        map: None,
        findings: Vec::new(),
    }
}

fn panel(panel: CurvesPanel) -> SweepPanel {
    let curve = |PlottedCurve { name, points, jumps }| SweepCurve {
        name,
        values: points.into_iter().map(|[_, value]| value).collect(),
        jumps,
    };
    let title = panel.heading();
    let curves = panel.curves.into_iter().map(curve).collect();
    SweepPanel { title, axis: panel.axis, curves, shown: panel.shown }
}

/// Gives where the wheel of a side is at every position, and its contacts.
fn side(case: &Case, system: &WheelsetOnTrack, columns: &Columns, lateral: &[f64], right: bool) -> SweepSide {
    let on_track = if right { system.right() } else { system.left() };
    let mut out = SweepSide {
        right,
        pair: usize::from(!right && case.profiles.left.is_some()),
        rail: [on_track.track().rail_x(), on_track.track().rail_z()],
        places: vec![f64::NAN; 3 * lateral.len()],
        position: Vec::new(),
        rail_x: Vec::new(),
        wheel_x: Vec::new(),
    };
    let value = |name: &str, row: usize| columns.quantity(name).map_or(f64::NAN, |column| column[row]);
    for row in (0..columns.rows()).filter(|&row| columns.right[row] == right) {
        let number = columns.position[row] as usize;
        out.position.push(number);
        out.rail_x.push(value("rail_x_mm", row));
        out.wheel_x.push(value("wheel_x_mm", row));
        let Some(place) = out.places.get_mut(3 * number..3 * number + 3) else { continue };
        let roll = value("roll_rad", row);
        let (lateral, yaw) = (value("lateral_mm", row), value("yaw_rad", row));
        let position = Position { lateral, yaw, roll: Roll::Fixed(roll) };
        let section = system.section(right, &position, roll, value("z_mm", row));
        let origin = section.translation.vector;
        place.copy_from_slice(&[origin.x, origin.y, section.rotation.angle()]);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::DoubtSet;
    use crate::search::{ONE_CONTACT, ParallelSweep, Selection};
    use nalgebra::Point2;

    /// The example's wheelset: the page puts both bodies' points of contact in one place.
    #[test]
    fn the_pair_of_profiles_touches_where_the_table_says() {
        let text = include_str!("../../examples/scenes/wheelset.toml").replace("yaw = 0.002", "yaw = 0.0");
        let scene = crate::scene::parse(&text, false).unwrap();
        let case = crate::scene::resolve(&scene, ".".as_ref(), "wheelset").unwrap();
        let crate::case::Place::Wheelset { system, .. } = &case.standing.place else { panic!("no wheelset") };
        let lateral = [-6.0, 0.0, 3.0, 7.0];
        let positions = lateral.map(|lateral| Position { lateral, yaw: 0.0, roll: Roll::Solve });
        let selection = Selection { within: 0.0, apart: ONE_CONTACT };
        let mut columns = Columns::default();
        let sweep = ParallelSweep { system, selection, conicity: None, positions: &positions };
        let rows = |chunk: &mut Columns, position, rows: &[_]| {
            rows.iter().for_each(|row| chunk.push(position, row, None, DoubtSet::default()));
            Ok(())
        };
        let all = |_, chunks: Vec<Columns>| {
            chunks.iter().for_each(|chunk| columns.extend(chunk));
            Ok(true)
        };
        sweep.blocks(rows, all).unwrap();
        let page = sweep_page(&case, system, &columns, &lateral, "").unwrap();
        let pair = &case.profiles.right.pair;
        for side in &page.sides {
            assert!(side.position.len() >= lateral.len());
            for (k, &number) in side.position.iter().enumerate() {
                let height = |profile: &crate::Profile, body: usize, x: f64| {
                    let [rail, wheel] = pair.sections();
                    [rail, wheel][body].point(profile, x).unwrap().station.z
                };
                let [x, z, angle] = [0, 1, 2].map(|j| side.places[3 * number + j]);
                let place = nalgebra::Isometry2::new(nalgebra::Vector2::new(x, z), angle);
                let wheel = Point2::new(side.wheel_x[k], height(pair.wheel(), 1, side.wheel_x[k]));
                let rail = Point2::new(side.rail_x[k], height(pair.rail(), 0, side.rail_x[k]));
                assert!((place * wheel - rail).norm() < 1e-9, "{number}: {} {rail}", place * wheel);
            }
        }
    }
}

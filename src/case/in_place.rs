//! Where a contact is on the track, and what files show of all of a run in the track's axes.
//!
//! The axes of a wheelset's track: x to the right, y forward, z up, the origin in the middle of the track at the top of rail,
//! with the middle of the axle at y = 0. For a single wheel they are the rail profile's axes, with the wheel's centre at y = 0.

use nalgebra::{Matrix4, Point3, Vector3, Vector4};

use super::drawn::{loops_of, quads};
use super::input::Arrangement;
use super::run::{Part, Run};
use crate::export::{ContactInPlace, InPlace, Loop, QuadMesh};
use crate::mesh::{BodyShell, axle_point};
use crate::placement::Placement;
use crate::search::TrackSide;
use crate::separation::Evaluator;

/// Half the length of rail that is shown \[mm\].
const RAIL: f64 = 300.0;

/// Half the arc of a wheel's rim that is shown \[rad\].
const RIM: f64 = 0.7;

/// Largest distance of shells from the bodies \[mm\]: too small to be seen, and a sweep of a hundred positions stays small.
const SHELL: f64 = 0.02;

/// Gives the transform from the contact frame of a part to the axes of the track, of homogeneous coordinates (ξ, η, ζ, 1). On a
/// left side it has a reflection: that side's own axes are the mirror image's.
pub(super) fn to_track(run: &Run, part: &Part) -> Matrix4<f64> {
    let placement = &part.site.contact.placement;
    let left = part.site.side() == Some(TrackSide::Left);
    let (rail, half) = match &run.case.setup.arrangement {
        Arrangement::Wheelset { system, .. } => {
            let side = if left { system.left() } else { system.right() };
            ([side.track().rail_x(), side.track().rail_z()], side.wheelset().wheel_x())
        }
        Arrangement::Points { .. } | Arrangement::Wheel { .. } | Arrangement::OnSlices { .. } => {
            ([0.0; 2], 0.0)
        }
    };
    if let Some(lofted) = placement.lofted_rail() {
        let [x, y, z] = lofted.origin();
        let origin = Vector4::new(x, y - run.case.setup.along, z, 1.0);
        let columns = lofted.axes().map(|[x, y, z]| Vector4::new(x, y, z, 0.0));
        let frame = Matrix4::from_columns(&[columns[0], columns[1], columns[2], origin]);
        return mirrored_to(left, rail) * frame;
    }
    let c = placement.rail().point.station;
    let in_meridian = Matrix4::from_columns(&[
        Vector4::new(c.cos, 0.0, c.sin, 0.0),
        Vector4::new(0.0, 1.0, 0.0, 0.0),
        Vector4::new(-c.sin, 0.0, c.cos, 0.0),
        Vector4::new(c.x, 0.0, c.z, 1.0),
    ]);
    let (radius, turn) = (placement.rail().generator().radius(), placement.turn());
    let upright = if radius.is_finite() {
        // The roller's meridian plane through C is turned forward by ν about its axle.
        let [to_axle, from_axle] =
            [radius, -radius].map(|up| Matrix4::new_translation(&Vector3::new(0.0, 0.0, up)));
        from_axle * Matrix4::from_axis_angle(&Vector3::x_axis(), -turn) * to_axle
    } else {
        Matrix4::new_translation(&Vector3::new(0.0, -axle_point(placement, -half).y, 0.0))
    };
    mirrored_to(left, rail) * upright * in_meridian
}

/// Gives the transform from the axes of a side's rail profile, at this place of the track, to those of the track.
fn mirrored_to(left: bool, rail: [f64; 2]) -> Matrix4<f64> {
    let mirrored = if left { -1.0 } else { 1.0 };
    let to_track = Matrix4::new_translation(&Vector3::new(rail[0], 0.0, rail[1]));
    Matrix4::new_nonuniform_scaling(&Vector3::new(mirrored, 1.0, 1.0)) * to_track
}

/// Gives what shows all of a run in the axes of the track: both rails, both wheels at first touch, patches, boundaries and contact
/// points, all where they are.
pub(super) fn in_place(run: &Run) -> InPlace {
    let on = |left: bool| run.parts.iter().find(|part| (part.site.side() == Some(TrackSide::Left)) == left);
    let sides = [false, true].into_iter().filter_map(on);
    let places: Vec<_> = sides.map(|part| (&part.site.contact.placement, to_track(run, part))).collect();
    let shells = |shell: fn(&Placement) -> BodyShell| {
        let shells = places.iter().map(|(placement, place)| {
            let BodyShell { points, faces } = shell(placement);
            BodyShell { points: points.iter().map(|point| moved(place, point)).collect(), faces }
        });
        joined(shells)
    };
    InPlace {
        statements: statements(run),
        rails: shells(|placement| BodyShell::rail(placement, RAIL, SHELL)),
        wheels: shells(|placement| BodyShell::wheel(placement, RIM, SHELL)),
        contacts: (1..).zip(&run.parts).map(|(k, part)| contact(run, part, k)).collect(),
    }
}

/// Gives the path from a part's folder to that of `wheelset.vtm`.
pub(super) fn beside(run: &Run, part: &Part) -> String {
    let root = run.parts.first().map_or("", |first| first.site.folder.as_str());
    if part.site.folder == root { ".".into() } else { format!("../{root}") }
}

/// Joins shells into one.
fn joined(shells: impl Iterator<Item = BodyShell>) -> BodyShell {
    shells.fold(BodyShell { points: Vec::new(), faces: Vec::new() }, |mut all, shell| {
        let first = all.points.len();
        all.points.extend(shell.points);
        all.faces
            .extend(shell.faces.into_iter().map(|face| face.into_iter().map(|node| first + node).collect()));
        all
    })
}

fn statements(run: &Run) -> Vec<String> {
    let axes = match run.case.setup.arrangement {
        Arrangement::Wheelset { .. } => {
            "track axes: x to the right, y forward, z up; origin in the middle, top of rail"
        }
        Arrangement::Points { .. } | Arrangement::Wheel { .. } | Arrangement::OnSlices { .. } => {
            "axes of the rail profile: x to the field side, y along, z up"
        }
    };
    vec![
        format!("title: {}", run.case.echo.title),
        format!("written by wheelrail {}", env!("CARGO_PKG_VERSION")),
        format!("scene {}", run.case.echo.hash),
        format!("lengths in mm; {axes}"),
        "wheels at first touch, before any approach".into(),
    ]
}

fn contact(run: &Run, part: &Part, number: usize) -> ContactInPlace {
    let placement = &part.site.contact.placement;
    let place = to_track(run, part);
    let approach = part.site.contact.approach.unwrap_or(f64::NAN);
    let patch = part.analysis.strips.as_ref().map(quads).unwrap_or_default();
    let mut evaluator = Evaluator::new(placement);
    let overlap =
        patch.points.iter().map(|point| approach - evaluator.separation(point.x, point.y)).collect();
    let ring = |ring: Loop| Loop { points: ring.points.iter().map(|p| moved(&place, p)).collect(), ..ring };
    let loops = part.analysis.patch.as_ref().map_or_else(Vec::new, |patch| loops_of(placement, patch));
    ContactInPlace {
        number,
        point: moved(&place, &Point3::origin()),
        approach,
        vertical_load: part.site.vertical_load().unwrap_or(f64::NAN),
        patch: QuadMesh { points: patch.points.iter().map(|point| moved(&place, point)).collect(), ..patch },
        overlap,
        loops: loops.into_iter().map(ring).collect(),
    }
}

fn moved(place: &Matrix4<f64>, point: &Point3<f64>) -> Point3<f64> {
    place.transform_point(point)
}

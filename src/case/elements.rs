//! Meshes for finite elements and for viewers: the triangles of the patch and the surfaces of both bodies.

use nalgebra::{Unit, Vector3};

use super::formats::{SurfaceOf, Writer};
use super::input::Outputs;
use super::jobs::possible;
use super::run::Part;
use crate::error::Result;
use crate::export::{PatchMesh, SurfaceMesh};
use crate::mesh::{Surface, TriangleMesh};
use crate::patch::Patch;
use crate::placement::Placement;
use crate::separation::{Evaluator, Normals};

/// Gives both bodies around the patch, if files with them are asked for; a grid of one row or column has none.
pub(super) fn surfaces_around(
    outputs: &Outputs,
    part: &Part,
    skipped: &mut Vec<String>,
) -> Result<Option<[Surface; 2]>> {
    let names = "surfaces of rail and wheel";
    if !part.site.has_extent() {
        skipped.push(format!("{names}: the grid has no extent"));
        return Ok(None);
    }
    let contact = &part.site.contact;
    let surfaces = || Surface::around(&contact.placement, &part.site.window(), contact.approach);
    let of_bodies =
        |writer: &Writer| matches!(writer, Writer::Surface(SurfaceOf::Rail | SurfaceOf::Wheel, _));
    possible(outputs, names, of_bodies, surfaces, skipped)
}

/// Gives a body's surface as writers take it.
pub(super) fn surface_mesh(name: &'static str, part: &Part, body: &Surface) -> SurfaceMesh {
    SurfaceMesh {
        name,
        points: body.points.clone(),
        triangles: body.triangles(),
        separation: body.separations(&part.site.contact.placement),
        normals: body.normals.clone(),
    }
}

/// Gives the triangle mesh of the patch with its fields, if files with it are asked for; `None` without an approach, and for an
/// infeasible contact, whose overlap is no patch.
pub(super) fn triangles(
    outputs: &Outputs,
    part: &Part,
    skipped: &mut Vec<String>,
) -> Result<Option<PatchMesh>> {
    let Some(patch) = &part.analysis.patch else { return Ok(None) };
    let placement = &part.site.contact.placement;
    let names = "triangle mesh of the patch";
    if part.site.is_infeasible() {
        skipped.push(format!("{names}: the contact is infeasible"));
        return Ok(None);
    }
    let mesh = || patch_mesh(placement, patch, outputs.mesh_size);
    let of_patch =
        |writer: &Writer| matches!(writer, Writer::Triangles(_) | Writer::Surface(SurfaceOf::Patch, _));
    possible(outputs, names, of_patch, mesh, skipped)
}

/// Makes the triangle mesh of a patch with what its nodes and components carry; `size` \[mm\] is the length of its edges, which the
/// patch decides if none is given.
///
/// # Errors
/// The errors of [`TriangleMesh::new`].
pub fn patch_mesh(placement: &Placement, patch: &Patch, size: Option<f64>) -> Result<PatchMesh> {
    let mesh = TriangleMesh::new(placement, patch, size)?;
    let areas = patch.components.iter().map(|component| component.area).collect();
    let mut evaluator = Evaluator::new(placement);
    let zero = |normal: Option<Unit<Vector3<f64>>>| normal.map_or_else(Vector3::zeros, Unit::into_inner);
    let (mut separation, mut rail_normals, mut wheel_normals) = (Vec::new(), Vec::new(), Vec::new());
    for point in &mesh.points {
        separation.push(evaluator.separation(point.x, point.y));
        let Normals { rail, wheel } = evaluator.normals(point.x, point.y);
        rail_normals.push(zero(rail));
        wheel_normals.push(zero(wheel));
    }
    Ok(PatchMesh { mesh, separation, rail_normals, wheel_normals, areas })
}

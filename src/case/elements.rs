//! Meshes for finite elements and for viewers: the triangles of the patch and the surfaces of both bodies.

use nalgebra::{Unit, Vector3};

use super::input::{OutputFormat, Outputs};
use super::jobs::{Job, bytes, possible};
use super::run::{Part, Run};
use crate::error::Result;
use crate::export::{
    Header, PatchMesh, SurfaceMesh, patch_inp, patch_msh, patch_vtu, surface_stl, surface_vtp, surface_vtu,
};
use crate::mesh::{Surface, TriangleMesh};
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
    let approach = contact.approach.map(|(approach, _)| approach);
    let surfaces = || Surface::around(&contact.placement, &part.site.window(), approach);
    possible(outputs, names, &OutputFormat::SURFACES, surfaces, skipped)
}

/// Gives a body's surface as writers take it.
pub(super) fn surface_mesh(part: &Part, body: &Surface) -> SurfaceMesh {
    SurfaceMesh {
        points: body.points.clone(),
        triangles: body.triangles(),
        separation: body.separations(&part.site.contact.placement),
        normals: body.normals.clone(),
    }
}

/// Gives the triangle mesh of the patch with its fields, if files with it are asked for; `None` without an approach, and for an
/// infeasible contact, whose overlap is no patch.
pub(super) fn triangles(run: &Run, part: &Part, skipped: &mut Vec<String>) -> Result<Option<PatchMesh>> {
    let Some(patch) = &part.analysis.patch else { return Ok(None) };
    let (outputs, placement) = (&run.case.outputs, &part.site.contact.placement);
    let names = "triangle mesh of the patch";
    if part.site.is_infeasible() {
        skipped.push(format!("{names}: the contact is infeasible"));
        return Ok(None);
    }
    let mesh = || {
        let mesh = TriangleMesh::new(placement, patch, outputs.mesh_size)?;
        let areas = patch.components.iter().map(|component| component.area).collect();
        Ok(with_fields(placement, mesh, areas))
    };
    possible(outputs, names, &OutputFormat::TRIANGLES, mesh, skipped)
}

fn with_fields(placement: &Placement, mesh: TriangleMesh, areas: Vec<f64>) -> PatchMesh {
    let mut evaluator = Evaluator::new(placement);
    let zero = |normal: Option<Unit<Vector3<f64>>>| normal.map_or_else(Vector3::zeros, Unit::into_inner);
    let (mut separation, mut rail_normals, mut wheel_normals) = (Vec::new(), Vec::new(), Vec::new());
    for point in &mesh.points {
        separation.push(evaluator.separation(point.x, point.y));
        let Normals { rail, wheel } = evaluator.normals(point.x, point.y);
        rail_normals.push(zero(rail));
        wheel_normals.push(zero(wheel));
    }
    PatchMesh { mesh, separation, rail_normals, wheel_normals, areas }
}

/// Adds the files of triangles: of the patch, and of both bodies around it.
pub(super) fn elements<'a>(
    jobs: &mut Vec<Job<'a>>,
    outputs: &Outputs,
    header: &'a Header,
    patch: Option<&'a PatchMesh>,
    bodies: Option<&'a [SurfaceMesh; 2]>,
) {
    let bodies = || bodies.into_iter().flatten();
    if outputs.any(&[OutputFormat::Vtk]) {
        for (name, body) in ["rail.vtu", "wheel.vtu"].into_iter().zip(bodies()) {
            bytes(jobs, name, move || surface_vtu(header, body));
        }
        if let Some(patch) = patch {
            bytes(jobs, "patch.vtu", move || patch_vtu(header, patch));
        }
    }
    if outputs.any(&[OutputFormat::Vtp]) {
        for (name, body) in ["rail.vtp", "wheel.vtp"].into_iter().zip(bodies()) {
            bytes(jobs, name, move || surface_vtp(header, body));
        }
        if let Some(patch) = patch {
            bytes(jobs, "patch.vtp", move || surface_vtp(header, &patch.surface()));
        }
    }
    if outputs.any(&[OutputFormat::Stl]) {
        for ((name, solid), body) in [("rail.stl", "rail"), ("wheel.stl", "wheel")].into_iter().zip(bodies())
        {
            bytes(jobs, name, move || surface_stl(solid, body));
        }
        if let Some(patch) = patch {
            bytes(jobs, "patch.stl", move || surface_stl("patch", &patch.surface()));
        }
    }
    if let (true, Some(patch)) = (outputs.any(&[OutputFormat::Gmsh]), patch) {
        bytes(jobs, "patch.msh", move || patch_msh(header, patch));
    }
    if let (true, Some(patch)) = (outputs.any(&[OutputFormat::Abaqus]), patch) {
        bytes(jobs, "patch.inp", move || patch_inp(header, patch));
    }
}

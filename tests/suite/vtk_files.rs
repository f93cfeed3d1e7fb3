//! VTK's XML files of patches: what each says, of nothing as well, and meshes that do not fit.

use wheelrail::export::{
    Frame, Header, Loop, PatchMesh, QuadMesh, SurfaceMesh, boundary_vtp, patch_vtu, strips_vtu, surface_vtp,
    surface_vtu,
};
use wheelrail::mesh::{BoundaryChain, TriangleMesh};
use wheelrail::nalgebra::{Isometry2, Point3, Vector3};

fn header() -> Header {
    Header {
        title: "a test".into(),
        version: "0.0.0".into(),
        scene_hash: "0123abcd".into(),
        approach: 0.05,
        frame: Frame::from(&Isometry2::identity()),
        remarks: Vec::new(),
    }
}

/// The corners of a square of 2 mm.
fn corners() -> Vec<Point3<f64>> {
    [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, y]| Point3::new(x, y, 0.0)).to_vec()
}

/// The square in one cell.
fn cell() -> QuadMesh {
    QuadMesh { points: corners(), quads: vec![[0, 1, 2, 3]], area: vec![4.0], component: vec![0] }
}

/// The square in two triangles.
fn triangles() -> PatchMesh {
    let mesh = TriangleMesh {
        component: vec![0; 2],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        boundary: vec![BoundaryChain { component: 0, nodes: vec![0, 1, 2, 3], angles: vec![1.5; 4] }],
        size: vec![2.0],
        chord_error: vec![0.01],
        made: vec![0],
        points: corners(),
    };
    PatchMesh {
        separation: vec![0.05; 4],
        rail_normals: vec![Vector3::z(); 4],
        wheel_normals: vec![-Vector3::z(); 4],
        areas: vec![4.0],
        mesh,
    }
}

#[test]
fn they_carry_frame_and_statements() {
    let square = Loop { component: 0, points: corners() };
    for file in [
        boundary_vtp(&header(), &[square]).unwrap(),
        boundary_vtp(&header(), &[]).unwrap(),
        strips_vtu(&header(), &cell()).unwrap(),
        strips_vtu(&header(), &QuadMesh::default()).unwrap(),
        patch_vtu(&header(), &triangles()).unwrap(),
        surface_vtu(&header(), &triangles().surface()).unwrap(),
        surface_vtp(&header(), &triangles().surface()).unwrap(),
        surface_vtp(&header(), &SurfaceMesh::default()).unwrap(),
    ] {
        let text = String::from_utf8_lossy(&file);
        assert!(text.contains("approach_mm") && text.contains("scene 0123abcd"), "{text}");
        assert!(!text.contains("<DataArray type=\"UInt64"), "{text}");
        assert!(text.contains("version=\"1.0\"") && text.trim_end().ends_with("</VTKFile>"), "{text}");
    }
}

#[test]
fn arrays_and_meshes_that_do_not_fit_are_refused() {
    let mut broken = cell();
    broken.area.pop();
    assert!(strips_vtu(&header(), &broken).unwrap_err().place.contains("areas"));
    let mut surface = triangles().surface();
    surface.triangles[0][2] = surface.points.len();
    assert!(surface_vtu(&header(), &surface).is_err() && surface_vtp(&header(), &surface).is_err());
    let mut patch = triangles();
    patch.areas.clear();
    assert!(patch_vtu(&header(), &patch).is_err());
}

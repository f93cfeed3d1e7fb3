//! Sample data for the writers' tests: a paraboloid, undefined at one corner.

use nalgebra::{Isometry2, Point3, Translation2, UnitComplex, Vector3};

use super::model::{Frame, GridFields, Header, Loop, PatchMesh, QuadMesh};
use crate::mesh::{BoundaryChain, TriangleMesh};

/// A grid that owns its arrays.
pub(super) struct Sample {
    pub(super) xi: Vec<f64>,
    pub(super) eta: Vec<f64>,
    pub(super) separation: Vec<f64>,
    pub(super) rail_height: Vec<f64>,
    pub(super) rail_normal: Vec<[f64; 2]>,
}

impl Sample {
    /// Makes n_ξ × n_η points 0.1 mm apart.
    pub(super) fn new(n_xi: usize, n_eta: usize) -> Self {
        let axis = |n: usize| (0..n).map(|i| (i as f64 - (n - 1) as f64 / 2.0) * 0.1).collect::<Vec<_>>();
        let (xi, eta) = (axis(n_xi), axis(n_eta));
        let rail_height: Vec<f64> = xi.iter().map(|x| -x * x / 600.0).collect();
        let rail_normal = xi.iter().map(|x| [x / 300.0, (1.0 - x * x / 9e4).sqrt()]).collect();
        let mut separation: Vec<f64> =
            xi.iter().flat_map(|x| eta.iter().map(move |y| x * x / 600.0 + y * y / 920.0)).collect();
        separation[0] = f64::NAN;
        Self { xi, eta, separation, rail_height, rail_normal }
    }

    pub(super) fn fields(&self) -> GridFields<'_> {
        GridFields::new(&self.xi, &self.eta, &self.separation, &self.rail_height, &self.rail_normal).unwrap()
    }
}

pub(super) fn header() -> Header {
    let turn = UnitComplex::from_cos_sin_unchecked(0.8, 0.6);
    Header {
        title: "a test".into(),
        version: "0.0.0".into(),
        scene_hash: "0123abcd".into(),
        approach: 0.05,
        frame: Frame::from(&Isometry2::from_parts(Translation2::new(10.0, -0.2), turn)),
        remarks: Vec::new(),
    }
}

/// Returns the square |ξ|, |η| ≤ 1 in four cells.
pub(super) fn mesh() -> QuadMesh {
    let points = (0..9).map(|i| Point3::new(f64::from(i / 3) - 1.0, f64::from(i % 3) - 1.0, 0.0)).collect();
    let quads = [0, 1, 3, 4].map(|a| [a, a + 3, a + 4, a + 1]).to_vec();
    QuadMesh { points, quads, area: vec![1.0; 4], component: vec![0, 0, 1, 1] }
}

/// Returns the square |ξ|, |η| ≤ 1 as eight triangles with nine nodes, with 7 mm² as its area.
pub(super) fn patch_mesh() -> PatchMesh {
    let QuadMesh { points, quads, .. } = mesh();
    let triangles: Vec<[usize; 3]> = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    let chain = BoundaryChain { component: 0, nodes: vec![0, 3, 6, 7, 8, 5, 2, 1], angles: vec![1.5; 8] };
    let mesh = TriangleMesh {
        component: vec![0; triangles.len()],
        triangles,
        boundary: vec![chain],
        size: vec![1.0],
        chord_error: vec![0.01],
        made: vec![0],
        points,
    };
    let nodes = mesh.points.len();
    PatchMesh {
        separation: vec![0.05; nodes],
        rail_normals: vec![Vector3::z(); nodes],
        wheel_normals: vec![-Vector3::z(); nodes],
        areas: vec![7.0],
        mesh,
    }
}

pub(super) fn square() -> Loop {
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    Loop { component: 0, points: corners.map(|[x, y]| Point3::new(x, y, 0.0)).to_vec() }
}

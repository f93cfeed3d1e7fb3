//! The one module that uses parry3d: triangle meshes, rays along ζ, closest points.
//!
//! It uses parry's f64 build: f32 has 5e-5 mm of noise at the axle's distance, and its distance between triangles was found
//! to return a false 0. For meshes with NaN parry returns a distance of 0; [`Mesh::new`] refuses them.

use parry3d_f64::math::Pose;
use parry3d_f64::query::details::local_ray_intersection_with_triangle;
use parry3d_f64::query::{ClosestPoints, PointQueryWithLocation, Ray, RayCast, closest_points};
use parry3d_f64::shape::TriMesh;

/// A point or direction (ξ, η, ζ) of the contact frame \[mm\]; glam's type, which parry takes.
pub(super) type Vector = parry3d_f64::math::Vector;

/// A triangle mesh.
pub(super) struct Mesh(TriMesh);

/// The place where a query met a mesh.
#[derive(Debug, Clone, Copy)]
pub(super) struct Hit {
    /// Index of the triangle.
    pub triangle: usize,
    /// Barycentric weights of the triangle's three corners.
    pub weights: [f64; 3],
    /// Coordinates of the point \[mm\].
    pub point: Vector,
}

/// The place on ζ from which a ray starts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum RayOrigin {
    /// Below everything: the ray goes up and meets the lowest sheet.
    Below,
    /// Above everything: the ray goes down and meets the highest sheet.
    Above,
    /// At this ζ \[mm\]: the ray goes up.
    UpFrom(f64),
    /// At this ζ \[mm\]: the ray goes down.
    DownFrom(f64),
}

impl Mesh {
    /// Makes a mesh, or `None` if there is no triangle or a vertex is not finite.
    pub fn new(vertices: Vec<Vector>, triangles: Vec<[u32; 3]>) -> Option<Self> {
        if vertices.iter().any(|v| !v.is_finite()) {
            return None;
        }
        TriMesh::new(vertices, triangles).ok().map(Self)
    }

    /// Returns where a line parallel to ζ meets the mesh first. Through an edge or a vertex it may miss the mesh, so that lines `nudge` \[mm\]
    /// beside it are tried, too.
    pub fn along_zeta_beside(&self, xi: f64, eta: f64, origin: RayOrigin, nudge: f64) -> Option<Hit> {
        let beside = [[0.0, 0.0], [1.0, 0.7], [-0.7, 1.0], [-1.0, -0.6], [0.6, -1.0]];
        beside.iter().find_map(|[a, b]| self.along_zeta(xi + a * nudge, eta + b * nudge, origin))
    }

    /// Returns where the ray through (ξ, η) along ζ first meets the mesh; `None` if it misses the mesh.
    ///
    /// Rays from below or above start close to the mesh's box: a longer ray would lose digits.
    pub fn along_zeta(&self, xi: f64, eta: f64, origin: RayOrigin) -> Option<Hit> {
        let bounds = self.0.local_aabb();
        let margin = bounds.extents().max_element();
        let (start, direction) = match origin {
            RayOrigin::Below => (bounds.mins.z - margin, Vector::Z),
            RayOrigin::Above => (bounds.maxs.z + margin, -Vector::Z),
            RayOrigin::UpFrom(zeta) => (zeta, Vector::Z),
            RayOrigin::DownFrom(zeta) => (zeta, -Vector::Z),
        };
        let ray = Ray::new(Vector::new(xi, eta, start), direction);
        let triangle = self.0.cast_local_ray_and_get_normal(&ray, f64::MAX, false)?.subshape as usize;
        let [a, b, c] = self.corners(triangle);
        let (_, weights) = local_ray_intersection_with_triangle(a, b, c, &ray)?;
        let zeta = a.z + (b.z - a.z) * weights.y + (c.z - a.z) * weights.z;
        Some(Hit { triangle, weights: weights.to_array(), point: Vector::new(xi, eta, zeta) })
    }

    /// Returns the point of the mesh that is closest to `point`.
    pub fn closest_to(&self, point: Vector) -> Hit {
        let (projection, (triangle, location)) = self.0.project_local_point_and_get_location(point, false);
        let weights = location.barycentric_coordinates().unwrap_or([f64::NAN; 3]);
        Hit { triangle: triangle as usize, weights, point: projection.point }
    }

    /// Returns the closest points of two meshes, or `None` if they touch or overlap.
    pub fn closest_pair(&self, other: &Self) -> Option<[Vector; 2]> {
        let here = Pose::IDENTITY;
        match closest_points(&here, &self.0, &here, &other.0, f64::MAX) {
            Ok(ClosestPoints::WithinMargin(own, others)) => Some([own, others]),
            _ => None,
        }
    }

    /// Returns the number of triangles.
    pub fn len(&self) -> usize {
        self.0.num_triangles()
    }

    /// Returns the corners of a triangle.
    pub fn corners(&self, triangle: usize) -> [Vector; 3] {
        let t = self.0.triangle(triangle as u32);
        [t.a, t.b, t.c]
    }

    /// Returns the unit normal of a triangle, right-handed by the order of its corners.
    pub fn normal(&self, triangle: usize) -> Vector {
        let [a, b, c] = self.corners(triangle);
        (b - a).cross(c - a).normalize()
    }
}

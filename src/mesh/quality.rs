//! Measures how well shaped the cells of a mesh are, by the numbers that mesh generators report.

use nalgebra::{Point3, Vector3};
use serde::Serialize;

use super::strips::StripMesh;
use super::surfaces::Surface;
use super::triangles::TriangleMesh;
use crate::numerics::interval::Interval;

/// The least, largest and mean value over all cells.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct QualityRange {
    /// Least value.
    pub min: f64,
    /// Largest value.
    pub max: f64,
    /// Mean value.
    pub mean: f64,
}

/// The shape of the straight-sided cells of a mesh.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Quality {
    /// Number of cells, triangles included.
    pub cells: usize,
    /// Number of cells with three corners.
    pub triangles: usize,
    /// Number of cells with a corner that turns the wrong way or not at all; 0 in a sound mesh.
    pub inverted: usize,
    /// Longest side over shortest side, at least 1.
    pub aspect_ratio: QualityRange,
    /// Equiangle skewness, from 0 (square, equilateral) to 1 (flat): the larger of (θ_max − θ_e)/(π − θ_e) and (θ_e −
    /// θ_min)/θ_e, with θ_e = π/2 for quads or π/3 for triangles.
    pub skewness: QualityRange,
    /// Smallest angle of a cell \[rad\], up to π/2.
    pub smallest_angle_rad: QualityRange,
}

impl Quality {
    /// Measures the cells of a strip mesh in the ξ–η plane. Returns `None` without cells.
    pub fn of_strips(mesh: &StripMesh) -> Option<Self> {
        let flat = |&k: &usize| Point3::new(mesh.points[k].x, mesh.points[k].y, 0.0);
        let shape = |corners: &[usize]| {
            let corners: Vec<_> = corners.iter().map(flat).collect();
            CellShape::new(&corners, &Vector3::z())
        };
        Self::of(mesh.cells.iter().map(|cell| shape(cell.vertices())))
    }

    /// Measures the cells of the triangle mesh of a patch in the ξ–η plane. Returns `None` without cells.
    pub fn of_triangles(mesh: &TriangleMesh) -> Option<Self> {
        let flat = |node: usize| Point3::new(mesh.points[node].x, mesh.points[node].y, 0.0);
        Self::of(mesh.triangles.iter().map(|cell| CellShape::new(&cell.map(flat), &Vector3::z())))
    }

    /// Measures the triangles of a surface. Returns `None` without triangles.
    pub fn of_surface(surface: &Surface) -> Option<Self> {
        let corners = |facet: &[usize]| facet.iter().map(|&k| surface.points[k]).collect::<Vec<_>>();
        let outside = surface.quads().into_iter().map(|quad| {
            let [a, b, c, d] = quad.map(|k| surface.points[k]);
            (c - a).cross(&(d - b))
        });
        // Each facet makes two triangles; its normal tells the sense in which they should turn.
        let normals = outside.flat_map(|normal| [normal; 2]);
        let triangles = surface.triangles().into_iter().zip(normals);
        Self::of(triangles.map(|(triangle, normal)| CellShape::new(&corners(&triangle), &normal)))
    }

    fn of(shapes: impl Iterator<Item = CellShape>) -> Option<Self> {
        let shapes: Vec<CellShape> = shapes.collect();
        let spread = |value: fn(&CellShape) -> f64| {
            let Interval { low: min, high: max } = Interval::around(shapes.iter().map(value));
            QualityRange { min, max, mean: shapes.iter().map(value).sum::<f64>() / shapes.len() as f64 }
        };
        (!shapes.is_empty()).then(|| Self {
            cells: shapes.len(),
            triangles: shapes.iter().filter(|shape| shape.triangle).count(),
            inverted: shapes.iter().filter(|shape| shape.inverted).count(),
            aspect_ratio: spread(|shape| shape.aspect_ratio),
            skewness: spread(|shape| shape.skewness),
            smallest_angle_rad: spread(|shape| shape.smallest_angle),
        })
    }
}

/// The shape of one cell.
struct CellShape {
    triangle: bool,
    inverted: bool,
    aspect_ratio: f64,
    skewness: f64,
    smallest_angle: f64,
}

impl CellShape {
    /// Measures a cell with these corners, counter-clockwise about `normal` of any length.
    fn new(corners: &[Point3<f64>], normal: &Vector3<f64>) -> Self {
        let n = corners.len();
        let sides: Vec<Vector3<f64>> = (0..n).map(|k| corners[(k + 1) % n] - corners[k]).collect();
        let lengths = sides.iter().map(Vector3::norm);
        let (shortest, longest) =
            lengths.fold((f64::INFINITY, 0.0), |(low, high): (f64, f64), l| (low.min(l), high.max(l)));
        let (mut inverted, mut smallest, mut largest) = (false, f64::INFINITY, 0.0f64);
        for k in 0..n {
            let (back, on) = (-sides[(k + n - 1) % n], sides[k]);
            let area = on.cross(&back);
            let turn = area.dot(normal);
            // A NaN counts as inverted.
            inverted |= turn.is_nan() || turn <= 0.0;
            let angle = area.norm().atan2(on.dot(&back));
            (smallest, largest) = (smallest.min(angle), largest.max(angle));
        }
        let even = std::f64::consts::PI * (n as f64 - 2.0) / n as f64;
        let skewness = ((largest - even) / (std::f64::consts::PI - even)).max((even - smallest) / even);
        let triangle = n == 3;
        Self { triangle, inverted, aspect_ratio: longest / shortest, skewness, smallest_angle: smallest }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

    #[test]
    fn a_square_a_triangle_and_a_bow_tie() {
        let up = Vector3::z();
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| Point3::new(x, y, 0.0));
        let shape = CellShape::new(&square, &up);
        assert!(!shape.inverted && !shape.triangle);
        assert_eq!([shape.aspect_ratio, shape.skewness, shape.smallest_angle], [1.0, 0.0, FRAC_PI_2]);
        let half = CellShape::new(&square[..3], &up);
        assert!(half.triangle && !half.inverted);
        assert!((half.smallest_angle - FRAC_PI_4).abs() < 1e-15 && (half.skewness - 0.25).abs() < 1e-15);
        let bow_tie = [square[0], square[1], square[3], square[2]];
        assert!(CellShape::new(&bow_tie, &up).inverted);
        let mut reversed = square;
        reversed.reverse();
        assert!(CellShape::new(&reversed, &up).inverted);
    }
}

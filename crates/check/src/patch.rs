//! Meshes over the parameter plane of one curve: rectangular cells of two triangles each.

use super::meshes::{Hit, Mesh, Vector};
use super::sampler::SampledSurface;
use wheelrail::Interval;

/// A mesh over the product of ascending parameter values.
pub(super) struct CurveMesh {
    /// The mesh of the cells.
    pub mesh: Mesh,
    curve: usize,
    t: Vec<f64>,
    v: Vec<f64>,
}

/// A point of a surface, given by its parameters.
#[derive(Debug, Clone, Copy)]
pub(super) struct ParameterPoint {
    /// Index of the curve.
    pub curve: usize,
    /// Parameter along the curve.
    pub t: f64,
    /// Length around the axle, or along the rail \[mm\].
    pub v: f64,
}

impl CurveMesh {
    /// Makes the mesh over t × v; `None` if a point is not finite.
    pub fn new(surface: &SampledSurface, curve: usize, t: Vec<f64>, v: Vec<f64>) -> Option<Self> {
        let vertices: Vec<Vector> =
            t.iter().flat_map(|&t| v.iter().map(move |&v| surface.point(curve, t, v))).collect();
        let triangles = cells(t.len(), v.len());
        Some(Self { mesh: Mesh::new(vertices, triangles)?, curve, t, v })
    }

    /// Returns the parameters of a hit.
    pub fn place(&self, hit: &Hit) -> ParameterPoint {
        let [t, v] = parameters([&self.t, &self.v], hit);
        ParameterPoint { curve: self.curve, t, v }
    }

    /// Returns whether a place is in the outer ring of cells, so that the true place may be outside; ends of
    /// the curve (0 and `length`) are no border.
    pub fn at_border(&self, place: &ParameterPoint, length: f64) -> bool {
        let outer = |x: &[f64], value: f64, whole: Interval| {
            let last = x.len() - 1;
            (value < x[1] && x[0] > whole.low) || (value > x[last - 1] && x[last] < whole.high)
        };
        outer(&self.t, place.t, Interval::new(0.0, length)) || outer(&self.v, place.v, Interval::ALL)
    }
}

/// Returns the parameters of a hit on the cells over two ascending lists of parameters.
pub(super) fn parameters([t, v]: [&[f64]; 2], hit: &Hit) -> [f64; 2] {
    let columns = v.len() - 1;
    let (cell, second) = (hit.triangle / 2, hit.triangle % 2);
    let (i, j) = (cell / columns, cell % columns);
    let [_, b, c] = hit.weights;
    // Corners (0,0), (1,0), (1,1) or (0,0), (1,1), (0,1).
    let (a, across) = if second == 0 { (b + c, c) } else { (b, b + c) };
    let between = |x: &[f64], k: usize, share: f64| x[k] + (x[k + 1] - x[k]) * share;
    [between(t, i, a), between(v, j, across)]
}

/// Returns the triangles of an n × m array of vertices, counter-clockwise in (t, v).
pub(super) fn cells(n: usize, m: usize) -> Vec<[u32; 3]> {
    let at = |i: usize, j: usize| (i * m + j) as u32;
    (0..n.saturating_sub(1))
        .flat_map(|i| (0..m.saturating_sub(1)).map(move |j| (i, j)))
        .flat_map(|(i, j)| {
            [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]]
        })
        .collect()
}

//! Strips: one part of the slices, as far as it goes without interruption.

use std::ops::Range;

use super::bicubic::{Bicubic, Corner, SurfacePoint};
use super::joining::Joining;

/// A part of the surface without interruption: over u from 0 to [`Strip::cells`], and over y from its first slice to its last.
#[derive(Debug, Clone)]
pub struct Strip {
    /// Number of the part that it is of, from 0 at the side of the track's centre.
    pub part: usize,
    at: Vec<f64>,
    cells: usize,
    /// Corners of all cells, slice by slice.
    corners: Vec<Corner>,
    /// Bounds of x and z over the cells between two slices, as binary trees with the root at 1: the children of k are 2k and 2k + 1,
    /// and the last half are the cells.
    trees: Vec<Vec<[[f64; 2]; 2]>>,
}

/// The cells of a strip between two neighbouring slices.
#[derive(Debug, Clone, Copy)]
pub struct Interval<'a> {
    strip: &'a Strip,
    index: usize,
}

/// Bounds of nothing.
const NONE: [[f64; 2]; 2] = [[f64::INFINITY, f64::NEG_INFINITY]; 2];

/// Smallest bounds around two.
fn around(a: [[f64; 2]; 2], b: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
    [0, 1].map(|axis| [a[axis][0].min(b[axis][0]), a[axis][1].max(b[axis][1])])
}

impl Strip {
    /// Joins the points \[x, z\] of two slices or more, the same number at ascending places `at` \[mm\].
    pub(super) fn new(part: usize, at: Vec<f64>, points: &[Vec<[f64; 2]>], joining: Joining) -> Self {
        let nodes = points[0].len();
        let mut corners: Vec<Corner> =
            points.iter().flatten().map(|at| [*at, [0.0; 2], [0.0; 2], [0.0; 2]]).collect();
        for node in 0..nodes {
            for axis in 0..2 {
                let values: Vec<f64> = points.iter().map(|slice| slice[node][axis]).collect();
                for (slice, slope) in joining.slopes(&at, &values).into_iter().enumerate() {
                    corners[slice * nodes + node][2][axis] = slope;
                }
            }
        }
        let shares: Vec<f64> = (0..nodes).map(|k| k as f64).collect();
        for slice in corners.chunks_mut(nodes) {
            for (from, to) in [(0, 1), (2, 3)] {
                for axis in 0..2 {
                    let values: Vec<f64> = slice.iter().map(|corner| corner[from][axis]).collect();
                    let slopes = Joining::Cubic.slopes(&shares, &values);
                    slice.iter_mut().zip(slopes).for_each(|(corner, slope)| corner[to][axis] = slope);
                }
            }
        }
        let mut strip = Self { part, at, cells: nodes - 1, corners, trees: Vec::new() };
        strip.trees = strip.intervals().map(|interval| interval.tree()).collect();
        strip
    }

    /// Number of cells across.
    pub fn cells(&self) -> usize {
        self.cells
    }

    /// The interval of y that it covers \[mm\].
    pub fn reach(&self) -> [f64; 2] {
        [self.at[0], self.at[self.at.len() - 1]]
    }

    /// The intervals between its slices, in order.
    pub fn intervals(&self) -> impl Iterator<Item = Interval<'_>> {
        (1..self.at.len()).map(|k| self.interval(k - 1))
    }

    /// One of the intervals.
    pub fn interval(&self, index: usize) -> Interval<'_> {
        Interval { strip: self, index }
    }

    /// The interval that holds y \[mm\], or is next to it.
    pub fn interval_at(&self, y: f64) -> Interval<'_> {
        let after = self.at.partition_point(|at| *at <= y);
        self.interval(after.clamp(1, self.at.len() - 1) - 1)
    }

    /// Returns the point at (u, y \[mm\]); parameters beyond the strip continue its last cubics.
    pub fn point(&self, u: f64, y: f64) -> SurfacePoint {
        let cell = (u.max(0.0) as usize).min(self.cells - 1);
        self.interval_at(y).cell(cell).point(u - cell as f64, y)
    }
}

impl<'a> Interval<'a> {
    /// Number of the interval in its strip, from 0.
    pub fn index(&self) -> usize {
        self.index
    }

    /// Its ends \[mm\].
    pub fn y(&self) -> [f64; 2] {
        [self.strip.at[self.index], self.strip.at[self.index + 1]]
    }

    /// One of its cells.
    pub fn cell(&self, cell: usize) -> Bicubic<'a> {
        let nodes = self.strip.cells + 1;
        let corner = |a: usize, b: usize| &self.strip.corners[(self.index + b) * nodes + cell + a];
        Bicubic { corners: [[corner(0, 0), corner(0, 1)], [corner(1, 0), corner(1, 1)]], y: self.y() }
    }

    /// Bounds of x and z \[mm\] over a node of its tree, whose root is 1.
    pub fn bounds(&self, node: usize) -> [[f64; 2]; 2] {
        self.strip.trees[self.index][node]
    }

    /// The one cell of a node of its tree; `None` of a node with two children.
    pub fn only_cell(&self, node: usize) -> Option<usize> {
        node.checked_sub(self.strip.trees[self.index].len() / 2)
    }

    /// The cells of a node of its tree.
    pub fn cells(&self, node: usize) -> Range<usize> {
        let leaves = self.strip.trees[self.index].len() / 2;
        let below = leaves.ilog2() - node.ilog2();
        let first = (node << below) - leaves;
        first.min(self.strip.cells)..(first + (1 << below)).min(self.strip.cells)
    }

    fn tree(&self) -> Vec<[[f64; 2]; 2]> {
        let leaves = self.strip.cells.next_power_of_two();
        let mut tree = vec![NONE; 2 * leaves];
        for cell in 0..self.strip.cells {
            let control = self.cell(cell).control([0.0, 1.0], self.y());
            let points = control.iter().flatten().map(|[x, _, z]| [[*x; 2], [*z; 2]]);
            tree[leaves + cell] = points.fold(NONE, around);
        }
        for node in (1..leaves).rev() {
            tree[node] = around(tree[2 * node], tree[2 * node + 1]);
        }
        tree
    }
}

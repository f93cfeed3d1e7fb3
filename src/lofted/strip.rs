//! Strips: one part of the slices, as far as it goes without interruption.

use std::ops::Range;
use std::sync::Arc;

use super::bicubic::{Bicubic, CornerValues, SurfacePoint};
use super::joining::Joining;
use super::kept::{HeightStretch, KeptSurface, SmoothCurve};
use super::tree::tree;
use crate::numerics::interval::Interval;

/// A part of the surface without interruption: over u from 0 to [`LoftStrip::cells`], and over y from its first slice to its last.
#[derive(Debug, Clone)]
pub struct LoftStrip {
    /// Number of the part that it belongs to, from 0 at the side of the track's centre.
    pub part: usize,
    at: Vec<f64>,
    cells: usize,
    surface: StripSurface,
}

/// What a strip's surface is made of.
#[derive(Debug, Clone)]
enum StripSurface {
    /// Slices: the corners of all cells, slice by slice, and bounds of x and z over the cells between two slices: see [`tree`].
    Joined { corners: Vec<CornerValues>, trees: Vec<Vec<[Interval; 2]>> },
    /// A profile that keeps its shape.
    Kept(KeptSurface),
}

/// The cells of a strip between two neighbouring slices.
#[derive(Debug, Clone, Copy)]
pub struct Bay<'a> {
    strip: &'a LoftStrip,
    index: usize,
}

impl LoftStrip {
    /// Joins the points \[x, z\] of two slices or more, the same number at ascending places `at` \[mm\].
    pub(super) fn new(part: usize, at: Vec<f64>, points: &[Vec<[f64; 2]>], joining: Joining) -> Self {
        let nodes = points[0].len();
        let mut corners: Vec<CornerValues> =
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
        let cells = nodes - 1;
        let of_bay = |k: usize| {
            tree((0..cells).map(|cell| {
                let bicubic = joined(&corners, cells, &at, [k, cell]);
                let control = bicubic.control(Interval::new(0.0, 1.0), bicubic.y);
                [0, 2].map(|axis| Interval::around(control.iter().flatten().map(|at| at[axis])))
            }))
        };
        let trees = (0..at.len() - 1).map(of_bay).collect();
        Self { part, at, cells, surface: StripSurface::Joined { corners, trees } }
    }

    /// Makes the strip of a profile's part that keeps its shape over a stretch.
    pub(super) fn kept(part: usize, curve: &Arc<SmoothCurve>, stretch: &HeightStretch) -> Self {
        let kept = KeptSurface { curve: Arc::clone(curve), stretch: stretch.clone() };
        Self { part, at: stretch.at.clone(), cells: curve.cells(), surface: StripSurface::Kept(kept) }
    }

    /// Bounds the distance of its surface from the cells' bicubics \[mm\].
    pub fn off(&self) -> f64 {
        match &self.surface {
            StripSurface::Joined { .. } => 0.0,
            StripSurface::Kept(kept) => kept.off(),
        }
    }

    /// Gives the number of cells across.
    pub fn cells(&self) -> usize {
        self.cells
    }

    /// Gives the interval of y that it covers \[mm\].
    pub fn reach(&self) -> Interval {
        Interval::new(self.at[0], self.at[self.at.len() - 1])
    }

    /// Tells whether it has a surface at y \[mm\].
    pub fn holds(&self, y: f64) -> bool {
        self.reach().contains(y)
    }

    /// Lists the bays between its slices, in order.
    pub fn bays(&self) -> impl Iterator<Item = Bay<'_>> {
        (1..self.at.len()).map(|k| self.bay(k - 1))
    }

    /// Gives one of the bays.
    pub fn bay(&self, index: usize) -> Bay<'_> {
        Bay { strip: self, index }
    }

    /// Finds the bay that holds y \[mm\], or is next to it.
    pub fn bay_at(&self, y: f64) -> Bay<'_> {
        let after = self.at.partition_point(|at| *at <= y);
        self.bay(after.clamp(1, self.at.len() - 1) - 1)
    }

    /// Returns the point at (u, y \[mm\]); parameters beyond the strip continue its last cubics.
    // Inline, so that derivatives that the caller does not use are not computed.
    #[inline(always)]
    pub fn point(&self, u: f64, y: f64) -> SurfacePoint {
        let cell = (u.max(0.0) as usize).min(self.cells - 1);
        self.point_of(cell, u - cell as f64, y)
    }

    /// Returns the point at a share of a cell and y \[mm\]. Derivatives with respect to the share may jump from one cell to the next.
    #[inline(always)]
    pub(super) fn point_of(&self, cell: usize, f: f64, y: f64) -> SurfacePoint {
        let bay = self.bay_at(y);
        match &self.surface {
            StripSurface::Joined { corners, .. } => {
                joined(corners, self.cells, &self.at, [bay.index, cell]).point(f, y)
            }
            StripSurface::Kept(kept) => kept.point(bay.index, cell, f, y),
        }
    }
}

impl<'a> Bay<'a> {
    /// Gives the number of the bay in its strip, from 0.
    pub fn index(&self) -> usize {
        self.index
    }

    /// Gives its ends \[mm\].
    pub fn y(&self) -> Interval {
        Interval::new(self.strip.at[self.index], self.strip.at[self.index + 1])
    }

    /// Gives the bicubic of one of its cells, or one that approximates the cell: see [`LoftStrip::off`].
    pub fn cell(&self, cell: usize) -> Bicubic {
        let LoftStrip { at, cells, surface, .. } = self.strip;
        match surface {
            StripSurface::Joined { corners, .. } => joined(corners, *cells, at, [self.index, cell]),
            StripSurface::Kept(kept) => kept.cell(self.index, cell),
        }
    }

    /// Bounds x and z of the bicubics \[mm\] over a node of its tree, whose root is 1.
    pub fn bounds(&self, node: usize) -> [Interval; 2] {
        match &self.strip.surface {
            StripSurface::Joined { trees, .. } => trees[self.index][node],
            StripSurface::Kept(kept) => kept.bounds(self.index, node),
        }
    }

    /// Gives the one cell of a leaf of its tree; `None` for a node with two children.
    pub fn only_cell(&self, node: usize) -> Option<usize> {
        node.checked_sub(self.leaves())
    }

    /// Lists the cells of a node of its tree; none for a leaf beyond the last cell.
    pub fn cells(&self, node: usize) -> Range<usize> {
        let leaves = self.leaves();
        let below = leaves.ilog2() - node.ilog2();
        let first = (node << below) - leaves;
        first.min(self.strip.cells)..(first + (1 << below)).min(self.strip.cells)
    }

    fn leaves(&self) -> usize {
        self.strip.cells.next_power_of_two()
    }
}

/// Makes the bicubic of a cell of a bay.
#[inline(always)]
fn joined(corners: &[CornerValues], cells: usize, at: &[f64], [bay, cell]: [usize; 2]) -> Bicubic {
    let corner = |a: usize, b: usize| corners[(bay + b) * (cells + 1) + cell + a];
    let corners = [0, 1].map(|a| [0, 1].map(|b| corner(a, b)));
    Bicubic { corners, y: Interval::new(at[bay], at[bay + 1]) }
}

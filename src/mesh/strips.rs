//! The boundary-fitted mesh of COUNTACT and CONFORM: strips across ξ, cells between the two boundary branches.
//!
//! Every component is the image of a rectangle: ξ runs from end to end in strips, and
//! η = (η_l + η_u)/2 + c (η_u − η_l)/2 from the lower branch at c = −1 to the upper at c = 1. Cells are the images
//! of equal steps of an angle in both directions (Chebyshev points), so that they become small with the square of
//! their number towards the boundary, where pressure varies fastest. Sides of constant ξ are straight, sides of
//! constant c follow the boundary; the outermost are the boundary itself. Areas and centroids are those of
//! such a cell, not of the polygon of its corners. A quad cannot invert: it has two parallel sides, both run
//! upwards. At a tip the cells are triangles that share it: quads with one corner repeated, so that
//! neighbours share all their sides and the mesh has neither gaps nor hanging points.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::error::{Error, Result};
use crate::interpenetration::measure::{Memo, Stretch};
use crate::interpenetration::{Component, End, Outline, Patch, Slice};
use crate::placement::Placement;

/// Cells beyond which a mesh is a mistake: the patch itself is known to fewer digits.
const MOST_CELLS: f64 = 1e7;

/// A corner of the boundary closer than this share of a strip to another one, or to an end, does not get a strip's
/// edge of its own: areas do not need it, and the strip would be a sliver.
const LEAST_STRIP: f64 = 0.25;

/// Demand on the areas, relative.
const AREA_DEMAND: f64 = 1e-12;

/// Demand on the centroids, relative to the extents of the component.
const CENTROID_DEMAND: f64 = 1e-9;

/// How many cells a component gets.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Counts {
    /// Strips along ξ, at least 2; corners of the boundary may add some.
    pub strips: usize,
    /// Cells of a strip, along η, at least 1.
    pub across: usize,
}

impl Default for Counts {
    /// 32 strips of 16 cells: cells along the boundary are then a tenth as wide as in the middle, strips at the tips a
    /// twentieth.
    fn default() -> Self {
        Self { strips: 32, across: 16 }
    }
}

/// One cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cell {
    /// Index of its component.
    pub component: usize,
    /// Strip along ξ and place along η within the component, both from 0 and ascending.
    pub place: [usize; 2],
    /// Indices of its corners, counter-clockwise seen from +ζ; at a tip the last repeats the first.
    pub corners: [usize; 4],
    /// Area in the ξ–η plane \[mm²\] with its curved sides, to 1e-12 relative.
    pub area: f64,
    /// Centroid \[ξ, η\] \[mm\] with its curved sides, to 1e-9 of the component's extents.
    pub centroid: [f64; 2],
    /// s at the centroid \[mm\].
    pub separation: f64,
}

impl Cell {
    /// The corners without repetition: four, or three at a tip.
    pub fn vertices(&self) -> &[usize] {
        if self.corners[0] == self.corners[3] { &self.corners[..3] } else { &self.corners }
    }
}

/// The mesh of all components.
#[derive(Debug, Clone, PartialEq)]
pub struct StripMesh {
    /// \[ξ, η, ζ^R\] \[mm\]: points on the rail.
    pub points: Vec<[f64; 3]>,
    /// Component by component, strip by strip, η fastest.
    pub cells: Vec<Cell>,
}

impl StripMesh {
    /// The mesh of a patch of this placed pair. Empty for an empty patch.
    ///
    /// # Errors
    /// Fewer than 2 strips or no cell across; more than 10⁷ cells.
    pub fn new(placement: &Placement, patch: &Patch, counts: Counts) -> Result<Self> {
        counts.check()?;
        let mut builder = Builder {
            placement,
            outline: Outline::new(placement, patch.approach, &patch.window),
            shares: shares(counts.across),
            mesh: Self { points: Vec::new(), cells: Vec::new() },
        };
        for (index, component) in patch.components.iter().enumerate() {
            builder.component(index, component, counts.strips);
        }
        Ok(builder.mesh)
    }
}

impl Counts {
    fn check(self) -> Result<()> {
        let found = format!("{} strips of {} cells", self.strips, self.across);
        if self.strips < 2 || self.across < 1 {
            let expected = "at least 2 strips of at least 1 cell";
            return Err(Error::new("mesh", found, expected, "ask for more"));
        }
        if self.strips as f64 * self.across as f64 > MOST_CELLS {
            let expected = format!("at most {MOST_CELLS:e} cells a component");
            return Err(Error::new("mesh", found, expected, "ask for fewer"));
        }
        Ok(())
    }
}

/// c of the points across: Chebyshev points, symmetric to the last bit.
fn shares(across: usize) -> Vec<f64> {
    (0..=across).map(|j| (FRAC_PI_2 * (2.0 * j as f64 - across as f64) / across as f64).sin()).collect()
}

struct Builder<'a> {
    placement: &'a Placement,
    outline: Outline<'a>,
    shares: Vec<f64>,
    mesh: StripMesh,
}

impl Builder<'_> {
    fn component(&mut self, index: usize, component: &Component, strips: usize) {
        let edges = strip_edges(component, strips);
        let rows: Vec<Vec<usize>> = edges.iter().map(|&xi| self.row(component, xi)).collect();
        for (i, (xi, rows)) in edges.windows(2).zip(rows.windows(2)).enumerate() {
            let moments = self.moments(component, [xi[0], xi[1]]);
            for j in 0..self.shares.len() - 1 {
                let quad = [rows[0][j], rows[1][j], rows[1][j + 1], rows[0][j + 1]];
                if let Some(corners) = tip_first(quad) {
                    let cell = self.cell(&moments, j);
                    self.mesh.cells.push(Cell { component: index, place: [i, j], corners, ..cell });
                }
            }
        }
    }

    /// Indices of the points of one strip edge, ascending in η; all the same where it has no width.
    fn row(&mut self, component: &Component, xi: f64) -> Vec<usize> {
        let Slice { eta: [low, high] } = self.outline.slice_of(&component.part, xi);
        let zeta = self.placement.rail.section.height(xi);
        let points = &mut self.mesh.points;
        let first = points.len();
        if low >= high {
            points.push([xi, low, zeta]);
            return vec![first; self.shares.len()];
        }
        let last = self.shares.len() - 1;
        points.extend(self.shares.iter().enumerate().map(|(j, share)| {
            let between = low + (high - low) / 2.0 * (1.0 + share);
            let eta = if j == 0 {
                low
            } else if j == last {
                high
            } else {
                between
            };
            [xi, eta, zeta]
        }));
        (first..=first + last).collect()
    }

    /// Moments of a strip's width, over its pieces between all corners: also those that have no edge.
    fn moments(&mut self, component: &Component, xi: [f64; 2]) -> Moments {
        let pieces = pieces(component, xi);
        let mut memo = Memo::new();
        let mut slice = |xi: f64| memo.at(xi, |xi| self.outline.slice(&component.part, xi));
        let mut width = |xi: f64| slice(xi).map_or(0.0, |slice| slice.eta[1] - slice.eta[0]);
        let area = pieces.iter().map(|piece| piece.integral(&mut width, AREA_DEMAND)).sum();
        // Means of quantities that change sign are taken from an offset, to whose size the demand then refers.
        let offset = component.eta[0].abs().max(component.eta[1].abs());
        let mut mean = |value: &dyn Fn(f64, Slice) -> f64| {
            let mut weighted =
                |xi: f64| slice(xi).map_or(0.0, |slice| value(xi, slice) * (slice.eta[1] - slice.eta[0]));
            pieces.iter().map(|piece| piece.integral(&mut weighted, CENTROID_DEMAND)).sum::<f64>() / area
        };
        Moments {
            area,
            xi: xi[0] + mean(&|x, _| x - xi[0]),
            middle: mean(&|_, slice| offset + (slice.eta[0] + slice.eta[1]) / 2.0) - offset,
            half: mean(&|_, slice| (slice.eta[1] - slice.eta[0]) / 2.0),
        }
    }

    /// The j-th cell of a strip: its share of the width is the same all along.
    fn cell(&mut self, moments: &Moments, j: usize) -> Cell {
        let [from, to] = [self.shares[j], self.shares[j + 1]];
        let centroid = [moments.xi, moments.middle + moments.half * (from + to) / 2.0];
        Cell {
            component: 0,
            place: [0; 2],
            corners: [0; 4],
            area: moments.area * (to - from) / 2.0,
            centroid,
            separation: self.outline.separation(centroid[0], centroid[1]),
        }
    }
}

/// What the cells of a strip share: means are weighted by the width.
struct Moments {
    /// Area of the strip \[mm²\].
    area: f64,
    /// Mean ξ.
    xi: f64,
    /// Mean η of the middle between the branches.
    middle: f64,
    /// Mean of half the width.
    half: f64,
}

/// The parts of a strip between the corners of the boundary inside it.
fn pieces(component: &Component, [a, b]: [f64; 2]) -> Vec<Stretch> {
    let inside = component.corners.iter().copied().filter(|&corner| corner > a && corner < b);
    let cuts: Vec<f64> = std::iter::once(a).chain(inside).chain([b]).collect();
    let round = |xi: f64| (0..2).any(|k| xi == component.xi[k] && component.ends[k] != End::Window);
    cuts.windows(2)
        .map(|pair| Stretch { xi: [pair[0], pair[1]], round: [round(pair[0]), round(pair[1])] })
        .collect()
}

/// A quad with a side of no length as a triangle that begins and ends there; `None` with two such sides.
fn tip_first(quad @ [a, b, c, d]: [usize; 4]) -> Option<[usize; 4]> {
    match (a == d, b == c) {
        (false, true) => Some([b, d, a, b]),
        (true, true) => None,
        _ => Some(quad),
    }
}

/// ξ of the strips' edges: equal steps of the angle between corners, which are edges themselves.
fn strip_edges(component: &Component, strips: usize) -> Vec<f64> {
    let grading = Grading { xi: component.xi, round: component.ends.map(|end| end != End::Window) };
    let least = LEAST_STRIP / strips as f64;
    let mut kept = vec![(0.0, component.xi[0])];
    for &corner in &component.corners {
        let t = grading.parameter(corner);
        if t - kept[kept.len() - 1].0 >= least && 1.0 - t >= least {
            kept.push((t, corner));
        }
    }
    kept.push((1.0, component.xi[1]));
    let mut edges = vec![component.xi[0]];
    for pair in kept.windows(2) {
        let [(from, _), (to, xi)] = [pair[0], pair[1]];
        // A component without corners always gets two strips: two tips cannot share one.
        let least = if kept.len() == 2 { 2.0 } else { 1.0 };
        let n = (strips as f64 * (to - from)).round().max(least) as usize;
        edges.extend((1..n).map(|k| grading.xi(from + (to - from) * k as f64 / n as f64)));
        edges.push(xi);
    }
    edges.dedup();
    edges
}

/// ξ as a function of t in \[0, 1\] that crowds equal steps of t towards round ends.
struct Grading {
    xi: [f64; 2],
    round: [bool; 2],
}

impl Grading {
    fn xi(&self, t: f64) -> f64 {
        let share = match self.round {
            [true, true] => (PI * t / 2.0).sin().powi(2),
            [true, false] => 2.0 * (PI * t / 4.0).sin().powi(2),
            [false, true] => (FRAC_PI_2 * t).sin(),
            [false, false] => t,
        };
        self.xi[0] + (self.xi[1] - self.xi[0]) * share
    }

    fn parameter(&self, xi: f64) -> f64 {
        let share = (xi - self.xi[0]) / (self.xi[1] - self.xi[0]);
        match self.round {
            [true, true] => 2.0 / PI * share.sqrt().asin(),
            [true, false] => 4.0 / PI * (share / 2.0).sqrt().asin(),
            [false, true] => share.asin() / FRAC_PI_2,
            [false, false] => share,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gradings_and_their_inverses() {
        for round in [[true, true], [true, false], [false, true], [false, false]] {
            let grading = Grading { xi: [-2.0, 5.0], round };
            assert_eq!(grading.xi(0.0), -2.0);
            assert!((grading.xi(1.0) - 5.0).abs() < 1e-14);
            for t in [0.0, 0.1, 0.5, 0.9] {
                assert!((grading.parameter(grading.xi(t)) - t).abs() < 1e-14, "{round:?} {t}");
            }
        }
    }

    #[test]
    fn triangles_start_at_their_tip_and_keep_their_sense() {
        assert_eq!(tip_first([1, 2, 3, 4]), Some([1, 2, 3, 4]));
        assert_eq!(tip_first([1, 2, 3, 1]), Some([1, 2, 3, 1]));
        assert_eq!(tip_first([1, 2, 2, 4]), Some([2, 4, 1, 2]));
        assert_eq!(tip_first([1, 2, 2, 1]), None);
    }
}

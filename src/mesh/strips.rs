//! The boundary-fitted mesh of COUNTACT and CONFORM: strips across ξ, divided into cells between the two boundary branches.
//!
//! A band of a component is a range of ξ with one interval of η; mostly it is the whole component. Each band is the image
//! of a rectangle: ξ runs from end to end in strips, and η = (η_l + η_u)/2 + c (η_u − η_l)/2 runs from the lower branch at
//! c = −1 to the upper branch at c = 1. Bands have the same points where they meet: a band that divides takes the lines of
//! the bands into which it divides. Cells are the images of equal steps of an angle in both directions (Chebyshev points).
//! Towards the boundary, where pressure varies fastest, their size falls with the square of their number. Sides of constant
//! ξ are straight; sides of constant c follow the boundary, and the outermost are the boundary itself. Areas and centroids
//! are those of such curved cells, not of the polygons of their corners. A quad cannot invert, because two of its sides are
//! parallel and both run upwards. At a tip the cells are triangles that share it: quads with one corner repeated.
//! Neighbours therefore share whole sides, and the mesh has neither gaps nor hanging points.

use std::f64::consts::FRAC_PI_2;

use nalgebra::Point3;

use super::lines::{BandMeeting, between, lines};
use crate::error::{Error, ErrorKind, Result};
use crate::numerics::interval::Interval;
use crate::numerics::lanes::{Lanes, lanes};
use crate::patch::{Band, BandPlaces, Component, Patch};
use crate::placement::Placement;
use crate::separation::Evaluator;

/// Most cells of a component. With more, cells are smaller than the accuracy of the patch, which can only be a mistake.
const MOST_CELLS: f64 = 1e7;

/// Least distance of a corner of the boundary from another corner or an end, as a share of a strip, at which it gets a
/// strip edge of its own. Areas do not need the edge, and a closer one would make a sliver.
const LEAST_STRIP: f64 = 0.25;

/// Relative accuracy demanded of the areas.
const AREA_DEMAND: f64 = 1e-12;

/// Accuracy demanded of the centroids, relative to the extents of the component.
const CENTROID_DEMAND: f64 = 1e-9;

/// The number of cells of each component.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StripCounts {
    /// Number of strips along ξ, at least 2. Corners of the boundary may add some.
    pub strips: usize,
    /// Number of cells of a strip along η, at least 1.
    pub across: usize,
}

impl Default for StripCounts {
    /// Returns 32 strips of 16 cells. Cells along the boundary are then a tenth as wide as in the middle, and strips at the
    /// tips a twentieth.
    fn default() -> Self {
        Self { strips: 32, across: 16 }
    }
}

/// A cell of a strip mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StripCell {
    /// Index of the cell's component.
    pub component: usize,
    /// Index of the strip within the component, from 0, band by band by ascending ξ; index of the cell within the strip,
    /// from 0, by ascending η.
    pub place: [usize; 2],
    /// Indices of the four corners, counter-clockwise seen from +ζ. At a tip the last corner repeats the first.
    pub corners: [usize; 4],
    /// Area in the ξ–η plane with the curved sides \[mm²\], to 1e-12 relative.
    pub area: f64,
    /// Centroid \[ξ, η\] of the cell with its curved sides \[mm\], to 1e-9 of the component's extents.
    pub centroid: [f64; 2],
    /// s at the centroid \[mm\].
    pub separation: f64,
}

impl StripCell {
    /// Returns the corners without repetition: four, or three at a tip.
    pub fn vertices(&self) -> &[usize] {
        if self.corners[0] == self.corners[3] { &self.corners[..3] } else { &self.corners }
    }
}

/// The boundary-fitted mesh of all components of a patch.
///
/// # Examples
/// ```
/// # use wheelrail::{Arc, Half, Pair, Profile, Segment};
/// use wheelrail::{Patch, StripCounts, StripMesh, Window, mesh::Quality};
/// # let rail = Arc::about([0.0, -300.0], 300.0, Half::Upper, [-35.0, 35.0])?;
/// # let rail = Profile::new("crown", "", vec![Segment::arc(rail)])?;
/// # let wheel = Profile::new("cylinder", "", vec![Segment::arc(Arc::line([-60.0, 0.0], [60.0, 0.0])?)])?;
/// # let pair = Pair::new(rail, wheel, 460.0)?;
/// let placement = pair.placed(0.0, 0.0, 0.0)?; // a crown of 300 mm below a cylinder of 460 mm
/// let patch = Patch::new(&placement, 0.05, &Window::UNBOUNDED);
/// let mesh = StripMesh::new(&placement, &patch, StripCounts::default())?;
/// let quality = Quality::of_strips(&mesh).expect("a mesh with cells");
/// assert_eq!((quality.cells, quality.inverted), (mesh.cells.len(), 0));
/// assert!(mesh.cells.len() >= 32 * 16);
/// # Ok::<(), wheelrail::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct StripMesh {
    /// Points (ξ, η, ζ^R) \[mm\] on the rail's surface.
    pub points: Vec<Point3<f64>>,
    /// Cells by component, then by strip, then by η.
    pub cells: Vec<StripCell>,
}

impl StripMesh {
    /// Makes the mesh of a patch of this placed pair. An empty patch gives an empty mesh.
    ///
    /// # Errors
    /// Fewer than 2 strips; no cell across; more than 10⁷ cells a component.
    pub fn new(placement: &Placement, patch: &Patch, counts: StripCounts) -> Result<Self> {
        counts.check()?;
        let mut builder = StripBuilder {
            placement,
            evaluator: Evaluator::new(placement),
            shares: shares(counts.across),
            mesh: Self { points: Vec::new(), cells: Vec::new() },
            eta: Vec::new(),
            separation: Vec::new(),
        };
        for (index, component) in patch.components.iter().enumerate() {
            builder.component(index, component, counts.strips);
        }
        Ok(builder.mesh)
    }
}

impl StripCounts {
    fn check(self) -> Result<()> {
        let found = format!("{} strips of {} cells", self.strips, self.across);
        if self.strips < 2 || self.across < 1 {
            let expected = "at least 2 strips of at least 1 cell";
            return Err(Error::new("mesh", found, expected, "ask for more"));
        }
        if self.strips as f64 * self.across as f64 > MOST_CELLS {
            let expected = format!("at most {MOST_CELLS:e} cells a component");
            return Err(Error::new("mesh", found, expected, "ask for fewer").of_kind(ErrorKind::Limit));
        }
        Ok(())
    }
}

/// Returns c of the points across a strip: Chebyshev points, symmetric to the last bit.
fn shares(across: usize) -> Vec<f64> {
    (0..=across).map(|j| (FRAC_PI_2 * (2.0 * j as f64 - across as f64) / across as f64).sin()).collect()
}

struct StripBuilder<'a> {
    placement: &'a Placement,
    evaluator: Evaluator<'a>,
    /// c of the points across a band that meets no narrower one.
    shares: Vec<f64>,
    mesh: StripMesh,
    /// η and s of the centroids of a strip \[mm\].
    eta: Vec<f64>,
    separation: Vec<f64>,
}

impl StripBuilder<'_> {
    fn component(&mut self, index: usize, component: &Component, strips: usize) {
        let bands = &component.bands;
        let shares = lines(bands, &self.shares);
        let mut meetings: Vec<BandMeeting> = BandMeeting::all(bands, &shares);
        let whole = component.xi.width();
        let mut first_strip = 0;
        self.mesh.points.reserve((strips + 1) * self.shares.len());
        self.mesh.cells.reserve(strips * self.shares.len());
        for (band, shares) in bands.iter().zip(&shares) {
            let edges = strip_edges(band, strips as f64 / whole);
            let slices = band.rows(&edges);
            let (mut before, mut row): (Vec<usize>, Vec<usize>) = (Vec::new(), Vec::new());
            for (i, &[xi, low, high]) in slices.iter().enumerate() {
                match meetings.iter_mut().find(|meeting| meeting.xi == xi) {
                    Some(meeting) if xi == band.xi.low || xi == band.xi.high => {
                        row = meeting.row(&mut self.mesh.points, self.placement, band, shares);
                    }
                    _ => self.row(shares, xi, Interval::new(low, high), &mut row),
                }
                if i > 0 {
                    self.strip(
                        band,
                        shares,
                        Interval::new(edges[i - 1], xi),
                        [index, first_strip + i - 1],
                        [&before, &row],
                    );
                }
                std::mem::swap(&mut before, &mut row);
            }
            first_strip += edges.len() - 1;
        }
    }

    /// Appends the cells between two rows of points as a strip of a component, which are given by their indices.
    fn strip(
        &mut self,
        band: &Band,
        shares: &[f64],
        xi: Interval,
        [component, strip]: [usize; 2],
        rows: [&[usize]; 2],
    ) {
        let moments = self.moments(band, xi);
        let middle = |j: usize| moments.middle + moments.half * (shares[j] + shares[j + 1]) / 2.0;
        self.eta.clear();
        self.eta.extend((1..shares.len()).map(|j| middle(j - 1)));
        self.separation.resize(self.eta.len(), f64::NAN);
        self.evaluator.column_in_lanes(moments.xi, &self.eta, &mut self.separation);
        for j in 0..self.eta.len() {
            let quad = [rows[0][j], rows[1][j], rows[1][j + 1], rows[0][j + 1]];
            if let Some(corners) = tip_first(quad) {
                self.mesh.cells.push(StripCell {
                    component,
                    place: [strip, j],
                    corners,
                    // The share of the strip's width is constant along ξ.
                    area: moments.area * (shares[j + 1] - shares[j]) / 2.0,
                    centroid: [moments.xi, self.eta[j]],
                    separation: self.separation[j],
                });
            }
        }
    }

    /// Adds the points of one strip edge between two η \[mm\], ascending in η, and puts their indices into `row`. These are all equal
    /// if the edge has no width.
    fn row(&mut self, shares: &[f64], xi: f64, eta: Interval, row: &mut Vec<usize>) {
        let points = &mut self.mesh.points;
        let first = points.len();
        let profile = self.placement.rail().section.height(xi);
        let is_swept = self.placement.under().is_none() && self.placement.lofted_rail().is_none();
        row.clear();
        if eta.low >= eta.high {
            points.push(Point3::new(xi, eta.low, profile));
            row.resize(shares.len(), first);
        } else {
            points.extend(shares.iter().map(|&share| Point3::new(xi, between(eta, share), profile)));
            row.extend(first..points.len());
        }
        if !is_swept {
            let evaluator = &mut self.evaluator;
            points[first..].iter_mut().for_each(|at| at.z = evaluator.lower_height(xi, at.y));
        }
    }

    /// Computes the moments of a strip's width, over the pieces between all corners of the boundary, even those without a
    /// strip edge.
    fn moments(&self, band: &Band, xi: Interval) -> Moments {
        // A mean of values that change sign is computed from an offset. The demanded accuracy then refers to the size of
        // the offset.
        let offset = band.sides.into_iter().fold(xi.width(), |most, eta| eta.magnitude().max(most));
        let weighted = |at: &BandPlaces| {
            let [low, high] = &at.edges;
            let width: Lanes = lanes(|k| high[k] - low[k]);
            [
                width,
                lanes(|k| (at.xi[k] - xi.low) * width[k]),
                lanes(|k| (offset + (low[k] + width[k] / 2.0)) * width[k]),
                lanes(|k| width[k] * width[k] / 2.0),
            ]
        };
        let demand = [AREA_DEMAND, CENTROID_DEMAND, CENTROID_DEMAND, CENTROID_DEMAND];
        let [area, along, across, half] = band.integrals(xi, false, weighted, demand);
        Moments { area, xi: xi.low + along / area, middle: across / area - offset, half: half / area }
    }
}

/// The moments that the cells of a strip share. Means are weighted by the width.
struct Moments {
    /// Area of the strip \[mm²\].
    area: f64,
    /// Mean ξ \[mm\].
    xi: f64,
    /// Mean η of the middle between the branches \[mm\].
    middle: f64,
    /// Mean of half the width \[mm\].
    half: f64,
}

/// Returns a quad that has one side without length as a triangle whose first and last corners are that side. Returns `None`
/// for a quad with two such sides.
fn tip_first(quad @ [a, b, c, d]: [usize; 4]) -> Option<[usize; 4]> {
    match (a == d, b == c) {
        (false, true) => Some([b, d, a, b]),
        (true, true) => None,
        _ => Some(quad),
    }
}

/// Returns ξ of the strip edges of a band \[mm\]. Corners of the boundary are edges, except those closer than [`LEAST_STRIP`] to
/// another edge; between two corners the edges are equal steps of the angle.
fn strip_edges(band: &Band, strips_per_mm: f64) -> Vec<f64> {
    let grading = band.grading();
    let strips = (strips_per_mm * band.xi.width()).round().max(2.0);
    let least = LEAST_STRIP / strips;
    let mut kept = vec![(0.0, band.xi.low)];
    for &corner in &band.corners {
        let t = grading.parameter(corner);
        if t - kept[kept.len() - 1].0 >= least && 1.0 - t >= least {
            kept.push((t, corner));
        }
    }
    kept.push((1.0, band.xi.high));
    let mut edges = vec![band.xi.low];
    for pair in kept.windows(2) {
        let [(from, _), (to, xi)] = [pair[0], pair[1]];
        // A band without corners always gets two strips, because two tips cannot share one.
        let least = if kept.len() == 2 { 2.0 } else { 1.0 };
        let n = (strips * (to - from)).round().max(least) as usize;
        edges.extend((1..n).map(|k| grading.xi(from + (to - from) * k as f64 / n as f64)));
        edges.push(xi);
    }
    edges.dedup();
    edges
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_start_at_their_tip_and_keep_their_sense() {
        assert_eq!(tip_first([1, 2, 3, 4]), Some([1, 2, 3, 4]));
        assert_eq!(tip_first([1, 2, 3, 1]), Some([1, 2, 3, 1]));
        assert_eq!(tip_first([1, 2, 2, 4]), Some([2, 4, 1, 2]));
        assert_eq!(tip_first([1, 2, 2, 1]), None);
    }
}

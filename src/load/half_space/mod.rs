//! The pressures that an approach δ causes over regions of contact: elastic half-spaces of cells with constant pressure.
//!
//! Pressures p ≥ 0 press the surfaces apart until s + u(p) = δ where p > 0, and s + u(p) ≥ δ elsewhere, with
//! u = 1/(π E*) ∬ p/r (Boussinesq).

mod cells;
mod edges;
mod influence;
mod pressures;
mod settle;

use std::f64::consts::PI;

use nalgebra::{Point3, Vector3};

use crate::error::{Error, Result};
use crate::patch::Window;
use crate::placement::Placement;
pub use cells::Cells;
pub use edges::{SharpEdge, sharp_edge};
use influence::Influence;
pub use pressures::{Largest, Pressures};
use settle::System;

/// Number of cells along ξ and along η of the box around a region: the load of Hertz's ellipse is then right to 0.2 %. There are more
/// along ξ, where the gap of profiles differs from Hertz's.
const CELLS: [usize; 2] = [32, 16];

/// A region of contact whose pressures are not known: its cells, and how far the bodies overlap in them.
///
/// Both bodies count as half-spaces along the tangent plane at C.
#[derive(Debug, Clone)]
pub struct HalfSpace {
    cells: Cells,
    /// δ − s \[mm\] of every cell, 0 where it is negative.
    depth: Vec<f64>,
    /// p/(π E*) of every cell \[1\] to begin with, 0 if none are known.
    start: Vec<f64>,
}

impl HalfSpace {
    /// Makes the half-space of the region inside `extent`, the box around it, under an approach δ \[mm\]. A box without extent has
    /// no depth.
    pub fn over(placement: &Placement, extent: &Window, approach: f64) -> Self {
        let found = Cells::over(extent, CELLS)
            .and_then(|cells| Self::new(cells, &cells.separations(placement), approach));
        found.unwrap_or_else(|_| {
            let cells = Cells { from: [extent.xi.low, extent.eta.low], step: [1.0; 2], count: CELLS };
            let none = vec![0.0; CELLS[0] * CELLS[1]];
            Self { cells, depth: none.clone(), start: none }
        })
    }

    /// Makes the half-space of a region with s \[mm\] at the middle of every cell, at i_ξ · n_η + i_η, under an approach δ \[mm\].
    /// Cells without a number count as apart.
    ///
    /// # Errors
    /// Another number of separations than of cells; an approach that is no number.
    pub fn new(cells: Cells, separations: &[f64], approach: f64) -> Result<Self> {
        if separations.len() != cells.count[0] * cells.count[1] || !approach.is_finite() {
            let found = format!("{} separations and an approach of {approach} mm", separations.len());
            let expected = format!("{} × {} and a finite one", cells.count[0], cells.count[1]);
            return Err(Error::new("pressure", found, expected, "give s in every cell"));
        }
        let depth: Vec<f64> =
            separations.iter().map(|s| if *s < approach { approach - s } else { 0.0 }).collect();
        let start = vec![0.0; depth.len()];
        Ok(Self { cells, depth, start })
    }

    /// Lets the search begin at the pressures of another approach, or on other cells over the region.
    pub fn beginning_at(mut self, known: &Pressures) -> Self {
        if known.cells.count == self.cells.count {
            self.start.copy_from_slice(&known.relative);
        } else {
            self.start = self.cells.between(&known.cells, &known.relative);
        }
        self
    }

    /// Makes the half-space of the same region on cells that are half as wide along some axes, under the approach δ \[mm\] of both.
    ///
    /// # Errors
    /// More than four million cells.
    pub fn finer(&self, placement: &Placement, approach: f64, axes: [bool; 2]) -> Result<Self> {
        let cells = self.cells.halved(axes)?;
        Self::new(cells, &cells.separations(placement), approach)
    }

    /// Places the region by itself, so that no other region presses upon it.
    pub fn alone(self) -> Located {
        Located { region: self, middle: Point3::origin(), normal: Vector3::z() }
    }

    /// Keeps every second cell along both axes, with twice the sides.
    fn wider(&self) -> Self {
        let [depth, start] = [&self.depth, &self.start].map(|values| self.cells.thinned(values));
        Self { cells: self.cells.coarser(), depth, start }
    }

    /// Gives the middle of the overlap in ξ and η \[mm\], weighted by its depth; that of the cells where nothing overlaps.
    pub fn middle(&self) -> [f64; 2] {
        let mut sums = [0.0; 3];
        for (i, column) in self.depth.chunks_exact(self.cells.count[1]).enumerate() {
            for (j, depth) in column.iter().enumerate() {
                sums = [sums[0] + depth, sums[1] + depth * i as f64, sums[2] + depth * j as f64];
            }
        }
        [0, 1].map(|k| {
            let middle =
                if sums[0] > 0.0 { sums[k + 1] / sums[0] } else { (self.cells.count[k] as f64 - 1.0) / 2.0 };
            self.cells.middle(k, middle)
        })
    }
}

/// A region in axes that all regions of a wheel share.
#[derive(Debug, Clone)]
pub struct Located {
    /// The region.
    pub region: HalfSpace,
    /// Where the middle of its overlap lies \[mm\].
    pub middle: Point3<f64>,
    /// Its normal, of length 1.
    pub normal: Vector3<f64>,
}

/// Number of cells up to which the search needs no pressures on wider cells to begin with.
const FEW_CELLS: usize = 1024;

/// Solves one half-space for its pressures, and on cells twice as wide for [`Pressures::largest_error`]. Tolerance, modulus and
/// errors are those of [`press`].
///
/// Method: the search begins at the pressures on the wider cells, which are found likewise. Accuracy with a tolerance of 1e-4 on
/// 100 × 100 cells over the box of an ellipse's overlap: 0.1 % of the largest pressure, 0.03 % of the load, 0.5 % of the contact area.
/// Cost: 30 ms for 200 × 200 cells.
///
/// # Examples
/// ```
/// # use wheelrail::{Arc, Half, Pair, Patch, Profile, Segment, Window};
/// use wheelrail::load::{Cells, HalfSpace, press_alone};
/// # let rail = Arc::about([0.0, -300.0], 300.0, Half::Upper, [-35.0, 35.0])?;
/// # let rail = Profile::new("crown", "", vec![Segment::arc(rail)])?;
/// # let wheel = Profile::new("cylinder", "", vec![Segment::arc(Arc::line([-60.0, 0.0], [60.0, 0.0])?)])?;
/// # let pair = Pair::new(rail, wheel, 460.0)?;
/// let placement = pair.placed(0.0, 0.0, 0.0)?; // a crown of 300 mm below a cylinder of 460 mm
/// let approach = 0.090_487_9;
/// let extent = Patch::new(&placement, approach, &Window::UNBOUNDED).extent().expect("a patch");
/// let cells = Cells::over(&extent, [64, 64])?;
/// let region = HalfSpace::new(cells, &cells.separations(&placement), approach)?;
/// let [found, wider] = press_alone(region, 1e-4, 113_932.0)?;
/// let largest = found.largest();
/// assert!((found.load() / 80_000.0 - 1.0).abs() < 1e-3);
/// assert!((largest.pressure_n_per_mm2 / 1139.19 - 1.0).abs() < 2e-3); // Hertz
/// assert!(found.largest_error(&wider) < 5.0);
/// # Ok::<(), wheelrail::Error>(())
/// ```
pub fn press_alone(mut region: HalfSpace, tolerance: f64, modulus: f64) -> Result<[Pressures; 2]> {
    let wider = region.wider();
    let wider = if wider.depth.len() > FEW_CELLS {
        let [wider, _] = press_alone(wider, tolerance, modulus)?;
        wider
    } else {
        press(&[wider.alone()], tolerance, modulus)?.swap_remove(0)
    };
    region.start = region.cells.filled(&wider.relative);
    let fine = press(&[region.alone()], tolerance, modulus)?.swap_remove(0);
    Ok([fine, wider])
}

/// Solves a region again on cells twice as wide, every second one of its own: what [`Pressures::largest_error`] compares with.
/// The tolerance is that of [`press`]. Cost: a tenth of the finer solution.
///
/// # Errors
/// The errors of [`press`].
pub fn on_wider_cells(solved: &Pressures, tolerance: f64) -> Result<Pressures> {
    let Pressures { cells, depth, relative, unit, .. } = solved;
    let own = HalfSpace { cells: *cells, depth: depth.clone(), start: relative.clone() };
    Ok(press(&[own.wider().alone()], tolerance, unit / PI)?.swap_remove(0))
}

/// Solves a region again on cells half as wide along its [`Pressures::rough_axes`]; δ \[mm\] is its approach, and what other regions have
/// pressed down stays. The tolerance is that of [`press`]. Cost: up to five times that of the solution.
///
/// # Errors
/// The errors of [`press`], and more than four million cells.
pub fn on_finer_cells(
    placement: &Placement,
    solved: &Pressures,
    approach: f64,
    tolerance: f64,
) -> Result<Pressures> {
    let Pressures { cells, relative, unit, lowered, .. } = solved;
    let own = HalfSpace { cells: *cells, depth: Vec::new(), start: relative.clone() };
    let finer = own.finer(placement, approach - lowered, solved.rough_axes())?.beginning_at(solved);
    let found = press(&[finer.alone()], tolerance, unit / PI)?.swap_remove(0);
    Ok(Pressures { lowered: *lowered, ..found })
}

/// Solves half-spaces that press upon each other for their pressures; `modulus` is E* \[N/mm²\].
///
/// No condition of contact is violated by more than `tolerance` of δ. The load of an ellipse then errs by less than 3/2 `tolerance`, the
/// largest pressure by 5 `tolerance`. Cells add 0.2 % of the load and 1 % of the largest pressure for 32 × 16 over the box of a patch,
/// less with the square of their sides. Another region counts by its whole force: it displaces this one by F cos γ/(π E* r), with r
/// between the middles and γ between the normals.
/// Cost: 10 to 20 products for 32 × 16 cells, 4 µs each; 20 to 40 for 200 × 200, 1 ms each.
/// Degenerate: no pressure where s < δ in no cell.
///
/// # Errors
/// Pressures that do not settle in 400 steps.
pub fn press(regions: &[Located], tolerance: f64, modulus: f64) -> Result<Vec<Pressures>> {
    let influence = |Located { region, .. }: &Located| Influence::new(region.cells.count, region.cells.step);
    let mut system = System {
        influences: regions.iter().map(influence).collect(),
        areas: regions.iter().map(|located| located.region.cells.area()).collect(),
        nearness: regions.iter().flat_map(|a| regions.iter().map(|b| nearness(a, b))).collect(),
    };
    let joined = |of: fn(&HalfSpace) -> &Vec<f64>| -> Vec<f64> {
        regions.iter().flat_map(|located| of(&located.region)).copied().collect()
    };
    let (depth, mut pressure) = (joined(|region| &region.depth), joined(|region| &region.start));
    let settled = system.settle(&depth, &mut pressure, tolerance);
    if settled.violation > tolerance {
        let found = format!("overlaps of {:.1e} δ after {} steps", settled.violation, settled.steps);
        let expected = format!("pressures that leave at most {tolerance:e} δ");
        return Err(Error::new("pressure", found, expected, "give fewer cells, or cells nearer to squares"));
    }
    let mut rest = pressure.as_slice();
    let each = regions.iter().zip(system.far(&pressure)).map(|(Located { region, .. }, lowered)| {
        let (own, others) = rest.split_at(region.depth.len());
        rest = others;
        let depth = region.depth.iter().map(|depth| (depth - lowered).max(0.0)).collect();
        let violation = settled.violation;
        Pressures {
            cells: region.cells,
            lowered,
            relative: own.to_vec(),
            unit: PI * modulus,
            violation,
            depth,
        }
    });
    Ok(each.collect())
}

/// Gives cos γ/r \[1/mm\] of two regions with γ between their normals: the displacement of one along its normal under a force π E* on the
/// other. 0 of a region and itself, and of normals more than 90° apart.
fn nearness(a: &Located, b: &Located) -> f64 {
    let distance = (a.middle - b.middle).norm();
    if distance > 0.0 { a.normal.dot(&b.normal).max(0.0) / distance } else { 0.0 }
}

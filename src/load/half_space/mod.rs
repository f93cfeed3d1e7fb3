//! The pressures that an approach δ causes over regions of contact: elastic half-spaces of cells with constant pressure.
//!
//! Pressures p ≥ 0 press the surfaces apart until s + u(p) = δ where p > 0, and s + u(p) ≥ δ elsewhere, with
//! u = 1/(π E*) ∬ p/r (Boussinesq).

mod cells;
mod influence;
mod pressures;
mod settle;

use std::f64::consts::PI;

use nalgebra::{Point3, Vector3};

use crate::error::{Error, Result};
use crate::patch::Window;
use crate::placement::Placement;
pub use cells::Cells;
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

    /// Lets the search begin at the pressures of another approach. Pressures on another number of cells are ignored.
    pub fn beginning_at(mut self, known: &Pressures) -> Self {
        if known.cells.count == self.cells.count {
            self.start.copy_from_slice(&known.relative);
        }
        self
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::load::hertz::{Curvatures, Ellipse};
    use crate::numerics::interval::Interval;

    /// E* of steel \[N/mm²\].
    const STEEL: f64 = 113_932.0;

    /// Cells over the box around the overlap of a paraboloid about `centre`, with its ellipse.
    fn paraboloid(
        [a, b]: [f64; 2],
        centre: [f64; 2],
        approach: f64,
        count: [usize; 2],
    ) -> Result<(HalfSpace, Option<Ellipse>)> {
        let [xi, eta] = [(a, centre[0]), (b, centre[1])].map(|(curvature, centre)| {
            let reach = (approach / curvature).sqrt();
            Interval::of(centre).grown(reach)
        });
        let cells = Cells::over(&Window { xi, eta }, count)?;
        let gaps = gaps(&cells, |x, y| a * (x - centre[0]).powi(2) + b * (y - centre[1]).powi(2));
        let curvatures = Curvatures { a_per_mm: a.min(b), b_per_mm: a.max(b), long_axis_rad: 0.0 };
        Ok((HalfSpace::new(cells, &gaps, approach)?, curvatures.under_approach(approach, STEEL)))
    }

    fn gaps(cells: &Cells, gap: impl Fn(f64, f64) -> f64) -> Vec<f64> {
        let eta = cells.middles(1);
        cells.middles(0).iter().flat_map(|x| eta.iter().map(|y| gap(*x, *y))).collect()
    }

    fn differs(found: f64, expected: f64) -> f64 {
        (found / expected - 1.0).abs()
    }

    /// Circles, and ellipses of up to 1 : 70, long along ξ or along η.
    #[test]
    fn hertz_is_found_on_the_cells_of_loads() -> Result<()> {
        for curvatures in
            [[1e-3, 1e-3], [5e-4, 2e-3], [2e-3, 5e-4], [1.1e-3, 0.04], [0.04, 1.1e-3], [2e-5, 0.02]]
        {
            for approach in [1e-6, 0.02, 0.1] {
                let (region, exact) = paraboloid(curvatures, [3.0, 0.0], approach, CELLS)?;
                let Some(exact) = exact else { panic!("no ellipse") };
                let found = press(&[region.alone()], 3e-4, STEEL)?.swap_remove(0);
                assert!(
                    differs(found.load(), exact.load_n) < 2.5e-3,
                    "{curvatures:?}: {} {exact:?}",
                    found.load()
                );
                let largest = found.largest();
                assert!(
                    differs(largest.pressure_n_per_mm2, exact.pressure_n_per_mm2) < 0.01,
                    "{largest:?} {exact:?}"
                );
            }
        }
        Ok(())
    }

    #[test]
    fn hertz_is_found_on_fine_cells_with_an_estimate_of_the_error() -> Result<()> {
        let cases = [
            ([1e-3, 1e-3], [100, 100]),
            ([5e-4, 2e-3], [96, 81]),
            ([0.04, 1.1e-3], [100, 60]),
            ([2e-5, 0.02], [128, 64]),
        ];
        for (curvatures, count) in cases {
            let (region, exact) = paraboloid(curvatures, [0.0, -2.0], 0.08, count)?;
            let Some(exact) = exact else { panic!("no ellipse") };
            let [fine, wider] = press_alone(region, 1e-4, STEEL)?;
            let found = fine.largest();
            let error = differs(found.pressure_n_per_mm2, exact.pressure_n_per_mm2);
            assert!(error < 1e-3, "{curvatures:?}: {found:?} {exact:?}");
            let estimate = fine.largest_error(&wider) / exact.pressure_n_per_mm2;
            assert!(error < estimate && estimate < 5e-3, "{curvatures:?}: {error:e} {estimate:e}");
            assert!(
                found.at_mm[0].abs() < 0.005 * exact.a_mm
                    && (found.at_mm[1] + 2.0).abs() < 0.005 * exact.a_mm
            );
            assert!(differs(fine.load(), exact.load_n) < 3e-4, "{curvatures:?}: {} {exact:?}", fine.load());
            let area = std::f64::consts::PI * exact.a_mm * exact.b_mm;
            assert!(
                differs(fine.contact_area(), area) < 5e-3,
                "{curvatures:?}: {} {area}",
                fine.contact_area()
            );
        }
        Ok(())
    }

    /// The middle of a cylinder 30 times as long as its contact is wide: p₀ = E* b/2R of the plane problem.
    #[test]
    fn the_middle_of_a_long_cylinder_has_the_pressures_of_a_line() -> Result<()> {
        let (radius, half_length, width) = (10.0, 30.0, 2.0);
        let window = Window { xi: Interval::symmetric(half_length), eta: Interval::symmetric(width) };
        let cells = Cells::over(&window, [60, 80])?;
        let region = HalfSpace::new(cells, &gaps(&cells, |_, y| y * y / (2.0 * radius)), 0.1)?;
        let found = press(&[region.alone()], 1e-4, STEEL)?.swap_remove(0);
        let middle = &found.values()[30 * 80..31 * 80];
        let force: f64 = middle.iter().sum::<f64>() * cells.step[1];
        let line = (force * STEEL / (std::f64::consts::PI * radius)).sqrt();
        let most = middle.iter().fold(0.0, |a: f64, b| a.max(*b));
        assert!(differs(most, line) < 5e-3, "{most} {line}");
        Ok(())
    }

    /// Two spheres, solved on one grid over both and as two regions that press upon each other from afar.
    #[test]
    fn regions_press_upon_each_other_as_on_one_grid() -> Result<()> {
        let (a, approach) = (2e-3, [0.08, 0.05]);
        for distance in [16.0, 30.0] {
            let cells = Cells::over(
                &Window { xi: Interval::new(-8.0, distance + 8.0), eta: Interval::symmetric(8.0) },
                [240, 120],
            )?;
            let one = |x: f64, y: f64, lift: f64| a * (x * x + y * y) + lift;
            let both =
                gaps(&cells, |x, y| one(x, y, 0.0).min(one(x - distance, y, approach[0] - approach[1])));
            let whole = press(&[HalfSpace::new(cells, &both, approach[0])?.alone()], 1e-4, STEEL)?;
            let columns = cells.middles(0).iter().filter(|x| **x < distance / 2.0).count() * cells.count[1];
            let left: f64 = whole[0].values()[..columns].iter().sum::<f64>() * cells.area();
            let (first, alone) = paraboloid([a, a], [0.0; 2], approach[0], [64, 64])?;
            let (second, _) = paraboloid([a, a], [0.0; 2], approach[1], [64, 64])?;
            let second = Located { middle: Point3::new(distance, 0.0, 0.0), ..second.alone() };
            let apart: Vec<f64> =
                press(&[first.alone(), second], 1e-4, STEEL)?.iter().map(Pressures::load).collect();
            assert!(differs(apart[0], left) < 2e-3, "{distance}: {apart:?} {left}");
            assert!(differs(apart.iter().sum(), whole[0].load()) < 2e-3, "{distance}: {apart:?}");
            assert!(alone.is_some_and(|alone| differs(alone.load_n, left) > 0.01), "{alone:?} {left}");
        }
        Ok(())
    }

    #[test]
    fn nothing_presses_without_overlap() -> Result<()> {
        let cells =
            Cells::over(&Window { xi: Interval::new(0.0, 1.0), eta: Interval::new(0.0, 1.0) }, [8, 8])?;
        let found = press(&[HalfSpace::new(cells, &[f64::NAN; 64], 0.1)?.alone()], 1e-4, STEEL)?;
        assert_eq!(
            [found[0].load(), found[0].contact_area(), found[0].largest().pressure_n_per_mm2],
            [0.0; 3]
        );
        assert!(press(&[], 1e-4, STEEL)?.is_empty());
        assert!(Cells::over(&Window::UNBOUNDED, [8, 8]).is_err());
        assert!(HalfSpace::new(cells, &[0.0; 63], 0.1).is_err());
        Ok(())
    }
}

//! The normal load that an approach δ causes over a region of the patch: an elastic half-space of cells with constant pressure.
//!
//! Pressures p ≥ 0 press the surfaces apart until s + u(p) = δ where p > 0, and s + u(p) ≥ δ elsewhere, with
//! u = 1/(π E*) ∬ p/r (Boussinesq). Solved by the conjugate gradients of Polonsky and Keer (1999) for a given approach.

use crate::patch::Window;
use crate::placement::Placement;
use crate::separation::Evaluator;

/// Cells along ξ and along η of the box around a region: the load of Hertz's ellipse is then right to 0.2 %. Profiles have
/// what is not Hertz's along ξ.
const CELLS: [usize; 2] = [32, 16];

/// Demand on the sum of all changes of pressure in a step, relative to the load: a hundredth of what cells err by.
const SETTLED: f64 = 1e-6;

/// Steps of conjugate gradients; a region of one part takes about 20.
const MOST_STEPS: usize = 400;

/// The cells of a region, with the pressures of the last approach: the next one starts from them.
#[derive(Debug, Clone)]
pub struct HalfSpace {
    /// p/(π E*) of every cell \[1\], at i_ξ · n_η + i_η.
    pressure: Vec<f64>,
}

impl Default for HalfSpace {
    fn default() -> Self {
        Self { pressure: vec![0.0; CELLS[0] * CELLS[1]] }
    }
}

impl HalfSpace {
    /// Gives the normal load \[N\] of the region inside `extent`, the box around it, under an approach δ \[mm\]; `modulus` is
    /// E* \[N/mm²\].
    ///
    /// Both bodies count as half-spaces along the tangent plane at C. Accuracy: that of the cells, 0.2 % of the load of a
    /// convex region. Cost: some milliseconds. Degenerate: 0 where s < δ in no cell.
    pub fn load(&mut self, placement: &Placement, extent: &Window, approach: f64, modulus: f64) -> f64 {
        let [xi, eta] = [extent.xi, extent.eta];
        let step = [(xi[1] - xi[0]) / CELLS[0] as f64, (eta[1] - eta[0]) / CELLS[1] as f64];
        let centres = |from: f64, k: usize| -> Vec<f64> {
            (0..CELLS[k]).map(|i| from + (i as f64 + 0.5) * step[k]).collect()
        };
        let eta = centres(eta[0], 1);
        let (mut evaluator, mut gap) = (Evaluator::new(placement), vec![0.0; CELLS[0] * CELLS[1]]);
        for (column, xi) in gap.chunks_exact_mut(CELLS[1]).zip(centres(xi[0], 0)) {
            evaluator.column(xi, &eta, column);
        }
        let depth: Vec<f64> = gap.iter().map(|s| if *s < approach { approach - s } else { 0.0 }).collect();
        let influence = Influence::new(step);
        self.settle(&influence, &depth);
        std::f64::consts::PI * modulus * step[0] * step[1] * self.pressure.iter().sum::<f64>()
    }

    /// Finds the pressures that close `depth`, the overlap of every cell \[mm\].
    fn settle(&mut self, influence: &Influence, depth: &[f64]) {
        let count = depth.len();
        for (p, depth) in self.pressure.iter_mut().zip(depth) {
            *p = if *depth > 0.0 { *p } else { 0.0 };
        }
        if self.pressure.iter().all(|p| *p == 0.0) {
            let sum = influence.rows.iter().sum::<f64>();
            self.pressure = depth.iter().map(|depth| depth / sum).collect();
        }
        let (mut search, mut residual, mut response) = (vec![0.0; count], vec![0.0; count], vec![0.0; count]);
        let mut before = f64::INFINITY;
        for _ in 0..MOST_STEPS {
            influence.apply(&self.pressure, &mut residual);
            for (g, depth) in residual.iter_mut().zip(depth) {
                *g -= depth;
            }
            let pressed = |p: &f64| *p > 0.0;
            let square: f64 =
                self.pressure.iter().zip(&residual).filter(|(p, _)| pressed(p)).map(|(_, g)| g * g).sum();
            for ((t, g), p) in search.iter_mut().zip(&residual).zip(&self.pressure) {
                *t = if pressed(p) { g + square / before * *t } else { 0.0 };
            }
            influence.apply(&search, &mut response);
            let along = |v: &[f64]| search.iter().zip(v).map(|(t, v)| t * v).sum::<f64>();
            let [rise, curvature] = [along(&residual), along(&response)];
            if curvature <= 0.0 {
                return;
            }
            let length = rise / curvature;
            let (mut change, mut total, mut joined) = (0.0, 0.0, false);
            for (((p, t), g), depth) in self.pressure.iter_mut().zip(&search).zip(&residual).zip(depth) {
                let old = *p;
                *p = (old - length * t).max(0.0);
                // A cell without pressure that still overlaps is pressed, and the directions start afresh.
                if *p == 0.0 && *g < 0.0 && *depth > 0.0 {
                    *p = -length * g;
                    joined = true;
                }
                change += (*p - old).abs();
                total += *p;
            }
            before = if joined { f64::INFINITY } else { square };
            if change <= SETTLED * total {
                return;
            }
        }
    }
}

/// Displacements \[mm\] of cells under a cell of unit pressure p/(π E*).
struct Influence {
    /// For every distance of columns, those at −(n_η − 1) … n_η − 1 cells along η.
    rows: Vec<f64>,
}

impl Influence {
    const LENGTH: usize = 2 * CELLS[1] - 1;

    fn new(step: [f64; 2]) -> Self {
        let mut rows = Vec::with_capacity(CELLS[0] * Self::LENGTH);
        for column in 0..CELLS[0] {
            let along = (0..Self::LENGTH).map(|k| k.abs_diff(CELLS[1] - 1));
            rows.extend(along.map(|cells| love([column as f64, cells as f64], step)));
        }
        Self { rows }
    }

    /// Computes the displacements \[mm\] under all pressures.
    fn apply(&self, pressure: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        for (from, pressed) in pressure.chunks_exact(CELLS[1]).enumerate() {
            for (j, p) in pressed.iter().enumerate().filter(|(_, p)| **p != 0.0) {
                for (to, out) in out.chunks_exact_mut(CELLS[1]).enumerate() {
                    let row = &self.rows[to.abs_diff(from) * Self::LENGTH..][CELLS[1] - 1 - j..];
                    for (u, k) in out.iter_mut().zip(row) {
                        *u += p * k;
                    }
                }
            }
        }
    }
}

/// Gives ∬ 1/r over a cell, from a point this many cells away \[mm\] (Love 1929).
fn love(cells: [f64; 2], step: [f64; 2]) -> f64 {
    let edges = [0, 1].map(|k| [(cells[k] - 0.5) * step[k], (cells[k] + 0.5) * step[k]]);
    let [x, y] = edges;
    // No edge of a cell goes through the centre of one: nothing is divided by 0.
    let part = |a: f64, [from, to]: [f64; 2]| a * ((to / a.abs()).asinh() - (from / a.abs()).asinh());
    part(x[1], y) - part(x[0], y) + part(y[1], x) - part(y[0], x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Result;
    use crate::load::hertz::curvatures;
    use crate::patch::Patch;
    use crate::placement::Pair;
    use crate::profile::{Arc, Half, Profile, Segment};

    /// E* of steel \[N/mm²\].
    const STEEL: f64 = 113_932.0;

    fn crossed_cylinders(radius: f64) -> Result<Placement> {
        let rail = Arc::about([0.0, -radius], radius, Half::Upper, [-0.8 * radius, 0.8 * radius])?;
        let wheel = Arc::line([-0.8 * radius, 0.0], [0.8 * radius, 0.0])?;
        let profile = |arc| Profile::new("test", "test", vec![Segment::arc(arc)]);
        Pair::new(profile(rail)?, profile(wheel)?, 460.0)?.placed(0.0, 0.0, 0.0)
    }

    #[test]
    fn hertz_has_the_load_of_the_cells() -> Result<()> {
        for (radius, depth) in [(300.0, 0.09), (13.0, 0.05), (80.0, 0.02), (20_000.0, 0.1)] {
            let placement = crossed_cylinders(radius)?;
            let extent = Patch::new(&placement, depth, &Window::UNBOUNDED).extent();
            let Some(extent) = extent else { panic!("no patch") };
            let start = std::time::Instant::now();
            let load = HalfSpace::default().load(&placement, &extent, depth, STEEL);
            let took = start.elapsed();
            let exact = curvatures(&placement).under_approach(depth, STEEL).map(|ellipse| ellipse.load_n);
            println!("{radius}: {load} {exact:?} {:e} {took:?}", load / exact.unwrap_or(0.0) - 1.0);
            assert!(exact.is_some_and(|exact| (load / exact - 1.0).abs() < 4e-3), "{load} {exact:?}");
        }
        Ok(())
    }
}

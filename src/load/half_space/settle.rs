//! Pressures that close an overlap: conjugate gradients of Polonsky and Keer (1999) for a given approach.

use std::ops::Range;

use super::influence::Influence;

/// Steps of conjugate gradients after which they are given up; 200² cells take some 40, and a region of several lobes 80.
const MOST_STEPS: usize = 400;

/// Least overlap that a region's own pressures have to close, as a share of its depth. Its load is then a thousandth of what it would
/// carry alone.
const SHALLOW: f64 = 0.01;

/// Cells of one or several regions that press upon each other.
pub(super) struct System {
    /// Displacements of every region under its own pressures.
    pub influences: Vec<Influence>,
    /// Area of a cell of every region \[mm²\].
    pub areas: Vec<f64>,
    /// Displacement of the region of each row under a force π E* on that of each column \[1/mm\]; 0 of a region and itself.
    pub nearness: Vec<f64>,
}

/// The end of a search by conjugate gradients.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SettledPressures {
    /// Largest violation of contact's conditions, relative to the overlap that its region's own pressures have to close.
    pub violation: f64,
    /// Steps taken.
    pub steps: usize,
}

/// The vectors of a search, for all cells of all regions.
struct SolverVectors {
    /// u(p) − depth \[mm\]: 0 where pressed, ≥ 0 elsewhere at the end.
    residual: Vec<f64>,
    /// Search direction \[1\], and the displacements under it \[mm\] in `response`.
    direction: Vec<f64>,
    response: Vec<f64>,
}

impl System {
    /// Finds the pressures p/(π E*) ≥ 0 with u(p) = depth where p > 0 and u(p) ≥ depth elsewhere; `depth` is the overlap δ − s of
    /// every cell \[mm\], at most 0 where there is none. The search begins at `pressure`, scaled to the depth.
    ///
    /// It ends when no condition is violated by more than `tolerance` of its region's approach. By Betti's theorem the load then errs by
    /// less than `tolerance` · d ln F/d ln δ, which is 3/2 for an ellipse.
    /// Cost: a product for each step, and two where cells lose or gain contact.
    pub fn settle(&mut self, depth: &[f64], pressure: &mut [f64], tolerance: f64) -> SettledPressures {
        let mut search = self.begin(depth, pressure);
        let (mut before, mut steps) = (f64::INFINITY, 0);
        loop {
            let violation = self.violation(&search.residual, pressure, depth);
            if violation <= tolerance || steps == MOST_STEPS {
                return SettledPressures { violation, steps };
            }
            steps += 1;
            let square = self.product(&search.residual, &search.residual, pressure);
            for ((t, g), p) in search.direction.iter_mut().zip(&search.residual).zip(&*pressure) {
                *t = if *p > 0.0 { g + square / before * *t } else { 0.0 };
            }
            self.displacements(&search.direction, &mut search.response);
            let rise = self.product(&search.direction, &search.residual, pressure);
            let length = rise / self.product(&search.direction, &search.response, pressure);
            if !length.is_finite() {
                return SettledPressures { violation, steps };
            }
            let [moved, joined] = step(pressure, &search, depth, length);
            if moved {
                self.displacements(pressure, &mut search.residual);
                search.residual.iter_mut().zip(depth).for_each(|(g, depth)| *g -= depth);
            } else {
                search.residual.iter_mut().zip(&search.response).for_each(|(g, r)| *g -= length * r);
            }
            before = if joined { f64::INFINITY } else { square };
        }
    }

    /// Scales the pressures of every region to its depth, and gives their residual.
    fn begin(&mut self, depth: &[f64], pressure: &mut [f64]) -> SolverVectors {
        let count = depth.len();
        let mut residual = vec![0.0; count];
        for (k, cells) in self.ranges().into_iter().enumerate() {
            let (depth, pressure, residual) =
                (&depth[cells.clone()], &mut pressure[cells.clone()], &mut residual[cells]);
            guess(depth, pressure);
            self.influences[k].apply(pressure, residual);
            let along = |v: &[f64]| pressure.iter().zip(v).map(|(p, v)| p * v).sum::<f64>();
            let scale = along(depth) / along(residual);
            if scale.is_finite() {
                pressure.iter_mut().chain(residual).for_each(|value| *value *= scale);
            }
        }
        self.add_far(pressure, &mut residual);
        residual.iter_mut().zip(depth).for_each(|(g, depth)| *g -= depth);
        SolverVectors { residual, direction: vec![0.0; count], response: vec![0.0; count] }
    }

    /// Gives where the cells of every region are in the vectors.
    fn ranges(&self) -> Vec<Range<usize>> {
        let mut from = 0;
        let range = |influence: &Influence| {
            let range = from..from + influence.cells();
            from = range.end;
            range
        };
        self.influences.iter().map(range).collect()
    }

    /// Computes the displacements \[mm\] under all pressures.
    fn displacements(&mut self, pressure: &[f64], out: &mut [f64]) {
        let ranges = self.ranges();
        for (influence, cells) in self.influences.iter_mut().zip(ranges) {
            influence.apply(&pressure[cells.clone()], &mut out[cells]);
        }
        self.add_far(pressure, out);
    }

    /// Adds the displacements that every region causes at the others: those of its whole force, at the middle of theirs.
    fn add_far(&self, pressure: &[f64], out: &mut [f64]) {
        let far = self.far(pressure);
        for (cells, far) in self.ranges().into_iter().zip(far) {
            if far != 0.0 {
                out[cells].iter_mut().for_each(|u| *u += far);
            }
        }
    }

    /// Gives the displacement of every region under the forces on the others \[mm\].
    pub fn far(&self, pressure: &[f64]) -> Vec<f64> {
        let ranges = self.ranges();
        let force = |(cells, area): (&Range<usize>, &f64)| area * pressure[cells.clone()].iter().sum::<f64>();
        let forces: Vec<f64> = ranges.iter().zip(&self.areas).map(force).collect();
        let at = |row: &[f64]| row.iter().zip(&forces).map(|(nearness, force)| nearness * force).sum();
        self.nearness.chunks_exact(forces.len().max(1)).map(at).collect()
    }

    /// Gives the sum of a b over the pressed cells, weighted by their area: K is symmetric under it.
    fn product(&self, a: &[f64], b: &[f64], pressure: &[f64]) -> f64 {
        let of = |(cells, area): (Range<usize>, &f64)| {
            let (a, b) = (&a[cells.clone()], &b[cells.clone()]);
            let each = a.iter().zip(b).zip(&pressure[cells]);
            area * each.map(|((a, b), p)| if *p > 0.0 { a * b } else { 0.0 }).sum::<f64>()
        };
        self.ranges().into_iter().zip(&self.areas).map(of).sum()
    }

    /// Gives the largest violation of contact's conditions, relative to what its region's own pressures have to close.
    fn violation(&self, residual: &[f64], pressure: &[f64], depth: &[f64]) -> f64 {
        let of = |(cells, far): (Range<usize>, f64)| {
            let deepest = depth[cells.clone()].iter().fold(0.0, |a: f64, d| a.max(*d));
            let each = residual[cells.clone()].iter().zip(&pressure[cells]);
            let worst = each.fold(0.0, |worst: f64, (g, p)| worst.max(if *p > 0.0 { g.abs() } else { -g }));
            if worst == 0.0 { 0.0 } else { worst / (deepest - far).max(SHALLOW * deepest) }
        };
        self.ranges().into_iter().zip(self.far(pressure)).map(of).fold(0.0, f64::max)
    }
}

/// Makes pressures to begin with: those known where there is depth, or those of an ellipse if none are known. Hertz's ellipse ends
/// where the depth is half of the largest, and its pressure falls as the root.
fn guess(depth: &[f64], pressure: &mut [f64]) {
    for (p, depth) in pressure.iter_mut().zip(depth) {
        *p = if *depth > 0.0 { *p } else { 0.0 };
    }
    if pressure.iter().all(|p| *p == 0.0) {
        let deepest = depth.iter().fold(0.0, |a: f64, d| a.max(*d));
        for (p, depth) in pressure.iter_mut().zip(depth) {
            *p = (depth - 0.5 * deepest).max(0.0).sqrt();
        }
    }
}

/// Steps along the direction. Tells whether a cell lost or gained contact, and whether one gained it: one without pressure that
/// still overlaps is pressed.
fn step(pressure: &mut [f64], search: &SolverVectors, depth: &[f64], length: f64) -> [bool; 2] {
    let [mut moved, mut joined] = [false; 2];
    let each = pressure.iter_mut().zip(&search.direction).zip(&search.residual).zip(depth);
    for (((p, t), g), depth) in each {
        let next = *p - length * t;
        moved |= next < 0.0;
        *p = next.max(0.0);
        if *p == 0.0 && *g < 0.0 && *depth > 0.0 {
            *p = -length * g;
            [moved, joined] = [true; 2];
        }
    }
    [moved, joined]
}

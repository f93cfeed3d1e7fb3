//! The conformal patch by a flood fill of a fine grid of t.

use wheelrail::Interval;
use wheelrail::Window;
use wheelrail::conformal::{NormalGap, fill_normal_gap};
use wheelrail::separation::EtaAxis;

/// Tolerance of the grid's values \[mm\].
const TOLERANCE: f64 = 1e-9;

/// t − δ cos α over a grid.
pub struct Filled {
    sigma: Vec<f64>,
    eta: Vec<f64>,
    depth: Vec<f64>,
}

impl Filled {
    /// Fills n × n points of a window; infinite where t is undefined.
    pub fn new(gap: &NormalGap<'_>, approach: f64, window: &Window, n: usize) -> Self {
        let axis = |side: Interval| (0..n).map(|k| side.step(k, n - 1)).collect::<Vec<f64>>();
        let (sigma, eta) = (axis(window.xi), axis(window.eta));
        let mut depth = vec![0.0; n * n];
        fill_normal_gap(gap, &sigma, &EtaAxis::new(&eta), TOLERANCE, &mut depth);
        for (column, &sigma) in depth.chunks_mut(n).zip(&sigma) {
            let target = approach * gap.angle(sigma).cos();
            column.iter_mut().for_each(|t| *t = if t.is_nan() { f64::INFINITY } else { *t - target });
        }
        Self { sigma, eta, depth }
    }

    /// Area by straight lines between the points of every column \[mm²\].
    pub fn area(&self) -> f64 {
        let share = |a: f64, b: f64| match (a < 0.0, b < 0.0) {
            (true, true) => 1.0,
            (false, false) => 0.0,
            _ if a.is_infinite() || b.is_infinite() => 0.5,
            (true, false) => a / (a - b),
            (false, true) => b / (b - a),
        };
        let cell = (self.sigma[1] - self.sigma[0]) * (self.eta[1] - self.eta[0]);
        let last = self.sigma.len() - 1;
        let column = |(i, column): (usize, &[f64])| {
            let length: f64 = column.windows(2).map(|d| share(d[0], d[1])).sum();
            if i == 0 || i == last { 0.5 * length } else { length }
        };
        self.depth.chunks(self.eta.len()).enumerate().map(column).sum::<f64>() * cell
    }

    /// Boxes around the connected parts of the points inside.
    pub fn parts(&self) -> Vec<Window> {
        let m = self.eta.len();
        let n = self.depth.len() / m;
        let mut known = vec![false; self.depth.len()];
        let mut parts = Vec::new();
        for start in 0..self.depth.len() {
            if known[start] || self.depth[start] >= 0.0 {
                continue;
            }
            let empty = Window { xi: Interval::NONE, eta: Interval::NONE };
            let (mut extent, mut stack) = (empty, vec![start]);
            known[start] = true;
            while let Some(k) = stack.pop() {
                let (i, j) = (k / m, k % m);
                extent.xi = extent.xi.with(self.sigma[i]);
                extent.eta = extent.eta.with(self.eta[j]);
                for p in i.saturating_sub(1)..(i + 2).min(n) {
                    for q in j.saturating_sub(1)..(j + 2).min(m) {
                        if !known[p * m + q] && self.depth[p * m + q] < 0.0 {
                            known[p * m + q] = true;
                            stack.push(p * m + q);
                        }
                    }
                }
            }
            parts.push(extent);
        }
        parts
    }
}

//! Finds the patch by a flood fill over a fine grid.

use wheelrail::Interval;
use wheelrail::patch::Window;
use wheelrail::placement::Placement;
use wheelrail::separation::Evaluator;

/// Number of points along the shorter side of the grid.
const FEWEST: f64 = 160.0;
const MOST: f64 = 2400.0;
/// Number of points across a cell at which s is interpolated for the area.
const INSIDE: usize = 4;
/// Points of the grid below which a component is too small for a flood fill.
const LEAST_POINTS: usize = 9;

/// A patch found by a flood fill.
#[derive(Debug)]
pub(super) struct Filled {
    /// Distance of the grid's points along ξ \[mm\].
    pub step: f64,
    /// Area \[mm²\].
    pub area: f64,
    /// Number of connected parts of at least nine points.
    pub parts: usize,
    /// Area \[mm²\] of nine cells: smaller parts are not counted.
    pub least_area: f64,
}

/// Fills {s < δ} within a window.
pub(super) fn filled(placement: &Placement, approach: f64, window: &Window) -> Filled {
    let sides = [window.xi, window.eta].map(Interval::width);
    let step = sides[0].min(sides[1]) / FEWEST;
    let counts = sides.map(|side| (side / step).ceil().clamp(2.0, MOST) as usize + 1);
    let eta: Vec<f64> = (0..counts[1]).map(|k| window.eta.step(k, counts[1] - 1)).collect();
    let mut evaluator = Evaluator::new(placement);
    let mut s = vec![f64::NAN; counts[0] * counts[1]];
    // Without skew the patch lies over the midplane's overlap.
    let over = if placement.skew() == 0.0 { placement.overlap() } else { Some(window.xi) };
    for (k, column) in s.chunks_exact_mut(counts[1]).enumerate() {
        let xi = window.xi.step(k, counts[0] - 1);
        if over.is_some_and(|over| over.contains(xi)) {
            evaluator.column(xi, &eta, column);
        }
    }
    let cell = sides[0] / (counts[0] - 1) as f64 * (sides[1] / (counts[1] - 1) as f64);
    Filled {
        area: cell * covered(&s, counts[1], approach),
        step: sides[0] / (counts[0] - 1) as f64,
        parts: parts(&s, counts[1], approach),
        least_area: cell * LEAST_POINTS as f64,
    }
}

/// Returns the number of cells covered by the patch; s is bilinear in each. Cells with a corner off a body
/// count by their defined corners.
fn covered(s: &[f64], n: usize, approach: f64) -> f64 {
    let mut sum = 0.0;
    for k in 0..s.len() / n - 1 {
        for l in 0..n - 1 {
            let corners = [s[k * n + l], s[k * n + l + 1], s[(k + 1) * n + l], s[(k + 1) * n + l + 1]];
            let inside = corners.iter().filter(|s| **s < approach).count();
            sum += match inside {
                0 => 0.0,
                4 => 1.0,
                _ if corners.iter().any(|s| s.is_nan()) => inside as f64 / 4.0,
                _ => share(corners, approach),
            };
        }
    }
    sum
}

fn share([a, b, c, d]: [f64; 4], approach: f64) -> f64 {
    let places = || (0..INSIDE).map(|k| (k as f64 + 0.5) / INSIDE as f64);
    let below = |(u, v): (f64, f64)| {
        let s = (1.0 - u) * ((1.0 - v) * a + v * b) + u * ((1.0 - v) * c + v * d);
        s < approach
    };
    let inside = places().flat_map(|u| places().map(move |v| (u, v))).filter(|&at| below(at)).count();
    inside as f64 / (INSIDE * INSIDE) as f64
}

/// Returns the number of connected parts of at least [`LEAST_POINTS`], by steps along ξ, η and both.
fn parts(s: &[f64], n: usize, approach: f64) -> usize {
    let mut seen: Vec<bool> = s.iter().map(|s| s.is_nan() || *s >= approach).collect();
    let rows = s.len() / n;
    let (mut count, mut open) = (0, Vec::new());
    for start in 0..s.len() {
        if seen[start] {
            continue;
        }
        seen[start] = true;
        open.push(start);
        let mut size = 0;
        while let Some(at) = open.pop() {
            size += 1;
            let (k, l) = (at / n, at % n);
            for i in k.saturating_sub(1)..=(k + 1).min(rows - 1) {
                for j in l.saturating_sub(1)..=(l + 1).min(n - 1) {
                    if !std::mem::replace(&mut seen[i * n + j], true) {
                        open.push(i * n + j);
                    }
                }
            }
        }
        count += usize::from(size >= LEAST_POINTS);
    }
    count
}

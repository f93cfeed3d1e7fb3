//! Chooses the points of the check: window, joints, tips, boundary and deepest points.

use super::request::Request;
use super::sampler::SampledSurface;
use wheelrail::Interval;
use wheelrail::internal::{bracketed, turning_points};
use wheelrail::patch::Slicer;
use wheelrail::placement::Placement;

/// Numbers of lines of the regular grid in ξ and η, with the edges of the window.
const GRID: [usize; 2] = [9, 7];

/// Number of columns in which the boundary is looked for.
const SLICES: usize = 48;
/// About how many of these columns give points.
const LOOP_POINTS: usize = 8;

/// Returns all (ξ, η) \[mm\] at which rays are cast.
pub(super) fn spread_points(
    placement: &Placement,
    request: &Request,
    rail: &SampledSurface,
    wheel: &SampledSurface,
) -> Vec<[f64; 2]> {
    let (xi, eta) = (request.window.xi, request.window.eta);
    let mut all: Vec<[f64; 2]> = (0..GRID[0] * GRID[1])
        .map(|k| [xi.step(k / GRID[1], GRID[0] - 1), eta.step(k % GRID[1], GRID[1] - 1)])
        .collect();
    all.extend(joints(rail, eta));
    all.extend(joints(wheel, eta));
    all.extend(boundary(placement, request));
    all.retain(|p| xi.contains(p[0]) && eta.contains(p[1]));
    all
}

/// Returns the deepest midplane point, the tips, and points of the boundary s = δ as the program finds them.
///
/// Slices are enough: under yaw, the closed loops of the boundary cost far more than the whole check.
fn boundary(placement: &Placement, request: &Request) -> Vec<[f64; 2]> {
    let Some(overlap) = placement.overlap() else { return Vec::new() };
    let over = request.window.xi.cut(overlap);
    if !over.has_width() {
        return Vec::new();
    }
    let mut slicer = Slicer::new(placement, request.approach);
    let deepest = turning_points(placement, over.low, over.high)
        .into_iter()
        .map(|xi| (slicer.separation(xi, 0.0), xi))
        .filter(|(s, _)| !s.is_nan())
        .min_by(|a, b| a.0.total_cmp(&b.0));
    let mut all: Vec<[f64; 2]> = deepest.iter().map(|&(_, xi)| [xi, 0.0]).collect();
    let columns: Vec<f64> = (0..=SLICES).map(|k| over.step(k, SLICES)).chain(deepest.map(|d| d.1)).collect();
    let mut depths: Vec<(f64, f64)> = columns.iter().map(|&xi| (xi, slicer.depth(xi))).collect();
    depths.sort_by(|a, b| a.0.total_cmp(&b.0));
    for pair in depths.windows(2).filter(|pair| (pair[0].1 < 0.0) != (pair[1].1 < 0.0)) {
        let tip = bracketed(|xi| slicer.depth(xi), pair[0].0, pair[1].0);
        all.extend(tip.and_then(|xi| slicer.slice(xi).map(|slice| [xi, slice.eta.low])));
    }
    for (xi, _) in depths.iter().filter(|(_, depth)| *depth < 0.0).step_by(SLICES / LOOP_POINTS) {
        all.extend(slicer.slice(*xi).iter().flat_map(|slice| slice.eta.ends().map(|eta| [*xi, eta])));
    }
    all
}

/// Returns points over the joints of one body, in the midplane and towards both edges of the window.
fn joints(surface: &SampledSurface, eta: Interval) -> Vec<[f64; 2]> {
    let ends = surface.curves.iter().enumerate().flat_map(|(k, c)| [(k, 0.0), (k, c.length)]);
    ends.flat_map(|(curve, t)| {
        [0.0, 0.5 * eta.low, 0.75 * eta.high].map(|v| {
            let point = surface.point(curve, t, v);
            [point.x, point.y]
        })
    })
    .collect()
}

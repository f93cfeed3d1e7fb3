//! Where to look: window, joints, tips, boundary and deepest points.

use super::Request;
use super::sampler::Surface;
use crate::interpenetration::Patch;
use crate::placement::Placement;

/// Lines of the regular grid in ξ and η, edges of the window included.
const GRID: [usize; 2] = [9, 7];

/// Points taken of each boundary loop.
const LOOP_POINTS: usize = 8;

/// All (ξ, η) \[mm\] at which rays are cast.
pub(super) fn spread_points(
    placement: &Placement,
    request: &Request,
    rail: &Surface,
    wheel: &Surface,
) -> Vec<[f64; 2]> {
    let window = &request.window;
    let at = |[a, b]: [f64; 2], k: usize, n: usize| {
        if k + 1 == n { b } else { a + (b - a) * k as f64 / (n - 1) as f64 }
    };
    let mut all: Vec<[f64; 2]> = (0..GRID[0] * GRID[1])
        .map(|k| [at(window.xi, k / GRID[1], GRID[0]), at(window.eta, k % GRID[1], GRID[1])])
        .collect();
    all.extend(joints(rail, window.eta));
    all.extend(joints(wheel, window.eta));
    for component in Patch::new(placement, request.approach, window).components {
        let [_, xi, eta] = component.deepest;
        all.push([xi, eta]);
        let n = component.boundary.len();
        // The first point is one tip, the middle one the other.
        all.extend((0..LOOP_POINTS).map(|k| component.boundary[k * n / LOOP_POINTS]));
    }
    all.retain(|p| {
        (0..2).all(|k| p[k] >= [window.xi, window.eta][k][0] && p[k] <= [window.xi, window.eta][k][1])
    });
    all
}

/// Points over the joints of one body, in the midplane and towards both edges of the window.
fn joints(surface: &Surface, eta: [f64; 2]) -> Vec<[f64; 2]> {
    let ends = surface.curves.iter().enumerate().flat_map(|(k, c)| [(k, 0.0), (k, c.length)]);
    ends.flat_map(|(curve, t)| {
        [0.0, 0.5 * eta[0], 0.75 * eta[1]].map(|v| {
            let point = surface.point(curve, t, v);
            [point.x, point.y]
        })
    })
    .collect()
}

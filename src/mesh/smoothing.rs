//! Moves the inner nodes of a triangulation to where the triangles around them are better shaped.

use nalgebra::Point2;

/// Number of passes over all inner nodes.
const PASSES: usize = 4;

/// Sine of the smallest angle that a move may leave behind if it makes the smallest angle around a node smaller.
const GOOD: f64 = 0.6;

/// Moves every inner node, in order, to the mean of the centroids of the triangles around it, weighted by their areas, if
/// the smallest angle there does not become smaller, or its sine stays above [`GOOD`]. Nodes before `fixed` stay.
pub(super) fn smooth(points: &mut [Point2<f64>], triangles: &[[usize; 3]], fixed: usize) {
    let mut around: Vec<Vec<usize>> = vec![Vec::new(); points.len()];
    for (k, triangle) in triangles.iter().enumerate() {
        triangle.iter().for_each(|&node| around[node].push(k));
    }
    for _ in 0..PASSES {
        for node in fixed..points.len() {
            let star: Vec<[usize; 3]> = around[node].iter().map(|&k| triangles[k]).collect();
            if star.is_empty() {
                continue;
            }
            let before = least_sine(points, &star);
            let (old, new) = (points[node], centre(points, &star));
            points[node] = new;
            let after = least_sine(points, &star);
            if after.is_nan() || after < before.min(GOOD) {
                points[node] = old;
            }
        }
    }
}

/// Returns the mean of the triangles' centroids, weighted by their areas.
fn centre(points: &[Point2<f64>], star: &[[usize; 3]]) -> Point2<f64> {
    let origin = points[star[0][0]];
    let (mut sum, mut areas) = (nalgebra::Vector2::zeros(), 0.0);
    for triangle in star {
        let [a, b, c] = triangle.map(|node| points[node] - origin);
        let area = (b - a).perp(&(c - a));
        sum += (a + b + c) * (area / 3.0);
        areas += area;
    }
    origin + sum / areas
}

/// Returns the sine of the smallest angle of some triangles; negative if one is clockwise.
fn least_sine(points: &[Point2<f64>], triangles: &[[usize; 3]]) -> f64 {
    triangles.iter().map(|triangle| sine(triangle.map(|node| points[node]))).fold(f64::INFINITY, f64::min)
}

/// Returns the sine of the smallest angle of a triangle, which is opposite its shortest side; negative if it is clockwise.
fn sine([a, b, c]: [Point2<f64>; 3]) -> f64 {
    let [p, q, r] = [b - a, c - b, a - c].map(|side| side.norm_squared());
    (b - a).perp(&(c - a)) / (p * q).max(q * r).max(r * p).sqrt()
}

/// Returns the angles of a triangle at its three corners \[rad\], negative if it is clockwise.
pub(super) fn angles(corners: [Point2<f64>; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| {
        let (here, on, back) = (corners[k], corners[(k + 1) % 3], corners[(k + 2) % 3]);
        (on - here).perp(&(back - here)).atan2((on - here).dot(&(back - here)))
    })
}

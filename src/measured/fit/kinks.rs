//! Finds corners: points where the tangents before and after differ by more than a smooth curve explains.

use super::parabola::Parabola;
use crate::measured::clean::checks::distance;
use crate::measured::read::points::Point;

/// Most steps of a window that are used, evenly picked. More steps do not sharpen a tangent, and windows over dense points
/// would cost n².
const MOST_IN_WINDOW: usize = 48;
/// Fewest points for a tangent, because a parabola needs three.
const LEAST_IN_WINDOW: usize = 3;

/// A corner at a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::measured) struct Kink {
    pub at: usize,
    /// Turn of the tangent \[rad\], positive counter-clockwise.
    pub angle: f64,
}

/// Finds points with a corner sharper than `least` \[rad\].
///
/// Method: on each side a parabola is fitted to the points of that side over `window` \[mm\] of path. An arc of radius r
/// biases each tangent by (window/r)²/10. Noise σ on m points moves it by about 14 σ/(window √m). Of several corners within
/// a window only the sharpest counts.
pub(in crate::measured) fn kinks(points: &[Point], least: f64, window: f64) -> Vec<Kink> {
    let inner = LEAST_IN_WINDOW - 1..points.len().saturating_sub(LEAST_IN_WINDOW - 1);
    let mut path = vec![0.0];
    for (k, pair) in points.windows(2).enumerate() {
        path.push(path[k] + distance(&pair[0], &pair[1]));
    }
    let mut out: Vec<Kink> = Vec::new();
    for at in inner {
        let [before, after] = [false, true].map(|forward| tangent(points, &path, at, forward, window));
        let [cos, sin] =
            [before[0] * after[0] + before[1] * after[1], before[0] * after[1] - before[1] * after[0]];
        let angle = sin.atan2(cos);
        if angle.abs() <= least {
            continue;
        }
        match out.last_mut() {
            Some(last) if path[at] - path[last.at] < window => {
                if angle.abs() > last.angle.abs() {
                    *last = Kink { at, angle };
                }
            }
            _ => out.push(Kink { at, angle }),
        }
    }
    out
}

/// Returns the direction of travel at a point, from the points on one side of it. `path` holds the arc length at each
/// point.
fn tangent(points: &[Point], path: &[f64], at: usize, forward: bool, window: f64) -> [f64; 2] {
    let far = if forward {
        let within = path.partition_point(|&s| s <= path[at] + window) - 1;
        within.max(at + LEAST_IN_WINDOW - 1)
    } else {
        let within = path.partition_point(|&s| s < path[at] - window);
        within.min(at + 1 - LEAST_IN_WINDOW)
    };
    let stride = far.abs_diff(at).div_ceil(MOST_IN_WINDOW);
    let picked: Vec<usize> = if forward {
        (at..=far).step_by(stride).collect()
    } else {
        (far..=at).rev().step_by(stride).collect()
    };
    let slope = |of: fn(&Point) -> f64| {
        let sample = |&j: &usize| ((path[j] - path[at]).abs(), of(&points[j]) - of(&points[at]));
        Parabola::fit(picked.iter().map(sample)).slope()
    };
    let sign = if forward { 1.0 } else { -1.0 };
    [sign * slope(|p| p.x), sign * slope(|p| p.z)]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn path(spacing: f64, at: impl Fn(f64) -> [f64; 2]) -> Vec<Point> {
        (0..(40.0 / spacing) as usize)
            .map(|k| {
                let [x, z] = at(k as f64 * spacing);
                Point { x, z, weight: 1.0, number: k + 1, line: k + 1 }
            })
            .collect()
    }

    #[test]
    fn an_edge_is_found_at_its_point_and_small_radii_are_none() {
        for spacing in [0.02, 0.25, 1.0] {
            // The edge turns by 40° at s = 20.
            let edge = path(spacing, |s| {
                let after = (s - 20.0).max(0.0);
                [s.min(20.0) + after * 40f64.to_radians().cos(), after * 40f64.to_radians().sin()]
            });
            let found = kinks(&edge, 0.5, 2.5);
            assert_eq!(found.len(), 1, "{spacing}: {found:?}");
            assert!((found[0].angle - 40f64.to_radians()).abs() < 1e-9, "{found:?}");
            assert!((edge[found[0].at].x - 20.0).abs() < 1e-9);
            // A line continues into a radius of 6 mm, as at the edge of a flange tip.
            let fillet = path(spacing, |s| {
                let angle = (s - 20.0).max(0.0) / 6.0;
                [s.min(20.0) + 6.0 * angle.sin(), 6.0 * (1.0 - angle.cos())]
            });
            assert!(kinks(&fillet, 0.5, 2.5).is_empty(), "{spacing}");
        }
    }
}

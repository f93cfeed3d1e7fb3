//! Finds corners: isolated kinks, where the tangents before and after differ by more than noise and a smooth curve explain.

use super::parabola::Parabola;
use crate::measured::clean::checks::distance;
use crate::measured::read::points::Point;

/// Length of path on each side of a kink of a full-sized profile \[mm\]. It does not follow the cut-off wavelength: the corners are
/// those of the points.
const WINDOW: f64 = 2.5;
/// Most steps of a window that are used, evenly picked. More steps do not sharpen a tangent, and windows over dense points
/// would cost n².
const MOST_IN_WINDOW: usize = 48;
/// Fewest points for a tangent: a parabola needs three, and three more show whether the points lie on it. The ends of a file may have
/// three.
const LEAST_IN_WINDOW: usize = 6;
const LEAST_AT_END: usize = 3;
/// Deviation of a parabola's slope at its end over m points of noise σ, in σ/(window √m): √192.
const END_SLOPE: f64 = 13.86;
/// Longest reach of these points, in windows: between points farther apart arcs look like corners.
const LONGEST: f64 = 2.0;
/// Deviations of a turn beyond which it is no noise: one of 2 million is. Where few distances are free it takes twice as many at
/// [`FEW`], like in Student's distribution.
const SIGNIFICANT: f64 = 5.0;
const FEW: f64 = 6.0;

/// A corner at a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::measured) struct Kink {
    pub at: usize,
    /// Turn of the tangent \[rad\], positive counter-clockwise.
    pub angle: f64,
}

/// The turn of the path between two neighbours.
#[derive(Debug, Clone, Copy)]
struct KinkTurn {
    /// The one of the two that lies better on both sides' parabolas, and the turn there.
    kink: Kink,
    /// Mean square of the distances of the points from their parabolas \[mm²\], and how many of these are free.
    noise: f64,
    free: f64,
    /// Deviation of the turn under noise of 1 mm \[1/mm\].
    spread: f64,
}

/// Finds points with a corner sharper than `least` \[rad\]. `size` is 1 for a full-sized profile, less for a model.
///
/// Method: on both sides of each gap between neighbours a parabola is fitted to the points over a window of path. A turn between them
/// is a corner if it exceeds `least` and is significant against the distances of the points from their parabolas, there and in the
/// median of the file. Bad points, roughness, steps and small radii are no parabolas: a corner is isolated. An arc of radius r biases
/// each tangent by (window/r)²/10. Of several corners within a window only the sharpest counts.
pub(in crate::measured) fn kinks(points: &[Point], least: f64, size: f64) -> Vec<Kink> {
    let window = WINDOW * size;
    let mut path = vec![0.0];
    for (k, pair) in points.windows(2).enumerate() {
        path.push(path[k] + distance(&pair[0], &pair[1]));
    }
    let gaps = LEAST_AT_END - 1..points.len().saturating_sub(LEAST_AT_END);
    let turns: Vec<KinkTurn> = gaps.map(|gap| turn(points, &path, gap, window)).collect();
    let mut noises: Vec<f64> = turns.iter().map(|turn| turn.noise).collect();
    noises.sort_by(f64::total_cmp);
    let usual = noises.get(noises.len() / 2).copied().unwrap_or(0.0);
    let mut out: Vec<Kink> = Vec::new();
    for KinkTurn { kink, noise, free, spread } in turns {
        // The noise of few points may be small by chance, beside bad points too.
        let own = noise * (1.0 + (FEW / free).powi(2)).powi(2);
        let by_noise = SIGNIFICANT * spread * own.max(usual).sqrt();
        if kink.angle.abs() <= least.max(by_noise) {
            continue;
        }
        match out.last_mut() {
            Some(last) if path[kink.at] - path[last.at] < window => {
                if kink.angle.abs() > last.angle.abs() {
                    *last = kink;
                }
            }
            _ => out.push(kink),
        }
    }
    out
}

/// Fits the parabolas on both sides of the gap behind a point. `path` holds the arc length at each point.
fn turn(points: &[Point], path: &[f64], gap: usize, window: f64) -> KinkTurn {
    let [before, after] =
        [OneSide::new(points, path, gap, false, window), OneSide::new(points, path, gap + 1, true, window)];
    let step = path[gap + 1] - path[gap];
    let [u, w] = [&before, &after].map(|side| side.of.map(|parabola| parabola.slope(-0.5 * step)));
    // The path before the gap runs against its parabola.
    let angle = (w[0] * u[1] - w[1] * u[0]).atan2(-(u[0] * w[0] + u[1] * w[1]));
    let off = |side: &OneSide, point: &Point| {
        let [x, z] = side.of.map(|parabola| parabola.value(-step));
        (point.x - x).hypot(point.z - z)
    };
    let at = if off(&after, &points[gap]) < off(&before, &points[gap + 1]) { gap } else { gap + 1 };
    let free = (before.free + after.free).max(1.0);
    let noise = (before.squares + after.squares) / free;
    KinkTurn { kink: Kink { at, angle }, noise, free, spread: before.spread.hypot(after.spread) }
}

/// The points on one side of a gap.
struct OneSide {
    /// Parabolas of x and z over the distance from the gap's end on this side.
    of: [Parabola; 2],
    /// Sum of the squares of the points' distances from them \[mm²\], and how many of the distances are free.
    squares: f64,
    free: f64,
    /// Deviation of the slope at the end under noise of 1 mm \[1/mm\].
    spread: f64,
}

impl OneSide {
    /// Fits parabolas to the points from `end` on, forwards or backwards.
    fn new(points: &[Point], path: &[f64], end: usize, forward: bool, window: f64) -> Self {
        let far = if forward {
            let within = path.partition_point(|&s| s <= path[end] + window) - 1;
            within.max((end + LEAST_IN_WINDOW - 1).min(points.len() - 1))
        } else {
            let within = path.partition_point(|&s| s < path[end] - window);
            within.min((end + 1).saturating_sub(LEAST_IN_WINDOW))
        };
        let stride = far.abs_diff(end).div_ceil(MOST_IN_WINDOW).max(1);
        let picked: Vec<usize> = if forward {
            (end..=far).step_by(stride).collect()
        } else {
            (far..=end).rev().step_by(stride).collect()
        };
        let (mut squares, count) = (0.0, picked.len() as f64);
        let of = [|p: &Point| p.x, |p: &Point| p.z].map(|of| {
            let samples = || picked.iter().map(|&j| ((path[j] - path[end]).abs(), of(&points[j])));
            let parabola = Parabola::fit(samples());
            squares += samples().map(|(s, value)| (value - parabola.value(s)).powi(2)).sum::<f64>();
            parabola
        });
        let length = (path[far] - path[end]).abs();
        Self {
            of,
            squares,
            free: count - LEAST_AT_END as f64,
            spread: if length > LONGEST * window { f64::MAX } else { END_SLOPE / (length * count.sqrt()) },
        }
    }
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
            let found = kinks(&edge, 0.5, 1.0);
            assert_eq!(found.len(), 1, "{spacing}: {found:?}");
            assert!((found[0].angle - 40f64.to_radians()).abs() < 1e-9, "{found:?}");
            assert!((edge[found[0].at].x - 20.0).abs() < 1e-9);
            // A line continues into a radius of 6 mm, as at the edge of a flange tip.
            let fillet = path(spacing, |s| {
                let angle = (s - 20.0).max(0.0) / 6.0;
                [s.min(20.0) + 6.0 * angle.sin(), 6.0 * (1.0 - angle.cos())]
            });
            assert!(kinks(&fillet, 0.5, 1.0).is_empty(), "{spacing}");
        }
    }
}

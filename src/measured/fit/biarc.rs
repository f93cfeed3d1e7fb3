//! Fits smooth chains of arcs and lines to points within a tolerance.
//!
//! A pair of arcs with equal tangent lengths joins two stations [Bolton1975]. A chain of such pairs is built from left to
//! right. Doubling and bisection find how long each pair can be while all its points stay within the tolerance.

use crate::error::{Error, Result};
use crate::measured::read::points::Point;
use crate::profile::{Arc, Station};

/// Largest distance of an arc's end from its first tangent, in roundings of the coordinates, up to which the arc is a line.
const STRAIGHT_ROUNDINGS: f64 = 8.0;

/// A chain of pairs of arcs.
#[derive(Debug, Clone, Default)]
pub(in crate::measured) struct Chain {
    pub arcs: Vec<Arc>,
    /// Distance of each point from the chain \[mm\].
    pub residuals: Vec<f64>,
}

/// Fits pairs of arcs from the first to the last of `stations`. Point k belongs to station k; all points are within
/// `tolerance` \[mm\] of their pair.
///
/// # Errors
/// Two neighbouring points that no pair of arcs joins within the tolerance, with their place.
pub(in crate::measured) fn chain(stations: &[Station], points: &[Point], tolerance: f64) -> Result<Chain> {
    let mut chain = Chain::default();
    let mut from = 0;
    let last = stations.len() - 1;
    while from < last {
        let fits = |to: usize| {
            pair(&stations[from], &stations[to])
                .filter(|pair| points[from..=to].iter().all(|p| distance(pair, p) <= tolerance))
        };
        let Some(mut best) = fits(from + 1) else {
            let found = format!("no pair of arcs within {tolerance} mm to {}", points[from + 1].place());
            let advice = "allow a larger `arc_tolerance`, or use curve = \"smoothing\"";
            return Err(Error::new(points[from].place(), found, "points that arcs can follow", advice));
        };
        let (mut good, mut bad) = (from + 1, last + 1);
        while good + 1 < bad {
            let doubled = from + 2 * (good - from);
            let to = if bad <= last { good + (bad - good) / 2 } else { doubled.min(last) };
            match fits(to) {
                Some(pair) => (best, good) = (pair, to),
                None => bad = to,
            }
        }
        let joint = usize::from(from > 0);
        chain.residuals.extend(points[from + joint..=good].iter().map(|p| distance(&best, p)));
        chain.arcs.extend(best);
        from = good;
    }
    Ok(chain)
}

/// Returns the two arcs from station to station with equal tangent lengths. Returns `None` if one of them would turn by a
/// right angle or more.
fn pair(a: &Station, b: &Station) -> Option<[Arc; 2]> {
    let [vx, vz] = [b.x - a.x, b.z - a.z];
    let along = vx * (a.cos + b.cos) + vz * (a.sin + b.sin);
    let apart = (b.cos - a.cos).powi(2) + (b.sin - a.sin).powi(2);
    let square = vx * vx + vz * vz;
    // This is the root of apart·d² + 2·along·d = square, in the form that does not cancel.
    let d = square / (along + (along * along + apart * square).sqrt());
    if !(along > 0.0 && d > 0.0) {
        return None;
    }
    let [q, r] = [[a.x + d * a.cos, a.z + d * a.sin], [b.x - d * b.cos, b.z - d * b.sin]];
    let [tx, tz] = [r[0] - q[0], r[1] - q[1]];
    let norm = tx.hypot(tz);
    let middle = Station { x: q[0] + 0.5 * tx, z: q[1] + 0.5 * tz, cos: tx / norm, sin: tz / norm };
    let forward = |s: &Station| s.cos * middle.cos + s.sin * middle.sin > 0.0;
    (forward(a) && forward(b)).then(|| [arc(*a, middle), arc(middle, *b)])
}

/// Returns the arc between these two stations. Both must lie on one arc or line.
fn arc(start: Station, end: Station) -> Arc {
    let [cx, cz] = [end.x - start.x, end.z - start.z];
    let cross = start.cos * cz - start.sin * cx;
    let scale = [start.x, start.z, end.x, end.z].iter().fold(0.0, |sum: f64, v| sum.max(v.abs()));
    if cross.abs() <= STRAIGHT_ROUNDINGS * f64::EPSILON * scale {
        let length = cx.hypot(cz);
        let (cos, sin) = (cx / length, cz / length);
        return Arc {
            start: Station { cos, sin, ..start },
            end: Station { cos, sin, ..end },
            radius: f64::INFINITY,
        };
    }
    Arc { start, end, radius: (cx * cx + cz * cz) / (2.0 * cross) }
}

/// Returns the distance \[mm\] of a point from a pair of arcs. Its side of their joint decides which arc counts.
fn distance(pair: &[Arc; 2], point: &Point) -> f64 {
    let joint = &pair[0].end;
    let beyond = (point.x - joint.x) * joint.cos + (point.z - joint.z) * joint.sin > 0.0;
    distance_from(&pair[usize::from(beyond)], point)
}

/// Returns the distance \[mm\] of a point from the circle or line of an arc. Nothing cancels for any radius.
fn distance_from(arc: &Arc, point: &Point) -> f64 {
    let at = Station { x: point.x, z: point.z, ..Station::AXES }.seen_from(&arc.start);
    let curvature = arc.curvature();
    let to_centre = (curvature * at.x).hypot(1.0 - curvature * at.z);
    (curvature * (at.x * at.x + at.z * at.z) - 2.0 * at.z).abs() / (1.0 + to_centre)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn station(x: f64, z: f64, angle: f64) -> Station {
        Station { x, z, cos: angle.cos(), sin: angle.sin() }
    }

    #[test]
    fn a_pair_joins_smoothly_and_ends_where_it_should() {
        for (angle_a, angle_b) in [(0.3, -0.8), (0.5, 0.5), (-0.2, 0.2), (0.0, 0.0), (0.4, 0.1)] {
            let (a, b) = (station(1.0, 2.0, angle_a), station(9.0, 3.5, angle_b));
            let Some([first, second]) = pair(&a, &b) else { unreachable!("{angle_a} {angle_b}") };
            for arc in [first, second] {
                // The end lies on the circle, and its tangent is that of the circle.
                let end = arc.end.seen_from(&arc.start);
                let point = Point { x: arc.end.x, z: arc.end.z, weight: 1.0, number: 1, line: 1 };
                assert!(distance_from(&arc, &point) < 1e-14, "{arc:?}");
                assert!((end.sin - end.x * arc.curvature()).abs() < 1e-14, "{arc:?}");
            }
            assert_eq!(first.end, second.start);
        }
    }

    #[test]
    fn one_arc_comes_back_as_one_radius() {
        let at = |angle: f64| station(50.0 * angle.sin(), -50.0 * (1.0 - angle.cos()), -angle);
        let Some(pair) = pair(&at(-0.3), &at(0.5)) else { unreachable!() };
        assert!(pair.iter().all(|arc| (arc.radius + 50.0).abs() < 1e-11), "{pair:?}");
    }
}

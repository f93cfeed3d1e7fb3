//! The vertices at which a path runs back, and points in no order.

use super::course::{Course, turn};
use crate::error::Error;
use crate::measured::read::points::Point;

/// Turn \[rad\] at a vertex beyond which the path runs back, 120°: sharp edges of profiles turn by less than 100°, points in the wrong
/// order by about 180°.
pub(super) const BACKWARDS: f64 = 2.0 / 3.0 * std::f64::consts::PI;
/// Least angle \[rad\] between the sides of a notch or of a thin blade, 4°. Narrower ones are a path that runs back over itself.
const NARROWEST: f64 = 0.07;
/// Fewest vertices on each side of a notch: fewer are points that were added at an end.
const SIDE: usize = 2;
/// Least share of the points at which the path of points in no order turns back; a shuffled path does at every second one.
const NO_ORDER: f64 = 0.1;

/// Tells whether the path runs back over one edge only, from vertex k: it turns by more than 120° at both of its ends, to opposite sides.
fn is_zigzag(at: &[Point], k: usize) -> bool {
    let Some([a, b, c, d]) = k.checked_sub(1).and_then(|from| at.get(from..from + 4)) else {
        return false;
    };
    let [first, second] = [turn(a, b, c), turn(b, c, d)];
    first.abs().min(second.abs()) > BACKWARDS && first * second < 0.0
}

/// Returns the vertices where the path runs back: those at which it turns by more than 120°, without the edges of a notch between blade and
/// stock rail. At these the path goes on along x on both sides, is no zigzag, and does not end within a vertex.
pub(super) fn reversals(at: &[Point]) -> Vec<usize> {
    let (Some(first), Some(last)) = (at.first(), at.last()) else { return Vec::new() };
    let way = (last.x - first.x).signum();
    let back = |k: &usize| {
        let [a, b, c] = [&at[*k - 1], &at[*k], &at[*k + 1]];
        let turned = turn(a, b, c).abs();
        let onwards =
            way * (b.x - a.x) > 0.0 && way * (c.x - b.x) > 0.0 && turned < std::f64::consts::PI - NARROWEST;
        let notch =
            onwards && *k >= SIDE && *k + SIDE < at.len() && ![*k - 1, *k].iter().any(|&k| is_zigzag(at, k));
        turned > BACKWARDS && !notch
    };
    (1..at.len().saturating_sub(1)).filter(back).collect()
}

/// Returns whether the smoothed path turns back all along.
pub(super) fn is_disordered(course: &Course) -> bool {
    reversals(&course.at).len() as f64 >= NO_ORDER * course.at.len() as f64
}

/// Returns the error of points in no order at all, whose shape says nothing.
pub(in crate::measured) fn no_order(points: &[Point]) -> Option<Error> {
    if !is_disordered(&Course::new(points)) {
        return None;
    }
    let back = reversals(points);
    let first = points.get(*back.first()?)?;
    let (count, n) = (back.len(), points.len());
    (count > 2).then(|| {
        let found = format!("points in no order: the path turns back at {count} of {n} points");
        let expected = "points in order along the profile, from one end to the other";
        Error::new(first.place(), found, expected, "sort the rows of the file")
    })
}

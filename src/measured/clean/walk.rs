//! Places along the smoothed path of measured points, next to other points.

use super::checks::distance;
use crate::measured::read::points::Point;

/// The smoothed path that leads to a fold, of two vertices or more, with a place on it that is walked from point to point.
pub(super) struct PathWalk<'a> {
    pub(super) at: &'a [Point],
    /// Length of the path up to each vertex \[mm\].
    pub(super) length: &'a [f64],
    /// Vertex of the place.
    pub(super) near: usize,
}

impl PathWalk<'_> {
    /// Number of vertices ahead of the place that are looked at: noise may make the next one no nearer.
    const AHEAD: usize = 8;

    /// Returns the length up to the last vertex \[mm\].
    pub(super) fn end(&self) -> f64 {
        self.length[self.length.len() - 1]
    }

    /// Walks to the place nearest to a point, and returns its length along the path and how far the point lies to the right of it \[mm\];
    /// beyond the end along the last chord.
    pub(super) fn walk_to(&mut self, point: &Point) -> [f64; 2] {
        let far = |k: usize| distance(&self.at[k], point);
        loop {
            let range =
                self.near.saturating_sub(Self::AHEAD)..(self.near + Self::AHEAD + 1).min(self.at.len());
            let nearest = range.min_by(|&a, &b| far(a).total_cmp(&far(b))).unwrap_or(self.near);
            if nearest == self.near {
                break;
            }
            self.near = nearest;
        }
        let a = self.near.min(self.at.len() - 2);
        let [along, across] = from_chord([&self.at[a], &self.at[a + 1]], point);
        [self.length[a] + along, across]
    }
}

/// Returns the length of a path up to each vertex \[mm\].
pub(super) fn lengths(at: &[Point]) -> Vec<f64> {
    let steps = at.windows(2).map(|pair| distance(&pair[0], &pair[1]));
    let sum = |sum: &mut f64, step: f64| {
        *sum += step;
        Some(*sum)
    };
    std::iter::once(0.0).chain(steps.scan(0.0, sum)).collect()
}

/// Returns how far a point lies along a chord from its first end, and to the right of it \[mm\]; zeros of a chord without length.
pub(super) fn from_chord([p, q]: [&Point; 2], point: &Point) -> [f64; 2] {
    let (u, w, length) = (q.x - p.x, q.z - p.z, distance(p, q));
    let [x, z] = [point.x - p.x, point.z - p.z];
    if length > 0.0 { [(x * u + z * w) / length, (x * w - z * u) / length] } else { [0.0; 2] }
}

//! The smoothed path of measured points, along which their order is judged.

use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::RangeInclusive;

use super::checks::{distance, same};
use crate::measured::read::points::Point;

/// Least turn \[rad\] at each of two neighbours that makes them rough, if they turn opposite ways: 15°. Noise of a seventh of the
/// spacing turns by 20°, and already puts one point in 10⁶ behind the one before it. An arc turns one way.
const ROUGH: f64 = PI / 12.0;
/// Number of pairs of neighbours on each side among which rough ones are counted.
const REACH: usize = 16;
/// Number of rough pairs of 2·[`REACH`] + 1 that are noise: a fifth. A point in the wrong order, or a run off the curve, makes two.
const NOISE: usize = 7;
/// Number of rough pairs that are left where noise was smoothed.
const LEFT: usize = 3;
/// Length \[mm\] of a step back that is noise: two points are as far apart where noise has a deviation of 50 µm.
const STEP_BACK: f64 = 0.15;
/// Largest distance \[mm\] of neighbours that stand for one place: noise of 50 µm is gone before that, and jumps stay jumps.
const LONGEST: f64 = 1.0;

/// The smoothed path: each vertex stands for a point, or for neighbouring points where the path is rough, by the median of their
/// coordinates.
#[derive(Debug, Clone)]
pub(in crate::measured) struct Course {
    /// The vertices; their numbers and lines are those of a point that they stand for.
    pub at: Vec<Point>,
    /// Index of the first point of each vertex.
    from: Vec<usize>,
    /// Whether the vertex stands for several points.
    pub merged: Vec<bool>,
    count: usize,
}

impl Course {
    /// Smooths the path where it is rough, and only there: neighbours are put together until it is not. Cost: n log² n.
    pub fn new(points: &[Point]) -> Self {
        let mut course = Self::unsmoothed(points);
        while course.merge(points) {}
        course
    }

    /// Returns the path as it is; coinciding points are one vertex.
    pub fn unsmoothed(points: &[Point]) -> Self {
        let from: Vec<usize> =
            (0..points.len()).filter(|&k| k == 0 || !same(&points[k - 1], &points[k])).collect();
        let at: Vec<Point> = from.iter().map(|&k| points[k]).collect();
        Self { merged: vec![false; at.len()], at, from, count: points.len() }
    }

    /// Returns the range of the points of a vertex.
    pub fn points_of(&self, vertex: usize) -> std::ops::Range<usize> {
        self.from[vertex]..self.from.get(vertex + 1).copied().unwrap_or(self.count)
    }

    /// Puts pairs of neighbours together where the path is rough. Returns whether there were any.
    fn merge(&mut self, points: &[Point]) -> bool {
        let pairs = rough_pairs(&self.at);
        let smoothed = |k: usize| self.merged[k + 1] && self.merged[k + 2];
        let noise = RoughTally::of(pairs.iter().copied());
        let left = RoughTally::of(pairs.iter().enumerate().map(|(k, &rough)| rough && smoothed(k)));
        let is_noisy = |k: usize| if self.merged[k] { left.near(k) >= LEFT } else { noise.near(k) >= NOISE };
        let mut noisy: Vec<bool> = (0..self.at.len()).map(is_noisy).collect();
        steps_back(&self.at).for_each(|range| noisy[range].fill(true));
        let (old, mut k) = (self.clone(), 0);
        (self.at, self.from, self.merged) = (Vec::new(), Vec::new(), Vec::new());
        while k < old.at.len() {
            let next = k + 1 < old.at.len() && (noisy[k + 1] || noisy[k] && old.merged[k + 1]);
            let two = next && (noisy[k] || old.merged[k]) && distance(&old.at[k], &old.at[k + 1]) < LONGEST;
            self.from.push(old.from[k]);
            self.merged.push(two || old.merged[k]);
            self.at.push(if two {
                middle(&points[old.from[k]..old.points_of(k + 1).end])
            } else {
                old.at[k]
            });
            k += 1 + usize::from(two);
        }
        self.at.len() < old.at.len()
    }
}

/// The number of rough pairs up to each one.
struct RoughTally(Vec<usize>);

impl RoughTally {
    fn of(rough: impl Iterator<Item = bool>) -> Self {
        let mut sum = vec![0];
        rough.for_each(|rough| sum.push(sum[sum.len() - 1] + usize::from(rough)));
        Self(sum)
    }

    /// Returns the number of rough pairs near a vertex.
    fn near(&self, vertex: usize) -> usize {
        const NEAR: usize = 2 * REACH + 1;
        let last = self.0.len() - 1;
        let from = vertex.saturating_sub(REACH + 1).min(last.saturating_sub(NEAR));
        self.0[(from + NEAR).min(last)] - self.0[from]
    }
}

/// Returns for each pair of inner neighbours whether they turn opposite ways by [`ROUGH`] or more, or both by more than a right angle.
/// Pair k is of the points k + 1 and k + 2.
fn rough_pairs(at: &[Point]) -> Vec<bool> {
    let turns: Vec<f64> = at.windows(3).map(|three| turn(&three[0], &three[1], &three[2])).collect();
    let rough = |a: f64, b: f64| {
        let least = a.abs().min(b.abs());
        least >= ROUGH && a * b < 0.0 || least > FRAC_PI_2
    };
    turns.windows(2).map(|two| rough(two[0], two[1])).collect()
}

/// Returns the ranges of vertices over which the path steps back by less than [`STEP_BACK`], or within that distance of an end.
fn steps_back(at: &[Point]) -> impl Iterator<Item = RangeInclusive<usize>> {
    let last = at.len().saturating_sub(1);
    let turns = at.windows(3).enumerate().filter(|(_, p)| turn(&p[0], &p[1], &p[2]).abs() > FRAC_PI_2);
    let back: Vec<usize> = [0].into_iter().chain(turns.map(|(k, _)| k + 1)).chain([last]).collect();
    let short = |range: &RangeInclusive<usize>| {
        let length: f64 = at[range.clone()].windows(2).map(|pair| distance(&pair[0], &pair[1])).sum();
        back.len() > 2 && length < STEP_BACK
    };
    back.windows(2).map(|pair| pair[0]..=pair[1]).filter(short).collect::<Vec<_>>().into_iter()
}

/// Returns the turn \[rad\] of the path a → b → c at b, positive counter-clockwise.
pub(in crate::measured) fn turn(a: &Point, b: &Point, c: &Point) -> f64 {
    let [u, w] = [[b.x - a.x, b.z - a.z], [c.x - b.x, c.z - b.z]];
    (u[0] * w[1] - u[1] * w[0]).atan2(u[0] * w[0] + u[1] * w[1])
}

/// Returns the point with the median of both coordinates.
fn middle(points: &[Point]) -> Point {
    let of = |coordinate: fn(&Point) -> f64| {
        let mut values: Vec<f64> = points.iter().map(coordinate).collect();
        let half = values.len() / 2;
        let (below, upper, _) = values.select_nth_unstable_by(half, f64::total_cmp);
        let lower = below.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if points.len().is_multiple_of(2) { 0.5 * (lower + *upper) } else { *upper }
    };
    Point { x: of(|p| p.x), z: of(|p| p.z), ..points[points.len() / 2] }
}

//! Names the segments of a curve that bridge what was not measured.

use super::checks::{Check, Finding, distance};
use super::runs::{BadRun, Path};
use crate::measured::read::points::Point;
use crate::profile::Segment;

/// Shares of a bridge's chord at which the segments over it are sought: a chain of arcs has several there.
const PLACES: [f64; 5] = [0.1, 0.3, 0.5, 0.7, 0.9];
/// Number of segments beyond the nearest one so far over which the search goes on: they are as short as the points' distances, so
/// that a bend may hide the next minimum, but not for so long.
const LOOKED_ON: usize = 1000;

/// Names the segments over the gaps that were found between points, and those from points off the curve to their neighbours. Points
/// and segments are from left to right.
pub(in crate::measured) fn name(segments: &mut [Segment], points: &[Point], findings: &[Finding]) {
    let gaps: Vec<&Finding> = findings.iter().filter(|found| found.check == Check::Gap).collect();
    let of_gap = |k: usize| {
        let place = if gaps.is_empty() { String::new() } else { points[k].place() };
        gaps.iter().find(|gap| gap.place == place).map(|gap| (k, format!("after {}", gap.place)))
    };
    let of_run = |run: &BadRun| {
        let rows = run.rows(points);
        (run.from.saturating_sub(1)..=run.to).map(move |k| (k, rows.clone()))
    };
    let mut all: Vec<(usize, String)> = (0..points.len()).filter_map(of_gap).collect();
    all.extend(Path::of(points).runs.iter().flat_map(of_run));
    all.sort_by_key(|(k, _)| *k);
    let mut from = 0;
    for (pair, rows) in all.iter().filter_map(|(k, rows)| Some((points.get(*k..k + 2)?, rows))) {
        let between = |share: f64, a: f64, b: f64| a + share * (b - a);
        let length = distance(&pair[0], &pair[1]);
        for share in PLACES {
            let at = [between(share, pair[0].x, pair[1].x), between(share, pair[0].z, pair[1].z)];
            if let Some(k) = nearest(segments, from, at, length) {
                segments[k].name_gap(rows);
                from = k;
            }
        }
    }
}

/// Returns the index of the segment from `from` on whose chord is nearest to a point, if it is nearer than `within` \[mm\].
fn nearest(segments: &[Segment], from: usize, [x, z]: [f64; 2], within: f64) -> Option<usize> {
    let off = |segment: &Segment| {
        let (a, b) = (segment.start(), segment.end());
        let (dx, dz) = (b.x - a.x, b.z - a.z);
        let share = ((x - a.x) * dx + (z - a.z) * dz) / (dx * dx + dz * dz);
        let share = if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 };
        (a.x + share * dx - x).hypot(a.z + share * dz - z)
    };
    let mut best = None;
    let mut least = within;
    for (k, segment) in segments.iter().enumerate().skip(from) {
        let own = off(segment);
        if own < least {
            (best, least) = (Some(k), own);
        } else if best.is_some_and(|best| k - best > LOOKED_ON) {
            break;
        }
    }
    best
}

//! Makes the repairs that the options allow, and lists the places that they touched.

use serde::Serialize;

use super::checks::{distance, same};
use super::loops;
use super::order::{Fold, are_scans, folds};
use super::runs::Path;
use super::walk::{PathWalk, lengths};
use crate::measured::options::Repair;
use crate::measured::read::points::Point;

/// Largest loop that `cut-loops` cuts, and largest overhang at an end that `remove-spikes` does, as a share of the whole path. A larger loop is no slip of the probe, and
/// which of its parts is the profile cannot be told.
const LARGEST_LOOP: f64 = 0.1;
/// Most places that the record lists; the count is always complete.
const LISTED: usize = 20;
/// Most rounds of one repair. Each round removes faults that the previous round uncovered.
const ROUNDS: usize = 10;

/// A repair that was made.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Repaired {
    /// The kind of repair.
    pub repair: Repair,
    /// Number of points that it dropped or moved in the order.
    pub points: usize,
    /// Places of the first of these points in the file, at most 20.
    pub places: Vec<String>,
}

/// Makes the allowed repairs, duplicates first and loops last; scans of neighbouring parts are sorted in any case. Returns those that
/// touched a point.
pub fn repair(points: &mut Vec<Point>, allowed: &[Repair]) -> Vec<Repaired> {
    let order = [Repair::DropDuplicates, Repair::Sort, Repair::RemoveSpikes, Repair::CutLoops];
    let mut done = Vec::new();
    for repair in order {
        let scans = repair == Repair::Sort && are_scans(points);
        let wanted = allowed.contains(&repair) || scans;
        if !wanted {
            continue;
        }
        let mut touched: Vec<Point> = Vec::new();
        for _ in 0..ROUNDS {
            let now = match repair {
                Repair::DropDuplicates => drop_duplicates(points),
                Repair::Sort => sort(points, scans),
                Repair::RemoveSpikes => [remove_spikes(points), cut_overhang(points)].concat(),
                Repair::CutLoops => cut_loops(points),
            };
            if now.is_empty() {
                break;
            }
            touched.extend(now);
        }
        if !touched.is_empty() {
            let places = touched.iter().take(LISTED).map(Point::place).collect();
            done.push(Repaired { repair, points: touched.len(), places });
        }
    }
    done
}

fn drop_duplicates(points: &mut Vec<Point>) -> Vec<Point> {
    let mut dropped = Vec::new();
    points.dedup_by(|b, a| {
        let drop = same(a, b);
        if drop {
            dropped.push(*b);
        }
        drop
    });
    dropped
}

/// Sorts the points where the path runs back over itself, and where it does so beside itself only if they are `scans`.
fn sort(points: &mut [Point], scans: bool) -> Vec<Point> {
    let path = Path::of(points);
    let vertices = &path.course.at;
    let length = lengths(vertices);
    let first_points: Vec<usize> =
        (0..vertices.len()).map(|v| path.on[path.course.points_of(v).start]).collect();
    let mut moved = Vec::new();
    let mut sorted_to = 0;
    for fold in
        folds(&path).into_iter().filter(|fold| fold.to > fold.from && (scans || fold.beside.is_none()))
    {
        // The path that leads to the fold, from where it was not sorted yet.
        let range = first_points.partition_point(|&k| k < sorted_to)
            ..first_points.partition_point(|&k| k <= fold.from);
        if fold.from >= sorted_to && range.len() > 1 {
            let track = PathWalk {
                at: &vertices[range.clone()],
                length: &length[range.clone()],
                near: range.len() - 1,
            };
            sorted_to = sort_fold(points, fold, sorted_to, track, &mut moved);
        }
    }
    moved
}

/// Sorts the points of one fold, and those from `sorted_to` on over which it runs back, along the path that leads to the fold. Returns
/// the index after the last sorted point.
fn sort_fold(
    points: &mut [Point],
    fold: Fold,
    sorted_to: usize,
    mut track: PathWalk<'_>,
    moved: &mut Vec<Point>,
) -> usize {
    let mut along: Vec<f64> = Vec::new();
    for (k, point) in points.iter().enumerate().skip(fold.from + 1) {
        let [at, _] = track.walk_to(point);
        if k > fold.to && at >= track.end() {
            break;
        }
        along.push(at);
    }
    let high = fold.from + along.len();
    let least = along.iter().copied().fold(f64::INFINITY, f64::min);
    let mut low = fold.from + 1;
    let mut before: Vec<f64> = Vec::new();
    while low > sorted_to {
        let [at, _] = track.walk_to(&points[low - 1]);
        if at < least {
            break;
        }
        before.push(at);
        low -= 1;
    }
    before.reverse();
    let mut order: Vec<(f64, Point)> =
        before.into_iter().chain(along).zip(points[low..=high].iter().copied()).collect();
    order.sort_by(|p, q| p.0.total_cmp(&q.0));
    for (slot, (_, point)) in points[low..=high].iter_mut().zip(order) {
        if slot.number != point.number {
            moved.push(point);
        }
        *slot = point;
    }
    high + 1
}

fn remove_spikes(points: &mut Vec<Point>) -> Vec<Point> {
    let mut off = vec![true; points.len()];
    Path::of(points).on.into_iter().for_each(|k| off[k] = false);
    drop_all(points, |k| off[k])
}

/// Drops what lies beyond the only place where the path turns back, if it is short.
fn cut_overhang(points: &mut Vec<Point>) -> Vec<Point> {
    let [fold] = folds(&Path::of(points))[..] else { return Vec::new() };
    let (at, last) = (fold.from, points.len() - 1);
    let length = |range: std::ops::RangeInclusive<usize>| -> f64 {
        points[range].windows(2).map(|pair| distance(&pair[0], &pair[1])).sum()
    };
    let beyond = if at < last - at { 0..=at } else { at..=last };
    let short = length(beyond.clone()) <= LARGEST_LOOP * length(0..=last);
    drop_all(points, |k| fold.from == fold.to && short && k != at && beyond.contains(&k))
}

fn cut_loops(points: &mut Vec<Point>) -> Vec<Point> {
    let length = |from: usize, to: usize| -> f64 {
        points[from..=to].windows(2).map(|pair| distance(&pair[0], &pair[1])).sum()
    };
    let whole = length(0, points.len().saturating_sub(1));
    let crossings = loops::crossings(points).edges;
    let small = crossings.into_iter().filter(|[i, j]| length(*i + 1, *j) <= LARGEST_LOOP * whole);
    let cuts: Vec<[usize; 2]> = small.collect();
    drop_all(points, |k| cuts.iter().any(|[i, j]| *i < k && k <= *j))
}

fn drop_all(points: &mut Vec<Point>, drop: impl Fn(usize) -> bool) -> Vec<Point> {
    let mut dropped = Vec::new();
    let mut k = 0;
    points.retain(|point| {
        let drop = drop(k);
        k += 1;
        if drop {
            dropped.push(*point);
        }
        !drop
    });
    dropped
}

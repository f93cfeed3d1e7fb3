//! Makes the repairs that the options allow, and lists the places that they touched.

use serde::Serialize;

use super::checks::{Fold, distance, folds, same, spikes};
use super::loops;
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

/// Makes the allowed repairs, duplicates first and loops last. Returns those that touched a point.
pub fn repair(points: &mut Vec<Point>, allowed: &[Repair]) -> Vec<Repaired> {
    let order = [Repair::DropDuplicates, Repair::Sort, Repair::RemoveSpikes, Repair::CutLoops];
    let mut done = Vec::new();
    for repair in order.into_iter().filter(|repair| allowed.contains(repair)) {
        let mut touched: Vec<Point> = Vec::new();
        for _ in 0..ROUNDS {
            let now = match repair {
                Repair::DropDuplicates => drop_duplicates(points),
                Repair::Sort => sort(points),
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

fn sort(points: &mut [Point]) -> Vec<Point> {
    let mut moved = Vec::new();
    let mut sorted_to = 0;
    for fold in folds(points).into_iter().filter(|fold| fold.to > fold.from) {
        if fold.from >= sorted_to {
            sorted_to = sort_fold(points, fold, &mut moved);
        }
    }
    moved
}

/// Sorts the points of one fold, and the points over which it runs back, along the direction of travel across the fold.
/// Returns the index after the last sorted point.
fn sort_fold(points: &mut [Point], fold: Fold, moved: &mut Vec<Point>) -> usize {
    let reach = fold.to - fold.from + 1;
    let (mut low, mut high) = (fold.from.saturating_sub(reach), (fold.to + reach).min(points.len() - 1));
    let (a, b) = (points[low], points[high]);
    let along = |p: &Point| (p.x - a.x) * (b.x - a.x) + (p.z - a.z) * (b.z - a.z);
    let (least, most) = (along(&points[fold.to]), along(&points[fold.from]));
    while low > 0 && along(&points[low]) > least {
        low -= 1;
    }
    while high + 1 < points.len() && along(&points[high]) < most {
        high += 1;
    }
    let before: Vec<usize> = points[low..=high].iter().map(|p| p.number).collect();
    points[low..=high].sort_by(|p, q| along(p).total_cmp(&along(q)));
    let after = &points[low..=high];
    moved.extend(after.iter().zip(before).filter(|(p, number)| p.number != *number).map(|(p, _)| *p));
    high + 1
}

fn remove_spikes(points: &mut Vec<Point>) -> Vec<Point> {
    let at: Vec<usize> = spikes(points).iter().map(|spike| spike.at).collect();
    drop_all(points, |k| at.binary_search(&k).is_ok())
}

/// Drops what lies beyond the only place where the path turns back, if it is short.
fn cut_overhang(points: &mut Vec<Point>) -> Vec<Point> {
    let [fold] = folds(points)[..] else { return Vec::new() };
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

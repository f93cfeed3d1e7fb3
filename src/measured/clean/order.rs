//! Finds where the smoothed path of measured points runs back.

use super::checks::{Check, Finding, distance, median};
use super::course::Course;
use super::reversals::reversals;
use super::runs::Path;
use crate::measured::read::points::Point;

/// Distance \[mm\] between two courses over one place from which they are not one.
const BESIDE: f64 = 0.03;
/// Multiple of the median bend of a course, by noise or by its curvature, that a single vertex may be beside it: five deviations.
const BENDS: f64 = 4.0;
/// Fewest vertices whose bends tell the noise.
const NEAR: usize = 16;
/// Most folds that are compared with the course that they run over, each of which may be the whole path.
const MOST_JUDGED: usize = 1000;

/// The stretch of points `from`..=`to` between two reversals of the path. A single reversal has `from == to`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::measured) struct Fold {
    pub from: usize,
    pub to: usize,
    /// Distance \[mm\] of the points that run back from the course that they run over, if it is more than noise: they are no part of
    /// it, and no order makes them one.
    pub beside: Option<f64>,
}

impl Fold {
    /// Returns the number of points, before the fold, over which the path runs back.
    fn overrun(&self, points: &[Point]) -> usize {
        let [a, b] = [points[self.from], points[self.to]];
        let along = |p: &Point| (p.x - b.x) * (a.x - b.x) + (p.z - b.z) * (a.z - b.z);
        points[..self.from].iter().rev().take_while(|p| along(p) > 0.0).count()
    }

    /// Returns the point from which the path jumps back in one step; `None` if it runs back point by point.
    fn jump(&self, points: &[Point]) -> Option<usize> {
        let steps = || (self.from..self.to).map(|k| (k, distance(&points[k], &points[k + 1])));
        let (k, longest) = steps().max_by(|a, b| a.1.total_cmp(&b.1))?;
        let whole: f64 = steps().map(|(_, length)| length).sum();
        (2.0 * longest > whole).then_some(k)
    }

    /// Names the shorter part of the path on one side of a single reversal, as the file has it.
    fn beyond(&self, points: &[Point]) -> String {
        let (before, after) = (&points[..self.from], &points[self.from + 1..]);
        let part = if after.len() <= before.len() { after } else { before };
        let first = part.iter().min_by_key(|point| point.number).map(Point::place);
        let last = part.iter().max_by_key(|point| point.number).map(Point::place);
        match (first, last) {
            (Some(first), Some(last)) if first != last => {
                format!("what the file has from {first} to {last}: {} points", part.len())
            }
            (first, _) => first.unwrap_or_default(),
        }
    }

    pub(super) fn finding(&self, points: &[Point]) -> Finding {
        let (first, last) = (&points[self.from], &points[self.to]);
        if let Some(beside) = self.beside {
            let place = last.place();
            let found = format!("a path that turns back to {place} and goes on {beside:.3} mm beside itself");
            return Finding::new(Check::Spike, first, found);
        }
        match self.to - self.from {
            0 => {
                let beyond = self.beyond(points);
                let found = format!("a path that turns back and does not return: beyond it lies {beyond}");
                Finding::new(Check::TurnsBack, first, found)
            }
            1 if self.overrun(points) == 0 => {
                Finding::new(Check::OutOfOrder, first, format!("the wrong order with {}", last.place()))
            }
            _ => Finding::new(Check::ZigZag, first, format!("a zig-zag back to {}", last.place())),
        }
    }
}

/// Least share of the points in each of several scans of one profile, a quarter: what is shorter is a slip.
const SCAN: usize = 4;

/// Largest distance \[mm\] between two scans of one profile: what calibrations of scanners leave.
const SCANNERS: f64 = 0.1;

/// Returns whether points are scans of neighbouring parts of one profile, one after the other, as several scanners on one car give them:
/// each part is in order, and overlaps the next one over less than half of either. Nothing about them has to be asked.
pub(super) fn are_scans(points: &[Point]) -> bool {
    let folds = folds(&Path::of(points));
    let jumps: Vec<usize> = folds.iter().filter_map(|fold| fold.jump(points)).collect();
    let starts: Vec<usize> =
        [0].into_iter().chain(jumps.iter().map(|k| k + 1)).chain([points.len()]).collect();
    let lengths: Vec<usize> = starts.windows(2).map(|pair| pair[1].saturating_sub(pair[0])).collect();
    let over = |k: usize| (1..lengths[k].min(lengths[k + 1]).div_ceil(2)).contains(&folds[k].overrun(points));
    !folds.is_empty()
        && jumps.len() == folds.len()
        && folds.iter().all(|fold| fold.beside.is_none_or(|beside| beside <= SCANNERS))
        && lengths.iter().all(|length| length * SCAN >= points.len())
        && (0..folds.len()).all(over)
}

/// Finds where the path runs back. Runs off the curve do not count.
pub(in crate::measured) fn folds(path: &Path) -> Vec<Fold> {
    let back = reversals(&path.course.at);
    let all = paired(&back, path.course.at.len());
    let few = all.len() <= MOST_JUDGED;
    let place = |fold: Fold| {
        let [from, to] = ends(fold, &path.course, &path.sound);
        let beside = if few { beside(fold, &path.course.at) } else { None };
        Fold { from: path.on[from], to: path.on[to], beside }
    };
    all.into_iter().map(place).collect()
}

/// Returns the distance \[mm\] of the vertices after a fold from the course before it, as far as they run over that, if it is more than
/// noise.
fn beside(fold: Fold, at: &[Point]) -> Option<f64> {
    let before = &at[..=fold.from];
    // Foot on the chord from vertex k to the next one: its place along and the distance across, and the length.
    let foot = |k: usize, point: &Point| {
        let [a, b] = [&before[k], &before[k + 1]];
        let (u, w, length) = (b.x - a.x, b.z - a.z, distance(a, b));
        let [x, z] = [point.x - a.x, point.z - a.z];
        [(x * u + z * w) / length, (u * z - w * x) / length, length]
    };
    let mut near = fold.from.checked_sub(1)?;
    let mut off = Vec::new();
    for point in at.iter().skip(fold.from + 1) {
        while near > 0 && foot(near, point)[0] < 0.0 {
            near -= 1;
        }
        while near + 2 < before.len() && foot(near, point)[0] > foot(near, point)[2] {
            near += 1;
        }
        let [along, across, length] = foot(near, point);
        if near == 0 && along < 0.0 || near + 2 == before.len() && along > length {
            break;
        }
        off.push(across);
    }
    // What bends and noise of the course make of a distance.
    let over = before.len().saturating_sub(NEAR.max(off.len()) + 2);
    let bends: Vec<f64> =
        (over..before.len() - 2).map(|k| (foot(k, &before[k + 2])[1] / 2.0).abs()).collect();
    let count = off.len() as f64;
    let least = BESIDE + BENDS * median(bends) / count.sqrt();
    let far = median(off).abs();
    (count > 0.0 && fold.to > fold.from && far > least).then_some(far)
}

/// Returns the points at the two vertices of a fold. Of a vertex that stands for several points it is the one where the path jumps
/// back, or one in the middle if the path does not jump.
fn ends(fold: Fold, course: &Course, points: &[Point]) -> [usize; 2] {
    let [first, last] = [fold.from, fold.to].map(|vertex| course.points_of(vertex));
    let middle = |of: &std::ops::Range<usize>| if of.len() > 2 { of.start + of.len() / 2 } else { of.start };
    if fold.from < fold.to && fold.to <= fold.from + 2 && (course.merged[fold.from] || course.merged[fold.to])
    {
        let length = |k: &usize| distance(&points[*k], &points[*k + 1]);
        let jump = (first.start..last.end - 1).max_by(|a, b| length(a).total_cmp(&length(b)));
        return jump.map_or([first.start, last.start], |k| [k, k + 1]);
    }
    [middle(&first), middle(&last)]
}

/// Pairs the reversals of a path of `n` points, so that the stretches between two of a pair are short: an overhang at an end is
/// one reversal alone, whose stretch is the overhang.
fn paired(back: &[usize], n: usize) -> Vec<Fold> {
    let alone = |k: usize| Fold { from: k, to: k, beside: None };
    let pairs = |of: &[usize]| -> Vec<Fold> {
        of.chunks_exact(2).map(|pair| Fold { from: pair[0], to: pair[1], beside: None }).collect()
    };
    let overhang = |k: usize| k.min(n - 1 - k);
    let stretch = |k: usize| back[k + 1] - back[k];
    let between = |from: usize| (from..back.len() - 1).step_by(2).map(stretch).sum::<usize>();
    match back {
        [] => Vec::new(),
        [only] => vec![alone(*only)],
        [first, inner @ .., last] if back.len().is_multiple_of(2) => {
            if overhang(*first) + between(1) + overhang(*last) < between(0) {
                [vec![alone(*first)], pairs(inner), vec![alone(*last)]].concat()
            } else {
                pairs(back)
            }
        }
        _ => {
            // The reversal that is left alone moves on from pair to pair.
            let mut sum = between(1);
            let mut best = (sum + overhang(back[0]), 0);
            for k in (2..back.len()).step_by(2) {
                sum = sum + stretch(k - 2) - stretch(k - 1);
                best = best.min((sum + overhang(back[k]), k));
            }
            let single = best.1;
            [pairs(&back[..single]), vec![alone(back[single])], pairs(&back[single + 1..])].concat()
        }
    }
}

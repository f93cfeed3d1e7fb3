//! Finds where the smoothed path of measured points runs back.

use super::checks::{Check, Finding, distance, median};
use super::course::Course;
use super::reversals::reversals;
use super::runs::Path;
use super::walk::{PathWalk, from_chord, lengths};
use crate::measured::read::points::Point;

/// Distance \[mm\] between two courses over one place from which they are not one.
const BESIDE: f64 = 0.03;
/// How far a single vertex may lie beside a course, in median bends of the course, which noise and curvature make: five deviations of the
/// noise.
const BENDS: f64 = 4.0;
/// Fewest vertices whose bends tell the noise.
const NEAR: usize = 16;
/// Most folds that are compared with the course over which they run back, which may be the whole path for each.
const MOST_JUDGED: usize = 1000;

/// The stretch of points `from`..=`to` between two reversals of the path. A single reversal has `from == to`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::measured) struct Fold {
    pub from: usize,
    pub to: usize,
    /// How far \[mm\] the points after `from` lie beside the course over which they run back, if that is more than noise: then they are off
    /// the surface, and no order makes them part of it.
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
    let place = |[from, to]: [usize; 2]| {
        let judged = few && from < to;
        let beside = if judged { beside(from, &path.course.at) } else { None };
        let [from, to] = ends([from, to], &path.course, &path.sound).map(|k| path.on[k]);
        Fold { from, to, beside }
    };
    all.into_iter().map(place).collect()
}

/// Returns how far \[mm\] the vertices after a reversal lie beside the course before it, as far as they run over that; `None` where that is
/// no more than noise.
fn beside(reversal: usize, at: &[Point]) -> Option<f64> {
    let before = &at[..=reversal];
    let length = lengths(before);
    let near = reversal.checked_sub(1)?;
    let mut walk = PathWalk { at: before, length: &length, near };
    let after = at[reversal + 1..].iter().map(|point| walk.walk_to(point));
    let over = 0.0..=length[reversal];
    let off: Vec<f64> =
        after.take_while(|[along, _]| over.contains(along)).map(|[_, across]| across).collect();
    // What bends and noise of the course make of a distance.
    let from = near.saturating_sub(NEAR.max(off.len()));
    let bends = before[from..].windows(3).map(|three| from_chord([&three[0], &three[1]], &three[2])[1] / 2.0);
    let least = BESIDE + BENDS * median(bends.map(f64::abs).collect()) / (off.len() as f64).sqrt();
    let count = off.len();
    let far = median(off).abs();
    (count > 0 && far > least).then_some(far)
}

/// Returns the points at the two vertices of a fold. Of a vertex that stands for several points it is the one where the path jumps
/// back, or one in the middle if the path does not jump.
fn ends([from, to]: [usize; 2], course: &Course, points: &[Point]) -> [usize; 2] {
    let [first, last] = [from, to].map(|vertex| course.points_of(vertex));
    let middle = |of: &std::ops::Range<usize>| if of.len() > 2 { of.start + of.len() / 2 } else { of.start };
    if from < to && to <= from + 2 && (course.merged[from] || course.merged[to]) {
        let length = |k: &usize| distance(&points[*k], &points[*k + 1]);
        let jump = (first.start..last.end - 1).max_by(|a, b| length(a).total_cmp(&length(b)));
        return jump.map_or([first.start, last.start], |k| [k, k + 1]);
    }
    [middle(&first), middle(&last)]
}

/// Pairs the reversals of a path of `n` vertices, so that the stretches between two of a pair are short: an overhang at an end is
/// one reversal alone, whose stretch is the overhang.
fn paired(back: &[usize], n: usize) -> Vec<[usize; 2]> {
    let alone = |k: usize| [k, k];
    let pairs =
        |of: &[usize]| -> Vec<[usize; 2]> { of.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect() };
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

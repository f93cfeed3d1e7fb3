//! Checks measured points in profile axes, from left to right. Each finding names its place in the file.

use serde::Serialize;

use super::loops;
use crate::error::{Error, Result};
use crate::measured::options::Repair;
use crate::measured::read::points::Point;
use crate::measured::shape::{gauge_depth, has_flange_back};
use crate::profile::Side;

/// Distance \[mm\] below which two points are one: a nanometre is less than any instrument or file resolves.
pub(in crate::measured) const SAME_POINT: f64 = 1e-6;
/// Cosine of the turn at a point beyond which the path runs back, 120°: sharp edges of profiles turn by less
/// than 100°, points in the wrong order by about 180°.
const BACKWARDS: f64 = -0.5;
/// Least height of a spike, as a multiple of the median of its neighbourhood. Ten is beyond noise (normal noise reaches it
/// once in 10⁹ points) and below what a speck of dirt gives.
const SPIKE_RATIO: f64 = 10.0;
/// Least height of a spike \[mm\]. Smoothing removes smaller roughness.
const SPIKE_HEIGHT: f64 = 0.02;
/// Number of points on each side that make a spike's neighbourhood.
const NEIGHBOURHOOD: usize = 10;
/// Least length of a gap, as a multiple of the median distance of neighbours. A gap is also at least [`GAP`] long.
const GAP_RATIO: f64 = 10.0;
/// Least length of a gap \[mm\]: the length of a contact patch.
const GAP: f64 = 5.0;
/// Least share of the points at which the path of points in no order turns back; a shuffled path does at every second one.
const NO_ORDER: f64 = 0.1;

/// A kind of fault of measured points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Check {
    /// Two points are at one place.
    Duplicate,
    /// A single point is in the wrong place of the order.
    OutOfOrder,
    /// A stretch runs back over the previous one, as in stitched sections.
    ZigZag,
    /// The path turns back and does not return. A point was added or left over at an end.
    TurnsBack,
    /// A single point is off the curve.
    Spike,
    /// The curve crosses itself.
    Loop,
    /// A long stretch has no points.
    Gap,
    /// The gauge face of a rail or the flange back of a wheel was not measured.
    MissingSideFace,
    /// The profile's shape contradicts its orientation, which follows from the definition of the format.
    Orientation,
    /// Smoothing takes away more than noise.
    Smoothing,
    /// The points are too far apart to show the shape between them.
    Sparse,
    /// The noise of the points leaves the curvature too uncertain for pressures.
    Noise,
}

/// A fault that was found.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Finding {
    /// The kind of fault.
    pub check: Check,
    /// Whether the points cannot carry a curve as they are.
    pub fatal: bool,
    /// Place in the file: "point 12 (line 40)".
    pub place: String,
    /// What was found there.
    pub found: String,
}

impl Finding {
    fn new(check: Check, point: &Point, found: impl Into<String>) -> Self {
        let fatal = !matches!(check, Check::Gap | Check::MissingSideFace | Check::Orientation);
        Self { check, fatal, place: point.place(), found: found.into() }
    }

    /// Makes the finding that the shape contradicts the definition of the format. Its place is the file's first point.
    pub(in crate::measured) fn orientation(first: &Point, found: String) -> Self {
        Self::new(Check::Orientation, first, found)
    }

    /// Makes the finding of rows without values behind a point.
    pub(in crate::measured) fn gap(before: &Point, found: String) -> Self {
        Self::new(Check::Gap, before, found)
    }

    /// Returns the repair that may mend the fault; `None` if none does.
    pub(in crate::measured) fn repair(&self) -> Option<Repair> {
        match self.check {
            Check::Duplicate => Some(Repair::DropDuplicates),
            Check::OutOfOrder | Check::ZigZag => Some(Repair::Sort),
            Check::Spike | Check::TurnsBack => Some(Repair::RemoveSpikes),
            Check::Loop => Some(Repair::CutLoops),
            Check::Gap
            | Check::MissingSideFace
            | Check::Orientation
            | Check::Smoothing
            | Check::Sparse
            | Check::Noise => None,
        }
    }

    /// Makes a finding about the curve through the points: it may be off the surface.
    pub(in crate::measured) fn of_curve(check: Check, place: String, found: String) -> Self {
        Self { check, fatal: false, place, found }
    }

    fn expectation(&self) -> (&'static str, &'static str) {
        match self.check {
            Check::Duplicate => ("different points", "delete one, or allow `repair = [\"drop-duplicates\"]`"),
            Check::OutOfOrder | Check::ZigZag => {
                ("points in order along the profile", "put them in order, or allow `repair = [\"sort\"]`")
            }
            Check::Spike => ("points near the curve", "delete it, or allow `repair = [\"remove-spikes\"]`"),
            Check::Loop => ("a curve that does not cross itself", "allow `repair = [\"cut-loops\"]`"),
            Check::TurnsBack => ("a path that ends where the profile does", "delete what lies beyond it"),
            Check::Gap | Check::MissingSideFace => ("a complete profile", "measure it"),
            Check::Orientation => ("an upright right-hand profile", "correct `mirror` or `flip_z`"),
            Check::Smoothing | Check::Sparse | Check::Noise => {
                ("a curve near the surface", "measure closer points of less noise")
            }
        }
    }
}

/// Returns the error of points in no order at all, whose shape says nothing.
pub(in crate::measured) fn no_order(points: &[Point]) -> Option<Error> {
    let back = reversals(points);
    let first = points.get(*back.first()?)?;
    let (count, n) = (back.len(), points.len());
    (count > 2 && count as f64 >= NO_ORDER * n as f64).then(|| {
        let found = format!("points in no order: the path turns back at {count} of {n} points");
        let expected = "points in order along the profile, from one end to the other";
        Error::new(first.place(), found, expected, "sort the rows of the file")
    })
}

/// Finds all faults, in the order of [`Check`].
pub fn findings(points: &[Point], side: Side, gauge_height: f64) -> Vec<Finding> {
    let mut out = Vec::new();
    let found = |k: usize| format!("the same place as {}", points[k - 1].place());
    out.extend(duplicates(points).map(|k| Finding::new(Check::Duplicate, &points[k], found(k))));
    out.extend(folds(points).iter().map(|fold| fold.finding(points)));
    out.extend(spikes(points).iter().map(|spike| {
        let found = format!("a point {:.3} mm off the line of its neighbours", spike.height);
        Finding { fatal: spike.backwards, ..Finding::new(Check::Spike, &points[spike.at], found) }
    }));
    // A path that runs back crosses itself everywhere: beside a fatal finding, crossings are not sought.
    if !out.iter().any(|finding| finding.fatal) {
        out.extend(crossings(points));
    }
    out.extend(gaps(points));
    out.extend(missing_side_face(points, side, gauge_height));
    out
}

fn crossings(points: &[Point]) -> Vec<Finding> {
    let found = loops::crossings(points);
    let crossing = |[a, b]: &[usize; 2]| {
        let found = format!("a loop: the curve crosses itself before {}", points[b + 1].place());
        Finding::new(Check::Loop, &points[*a], found)
    };
    let mut out: Vec<Finding> = found.edges.iter().map(crossing).collect();
    if let (Some(first), true) = (points.first(), found.cut_short) {
        let text = "too tangled a path to be searched for loops to its end: there may be some";
        out.push(Finding { fatal: false, ..Finding::new(Check::Loop, first, text) });
    }
    out
}

/// Rejects points with a fatal finding. The error names the first one and counts the others.
///
/// # Errors
/// At least one finding is fatal.
pub fn reject(findings: &[Finding]) -> Result<()> {
    let mut fatal = findings.iter().filter(|finding| finding.fatal);
    let Some(first) = fatal.next() else {
        return Ok(());
    };
    let (expected, advice) = first.expectation();
    let found = match fatal.filter(|other| other.check == first.check).count() {
        0 => first.found.clone(),
        more => format!("{} (and {more} more)", first.found),
    };
    Err(Error::new(first.place.clone(), found, expected, advice))
}

/// Returns the indices of points that are at the place of the previous point.
pub(in crate::measured) fn duplicates(points: &[Point]) -> impl Iterator<Item = usize> {
    points.windows(2).enumerate().filter(|(_, pair)| same(&pair[0], &pair[1])).map(|(k, _)| k + 1)
}

pub(in crate::measured) fn same(a: &Point, b: &Point) -> bool {
    distance(a, b) <= SAME_POINT
}

pub(in crate::measured) fn distance(a: &Point, b: &Point) -> f64 {
    (b.x - a.x).hypot(b.z - a.z)
}

/// The stretch of points `from`..=`to` between two reversals of the path. A single reversal has `from == to`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::measured) struct Fold {
    pub from: usize,
    pub to: usize,
}

impl Fold {
    /// Returns the number of points, before the fold, over which the path runs back.
    fn overrun(&self, points: &[Point]) -> usize {
        let [a, b] = [points[self.from], points[self.to]];
        let along = |p: &Point| (p.x - b.x) * (a.x - b.x) + (p.z - b.z) * (a.z - b.z);
        points[..self.from].iter().rev().take_while(|p| along(p) > 0.0).count()
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

    fn finding(&self, points: &[Point]) -> Finding {
        let (first, last) = (&points[self.from], &points[self.to]);
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

/// Finds where the path runs back. Reversals at spikes do not count.
pub(in crate::measured) fn folds(points: &[Point]) -> Vec<Fold> {
    let spikes: Vec<usize> = spikes(points).iter().filter(|s| s.backwards).map(|s| s.at).collect();
    let beside = |k: usize| {
        let next = spikes.partition_point(|&s| s + 1 < k);
        spikes.get(next).is_some_and(|&s| s <= k + 1)
    };
    let back: Vec<usize> = reversals(points).into_iter().filter(|&k| !beside(k)).collect();
    paired(&back, points.len())
}

/// Pairs the reversals of a path of `n` points, so that the stretches between two of a pair are short: an overhang at an end is
/// one reversal alone, whose stretch is the overhang.
fn paired(back: &[usize], n: usize) -> Vec<Fold> {
    let alone = |k: usize| Fold { from: k, to: k };
    let pairs = |of: &[usize]| -> Vec<Fold> {
        of.chunks_exact(2).map(|pair| Fold { from: pair[0], to: pair[1] }).collect()
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

/// Returns the points where the path turns by more than 120°. Coinciding points are passed over.
fn reversals(points: &[Point]) -> Vec<usize> {
    let mut out = Vec::new();
    let mut before: Option<[f64; 2]> = None;
    for (k, pair) in points.windows(2).enumerate() {
        let [u, w] = [pair[1].x - pair[0].x, pair[1].z - pair[0].z];
        let length = u.hypot(w);
        if length <= SAME_POINT {
            continue;
        }
        let direction = [u / length, w / length];
        if before.is_some_and(|b| b[0] * direction[0] + b[1] * direction[1] < BACKWARDS) {
            out.push(k);
        }
        before = Some(direction);
    }
    out
}

/// A single point off the curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::measured) struct Spike {
    pub at: usize,
    /// Distance of the point from the line through its two neighbours \[mm\].
    pub height: f64,
    /// Whether the path turns by more than 120° at the point or beside it.
    pub backwards: bool,
}

/// Finds points off the line of their neighbours whose neighbours are off to the other side. A single wrong point has this
/// pattern; an edge does not.
pub(in crate::measured) fn spikes(points: &[Point]) -> Vec<Spike> {
    /// Share of the expected distance by which a neighbour must be off to the other side. Let the point be off by h, and
    /// let o be the point beyond the neighbour. The neighbour is then off by −h·d/l, where d is its distance from o and l
    /// the distance of the point from o. For equal steps and small h that is −h/2. Half of the expected distance is enough.
    const ANSWER: f64 = 0.5;
    let n = points.len();
    let off: Vec<f64> = (0..n).map(|k| if k == 0 || k + 1 >= n { 0.0 } else { offset(points, k) }).collect();
    let backwards = reversals(points);
    let mut out = Vec::new();
    for k in 1..n.saturating_sub(1) {
        let height = off[k].abs();
        let answers = |j: usize, outer: usize| {
            let share = distance(&points[outer], &points[j]) / distance(&points[outer], &points[k]);
            off[j] * off[k].signum() < -ANSWER * share * height
        };
        // The end points of the path have no line of neighbours, so that they need not be off.
        let before = k == 1 || answers(k - 1, k - 2);
        let after = k + 2 == n || answers(k + 1, k + 2);
        if height <= SPIKE_HEIGHT || !before || !after {
            continue;
        }
        let near =
            (k.saturating_sub(NEIGHBOURHOOD)..n.min(k + NEIGHBOURHOOD + 1)).filter(|j| j.abs_diff(k) > 2);
        if height > SPIKE_RATIO * median(near.map(|j| off[j].abs()).collect()) {
            let backwards = (k - 1..=k + 1).any(|j| backwards.binary_search(&j).is_ok());
            out.push(Spike { at: k, height, backwards });
        }
    }
    out
}

/// Returns the signed distance of a point from the line through its neighbours \[mm\].
fn offset(points: &[Point], k: usize) -> f64 {
    let [a, p, b] = [points[k - 1], points[k], points[k + 1]];
    let [u, w] = [b.x - a.x, b.z - a.z];
    let length = u.hypot(w);
    if length > 0.0 { (u * (p.z - a.z) - w * (p.x - a.x)) / length } else { distance(&a, &p) }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::INFINITY)
}

fn gaps(points: &[Point]) -> Vec<Finding> {
    let steps: Vec<f64> = points.windows(2).map(|pair| distance(&pair[0], &pair[1])).collect();
    let least = GAP.max(GAP_RATIO * median(steps.clone()));
    let wide = steps.iter().enumerate().filter(|(_, step)| **step > least);
    wide.map(|(k, step)| {
        let found = format!("no point over {step:.2} mm up to {}", points[k + 1].place());
        Finding::new(Check::Gap, &points[k], found)
    })
    .collect()
}

fn missing_side_face(points: &[Point], side: Side, gauge_height: f64) -> Option<Finding> {
    let first = points.first()?;
    let found = match side {
        Side::Wheel if has_flange_back(points) => return None,
        Side::Wheel => "no back of the flange".to_owned(),
        Side::Rail => {
            let depth = gauge_depth(points);
            if depth >= gauge_height {
                return None;
            }
            format!("a gauge face measured down to {depth:.1} of {gauge_height} mm below the top")
        }
    };
    Some(Finding::new(Check::MissingSideFace, first, found))
}

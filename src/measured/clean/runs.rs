//! Finds points and runs of points off the curve: dirt, and what scanners write where they see nothing.
//!
//! A run begins and ends with a step of the course: neither end of it lies on the line through the two vertices on the other
//! side, each off to its own side. An edge is no step, because its point lies on both lines; nor is an arc, because it turns one
//! way. Without the run there is no step. A run with a step at one end alone has one height, as a scanner writes it, or has lost the sign
//! of its coordinates.

use super::checks::{Check, Finding, distance, median};
use super::course::{Course, turn};
use super::reversals::{BACKWARDS, is_disordered};
use crate::measured::read::points::Point;

/// Least height of a step, as a multiple of the median noise of the steps nearby, and of all: nine deviations of a point.
const STEP_RATIO: f64 = 6.0;
/// Least height of a step \[mm\]. Smoothing removes smaller roughness.
const STEP_HEIGHT: f64 = 0.02;
/// Least height of a step \[mm\] that sets the last points of a profile apart: edges end in burrs and chamfers.
const STEP_AT_END: f64 = 0.2;
/// Length of the edge of such a step, as a multiple of the median length nearby.
const JUMP_AT_END: f64 = 4.0;
/// Least number of neighbours of one height that are a scanner's, if a step is beside them.
const LEVEL: usize = 3;
/// Number of edges on each side that make a step's neighbourhood.
const NEIGHBOURHOOD: usize = 10;
/// Largest number of vertices of a run: the larger of this number and a fortieth of those of the smoothed path. Runs of 28 were seen, whose
/// rows had lost their minus.
const LONGEST: usize = 40;
/// Largest number of vertices of a run at an end, where a step is all that shows it.
const LONGEST_AT_END: usize = 12;
/// Least number of vertices of the path to one of a run: what most of the points say is the curve.
const FEW: usize = 4;
/// Least distance of a point from the smoothed path where it is off it, as a multiple of that within which three in four are: nine
/// deviations.
const POINT_RATIO: f64 = 8.0;
/// Number of steps, after the one where a run begins, of which one may be its end.
const ENDS: usize = 32;
/// Least length \[mm\] of an edge that is a jump, and its ratio to the median length nearby.
const JUMP: f64 = 1.0;
const JUMP_RATIO: f64 = 10.0;
/// Least length of the jumps to a run and back from it, as a multiple of the distance between its neighbours.
const DETOUR: f64 = 2.0;
/// Share of a run's steps that may be left without it.
const LEFT_OVER: f64 = 0.25;
/// Least height of a run's steps, as a share of its height: grooves and dents have sides.
const ABRUPT: f64 = 0.2;
/// Height \[mm\] of a run that no wear leaves between two neighbouring points on either side of it.
const NO_WEAR: f64 = 0.4;
/// Most vertices that tell the direction of the curve beside a run.
const SIDE: usize = 4;
/// Distance \[mm\] from half of the points beyond which no rail or wheel reaches.
const FAR: f64 = 500.0;
/// Most rounds. Each finds what the one before uncovered.
const ROUNDS: usize = 5;

/// The points `from`..=`to`, which lie off the curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::measured) struct BadRun {
    pub from: usize,
    pub to: usize,
    /// Largest distance of its points from the curve \[mm\].
    pub height: f64,
}

/// Measured points without the runs that are off the curve, and their smoothed path.
#[derive(Debug, Clone)]
pub(in crate::measured) struct Path {
    /// The runs off the curve, from left to right.
    pub runs: Vec<BadRun>,
    /// Indices of the other points.
    pub on: Vec<usize>,
    /// The other points.
    pub sound: Vec<Point>,
    /// Their smoothed path.
    pub course: Course,
}

impl Path {
    /// Finds the runs and smooths the path of the other points.
    pub fn of(points: &[Point]) -> Self {
        let runs = runs(points);
        let mut bad = vec![false; points.len()];
        runs.iter().for_each(|run| bad[run.from..=run.to].fill(true));
        let on: Vec<usize> = (0..points.len()).filter(|&k| !bad[k]).collect();
        let sound: Vec<Point> = on.iter().map(|&k| points[k]).collect();
        Self { runs, on, course: Course::new(&sound), sound }
    }

    /// Returns the points by which axes and origin are judged, in the coordinates that `points` have: the vertices of the smoothed path.
    /// These points are as long as `scale` \[mm\]; if they are in no order, all are returned.
    pub fn judged(points: &[Point], scale: f64) -> Vec<Point> {
        let scaled = |by: f64| move |p: &Point| Point { x: by * p.x, z: by * p.z, ..*p };
        let path = Self::of(&points.iter().map(scaled(scale)).collect::<Vec<_>>());
        if is_disordered(&path.course) {
            return points.to_vec();
        }
        let vertex = |(v, median): (usize, &Point)| match path.course.merged[v] {
            true => scaled(scale.recip())(median),
            false => points[path.on[path.course.points_of(v).start]],
        };
        path.course.at.iter().enumerate().map(vertex).collect()
    }
}

impl BadRun {
    pub(super) fn finding(&self, points: &[Point]) -> Finding {
        let first = &points[self.from];
        let found = match self.to - self.from {
            0 => format!("a point {} off the line of its neighbours", self.how_far()),
            more => format!(
                "{} points in a row, {}, up to {} off the curve of their neighbours",
                more + 1,
                self.rows(points),
                self.how_far()
            ),
        };
        Finding { fatal: self.is_no_surface(points), ..Finding::new(Check::Spike, first, found) }
    }

    /// Names the first and the last of its points in the order of the file.
    pub(super) fn rows(&self, points: &[Point]) -> String {
        let (first, last) = (&points[self.from], &points[self.to]);
        let [first, last] = if first.number < last.number { [first, last] } else { [last, first] };
        if self.to > self.from { format!("{} to {}", first.place(), last.place()) } else { first.place() }
    }

    fn how_far(&self) -> String {
        if self.height < FAR { format!("{:.3} mm", self.height) } else { format!("more than {FAR} mm") }
    }

    /// Returns whether no surface has such a run: the path turns back at it, it is higher than any dent, or all its heights are the same,
    /// as a scanner writes where it sees nothing. Other runs may be dirt, dents, or a corner of a curve with few points.
    fn is_no_surface(&self, points: &[Point]) -> bool {
        let level = points[self.from..=self.to].iter().all(|p| p.z == points[self.from].z);
        let more = self.to > self.from;
        let beside = self.from.checked_sub(1).and_then(|k| points.get(k)).zip(points.get(self.to + 1));
        let apart = beside.filter(|_| !more).map_or(0.0, |(before, after)| distance(before, after));
        more && level || self.height >= NO_WEAR.max(0.5 * apart) || self.is_sharp(points)
    }

    /// Returns whether it is a single point, and the path turns by more than 120° at it or beside it.
    fn is_sharp(&self, points: &[Point]) -> bool {
        let near = &points[self.from.saturating_sub(2)..points.len().min(self.from + 3)];
        self.to == self.from
            && near.windows(3).any(|three| turn(&three[0], &three[1], &three[2]).abs() > BACKWARDS)
    }
}

/// Finds all runs, from left to right.
fn runs(points: &[Point]) -> Vec<BadRun> {
    let mut bad: Vec<Option<f64>> = far_away(points).iter().map(|far| far.then_some(FAR)).collect();
    // Smoothing would mix a run with its neighbours: what sticks out of the path as it is goes first.
    for smoothed in [false, true] {
        let on: Vec<usize> = (0..points.len()).filter(|&k| bad[k].is_none()).collect();
        let sound: Vec<Point> = on.iter().map(|&k| points[k]).collect();
        let course = if smoothed { Course::new(&sound) } else { Course::unsmoothed(&sound) };
        let vertices = course.at.len();
        let wanted = if smoothed {
            WantedRuns { longest: LONGEST.max(vertices / 40).min(vertices / FEW), least: 0.0 }
        } else {
            WantedRuns { longest: LONGEST.min(vertices / FEW), least: NO_WEAR }
        };
        for (place, far) in off_the_course(&sound, &course, wanted) {
            bad[on[place]] = Some(far);
        }
    }
    gathered(&bad)
}

/// Returns the points that are off the curve, and their distances \[mm\] from it.
fn off_the_course(points: &[Point], course: &Course, wanted: WantedRuns) -> Vec<(usize, f64)> {
    let mut off = vec![false; course.at.len()];
    let mut kept: Vec<usize> = (0..course.at.len()).collect();
    for _ in 0..ROUNDS {
        let chain: Vec<Point> = kept.iter().map(|&v| course.at[v]).collect();
        let found = runs_of(&chain, wanted);
        if found.is_empty() {
            break;
        }
        found.iter().for_each(|&[from, to]| kept[from..=to].iter().for_each(|&v| off[v] = true));
        kept.retain(|&v| !off[v]);
    }
    let far = distances(points, course, &kept);
    let among = |v: usize| if course.merged[v] { course.points_of(v) } else { 0..0 };
    let mut noise: Vec<f64> = (0..course.at.len()).flat_map(among).map(|k| far[k]).collect();
    noise.sort_by(f64::total_cmp);
    let least = STEP_HEIGHT.max(POINT_RATIO * noise.get(noise.len() * 3 / 4).copied().unwrap_or(0.0));
    let is_off = |&(v, k): &(usize, usize)| if course.merged[v] { far[k] > least } else { off[v] };
    let all = (0..course.at.len()).flat_map(|v| course.points_of(v).map(move |k| (v, k)));
    all.filter(is_off).map(|(_, k)| (k, far[k])).collect()
}

/// Returns the runs of consecutive bad points, of their distances.
fn gathered(bad: &[Option<f64>]) -> Vec<BadRun> {
    let mut out: Vec<BadRun> = Vec::new();
    for (k, far) in bad.iter().enumerate().filter_map(|(k, far)| Some((k, (*far)?))) {
        match out.last_mut() {
            Some(run) if run.to + 1 == k => (run.to, run.height) = (k, run.height.max(far)),
            _ => out.push(BadRun { from: k, to: k, height: far }),
        }
    }
    out
}

/// Returns which points are farther from half of the others than any profile reaches; none if they are many, as in a wrong unit.
fn far_away(at: &[Point]) -> Vec<bool> {
    let middle = |of: fn(&Point) -> f64| median(at.iter().map(of).collect());
    let [x, z] = [middle(|p| p.x), middle(|p| p.z)];
    let far: Vec<bool> = at.iter().map(|p| (p.x - x).abs().max((p.z - z).abs()) > FAR).collect();
    let few = 10 * far.iter().filter(|far| **far).count() <= at.len();
    if few { far } else { vec![false; at.len()] }
}

/// Returns the distance \[mm\] of each point from the path through the kept vertices.
fn distances(points: &[Point], course: &Course, kept: &[usize]) -> Vec<f64> {
    /// Number of chords on each side of a point's place in the order that may be the nearest.
    const NEAR: usize = 3;
    let mut out = vec![0.0; points.len()];
    for v in 0..course.at.len() {
        let place = kept.partition_point(|&k| k < v);
        let chords = place.saturating_sub(NEAR)..(place + NEAR).min(kept.len().saturating_sub(1));
        for k in course.points_of(v) {
            let from = |c: usize| {
                let chord = [&course.at[kept[c]], &course.at[kept[c + 1]]];
                from_chord(&points[k], chord, [c == 0, c + 2 == kept.len()])
            };
            out[k] = chords.clone().map(from).fold(f64::INFINITY, f64::min);
        }
    }
    out
}

/// Returns the distance \[mm\] of a point from a chord, which goes on beyond its `open` ends.
fn from_chord(p: &Point, [a, b]: [&Point; 2], open: [bool; 2]) -> f64 {
    let [u, w] = [b.x - a.x, b.z - a.z];
    let square = u * u + w * w;
    let [least, most] =
        [if open[0] { f64::NEG_INFINITY } else { 0.0 }, if open[1] { f64::INFINITY } else { 1.0 }];
    let share = ((p.x - a.x) * u + (p.z - a.z) * w) / square;
    let share = if square > 0.0 { share.clamp(least, most) } else { 0.0 };
    (p.x - a.x - share * u).hypot(p.z - a.z - share * w)
}

/// A line through vertices: one of its points, and its direction.
#[derive(Debug, Clone, Copy)]
struct Chord {
    at: [f64; 2],
    along: [f64; 2],
}

impl Chord {
    /// Returns the line of least squares through vertices, along their order; `None` if they do not tell a direction.
    fn through(points: &[Point]) -> Option<Self> {
        let (first, last) = (points.first()?, points.last()?);
        let n = points.len() as f64;
        let mean = |of: fn(&Point) -> f64| points.iter().map(of).sum::<f64>() / n;
        let at = [mean(|p| p.x), mean(|p| p.z)];
        // Each vertex counts by its place in the order.
        let slope = |of: fn(&Point) -> f64| -> f64 {
            points.iter().enumerate().map(|(k, p)| (k as f64 - 0.5 * (n - 1.0)) * of(p)).sum()
        };
        let along = [slope(|p| p.x), slope(|p| p.z)];
        let length = along[0].hypot(along[1]);
        (length > 0.0 && distance(first, last) > 0.0).then(|| Self { at, along: along.map(|c| c / length) })
    }

    /// Returns the distance \[mm\] of a point, positive to the left.
    fn off(&self, p: &Point) -> f64 {
        self.along[0] * (p.z - self.at[1]) - self.along[1] * (p.x - self.at[0])
    }

    fn is_along(&self, a: &Point, b: &Point) -> bool {
        self.along[0] * (b.x - a.x) + self.along[1] * (b.z - a.z) > 0.0
    }
}

/// The step from a vertex to the next one, between the line that ends in the first and the line that begins in the second.
#[derive(Debug, Clone, Copy, Default)]
struct StepHeight {
    /// The smaller one of the two vertices' distances \[mm\] from the other's line; 0 if both are on one side: an arc, or an edge.
    least: f64,
    /// The larger one \[mm\].
    most: f64,
    /// Half of the difference of the two distances \[mm\]: the noise, if there is no step.
    noise: f64,
}

impl StepHeight {
    /// At an end of the path there is one line.
    fn between(before: Option<Chord>, a: &Point, b: &Point, after: Option<Chord>) -> Self {
        match (before.map(|line| line.off(b)), after.map(|line| line.off(a))) {
            (Some(left), Some(right)) => {
                let [least, most] = [left.abs().min(right.abs()), left.abs().max(right.abs())];
                let least = if left * right < 0.0 { least } else { 0.0 };
                Self { least, most, noise: 0.5 * (left - right).abs() }
            }
            (Some(one), None) | (None, Some(one)) => Self { least: one.abs(), most: one.abs(), noise: 0.0 },
            _ => Self::default(),
        }
    }
}

/// Finds the runs [first, last] of a chain of distinct vertices.
fn runs_of(chain: &[Point], wanted: WantedRuns) -> Vec<[usize; 2]> {
    let n = chain.len();
    if n < SIDE {
        return Vec::new();
    }
    let line = |from: usize| Chord::through(&chain[from..from + 2]);
    let of_edge = |k: usize| {
        let before = k.checked_sub(1).and_then(line);
        StepHeight::between(before, &chain[k], &chain[k + 1], (k + 2 < n).then(|| line(k + 1)).flatten())
    };
    let heights: Vec<StepHeight> = (0..n - 1).map(of_edge).collect();
    let mut noise: Vec<f64> = heights.iter().map(|step| step.noise).collect();
    noise.sort_by(f64::total_cmp);
    // Of normal noise three in four values are within 1.7 medians; where noise runs along the path it shows in none.
    let everywhere = noise[noise.len() * 3 / 4] / 1.7;
    let lengths: Vec<f64> = chain.windows(2).map(|pair| distance(&pair[0], &pair[1])).collect();
    let height = STEP_HEIGHT.max(STEP_RATIO * everywhere);
    let is_step = |k: usize| {
        let near = (k.saturating_sub(NEIGHBOURHOOD)..(n - 1).min(k + NEIGHBOURHOOD + 1))
            .filter(|j| j.abs_diff(k) > 2);
        let beyond = |value: f64, least: f64, ratio: f64, of: &dyn Fn(usize) -> f64| {
            value > least && value > ratio * median(near.clone().map(of).collect())
        };
        beyond(heights[k].least, height, STEP_RATIO, &|j| heights[j].noise)
            || beyond(lengths[k], JUMP, JUMP_RATIO, &|j| lengths[j])
    };
    let steps: Vec<usize> = (0..n - 1).filter(|&k| is_step(k)).collect();
    let search = RunSearch { chain, heights: &heights, steps: &steps, wanted, height };
    let mut pairs: Vec<[usize; 2]> =
        (0..steps.len()).filter_map(|s| Some([s, search.run_from(s)?])).collect();
    pairs.sort_by_key(|&[s, e]| steps[e] - steps[s]);
    let mut free = vec![true; steps.len()];
    let mut out = Vec::new();
    for [s, e] in pairs {
        if free[s..=e].iter().all(|free| *free) {
            free[s..=e].fill(false);
            out.push(search.with_level([steps[s] + 1, steps[e]]));
        }
    }
    let alone = (0..steps.len()).filter(|&s| free[s]).map(|s| steps[s]);
    out.extend(alone.filter_map(|step| search.level_beside(step).or_else(|| search.mirrored_beside(step))));
    if out.is_empty() { search.at_ends(&lengths) } else { out }
}

/// The runs that are wanted.
#[derive(Debug, Clone, Copy)]
struct WantedRuns {
    /// Largest number of vertices.
    longest: usize,
    /// Least height \[mm\].
    least: f64,
}

struct RunSearch<'a> {
    chain: &'a [Point],
    heights: &'a [StepHeight],
    /// Edges k → k + 1 that are steps.
    steps: &'a [usize],
    wanted: WantedRuns,
    /// Least height of a step anywhere \[mm\].
    height: f64,
}

impl RunSearch<'_> {
    /// Returns the step that ends the shortest run which begins with step `s`.
    fn run_from(&self, s: usize) -> Option<usize> {
        let ends = s + 1..self.steps.len().min(s + 1 + ENDS);
        ends.take_while(|&e| self.steps[e] - self.steps[s] <= self.wanted.longest).find(|&e| self.joins(s, e))
    }

    /// Returns whether the path has no step without the vertices between two steps.
    fn joins(&self, s: usize, e: usize) -> bool {
        let (a, b) = (self.steps[s], self.steps[e] + 1);
        // Beside a high step a low one is that step's own: it is a line's end.
        let high = |step: usize| {
            let least = LEFT_OVER * self.heights[step].least;
            move |&&k: &&usize| k.abs_diff(step) > 1 || self.heights[k].least >= least
        };
        let last = self.steps[..s].iter().rfind(high(a)).map_or(0, |k| k + 1);
        let next = self.steps[e + 1..].iter().find(high(b - 1)).map_or(self.chain.len(), |k| k + 1);
        let (from, to) = (last.max((a + 1).saturating_sub(SIDE)), next.min(b + SIDE));
        let [before, after] = [from..a + 1, b..to].map(|side| Chord::through(&self.chain[side]));
        let [p, q] = [&self.chain[a], &self.chain[b]];
        let onwards = |line: Option<Chord>| line.is_none_or(|line| line.is_along(p, q));
        let ends = [&self.heights[a], &self.heights[b - 1]];
        let least = ends[0].least.min(ends[1].least);
        let left = StepHeight::between(before, p, q, after).least;
        let gap = distance(p, q);
        let run = &self.chain[a + 1..b];
        let off = |chord: Chord| run.iter().map(|p| chord.off(p).abs()).fold(0.0, f64::max);
        let height = Chord::through(&[*p, *q]).map_or(0.0, off);
        let [lower, higher] = [ends[0].most.min(ends[1].most), ends[0].most.max(ends[1].most)];
        let by_steps =
            least > STEP_HEIGHT && lower >= ABRUPT * height && left <= STEP_HEIGHT.max(LEFT_OVER * higher);
        let jumps = distance(p, &run[0]).min(distance(&run[run.len() - 1], q));
        let by_jumps =
            before.is_some() && after.is_some() && jumps >= DETOUR * gap && left <= LEFT_OVER * jumps;
        height >= self.wanted.least && onwards(before) && onwards(after) && (by_steps || by_jumps)
    }

    /// Returns a run with the vertices beside it that have its height, if it has one: a scanner wrote them, too.
    fn with_level(&self, [from, to]: [usize; 2]) -> [usize; 2] {
        let level = self.chain[from].z;
        let [wide_from, wide_to] = self.level_around(from, level);
        let is_level = wide_to >= to && from < to;
        if is_level { [wide_from, wide_to] } else { [from, to] }
    }

    /// Returns the range of vertices of this height around one of them.
    fn level_around(&self, vertex: usize, level: f64) -> [usize; 2] {
        let same = |p: &&Point| p.z == level;
        let before = self.chain[..vertex].iter().rev().take_while(same).count();
        let after = self.chain[vertex..].iter().take_while(same).count();
        [vertex - before, vertex + after.saturating_sub(1)]
    }

    /// Returns the run of equal heights that a step without another one begins or ends, as where a scanner's zeros cross the curve.
    fn level_beside(&self, step: usize) -> Option<[usize; 2]> {
        let [before, after] = [step, step + 1].map(|v| self.level_around(v, self.chain[v].z));
        let long = |run: &[usize; 2]| run[1] - run[0] + 1 >= LEVEL && run[1] - run[0] < self.wanted.longest;
        [before, after].into_iter().filter(long).max_by_key(|run| run[1] - run[0])
    }

    /// Returns the run that a step without another one begins or ends, if its points have lost the minus of x or z. Both sides of the step and
    /// both coordinates are tried. A run whose far end does not join the path as it is counts before one where the curve crosses the axis, and
    /// a shorter one before a longer one.
    fn mirrored_beside(&self, step: usize) -> Option<[usize; 2]> {
        let (before, after) = self.chain.split_at(step + 1);
        let before: Vec<Point> = before.iter().rev().take(self.wanted.longest + 2).copied().collect();
        let of_side =
            |sides: [&[Point]; 2]| [0, 1].map(|axis| self.mirrored(sides, axis)).into_iter().flatten();
        let runs_before = of_side([&before, after]).map(|run| (run, [step + 1 - run.1, step]));
        let runs_after = of_side([after, &before]).map(|run| (run, [step + 1, step + run.1]));
        runs_before.chain(runs_after).min_by_key(|(run, _)| *run).map(|(_, range)| range)
    }

    /// Finds the shortest run on one `side` of a step that joins the path at both ends if x (`axis` 0) or z (1) changes its sign. At least one
    /// of its points must move by the least height of the wanted runs. The points of either side begin at the step. Returns whether the curve
    /// crosses the axis at the run's far end, so that the path goes on there as it is, too, and the number of points.
    fn mirrored(&self, [side, other]: [&[Point]; 2], axis: usize) -> Option<(bool, usize)> {
        let mirror = |p: Point| if axis == 0 { Point { x: -p.x, ..p } } else { Point { z: -p.z, ..p } };
        let [&first, &second] = [side.first()?, side.get(1)?];
        if !self.goes_on([*other.get(1)?, *other.first()?, mirror(first), mirror(second)]) {
            return None;
        }
        let has_sign = |p: &&Point| p.xz()[axis] * first.xz()[axis] > 0.0;
        let most = side.iter().take(self.wanted.longest).take_while(has_sign).count();
        // Beside the axis any part of a curve is nearly its own mirror.
        let high = side.iter().position(|p| 2.0 * p.xz()[axis].abs() >= self.wanted.least)?;
        (2.max(high + 1)..=most).find_map(|count| {
            let &[p, last, next, q] = side.get(count - 2..count + 2)? else { return None };
            let joins = self.goes_on([mirror(p), mirror(last), next, q]);
            joins.then(|| (self.goes_on([p, last, next, q]), count))
        })
    }

    /// Returns whether a path goes on from the second of four points to the third without a step.
    fn goes_on(&self, [p, a, b, q]: [Point; 4]) -> bool {
        let lines = [[p, a], [b, q]].map(|line| Chord::through(&line));
        lines.iter().flatten().all(|line| line.is_along(&a, &b))
            && StepHeight::between(lines[0], &a, &b, lines[1]).most <= self.height
    }

    /// Returns the run that jumps off the path at one of its ends.
    fn at_ends(&self, lengths: &[f64]) -> Vec<[usize; 2]> {
        let n = self.chain.len();
        let longest = LONGEST_AT_END.min(n / 10);
        let jumps = |k: usize| {
            let near =
                (k.saturating_sub(NEIGHBOURHOOD)..(n - 1).min(k + NEIGHBOURHOOD + 1)).filter(|j| *j != k);
            self.heights[k].least >= STEP_AT_END
                && lengths[k] > JUMP_AT_END * median(near.map(|j| lengths[j]).collect())
        };
        let near =
            |from: usize, to: usize| self.steps.iter().copied().filter(move |k| (from..to).contains(k));
        let alone = |from: usize, to: usize| near(from, to).next().filter(|_| near(from, to).count() == 1);
        let first = alone(0, 2 * longest).filter(|&k| k > 0 && k < longest && jumps(k));
        let last = alone(n - 1 - 2 * longest.min(n / 4), n)
            .filter(|&k| k + 2 < n && k + longest > n - 2 && jumps(k));
        first.map(|k| [0, k]).into_iter().chain(last.map(|k| [k + 1, n - 1])).collect()
    }
}

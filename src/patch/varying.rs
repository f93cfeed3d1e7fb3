//! The patch on a rail that varies along the track, where a line of constant ξ may meet it in several intervals of η.
//!
//! Lines of constant ξ, half a millimetre apart and nearer to each other around C, are searched for intervals with s < δ. Between two
//! lines whose intervals do not answer each other one to one, more lines are laid until the place is known to rounding: there intervals
//! begin, end, divide or join. So a part is missed only if it is narrower than the steps in both directions and does not hold C.

use super::band::{Band, overlap};
use super::outline::{End, Window};
use super::skewed::slicer::Edge;
use crate::numerics::roots::{bracketed, last_where};
use crate::placement::Placement;
use crate::separation::Evaluator;

/// Step of the lines of constant ξ \[mm\].
const STEP: f64 = 0.5;

/// Step along them, as a share of the half-length of the patch of a wheel on a straight rail; its limits \[mm\].
const SHARE: f64 = 0.125;
const STEPS: [f64; 2] = [0.25, 1.0];

/// How far along the track from C the patch is looked for \[mm\], and how many halvings of a step lie around C.
const FARTHEST: f64 = 120.0;
const HALVINGS: i32 = 24;

/// Points over an interval that a line near by has, and how far beyond its ends, as a share of it.
const POINTS: usize = 12;
const BEYOND: f64 = 0.25;

/// Distance of two lines, in roundings of the size of ξ, at which no line lies between them.
const NEAREST: f64 = 8.0;

/// Depth \[mm\] of an interval that ends at a tip, not where a body ends: that of two lines a rounding apart.
const SHALLOW: f64 = 1e-9;

/// Relative accuracy of the interpolated boundary: a spline across the rail bends anew in every cell.
pub(super) const SMOOTH: f64 = 1e-9;

/// An interval of η of the patch.
#[derive(Debug, Clone, Copy)]
struct Interval {
    eta: [f64; 2],
    /// Where s is least in it, and that s \[mm\].
    lowest: [f64; 2],
}

/// A line of constant ξ with its intervals, by ascending η.
#[derive(Debug, Clone)]
struct Line {
    xi: f64,
    intervals: Vec<Interval>,
}

/// The slices of a placed pair on a rail that varies at one approach.
#[derive(Debug)]
pub(super) struct Varying<'a> {
    evaluator: Evaluator<'a>,
    approach: f64,
    /// Step along lines of constant ξ \[mm\].
    step: f64,
    /// The lines of every band.
    lanes: Vec<Vec<(f64, Interval)>>,
}

impl<'a> Varying<'a> {
    /// Makes the slices; `None` on a swept rail.
    pub(super) fn new(placement: &'a Placement, approach: f64) -> Option<Self> {
        placement.lofted()?;
        let half = (2.0 * placement.rolling_radius() * approach).sqrt();
        // Also for δ = NaN, where nothing is found.
        let step = (SHARE * half).max(STEPS[0]).min(STEPS[1]);
        Some(Self { evaluator: Evaluator::new(placement), approach, step, lanes: Vec::new() })
    }

    /// Finds the bands in a window, and pairs (lane, ξ) at which s may be least \[mm\].
    pub(super) fn bands(&mut self, placement: &Placement, window: &Window) -> (Vec<Band>, Vec<(usize, f64)>) {
        let eta = [window.eta[0].max(-FARTHEST), window.eta[1].min(FARTHEST)];
        let reach = placement.lofted().and_then(|rail| rail.reach(eta));
        let Some([from, to]) = reach.filter(|_| eta[0] < eta[1]) else { return (Vec::new(), Vec::new()) };
        let xi = [window.xi[0].max(from), window.xi[1].min(to)];
        if xi[0] >= xi[1] {
            return (Vec::new(), Vec::new());
        }
        let samples = places(eta, self.step);
        let lines: Vec<Line> = places(xi, STEP).into_iter().map(|xi| self.line(xi, &samples)).collect();
        let lines = self.refined(lines);
        let (bands, turns) = self.joined(&lines, window, xi);
        (bands.into_iter().filter(|band| band.xi[0] < band.xi[1]).collect(), turns)
    }

    /// Returns both ends of the slice of a lane at ξ; `None` outside the patch.
    pub(super) fn edges(&mut self, xi: f64, lane: Option<usize>) -> Option<[Edge; 2]> {
        let edge = |eta: f64| Edge { eta, ledge: false };
        self.interval(xi, lane).map(|found| found.eta.map(edge))
    }

    /// Returns η of the least s of a lane at ξ \[mm\], or of C's surroundings without one; between its lines where nothing overlaps.
    pub(super) fn lowest(&mut self, xi: f64, lane: Option<usize>) -> f64 {
        if let Some(found) = self.interval(xi, lane) {
            return found.lowest[0];
        }
        let Some(rows) = lane.and_then(|lane| self.lanes.get(lane)) else { return 0.0 };
        let [a, b] = beside(rows, xi).map(|k| rows[k]);
        if (xi - a.0).abs() <= (b.0 - xi).abs() { a.1.lowest[0] } else { b.1.lowest[0] }
    }

    /// Returns s \[mm\].
    pub(super) fn separation(&mut self, xi: f64, eta: f64) -> f64 {
        self.evaluator.separation(xi, eta)
    }

    /// Finds the interval of a lane at ξ: between those of the lines on both sides.
    fn interval(&mut self, xi: f64, lane: Option<usize>) -> Option<Interval> {
        let Some(rows) = lane.and_then(|lane| self.lanes.get(lane)) else {
            let step = self.step;
            let found = self.line(xi, &places([-FARTHEST, FARTHEST], step));
            return found.intervals.into_iter().min_by(|a, b| a.lowest[1].total_cmp(&b.lowest[1]));
        };
        let [(from, a), (to, b)] = beside(rows, xi).map(|k| rows[k]);
        let share = if to > from { ((xi - from) / (to - from)).clamp(0.0, 1.0) } else { 0.0 };
        let middle = |of: &Interval| 0.5 * (of.eta[0] + of.eta[1]);
        let near = middle(&a) + share * (middle(&b) - middle(&a));
        let hull = [a.eta[0].min(b.eta[0]), a.eta[1].max(b.eta[1])];
        let mut samples = Vec::new();
        spread(hull, &mut samples);
        let away = |of: &Interval| (near.clamp(of.eta[0], of.eta[1]) - near).abs();
        let line = self.line(xi, &samples);
        line.intervals.into_iter().min_by(|p, q| away(p).total_cmp(&away(q)))
    }

    /// Finds the intervals along a line by s at ascending η.
    fn line(&mut self, xi: f64, samples: &[f64]) -> Line {
        let mut points: Vec<[f64; 2]> = samples.iter().map(|&eta| [eta, self.separation(xi, eta)]).collect();
        let approach = self.approach;
        let dips: Vec<usize> = (1..points.len().max(1) - 1)
            .filter(|&k| {
                let [a, s, b] = [k - 1, k, k + 1].map(|k| points[k][1]);
                // As far below as a parabola through the three may be, twice.
                s <= a && s <= b && (s - approach < 0.5 * ((a - s) + (b - s)) || s < approach)
            })
            .collect();
        for k in dips.into_iter().rev() {
            let slope = |eta: f64| self.evaluator.separation_and_gradient(xi, eta).1[1];
            if let Some(eta) = bracketed(slope, points[k - 1][0], points[k + 1][0]) {
                let at = k + usize::from(eta > points[k][0]);
                let s = self.separation(xi, eta);
                if eta != points[k][0] && s < points[k][1] {
                    points.insert(at, [eta, s]);
                }
            }
        }
        let mut intervals: Vec<Interval> = Vec::new();
        let mut open: Option<Interval> = None;
        for k in 0..points.len() {
            let [eta, s] = points[k];
            let inside = s < approach;
            if inside && open.is_none() {
                let from = if k == 0 { eta } else { self.edge(xi, eta, points[k - 1][0]) };
                open = Some(Interval { eta: [from, eta], lowest: [eta, s] });
            }
            if let Some(found) = open.as_mut().filter(|_| inside) {
                found.eta[1] = eta;
                if s < found.lowest[1] {
                    found.lowest = [eta, s];
                }
            }
            if let Some(mut found) = open.take_if(|_| !inside) {
                found.eta[1] = self.edge(xi, points[k - 1][0], eta);
                intervals.push(found);
            }
        }
        intervals.extend(open);
        Line { xi, intervals }
    }

    /// Finds the end of an interval between a place inside and one outside.
    fn edge(&mut self, xi: f64, inside: f64, outside: f64) -> f64 {
        let approach = self.approach;
        let root = bracketed(|eta| self.separation(xi, eta) - approach, inside, outside);
        root.unwrap_or_else(|| last_where(|eta| self.separation(xi, eta) < approach, inside, outside))
    }

    /// Lays more lines until the intervals of neighbours answer each other, or nothing lies between the lines.
    fn refined(&mut self, lines: Vec<Line>) -> Vec<Line> {
        let mut out: Vec<Line> = Vec::with_capacity(2 * lines.len());
        let mut waiting: Vec<Line> = lines.into_iter().rev().collect();
        while let Some(next) = waiting.pop() {
            let Some(last) = out.last().filter(|last| !answer(last, &next)) else {
                out.push(next);
                continue;
            };
            let nearest = NEAREST * f64::EPSILON * last.xi.abs().max(next.xi.abs());
            let middle = last.xi + 0.5 * (next.xi - last.xi);
            if next.xi - last.xi <= nearest || middle <= last.xi || middle >= next.xi {
                out.push(next);
                continue;
            }
            let mut samples = Vec::new();
            last.intervals.iter().chain(&next.intervals).for_each(|found| spread(found.eta, &mut samples));
            samples.sort_by(f64::total_cmp);
            samples.dedup();
            let between = self.line(middle, &samples);
            waiting.extend([next, between]);
        }
        out
    }

    /// Joins the intervals of successive lines to bands.
    fn joined(&mut self, lines: &[Line], window: &Window, ends: [f64; 2]) -> (Vec<Band>, Vec<(usize, f64)>) {
        let (mut bands, mut lanes): (Vec<Band>, Vec<Vec<(f64, Interval)>>) = (Vec::new(), Vec::new());
        // The band of every interval of the line before.
        let mut current: Vec<usize> = Vec::new();
        let nothing = Line { xi: ends[0], intervals: Vec::new() };
        let pairs = std::iter::once(&nothing).chain(lines).zip(lines);
        for (before, line) in pairs {
            let links = links(before, line);
            let alone = |side: usize, k: usize| links.iter().filter(|link| link[side] == k).count() == 1;
            let mut next = Vec::with_capacity(line.intervals.len());
            for (j, found) in line.intervals.iter().enumerate() {
                let from = links.iter().find(|[i, other]| *other == j && alone(0, *i) && alone(1, j));
                let band = from.map_or_else(
                    || {
                        let joins = links.iter().any(|link| link[1] == j);
                        let end = (!joins).then(|| bound(found, line.xi, [window.xi[0], ends[0]], self.approach));
                        let side = side(found, end);
                        bands.push(Band::new([line.xi; 2], [end, None], [side; 2], window.eta));
                        lanes.push(Vec::new());
                        bands.len() - 1
                    },
                    |[i, _]| current[*i],
                );
                lanes[band].push((line.xi, *found));
                next.push(band);
            }
            for (i, &band) in current.iter().enumerate() {
                if next.contains(&band) {
                    continue;
                }
                let found = &before.intervals[i];
                let joins = links.iter().any(|link| link[0] == i);
                let end = (!joins).then(|| bound(found, before.xi, [f64::NAN; 2], self.approach));
                // Bands that join or divide meet at one ξ.
                close(&mut bands[band], if joins { line.xi } else { before.xi }, end, side(found, end));
            }
            current = next;
        }
        if let Some(last) = lines.last() {
            for (found, &band) in last.intervals.iter().zip(&current) {
                let end = Some(bound(found, last.xi, [window.xi[1], ends[1]], self.approach));
                close(&mut bands[band], last.xi, end, side(found, end));
            }
        }
        let deepest = |rows: &Vec<(f64, Interval)>| {
            let least = |p: &&(f64, Interval), q: &&(f64, Interval)| p.1.lowest[1].total_cmp(&q.1.lowest[1]);
            rows.iter().min_by(least).map_or(f64::NAN, |row| row.0)
        };
        let mut turns: Vec<(usize, f64)> = lanes.iter().map(deepest).enumerate().collect();
        self.lanes = lanes;
        for (lane, xi) in &mut turns {
            *xi = self.turn(*lane, *xi);
            bands[*lane].valleys = vec![(bands[*lane].xi[1], vec![*lane])];
        }
        (bands, turns)
    }

    /// Finds where s turns along a lane, near the deepest of its lines.
    fn turn(&mut self, lane: usize, xi: f64) -> f64 {
        let rows = &self.lanes[lane];
        let at = rows.partition_point(|row| row.0 < xi);
        let (Some(from), Some(to)) = (at.checked_sub(1).map(|k| rows[k].0), rows.get(at + 1).map(|row| row.0))
        else {
            return xi;
        };
        let slope = |xi: f64| {
            let eta = self.lowest(xi, Some(lane));
            self.evaluator.separation_and_gradient(xi, eta).1[0]
        };
        bracketed(slope, from, to).unwrap_or(xi)
    }
}

fn close(band: &mut Band, xi: f64, end: Option<End>, side: [f64; 2]) {
    (band.xi[1], band.ends[1], band.sides[1]) = (xi, end, side);
}

/// Returns what bounds an interval at its ξ: the window if ξ is its end, the end of the rail, or a tip.
fn bound(found: &Interval, xi: f64, [window, reach]: [f64; 2], approach: f64) -> End {
    match () {
        () if xi == window => End::Window,
        () if xi == reach || approach - found.lowest[1] > SHALLOW => End::ProfileEnd,
        () => End::Tip,
    }
}

/// Returns the side of a band: without width at a tip.
fn side(found: &Interval, end: Option<End>) -> [f64; 2] {
    if end == Some(End::Tip) { [found.lowest[0]; 2] } else { found.eta }
}

/// Lists the pairs of overlapping intervals of two lines.
fn links(a: &Line, b: &Line) -> Vec<[usize; 2]> {
    let all = (0..a.intervals.len()).flat_map(|i| (0..b.intervals.len()).map(move |j| [i, j]));
    all.filter(|&[i, j]| overlap(a.intervals[i].eta, b.intervals[j].eta)).collect()
}

/// Tells whether the intervals of two lines answer each other one to one.
fn answer(a: &Line, b: &Line) -> bool {
    let count = a.intervals.len();
    count == b.intervals.len() && {
        let links = links(a, b);
        links.len() == count && links.iter().all(|[i, j]| i == j)
    }
}

/// The indices of the rows on both sides of ξ.
fn beside(rows: &[(f64, Interval)], xi: f64) -> [usize; 2] {
    let last = rows.len() - 1;
    let after = rows.partition_point(|row| row.0 < xi).min(last);
    [after.saturating_sub(1), after]
}

/// Adds points over an interval and beyond.
fn spread([low, high]: [f64; 2], out: &mut Vec<f64>) {
    let more = BEYOND * (high - low);
    let (from, length) = (low - more, high - low + 2.0 * more);
    out.extend((0..=POINTS).map(|k| from + length * k as f64 / POINTS as f64));
}

/// Places in steps over an interval, with its ends; nearer to each other around 0 if that lies inside.
fn places([from, to]: [f64; 2], step: f64) -> Vec<f64> {
    let count = ((to - from) / step).ceil().max(1.0);
    let mut out: Vec<f64> = (0..=count as usize).map(|k| from + (to - from) * k as f64 / count).collect();
    out.push(0.0);
    out.extend((0..HALVINGS).flat_map(|k| [1.0, -1.0].map(|sign| sign * step * 0.5f64.powi(k))));
    out.retain(|place| (from..=to).contains(place));
    out.sort_by(f64::total_cmp);
    out.dedup();
    out
}

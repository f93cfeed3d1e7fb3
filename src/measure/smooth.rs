//! Smooths the noisy points of a measured curve by local parabolas, which are as wide as the points' own noise asks for.
//!
//! Method: robust local regression [Cleveland1979] of degree two, across the chord of each window, with the kernel 1 − u². A tip, a
//! crossing or a rise of the smoothed curve is not the extreme of noisy points. Of points without noise nothing is changed.

use crate::measured::noise::Deviates;
use crate::profile::{Mark, Profile, Shape, Station};

/// Fewest points whose noise can be told from their shape.
const LEAST_POINTS: usize = 50;
/// Half width \[mm\] of the windows in which noise is found: the shape of a 10 mm rounding differs from a parabola there by 1e-5 mm.
const NOISE_WINDOW: f64 = 1.5;
/// Noise \[mm\] that is none: less than the last digit of files in micrometres.
const NO_NOISE: f64 = 2e-4;
/// Radius \[mm\] of the roundings for which windows are best: there, the error of the shape is of the size of that of the noise.
const ROUNDING: f64 = 10.0;
/// Largest half width \[mm\] of a window.
const WIDEST: f64 = 6.0;
/// Fewest points on either side in a window, and points beyond its end over which it is sought on.
const LEAST_BESIDE: usize = 3;
const LOOKED_ON: usize = 3;
/// Rounds in which points off the curve lose their weight, and the residual in median absolute residuals at which it is lost.
const ROUNDS: i32 = 4;
const LOST_AT: f64 = 6.0;
/// Standard deviation of a normal distribution whose median absolute value is 1.
const NORMAL: f64 = 1.4826;
/// Integrals of the equivalent kernel of local parabolas with the kernel 1 − u²: of its square, and of u⁴.
const SQUARE: f64 = 1.25;
const FOURTH: f64 = 1.0 / 21.0;
/// Largest distance \[mm\] of the marks of a smoothed curve, and least one of those that its points give.
const STEP: f64 = 0.05;
const APART: f64 = 0.1;
/// Longest stretch \[mm\] without points that is drawn from its neighbours: one or a few points are off the curve.
const DRAWN_OVER: f64 = 2.0;

/// The points of a measured curve.
#[derive(Debug, Clone, Default)]
pub(super) struct NoisyPoints {
    at: Vec<[f64; 2]>,
    /// Whether the way to the next point was not measured.
    unknown: Vec<bool>,
    /// Standard deviation \[mm\] of the points across the curve.
    pub sigma: f64,
    /// Half width \[mm\] of the windows.
    window: f64,
    /// The parabolas of the smoothed curve; empty where the points are taken as they are.
    smooth: Vec<Local>,
    /// Whether the curve through the points as they are is a spline, which swings beside a corner, not a drawing.
    splined: bool,
}

/// A point's parabola: its value and slope at the point, its curvature, and the chord of its window.
#[derive(Debug, Clone, Copy)]
struct Local {
    across: f64,
    slope: f64,
    bend: f64,
    chord: [f64; 2],
}

impl NoisyPoints {
    /// Takes the ends of a profile's segments as points, and finds their noise. If the profile was smoothed before, the noise of the points
    /// that it was smoothed from counts. A drawing has too few points to be noisy.
    pub fn new(profile: &Profile) -> Self {
        let mut own = Self::default();
        let (mut dropped, mut before) = (false, false);
        for segment in profile.segments() {
            let (at, gap) = (segment.start(), segment.is_gap());
            // A point between two bridges is off the curve.
            if gap && before {
                dropped = true;
            } else {
                own.at.push([at.x, at.z]);
                own.unknown.push(gap);
            }
            before = gap;
        }
        if let Some(last) = profile.segments().last() {
            own.at.push([last.end().x, last.end().z]);
            own.unknown.push(false);
        }
        for k in 0..own.at.len().saturating_sub(1) {
            own.unknown[k] &= distance(own.at[k], own.at[k + 1]) > DRAWN_OVER;
        }
        if own.at.len() < LEAST_POINTS {
            return own;
        }
        let (found, counts) = own.parabolas(NOISE_WINDOW, &vec![1.0; own.at.len()]);
        // The point itself draws its parabola nearer.
        let free = |count: usize| (1.0 - 3.1 / count as f64).max(0.1).sqrt();
        let all = found.iter().zip(counts).map(|(local, count)| local.across.abs() / free(count)).collect();
        // The noise of the points of a smoothed curve does not show in it.
        own.sigma = (NORMAL * median(all)).max(profile.noise());
        if own.sigma < NO_NOISE {
            own.sigma = 0.0;
        }
        let step = own.length() / own.at.len() as f64;
        let bias = 3.0 / ROUNDING.powi(3) / 24.0 * FOURTH;
        let best = (own.sigma.powi(2) * step * SQUARE / (8.0 * bias * bias)).powf(1.0 / 9.0);
        own.window = best.min(WIDEST);
        let smooth = own.robust();
        if own.sigma > 0.0 || dropped || own.at.windows(3).any(turns_back) || has_outlier(&smooth) {
            own.smooth = smooth;
        }
        own.splined = profile.segments().iter().all(|of| matches!(of.shape, Shape::Polynomial(_)));
        own
    }

    /// Fits the parabolas; points off the curve lose their weight.
    fn robust(&self) -> Vec<Local> {
        let (mut found, _) = self.parabolas(self.window, &vec![1.0; self.at.len()]);
        for round in 1..=ROUNDS {
            let least = lost_from(&found);
            let far = |local: &Local| local.across.abs();
            let weight = |k: usize| {
                // At first the farthest of neighbours alone: it draws their parabolas away from the others.
                let beside = &found[k.saturating_sub(LEAST_BESIDE)..(k + LEAST_BESIDE + 1).min(found.len())];
                let farthest = beside.iter().map(far).fold(0.0, f64::max);
                let off = far(&found[k]) / least.max(0.5f64.powi(round) * farthest);
                (1.0 - off * off).max(0.0).powi(2)
            };
            let weights: Vec<f64> = (0..found.len()).map(weight).collect();
            found = self.parabolas(self.window, &weights).0;
        }
        found
    }

    /// Returns the length of the path \[mm\] over points that are farther apart than their noise.
    fn length(&self) -> f64 {
        let mut last: Option<[f64; 2]> = None;
        let mut length = 0.0;
        for &at in &self.at {
            let step = last.map_or(f64::INFINITY, |last| distance(last, at));
            if step >= APART {
                length += if last.is_some() { step } else { 0.0 };
                last = Some(at);
            }
        }
        length
    }

    /// Returns the marks of the smoothed curve, and whether the way to the next mark was not measured; `None` for points that are
    /// taken as they are.
    pub fn smoothed(&self) -> Option<(Vec<Mark>, Vec<bool>)> {
        (!self.smooth.is_empty()).then(|| self.marks(&self.smooth))
    }

    /// Returns the marks as [`Self::smoothed`] does, with windows half as wide; of points without noise those of the chords of the ones near
    /// the curve; `None` for a drawing. Such windows take a sixteenth of the shape that whole ones take, so that the difference tells what
    /// smoothing has taken; chords tell what splines and parabolas make of a corner.
    pub fn less_smoothed(&self) -> Option<(Vec<Mark>, Vec<bool>)> {
        if self.sigma > 0.0 {
            let narrow = Self { window: 0.5 * self.window, ..self.clone() };
            return Some(narrow.marks(&narrow.robust()));
        }
        (self.splined || !self.smooth.is_empty()).then(|| self.chords())
    }

    /// Returns marks at both ends of every chord, as [`Self::smoothed`] does.
    fn chords(&self) -> (Vec<Mark>, Vec<bool>) {
        let least = lost_from(&self.smooth);
        let is_near = |k: &usize| self.smooth.get(*k).is_none_or(|local| local.across.abs() <= least);
        let near: Vec<usize> = (0..self.at.len()).filter(is_near).collect();
        let (mut marks, mut unknown, mut s) = (Vec::new(), Vec::new(), 0.0);
        for pair in near.windows(2) {
            let [a, b] = [self.at[pair[0]], self.at[pair[1]]];
            let length = distance(a, b);
            let [cos, sin] = [(b[0] - a[0]) / length, (b[1] - a[1]) / length];
            let mark = |[x, z]: [f64; 2], s: f64| {
                let station = Station { x, z, cos, sin };
                Mark { s, station, curvature: 0.0, segment: 0 }
            };
            marks.extend([mark(a, s), mark(b, s + length)]);
            unknown.extend([self.unknown[pair[0]..pair[1]].contains(&true), false]);
            s += length;
        }
        (marks, unknown)
    }

    /// Measures the smoothed curve once more, with the noise of the points; `None` for points without noise.
    pub fn again(&self, deviates: &mut Deviates) -> Option<(Vec<Mark>, Vec<bool>)> {
        if self.sigma == 0.0 {
            return None;
        }
        let moved = self.at.iter().zip(&self.smooth).map(|([x, z], local)| {
            let off = local.across + self.sigma * deviates.draw();
            [x - off * local.chord[1], z + off * local.chord[0]]
        });
        let again = Self { at: moved.collect(), ..self.clone() };
        let (found, _) = again.parabolas(self.window, &vec![1.0; again.at.len()]);
        Some(again.marks(&found))
    }

    fn marks(&self, found: &[Local]) -> (Vec<Mark>, Vec<bool>) {
        let (mut marks, mut unknown): (Vec<Mark>, Vec<bool>) = (Vec::new(), Vec::new());
        let mut bridge = false;
        for (k, local) in found.iter().enumerate() {
            let ([x, z], [cos, sin]) = (self.at[k], local.chord);
            let norm = 1.0f64.hypot(local.slope);
            let station = Station {
                x: x - local.across * sin,
                z: z + local.across * cos,
                cos: (cos - local.slope * sin) / norm,
                sin: (sin + local.slope * cos) / norm,
            };
            let (last, edge) = (marks.last().copied(), bridge || self.unknown[k] || k + 1 == found.len());
            let step =
                last.map_or(0.0, |last| (station.x - last.station.x).hypot(station.z - last.station.z));
            // A point that is off along the curve lies on it, but not between its neighbours.
            let back = last.is_some_and(|last| is_behind(&last.station, &station));
            if back || last.is_some() && step < if edge { 1e-3 * APART } else { APART } {
                bridge |= self.unknown[k];
                continue;
            }
            let s = last.map_or(0.0, |last| last.s + step);
            marks.push(Mark { s, station, curvature: local.bend / norm.powi(3), segment: 0 });
            if let Some(before) = unknown.last_mut() {
                *before = bridge;
            }
            unknown.push(false);
            bridge = self.unknown[k];
        }
        redirect(&mut marks, &unknown);
        dense(&marks, &unknown)
    }

    /// Fits a parabola about each point, over the points within `window` \[mm\]; also returns their numbers.
    fn parabolas(&self, window: f64, weights: &[f64]) -> (Vec<Local>, Vec<usize>) {
        (0..self.at.len()).map(|k| self.parabola(k, self.around(k, window), window, weights)).unzip()
    }

    /// Returns the first and the last point of the window about a point.
    fn around(&self, k: usize, window: f64) -> [usize; 2] {
        let reach = |forward: bool| {
            let (mut best, mut j, mut count) = (k, k, 0);
            loop {
                let bridge = if forward { self.unknown[j] } else { j > 0 && self.unknown[j - 1] };
                let next = if forward { j + 1 } else { j.wrapping_sub(1) };
                if bridge || next >= self.at.len() {
                    return best;
                }
                (j, count) = (next, count + 1);
                if count <= LEAST_BESIDE || distance(self.at[k], self.at[j]) <= window {
                    best = j;
                } else if j.abs_diff(best) > LOOKED_ON {
                    return best;
                }
            }
        };
        [reach(false), reach(true)]
    }

    fn parabola(&self, k: usize, [from, to]: [usize; 2], window: f64, weights: &[f64]) -> (Local, usize) {
        let [a, b] = [self.at[from], self.at[to]];
        let length = distance(a, b);
        let chord = if length > 0.0 { [(b[0] - a[0]) / length, (b[1] - a[1]) / length] } else { [1.0, 0.0] };
        let local = |j: usize| {
            let [x, z] = [self.at[j][0] - self.at[k][0], self.at[j][1] - self.at[k][1]];
            [x * chord[0] + z * chord[1], z * chord[0] - x * chord[1]]
        };
        let farthest = [from, to].map(|j| local(j)[0].abs()).into_iter().fold(window, f64::max) * 1.01;
        let (mut moments, mut right) = ([0.0; 5], [0.0; 3]);
        // Where most of a window is off the parabola it is the shape that is none, and all its points count.
        let few = 2.0 * weights[from..=to].iter().sum::<f64>() < (to - from + 1) as f64;
        for (j, weight) in weights.iter().enumerate().take(to + 1).skip(from) {
            let [u, v] = local(j);
            let u = u / farthest;
            let mut power = if few { 1.0 } else { *weight } * (1.0 - u * u).max(0.0);
            for (degree, moment) in moments.iter_mut().enumerate() {
                *moment += power;
                if let Some(right) = right.get_mut(degree) {
                    *right += power * v;
                }
                power *= u;
            }
        }
        let matrix = nalgebra::Matrix3::from_fn(|row, column| moments[row + column]);
        let solved = matrix.cholesky().map(|of| of.solve(&nalgebra::Vector3::from(right)));
        let [across, slope, bend] = match solved {
            Some(of) => [of[0], of[1] / farthest, 2.0 * of[2] / (farthest * farthest)],
            None => [0.0; 3],
        };
        (Local { across, slope, bend, chord }, to - from + 1)
    }
}

/// Returns the distance \[mm\] from its parabola from which on a point is off the curve.
fn lost_from(found: &[Local]) -> f64 {
    LOST_AT * median(found.iter().map(|local| local.across.abs()).collect()).max(NO_NOISE)
}

/// Tells whether a point is off the curve on which its neighbours lie. At a corner they are off as well.
fn has_outlier(found: &[Local]) -> bool {
    let least = lost_from(found);
    let is_off = |local: &Local| local.across.abs() > least;
    let alone =
        |near: &[Local]| is_off(&near[LEAST_BESIDE]) && near.iter().filter(|of| is_off(of)).count() == 1;
    found.windows(2 * LEAST_BESIDE + 1).any(alone)
}

/// Gives marks of a smoothed curve the directions of the parabolas through them and their neighbours. Those of wide windows are off by the
/// square of their width, and the curve through them would be scalloped.
fn redirect(marks: &mut [Mark], unknown: &[bool]) {
    let own: Vec<[f64; 2]> = marks.iter().map(|mark| [mark.station.x, mark.station.z]).collect();
    for k in 1..own.len().saturating_sub(1) {
        let [before, after] = [distance(own[k - 1], own[k]), distance(own[k], own[k + 1])];
        if unknown[k - 1] || unknown[k] || before.min(after) < 0.5 * APART {
            continue;
        }
        let along = |axis: usize| {
            let slope = |from: usize, length: f64| (own[from + 1][axis] - own[from][axis]) / length;
            after * slope(k - 1, before) + before * slope(k, after)
        };
        let ([x, z], station) = ([along(0), along(1)], &mut marks[k].station);
        let norm = x.hypot(z);
        if norm > 0.0 {
            (station.cos, station.sin) = (x / norm, z / norm);
        }
    }
}

/// Sets marks between those of a smoothed curve, on the cubics through them.
fn dense(marks: &[Mark], unknown: &[bool]) -> (Vec<Mark>, Vec<bool>) {
    let mut out = (Vec::new(), Vec::new());
    for (k, pair) in marks.windows(2).enumerate() {
        let [a, b] = [&pair[0], &pair[1]];
        let count = if unknown[k] { 1 } else { ((b.s - a.s) / STEP).ceil().max(1.0) as usize };
        for j in 0..count {
            let share = j as f64 / count as f64;
            let mix = |a: f64, b: f64| a + share * (b - a);
            let [x, z] = a.between(b, share);
            let (cos, sin) = (mix(a.station.cos, b.station.cos), mix(a.station.sin, b.station.sin));
            let norm = cos.hypot(sin);
            let station = Station { x, z, cos: cos / norm, sin: sin / norm };
            let (s, curvature) = (mix(a.s, b.s), mix(a.curvature, b.curvature));
            out.0.push(Mark { s, station, curvature, segment: 0 });
            out.1.push(unknown[k]);
        }
    }
    out.0.extend(marks.last());
    out.1.extend(unknown.last());
    out
}

/// Tells whether the path turns by more than a right angle at the middle one of three points.
fn turns_back(three: &[[f64; 2]]) -> bool {
    let [a, b, c] = [three[0], three[1], three[2]];
    (b[0] - a[0]) * (c[0] - b[0]) + (b[1] - a[1]) * (c[1] - b[1]) < 0.0
}

/// Tells whether the way from one station to another is against the directions of both.
fn is_behind(from: &Station, to: &Station) -> bool {
    let along = |of: &Station| (to.x - from.x) * of.cos + (to.z - from.z) * of.sin;
    along(from) < 0.0 && along(to) < 0.0
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (b[0] - a[0]).hypot(b[1] - a[1])
}

fn median(values: Vec<f64>) -> f64 {
    quantile(values, 0.5)
}

/// Returns the value below which this share of the values lies; 0 without any.
pub(super) fn quantile(mut values: Vec<f64>, share: f64) -> f64 {
    let at = (share * values.len() as f64) as usize;
    if at >= values.len() {
        return 0.0;
    }
    *values.select_nth_unstable_by(at, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measured::{CurveKind, Options, of_points};
    use crate::profile::Side;

    #[test]
    fn smoothed_curves_stay_by_their_points_where_a_ledge_is() -> crate::error::Result<()> {
        for rough in 6..20 {
            for depth in [0.05, 0.1, 0.2, 0.3] {
                let mut deviates = Deviates::new(rough as u64, 1);
                let height = |k: usize| {
                    let x = 0.2 * k as f64 - 30.0;
                    // A ledge over a few points with noise of 0.4 µm.
                    let ledge = if (200..200 + rough).contains(&k) { depth } else { 0.0 };
                    [x, 4e-4 * deviates.draw() + ledge - 0.005 * x * x]
                };
                let options = Options {
                    mirror: Some(false),
                    flip_z: Some(false),
                    curve: Some(CurveKind::Interpolation),
                    ..Options::default()
                };
                let points: Vec<[f64; 2]> = (0..300).map(height).collect();
                let profile = of_points("rough", &points, Side::Rail, &options)?.profile;
                let Some((marks, _)) = NoisyPoints::new(&profile).smoothed() else { continue };
                assert!(marks.len() < 3000, "{rough} {depth}: {}", marks.len());
                let near = |mark: &Mark| {
                    points.iter().any(|&at| distance(at, [mark.station.x, mark.station.z]) < 0.5)
                };
                assert!(marks.iter().all(near), "{rough} {depth}");
            }
        }
        Ok(())
    }
}

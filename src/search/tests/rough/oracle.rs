//! The oracle lowers rings. At an abscissa X of the rail every ring of the wheel has a height in closed form.
//! The gap is the lowest height over dense samples of the wheel's profile, less the rail's height. Its local
//! minima over dense X are refined by zooming in.

use super::pairs::Pair3;
use super::{Section, Side, WITHIN};
use crate::numerics::interval::Interval;

/// Largest height of a sample of the wheel over the lowest ring beside it \[mm\]: half a step at a noise's
/// slope.
const COARSE: f64 = 1e-2;

/// Distance of the abscissae of a first pass \[mm\].
const COARSE_STEP: f64 = 0.1;
/// Largest fall of the gap between two abscissae of a first pass \[mm\]: noise, a flank of 60° over the step,
/// and the near misses that are asked for.
const COARSE_MARGIN: f64 = 0.35;

/// The oracle, which finds the gap by rings.
pub(super) struct Oracle {
    pub(super) rail: Section,
    wheel: Section,
    radius: f64,
    pose: [f64; 3],
    /// Sines and cosines of yaw and roll.
    turns: [(f64, f64); 2],
    /// Samples of the wheel's profile, in order of x.
    samples: Vec<[f64; 2]>,
}

impl Oracle {
    /// Returns the gap over the rail's abscissa X of the ring of the wheel's profile point (x, z); infinite
    /// if the ring does not reach X.
    fn gap(&self, [x, z]: [f64; 2], at: f64, rail: f64) -> f64 {
        let [offset, yaw, _] = self.pose;
        let (rolling, [(sy, cy), (sr, cr)]) = (self.radius - z, self.turns);
        // X = offset + (x cosψ − ϱ sinω sinψ) cosφ + (R − ϱ cosω) sinφ: a sinω + b cosω = c.
        let (a, b) = (-rolling * sy * cr, -rolling * sr);
        let c = at - offset - x * cy * cr - self.radius * sr;
        let height = |omega_sin: f64, omega_cos: f64| {
            let across = x * cy - rolling * omega_sin * sy;
            (self.radius - rolling * omega_cos) * cr - across * sr
        };
        let length = a.hypot(b);
        if yaw == 0.0 {
            // Except for the roll, the whole ring is at one abscissa; its lowest point counts, and the caller
            // checks X.
            return f64::NAN;
        }
        if c.abs() > length {
            return f64::INFINITY;
        }
        let root = ((length - c) * (length + c)).max(0.0).sqrt();
        let on_side = |sign: f64| {
            let s = (a * c + sign * b * root) / (length * length);
            let k = (b * c - sign * a * root) / (length * length);
            height(s, k)
        };
        on_side(1.0).min(on_side(-1.0)) - rail
    }

    /// Returns the wheel's height over an abscissa between two samples without yaw, where its profile is a
    /// curve in the rail's axes: by bisection along x.
    fn unyawed(&self, at: f64, samples: [[f64; 2]; 2]) -> f64 {
        let [offset, _, roll] = self.pose;
        let [low, high] = samples.map(|[x, _]| x);
        let place = |x: f64| {
            // At a step each side has its own height.
            let own = samples.into_iter().find(|sample| sample[0] == x);
            let z = own.map_or_else(|| self.wheel.height(x), |[_, z]| z);
            [offset + x * roll.cos() + z * roll.sin(), z * roll.cos() - x * roll.sin()]
        };
        let (mut a, mut b) = (low, high);
        let ends = [place(a), place(b)];
        let around = (ends[0][0] - at) * (ends[1][0] - at);
        if around.is_nan() || around > 0.0 {
            return f64::INFINITY;
        }
        if roll == 0.0 {
            return place(at - offset)[1];
        }
        for _ in 0..200 {
            let middle = a + (b - a) / 2.0;
            if middle <= a || middle >= b {
                break;
            }
            if (place(middle)[0] > at) == (ends[1][0] > ends[0][0]) { b = middle } else { a = middle }
        }
        // At a jump of the surface, behind what overhangs, the two heights are at two abscissae.
        let [x, z] = place(a);
        if (x - at).abs() < 1e-9 { z } else { f64::INFINITY }
    }

    /// Returns the gap over X of the lowest ring between samples `from` and `to`, with the abscissa of that
    /// ring.
    pub(super) fn lowest(&self, at: f64, [from, to]: [usize; 2], zooms: u32) -> [f64; 2] {
        let rail = self.rail.height(at);
        let mut best = [f64::INFINITY, f64::NAN];
        if rail.is_nan() {
            return best;
        }
        if self.pose[1] == 0.0 {
            for k in from..to.min(self.samples.len() - 1) {
                let cell = [self.samples[k], self.samples[k + 1]];
                let gap = self.unyawed(at, cell) - rail;
                if gap < best[0] {
                    best = [gap, cell[0][0]];
                }
            }
            return best;
        }
        let to = to.min(self.samples.len() - 1);
        // A ring rises over its profile point by at least u²/2ϱ sin²ψ; u is its distance along x except for
        // the roll.
        let [offset, yaw, roll] = self.pose;
        let rise = 0.5 / ((self.radius + 40.0) * yaw.sin().powi(2));
        // The ring beside X is among the lowest, so that most others need no closed form.
        let beside = self.samples[from..to].partition_point(|[x, _]| *x < at - offset) + from;
        let mut coarse_so_far = self.gap(self.samples[beside], at, rail);
        let quick = |sample: &[f64; 2]| {
            let [x, z] = *sample;
            let u = ((x * yaw.cos() - (at - offset)).abs() - 60.0 * roll.abs()).max(0.0);
            z - x * roll.sin() + 0.9 * rise * u * u - 0.05 - rail
        };
        let mut gaps = Vec::with_capacity(to + 1 - from);
        for sample in &self.samples[from..=to] {
            let gap = if quick(sample) > coarse_so_far + COARSE {
                f64::INFINITY
            } else {
                self.gap(*sample, at, rail)
            };
            coarse_so_far = coarse_so_far.min(gap);
            gaps.push(gap);
        }
        let coarse = gaps.iter().copied().fold(f64::INFINITY, f64::min);
        for k in 0..gaps.len() {
            let (a, b) = (k.saturating_sub(1), (k + 1).min(gaps.len() - 1));
            if gaps[k] <= gaps[a] && gaps[k] <= gaps[b] && gaps[k] <= coarse + COARSE {
                let cell = Interval::new(self.samples[from + a][0], self.samples[from + b][0]);
                let found = self.ring_between(at, rail, cell, zooms);
                if found[0] < best[0] {
                    best = found;
                }
            }
        }
        best
    }

    /// Returns the lowest gap of the rings between two abscissae of the wheel's profile, with the abscissa of
    /// the ring.
    fn ring_between(&self, at: f64, rail: f64, mut cell: Interval, zooms: u32) -> [f64; 2] {
        let ends = cell;
        let ring = |x: f64| [self.gap([x, self.wheel.height(x)], at, rail), x];
        // The ends of every narrower cell are among the rings that are known.
        let mut best = ends.ends().map(ring).into_iter().fold([f64::INFINITY, cell.low], lower);
        for _ in 0..zooms {
            let step = cell.width() / 8.0;
            best = (1..8).map(|k| ring(cell.low + step * f64::from(k))).fold(best, lower);
            cell = Interval::of(best[1]).grown(step).cut(ends);
        }
        best
    }

    pub(super) fn new(pair: &Pair3, radius: f64, step: f64) -> Self {
        let wheel = Section::own_axes(&pair.wheel, Side::Wheel);
        let samples = samples(&wheel, step);
        let [_, yaw, roll] = pair.pose;
        let turns = [yaw.sin_cos(), roll.sin_cos()];
        Self {
            rail: Section::own_axes(&pair.rail, Side::Rail),
            wheel,
            radius,
            pose: pair.pose,
            turns,
            samples,
        }
    }

    /// Returns the samples whose rings may be lowest at X: without yaw those beside X, with yaw as far as a
    /// ring's slope allows.
    pub(super) fn near(&self, at: f64) -> [usize; 2] {
        let [offset, yaw, roll] = self.pose;
        // tanφ up to 8, that is 83°; the roll shifts by heights of 40 mm.
        let reach = 8.0 * self.radius * yaw.tan() * yaw.sin().abs() * yaw.signum() + 40.0 * roll.abs() + 0.2;
        let x = at - offset;
        let first = self.samples.partition_point(|s| s[0] < x - reach);
        let last = self.samples.partition_point(|s| s[0] <= x + reach);
        [first.saturating_sub(1), last]
    }

    /// Returns abscissae of the rail that resolve every bump of either body; bumps of a yawed wheel are wider
    /// than a step.
    fn abscissae(&self, step: f64) -> Vec<f64> {
        let mut all: Vec<f64> = samples(&self.rail, step).iter().map(|s| s[0]).collect();
        let [offset, yaw, roll] = self.pose;
        if let Some(reach) = self.rail.reach().filter(|_| yaw == 0.0) {
            let placed = self.samples.iter().map(|[x, z]| offset + x * roll.cos() + z * roll.sin());
            all.extend(placed.filter(|x| reach.contains(*x)));
        }
        all.sort_by(f64::total_cmp);
        // Both ends of a joint differ by rounding; the gap would have a minimum between them.
        all.dedup_by(|b, a| *b - *a < 1e-7);
        all
    }

    /// Returns all local minima of the gap up to `within` above the lowest, as \[gap, X\].
    pub(super) fn minima(&self, step: f64) -> Vec<[f64; 2]> {
        let x = self.abscissae(step);
        // A coarse pass leaves out what is too high for noise and the slope of a step.
        let stride = (COARSE_STEP / step).ceil() as usize;
        let rough: Vec<f64> =
            x.iter().step_by(stride).map(|&at| self.lowest(at, self.near(at), 1)[0]).collect();
        let least = rough.iter().copied().fold(f64::INFINITY, f64::min);
        let hopeful = |k: usize| {
            let cell = k / stride;
            let ends = [cell.saturating_sub(1), cell, cell + 1, cell + 2];
            ends.into_iter().filter_map(|i| rough.get(i)).any(|&gap| gap <= least + COARSE_MARGIN)
        };
        let gap =
            |k: usize| if hopeful(k) { self.lowest(x[k], self.near(x[k]), 1)[0] } else { f64::INFINITY };
        let gaps: Vec<f64> = (0..x.len()).map(gap).collect();
        let lowest = gaps.iter().copied().fold(f64::INFINITY, f64::min);
        let mut out: Vec<[f64; 2]> = Vec::new();
        for k in 0..x.len() {
            let (a, b) = (k.saturating_sub(1), (k + 1).min(x.len() - 1));
            // A sample is above its minimum by at most a noise's slope times the step.
            let low = gaps[k] <= gaps[a] && gaps[k] <= gaps[b] && gaps[k] <= lowest + WITHIN + 1e-2;
            if low && gaps[k].is_finite() {
                out.extend(self.zoomed(
                    Interval::new(x[a.saturating_sub(1)], x[(b + 1).min(x.len() - 1)]),
                    Interval::new(x[0], x[x.len() - 1]),
                ));
            }
        }
        let lowest = out.iter().map(|m| m[0]).fold(f64::INFINITY, f64::min);
        out.retain(|m| m[0] <= lowest + WITHIN);
        out
    }

    /// Returns the least gap between two abscissae, as \[gap, X\]; `None` if it is at one of them, unless
    /// that is an end of the rail.
    fn zoomed(&self, whole: Interval, rail: Interval) -> Option<[f64; 2]> {
        let gap = |at: f64| [self.lowest(at, self.near(at), 9)[0], at];
        // The ends of every narrower cell are among the gaps that are known.
        let (mut cell, mut best) =
            (whole, whole.ends().map(gap).into_iter().fold([f64::INFINITY, whole.low], lower));
        for _ in 0..17 {
            let step = cell.width() / 6.0;
            best = (1..6).map(|k| gap(cell.low + step * f64::from(k))).fold(best, lower);
            cell = Interval::of(best[1]).grown(step).cut(whole);
        }
        let edge = 1e-6 * whole.width();
        let inside = |end: f64, of_rail: f64| (best[1] - end).abs() > edge || end == of_rail;
        (inside(whole.low, rail.low) && inside(whole.high, rail.high)).then_some(best)
    }
}

/// Returns the one of two gaps, with their places, that is lower; the first one of equal ones.
fn lower(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    if b[0] < a[0] { b } else { a }
}

/// Returns points of the outer surface every `step` mm along it, with the ends of all pieces.
fn samples(section: &Section, step: f64) -> Vec<[f64; 2]> {
    let mut out: Vec<[f64; 2]> = Vec::new();
    for piece in &section.pieces {
        let branch = &section.branches[piece.branch];
        let [a, b] = piece.xi.ends();
        let length = (b - a).hypot(piece.heights[1] - piece.heights[0]);
        let n = (length / step).ceil().clamp(4.0, 64.0);
        out.extend((0..=n as u32).map(|k| {
            let x = (a + (b - a) * f64::from(k) / n).min(b);
            [x, branch.height(x)]
        }));
    }
    out
}

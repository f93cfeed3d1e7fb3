//! Finds the intervals of ξ over which s along a valley or ridge only rises or only falls.

use super::path::Leg;
use super::valleys::Valleys;
use crate::numerics::roots::bracketed;
use crate::profile::{Branch, Section};

/// Number of intervals of a stretch between two joints. The slope of s is computed at their ends.
///
/// The slopes of two arcs agree at one place at most, those of two cubics at two places. Two places in different intervals
/// are found by a change of sign; two in one interval are found by the least |slope|.
const INTERVALS: usize = 4;

/// Factor by which the slope inside a stretch may exceed the slopes at its ends. Arcs are steepest at their ends; a cubic
/// of a smooth profile turns too little between two joints to exceed it.
const STEEPER: f64 = 2.0;

/// Least value of the parabola through three slopes, as a share of the smallest |slope|, from which no root is sought: the
/// slopes then stay away from 0.
const NEAR_ROOT: f64 = 0.5;

/// Steps of the golden section, which leave 1e-6 of an interval.
const GOLDEN_STEPS: usize = 30;

/// The golden section (√5 − 1)/2.
const GOLDEN: f64 = 0.618_033_988_749_894_8;

/// s and its slope at one place of a valley or ridge.
#[derive(Debug, Clone, Copy)]
struct ValleySample {
    /// Profile abscissa \[mm\], or t on a circle.
    at: f64,
    xi: f64,
    /// s \[mm\], to the rounding of both bodies' heights.
    gap: f64,
    /// ds/dξ along the valley or ridge.
    slope: f64,
}

/// One leg over one branch of the rail.
struct RailStretch<'v> {
    valleys: &'v Valleys<'v>,
    leg: &'v Leg,
    rail: &'v Branch,
}

/// Appends the intervals of ξ \[mm\], in order, over which s along a valley or ridge is monotone inside a given range. They
/// end at joints of both bodies and where s turns. A stretch between joints is left out if `matters` is false for bounds of
/// its least and largest s.
///
/// Method: the slope of the surface where it is parallel to η less the slope of the rail, in closed form, at a few places
/// of every stretch. Two turns inside a quarter of a stretch are missed if |slope| shows no minimum there; s changes
/// between them by less than that slope × their distance. Cost: two places for a stretch that does not matter; five places
/// and a root for each turn for any other.
pub(crate) fn monotone(
    valleys: &Valleys<'_>,
    rail: &Section,
    crease: usize,
    [from, to]: [f64; 2],
    matters: impl Fn([f64; 2]) -> bool,
    intervals: &mut Vec<[f64; 2]>,
) {
    let mut turns = Vec::new();
    for leg in &valleys.creases[crease].legs {
        let (a, b) = (leg.xi[0].max(from), leg.xi[1].min(to));
        if a >= b {
            continue;
        }
        let mut left = a;
        let inside = |xi: &f64| a < *xi && *xi < b;
        let joints = rail.joints([a, b]).map(|(xi, _)| xi).filter(inside);
        for right in joints.chain([b]) {
            let branch = rail.branch_at(left + (right - left) / 2.0).filter(|_| right > left);
            let stretch = branch.map(|rail| RailStretch { valleys, leg, rail });
            turns.clear();
            if stretch.is_some_and(|stretch| stretch.turns([left, right], &matters, &mut turns)) {
                turns.retain(|turn| left < *turn && *turn < right);
                turns.sort_by(f64::total_cmp);
                for &turn in turns.iter().chain([&right]) {
                    intervals.push([left, turn]);
                    left = turn;
                }
            }
            left = right;
        }
    }
}

impl RailStretch<'_> {
    /// Returns whether the stretch matters; if it does, appends the ξ inside it at which s turns.
    fn turns(&self, xi: [f64; 2], matters: &impl Fn([f64; 2]) -> bool, turns: &mut Vec<f64>) -> bool {
        let ends = xi.map(|xi| self.sample(self.place_at(xi)));
        let steepest = ends[0].slope.abs().max(ends[1].slope.abs());
        let reach = STEEPER * steepest * (ends[1].xi - ends[0].xi);
        let [low, high] = [ends[0].gap.min(ends[1].gap), ends[0].gap.max(ends[1].gap)];
        // A slope of NaN decides nothing.
        if !reach.is_nan() && !matters([low - reach, high + reach]) {
            return false;
        }
        let between = |k: usize| {
            let share = k as f64 / INTERVALS as f64;
            ends[0].at + (ends[1].at - ends[0].at) * share
        };
        let mut samples = [ends[0]; INTERVALS + 1];
        for (k, sample) in samples.iter_mut().enumerate().take(INTERVALS).skip(1) {
            *sample = self.sample(between(k));
        }
        samples[INTERVALS] = ends[1];
        for pair in samples.windows(2) {
            self.root(pair[0].at, pair[1].at, turns);
        }
        for three in samples.windows(3) {
            self.hidden_roots([three[0], three[1], three[2]], turns);
        }
        true
    }

    /// Appends the ξ at which the slope changes sign between a and b, if it does.
    fn root(&self, a: f64, b: f64, turns: &mut Vec<f64>) {
        let root = bracketed(|at| self.sample(at).slope, a, b);
        turns.extend(root.map(|at| self.sample(at).xi));
    }

    /// Appends the two ξ at which the slope changes sign around the least |slope|, if it does.
    fn hidden_roots(&self, [before, here, after]: [ValleySample; 3], turns: &mut Vec<f64>) {
        let sign = here.slope.signum();
        let [p, q, r] = [before, here, after].map(|sample| sign * sample.slope);
        // All three slopes have one sign, and the middle one is nearest to 0. The parabola through them comes still nearer.
        let dips = p > q && r > q && q > 0.0;
        if !dips || q - (r - p) * (r - p) / (8.0 * (p - 2.0 * q + r)) > NEAR_ROOT * q {
            return;
        }
        let value = |at: f64| sign * self.sample(at).slope;
        let (mut a, mut b) = (before.at, after.at);
        let [mut c, mut d] = [b - GOLDEN * (b - a), a + GOLDEN * (b - a)];
        let (mut at_c, mut at_d) = (value(c), value(d));
        for _ in 0..GOLDEN_STEPS {
            let (least, at) = if at_c < at_d { (at_c, c) } else { (at_d, d) };
            if least <= 0.0 {
                self.root(before.at, at, turns);
                self.root(at, after.at, turns);
                return;
            }
            if at_c < at_d {
                (b, d, at_d) = (d, c, at_c);
                c = b - GOLDEN * (b - a);
                at_c = value(c);
            } else {
                (a, c, at_c) = (c, d, at_d);
                d = a + GOLDEN * (b - a);
                at_d = value(d);
            }
        }
    }

    /// Returns the parameter of the leg at ξ.
    fn place_at(&self, xi: f64) -> f64 {
        let leg = self.leg;
        if xi == leg.xi[0] {
            return leg.range[0];
        }
        if xi == leg.xi[1] {
            return leg.range[1];
        }
        match leg.piece {
            Some(piece) => self.valleys.abscissa(piece, leg.range, xi),
            None => self.valleys.turn(leg, xi),
        }
    }

    fn sample(&self, at: f64) -> ValleySample {
        let turned = &self.valleys.turned;
        let (circle, t, slope) = match self.leg.piece {
            Some(piece) => {
                let parallel = turned.parallel_with_slope(piece, at);
                (parallel.circle, parallel.t, parallel.slope)
            }
            None => (self.leg.circle, at, turned.slope(at)),
        };
        let xi = turned.place(&circle, t).xi;
        let gap = turned.height(&circle, t) - self.rail.height(xi);
        ValleySample { at, xi, gap, slope: slope - self.rail.chord_slope(xi, xi) }
    }
}

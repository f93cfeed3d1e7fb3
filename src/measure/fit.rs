//! Fits a measured curve to parts of a nominal one: the rigid motion with the least squares of distances.

use nalgebra::{Matrix3, Vector3};

use super::curve::MarkedCurve;
use super::smooth::quantile;
use crate::numerics::interval::Interval;
use crate::profile::{Beside, Mark, Station, beside};

/// Farthest distance \[mm\] of a place that belongs to a part of the nominal. It is more than a start is off, and less than the
/// distance of another part of the profile.
const FARTHEST: f64 = 6.0;
/// Least cosine between the tangents of a place and its foot: the other face of a flange or head does not count.
const ALONG: f64 = 0.7;
/// Length \[mm\] by which a turn counts as a motion, and root mean square of the distances \[mm\] that the worst motion by 1 mm
/// has to make. A straight face alone makes none along itself.
const ARM: f64 = 10.0;
const LEAST_HOLD: f64 = 0.03;
/// Largest number of passes until a motion is settled: each one leaves the square of the last one's error, or a tenth where the feet slide.
const MOST_PASSES: usize = 200;
/// Motion \[mm\] at which a fit is settled, a ten-thousandth of the instrument's resolution; in the second half of the passes
/// [`CHOSEN`] is enough, and each pass makes a smaller share of its motion: feet that jump between the marks of a nominal, and places that
/// lose and gain weight, may move it to and fro for ever, about its mean.
const SETTLED: f64 = 1e-6;
/// Smallest and largest distance \[mm\] up to which a place fits, between which it is three times the root mean square.
pub(super) const FITS: Interval = Interval::new(0.005, 0.1);
/// Number of windows of half of the places from which the fit of most of them starts.
const WINDOWS: usize = 11;
/// Share of the places that have to fit, whose largest distance is the scale of a fit of most of them; and the distance in scales at
/// which a place loses its weight: two deviations of noise if all places fit, five if half of them do.
const FITTING: f64 = 0.4;
const LOST_AT: f64 = 4.0;
/// Share of the last scale from which on a scale has settled, and most scales.
const SETTLES: f64 = 0.99;
const MOST_SCALES: usize = 20;
/// What parts that do not hold the profile are told of.
const FREE: &str = "what is measured of it leaves the profile free to move";
/// Motion \[mm\] below which the places that belong to a part stay chosen, a tenth of the instrument's resolution: at a part's end
/// a place may belong to it after one pass and not after the next, for ever.
const CHOSEN: f64 = 1e-3;

/// A fit of a measured curve to a nominal one.
pub(super) struct NominalFit<'a> {
    pub measured: &'a MarkedCurve,
    pub nominal: &'a MarkedCurve,
    /// Whether each mark of the nominal belongs to a part that is fitted.
    pub parts: &'a [bool],
    /// Share of the parts' length over which places have to be found.
    pub least_part: f64,
}

/// A motion and how well it fits.
#[derive(Debug, Clone, Copy)]
pub(super) struct FittedMotion {
    pub motion: Station,
    /// Root mean square of the distances \[mm\].
    pub rms: f64,
    /// Length of the measured curve that is fitted \[mm\].
    pub length: f64,
    /// Length of what is measured near the parts \[mm\].
    pub near: f64,
    /// Length \[mm\] of the part of `near` that does not fit and lies above the nominal: outside of a rail, inside of a wheel.
    pub above: f64,
}

/// A place of the measured curve beside its foot on the nominal one.
struct PointAndFoot {
    measured: usize,
    at: [f64; 2],
    normal: [f64; 2],
    across: f64,
    length: f64,
    weight: f64,
}

impl NominalFit<'_> {
    /// Finds the motion that fits the parts, from a first guess.
    ///
    /// # Errors
    /// Parts that are not measured, that leave a motion free, or at which the fit does not settle; the text says which.
    pub fn of_parts(&self, start: Station) -> Result<FittedMotion, String> {
        let own: f64 =
            self.nominal.lengths().zip(self.parts).filter(|(_, part)| **part).map(|(l, _)| l).sum();
        if own == 0.0 {
            return Err("the nominal has none of it: give one that has, or another alignment".into());
        }
        let all = self.settled(start, self.near_parts(), f64::INFINITY)?;
        if all.near < self.least_part * own {
            return Err(format!("{:.1} mm of its {own:.1} mm are measured", all.near.min(own)));
        }
        Ok(all)
    }

    /// Finds the motion from which half of the places near the parts are off the least: the others may be off as far as they like.
    ///
    /// Method: Tukey's biweight with the scale of the median distance, from all places and from windows of half of them, of which one
    /// may be free of others.
    ///
    /// # Errors
    /// Places that leave a motion free.
    pub fn of_most(&self, all: FittedMotion) -> Result<FittedMotion, String> {
        let near = self.near_parts();
        // All its motions lie near the first one, and their feet beside its feet.
        let mut feet = Vec::new();
        let own = self.pairs(&all.motion, &mut feet, &near, None, f64::INFINITY);
        let half = own.len() / 2;
        let windows = (0..WINDOWS).map(|k| k * (own.len() - half) / (WINDOWS - 1));
        let windows =
            windows.filter_map(|from| Some([own.get(from)?.measured, own.get(from + half)?.measured]));
        let of_window = |[from, to]: [usize; 2]| {
            let inside = |k: usize, foot: &Beside| (from..=to).contains(&k) && near(k, foot);
            self.settled_from(all.motion, feet.clone(), inside, f64::INFINITY)
        };
        let starts = [Ok(all)].into_iter().chain(windows.map(of_window));
        let best = starts.flatten().filter_map(|start| self.of_half(start, &feet, &near).ok());
        let best = best.min_by(|a, b| a.1.total_cmp(&b.1));
        best.map(|(found, _)| found).ok_or_else(|| FREE.to_owned())
    }

    /// Tells which places belong to the parts.
    fn near_parts(&self) -> impl Fn(usize, &Beside) -> bool {
        |_, foot| self.parts[foot.mark] && foot.across.abs() <= FARTHEST
    }

    /// Fits by the biweight until the median distance \[mm\] of the places near the parts, which is its scale, stays.
    fn of_half(
        &self,
        start: FittedMotion,
        feet: &[usize],
        near: &impl Fn(usize, &Beside) -> bool,
    ) -> Result<(FittedMotion, f64), String> {
        let scale = |of: &FittedMotion| {
            let pairs = self.pairs(&of.motion, &mut feet.to_vec(), near, None, f64::INFINITY);
            quantile(pairs.iter().map(|pair| pair.across.abs()).collect(), FITTING)
        };
        let (mut found, mut last) = (start, f64::INFINITY);
        for _ in 0..MOST_SCALES {
            let own = scale(&found);
            if own >= SETTLES * last {
                break;
            }
            last = own;
            let fits = (LOST_AT * own).max(FITS.low);
            found = self.settled_from(found.motion, feet.to_vec(), near, fits)?;
        }
        Ok((found, last))
    }

    /// Finds the motion that fits all places near the nominal, from the motion that fits the parts, by Tukey's biweight: a place
    /// weighs the less the farther it is off, and nothing from `fits` \[mm\] on.
    ///
    /// # Errors
    /// Places that leave a motion free, or at which the fit does not settle; the text says which.
    pub fn of_all(&self, of_parts: FittedMotion, fits: f64) -> Result<FittedMotion, String> {
        self.settled(of_parts.motion, |_, foot| foot.across.abs() <= FARTHEST, fits)
    }

    /// Settles a motion, as [`Self::settled_from`] does; its first feet are sought over all marks.
    fn settled(
        &self,
        start: Station,
        belongs: impl Fn(usize, &Beside) -> bool,
        fits: f64,
    ) -> Result<FittedMotion, String> {
        self.settled_from(start, Vec::new(), belongs, fits)
    }

    /// Repeats Gauss and Newton's step until the motion is settled. A place belongs by its mark and its foot; it weighs nothing
    /// from `fits` \[mm\] on.
    fn settled_from(
        &self,
        start: Station,
        mut feet: Vec<usize>,
        belongs: impl Fn(usize, &Beside) -> bool,
        fits: f64,
    ) -> Result<FittedMotion, String> {
        let mut motion = start;
        let mut chosen: Option<Vec<bool>> = None;
        let mut last = f64::INFINITY;
        for pass in 0..MOST_PASSES {
            let pairs = self.pairs(&motion, &mut feet, &belongs, chosen.as_deref(), fits);
            let share = 1.0 / (1 + pass.saturating_sub(MOST_PASSES / 2)) as f64;
            let Some(step) = step(&pairs, share) else {
                return Err(FREE.into());
            };
            let next = motion.placed_by(&step);
            let moved = apart(&motion, &next);
            motion = next;
            last = moved;
            let late = 2 * pass >= MOST_PASSES;
            if chosen.is_none() && (moved <= CHOSEN || late) {
                let mut own = vec![false; self.measured.marks.len()];
                pairs.iter().for_each(|pair| own[pair.measured] = true);
                chosen = Some(own);
            } else if moved <= if late { CHOSEN } else { SETTLED } {
                let pairs = self.pairs(&motion, &mut feet, &belongs, chosen.as_deref(), fits);
                let sum = |of: fn(&PointAndFoot) -> f64| pairs.iter().map(of).sum::<f64>();
                let squares = sum(|pair| pair.weight * pair.across * pair.across);
                let rms = (squares / sum(|pair| pair.weight)).sqrt();
                let length = sum(|pair| if pair.weight > 0.0 { pair.length } else { 0.0 });
                let above =
                    sum(|pair| if pair.weight > 0.0 || pair.across < 0.0 { 0.0 } else { pair.length });
                return Ok(FittedMotion { motion, rms, length, near: sum(|pair| pair.length), above });
            }
        }
        Err(format!(
            "the fit is not settled after {MOST_PASSES} passes: the last one moved it by {last:e} mm"
        ))
    }

    /// Returns the places that belong, under a motion, or those that are chosen. `feet` are those of the last motion; the first search
    /// is over all marks.
    fn pairs(
        &self,
        motion: &Station,
        feet: &mut Vec<usize>,
        belongs: impl Fn(usize, &Beside) -> bool,
        chosen: Option<&[bool]>,
        fits: f64,
    ) -> Vec<PointAndFoot> {
        let nominal = &self.nominal.marks;
        let moved = self.measured.placed(motion);
        if feet.is_empty() {
            feet.extend(moved.marks.iter().map(|mark| nearest(nominal, &mark.station)));
        }
        let mut pairs = Vec::new();
        for (k, (mark, length)) in moved.marks.iter().zip(self.measured.lengths()).enumerate() {
            let station = mark.station;
            let Some(foot) = beside(nominal, [station.x, station.z], feet[k]) else { continue };
            feet[k] = foot.mark;
            let own = nominal[foot.mark].station;
            let along = station.cos * own.cos + station.sin * own.sin;
            let inside = foot.mark > 0 && foot.mark + 1 < nominal.len();
            let chosen = match chosen {
                Some(chosen) => chosen[k],
                None => inside && along >= ALONG && belongs(k, &foot),
            };
            if chosen {
                let at = [station.x, station.z];
                let share = (1.0 - (foot.across / fits).powi(2)).max(0.0).powi(2);
                pairs.push(PointAndFoot {
                    measured: k,
                    at,
                    normal: [-own.sin, own.cos],
                    across: foot.across,
                    length,
                    weight: share * length,
                });
            }
        }
        pairs
    }
}

/// Returns this share of the motion that makes the distances least to first order; `None` if some motion changes none of them.
fn step(pairs: &[PointAndFoot], share: f64) -> Option<Station> {
    let length: f64 = pairs.iter().map(|pair| pair.weight).sum();
    let mean = |k: usize| pairs.iter().map(|pair| pair.weight * pair.at[k]).sum::<f64>() / length;
    let centre = [mean(0), mean(1)];
    let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
    for PointAndFoot { at, normal: [a, b], across, weight, .. } in pairs {
        let turn = b * (at[0] - centre[0]) - a * (at[1] - centre[1]);
        let row = Vector3::new(*a, *b, turn / ARM);
        normal += *weight * row * row.transpose();
        right -= *weight * *across * row;
    }
    let each = normal / length;
    // Without pairs it is NaN, of which there are no eigenvalues.
    if each.iter().any(|value| !value.is_finite()) {
        return None;
    }
    if each.symmetric_eigenvalues().min() < LEAST_HOLD * LEAST_HOLD {
        return None;
    }
    let motion = share * normal.cholesky()?.solve(&right);
    let (sin, cos) = (motion[2] / ARM).sin_cos();
    let [x, z] = centre;
    Some(Station { x: x + motion[0] - (x * cos - z * sin), z: z + motion[1] - (x * sin + z * cos), cos, sin })
}

/// Returns whether two motions are one, within what decides which places belong.
pub(super) fn is_same(a: &FittedMotion, b: &FittedMotion) -> bool {
    apart(&a.motion, &b.motion) < CHOSEN
}

/// Returns how far two motions are apart \[mm\], a turn counted at 100 mm, about the extent of a profile.
fn apart(a: &Station, b: &Station) -> f64 {
    let turn = 100.0 * (a.sin * b.cos - a.cos * b.sin);
    (a.x - b.x).abs().max((a.z - b.z).abs()).max(turn.abs())
}

/// Returns the index of the nearest mark.
fn nearest(marks: &[Mark], to: &Station) -> usize {
    let square = |mark: &Mark| (mark.station.x - to.x).powi(2) + (mark.station.z - to.z).powi(2);
    let best = marks.iter().enumerate().min_by(|(_, a), (_, b)| square(a).total_cmp(&square(b)));
    best.map_or(0, |(k, _)| k)
}

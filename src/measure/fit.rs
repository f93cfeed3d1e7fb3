//! Fits a measured curve to parts of a nominal one: the rigid motion with the least squares of distances.

use nalgebra::{Matrix3, Vector3};

use super::curve::MarkedCurve;
use crate::numerics::interval::Interval;
use crate::profile::{Mark, Station, beside};

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
/// [`CHOSEN`] is enough: feet that jump between the marks of a nominal may move it to and fro by less, for ever.
const SETTLED: f64 = 1e-6;
/// Smallest and largest distance \[mm\] up to which a place fits, between which it is three times the root mean square.
pub(super) const FITS: Interval = Interval::new(0.005, 0.1);
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
        let near = |foot: usize, across: f64| self.parts[foot] && across.abs() <= FARTHEST;
        let fitted = self.settled(start, near, f64::INFINITY)?;
        if fitted.length < self.least_part * own {
            return Err(format!("{:.1} mm of its {own:.1} mm are measured", fitted.length.min(own)));
        }
        Ok(fitted)
    }

    /// Finds the motion that fits all places near the nominal, from the motion that fits the parts, by Tukey's biweight: a place
    /// weighs the less the farther it is off, and nothing from `fits` \[mm\] on.
    ///
    /// # Errors
    /// Places that leave a motion free, or at which the fit does not settle; the text says which.
    pub fn of_all(&self, of_parts: FittedMotion, fits: f64) -> Result<FittedMotion, String> {
        self.settled(of_parts.motion, |_, across| across.abs() <= FARTHEST, fits)
    }

    /// Repeats Gauss and Newton's step until the motion is settled. A place belongs by its foot and its distance; it weighs nothing
    /// from `fits` \[mm\] on.
    fn settled(
        &self,
        start: Station,
        belongs: impl Fn(usize, f64) -> bool,
        fits: f64,
    ) -> Result<FittedMotion, String> {
        let (mut motion, mut feet) = (start, Vec::new());
        let mut chosen: Option<Vec<bool>> = None;
        let mut last = f64::INFINITY;
        for pass in 0..MOST_PASSES {
            let pairs = self.pairs(&motion, &mut feet, &belongs, chosen.as_deref(), fits);
            let Some(step) = step(&pairs) else {
                return Err("what is measured of it leaves the profile free to move".into());
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
                let near = pairs.iter().filter(|pair| pair.weight > 0.0);
                return Ok(FittedMotion { motion, rms, length: near.map(|pair| pair.length).sum() });
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
        belongs: impl Fn(usize, f64) -> bool,
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
                None => inside && along >= ALONG && belongs(foot.mark, foot.across),
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

/// Returns the motion that makes the distances least to first order; `None` if some motion changes none of them.
fn step(pairs: &[PointAndFoot]) -> Option<Station> {
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
    let motion = normal.cholesky()?.solve(&right);
    let (sin, cos) = (motion[2] / ARM).sin_cos();
    let [x, z] = centre;
    Some(Station { x: x + motion[0] - (x * cos - z * sin), z: z + motion[1] - (x * sin + z * cos), cos, sin })
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

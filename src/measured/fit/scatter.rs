//! The noise of measured points, what it leaves of a smoothed curve's curvature, and whether a residual is noise.
//!
//! White noise of deviation σ on points h apart leaves the second derivative of a smoothing spline with a deviation of
//! σ √h (2π)² λ^(−5/2) √(∫ u⁴/(1 + u⁴)² du), λ its cut-off wavelength: the integral over the real line is Γ(5/4) Γ(3/4)/2.

use crate::measured::clean::checks::distance;
use crate::measured::options::CUTOFF_WAVELENGTH;
use crate::measured::read::points::Point;
use crate::measured::shape::reach;

/// (2π)² √(Γ(5/4) Γ(3/4)/2).
const CURVATURE: f64 = 29.42;
/// Width \[mm\] from which on a profile has the size of rails and wheels; what is narrower is a model or a part.
const FULL_WIDTH: f64 = 60.0;
/// Curvature \[1/mm\] of the head of a full-sized rail.
const HEAD: f64 = 1.0 / 300.0;
/// Shares of a head's curvature: an error that does no harm (pressures of heads on treads are off by 1 to 2 %), and one that does.
const HARMLESS: f64 = 0.05;
const HARMFUL: f64 = 0.1;
/// Deviations of a mean of noise that it does not reach.
const SIGNIFICANT: f64 = 5.0;
/// Distance \[mm\] by which smoothing may move the curve of a full-sized profile: 2 % of the approach under a wheel's load, over both bodies.
const MOVED: f64 = 0.001;
/// Distance \[mm\] of a point of a full-sized profile from the cubic through its neighbours that shows that they are too far apart for
/// pressures, the deviations of noise that it exceeds, and the longest step there, as a multiple of the median one: beside longer ones
/// the profile has a gap, or was sampled at equal x on a side face.
const UNRESOLVED: f64 = 0.005;
const OFF_NOISE: f64 = 6.0;
const EVEN: f64 = 2.0;
/// The median of the sizes of normal deviates.
const MEDIAN: f64 = 0.6745;

/// The points of a file as smoothing sees them.
#[derive(Debug, Clone)]
pub(in crate::measured) struct Scatter {
    /// Arc length at each point \[mm\].
    path: Vec<f64>,
    /// Distance of each point but the first and last two from the cubic through its neighbours \[mm\], as a deviation of one point.
    off: Vec<f64>,
    /// Standard deviation of the points across the profile \[mm\].
    pub noise: f64,
    /// Median distance of neighbours \[mm\].
    pub spacing: f64,
    /// Size of the profile, 1 for those of rails and wheels, less for models and parts.
    pub size: f64,
}

impl Scatter {
    /// Finds the noise of points, their spacing, and the size of their profile.
    pub fn of(points: &[Point]) -> Self {
        let mut path = vec![0.0];
        for (k, pair) in points.windows(2).enumerate() {
            path.push(path[k] + distance(&pair[0], &pair[1]));
        }
        let spacing = median(path.windows(2).map(|pair| pair[1] - pair[0]).collect());
        let size = (reach(points).width() / FULL_WIDTH).min(1.0);
        let of_five = |k: usize| off_cubic(&points[k..k + 5], &path[k..k + 5]);
        let off: Vec<f64> = (0..points.len().saturating_sub(4)).map(of_five).collect();
        Self { noise: deviation(off.iter().copied()), spacing, size, path, off }
    }

    /// Returns the customary cut-off wavelength \[mm\] for a profile of this size: the longest that is chosen.
    pub fn longest(&self) -> f64 {
        CUTOFF_WAVELENGTH * self.size
    }

    /// Returns the shortest cut-off wavelength \[mm\] at which noise of this deviation \[mm\] does the curvature no harm.
    pub fn harmless(&self, noise: f64) -> f64 {
        let least = CURVATURE * noise * self.spacing.sqrt() / (HARMLESS * HEAD / self.size);
        least.powf(0.4).max(self.spacing)
    }

    /// Returns the standard deviation \[1/mm\] that the noise leaves of the curvature of a curve smoothed with a cut-off wavelength
    /// \[mm\]; below two spacings it is that of an interpolation.
    pub fn curvature_error(&self, cutoff: f64) -> f64 {
        CURVATURE * self.noise * self.spacing.sqrt() * cutoff.max(2.0 * self.spacing).powf(-2.5)
    }

    /// Tells whether an error of the curvature \[1/mm\] is too large for pressures.
    pub fn is_harmful(&self, error: f64) -> bool {
        error > HARMFUL * HEAD / self.size
    }

    /// Finds where a curve is off the points beyond noise: the middle of the half wavelength with the largest mean distance, and that
    /// mean \[mm\]. `None` if all means are noise, or too small for pressures.
    pub fn shape_taken(&self, residuals: &[f64], cutoff: f64) -> Option<(usize, f64)> {
        let mut sums = vec![0.0];
        sums.extend(residuals.iter().scan(0.0, |sum, r| {
            *sum += r;
            Some(*sum)
        }));
        let mean = |from: usize| {
            let to = self.path.partition_point(|s| *s <= self.path[from] + 0.5 * cutoff).max(from + 1);
            let count = (to - from) as f64;
            let mean = (sums[to] - sums[from]) / count;
            let noise = SIGNIFICANT * self.noise / count.sqrt();
            (mean.abs() > noise.max(MOVED * self.size)).then_some((usize::midpoint(from, to), mean))
        };
        (0..residuals.len()).filter_map(mean).max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
    }

    /// Finds where the points are too far apart to show the shape between them: the point that is farthest from the cubic through its
    /// neighbours beyond noise, and how far \[mm\]. Corners have no such cubic.
    pub fn unresolved(&self, corners: &[usize]) -> Option<(usize, f64)> {
        let least = (UNRESOLVED * self.size).max(OFF_NOISE * self.noise);
        let longest = EVEN * self.spacing;
        let even = |k: usize| self.path[k..k + 5].windows(2).all(|pair| pair[1] - pair[0] <= longest);
        let beside = |k: usize| corners.iter().any(|corner| (k..k + 5).contains(corner));
        let far = self.off.iter().map(|off| off.abs()).enumerate().filter(|(_, off)| *off > least);
        let judged = far.filter(|(k, _)| even(*k) && !beside(*k));
        judged.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(k, off)| (k + 2, off))
    }
}

/// Returns the distance of five points from a cubic across their path, in deviations of one point: their fourth divided difference.
fn off_cubic(points: &[Point], path: &[f64]) -> f64 {
    let weight = |k: usize| {
        let others = path.iter().enumerate().filter(|(j, _)| *j != k);
        others.map(|(_, s)| path[k] - s).product::<f64>().recip()
    };
    let weights: Vec<f64> = (0..points.len()).map(weight).collect();
    let sum = |of: fn(&Point) -> f64| points.iter().zip(&weights).map(|(p, w)| w * of(p)).sum::<f64>();
    let norm = weights.iter().map(|w| w * w).sum::<f64>().sqrt();
    let [u, w] = [points[4].x - points[0].x, points[4].z - points[0].z];
    (sum(|p| p.z) * u - sum(|p| p.x) * w) / (norm * u.hypot(w))
}

/// Returns the standard deviation of normal deviates by the median of their sizes, which what is seldom does not move; 0 without any.
pub(in crate::measured) fn deviation(values: impl Iterator<Item = f64>) -> f64 {
    median(values.map(f64::abs).filter(|value| value.is_finite()).collect()) / MEDIAN
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

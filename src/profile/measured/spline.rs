//! Parametric cubic splines through or near points, in pieces between corners.

use super::checks::distance;
use super::points::Point;
use super::smoothing::{Fit, Smoother, penalty};
use crate::error::Result;
use crate::profile::{Polynomial, Segment, Shape, Station};

/// One piece: C², natural ends, over its own arc length.
///
/// The natural end (curvature 0) costs about κ (λ_c/2π)² there, 2 µm on a 300 mm radius at λ_c = 5 mm, and fades
/// over λ_c: a profile should reach that far beyond what carries load.
#[derive(Debug, Clone)]
pub(super) struct Piece {
    /// Index of its first point among all.
    pub from: usize,
    steps: Vec<f64>,
    x: Fit,
    z: Fit,
}

/// Pieces between `corners` (indices of points); a cut-off wavelength of `None` interpolates.
///
/// At a corner both pieces end in one point: the mean of where each would end alone.
pub(super) fn pieces(points: &[Point], corners: &[usize], cutoff: Option<f64>) -> Vec<Piece> {
    let mut ends = vec![0];
    ends.extend(corners);
    ends.push(points.len() - 1);
    let ranges: Vec<[usize; 2]> = ends.windows(2).map(|pair| [pair[0], pair[1]]).collect();
    let free = ranges.iter().map(|&range| Piece::new(points, range, cutoff, [None, None]));
    let free: Vec<Piece> = free.collect();
    if corners.is_empty() || cutoff.is_none() {
        return free;
    }
    let joints: Vec<[f64; 2]> = free
        .windows(2)
        .map(|pair| {
            let (a, b) = (pair[0].station(pair[0].steps.len()), pair[1].station(0));
            [0.5 * (a.x + b.x), 0.5 * (a.z + b.z)]
        })
        .collect();
    let joint = |k: Option<usize>| k.and_then(|k| joints.get(k).copied());
    let pinned = |(k, &range): (usize, &[usize; 2])| {
        Piece::new(points, range, cutoff, [joint(k.checked_sub(1)), joint(Some(k))])
    };
    ranges.iter().enumerate().map(pinned).collect()
}

impl Piece {
    /// Two passes: over the chords of the points, whose noise makes them too long, then over those of the first
    /// pass.
    fn new(
        points: &[Point],
        [from, to]: [usize; 2],
        cutoff: Option<f64>,
        pins: [Option<[f64; 2]>; 2],
    ) -> Self {
        let points = &points[from..=to];
        let chords = points.windows(2).map(|pair| distance(&pair[0], &pair[1])).collect();
        let first = Self::over(points, from, chords, cutoff, pins);
        if cutoff.is_none() {
            return first;
        }
        let smooth: Vec<[f64; 2]> = (0..points.len())
            .map(|k| {
                let station = first.station(k);
                [station.x, station.z]
            })
            .collect();
        let steps: Vec<f64> =
            smooth.windows(2).map(|pair| (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1])).collect();
        // Smoothing that closes a step has nothing left to measure by.
        if steps.iter().zip(&first.steps).all(|(new, old)| *new > 0.1 * old) {
            Self::over(points, from, steps, cutoff, pins)
        } else {
            first
        }
    }

    fn over(
        points: &[Point],
        from: usize,
        steps: Vec<f64>,
        cutoff: Option<f64>,
        pins: [Option<[f64; 2]>; 2],
    ) -> Self {
        let n = points.len();
        let [mut x, mut z]: [Vec<f64>; 2] =
            [points.iter().map(|p| p.x).collect(), points.iter().map(|p| p.z).collect()];
        let spacing = |k: usize| {
            let (before, after) = (k.checked_sub(1).map_or(0.0, |j| steps[j]), steps.get(k).unwrap_or(&0.0));
            0.5 * (before + after)
        };
        let mut slack: Vec<f64> = (0..n).map(|k| (spacing(k) * points[k].weight).recip()).collect();
        for (k, pin) in [(0, pins[0]), (n - 1, pins[1])] {
            if let Some(pin) = pin {
                (x[k], z[k], slack[k]) = (pin[0], pin[1], 0.0);
            }
        }
        let smoother = Smoother::new(&steps, &slack, cutoff.map_or(0.0, penalty));
        let (x, z) = (smoother.fit(&x), smoother.fit(&z));
        Self { from, x, z, steps }
    }

    /// Number of knots.
    pub fn knots(&self) -> usize {
        self.steps.len() + 1
    }

    /// Point and tangent at a knot.
    pub fn station(&self, k: usize) -> Station {
        let (dx, dz) = (self.x.slope(k, &self.steps), self.z.slope(k, &self.steps));
        let norm = dx.hypot(dz);
        Station { x: self.x.value[k].into(), z: self.z.value[k].into(), cos: dx / norm, sin: dz / norm }
    }

    /// One segment per span, its parameter the arc length from its start.
    pub fn segments(&self) -> Result<Vec<Segment>> {
        let span = |(k, &step): (usize, &f64)| {
            let shape = Polynomial::span(&self.x.cubic(k, step), &self.z.cubic(k, step), [0.0, step])?;
            Ok(Segment { label: String::new(), shape: Shape::Polynomial(shape) })
        };
        self.steps.iter().enumerate().map(span).collect()
    }
}

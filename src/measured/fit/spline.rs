//! Fits parametric cubic splines through points or near them, one piece between two corners.

use super::parabola::Parabola;
use super::smoothing::{CubicSpline, Smoother, penalty};
use crate::error::Result;
use crate::measured::clean::checks::distance;
use crate::measured::read::points::Point;
use crate::profile::{Polynomial, Segment, Shape, Station};

/// Distance of a smoothed curve's knots, as a share of the cut-off wavelength. A cubic through these knots is off by
/// (2π/10)⁴/384 of the amplitude of a wave of that length: 0.2 nm on a 13 mm radius for 5 mm.
const KNOTS: f64 = 0.1;

/// One piece of the curve. It is C² over its own arc length.
///
/// An interpolation has natural ends (curvature 0). A smoothing spline with natural ends would be off there by about κ
/// (λ_c/2π)²: 30 µm on a 20 mm radius at λ_c = 5 mm. It is therefore fitted beyond its ends too, to points on the parabolas
/// that best fit its last λ_c, and cut at its ends.
#[derive(Debug, Clone)]
pub(in crate::measured) struct SplinePiece {
    /// Index of the first point of the piece among all points.
    pub from: usize,
    steps: Vec<f64>,
    x: CubicSpline,
    z: CubicSpline,
}

/// Fits the pieces between `corners`, which are indices of points. A cut-off wavelength of `None` interpolates.
///
/// At a corner both pieces end in one point: the mean of the two points where each piece would end alone.
pub(in crate::measured) fn pieces(
    points: &[Point],
    corners: &[usize],
    cutoff: Option<f64>,
) -> Vec<SplinePiece> {
    let mut ends = vec![0];
    ends.extend(corners);
    ends.push(points.len() - 1);
    let ranges: Vec<[usize; 2]> = ends.windows(2).map(|pair| [pair[0], pair[1]]).collect();
    let free = ranges.iter().map(|&range| SplinePiece::new(points, range, cutoff, [None, None]));
    let free: Vec<SplinePiece> = free.collect();
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
        SplinePiece::new(points, range, cutoff, [joint(k.checked_sub(1)), joint(Some(k))])
    };
    ranges.iter().enumerate().map(pinned).collect()
}

fn chords(at: impl Iterator<Item = [f64; 2]>) -> Vec<f64> {
    let at: Vec<[f64; 2]> = at.collect();
    at.windows(2).map(|pair| (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1])).collect()
}

/// Returns points that continue some points beyond their first one, nearest first. They lie on the parabola that best fits
/// the first `reach` \[mm\], with the same spacing and over the same length. There are none if too few points fix a
/// curvature.
fn beyond(points: impl Iterator<Item = Point>, reach: f64) -> Vec<Point> {
    /// Fewest points for the parabola. It has three unknowns; twice as many points keep noise out of its curvature.
    const LEAST: usize = 6;
    let mut near: Vec<Point> = Vec::new();
    let mut path: Vec<f64> = Vec::new();
    for point in points {
        let walked = match (near.last(), path.last()) {
            (Some(last), Some(walked)) => walked + distance(last, &point),
            _ => 0.0,
        };
        if walked > reach {
            break;
        }
        near.push(point);
        path.push(walked);
    }
    let (Some(&walked), true) = (path.last(), near.len() >= LEAST) else {
        return Vec::new();
    };
    let parabolas = [|p: &Point| p.x, |p: &Point| p.z]
        .map(|of| Parabola::fit(path.iter().copied().zip(near.iter().map(of))));
    let step = walked / (near.len() - 1) as f64;
    let at = |k: usize| {
        let [x, z] = [0, 1].map(|axis| parabolas[axis].value(-step * k as f64));
        Point { x, z, weight: near[0].weight, ..near[0] }
    };
    (1..near.len()).map(at).collect()
}

impl SplinePiece {
    /// Fits the piece, in one pass if it interpolates and in two if it smooths. The first pass uses the chords of the points as arc
    /// length; noise makes them too long. The second pass uses the chords of the first result. Where noise is as large as the
    /// distance of the points, the first result has chords below a tenth of the points' chords, which measure nothing. The first
    /// result is then kept: its arc length is too long, so that its cut-off wavelength is too short by the same factor.
    fn new(
        points: &[Point],
        [from, to]: [usize; 2],
        cutoff: Option<f64>,
        pins: [Option<[f64; 2]>; 2],
    ) -> Self {
        let own = &points[from..=to];
        let Some(cutoff_wavelength) = cutoff else {
            return Self::over(own, from, chords(own.iter().map(Point::xz)), cutoff, pins, [0; 2]);
        };
        let before = beyond(own.iter().copied(), cutoff_wavelength);
        let after = beyond(own.iter().rev().copied(), cutoff_wavelength);
        let extra = [before.len(), after.len()];
        let all: Vec<Point> = before.into_iter().rev().chain(own.iter().copied()).chain(after).collect();
        let first = Self::over(&all, from, chords(all.iter().map(Point::xz)), cutoff, pins, extra);
        let smooth = (0..all.len()).map(|k| [f64::from(first.x.value[k]), f64::from(first.z.value[k])]);
        let steps = chords(smooth);
        let open = steps.iter().zip(&first.steps).all(|(new, old)| *new > 0.1 * old);
        let mut piece = if open { Self::over(&all, from, steps, cutoff, pins, extra) } else { first };
        piece.cut(extra);
        piece
    }

    /// Drops the given numbers of knots at the beginning and at the end.
    fn cut(&mut self, [before, after]: [usize; 2]) {
        self.steps.drain(..before);
        self.steps.truncate(self.steps.len() - after);
        for fit in [&mut self.x, &mut self.z] {
            for values in [&mut fit.value, &mut fit.second] {
                values.drain(..before);
                values.truncate(values.len() - after);
            }
        }
    }

    fn over(
        points: &[Point],
        from: usize,
        steps: Vec<f64>,
        cutoff: Option<f64>,
        pins: [Option<[f64; 2]>; 2],
        extra: [usize; 2],
    ) -> Self {
        let n = points.len();
        let [mut x, mut z]: [Vec<f64>; 2] =
            [points.iter().map(|p| p.x).collect(), points.iter().map(|p| p.z).collect()];
        let spacing = |k: usize| {
            let (before, after) = (k.checked_sub(1).map_or(0.0, |j| steps[j]), steps.get(k).unwrap_or(&0.0));
            0.5 * (before + after)
        };
        let mut slack: Vec<f64> = (0..n).map(|k| (spacing(k) * points[k].weight).recip()).collect();
        for (k, pin) in [(extra[0], pins[0]), (n - 1 - extra[1], pins[1])] {
            if let Some(pin) = pin {
                (x[k], z[k], slack[k]) = (pin[0], pin[1], 0.0);
            }
        }
        let smoother = Smoother::new(&steps, &slack, cutoff.map_or(0.0, penalty));
        let (x, z) = (smoother.fit(&x), smoother.fit(&z));
        Self { from, x, z, steps }
    }

    /// Returns the number of knots.
    pub fn knots(&self) -> usize {
        self.steps.len() + 1
    }

    /// Returns the station at a knot.
    pub fn station(&self, k: usize) -> Station {
        let (dx, dz) = (self.x.slope(k, &self.steps), self.z.slope(k, &self.steps));
        let norm = dx.hypot(dz);
        Station { x: self.x.value[k].into(), z: self.z.value[k].into(), cos: dx / norm, sin: dz / norm }
    }

    /// Returns one segment for each span. Its parameter is the arc length from its start \[mm\].
    ///
    /// A smoothed curve has no detail shorter than its cut-off wavelength. It is therefore moved to knots at least
    /// [`KNOTS`] of that wavelength apart, because thousands of an instrument's points would slow down every later step.
    pub fn segments(&self, cutoff: Option<f64>) -> Result<Vec<Segment>> {
        let thinned = cutoff.map(|wavelength| self.thinned(KNOTS * wavelength));
        let Self { steps, x, z, .. } = thinned.as_ref().unwrap_or(self);
        let span = |(k, &step): (usize, &f64)| {
            let shape = Polynomial::span(&x.cubic(k, step), &z.cubic(k, step), [0.0, step])?;
            Ok(Segment { label: String::new(), shape: Shape::Polynomial(shape) })
        };
        steps.iter().enumerate().map(span).collect()
    }

    /// Returns the spline through the values at knots at least `apart` \[mm\] apart. It has the same curvature at both
    /// ends.
    fn thinned(&self, apart: f64) -> Self {
        let (mut kept, mut steps, mut walked) = (vec![0], Vec::new(), 0.0);
        for (k, step) in self.steps.iter().enumerate() {
            walked += step;
            if walked >= apart || k + 1 == self.steps.len() {
                kept.push(k + 1);
                steps.push(walked);
                walked = 0.0;
            }
        }
        let slack = vec![0.0; kept.len()];
        let smoother = Smoother::new(&steps, &slack, 0.0);
        let [x, z] = [&self.x, &self.z].map(|fit| {
            let values: Vec<f64> = kept.iter().map(|&k| fit.value[k].into()).collect();
            smoother.fit_between(&values, [fit.second[0], fit.second[self.steps.len()]])
        });
        Self { from: self.from, x, z, steps }
    }
}

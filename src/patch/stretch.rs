//! The boundary of a patch between two corners, as interpolants.

use std::ops::Range;

use crate::numerics::chebyshev::{NODES, POINTS, PROOF, coefficients_by_vectors, values, values_and_slopes};
use crate::numerics::interval::Interval;
use crate::numerics::lanes::{Lanes, lanes, largest};
use crate::numerics::noise::measured;

/// Share of the first stretch at which a part is not halved again. What is left beside an unknown corner is below the accuracy of
/// areas.
const SHORTEST: f64 = 1e-7;

/// Most stretches between two corners.
const MOST_STRETCHES: usize = 1024;

/// Number of stretches between two corners from which on the noise of edges is measured, by as many slices as a stretch takes.
const NOISY: usize = 4;

/// Share of the rounding up to which a coefficient is left out: a sixteenth of it, and a margin.
const LEFT_OUT: f64 = 1.0 / 64.0;

/// Largest rounding, as a share of the values, with which coefficients are left out. Where a band is narrow, what counts as the
/// rounding of its middle may be as large as the middle.
const MOST_ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Number of the last coefficients that are compared with as many before them.
const TAIL: usize = 4;

/// Factor by which the last coefficients may be smaller than those before them to count as noise, if they are also below
/// [`LEVEL_SHARE`]. Halving would not make them smaller. Those of a kink fall as slowly, but are larger.
const LEVEL: f64 = 4.0;

/// Largest noise, as a share of the values. Where the wheel ends, edges have more noise than where s = δ.
const LEVEL_SHARE: f64 = 1e-12;

/// Rounding of an edge, in roundings of its size.
const EDGE_ROUNDINGS: f64 = 8.0;

/// Both edges of a band over a range of ξ without a corner.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Stretch {
    /// Range of ξ \[mm\].
    pub(crate) xi: Interval,
    curve: EdgeCurve,
}

/// A sum of Chebyshev polynomials over (−1, 1).
#[derive(Debug, Clone, PartialEq)]
struct EdgeSeries {
    coefficients: Lanes,
    /// Number of coefficients that are not rounding, at least 1.
    count: usize,
}

/// How the edges vary over a stretch.
#[derive(Debug, Clone, PartialEq)]
enum EdgeCurve {
    /// Functions of ξ: the square of half the width, divided by the distance from either end at which the width is zero, and the
    /// middle between the edges.
    Width { zero: [bool; 2], square: EdgeSeries, middle: EdgeSeries },
    /// The edges themselves as functions of the square root of the distance from the first (0) or last (1) ξ.
    Root { from: usize, edges: [EdgeSeries; 2] },
}

/// Fits stretches to the edges of a band.
pub(super) struct StretchFit<F> {
    /// Gives both edges \[mm\] at 16 values of ξ.
    pub(super) edges: F,
    /// Range of ξ of the band \[mm\].
    pub(super) band: Interval,
    /// Whether the width is zero at either end of the band.
    pub(super) zero: [bool; 2],
    /// Whether the edges may be square roots of the distance from either end of the band.
    pub(super) root: [bool; 2],
    /// The least and the largest rounding of the square of half the width \[mm²\] that may be expected. The largest, or what is measured if
    /// that is more, counts where there are more stretches than [`NOISY`].
    pub(super) noise: [f64; 2],
}

impl<F: FnMut(&Lanes) -> [Lanes; 2]> StretchFit<F> {
    /// Appends the stretches between two neighbouring corners.
    ///
    /// Method: the interpolant at 16 Chebyshev points of ξ; if its last coefficients are no rounding, of the square root of the
    /// distance from an end of the band; otherwise the range is halved.
    pub(super) fn add(&mut self, corners: Interval, stretches: &mut Vec<Stretch>) {
        let shortest = SHORTEST * corners.width();
        let first = stretches.len();
        let [least, most] = self.noise;
        let mut waiting = vec![(corners, least)];
        while let Some((xi, noise)) = waiting.pop() {
            let (plain, resolved) = self.over_width(xi, noise);
            let root = (0..2).find(|&end| !resolved && self.root[end] && xi[end] == self.band[end]);
            let rooted = root.map(|end| self.over_root(xi, end, noise)).filter(|(_, resolved)| *resolved);
            let count = stretches.len() + waiting.len() - first;
            let middle = xi.middle();
            let short = xi.width() <= shortest || !xi.surrounds(middle);
            if let Some((stretch, _)) = rooted {
                stretches.push(stretch);
            } else if resolved || short || count > MOST_STRETCHES {
                stretches.push(plain);
            } else {
                let noisy = count > NOISY;
                let more = if noisy { measured(|at| self.squares(at), xi).max(most) } else { 0.0 };
                let noise = noise.max(more);
                waiting.extend(xi.halves().map(|half| (half, noise)).into_iter().rev());
            }
        }
    }

    /// Returns the square of half the width \[mm²\] at every ξ.
    fn squares(&mut self, xi: &Lanes) -> Lanes {
        let [low, high] = (self.edges)(xi);
        lanes(|k| ((high[k] - low[k]) / 2.0).powi(2))
    }

    fn over_width(&mut self, xi: Interval, noise: f64) -> (Stretch, bool) {
        let zero = [0, 1].map(|end| self.zero[end] && xi[end] == self.band[end]);
        let (centre, half) = (xi.middle(), xi.width() / 2.0);
        let nodes = &*NODES;
        let x: Lanes = lanes(|k| centre + half * nodes[k]);
        let [low, high] = (self.edges)(&x);
        let (mut square, mut middle) = ([0.0; POINTS], [0.0; POINTS]);
        let (mut narrowest, mut nearest) = (f64::INFINITY, f64::INFINITY);
        for k in 0..POINTS {
            let (width, [far, _]) = ((high[k] - low[k]) / 2.0, distances(xi, zero, x[k]));
            (narrowest, nearest) = (narrowest.min(width), nearest.min(far));
            (middle[k], square[k]) = (low[k] + width, width * width / far);
        }
        let rounding = rounding(largest(&middle), narrowest, noise);
        let (square, first) = EdgeSeries::new(&square, noise / nearest + moved(&x, &square));
        let (middle, second) = EdgeSeries::new(&middle, rounding + moved(&x, &middle));
        let resolved = first && second;
        let curve = EdgeCurve::Width { zero, square, middle };
        (Stretch { xi, curve }, resolved)
    }

    fn over_root(&mut self, xi: Interval, from: usize, noise: f64) -> (Stretch, bool) {
        let length = xi.width();
        let nodes = &*NODES;
        let away = |k: usize| length * ((1.0 + nodes[k]) / 2.0).powi(2);
        let x: Lanes = lanes(|k| if from == 0 { xi.low + away(k) } else { xi.high - away(k) });
        let [low, high] = (self.edges)(&x);
        let narrowest = (0..POINTS).map(|k| (high[k] - low[k]) / 2.0).fold(f64::INFINITY, f64::min);
        let rounding = rounding(largest(&low).max(largest(&high)), narrowest, noise);
        let series = |values: &Lanes| EdgeSeries::new(values, rounding + moved(&x, values));
        let [(low, first), (high, second)] = [series(&low), series(&high)];
        (Stretch { xi, curve: EdgeCurve::Root { from, edges: [low, high] } }, first && second)
    }
}

impl Stretch {
    /// Returns both edges \[mm\] at N values of ξ within the range.
    #[inline(always)]
    pub(crate) fn edges<const N: usize>(&self, xi: &Lanes<N>) -> [Lanes<N>; 2] {
        match &self.curve {
            EdgeCurve::Width { zero, square, middle } => {
                let t: Lanes<N> = lanes(|k| self.parameter(xi[k]));
                let (square, middle) = (square.values(&t), middle.values(&t));
                // Rounding may make the square negative beside a neck.
                let half: Lanes<N> =
                    lanes(|k| (square[k] * distances(self.xi, *zero, xi[k])[0]).max(0.0).sqrt());
                [lanes(|k| middle[k] - half[k]), lanes(|k| middle[k] + half[k])]
            }
            EdgeCurve::Root { from, edges: [low, high] } => {
                let t: Lanes<N> = lanes(|k| 2.0 * self.root(*from, xi[k]) - 1.0);
                [low.values(&t), high.values(&t)]
            }
        }
    }

    /// Returns both edges \[mm\] at N values of ξ within the range, and dη/dξ of both, which is infinite where the width is zero.
    #[inline(always)]
    pub(crate) fn edges_and_slopes<const N: usize>(&self, xi: &Lanes<N>) -> [[Lanes<N>; 2]; 2] {
        let length = self.xi.width();
        match &self.curve {
            EdgeCurve::Width { zero, square, middle } => {
                let t: Lanes<N> = lanes(|k| self.parameter(xi[k]));
                let [square, growth] = square.values_and_slopes(&t);
                let [middle, along] = middle.values_and_slopes(&t);
                let rate = 2.0 / length;
                let [mut half, mut widens] = [[0.0; N]; 2];
                for k in 0..N {
                    let [far, change] = distances(self.xi, *zero, xi[k]);
                    half[k] = (square[k] * far).max(0.0).sqrt();
                    widens[k] = (growth[k] * rate * far + square[k] * change) / (2.0 * half[k]);
                }
                let edges = [lanes(|k| middle[k] - half[k]), lanes(|k| middle[k] + half[k])];
                [edges, [lanes(|k| along[k] * rate - widens[k]), lanes(|k| along[k] * rate + widens[k])]]
            }
            EdgeCurve::Root { from, edges: [low, high] } => {
                let root: Lanes<N> = lanes(|k| self.root(*from, xi[k]));
                let toward = if *from == 0 { 1.0 } else { -1.0 };
                let t: Lanes<N> = lanes(|k| 2.0 * root[k] - 1.0);
                let ([low, fall], [high, rise]) = (low.values_and_slopes(&t), high.values_and_slopes(&t));
                // dt/dξ of t = 2 √(distance/length) − 1.
                let rate: Lanes<N> = lanes(|k| toward / (length * root[k]));
                [[low, high], [lanes(|k| fall[k] * rate[k]), lanes(|k| rise[k] * rate[k])]]
            }
        }
    }

    #[inline(always)]
    fn parameter(&self, xi: f64) -> f64 {
        let [a, b] = self.xi.ends();
        (((xi - a) - (b - xi)) / (b - a)).clamp(-1.0, 1.0)
    }

    /// Returns the square root of the distance from an end as a share of the range.
    #[inline(always)]
    fn root(&self, from: usize, xi: f64) -> f64 {
        ((xi - self.xi[from]) / (self.xi[1 - from] - self.xi[from])).clamp(0.0, 1.0).sqrt()
    }
}

/// Returns the rounding \[mm\] of edges of a size \[mm\], from half the narrowest width \[mm\] and `noise`, the rounding of its square
/// \[mm²\]. Half a width that is nothing but rounding counts as √noise.
fn rounding(size: f64, narrowest: f64, noise: f64) -> f64 {
    EDGE_ROUNDINGS * f64::EPSILON * size + noise / (2.0 * narrowest.max(noise.sqrt()))
}

/// Returns how far the rounding of 16 places may move a coefficient of the series through the values there, in the values' unit.
fn moved(x: &Lanes, values: &Lanes) -> f64 {
    let slopes = (1..POINTS).map(|k| ((values[k] - values[k - 1]) / (x[k] - x[k - 1])).abs());
    // Places that rounding makes one say nothing.
    let sum: f64 = slopes.filter(|slope| slope.is_finite()).sum();
    2.0 / POINTS as f64 * f64::EPSILON * largest(x) * sum
}

/// Returns the product of the distances from the ends with a zero width, and its derivative.
#[inline(always)]
fn distances(Interval { low: a, high: b }: Interval, zero: [bool; 2], xi: f64) -> [f64; 2] {
    match zero {
        [false, false] => [1.0, 0.0],
        [true, false] => [xi - a, 1.0],
        [false, true] => [b - xi, -1.0],
        [true, true] => [(xi - a) * (b - xi), (b - xi) - (xi - a)],
    }
}

impl EdgeSeries {
    /// Interpolates values at the 16 points. Returns the series, and whether its last coefficients are noise, or no larger
    /// than `rounding`.
    fn new(values: &Lanes, rounding: f64) -> (Self, bool) {
        let coefficients = coefficients_by_vectors(values);
        // What is left out is in sum less than the rounding of one value.
        let least = LEFT_OUT * rounding.min(MOST_ROUNDING * largest(values));
        let counts = |c: &f64| c.abs() > least;
        let count = coefficients.iter().rposition(counts).map_or(1, |last| last + 1);
        let sizes = coefficients.map(f64::abs);
        let most = |range: Range<usize>| sizes[range].iter().copied().fold(0.0, f64::max);
        let [before, last] = [most(POINTS - 2 * TAIL..POINTS - TAIL), most(POINTS - TAIL..POINTS)];
        let level = before <= LEVEL * last && last <= LEVEL_SHARE * largest(values);
        let resolved = level || sizes[POINTS - PROOF..].iter().all(|c| *c <= rounding);
        (Self { coefficients, count }, resolved)
    }

    #[inline(always)]
    fn values<const N: usize>(&self, t: &Lanes<N>) -> Lanes<N> {
        if self.count == 1 { [self.coefficients[0]; N] } else { values(&self.coefficients[..self.count], t) }
    }

    #[inline(always)]
    fn values_and_slopes<const N: usize>(&self, t: &Lanes<N>) -> [Lanes<N>; 2] {
        if self.count == 1 {
            [[self.coefficients[0]; N], [0.0; N]]
        } else {
            values_and_slopes(&self.coefficients[..self.count], t)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fitted(
        mut edges: impl FnMut(f64) -> [f64; 2],
        band: Interval,
        zero: [bool; 2],
        root: [bool; 2],
    ) -> Vec<Stretch> {
        let mut stretches = Vec::new();
        let edges = |xi: &Lanes| {
            let both = xi.map(&mut edges);
            [both.map(|edges| edges[0]), both.map(|edges| edges[1])]
        };
        StretchFit { edges, band, zero, root, noise: [8.0 * f64::EPSILON; 2] }.add(band, &mut stretches);
        stretches
    }

    #[test]
    fn an_ellipse_is_one_stretch() {
        let half = |x: f64| ((x + 1.0) * (2.0 - x)).sqrt();
        let found = fitted(
            |x| [0.1 * x - half(x), 0.1 * x + half(x)],
            Interval::new(-1.0, 2.0),
            [true; 2],
            [false; 2],
        );
        let [stretch] = found.as_slice() else { panic!("{}", found.len()) };
        for x in [-1.0, -0.999_999, 0.3, 2.0] {
            let [[[low], [high]], slopes] = stretch.edges_and_slopes(&[x]);
            assert_eq!([[low], [high]], stretch.edges(&[x]));
            assert!(
                (low - 0.1 * x + half(x)).abs() < 1e-14 && (high - 0.1 * x - half(x)).abs() < 1e-14,
                "{x}"
            );
            let slope = 0.1 + (1.0 - 2.0 * x) / (2.0 * half(x));
            assert!(half(x) == 0.0 || (slopes[1][0] / slope - 1.0).abs() < 1e-12, "{x}");
        }
    }

    #[test]
    fn one_edge_may_be_a_root() {
        for from in 0..2 {
            let away = move |x: f64| if from == 0 { x } else { 1.0 - x };
            let edges = move |x: f64| [-1.0 - x, -0.2 * away(x).sqrt() + 0.3 * x];
            let found = fitted(edges, Interval::new(0.0, 1.0), [false; 2], [from == 0, from == 1]);
            assert_eq!(found.len(), 1);
            for x in [0.0, 1e-9, 0.2, 1.0] {
                let [[[low], [high]], _] = found[0].edges_and_slopes(&[x]);
                assert!((low - edges(x)[0]).abs() < 1e-14 && (high - edges(x)[1]).abs() < 1e-14, "{x}");
            }
        }
    }

    /// Where an edge is steep, it moves by the rounding of ξ.
    #[test]
    fn steep_edges_are_one_stretch() {
        let band = Interval::new(20.0, 20.000_001);
        assert_eq!(fitted(|x| [-9.0, 640.0 * (x - 20.0)], band, [false; 2], [false; 2]).len(), 1);
        let root = |x: f64| [-9.0, ((x - 20.0) / 1e-6).sqrt()];
        assert_eq!(fitted(root, band, [false; 2], [true, false]).len(), 1);
    }

    #[test]
    fn a_kink_is_cut_out() {
        let found =
            fitted(|x: f64| [-1.0, 1.0 + (x - 0.3).abs()], Interval::new(0.0, 1.0), [false; 2], [false; 2]);
        let area: f64 = (0..10_000)
            .map(|k| (f64::from(k) + 0.5) / 10_000.0)
            .map(|x| {
                let at = found.partition_point(|stretch| stretch.xi.high < x);
                let [[low], [high]] = found[at].edges(&[x]);
                (high - low) / 10_000.0
            })
            .sum();
        assert!((area - 2.29).abs() < 1e-8 && found.len() < 40, "{area} {}", found.len());
    }
}

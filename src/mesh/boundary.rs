//! The exact boundary of a component as closed curves, sampled finely enough to show every turn and corner.

use nalgebra::{Point2, Vector2};

use crate::numerics::roots::bracketed;
use crate::patch::{Band, BandSide, Component, rings};

/// Samples of a component's boundary before curvature asks for more, on each of its two sides.
const SAMPLES_PER_SIDE: f64 = 64.0;

/// Least number of samples on a part of the boundary between two joints.
const LEAST_SAMPLES: f64 = 2.0;

/// Most samples of a ring. A boundary that asks for more turns at the size of rounding.
const MOST_SAMPLES: usize = 4096;

/// Largest turn \[rad\] between two neighbouring chords of the samples; a larger one that remains is a corner. It is a sixth
/// of the smallest angle of the mesh.
const LARGEST_TURN: f64 = 0.09;

/// Length, as a share of a component's extents, down to which steps beside a turn are halved. A smaller round tip counts as a corner.
const LEAST_STEP: f64 = 1e-6;

/// Distance, as a share of a component's extents, below which two points are one. It is far above rounding and far below
/// [`LEAST_STEP`].
const ONE_POINT: f64 = 1e-10;

/// Steps of the false position to a point's parameter. It is close to linear between samples: each step gains a digit or more.
const PROJECTIONS: usize = 4;

/// A part of a ring with a formula of its own.
#[derive(Debug, Clone, Copy)]
enum BoundaryPart {
    /// A side of a band.
    Side(BandSide),
    /// A straight line of constant ξ, at which a body or the window ends.
    Wall([Point2<f64>; 2]),
}

/// A sample of a ring and the way to the next one.
#[derive(Debug, Clone, Copy)]
pub(super) struct RingSample {
    /// The point (ξ, η) \[mm\].
    pub(super) point: Point2<f64>,
    /// Length of the polygon of the samples up to here \[mm\].
    pub(super) at: f64,
    /// Angle by which the polygon turns to the left here \[rad\].
    pub(super) turn: f64,
    /// The part on which the way to the next sample lies, and the parameters of both.
    part: usize,
    range: [f64; 2],
}

/// One closed curve of a component's boundary, with the patch on its left.
#[derive(Debug)]
pub(super) struct Ring {
    parts: Vec<BoundaryPart>,
    /// The samples in order; the last is followed by the first.
    pub(super) samples: Vec<RingSample>,
    /// Length of the polygon of the samples \[mm\].
    pub(super) length: f64,
}

/// Finds points of a component's boundary.
pub(super) struct BoundaryTracer<'a> {
    bands: &'a [Band],
    /// Half the circumference of the box around the component \[mm\].
    extent: f64,
}

impl<'a> BoundaryTracer<'a> {
    /// Makes the tracer of a component.
    pub(super) fn new(component: &'a Component) -> Self {
        Self { bands: &component.bands, extent: component.xi.width() + component.eta.width() }
    }

    /// Returns all rings of the component.
    pub(super) fn rings(&mut self) -> Vec<Ring> {
        rings(self.bands).into_iter().map(|sides| self.ring(&sides)).collect()
    }

    /// Returns the point of a ring at this length of its polygon. It lies on the exact curve, where the projection on the chord
    /// beside it has about this length: equal steps in length are equal steps along the curve, whatever its parameter does.
    pub(super) fn point(&mut self, ring: &Ring, at: f64) -> Point2<f64> {
        let (k, share) = ring.place(at);
        let sample = &ring.samples[k];
        let ([from, to], chord) = (sample.range, ring.next(k) - sample.point);
        let (mut point, mut low, mut high) = (sample.point, [0.0; 2], [1.0; 2]);
        if share == 0.0 {
            return point;
        }
        for _ in 0..PROJECTIONS {
            let parameter = low[0] + (high[0] - low[0]) * (share - low[1]) / (high[1] - low[1]);
            point = self.on_part(&ring.parts[sample.part], from + (to - from) * parameter);
            let along = (point - sample.point).dot(&chord) / chord.norm_squared();
            *(if along < share { &mut low } else { &mut high }) = [parameter, along];
        }
        point
    }

    /// Returns the place on a ring, before (`sense` −1) or after (1) the place `at`, whose point is at a distance \[mm\] from that of `at`.
    pub(super) fn away(&mut self, ring: &Ring, at: f64, sense: f64, distance: f64) -> f64 {
        let corner = self.point(ring, at);
        let place = |way: f64| (at + sense * way).rem_euclid(ring.length);
        let off = |way: f64| (self.point(ring, place(way)) - corner).norm() - distance;
        // No curve is shorter than its chord, and it is twice as long only where it turns back.
        at + sense * bracketed(off, 0.0, 2.0 * distance).unwrap_or(distance)
    }

    fn ring(&mut self, sides: &[BandSide]) -> Ring {
        let parts = self.parts(sides);
        let mut samples = Vec::new();
        for (part, place) in parts.iter().enumerate() {
            let parameters = self.first_parameters(place);
            for pair in parameters.windows(2) {
                let range = [pair[0], pair[1]];
                let point = self.on_part(place, range[0]);
                samples.push(RingSample { point, at: 0.0, turn: 0.0, part, range });
            }
        }
        let mut ring = Ring { parts, samples, length: 0.0 };
        ring.measure(ONE_POINT * self.extent);
        while ring.samples.len() <= MOST_SAMPLES && self.refine(&mut ring) {
            ring.measure(ONE_POINT * self.extent);
        }
        ring
    }

    /// Returns the parts of a ring: sides of bands, and walls between them.
    fn parts(&mut self, sides: &[BandSide]) -> Vec<BoundaryPart> {
        let mut parts = Vec::new();
        for (k, &side) in sides.iter().enumerate() {
            let before = BoundaryPart::Side(sides[(k + sides.len() - 1) % sides.len()]);
            let [from, to] = [self.on_part(&before, 1.0), self.on_part(&BoundaryPart::Side(side), 0.0)];
            if (to - from).norm() > ONE_POINT * self.extent {
                parts.push(BoundaryPart::Wall([from, to]));
            }
            parts.push(BoundaryPart::Side(side));
        }
        parts
    }

    /// Returns ascending parameters from 0 to 1 of the first samples of a part: every joint is one of them.
    fn first_parameters(&self, part: &BoundaryPart) -> Vec<f64> {
        let BoundaryPart::Side(side) = part else {
            return (0..=SAMPLES_PER_SIDE as u32).map(|k| f64::from(k) / SAMPLES_PER_SIDE).collect();
        };
        let band = &self.bands[side.band];
        let mut parameters = vec![0.0];
        for t in band.pieces() {
            let n = (SAMPLES_PER_SIDE * t.width()).round().max(LEAST_SAMPLES) as usize;
            parameters.extend((1..=n).map(|k| t.step(k, n)));
        }
        if side.branch == 1 {
            parameters.reverse();
            parameters.iter_mut().for_each(|t| *t = 1.0 - *t);
        }
        parameters
    }

    /// Returns the point at a parameter from 0 to 1 of a part, in the sense of the ring.
    fn on_part(&mut self, part: &BoundaryPart, parameter: f64) -> Point2<f64> {
        match part {
            BoundaryPart::Wall([from, to]) => from + (to - from) * parameter,
            BoundaryPart::Side(side) => {
                let band = &self.bands[side.band];
                let t = if side.branch == 0 { parameter } else { 1.0 - parameter };
                let xi = match t {
                    0.0 => band.xi.low,
                    1.0 => band.xi.high,
                    t => band.xi.nearest(band.grading().xi(t)),
                };
                Point2::new(xi, band.slice(xi).eta[side.branch])
            }
        }
    }

    /// Halves the steps beside every turn that is too large, also those along straight walls, because the edge lengths near a
    /// corner are found from the samples. Returns whether any step was halved.
    fn refine(&mut self, ring: &mut Ring) -> bool {
        let n = ring.samples.len();
        let least = LEAST_STEP * self.extent;
        let mut halved = vec![false; n];
        for k in (0..n).filter(|&k| ring.samples[k].turn.abs() > LARGEST_TURN) {
            let beside = [(k + n - 1) % n, k].map(|j| (j, ring.step(j)));
            let longest = beside[0].1.max(beside[1].1);
            for (j, length) in beside {
                halved[j] |= length > least && length > longest / 2.0;
            }
        }
        if !halved.contains(&true) {
            return false;
        }
        let mut samples = Vec::with_capacity(2 * n);
        for (sample, halved) in ring.samples.iter().zip(halved) {
            let [from, to] = sample.range;
            let middle = from + (to - from) / 2.0;
            if halved && middle > from && middle < to {
                let point = self.on_part(&ring.parts[sample.part], middle);
                samples.push(RingSample { range: [from, middle], ..*sample });
                samples.push(RingSample { point, range: [middle, to], ..*sample });
            } else {
                samples.push(*sample);
            }
        }
        let grown = samples.len() > n;
        ring.samples = samples;
        grown
    }
}

impl Ring {
    /// Drops samples that are one with the next, and measures lengths and turns.
    fn measure(&mut self, one_point: f64) {
        let next = |samples: &[RingSample], k: usize| samples[(k + 1) % samples.len()].point;
        let apart = |samples: &[RingSample], k: usize| (next(samples, k) - samples[k].point).norm();
        let all = std::mem::take(&mut self.samples);
        let kept = (0..all.len()).filter(|&k| apart(&all, k) > one_point);
        self.samples = kept.map(|k| all[k]).collect();
        let n = self.samples.len();
        let mut at = 0.0;
        for k in 0..n {
            let [back, on] = [(k + n - 1) % n, k].map(|j| next(&self.samples, j) - self.samples[j].point);
            self.samples[k].at = at;
            self.samples[k].turn = back.perp(&on).atan2(back.dot(&on));
            at += on.norm();
        }
        self.length = at;
    }

    /// Returns the length of the chord from sample `k` to the next \[mm\].
    pub(super) fn step(&self, k: usize) -> f64 {
        self.samples.get(k + 1).map_or(self.length, |next| next.at) - self.samples[k].at
    }

    /// Returns the area that the polygon of the samples encloses \[mm²\], positive if it is counter-clockwise.
    pub(super) fn enclosed(&self) -> f64 {
        let Some(first) = self.samples.first().map(|sample| sample.point) else { return 0.0 };
        let pairs = self.samples.windows(2);
        pairs.map(|pair| (pair[0].point - first).perp(&(pair[1].point - first)) / 2.0).sum()
    }

    /// Returns whether sample `k` is a corner.
    pub(super) fn is_corner(&self, k: usize) -> bool {
        self.samples[k].turn.abs() > LARGEST_TURN
    }

    /// Returns the inward normal at sample `k`, that of the circle through it and its neighbours.
    pub(super) fn inward(&self, k: usize) -> Vector2<f64> {
        let n = self.samples.len();
        let [before, here, after] = [(k + n - 1) % n, k, (k + 1) % n].map(|j| self.samples[j].point);
        let (back, on) = (here - before, after - here);
        let along = back / back.norm_squared() + on / on.norm_squared();
        Vector2::new(-along.y, along.x).normalize()
    }

    /// Returns the radius \[mm\] of the circle through `here`, with its centre toward `inward`, that touches the chord from sample
    /// `k` to the next; infinite if it touches the chord's line beyond its ends, or if the chord does not face `here`.
    pub(super) fn facing(&self, k: usize, here: Point2<f64>, inward: &Vector2<f64>) -> f64 {
        let (from, to) = (self.samples[k].point, self.next(k));
        let (chord, length) = (to - from, (to - from).norm());
        let normal = Vector2::new(-chord.y, chord.x) / length;
        let (away, along) = ((here - from).dot(&normal), inward.dot(&normal));
        // Chords that do not face the circle belong to its own part of the curve, which they cut short.
        if along >= 0.0 || away <= 0.0 {
            return f64::INFINITY;
        }
        let radius = away / (1.0 - along);
        let touched = (here + (inward - normal) * radius - from).dot(&chord);
        if (0.0..=length * length).contains(&touched) { radius } else { f64::INFINITY }
    }

    /// Returns the radius of the circle through sample `k` and its neighbours \[mm\].
    pub(super) fn radius(&self, k: usize) -> f64 {
        let n = self.samples.len();
        let [before, after] = [(k + n - 1) % n, (k + 1) % n].map(|j| self.samples[j].point);
        (after - before).norm() / (2.0 * self.samples[k].turn.sin().abs())
    }

    /// Returns the index of the last sample up to a length of the polygon.
    pub(super) fn index(&self, at: f64) -> usize {
        self.samples.partition_point(|sample| sample.at <= at).saturating_sub(1)
    }

    /// Returns the index of the last sample up to a length of the polygon, which may exceed the whole, and the share of the way
    /// to the next one.
    fn place(&self, at: f64) -> (usize, f64) {
        let at = if at >= self.length { at - self.length } else { at };
        let k = self.index(at);
        (k, ((at - self.samples[k].at) / self.step(k)).clamp(0.0, 1.0))
    }

    /// Returns the point of the sample after sample `k`.
    fn next(&self, k: usize) -> Point2<f64> {
        self.samples[(k + 1) % self.samples.len()].point
    }

    /// Returns the largest distance of the samples between two lengths of the polygon from the chord between two points
    /// \[mm\].
    pub(super) fn off_chord(&self, at: [f64; 2], [from, to]: [Point2<f64>; 2]) -> f64 {
        let chord = (to - from).normalize();
        let n = self.samples.len();
        let at = if at[0] >= self.length { at.map(|at| at - self.length) } else { at };
        let first = self.samples.partition_point(|sample| sample.at <= at[0]);
        let around = (first..first + n).map(|k| {
            let sample = &self.samples[k % n];
            (sample.at + if k >= n { self.length } else { 0.0 }, sample.point)
        });
        let between = around.take_while(|(place, _)| *place < at[1]);
        between.map(|(_, point)| (point - from).perp(&chord).abs()).fold(0.0, f64::max)
    }
}

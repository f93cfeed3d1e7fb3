//! Divides the boundary of a component into edges that a triangle mesh with good angles can begin from.
//!
//! The length of an edge is at most the size asked for, follows curvature so that the chord error keeps its bound, is at most
//! the radius of the largest circle that touches the boundary there from inside and fits into the component, and varies
//! slowly from place to place. Corners are nodes. Both edges at a sharp corner have one length: the triangle between them, the
//! tip, is isosceles. What is left of the component behind its tips has no sharp corner.

use std::f64::consts::{FRAC_PI_3, PI};

use nalgebra::Point2;

use super::boundary::{BoundaryTracer, Ring};
use crate::error::{Error, ErrorKind, Result};
use crate::numerics::interval::Interval;

/// Largest turn of the boundary along one edge \[rad\].
const TURN_PER_EDGE: f64 = 0.4;

/// Largest growth of the edges per length.
const GROWTH: f64 = 0.25;

/// Edges per radius of the largest circle inside the component.
const EDGES_PER_RADIUS: f64 = 1.0;

/// Edges per radius of the largest circle behind a tip, whose third side is as long as the component is wide there.
const EDGES_PER_WEDGE: f64 = 0.6;

/// Interior angle \[rad\] below which a corner is sharp: equal edges on its two sides end closer to each other than they are long.
const SHARP: f64 = FRAC_PI_3;

/// Least radius of a circle that counts as lying between the two sides of a corner, as a share of its radius between straight sides.
const WEDGE: f64 = 0.75;

/// Largest length of the edges at a sharp corner, as a share of the boundary up to the next corner.
const CORNER_SHARE: f64 = 0.25;

/// Least number of edges of a ring without corners.
const LEAST_EDGES: f64 = 3.0;

/// Most edges of the boundary of a component. Edges are about as long as the component is wide, so that one with more edges is twenty
/// thousand times as long as wide, and no solver computes over such a mesh.
const MOST_EDGES: f64 = 4e4;

/// A node of the boundary.
#[derive(Debug, Clone, Copy)]
pub(super) struct BoundaryNode {
    /// The point (ξ, η) \[mm\], on the exact curve.
    pub(super) point: Point2<f64>,
    /// Length of the ring's polygon up to the node \[mm\].
    pub(super) at: f64,
    /// At a sharp corner, the number of equal parts of the third side of the triangle that its two edges make.
    pub(super) tip: Option<usize>,
}

/// What the edges of a boundary have to keep.
#[derive(Debug, Clone, Copy)]
pub(super) struct EdgeLimits {
    /// Largest length of an edge \[mm\].
    pub(super) size: f64,
    /// Largest distance of the curve from an edge \[mm\].
    pub(super) chord_error: f64,
}

/// A corner of a ring.
#[derive(Debug, Clone, Copy)]
struct RingCorner {
    sample: usize,
    angle: f64,
}

/// A sample of any ring with the edge length wanted there.
#[derive(Debug, Clone, Copy)]
struct Wanted {
    point: Point2<f64>,
    length: f64,
}

/// The edges that a component's boundary wants, before they are shortened.
pub(super) struct RingSpacing<'r> {
    rings: &'r [Ring],
    limits: EdgeLimits,
    corners: Vec<Vec<RingCorner>>,
    /// For each sharp corner of a ring the two lengths of the polygon at which its edges end \[mm\].
    protected: Vec<Vec<[f64; 2]>>,
    /// Length of the edges at every sample of each ring \[mm\].
    lengths: Vec<Vec<f64>>,
}

impl<'r> RingSpacing<'r> {
    /// Finds the edges of a boundary. Cost: a millisecond; it grows with the square of the number of samples.
    pub(super) fn new(tracer: &mut BoundaryTracer<'_>, rings: &'r [Ring], limits: EdgeLimits) -> Self {
        let corners: Vec<Vec<RingCorner>> = rings.iter().map(corners_of).collect();
        let circles = circles(rings);
        let mut wanted: Vec<Vec<Wanted>> =
            (0..rings.len()).map(|k| own_lengths(&rings[k], &corners[k], &circles[k], limits)).collect();
        let protected: Vec<Vec<[f64; 2]>> =
            (0..rings.len()).map(|k| protected(tracer, &rings[k], &corners[k], &wanted)).collect();
        for (k, ring) in rings.iter().enumerate() {
            narrow(ring, &corners[k], &protected[k], &circles[k], &mut wanted[k]);
        }
        let all: Vec<Wanted> = wanted.iter().flatten().filter(|w| w.length.is_finite()).copied().collect();
        let length = |w: &Wanted| graded(&w.point, &all).min(limits.size);
        let lengths = wanted.iter().map(|wanted| wanted.iter().map(length).collect()).collect();
        Self { rings, limits, corners, protected, lengths }
    }

    /// Returns the nodes of each ring, in its order; `share`, at most 1, shortens all edges.
    ///
    /// # Errors
    /// More than 40,000 edges, counted before any node is made.
    pub(super) fn nodes(
        &self,
        tracer: &mut BoundaryTracer<'_>,
        share: f64,
    ) -> Result<Vec<Vec<BoundaryNode>>> {
        let counts = self.rings.iter().zip(&self.lengths).map(|(ring, lengths)| {
            let lengths: Vec<f64> = lengths.iter().map(|length| share * length).collect();
            EdgeCounts::new(ring, &lengths)
        });
        let counts: Vec<EdgeCounts<'_>> = counts.collect();
        let edges: f64 = counts.iter().map(EdgeCounts::whole).sum();
        if edges.is_nan() || edges > MOST_EDGES {
            let found =
                format!("a part of the patch that is so narrow that its boundary takes {edges:.0e} edges");
            let advice =
                "take another approach, a window that cuts more or less of the patch, or formats without it";
            return Err(Error::new("mesh", found, format!("at most {MOST_EDGES:e}"), advice)
                .of_kind(ErrorKind::Limit));
        }
        let nodes = counts.iter().zip(&self.corners).zip(&self.protected);
        Ok(nodes
            .map(|((counts, corners), protected)| {
                divided(tracer, counts, corners, protected, self.limits.chord_error)
            })
            .collect())
    }
}

fn corners_of(ring: &Ring) -> Vec<RingCorner> {
    let corners = (0..ring.samples.len()).filter(|&k| ring.is_corner(k));
    corners.map(|sample| RingCorner { sample, angle: PI - ring.samples[sample].turn }).collect()
}

/// Returns, for every sample of each ring, the radius \[mm\] of the largest circle that touches the boundary there from inside, holds
/// no sample of any ring and crosses no chord that faces it; infinite at corners.
///
/// Method: a circle reaches no farther than its diameter, so that samples are looked at in the order of their distance along the longer
/// axis, until they and the chords from them lie beyond the smallest circle so far.
fn circles(rings: &[Ring]) -> Vec<Vec<f64>> {
    let of_ring = |k: usize| (0..rings[k].samples.len()).map(move |sample| (k, sample));
    let mut all: Vec<(usize, usize)> = (0..rings.len()).flat_map(of_ring).collect();
    let point = |(ring, sample): (usize, usize)| rings[ring].samples[sample].point;
    let extent = |axis: usize| all.iter().fold(Interval::NONE, |range, at| range.with(point(*at)[axis]));
    let axis = usize::from(extent(1).width() > extent(0).width());
    all.sort_by(|a, b| point(*a)[axis].total_cmp(&point(*b)[axis]));
    let longest = all.iter().map(|&(ring, sample)| rings[ring].step(sample)).fold(0.0, f64::max);
    let mut circles: Vec<Vec<f64>> =
        rings.iter().map(|ring| vec![f64::INFINITY; ring.samples.len()]).collect();
    for (place, &at) in all.iter().enumerate() {
        let (ring, here) = (&rings[at.0], point(at));
        if ring.is_corner(at.1) {
            continue;
        }
        let inward = ring.inward(at.1);
        let radius = &mut circles[at.0][at.1];
        let mut look = |other: (usize, usize)| {
            let to = point(other) - here;
            if to[axis].abs() > 2.0 * *radius + longest {
                return false;
            }
            let depth = to.dot(&inward);
            if depth > 0.0 {
                *radius = radius.min(to.norm_squared() / (2.0 * depth));
            }
            *radius = radius.min(rings[other.0].facing(other.1, here, &inward));
            true
        };
        // From here on, and back.
        for others in
            [&mut all[place..].iter() as &mut dyn Iterator<Item = _>, &mut all[..place].iter().rev()]
        {
            others.take_while(|other| look(**other)).for_each(drop);
        }
    }
    circles
}

/// Returns the corners before and after a sample. A ring without corners has none.
fn beside(corners: &[RingCorner], sample: usize) -> impl Iterator<Item = &RingCorner> {
    let after = corners.partition_point(|corner| corner.sample <= sample);
    let n = corners.len();
    let both = [after + n.saturating_sub(1), after];
    both.into_iter().filter_map(move |k| corners.get(k.checked_rem(n)?))
}

/// Returns whether the circle at a sample is that between the two sides of a corner.
fn is_wedge(ring: &Ring, corner: &RingCorner, sample: usize, circle: f64) -> bool {
    let away = (ring.samples[sample].point - ring.samples[corner.sample].point).norm();
    corner.angle < PI && circle >= WEDGE * away * (corner.angle / 2.0).tan()
}

/// Returns the edge length at every sample that follows from size, curvature and circles, except circles between the sides of a corner.
fn own_lengths(ring: &Ring, corners: &[RingCorner], circles: &[f64], limits: EdgeLimits) -> Vec<Wanted> {
    let length = |k: usize| {
        if ring.is_corner(k) {
            return corner_gap(ring, corners, k).min(limits.size);
        }
        let radius = ring.radius(k);
        let curved = (8.0 * limits.chord_error * radius).sqrt().min(TURN_PER_EDGE * radius);
        let wedge = beside(corners, k).any(|corner| is_wedge(ring, corner, k, circles[k]));
        let inside = if wedge { f64::INFINITY } else { circles[k] / EDGES_PER_RADIUS };
        limits.size.min(curved).min(inside)
    };
    let samples = ring.samples.iter().enumerate();
    samples.map(|(k, sample)| Wanted { point: sample.point, length: length(k) }).collect()
}

/// Returns the length of the boundary from a corner to the nearest other one \[mm\], or the whole ring.
fn corner_gap(ring: &Ring, corners: &[RingCorner], sample: usize) -> f64 {
    let at = |k: usize| ring.samples[k].at;
    let gap = |other: &RingCorner| {
        let way = (at(other.sample) - at(sample)).abs();
        way.min(ring.length - way)
    };
    corners.iter().filter(|other| other.sample != sample).map(gap).fold(ring.length, f64::min)
}

/// Returns for each sharp corner the two lengths of the polygon, before and after it, at which its two edges end \[mm\].
fn protected(
    tracer: &mut BoundaryTracer<'_>,
    ring: &Ring,
    corners: &[RingCorner],
    wanted: &[Vec<Wanted>],
) -> Vec<[f64; 2]> {
    let all: Vec<Wanted> = wanted.iter().flatten().copied().collect();
    let sharp = corners.iter().filter(|corner| corner.angle < SHARP);
    let around = |corner: &RingCorner| {
        let here = ring.samples[corner.sample];
        let length = graded(&here.point, &all).min(CORNER_SHARE * corner_gap(ring, corners, corner.sample));
        [-1.0, 1.0].map(|sense| tracer.away(ring, here.at, sense, length))
    };
    sharp.map(around).collect()
}

/// Limits the edge lengths between the two sides of a sharp corner beyond the corner's own two edges. Along these there is no limit.
fn narrow(
    ring: &Ring,
    corners: &[RingCorner],
    protected: &[[f64; 2]],
    circles: &[f64],
    wanted: &mut [Wanted],
) {
    for (k, sample) in ring.samples.iter().enumerate() {
        if protected.iter().any(|around| holds(ring, around, sample.at)) {
            wanted[k].length = f64::INFINITY;
            continue;
        }
        let mut sharp = beside(corners, k).filter(|corner| corner.angle < SHARP);
        if sharp.any(|corner| is_wedge(ring, corner, k, circles[k])) {
            wanted[k].length = wanted[k].length.min(circles[k] / EDGES_PER_WEDGE);
        }
    }
}

/// Returns the edge length at a point: no wanted length is exceeded by more than [`GROWTH`] times its distance.
fn graded(point: &Point2<f64>, wanted: &[Wanted]) -> f64 {
    wanted.iter().map(|w| w.length + GROWTH * (w.point - point).norm()).fold(f64::INFINITY, f64::min)
}

/// Divides a ring into the edges that were counted.
fn divided(
    tracer: &mut BoundaryTracer<'_>,
    counts: &EdgeCounts<'_>,
    corners: &[RingCorner],
    protected: &[[f64; 2]],
    chord_error: f64,
) -> Vec<BoundaryNode> {
    let ring = counts.ring;
    let fixed = fixed_places(ring, corners, protected, chord_error);
    let least = if fixed.len() == 1 { LEAST_EDGES } else { 1.0 };
    let mut places = Vec::new();
    for (k, &from) in fixed.iter().enumerate() {
        let to = fixed.get(k + 1).copied().unwrap_or(fixed[0] + ring.length);
        let ends = [from, to].map(|at| counts.up_to(at));
        let edges = if protected.iter().any(|around| holds(ring, around, from + (to - from) / 2.0)) {
            1.0
        } else {
            (ends[1] - ends[0]).ceil().max(least)
        };
        places.push(from);
        let share = |j: usize| ends[0] + (ends[1] - ends[0]) * j as f64 / edges;
        places.extend((1..edges as usize).map(|j| counts.place(share(j))));
    }
    let sharp =
        |at: f64| corners.iter().any(|corner| corner.angle < SHARP && ring.samples[corner.sample].at == at);
    let node = |at: f64| BoundaryNode { point: tracer.point(ring, at), at, tip: sharp(at).then_some(1) };
    let mut nodes: Vec<BoundaryNode> = places.into_iter().map(node).collect();
    // No chain begins with a tip: the node before a tip is the one before it in the list.
    if nodes.first().is_some_and(|node| node.tip.is_some()) {
        nodes.rotate_left(1);
    }
    halved(tracer, ring, nodes, chord_error)
}

/// Returns whether a place of a ring lies between two others, which may lie before its start or beyond its end.
fn holds(ring: &Ring, [from, to]: &[f64; 2], at: f64) -> bool {
    [-ring.length, 0.0, ring.length].into_iter().any(|whole| *from < at + whole && at + whole < *to)
}

/// Returns the ascending places of a ring that are nodes: corners, and the ends of the edges at tips. There is at least one.
fn fixed_places(ring: &Ring, corners: &[RingCorner], protected: &[[f64; 2]], chord_error: f64) -> Vec<f64> {
    let mut fixed: Vec<f64> = protected.iter().flatten().map(|at| at.rem_euclid(ring.length)).collect();
    let mut last = f64::NEG_INFINITY;
    for corner in corners {
        let at = ring.samples[corner.sample].at;
        // Corners closer than the chord error may share a node.
        if corner.angle < SHARP || at - last > chord_error {
            fixed.push(at);
            last = at;
        }
    }
    if fixed.is_empty() {
        fixed.push(0.0);
    }
    fixed.sort_by(f64::total_cmp);
    fixed
}

/// The number of edges along a ring.
struct EdgeCounts<'a> {
    ring: &'a Ring,
    /// Number of edges from the start of the ring to each sample, and to its end.
    counts: Vec<f64>,
}

impl<'a> EdgeCounts<'a> {
    /// Sums up the edges of a ring from their lengths \[mm\] at its samples.
    fn new(ring: &'a Ring, lengths: &[f64]) -> Self {
        let (n, mut counts) = (ring.samples.len(), vec![0.0]);
        for k in 0..n {
            let per_length = (1.0 / lengths[k] + 1.0 / lengths[(k + 1) % n]) / 2.0;
            counts.push(counts[k] + ring.step(k) * per_length);
        }
        Self { ring, counts }
    }

    /// Returns the number of edges of the whole ring.
    fn whole(&self) -> f64 {
        self.counts[self.counts.len() - 1]
    }

    /// Returns the number of edges up to a length of the polygon, which may exceed that of the whole ring.
    fn up_to(&self, at: f64) -> f64 {
        if at >= self.ring.length {
            return self.whole() + self.up_to(at - self.ring.length);
        }
        let k = self.ring.index(at);
        let share = (at - self.ring.samples[k].at) / self.ring.step(k);
        self.counts[k] + (self.counts[k + 1] - self.counts[k]) * share
    }

    /// Returns the length of the polygon at which this number of edges is reached.
    fn place(&self, count: f64) -> f64 {
        let whole = self.whole();
        let (count, beyond) = if count >= whole { (count - whole, self.ring.length) } else { (count, 0.0) };
        let k = self.counts.partition_point(|known| *known <= count).clamp(1, self.counts.len() - 1) - 1;
        let share = (count - self.counts[k]) / (self.counts[k + 1] - self.counts[k]);
        self.ring.samples[k].at + self.ring.step(k) * share + beyond
    }
}

/// Halves edges until the chord error is within its bound.
fn halved(
    tracer: &mut BoundaryTracer<'_>,
    ring: &Ring,
    mut nodes: Vec<BoundaryNode>,
    chord_error: f64,
) -> Vec<BoundaryNode> {
    let off = |nodes: &[BoundaryNode], k: usize| {
        let (here, next) = (nodes[k], following(ring, nodes, k));
        // A curve shorter than the bound cannot be farther from its chord.
        next.at - here.at > chord_error
            && ring.off_chord([here.at, next.at], [here.point, next.point]) > chord_error
    };
    let mut k = 0;
    while k < nodes.len() {
        if nodes[k].tip.is_some() && (off(&nodes, k) || off(&nodes, k - 1)) {
            halve_tip(tracer, ring, &mut nodes, k);
            k += 1;
        } else if nodes[k].tip.is_none() && nodes[(k + 1) % nodes.len()].tip.is_none() && off(&nodes, k) {
            let at = [nodes[k].at, following(ring, &nodes, k).at];
            nodes.insert(k + 1, between(tracer, ring, at, 0.5));
        } else {
            k += 1;
        }
    }
    nodes
}

/// Halves both edges at a tip, which is not the first node, so that they keep one length. The tip is then one node later.
fn halve_tip(tracer: &mut BoundaryTracer<'_>, ring: &Ring, nodes: &mut Vec<BoundaryNode>, tip: usize) {
    let BoundaryNode { point, at, .. } = nodes[tip];
    let half = (nodes[tip - 1].point - point).norm() / 2.0;
    let [back, on] = [-1.0, 1.0].map(|sense| {
        let at = tracer.away(ring, at, sense, half).rem_euclid(ring.length);
        BoundaryNode { point: tracer.point(ring, at), at, tip: None }
    });
    nodes.insert(tip + 1, on);
    nodes.insert(tip, back);
}

/// Returns the node after node `k`, with its length counted on from that node.
pub(super) fn following(ring: &Ring, nodes: &[BoundaryNode], k: usize) -> BoundaryNode {
    let next = nodes[(k + 1) % nodes.len()];
    if next.at > nodes[k].at { next } else { BoundaryNode { at: next.at + ring.length, ..next } }
}

/// Returns a new node at a share of the way between two lengths of the polygon.
pub(super) fn between(
    tracer: &mut BoundaryTracer<'_>,
    ring: &Ring,
    at: [f64; 2],
    share: f64,
) -> BoundaryNode {
    let at = at[0] + (at[1] - at[0]) * share;
    BoundaryNode { point: tracer.point(ring, at), at, tip: None }
}

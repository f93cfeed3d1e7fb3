//! Finds where a chain of points crosses itself, by a tree of boxes. Cost: n log n for chains like profiles.

use crate::measured::read::points::Point;
use crate::numerics::interval::Interval;

/// Most crossings that are reported.
const MOST_CROSSINGS: usize = 100;
/// Number of box comparisons after which the search ends. A profile of a million points takes a tenth of it. Points that
/// wind around one place take up to n², which would last hours.
const MOST_COMPARISONS: usize = 100_000_000;

/// The result of a search for crossings.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(in crate::measured) struct Crossings {
    /// Pairs of edges \[i, j\], i < j, where edge i → i + 1 crosses edge j → j + 1. At most [`MOST_CROSSINGS`].
    pub edges: Vec<[usize; 2]>,
    /// Whether the search ended at its limit of comparisons, so that there may be other crossings.
    pub cut_short: bool,
}

/// Finds where the chain crosses itself.
pub(in crate::measured) fn crossings(points: &[Point]) -> Crossings {
    crossings_within(points, MOST_COMPARISONS)
}

fn crossings_within(points: &[Point], most_comparisons: usize) -> Crossings {
    if points.len() < 4 {
        return Crossings { edges: Vec::new(), cut_short: false };
    }
    let mut search = CrossingSearch::new(points, most_comparisons);
    search.inside(EdgeRange { index: 1, from: 0, to: points.len() - 1 });
    search.found.sort_unstable();
    Crossings { edges: search.found, cut_short: search.comparisons > most_comparisons }
}

/// The box around some edges: the ranges of x and of z \[mm\].
type EdgeBox = [Interval; 2];

/// The edges `from`..`to` and the index of their box. The children of box k are the boxes 2k and 2k + 1.
#[derive(Debug, Clone, Copy)]
struct EdgeRange {
    index: usize,
    from: usize,
    to: usize,
}

impl EdgeRange {
    fn halves(self) -> Option<[Self; 2]> {
        let middle = self.from + (self.to - self.from) / 2;
        let half = |index, from, to| Self { index, from, to };
        (self.to - self.from > 1)
            .then(|| [half(2 * self.index, self.from, middle), half(2 * self.index + 1, middle, self.to)])
    }
}

struct CrossingSearch<'a> {
    points: &'a [Point],
    boxes: Vec<EdgeBox>,
    found: Vec<[usize; 2]>,
    comparisons: usize,
    most_comparisons: usize,
}

impl<'a> CrossingSearch<'a> {
    fn new(points: &'a [Point], most_comparisons: usize) -> Self {
        let boxes = vec![[Interval::NONE; 2]; 4 * points.len()];
        let mut search = Self { points, boxes, found: Vec::new(), comparisons: 0, most_comparisons };
        search.build(EdgeRange { index: 1, from: 0, to: points.len() - 1 });
        search
    }

    fn build(&mut self, node: EdgeRange) -> EdgeBox {
        let bounds = match node.halves() {
            Some([a, b]) => {
                let (a, b) = (self.build(a), self.build(b));
                [a[0].hull(b[0]), a[1].hull(b[1])]
            }
            None => {
                let (a, b) = (self.points[node.from], self.points[node.from + 1]);
                [Interval::of(a.x).with(b.x), Interval::of(a.z).with(b.z)]
            }
        };
        self.boxes[node.index] = bounds;
        bounds
    }

    fn inside(&mut self, node: EdgeRange) {
        if let Some([a, b]) = node.halves() {
            self.inside(a);
            self.inside(b);
            self.between(a, b);
        }
    }

    fn between(&mut self, a: EdgeRange, b: EdgeRange) {
        self.comparisons += 1;
        if self.comparisons > self.most_comparisons
            || self.found.len() >= MOST_CROSSINGS
            || apart(&self.boxes[a.index], &self.boxes[b.index])
        {
            return;
        }
        let larger_first = a.to - a.from >= b.to - b.from;
        match (a.halves(), b.halves()) {
            (Some(halves), other) if larger_first || other.is_none() => {
                halves.into_iter().for_each(|half| self.between(half, b));
            }
            (_, Some(halves)) => halves.into_iter().for_each(|half| self.between(a, half)),
            _ if a.from + 1 < b.from && self.cross(a.from, b.from) => self.found.push([a.from, b.from]),
            _ => {}
        }
    }

    /// Returns whether two edges cross in their interiors.
    fn cross(&self, i: usize, j: usize) -> bool {
        let [a, b, c, d] = [i, i + 1, j, j + 1].map(|k| self.points[k]);
        turn(a, b, c) * turn(a, b, d) < 0.0 && turn(c, d, a) * turn(c, d, b) < 0.0
    }
}

fn turn(a: Point, b: Point, c: Point) -> f64 {
    ((b.x - a.x) * (c.z - a.z) - (b.z - a.z) * (c.x - a.x)).signum()
}

fn apart(a: &EdgeBox, b: &EdgeBox) -> bool {
    !(a[0].meets(b[0]) && a[1].meets(b[1]))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chain(xz: &[[f64; 2]]) -> Vec<Point> {
        xz.iter().map(|&[x, z]| Point { x, z, weight: 1.0, number: 1, line: 1 }).collect()
    }

    #[test]
    fn a_loop_is_found_once_and_a_touching_chain_is_not_one() {
        let looped = chain(&[[0.0, 0.0], [2.0, 0.0], [3.0, 1.0], [2.0, 2.0], [1.0, -1.0], [5.0, -1.0]]);
        assert_eq!(crossings(&looped), Crossings { edges: vec![[0, 3]], cut_short: false });
        assert_eq!(crossings_within(&looped, 1), Crossings { edges: Vec::new(), cut_short: true });
        assert!(crossings(&chain(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [2.0, 1.0]])).edges.is_empty());
    }

    #[test]
    fn a_long_chain_takes_little_time() {
        let circle: Vec<_> = (0..200_000)
            .map(|k| {
                let angle = 3e-5 * f64::from(k);
                [angle.cos(), angle.sin()]
            })
            .collect();
        let points = chain(&circle);
        let mut search = CrossingSearch::new(&points, MOST_COMPARISONS);
        search.inside(EdgeRange { index: 1, from: 0, to: points.len() - 1 });
        assert!(search.found.is_empty() && search.comparisons < 20 * points.len(), "{}", search.comparisons);
    }
}

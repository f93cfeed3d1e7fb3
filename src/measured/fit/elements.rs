//! Turns the design elements of a file into a chain of arcs and lines.

use crate::error::Result;
use crate::measured::read::points::{DesignElement, ElementShape, Point};
use crate::profile::{Arc, Segment, Station};

/// Distance \[mm\] of the points that stand for elements in the checks and in the search for the orientation.
const STEP: f64 = 0.5;
/// Most steps over one element. With [`STEP`] that is 200 mm.
const MOST_STEPS: f64 = 400.0;
/// Distance \[mm\] below which two ends are one joint. Drawings print 1e-4 mm.
const JOINT: f64 = 1e-3;
/// Largest turn of one arc \[rad\]. An arc of a chain turns by at most half a circle, and rounding must not exceed it.
const LARGEST_TURN: f64 = 3.0;

/// An element with its direction of travel.
#[derive(Debug, Clone, Copy)]
struct Directed {
    element: DesignElement,
    backwards: bool,
}

/// Returns the elements in the order of the file, each with the direction in which it begins where the previous one ends.
fn directed(elements: &[DesignElement]) -> Vec<Directed> {
    let mut out: Vec<Directed> = Vec::with_capacity(elements.len());
    for (k, &element) in elements.iter().enumerate() {
        let [a, b] = ends(&element);
        let backwards = match (out.last(), elements.get(k + 1)) {
            (Some(before), _) => far(before.end(), a) > far(before.end(), b),
            (None, Some(next)) => {
                let nearest =
                    |p: [f64; 2]| ends(next).map(|q| far(p, q)).into_iter().fold(f64::INFINITY, f64::min);
                nearest(a) < nearest(b)
            }
            (None, None) => a[0] > b[0],
        };
        out.push(Directed { element, backwards });
    }
    out
}

fn far(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

fn on_circle(center: [f64; 2], radius: f64, angle: f64) -> [f64; 2] {
    [center[0] + radius * angle.cos(), center[1] + radius * angle.sin()]
}

fn ends(element: &DesignElement) -> [[f64; 2]; 2] {
    match element.shape {
        ElementShape::Line { from, to } => [from, to],
        ElementShape::Arc { center, radius, angles } => angles.map(|angle| on_circle(center, radius, angle)),
    }
}

impl Directed {
    fn end(&self) -> [f64; 2] {
        ends(&self.element)[usize::from(!self.backwards)]
    }

    /// Returns points along the element; both ends are included.
    fn points(&self, number: usize) -> Vec<Point> {
        let length = match self.element.shape {
            ElementShape::Line { from, to } => far(from, to),
            ElementShape::Arc { radius, angles, .. } => radius * (angles[1] - angles[0]),
        };
        let n = (length / STEP).ceil().clamp(1.0, MOST_STEPS);
        let point = |k: usize| {
            let [x, z] = self.at(k as f64 / n);
            Point { x, z, weight: 1.0, number, line: self.element.line }
        };
        (0..=n as usize).map(point).collect()
    }

    /// Returns the point at a share of the element's length.
    fn at(&self, share: f64) -> [f64; 2] {
        let share = if self.backwards { 1.0 - share } else { share };
        match self.element.shape {
            ElementShape::Line { from, to } => {
                [from[0] + share * (to[0] - from[0]), from[1] + share * (to[1] - from[1])]
            }
            ElementShape::Arc { center, radius, angles } => {
                on_circle(center, radius, angles[0] + share * (angles[1] - angles[0]))
            }
        }
    }

    fn segments(&self) -> Result<Vec<Segment>> {
        let (center, radius, angles) = match self.element.shape {
            ElementShape::Line { from, to } => {
                let (from, to) = if self.backwards { (to, from) } else { (from, to) };
                return Ok(vec![Segment::arc(Arc::line(from, to)?)]);
            }
            ElementShape::Arc { center, radius, angles } => (center, radius, angles),
        };
        let parts = ((angles[1] - angles[0]) / LARGEST_TURN).ceil().max(1.0);
        let sense = if self.backwards { -1.0 } else { 1.0 };
        let station = |k: f64| {
            let share = if self.backwards { 1.0 - k / parts } else { k / parts };
            let angle = angles[0] + share * (angles[1] - angles[0]);
            let [x, z] = on_circle(center, radius, angle);
            Station { x, z, cos: -sense * angle.sin(), sin: sense * angle.cos() }
        };
        let arc =
            |k: usize| Arc { start: station(k as f64), end: station((k + 1) as f64), radius: sense * radius };
        Ok((0..parts as usize).map(|k| Segment::arc(arc(k))).collect())
    }
}

/// Returns points every [`STEP`] mm along the elements, with the number of their element.
pub(in crate::measured) fn points(elements: &[DesignElement]) -> Vec<Point> {
    let mut out: Vec<Point> = Vec::new();
    for (k, directed) in directed(elements).iter().enumerate() {
        let own = directed.points(k + 1);
        if out.last().zip(own.first()).is_some_and(|(end, start)| far(end.xz(), start.xz()) <= JOINT) {
            out.pop();
        }
        out.extend(own);
    }
    out
}

/// Makes the chain of elements, in profile axes and from left to right.
///
/// # Errors
/// A line element with two equal ends; the error gives its line in the file.
pub(in crate::measured) fn segments(elements: &[DesignElement]) -> Result<Vec<Segment>> {
    let mut chain = directed(elements);
    let first = chain.first().map(|first| ends(&first.element)[usize::from(first.backwards)]);
    if let (Some(first), Some(last)) = (first, chain.last())
        && last.end()[0] < first[0]
    {
        chain.reverse();
        chain.iter_mut().for_each(|directed| directed.backwards ^= true);
    }
    let mut out = Vec::new();
    for directed in chain {
        let segments = directed.segments();
        out.extend(segments.map_err(|error| error.within(format!("line {}", directed.element.line)))?);
    }
    Ok(out)
}

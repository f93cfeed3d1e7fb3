//! Closes a drawn chain. A drawing's coordinates are rounded, so that neighbouring segments miss each other by small steps.
//! A surface with steps has contacts, edges and slivers that no wheel has.
//!
//! One rule closes each joint, from the two drawn ends alone. Let d be the distance between the two ends across the
//! tangent, φ the kink, K = `BEND` / length of the chain, and w = √(d/K):
//!
//! - **met**: ends that differ only by roundings are one point already; they stay as they are;
//! - **crossing**: if the drawing has a kink, |φ| > Kw, both segments are cut or continued to where they cross, which is
//!   less than about w away;
//! - **bend**: otherwise the last w of the left segment and the first w of the right one are bent towards each other. Each
//!   bent stretch leaves its segment along the tangent, and its curvature differs from the drawn one by a constant: ±d/w² =
//!   ±K for the step, and up to K/2 more for the kink, which disappears. A bent arc is an arc; a bent polynomial is the
//!   polynomial plus a parabola.
//!
//! Outside these stretches every segment is the drawn one. A gap along the tangent is not a step: the segments are first
//! continued towards each other, the flatter one further. The width w is at least `SHORTEST` and at most `SHARE` of the
//! shorter neighbour. The rule prefers no direction, no axes and no unit of length: it commutes with mirroring, rigid
//! motion and scaling. Closing a second time changes nothing.

use serde::{Deserialize, Serialize};

use super::arc::Arc;
use super::polynomial::Polynomial;
use super::segment::{Segment, Shape};
use super::station::Station;
use crate::error::{Error, Result};
use crate::numerics::interval::Interval;

/// Distance of two ends, as a share of the profile's extent, below which only rounding separates them. Coordinates of arcs
/// are rounded some ten times. With a smaller value, bends over 1e-13 mm would make segments without length.
pub const ONE_JOINT: f64 = 16.0 * f64::EPSILON;

/// Curvature × length of the chain by which a bend may differ from the drawing: 1/(1200 mm) on a wheel of 150 mm. A larger
/// value comes near the curvature of treads and crowns, and makes a second contact beside the first. A smaller value
/// changes more of the drawn surface than the step is worth.
const BEND: f64 = 1.0 / 8.0;

/// Shortest bent stretch, as a share of the chain's length: 18 µm of 150 mm. A smaller value puts points of files closer
/// together than solvers can separate. A larger value changes more of the drawing for tiny steps.
const SHORTEST: f64 = 1.0 / 8192.0;

/// Largest share of a segment that may be bent, cut or continued at each of its ends. The drawn shape then keeps its
/// middle.
const SHARE: f64 = 1.0 / 3.0;

/// Largest step, as a share of the bent stretch beside it; the tangent then turns by up to 0.1 rad. A larger step cannot be
/// a rounding of the segment's ends.
const STEEPEST: f64 = 1.0 / 16.0;

/// Largest change of a kink at the crossing of two segments, as a share of the kink. With a larger change, the segments
/// curve away from each other before they meet.
const SAME_KINK: f64 = 0.25;

/// Most corrections of a joint. Each correction reduces the error by curvature × w, at least ten times.
const MOST_CORRECTIONS: usize = 40;

/// How a joint was closed.
///
/// Let K = 1/8 ÷ length of the chain, and w = √(step/K). If the drawing has a kink larger than Kw, both segments are cut or
/// continued to where they cross. Otherwise the last w of the left segment and the first w of the right one are bent by a
/// constant change of curvature, until they meet without a kink.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Closing {
    /// Index of the segment in the closed chain that ends at the joint point.
    pub left: usize,
    /// Distance of the two drawn ends across the tangent \[mm\].
    pub step: f64,
    /// Largest distance by which the drawn surface was moved across its tangent \[mm\].
    pub moved: f64,
    /// Length of the changed stretch on either side of the joint \[mm\].
    pub reach: f64,
}

/// Closes a chain. Returns its segments, and what was done at each joint whose ends differed by more than a rounding.
///
/// # Errors
/// A step beside a segment that is too short for it.
pub(super) fn close(segments: &[Segment], extent: f64) -> Result<(Vec<Segment>, Vec<Closing>)> {
    let lengths: Vec<f64> = segments.iter().map(chord).collect();
    let chain: f64 = lengths.iter().sum();
    let mut out: Vec<Segment> = Vec::with_capacity(segments.len());
    let mut closings = Vec::new();
    for (index, next) in segments.iter().enumerate() {
        let Some(last) = out.pop() else {
            out.push(next.clone());
            continue;
        };
        let longest = SHARE * lengths[index - 1].min(lengths[index]);
        let (left, right) = (JointSide::end(&last), JointSide::start(next));
        let rounding = ONE_JOINT * (extent + left.station.x.abs() + left.station.z.abs());
        let misfit = Misfit { left, right, chain, longest, rounding };
        let closed = misfit.closed().ok_or_else(|| misfit.refusal(next.place(index)))?;
        let [left, bent_left] = closed.left;
        out.extend(left.into_iter().chain(bent_left));
        if let Some(closing) = closed.closing {
            closings.push(Closing { left: out.len() - 1, ..closing });
        }
        let [bent_right, right] = closed.right;
        out.extend(bent_right.into_iter().chain(right));
    }
    Ok((out, closings))
}

/// Returns the distance between a segment's ends \[mm\].
fn chord(segment: &Segment) -> f64 {
    let (start, end) = (segment.start(), segment.end());
    (end.x - start.x).hypot(end.z - start.z)
}

/// A segment at the joint to be closed. A distance s \[mm\] along it is counted from its drawn end at the joint, positive
/// to the right.
#[derive(Debug, Clone, Copy)]
struct JointSide<'a> {
    segment: &'a Segment,
    station: Station,
    /// +1 if the segment ends at the joint, −1 if it begins there.
    outward: f64,
}

/// The bent part of a segment. It begins at s = −outward × `reach` and has the length `length`, both in mm.
#[derive(Debug, Clone, Copy)]
struct Bent {
    reach: f64,
    length: f64,
    /// Change of curvature \[1/mm\].
    change: f64,
}

impl<'a> JointSide<'a> {
    fn end(segment: &'a Segment) -> Self {
        Self { segment, station: segment.end(), outward: 1.0 }
    }

    fn start(segment: &'a Segment) -> Self {
        Self { segment, station: segment.start(), outward: -1.0 }
    }

    /// Returns the station at s on the segment, or on its continuation.
    fn at(&self, s: f64) -> Station {
        match &self.segment.shape {
            Shape::Arc(arc) => graphed(&self.station, arc.curvature(), s),
            Shape::Polynomial(polynomial) => polynomial.station(self.parameter(polynomial, s)),
        }
    }

    /// Returns the parameter of a polynomial at s. The speed at the joint turns s into a change of parameter.
    fn parameter(&self, polynomial: &Polynomial, s: f64) -> f64 {
        let end = if self.outward > 0.0 { polynomial.t[1] } else { polynomial.t[0] };
        end + s / polynomial.speed(end)
    }

    /// Returns the segment, cut or continued so that it ends at s.
    fn cut(&self, s: f64) -> Segment {
        let shape = match &self.segment.shape {
            Shape::Arc(arc) if self.outward > 0.0 => Shape::Arc(Arc { end: self.at(s), ..*arc }),
            Shape::Arc(arc) => Shape::Arc(Arc { start: self.at(s), ..*arc }),
            Shape::Polynomial(polynomial) => {
                let mut cut = polynomial.clone();
                cut.t[usize::from(self.outward > 0.0)] = self.parameter(polynomial, s);
                Shape::Polynomial(cut)
            }
        };
        Segment { label: self.segment.label.clone(), shape }
    }

    /// Returns the bent part. Its far end is the joint.
    fn bent(&self, bent: &Bent) -> Segment {
        let (from, length) = (-self.outward * bent.reach, self.outward * bent.length);
        let shape = match &self.segment.shape {
            Shape::Arc(arc) => {
                let curvature = arc.curvature() + bent.change;
                let near = self.at(from);
                let far = graphed(&near, curvature, length);
                let [start, end] = if self.outward > 0.0 { [near, far] } else { [far, near] };
                Shape::Arc(Arc { start, end, radius: curvature.recip() })
            }
            Shape::Polynomial(polynomial) => {
                let near = self.parameter(polynomial, from);
                let far = near + length / polynomial.speed(self.parameter(polynomial, 0.0));
                let mut all = polynomial.curved(near, self.parameter(polynomial, 0.0), bent.change);
                all.t = if self.outward > 0.0 { Interval::new(near, far) } else { Interval::new(far, near) };
                Shape::Polynomial(all)
            }
        };
        Segment { label: format!("closing {}", self.segment.label).trim_end().into(), shape }
    }
}

/// Returns the station at a distance s \[mm\] along an arc of the given curvature from `from`; a negative s goes backwards.
fn onward(from: &Station, curvature: f64, s: f64) -> Station {
    let half = 0.5 * curvature * s;
    let chord = if half == 0.0 { s } else { s * (half.sin() / half) };
    let (sin, cos) = (2.0 * half).sin_cos();
    Station { x: chord * half.cos(), z: chord * half.sin(), cos, sin }.placed_by(from)
}

/// Least cosine of the tangent angle at which a point keeps its rounded abscissa.
const GRAPH: f64 = 1.0 / 64.0;

/// Returns the station at a distance s \[mm\] along an arc of the given curvature from `from`. The abscissa is rounded
/// first; tangent and height are then those of the arc at the rounded abscissa. Separate roundings would move everything
/// that is anchored at the station: the height of a steep segment by a rounding of the larger coordinate.
fn graphed(from: &Station, curvature: f64, s: f64) -> Station {
    let rounded = onward(from, curvature, s);
    if from.cos.min(rounded.cos) < GRAPH {
        return rounded;
    }
    let run = rounded.x - from.x;
    let sin = from.sin + curvature * run;
    let cos = rounded.cos - (sin - rounded.sin) * (rounded.sin / rounded.cos);
    Station { z: from.z + run * ((from.sin + sin) / (from.cos + cos)), cos, sin, ..rounded }
}

/// Two neighbours whose ends must become one point.
#[derive(Debug)]
struct Misfit<'a> {
    left: JointSide<'a>,
    right: JointSide<'a>,
    /// Length of the chain \[mm\].
    chain: f64,
    /// Longest stretch that may be changed \[mm\].
    longest: f64,
    /// Distance below which two ends are one point \[mm\].
    rounding: f64,
}

/// The segments of a closed joint. `left` holds the left segment and its bent end; `right` holds the bent beginning of the
/// right segment and that segment.
struct Closed {
    left: [Option<Segment>; 2],
    right: [Option<Segment>; 2],
    closing: Option<Closing>,
}

impl Misfit<'_> {
    /// Returns how far the right station is from the left one: the distance along the tangents \[mm\], the distance across
    /// the tangents \[mm\] (the smaller of the two tangents' values), and the turn \[rad\].
    fn miss(left: &Station, right: &Station) -> [f64; 3] {
        let from_left = right.seen_from(left);
        let from_right = left.seen_from(right);
        let along = 0.5 * (from_left.x - from_right.x);
        let [a, b] = [from_left.z, -from_right.z];
        [along, if a.abs() < b.abs() { a } else { b }, from_left.angle()]
    }

    fn closed(&self) -> Option<Closed> {
        let [left, right] = [&self.left, &self.right].map(|edge| edge.segment.clone());
        let [along, across, kink] = Self::miss(&self.left.station, &self.right.station);
        if along.hypot(across) <= self.rounding {
            return Some(Closed::met(left, right));
        }
        if along.abs() > self.longest {
            return None;
        }
        if along.abs() <= self.rounding {
            return self.met(across, kink);
        }
        let share = self.share();
        let (left, right) = (self.left.cut(share * along), self.right.cut((share - 1.0) * along));
        let met = Misfit { left: JointSide::end(&left), right: JointSide::start(&right), ..*self };
        let [along, across, kink] = Self::miss(&met.left.station, &met.right.station);
        if along.hypot(across) <= self.rounding {
            return Some(Closed::met(left.clone(), right.clone()));
        }
        met.met(across, kink)
    }

    /// Returns the share of a gap along the tangent by which the left segment is continued; the right segment is extended
    /// by the rest. The flatter segment is continued further, because it turns less on the way; a line takes the whole gap
    /// beside an arc.
    fn share(&self) -> f64 {
        let (left, right) = (self.left.segment.end_curvatures()[1], self.right.segment.end_curvatures()[0]);
        let share = right.abs() / (left.abs() + right.abs());
        if share.is_nan() { 0.5 } else { share }
    }

    /// Closes ends that miss each other only across the tangent.
    fn met(&self, across: f64, kink: f64) -> Option<Closed> {
        let most = BEND / self.chain;
        let w = (across.abs() / most).sqrt().max(SHORTEST * self.chain).min(self.longest);
        let sharp = kink.abs() > most * w;
        let crossing = if sharp { self.crossing(across, kink, w) } else { None };
        crossing.or_else(|| self.bend(w, across, if sharp { kink } else { 0.0 }))
    }

    /// Cuts or continues both segments to where they cross, by Newton steps along the tangents. Returns `None` if the
    /// crossing is farther than `w` or the kink changes too much.
    fn crossing(&self, across: f64, kink: f64, w: f64) -> Option<Closed> {
        let mut s = [0.0; 2];
        for _ in 0..MOST_CORRECTIONS {
            let (left, right) = (self.left.at(s[0]), self.right.at(s[1]));
            let apart = right.seen_from(&left);
            if apart.x.hypot(apart.z) <= 0.25 * self.rounding {
                let change = (apart.angle() - kink).abs();
                if s.iter().any(|s| s.abs() > w) || change > SAME_KINK * kink.abs() {
                    return None;
                }
                let mut closed = Closed::shared(self.left.cut(s[0]), self.right.cut(s[1]));
                let (step, reach) = (across.abs(), s[0].abs().max(s[1].abs()));
                closed.closing = Some(Closing { left: 0, step, moved: step, reach });
                return Some(closed);
            }
            // Solves left + a·t_left = right + b·t_right in the axes of the left station.
            let b = -apart.z / apart.sin;
            s = [s[0] + apart.x + b * apart.cos, s[1] + b];
        }
        None
    }

    /// Bends both segments towards each other over `w` until they meet with the kink `kept`. Returns `None` if the step is
    /// too large for `w`.
    fn bend(&self, w: f64, across: f64, kept: f64) -> Option<Closed> {
        if across.abs() > STEEPEST * w {
            return None;
        }
        let mut bents = [Bent { reach: w, length: w, change: 0.0 }; 2];
        let mut last = f64::INFINITY;
        for _ in 0..MOST_CORRECTIONS {
            let (left, right) = (self.left.bent(&bents[0]), self.right.bent(&bents[1]));
            let apart = right.start().seen_from(&left.end());
            if bents.iter().any(|bent| !(bent.length <= 2.0 * w && bent.length >= 0.5 * w)) {
                return None;
            }
            let turn = apart.angle() - kept;
            let miss = apart.x.hypot(apart.z) + turn.abs() * w;
            if miss <= 0.25 * self.rounding && miss >= 0.5 * last {
                let mut closed = Closed::shared(left, right);
                closed.left = [Some(self.left.cut(-w)), closed.left[0].take()];
                closed.right = [closed.right[1].take(), Some(self.right.cut(w))];
                let step = across.abs();
                closed.closing = Some(Closing { left: 0, step, moved: 0.5 * step, reach: w });
                return Some(closed);
            }
            last = miss;
            let (lift, level) = (apart.z / (w * w), turn / (2.0 * w));
            bents[0].change += level + lift;
            bents[1].change += level - lift;
            bents[0].length += 0.5 * apart.x;
            bents[1].length += 0.5 * apart.x;
        }
        None
    }

    fn refusal(&self, place: String) -> Error {
        let [along, across, _] = Self::miss(&self.left.station, &self.right.station);
        let found = format!(
            "{:.6} mm across and {:.6} mm along from the end of the segment before, at x = {}",
            across.abs(),
            along.abs(),
            self.left.station.x
        );
        let expected = format!("a step that the {:.6} mm beside it can take", self.longest);
        Error::new(place, found, expected, "correct the end points, or leave out the short segment")
    }
}

impl Closed {
    /// Makes the joint of two segments that meet already.
    fn met(left: Segment, right: Segment) -> Self {
        Self { left: [Some(left), None], right: [None, Some(right)], closing: None }
    }

    /// Joins two segments whose ends differ only by rounding. Beside a polynomial, an arc takes over the polynomial's end;
    /// two arcs share the point between their ends.
    fn shared(mut left: Segment, mut right: Segment) -> Self {
        let (end, start) = (left.end(), right.start());
        let middle = |a: f64, b: f64| if a == b { a } else { a + 0.5 * (b - a) };
        // Along its tangent an end may move by roundings of x and stay on its arc. Across the tangent it may move only by
        // roundings of z.
        let slid =
            |at: &Station, x: f64| if at.cos < GRAPH { at.z } else { at.z + (x - at.x) * at.sin / at.cos };
        match (&mut left.shape, &mut right.shape) {
            (Shape::Arc(left), Shape::Arc(right)) => {
                let x = middle(end.x, start.x);
                let z = middle(slid(&end, x), slid(&start, x));
                (left.end.x, left.end.z) = (x, z);
                (right.start.x, right.start.z) = (x, z);
            }
            (Shape::Arc(left), _) => (left.end.x, left.end.z) = (start.x, start.z),
            (_, Shape::Arc(right)) => (right.start.x, right.start.z) = (end.x, end.z),
            _ => {}
        }
        Self::met(left, right)
    }
}

#[cfg(test)]
mod tests;

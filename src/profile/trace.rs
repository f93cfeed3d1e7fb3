//! Follows a profile by arc length, to plot it and to compare two curves.

use nalgebra::Point2;

use super::{Polynomial, Profile, Segment, Shape, Station};
use crate::numerics::twice::Twice;

/// A station with its distance along the profile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mark {
    /// Arc length from the profile's left end \[mm\]. A step of a drawing counts by its length.
    pub s: f64,
    /// Point and tangent.
    pub station: Station,
    /// Curvature \[1/mm\], positive with the hollow side up.
    pub curvature: f64,
    /// Index of the segment.
    pub segment: usize,
}

impl Mark {
    /// Returns the point \[x, z\] \[mm\] at a share (0 to 1) of the way to the next mark, on the cubic through both points with their
    /// tangents. It is off the curve by about (κ″ − κ³)a⁴/384, with a the distance of the marks. The two sides of a joint are one
    /// point, and a step of a drawing is straight.
    pub fn between(&self, next: &Self, share: f64) -> [f64; 2] {
        let (a, b) = (self.station, next.station);
        let pull = if self.segment == next.segment { next.s - self.s } else { 0.0 };
        let blend = if pull == 0.0 { share } else { share * share * (3.0 - 2.0 * share) };
        let [from, to] = [pull * share * (1.0 - share).powi(2), -pull * share * share * (1.0 - share)];
        [
            a.x + blend * (b.x - a.x) + from * a.cos + to * b.cos,
            a.z + blend * (b.z - a.z) + from * a.sin + to * b.sin,
        ]
    }
}

/// The position of a point beside a trace.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Beside {
    /// Index of the nearest mark.
    pub mark: usize,
    /// Arc length of the foot \[mm\].
    pub s: f64,
    /// Distance across the tangent \[mm\], positive to the left of the direction of travel: above a tread.
    pub across: f64,
}

/// Largest number of steps of a trace. On a profile of 300 mm they are a third of a micrometre long.
const MOST_STEPS: f64 = 1e6;

/// Returns marks at most `step` \[mm\] apart, in order of ascending s. Each joint has a mark on either side. A step below a
/// millionth of the profile's length is replaced by that: compare the s of neighbours where it matters.
///
/// Accuracy: s is a sum over arcs of the curvature κ at the end of each step a. Its relative error is about (aκ)⁴/200 on an arc, and
/// a³κκ′/24 more on a polynomial.
///
/// # Examples
/// ```
/// use wheelrail::profile::{beside, standards, trace};
///
/// let marks = trace(&standards::rail("60E1")?, 0.1);
/// let top = beside(&marks, [0.0, 1.0], 0).expect("a trace with marks"); // 1 mm above the crown
/// assert!((top.across - 1.0).abs() < 1e-6);
/// # Ok::<(), wheelrail::Error>(())
/// ```
pub fn trace(profile: &Profile, step: f64) -> Vec<Mark> {
    let step = bounded(step, profile);
    let mut marks: Vec<Mark> = Vec::new();
    for (index, segment) in profile.segments().iter().enumerate() {
        let shares = shares(segment, step);
        for k in 0..=shares {
            let share = k as f64 / shares as f64;
            let (station, curvature) = at_share(segment, share);
            let walked = marks.last().map_or(0.0, |last| last.s + chord(&last.station, &station, curvature));
            marks.push(Mark { s: walked, station, curvature, segment: index });
        }
    }
    marks
}

/// Returns the points \[mm\] of the marks of [`trace`], for those who need neither tangents nor lengths; on polynomials to the
/// working precision.
pub fn points_along(profile: &Profile, step: f64) -> Vec<Point2<f64>> {
    let step = bounded(step, profile);
    let along = |segment: &Segment| {
        let shares = shares(segment, step);
        let at = |k: usize| match &segment.shape {
            Shape::Polynomial(polynomial) => point(polynomial, k as f64 / shares as f64),
            Shape::Arc(_) => {
                let (Station { x, z, .. }, _) = at_share(segment, k as f64 / shares as f64);
                Point2::new(x, z)
            }
        };
        (0..=shares).map(at).collect::<Vec<_>>()
    };
    profile.segments().iter().flat_map(along).collect()
}

/// Finds the foot of a point \[mm\] on a trace. The search begins at mark `hint`: for points in a row, pass the mark found
/// for the previous point.
///
/// Method: the circle of curvature at the nearest mark. The accuracy is κ′a³/6, with a half the distance of marks: about
/// 1e-6 mm for 0.1 mm. Cost: the marks between hint and foot. Of several feet it finds the first one from the hint. Returns
/// `None` for an empty trace.
pub fn beside(marks: &[Mark], [x, z]: [f64; 2], hint: usize) -> Option<Beside> {
    let square = |k: usize| {
        let at = &marks[k].station;
        (at.x - x).powi(2) + (at.z - z).powi(2)
    };
    let mut best = hint.min(marks.len().checked_sub(1)?);
    for forward in [true, false] {
        // The search continues a little beyond a minimum: both marks of a joint are at one place, and noise or a bend may
        // hide the next minimum.
        let mut k = best;
        let mut idle = 0;
        while let Some(next) =
            if forward { Some(k + 1).filter(|&k| k < marks.len()) } else { k.checked_sub(1) }
        {
            k = next;
            idle = if square(k) < square(best) { 0 } else { idle + 1 };
            if idle == 0 {
                best = k;
            } else if idle > LOOKED_ON {
                break;
            }
        }
    }
    let mark = &marks[best];
    let at = Station { x, z, ..Station::AXES }.seen_from(&mark.station);
    let curvature = mark.curvature;
    let to_centre = (curvature * at.x).hypot(1.0 - curvature * at.z);
    let across = (2.0 * at.z - curvature * (at.x * at.x + at.z * at.z)) / (1.0 + to_centre);
    Some(Beside { mark: best, s: mark.s + at.x, across })
}

/// Number of marks beyond the nearest one so far over which the search goes on.
const LOOKED_ON: usize = 16;

/// Returns a step \[mm\], but at least that of [`MOST_STEPS`].
fn bounded(step: f64, profile: &Profile) -> f64 {
    let length: f64 = profile.segments().iter().map(segment_length).sum();
    step.max(length / MOST_STEPS)
}

/// Returns the station and the curvature \[1/mm\] at a share (0 to 1) of an arc's length or of a polynomial's range of the parameter.
fn at_share(segment: &Segment, share: f64) -> (Station, f64) {
    match &segment.shape {
        Shape::Arc(arc) if share == 1.0 => (arc.end, arc.curvature()),
        Shape::Arc(arc) => (arc.station_at(share), arc.curvature()),
        Shape::Polynomial(polynomial) => polynomial.station_and_curvature(parameter(polynomial, share)),
    }
}

/// Returns a polynomial's parameter at a share (0 to 1) of its range.
fn parameter(polynomial: &Polynomial, share: f64) -> f64 {
    polynomial.t.low + share * polynomial.t.width()
}

/// Returns the length of a segment \[mm\]. A polynomial is measured by chords, which are at most a few per cent too short.
fn segment_length(segment: &Segment) -> f64 {
    const CHORDS: usize = 8;
    match &segment.shape {
        Shape::Arc(arc) => arc.length(),
        Shape::Polynomial(polynomial) => chords(polynomial, CHORDS).sum(),
    }
}

/// Returns the number of equal shares into which a segment is divided so that none is longer than `step` \[mm\].
fn shares(segment: &Segment, step: f64) -> usize {
    let shares = |length: f64| (length / step).ceil().max(1.0) as usize;
    let polynomial = match &segment.shape {
        Shape::Arc(arc) => return shares(arc.length()),
        Shape::Polynomial(polynomial) => polynomial,
    };
    let mut count = 1;
    loop {
        // Equal shares of a polynomial's parameter differ in length.
        let longest = chords(polynomial, count).fold(0.0, f64::max);
        if longest <= step {
            return count;
        }
        count = shares(count as f64 * longest).max(count + 1);
    }
}

/// Returns the lengths \[mm\] of the chords over equal shares of a polynomial's range.
fn chords(polynomial: &Polynomial, count: usize) -> impl Iterator<Item = f64> {
    let at = move |k: usize| point(polynomial, k as f64 / count as f64);
    let mut last = at(0);
    (1..=count).map(move |k| {
        let to = at(k);
        let from = std::mem::replace(&mut last, to);
        nalgebra::distance(&from, &to)
    })
}

/// Returns the point \[mm\] at a share (0 to 1) of a polynomial's range, in the working precision.
fn point(polynomial: &Polynomial, share: f64) -> Point2<f64> {
    let t = parameter(polynomial, share);
    let at = |c: &[Twice]| c.iter().rev().fold(0.0, |sum, c| sum * t + c.high);
    Point2::new(at(&polynomial.x), at(&polynomial.z))
}

/// Returns the distance of two stations \[mm\].
fn distance(a: &Station, b: &Station) -> f64 {
    (b.x - a.x).hypot(b.z - a.z)
}

/// Returns the length \[mm\] of the circular arc over a chord, to the second order of chord × curvature.
fn chord(a: &Station, b: &Station, curvature: f64) -> f64 {
    let chord = distance(a, b);
    chord * (1.0 + (chord * curvature).powi(2) / 24.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Result;
    use crate::profile::{Arc, Half, standards};

    fn half_circle() -> Result<Profile> {
        let arc = |x| Arc::about([0.0, 0.0], 50.0, Half::Upper, x).map(Segment::arc);
        Profile::new("circle", "test", vec![arc([-40.0, 0.0])?, arc([0.0, 40.0])?])
    }

    #[test]
    fn a_trace_is_bounded_whatever_the_step() -> Result<()> {
        let marks = trace(&half_circle()?, 1e-300);
        assert!((1_000_000..1_000_100).contains(&marks.len()), "{}", marks.len());
        Ok(())
    }

    #[test]
    fn points_beside_a_circle_lie_as_far_as_their_radius_says() -> Result<()> {
        let marks = trace(&half_circle()?, 0.1);
        let whole = 2.0 * 0.8f64.asin() * 50.0;
        assert!(marks.last().is_some_and(|last| (last.s - whole).abs() < 1e-6 * whole));
        let mut hint = 0;
        for k in 1..80 {
            let angle = (f64::from(k) / 80.0 - 0.5) * 2.0 * 0.8f64.asin();
            let radius = 50.0 + 0.01 * f64::from(k % 3 - 1);
            let found = beside(&marks, [radius * angle.sin(), radius * angle.cos()], hint).expect("marks");
            hint = found.mark;
            assert!((found.across - (radius - 50.0)).abs() < 1e-12, "{k}: {found:?}");
            assert!((found.s - 50.0 * angle - 0.5 * whole).abs() < 1e-4, "{k}: {found:?}");
        }
        Ok(())
    }

    #[test]
    fn no_step_is_longer_than_asked_for() -> Result<()> {
        for name in standards::wheel_names() {
            let marks = trace(&standards::wheel(name)?, 0.2);
            let longest = marks.windows(2).filter(|pair| pair[0].segment == pair[1].segment);
            let longest =
                longest.map(|pair| distance(&pair[0].station, &pair[1].station)).fold(0.0, f64::max);
            assert!(longest <= 0.2, "{name}: {longest}");
        }
        Ok(())
    }
}

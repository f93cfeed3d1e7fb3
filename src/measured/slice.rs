//! Cuts a section out of a list of slices: finds the slices on both sides of it and interpolates between their points.

use serde::Serialize;

use super::clean::checks::{SAME_POINT, distance};
use super::options::Options;
use super::read::points::Point;
use super::read::slices::{ListedSlice, SliceList, unit};
use crate::error::{Error, Result, finite};
use crate::numerics::interval::Interval;
use crate::profile::Side;

/// Distance from a slice \[mm or rad\] up to which a section is that slice. A position converted from another unit is
/// rounded by less.
const SAME_PLACE: f64 = 1e-6;

/// A section of a variable profile: where it lies, and what of the list belongs to it.
#[derive(Debug, Clone, PartialEq)]
pub struct SectionOfList<'a> {
    side: Side,
    /// Position along the track \[mm\] or around the wheel \[rad\], in [−π, π).
    at: f64,
    first: &'a ListedSlice,
    /// The slice after it, and its share in (0, 1).
    second: Option<(&'a ListedSlice, f64)>,
}

/// Where a section was cut, and what it was made of; written to summary.json.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CutRecord {
    /// Position along the track \[mm\]; `None` for a wheel.
    pub along: Option<f64>,
    /// Position around the wheel \[rad\]; `None` for a rail.
    pub angle: Option<f64>,
    /// One slice or two.
    pub slices: Vec<Share>,
    /// File whose points are those of the section; numbers and lines of points are those of this file.
    pub points_of: String,
}

/// The share of a slice in a section.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Share {
    /// File of the slice, as the list has it.
    pub file: String,
    /// Position of the slice \[mm or rad\].
    pub at: f64,
    /// Its share; the shares of a section add up to 1.
    pub share: f64,
}

/// Returns an angle in [−π, π).
fn around(angle: f64) -> f64 {
    use std::f64::consts::{PI, TAU};
    if (-PI..PI).contains(&angle) { angle } else { (angle + PI).rem_euclid(TAU) - PI }
}

impl<'a> SectionOfList<'a> {
    /// Finds the slices around the place that the options name.
    ///
    /// The angle around a wheel is first turned into \[−π, π). Where no slices lie on both sides of it, the nearer one of the first and
    /// the last slice around the wheel holds.
    ///
    /// # Errors
    /// No place, one that is not finite, or that of the other body; a place outside a rail's slices.
    pub fn new(list: &'a SliceList, options: &Options) -> Result<Self> {
        let (key, given, other, taken) = match list.side {
            Side::Rail => ("along", options.along, "angle", options.angle.is_some()),
            Side::Wheel => ("angle", options.angle, "along", options.along.is_some()),
        };
        let unit = unit(list.side);
        let ends = match list.slices.as_slice() {
            [first, .., last] => [first.at, last.at],
            [only] => [only.at; 2],
            [] => [f64::NAN; 2],
        };
        let range = format!("a place from {} to {} {unit}", ends[0], ends[1]);
        if taken {
            let expected = format!("`{key}` for these slices, {range}");
            return Err(Error::new(other, "an option without effect", expected, "delete it"));
        }
        let Some(given) = given else {
            let found = format!("no `{key}` for {} slices", list.slices.len());
            let surface = match list.side {
                Side::Rail => "; in [wheelset] it places a wheelset on all of them",
                Side::Wheel => "; `wheelrail march` takes all of them",
            };
            return Err(Error::new(key, found, range, format!("give `{key}`, in {unit}{surface}")));
        };
        let mut at = finite(key, given)?;
        let asked = if list.side == Side::Wheel { around(at) } else { at };
        if list.side == Side::Wheel {
            let off = ends.map(|end| around(asked - end).abs());
            let nearer = if off[0] < off[1] { ends[0] } else { ends[1] };
            at = if Interval::new(ends[0], ends[1]).contains(asked) { asked } else { nearer };
        } else if at < ends[0] - SAME_PLACE || at > ends[1] + SAME_PLACE {
            return Err(Error::new(key, format!("{at} {unit}"), range, "choose one that the slices cover"));
        }
        let near = list.slices.iter().find(|slice| (slice.at - at).abs() <= SAME_PLACE);
        let after = list.slices.partition_point(|slice| slice.at <= at);
        let pair = after.checked_sub(1).and_then(|k| list.slices.get(k..k + 2));
        let (first, second) = match (near, pair) {
            (Some(slice), _) => (slice, None),
            (None, Some([a, b])) => (a, Some((b, (at - a.at) / (b.at - a.at)))),
            _ => return Err(Error::new(key, format!("{at} {unit}"), range, "choose another place")),
        };
        Ok(Self { side: list.side, at: asked, first, second })
    }

    /// Gives the files to open, relative to the list; no file twice.
    pub fn files(&self) -> Vec<&'a str> {
        let second = self.second.map(|(slice, _)| slice.file.as_str());
        let second = second.filter(|file| *file != self.first.file);
        [self.first.file.as_str()].into_iter().chain(second).collect()
    }

    /// Gives the place in words.
    pub(super) fn place(&self) -> String {
        format!("section at {} {}", self.at, unit(self.side))
    }

    /// Makes the points of the section from those of its slices, which `points_of` gives in profile axes from left to
    /// right; returns them in that order with the record.
    ///
    /// Method: where the list has features, they divide each slice into parts; otherwise it is one part. A point of the section
    /// is the straight-line interpolation between the points of both slices at equal relative arc length in the same part,
    /// the arc length being that of the polygon. The part's points are those of the slice that has more there. Parts that
    /// only one of the slices has end at that slice.
    /// Accuracy: h²κ/8 for the polygon of the other slice with a spacing h and a curvature κ, and d²/8 times the second
    /// derivative along the track for slices d apart; at a slice both are 0.
    ///
    /// # Errors
    /// Features that do not ascend along a slice; two slices without a common part.
    pub(super) fn interpolate(
        &self,
        points_of: impl Fn(&str) -> Result<Vec<Point>>,
    ) -> Result<(Vec<Point>, CutRecord)> {
        let first = self.path(self.first, points_of(&self.first.file)?)?;
        let (mut points, from) = match self.second {
            None => (first.whole(), 0),
            Some((slice, share)) => between(&first, &self.path(slice, points_of(&slice.file)?)?, share)
                .ok_or_else(|| {
                    let found = format!("no part that both {} and {} have", self.first.file, slice.file);
                    let advice = "take a place at a slice, or add features";
                    Error::new("", found, "a common part", advice)
                })?,
        };
        if self.side == Side::Wheel {
            points.reverse();
        }
        let share = |slice: &ListedSlice, share| Share { file: slice.file.clone(), at: slice.at, share };
        let rest = self.second.map_or(0.0, |(_, share)| share);
        let slices: Vec<Share> = [share(self.first, 1.0 - rest)]
            .into_iter()
            .chain(self.second.map(|(slice, part)| share(slice, part)))
            .collect();
        let rail = self.side == Side::Rail;
        let record = CutRecord {
            along: rail.then_some(self.at),
            angle: (!rail).then_some(self.at),
            points_of: slices[from].file.clone(),
            slices,
        };
        Ok((points, record))
    }

    /// Lays the features of a slice out along its points.
    fn path(&self, slice: &ListedSlice, mut points: Vec<Point>) -> Result<SlicePath> {
        if self.side == Side::Wheel {
            points.reverse();
        }
        let mut arc = vec![0.0];
        for pair in points.windows(2) {
            arc.push(arc[arc.len() - 1] + distance(&pair[0], &pair[1]));
        }
        let length = arc[arc.len() - 1];
        let mut breaks: Vec<f64> =
            if slice.features.is_empty() { vec![0.0, length] } else { slice.features.clone() };
        let present = |s: &f64| *s >= -SAME_POINT;
        let ends = breaks.iter().position(present).zip(breaks.iter().rposition(present));
        let Some((from, to)) = ends.filter(|(from, to)| from < to) else {
            let found = format!("{} features", ends.map_or(0, |_| 1));
            let (expected, advice) = ("two features at least, its ends", "give it arc lengths");
            return Err(Error::new(&slice.file, found, expected, advice));
        };
        breaks[to] = breaks[to].min(length);
        if let Some(k) = (from + 1..=to).find(|&k| breaks[k] - breaks[k - 1] <= SAME_POINT) {
            let found = format!("feature {} at {} mm after one at {} mm", k + 1, breaks[k], breaks[k - 1]);
            let expected = format!("ascending arc lengths within the {length:.3} mm of the slice");
            return Err(Error::new(&slice.file, found, expected, "correct the list, or check the unit"));
        }
        Ok(SlicePath { points, arc, breaks, parts: [from, to] })
    }
}

/// A slice as a polygon, from the end at which arc lengths begin.
struct SlicePath {
    points: Vec<Point>,
    /// Arc length at each point \[mm\].
    arc: Vec<f64>,
    /// Arc lengths of the features \[mm\].
    breaks: Vec<f64>,
    /// The first and the last feature that the slice has.
    parts: [usize; 2],
}

impl SlicePath {
    /// Gives the indices of the points between two arc lengths, without points at them.
    fn inside(&self, arc: Interval) -> std::ops::Range<usize> {
        let first = self.arc.partition_point(|&s| s <= arc.low + SAME_POINT);
        let last = self.arc.partition_point(|&s| s < arc.high - SAME_POINT);
        first..last.max(first)
    }

    /// Gives the point of the polygon at an arc length \[mm\].
    fn at(&self, s: f64) -> Point {
        let k = self.arc.partition_point(|&other| other <= s).clamp(1, self.arc.len() - 1);
        let (a, b) = (&self.points[k - 1], &self.points[k]);
        let length = self.arc[k] - self.arc[k - 1];
        let share = if length > 0.0 { ((s - self.arc[k - 1]) / length).clamp(0.0, 1.0) } else { 0.0 };
        if share == 1.0 { *b } else { mixed(a, b, share) }
    }

    /// Gives the points from the first to the last feature, one at each.
    fn whole(&self) -> Vec<Point> {
        let [from, to] = self.parts.map(|k| self.breaks[k]);
        let inside = self.inside(Interval::new(from, to));
        [self.at(from)].into_iter().chain(self.points[inside].iter().copied()).chain([self.at(to)]).collect()
    }

    /// Gives the arc lengths \[mm\] at both ends of a part.
    fn part(&self, k: usize) -> Interval {
        Interval::new(self.breaks[k], self.breaks[k + 1])
    }
}

/// Interpolates between two slices, part by part. Gives the points, and which slice (0 or 1) most of them come from; `None`
/// without a common part.
fn between(a: &SlicePath, b: &SlicePath, share: f64) -> Option<(Vec<Point>, usize)> {
    let (from, to) = (a.parts[0].max(b.parts[0]), a.parts[1].min(b.parts[1]));
    if from >= to {
        return None;
    }
    let mut points = Vec::new();
    let mut counts = [0, 0];
    for k in from..to {
        let (own, other) = (a.part(k), b.part(k));
        let [inside_a, inside_b] = [a.inside(own), b.inside(other)];
        let denser_b = inside_b.len() > inside_a.len();
        counts[usize::from(denser_b)] += inside_a.len().max(inside_b.len());
        if points.is_empty() {
            points.push(mixed(&a.at(own.low), &b.at(other.low), share));
        }
        let scaled = |s: f64, from: Interval, onto: Interval| {
            onto.low + onto.width() * ((s - from.low) / from.width())
        };
        if denser_b {
            let mix = |j: usize| {
                let p = mixed(&a.at(scaled(b.arc[j], other, own)), &b.points[j], share);
                Point { x: p.x, z: p.z, ..b.points[j] }
            };
            points.extend(inside_b.map(mix));
        } else {
            points.extend(inside_a.map(|j| mixed(&a.points[j], &b.at(scaled(a.arc[j], own, other)), share)));
        }
        points.push(mixed(&a.at(own.high), &b.at(other.high), share));
    }
    Some((points, usize::from(counts[1] > counts[0])))
}

/// Gives the point at a share of the way from one to another, with weight, number and line of the first.
fn mixed(a: &Point, b: &Point, share: f64) -> Point {
    Point { x: a.x + share * (b.x - a.x), z: a.z + share * (b.z - a.z), ..*a }
}

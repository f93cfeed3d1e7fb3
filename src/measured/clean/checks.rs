//! Checks measured points in profile axes, from left to right. Each finding names its place in the file.

use serde::Serialize;

use super::course::Course;
use super::loops;
use super::order::{folds, reversals};
use super::runs::Path;
use crate::error::{Error, Result};
use crate::measured::options::Repair;
use crate::measured::read::points::Point;
use crate::measured::shape::{gauge_depth, has_flange_back};
use crate::profile::Side;

/// Distance \[mm\] below which two points are one: a nanometre is less than any instrument or file resolves.
pub(in crate::measured) const SAME_POINT: f64 = 1e-6;
/// Least length of a gap, as a multiple of the median distance of neighbours. A gap is also at least [`GAP`] long.
const GAP_RATIO: f64 = 10.0;
/// Least length of a gap \[mm\]: the length of a contact patch.
const GAP: f64 = 5.0;
/// Least share of the points at which the path of points in no order turns back; a shuffled path does at every second one.
const NO_ORDER: f64 = 0.1;

/// A kind of fault of measured points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Check {
    /// Two points are at one place.
    Duplicate,
    /// A single point is in the wrong place of the order.
    OutOfOrder,
    /// A stretch runs back over the previous one, as in stitched sections.
    ZigZag,
    /// The path turns back and does not return. A point was added or left over at an end.
    TurnsBack,
    /// A point is off the curve, or several neighbouring ones are: dirt, or rows that a scanner wrote where it saw nothing.
    Spike,
    /// The curve crosses itself.
    Loop,
    /// A long stretch has no points.
    Gap,
    /// The gauge face of a rail or the flange back of a wheel was not measured.
    MissingSideFace,
    /// The profile's shape contradicts its orientation, which follows from the definition of the format.
    Orientation,
    /// Smoothing takes away more than noise.
    Smoothing,
    /// The points are too far apart to show the shape between them.
    Sparse,
    /// The noise of the points leaves the curvature too uncertain for pressures.
    Noise,
}

/// A fault that was found.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Finding {
    /// The kind of fault.
    pub check: Check,
    /// Whether the points cannot carry a curve as they are.
    pub fatal: bool,
    /// Place in the file: "point 12 (line 40)".
    pub place: String,
    /// What was found there.
    pub found: String,
}

impl Finding {
    pub(super) fn new(check: Check, point: &Point, found: impl Into<String>) -> Self {
        let fatal = !matches!(check, Check::Gap | Check::MissingSideFace | Check::Orientation);
        Self { check, fatal, place: point.place(), found: found.into() }
    }

    /// Makes the finding that the shape contradicts the definition of the format. Its place is the file's first point.
    pub(in crate::measured) fn orientation(first: &Point, found: String) -> Self {
        Self::new(Check::Orientation, first, found)
    }

    /// Makes the finding of rows without values behind a point.
    pub(in crate::measured) fn gap(before: &Point, found: String) -> Self {
        Self::new(Check::Gap, before, found)
    }

    /// Returns the repair that may mend the fault; `None` if none does.
    pub(in crate::measured) fn repair(&self) -> Option<Repair> {
        match self.check {
            Check::Duplicate => Some(Repair::DropDuplicates),
            Check::OutOfOrder | Check::ZigZag => Some(Repair::Sort),
            Check::Spike | Check::TurnsBack => Some(Repair::RemoveSpikes),
            Check::Loop => Some(Repair::CutLoops),
            Check::Gap
            | Check::MissingSideFace
            | Check::Orientation
            | Check::Smoothing
            | Check::Sparse
            | Check::Noise => None,
        }
    }

    /// Makes a finding about the curve through the points: it may be off the surface.
    pub(in crate::measured) fn of_curve(check: Check, place: String, found: String) -> Self {
        Self { check, fatal: false, place, found }
    }

    fn expectation(&self) -> (&'static str, &'static str) {
        match self.check {
            Check::Duplicate => ("different points", "delete one, or allow `repair = [\"drop-duplicates\"]`"),
            Check::OutOfOrder | Check::ZigZag => {
                ("points in order along the profile", "put them in order, or allow `repair = [\"sort\"]`")
            }
            Check::Spike => {
                ("points near the curve", "delete what lies off it, or allow `repair = [\"remove-spikes\"]`")
            }
            Check::Loop => ("a curve that does not cross itself", "allow `repair = [\"cut-loops\"]`"),
            Check::TurnsBack => ("a path that ends where the profile does", "delete what lies beyond it"),
            Check::Gap | Check::MissingSideFace => ("a complete profile", "measure it"),
            Check::Orientation => ("an upright right-hand profile", "correct `mirror` or `flip_z`"),
            Check::Smoothing | Check::Sparse | Check::Noise => {
                ("a curve near the surface", "measure closer points of less noise")
            }
        }
    }
}

/// Returns whether the smoothed path turns back all along.
pub(super) fn is_disordered(course: &Course) -> bool {
    reversals(&course.at).len() as f64 >= NO_ORDER * course.at.len() as f64
}

/// Returns the error of points in no order at all, whose shape says nothing.
pub(in crate::measured) fn no_order(points: &[Point]) -> Option<Error> {
    if !is_disordered(&Course::new(points)) {
        return None;
    }
    let back = reversals(points);
    let first = points.get(*back.first()?)?;
    let (count, n) = (back.len(), points.len());
    (count > 2).then(|| {
        let found = format!("points in no order: the path turns back at {count} of {n} points");
        let expected = "points in order along the profile, from one end to the other";
        Error::new(first.place(), found, expected, "sort the rows of the file")
    })
}

/// Finds all faults, in the order of [`Check`].
pub fn findings(points: &[Point], side: Side, gauge_height: f64) -> Vec<Finding> {
    let path = Path::of(points);
    let sound = &path.sound;
    let mut out = Vec::new();
    let found = |k: usize| format!("the same place as {}", sound[k - 1].place());
    out.extend(duplicates(sound).map(|k| Finding::new(Check::Duplicate, &sound[k], found(k))));
    out.extend(folds(&path).iter().map(|fold| fold.finding(points)));
    out.extend(path.runs.iter().map(|run| run.finding(points)));
    // A path that runs back crosses itself everywhere: beside a fatal finding, crossings are not sought.
    if !out.iter().any(|finding| finding.fatal) {
        out.extend(crossings(&path.course.at));
    }
    out.extend(gaps(sound).into_iter().map(|(k, step)| {
        let found = format!("no point over {step:.2} mm up to {}", sound[k + 1].place());
        Finding::new(Check::Gap, &sound[k], found)
    }));
    out.extend(missing_side_face(&path.course.at, side, gauge_height));
    out
}

fn crossings(points: &[Point]) -> Vec<Finding> {
    let found = loops::crossings(points);
    let crossing = |[a, b]: &[usize; 2]| {
        let found = format!("a loop: the curve crosses itself before {}", points[b + 1].place());
        Finding::new(Check::Loop, &points[*a], found)
    };
    let mut out: Vec<Finding> = found.edges.iter().map(crossing).collect();
    if let (Some(first), true) = (points.first(), found.cut_short) {
        let text = "too tangled a path to be searched for loops to its end: there may be some";
        out.push(Finding { fatal: false, ..Finding::new(Check::Loop, first, text) });
    }
    out
}

/// Rejects points with a fatal finding. The error names the first one and counts the others.
///
/// # Errors
/// At least one finding is fatal.
pub fn reject(findings: &[Finding]) -> Result<()> {
    let mut fatal = findings.iter().filter(|finding| finding.fatal);
    let Some(first) = fatal.next() else {
        return Ok(());
    };
    let (expected, advice) = first.expectation();
    let found = match fatal.filter(|other| other.check == first.check).count() {
        0 => first.found.clone(),
        more => format!("{} (and {more} more)", first.found),
    };
    Err(Error::new(first.place.clone(), found, expected, advice))
}

/// Returns the indices of points that are at the place of the previous point.
pub(in crate::measured) fn duplicates(points: &[Point]) -> impl Iterator<Item = usize> {
    points.windows(2).enumerate().filter(|(_, pair)| same(&pair[0], &pair[1])).map(|(k, _)| k + 1)
}

pub(in crate::measured) fn same(a: &Point, b: &Point) -> bool {
    distance(a, b) <= SAME_POINT
}

pub(in crate::measured) fn distance(a: &Point, b: &Point) -> f64 {
    (b.x - a.x).hypot(b.z - a.z)
}

/// Returns the median, or infinity without values.
pub(super) fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::INFINITY)
}

/// Returns the indices of points after which a long stretch has no points, and its lengths \[mm\].
fn gaps(points: &[Point]) -> Vec<(usize, f64)> {
    let steps: Vec<f64> = points.windows(2).map(|pair| distance(&pair[0], &pair[1])).collect();
    let least = GAP.max(GAP_RATIO * median(steps.clone()));
    steps.into_iter().enumerate().filter(|(_, step)| *step > least).collect()
}

fn missing_side_face(points: &[Point], side: Side, gauge_height: f64) -> Option<Finding> {
    let first = points.first()?;
    let found = match side {
        Side::Wheel if has_flange_back(points) => return None,
        Side::Wheel => "no back of the flange".to_owned(),
        Side::Rail => {
            let depth = gauge_depth(points);
            if depth >= gauge_height {
                return None;
            }
            format!("a gauge face measured down to {depth:.1} of {gauge_height} mm below the top")
        }
    };
    Some(Finding::new(Check::MissingSideFace, first, found))
}

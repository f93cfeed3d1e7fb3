//! The kinds of faults of measured points. Each finding names its place in the file.

use serde::Serialize;

use crate::error::{Error, Result};
use crate::measured::options::Repair;
use crate::measured::read::points::Point;

/// Distance \[mm\] below which two points are one: a nanometre is less than any instrument or file resolves.
pub(in crate::measured) const SAME_POINT: f64 = 1e-6;
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

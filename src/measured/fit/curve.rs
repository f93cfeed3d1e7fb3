//! Draws the curve through points or design elements, as segments of a chain.

use serde::Serialize;

use super::biarc;
use super::elements;
use super::kinks::{Kink, kinks};
use super::scatter::{Scatter, deviation};
use super::spline::{SplinePiece, pieces};
use crate::error::{Error, Result};
use crate::measured::clean::checks::{Check, Finding};
use crate::measured::options::{ARC_CUTOFFS, CurveKind, Options};
use crate::measured::read::points::{DesignElement, Point};
use crate::profile::Segment;

/// Share of an arc chain's tolerance that the smoothing before it may use.
const SMOOTHING_SHARE: f64 = 0.5;

/// Largest deviation of most points from a curve that is noise, as a multiple of the noise between neighbours.
const OF_NOISE: f64 = 1.25;

/// A corner of the curve.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Corner {
    /// Place of the point in the file.
    pub place: String,
    /// Coordinates \[x, z\] of the point \[mm\].
    pub point: [f64; 2],
    /// Turn of the tangent \[rad\], positive counter-clockwise.
    pub angle: f64,
}

/// Distances \[mm\] of the points from the curve, across its tangent.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Residual {
    /// Largest distance.
    pub largest: f64,
    /// Root mean square of the distances.
    pub rms: f64,
    /// Place of the point with the largest distance.
    pub worst: String,
}

/// The curve that was drawn, and its distance from the points.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CurveRecord {
    /// Kind of curve.
    pub kind: CurveKind,
    /// Wavelength \[mm\] whose waves smoothing halves; `None` without smoothing.
    pub cutoff_wavelength: Option<f64>,
    /// What decided that wavelength: the option, the noise of the points, the tolerance of the arcs, or the customary length.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cutoff_because: Option<&'static str>,
    /// Tolerance of a chain of arcs \[mm\]; `None` for other curves.
    pub tolerance: Option<f64>,
    /// Number of segments.
    pub segments: usize,
    /// The corners, from left to right.
    pub corners: Vec<Corner>,
    /// Distances of the points from the curve; `None` for design elements.
    pub residual: Option<Residual>,
    /// Standard deviation of the points across the profile \[mm\], from their distances to cubics through their neighbours; `None` for
    /// design elements.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub noise: Option<f64>,
    /// Standard deviation \[1/mm\] that the noise leaves of the curvature of a smoothed or interpolated curve.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub curvature_error: Option<f64>,
    /// What smoothing took away that is no noise; `None` if all of it is, or too small for pressures.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shape_taken: Option<ShapeTaken>,
}

/// The largest mean distance of the points from a smoothed curve over half of its cut-off wavelength.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ShapeTaken {
    /// Place of the point in the middle.
    pub place: String,
    /// Coordinates \[x, z\] of that point \[mm\].
    pub point: [f64; 2],
    /// The mean distance \[mm\], positive if the points lie above the curve.
    pub distance: f64,
}

/// Lists what makes a smoothed curve doubtful.
fn findings(record: &CurveRecord, points: &[Point], corners: &[usize], scatter: &Scatter) -> Vec<Finding> {
    let um = |length: f64| format!("{:.1} um", 1e3 * length.abs());
    let noise = um(scatter.noise);
    let mut out = Vec::new();
    if let (Some(taken), Some(cutoff)) = (&record.shape_taken, record.cutoff_wavelength) {
        let found = format!(
            "smoothing with a cut-off wavelength of {cutoff:.3} mm moves the curve by {} off points whose noise is {noise}: it takes \
             away shape, and angles, conicity and pressures there may be off; a shorter cutoff_wavelength takes less",
            um(taken.distance)
        );
        out.push(Finding::of_curve(Check::Smoothing, taken.place.clone(), found));
    }
    if let Some((at, off)) = scatter.unresolved(corners) {
        let found = format!(
            "points {:.2} mm apart, too far to show the shape here: one is {} off the cubic through its neighbours, and pressures may \
             be off; measure closer points",
            scatter.spacing,
            um(off)
        );
        out.push(Finding::of_curve(Check::Sparse, points[at].place(), found));
    }
    if let Some(error) = record.curvature_error.filter(|error| scatter.is_harmful(*error)) {
        let found = format!(
            "noise of {noise} leaves the curvature uncertain by {error:.1e} 1/mm, and pressures with it; a longer cutoff_wavelength or \
             closer points leave less"
        );
        out.push(Finding::of_curve(Check::Noise, points[0].place(), found));
    }
    out
}

/// Draws the curve that the options ask for. Returns its segments, its record, and what makes it doubtful.
///
/// # Errors
/// A curve of elements for a file without elements; a chain of arcs that cannot keep its tolerance.
pub(in crate::measured) fn curve(
    points: &[Point],
    elements: &[DesignElement],
    options: &Options,
    without_points: bool,
) -> Result<(Vec<Segment>, CurveRecord, Vec<Finding>)> {
    let default = if without_points { CurveKind::Elements } else { CurveKind::Smoothing };
    let kind = options.curve.unwrap_or(default);
    if kind == CurveKind::Elements {
        return design(elements);
    }
    let scatter = Scatter::of(points);
    let found = kinks(points, options.kink_angle(), scatter.size);
    let corners: Vec<usize> = found.iter().map(|kink| kink.at).collect();
    let arcs_alone = kind == CurveKind::Arcs;
    let DrawnCurve { segments, residuals, cutoff, because } = match kind {
        CurveKind::Arcs => arcs(points, &corners, options)?,
        CurveKind::Interpolation => splined(pieces(points, &corners, None), points, None)?,
        _ => smoothed(points, &corners, options, &scatter)?,
    };
    let shape_taken =
        cutoff.filter(|_| !arcs_alone).and_then(|cutoff| scatter.shape_taken(&residuals, cutoff));
    let taken = |(at, distance): (usize, f64)| {
        let point = &points[at];
        ShapeTaken { place: point.place(), point: point.xz(), distance }
    };
    let record = CurveRecord {
        kind,
        cutoff_wavelength: cutoff,
        cutoff_because: because,
        tolerance: arcs_alone.then(|| options.arc_tolerance()),
        segments: segments.len(),
        corners: found.iter().map(|kink| corner(kink, points)).collect(),
        residual: residual(&residuals, points),
        noise: Some(scatter.noise),
        curvature_error: (!arcs_alone).then(|| scatter.curvature_error(cutoff.unwrap_or(0.0))),
        shape_taken: shape_taken.map(taken),
    };
    let smoothing = kind == CurveKind::Smoothing;
    let findings = if smoothing { findings(&record, points, &corners, &scatter) } else { Vec::new() };
    Ok((segments, record, findings))
}

fn corner(kink: &Kink, points: &[Point]) -> Corner {
    let point = &points[kink.at];
    Corner { place: point.place(), point: point.xz(), angle: kink.angle }
}

fn residual(residuals: &[f64], points: &[Point]) -> Option<Residual> {
    let worst = (0..residuals.len()).max_by(|&a, &b| residuals[a].abs().total_cmp(&residuals[b].abs()))?;
    let sum: f64 = residuals.iter().map(|r| r * r).sum();
    let rms = (sum / residuals.len() as f64).sqrt();
    Some(Residual { largest: residuals[worst].abs(), rms, worst: points[worst].place() })
}

/// Draws the design elements themselves.
fn design(elements: &[DesignElement]) -> Result<(Vec<Segment>, CurveRecord, Vec<Finding>)> {
    if elements.is_empty() {
        let advice = "choose \"smoothing\", \"interpolation\" or \"arcs\"";
        let expected = "a file with design elements (MPD1=…)";
        return Err(Error::new("curve = \"elements\"", "a file without any", expected, advice));
    }
    let segments = elements::segments(elements)?;
    let record = CurveRecord {
        kind: CurveKind::Elements,
        cutoff_wavelength: None,
        cutoff_because: None,
        tolerance: None,
        segments: segments.len(),
        corners: Vec::new(),
        residual: None,
        noise: None,
        curvature_error: None,
        shape_taken: None,
    };
    Ok((segments, record, Vec::new()))
}

/// Returns the distance \[mm\] of each point from the spline, across the tangent at the point's own knot; positive above it.
fn spline_residuals(pieces: &[SplinePiece], points: &[Point]) -> Vec<f64> {
    let mut residuals = vec![0.0; points.len()];
    for piece in pieces {
        for k in 0..piece.knots() {
            let (station, point) = (piece.station(k), &points[piece.from + k]);
            let across = (point.z - station.z) * station.cos - (point.x - station.x) * station.sin;
            residuals[piece.from + k] = across;
        }
    }
    residuals
}

/// A curve as it was drawn.
struct DrawnCurve {
    segments: Vec<Segment>,
    /// Distance of each point from it \[mm\].
    residuals: Vec<f64>,
    /// Cut-off wavelength of its smoothing \[mm\], and what decided it.
    cutoff: Option<f64>,
    because: Option<&'static str>,
}

fn splined(
    pieces: Vec<SplinePiece>,
    points: &[Point],
    cutoff: Option<(f64, &'static str)>,
) -> Result<DrawnCurve> {
    let (cutoff, because) = cutoff.unzip();
    let mut segments = Vec::with_capacity(points.len());
    for piece in &pieces {
        segments.extend(piece.segments(cutoff)?);
    }
    Ok(DrawnCurve { segments, residuals: spline_residuals(&pieces, points), cutoff, because })
}

/// Smooths with the cut-off wavelength that the options give; otherwise with the shortest at which the noise does the curvature no
/// harm, and at most with the customary one.
///
/// What most points are off the curve is noise too, whatever its waves: where it exceeds the noise between neighbours, the wavelength
/// is at least doubled.
fn smoothed(points: &[Point], corners: &[usize], options: &Options, scatter: &Scatter) -> Result<DrawnCurve> {
    let fit = |cutoff: f64| pieces(points, corners, Some(cutoff));
    if let Some(cutoff) = options.cutoff_wavelength {
        return splined(fit(cutoff), points, Some((cutoff, "option `cutoff_wavelength`")));
    }
    let longest = scatter.longest();
    let (mut noise, mut cutoff) = (scatter.noise, scatter.harmless(scatter.noise));
    while cutoff < longest {
        let pieces = fit(cutoff);
        let off = deviation(spline_residuals(&pieces, points).into_iter());
        if off <= OF_NOISE * noise {
            return splined(pieces, points, Some((cutoff, "the noise of the points")));
        }
        (noise, cutoff) = (off, scatter.harmless(off).max(2.0 * cutoff));
    }
    splined(fit(longest), points, Some((longest, "the size of the profile")))
}

/// Fits a chain of arcs to the tangents of a spline. The spline has the smoothing that the options give; otherwise it has
/// the strongest smoothing that uses no more than half of the tolerance, or none.
fn arcs(points: &[Point], corners: &[usize], options: &Options) -> Result<DrawnCurve> {
    let tolerance = options.arc_tolerance();
    let fit = |cutoff: Option<f64>| (pieces(points, corners, cutoff), cutoff);
    let near = |(pieces, _): &(Vec<SplinePiece>, Option<f64>)| {
        let residuals = spline_residuals(pieces, points);
        residuals.into_iter().all(|off| off.abs() <= SMOOTHING_SHARE * tolerance)
    };
    let (pieces, cutoff) = match options.cutoff_wavelength {
        Some(cutoff) => fit(Some(cutoff)),
        None => {
            let mut smoothed = ARC_CUTOFFS.iter().map(|&cutoff| fit(Some(cutoff)));
            smoothed.find(near).unwrap_or_else(|| fit(None))
        }
    };
    let mut segments = Vec::new();
    let mut residuals = vec![0.0; points.len()];
    for piece in &pieces {
        let stations: Vec<_> = (0..piece.knots()).map(|k| piece.station(k)).collect();
        let own = &points[piece.from..piece.from + piece.knots()];
        let chain = biarc::chain(&stations, own, tolerance)?;
        residuals[piece.from..piece.from + own.len()].copy_from_slice(&chain.residuals);
        segments.extend(chain.arcs.into_iter().map(Segment::arc));
    }
    let given = options.cutoff_wavelength.map(|_| "option `cutoff_wavelength`");
    let because = cutoff.map(|_| given.unwrap_or("the tolerance of the arcs"));
    Ok(DrawnCurve { segments, residuals, cutoff, because })
}

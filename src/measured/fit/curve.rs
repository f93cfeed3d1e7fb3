//! Draws the curve through points or design elements, as segments of a chain.

use serde::Serialize;

use super::biarc;
use super::elements;
use super::kinks::{Kink, kinks};
use super::spline::{SplinePiece, pieces};
use crate::error::{Error, Result};
use crate::measured::options::{ARC_CUTOFFS, CUTOFF_WAVELENGTH, CurveKind, Options};
use crate::measured::read::points::{DesignElement, Point};
use crate::profile::Segment;

/// Share of an arc chain's tolerance that the smoothing before it may use.
const SMOOTHING_SHARE: f64 = 0.5;

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
    /// Tolerance of a chain of arcs \[mm\]; `None` for other curves.
    pub tolerance: Option<f64>,
    /// Number of segments.
    pub segments: usize,
    /// The corners, from left to right.
    pub corners: Vec<Corner>,
    /// Distances of the points from the curve; `None` for design elements.
    pub residual: Option<Residual>,
}

/// Draws the curve that the options ask for. Returns its segments and its record.
///
/// # Errors
/// A curve of elements for a file without elements; a chain of arcs that cannot keep its tolerance.
pub(in crate::measured) fn curve(
    points: &[Point],
    elements: &[DesignElement],
    options: &Options,
    without_points: bool,
) -> Result<(Vec<Segment>, CurveRecord)> {
    let default = if without_points { CurveKind::Elements } else { CurveKind::Smoothing };
    let kind = options.curve.unwrap_or(default);
    if kind == CurveKind::Elements {
        return design(elements);
    }
    let window = 0.5 * options.cutoff_wavelength.unwrap_or(CUTOFF_WAVELENGTH);
    let found = kinks(points, options.kink_angle(), window);
    let corners: Vec<usize> = found.iter().map(|kink| kink.at).collect();
    let (segments, residuals, cutoff) = match kind {
        CurveKind::Arcs => arcs(points, &corners, options)?,
        _ => {
            let smoothing = options.cutoff_wavelength.unwrap_or(CUTOFF_WAVELENGTH);
            let cutoff = (kind == CurveKind::Smoothing).then_some(smoothing);
            let pieces = pieces(points, &corners, cutoff);
            let mut segments = Vec::with_capacity(points.len());
            for piece in &pieces {
                segments.extend(piece.segments(cutoff)?);
            }
            (segments, spline_residuals(&pieces, points), cutoff)
        }
    };
    let tolerance = (kind == CurveKind::Arcs).then(|| options.arc_tolerance());
    let corners = found.iter().map(|kink| corner(kink, points)).collect();
    let record = CurveRecord {
        kind,
        cutoff_wavelength: cutoff,
        tolerance,
        segments: segments.len(),
        corners,
        residual: residual(&residuals, points),
    };
    Ok((segments, record))
}

fn corner(kink: &Kink, points: &[Point]) -> Corner {
    let point = &points[kink.at];
    Corner { place: point.place(), point: point.xz(), angle: kink.angle }
}

fn residual(residuals: &[f64], points: &[Point]) -> Option<Residual> {
    let worst = (0..residuals.len()).max_by(|&a, &b| residuals[a].total_cmp(&residuals[b]))?;
    let sum: f64 = residuals.iter().map(|r| r * r).sum();
    let rms = (sum / residuals.len() as f64).sqrt();
    Some(Residual { largest: residuals[worst], rms, worst: points[worst].place() })
}

/// Draws the design elements themselves.
fn design(elements: &[DesignElement]) -> Result<(Vec<Segment>, CurveRecord)> {
    if elements.is_empty() {
        let advice = "choose \"smoothing\", \"interpolation\" or \"arcs\"";
        let expected = "a file with design elements (MPD1=…)";
        return Err(Error::new("curve = \"elements\"", "a file without any", expected, advice));
    }
    let segments = elements::segments(elements)?;
    let record = CurveRecord {
        kind: CurveKind::Elements,
        cutoff_wavelength: None,
        tolerance: None,
        segments: segments.len(),
        corners: Vec::new(),
        residual: None,
    };
    Ok((segments, record))
}

/// Returns the distance \[mm\] of each point from the spline, across the tangent at the point's own knot.
fn spline_residuals(pieces: &[SplinePiece], points: &[Point]) -> Vec<f64> {
    let mut residuals = vec![0.0; points.len()];
    for piece in pieces {
        for k in 0..piece.knots() {
            let (station, point) = (piece.station(k), &points[piece.from + k]);
            let across = (point.z - station.z) * station.cos - (point.x - station.x) * station.sin;
            residuals[piece.from + k] = across.abs();
        }
    }
    residuals
}

type Arcs = (Vec<Segment>, Vec<f64>, Option<f64>);

/// Fits a chain of arcs to the tangents of a spline. The spline has the smoothing that the options give; otherwise it has
/// the strongest smoothing that uses no more than half of the tolerance, or none.
fn arcs(points: &[Point], corners: &[usize], options: &Options) -> Result<Arcs> {
    let tolerance = options.arc_tolerance();
    let fit = |cutoff: Option<f64>| (pieces(points, corners, cutoff), cutoff);
    let near = |(pieces, _): &(Vec<SplinePiece>, Option<f64>)| {
        let worst = spline_residuals(pieces, points).into_iter().fold(0.0, f64::max);
        worst <= SMOOTHING_SHARE * tolerance
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
    Ok((segments, residuals, cutoff))
}

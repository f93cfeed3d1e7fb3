//! Compares a method with the 60-digit values of a scene.

use super::reference::{ReferenceFile, exact};
use wheelrail::mesh::equal_steps;
use wheelrail::nalgebra::Vector2;
use wheelrail::placement::Placement;
use wheelrail::separation::{Choice, EtaAxis};

/// One compared point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ComparedPoint {
    /// ξ \[mm\].
    pub xi: f64,
    /// η \[mm\].
    pub eta: f64,
    /// Computed s \[mm\], NaN where the method finds no surface.
    pub found: f64,
    /// Exact s in f64 precision \[mm\], `None` where there is no surface.
    pub expected: Option<f64>,
    /// Whether the point is over both contact segments, where full relative accuracy is promised.
    pub over_contact: bool,
    /// Whether the point is over both contact segments, and not within rounding of one of their ends.
    pub inside_contact: bool,
}

impl ComparedPoint {
    /// Returns |found − expected| \[mm\]: 0 if there is no surface and none was found, NaN if only one of the
    /// two has a value.
    pub fn error(&self) -> f64 {
        match self.expected {
            Some(expected) => (self.found - expected).abs(),
            None if self.found.is_nan() => 0.0,
            None => f64::NAN,
        }
    }

    /// Returns the error relative to s; NaN if only one of the two has a value. Returns `None` at C itself, where s = 0 has
    /// no relative error, and where there is no surface.
    pub fn relative(&self) -> Option<f64> {
        self.expected.filter(|&expected| expected != 0.0).map(|expected| self.error() / expected.abs())
    }
}

/// Evaluates a choice at all points of a scene's file, in the file's order, on a grid with `columns` equally
/// spaced columns between them.
///
/// The η values are those of the file. Spectral columns then reach as far, and are the same polynomials, as on any grid
/// with the same largest |η|. Strips are made if there are many columns. With as many columns as a grid has, the comparison
/// is of that grid's own strips.
pub fn compare(
    reference: &ReferenceFile,
    placement: &Placement,
    choice: &Choice,
    columns: usize,
) -> Vec<ComparedPoint> {
    let [mut xi, eta] = reference.scene.axes();
    if let (Some(&first), Some(&last)) = (xi.first(), xi.last()) {
        xi.extend(equal_steps(first, last, columns));
        xi.sort_by(f64::total_cmp);
    }
    let axis = EtaAxis::new(&eta);
    let mut values = vec![0.0; xi.len() * eta.len()];
    choice.fill(placement, &xi, &axis, &mut values);
    let index = |values: &[f64], v: f64| values.partition_point(|&w| w < v);
    let points = reference.separation.iter().map(|(x, y, value)| ComparedPoint {
        xi: *x,
        eta: *y,
        found: values[index(&xi, *x) * eta.len() + index(&eta, *y)],
        expected: value.as_deref().map(exact),
        over_contact: over_contact(placement, *x, *y),
        inside_contact: inside_contact(placement, *x, *y),
    });
    points.collect()
}

/// Returns whether (ξ, η) lies over the contact segments of rail and wheel, and on the wheel's also the profile point that
/// is turned to (ξ, η). That point is at ξ′ − e sinθ, with e ≈ η′²/2R.
pub fn over_contact(placement: &Placement, xi: f64, eta: f64) -> bool {
    on_contact(placement, xi, eta, 0.0)
}

/// Rounding of the ends of segments in the contact frame, as a share of the profiles' extent. It comes from their
/// abscissae.
const END_ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Returns whether a point is [`over_contact`] and not within rounding of an end. Nearer to an end, the point belongs to
/// the neighbour as well, where s has only absolute accuracy.
pub fn inside_contact(placement: &Placement, xi: f64, eta: f64) -> bool {
    let extent = placement.rail().profile().extent().max(placement.wheel().profile().extent());
    on_contact(placement, xi, eta, END_ROUNDING * extent)
}

fn on_contact(placement: &Placement, xi: f64, eta: f64, end: f64) -> bool {
    let own = placement.skew_rotation().inverse_transform_vector(&Vector2::new(xi, eta));
    let (xi_w, eta_w) = (own.x, own.y);
    let e = eta_w * eta_w / (2.0 * placement.rolling_radius());
    let raised = xi_w - e * placement.wheel().point().station.sin;
    placement.rail().section().on_contact_segment(xi, end)
        && [xi_w, raised].iter().all(|&xi| placement.wheel().section().on_contact_segment(xi, end))
}

/// The figures of one row of accuracy.csv. The largest errors are NaN if a method misses a surface, or finds
/// one where there is none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Errors {
    /// Largest absolute error \[mm\].
    pub max_abs: f64,
    /// Largest relative error, without C itself.
    pub max_rel: f64,
    /// 99 % quantile of the relative errors; of fewer than a hundred, the largest.
    pub q99_rel: f64,
    /// Place (ξ, η) of the largest absolute error \[mm\].
    pub worst: [f64; 2],
    /// Number of points with a value where there is none, or without one where there is one.
    pub wrongly_masked: usize,
}

impl Errors {
    /// Calculates the largest errors and quantiles of some points.
    pub fn of(points: &[ComparedPoint]) -> Self {
        let worst = points.iter().max_by(|p, q| p.error().total_cmp(&q.error()));
        let mut relative: Vec<f64> =
            points.iter().filter_map(ComparedPoint::relative).map(f64::abs).collect();
        relative.sort_by(f64::total_cmp);
        let quantile = |share: f64| {
            let rank = (share * relative.len() as f64).ceil() as usize;
            rank.checked_sub(1).and_then(|k| relative.get(k)).copied().unwrap_or(0.0)
        };
        Self {
            max_abs: worst.map_or(0.0, ComparedPoint::error),
            max_rel: quantile(1.0),
            q99_rel: quantile(0.99),
            worst: worst.map_or([0.0; 2], |point| [point.xi, point.eta]),
            wrongly_masked: points.iter().filter(|point| point.error().is_nan()).count(),
        }
    }
}

//! The normal gap of conformal contact against closest distances: no way to the wheel is shorter than the closest one, and the
//! closest one is that along the normal where both bodies' normals agree.

use std::fmt;

use serde::Serialize;
use wheelrail::conformal::NormalGap;
use wheelrail::error::{Error, Result};
use wheelrail::nalgebra::{Unit, Vector3};
use wheelrail::placement::Placement;
use wheelrail::profile::{Profile, Segment, Shape, Side};

use super::body::Solid;
use super::closest::to_point;
use super::compare::{ROUNDINGS, SAFETY, smallest_radius};
use super::floor::floors;
use super::meshes::Vector;
use super::sampler::SampledSurface;

/// Largest sine of the angle between the line of the normal gap and the wheel's normal at which both count as one direction.
const ONE_DIRECTION: f64 = 0.05;

/// Number of places of a polynomial at which its curvature is evaluated.
const SAMPLES: usize = 9;

/// A point of the rail with its normal gap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NormalGapSample {
    /// (σ, η) \[mm\].
    pub at: [f64; 2],
    /// The point (ξ, η, ζ) of the rail or roller \[mm\].
    pub point: [f64; 3],
    /// t \[mm\], finite.
    pub gap: f64,
    /// Outward unit normal of the rail.
    pub rail_normal: Unit<Vector3<f64>>,
    /// Outward unit normal of the wheel where the line along it ends.
    pub wheel_normal: Unit<Vector3<f64>>,
}

impl NormalGapSample {
    /// Evaluates the point at (σ, η) \[mm\]; `None` beyond the rail's range of σ and where the ray misses the wheel.
    pub fn at(gap: &NormalGap<'_>, sigma: f64, eta: f64) -> Option<Self> {
        let point = gap.point(sigma, eta)?;
        let normal = point.rail_normal;
        Some(Self {
            at: [sigma, eta],
            point: [point.rail.xi - point.below * normal.x, eta, point.rail.zeta - point.below * normal.z],
            gap: point.gap,
            rail_normal: normal,
            wheel_normal: point.wheel_normal?,
        })
    }

    /// The point (ξ, η, ζ) \[mm\] where the line of the normal gap ends on a body.
    pub(super) fn end(&self, side: Side) -> [f64; 3] {
        match side {
            Side::Rail => self.point,
            Side::Wheel => [0, 1, 2].map(|k| self.point[k] + self.gap * self.rail_normal[k]),
        }
    }
}

/// What the comparison found.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct NormalGapReport {
    /// Number of points that were compared.
    pub points: usize,
    /// Largest value \[mm\] of the closest distance less |t| less the allowed error; at most 0 if t agrees.
    pub beyond_mm: f64,
    /// Point (σ, η) \[mm\] of `beyond_mm`.
    pub at_mm: [f64; 2],
    /// Number of points at which both normals are one line.
    pub aligned: usize,
    /// Largest amount \[mm\] by which the closest distance of such a point is outside \[|t| cosβ − bend, |t|\], less the allowed error;
    /// β is the angle between the two normals.
    pub aligned_mm: f64,
    /// Whether t agrees everywhere.
    pub agrees: bool,
}

impl fmt::Display for NormalGapReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let said = if self.agrees { "agrees with" } else { "DISAGREES with" };
        let [sigma, eta] = self.at_mm;
        writeln!(f, "  normal gap t: {said} closest distances at {} points", self.points)?;
        writeln!(
            f,
            "    distance - |t| less both errors: at most {:.1e} mm, at σ = {sigma:.4}, η = {eta:.4} mm; expected at most 0",
            self.beyond_mm
        )?;
        writeln!(
            f,
            "    where both normals are one line to 3 degrees, {} points: at most {:.1e} mm outside of |t| cosβ to |t|",
            self.aligned, self.aligned_mm
        )
    }
}

/// Compares normal gaps with closest distances: under a wheel of revolution those of the rail's points from the wheel's mesh, under a
/// wheel that varies those of the wheel's points from the rail's mesh.
///
/// Cost: about a millisecond a point.
///
/// # Errors
/// Points or profiles that are not finite; no point that could be measured.
pub fn check_normal_gap(placement: &Placement, samples: &[NormalGapSample]) -> Result<NormalGapReport> {
    let reach = samples.iter().map(|sample| Vector3::from(sample.point).norm() + sample.gap.abs());
    let reach = reach.fold(0.0, f64::max);
    let from = if placement.lofted_wheel().is_some() { Side::Wheel } else { Side::Rail };
    let surface = match from {
        Side::Rail => SampledSurface::wheel(placement),
        Side::Wheel => SampledSurface::rail(placement),
    };
    let other = Solid::up_to(placement, surface, 2.0 * reach)?;
    let radius = smallest_radius(placement);
    let sharpest = sharpest_radius(placement.wheel().profile()).min(radius);
    let floors = floors(radius, placement.rolling_radius())?;
    let floor = floors.iter().map(|floor| floor.closest_mm).fold(0.0, f64::max);
    let mut report = NormalGapReport {
        points: 0,
        beyond_mm: f64::NEG_INFINITY,
        at_mm: [f64::NAN; 2],
        aligned: 0,
        aligned_mm: f64::NEG_INFINITY,
        agrees: true,
    };
    for sample in samples {
        let [xi, eta, zeta] = sample.end(from);
        let Some(closest) = to_point(&other, Vector::new(xi, eta, zeta)) else { continue };
        let rounding = ROUNDINGS * (placement.wheel_radius() + reach);
        let allowed = SAFETY * (floor + closest.error) + rounding;
        let longer = closest.distance - sample.gap.abs() - allowed;
        report.points += 1;
        if longer > report.beyond_mm {
            (report.beyond_mm, report.at_mm) = (longer, sample.at);
        }
        let (t, sine) = (sample.gap.abs(), sample.rail_normal.cross(&sample.wheel_normal).norm());
        if sine < ONE_DIRECTION {
            // A tangent plane inclined by β is t cosβ away; the wheel departs from it by at most t² sin²β over its smallest radius.
            // Measured from the wheel, t itself is the closest distance, since the line is a normal of the rail.
            let bend = t * sine * t * sine / sharpest;
            let expected = match from {
                Side::Rail => [t * (1.0 - sine * sine).sqrt() - bend, t],
                Side::Wheel => [t, t],
            };
            let difference = (expected[0] - closest.distance).max(closest.distance - expected[1]);
            report.aligned += 1;
            report.aligned_mm = report.aligned_mm.max(difference - allowed);
            report.agrees &= difference <= allowed;
        }
        report.agrees &= longer <= 0.0;
    }
    if report.points == 0 {
        let expected = "points over the wheel, of which at least one can be measured";
        return Err(Error::new("check: normal gap", "none", expected, "widen the window of the grid"));
    }
    Ok(report)
}

/// Computes the smallest radius of curvature of a profile \[mm\], of a polynomial at [`SAMPLES`] places.
fn sharpest_radius(profile: &Profile) -> f64 {
    let curvature = |segment: &Segment| match &segment.shape {
        Shape::Arc(arc) => arc.curvature().abs(),
        Shape::Polynomial(polynomial) => {
            let t = polynomial.range();
            (0..SAMPLES).map(|k| polynomial.curvature(t.step(k, SAMPLES - 1)).abs()).fold(0.0, f64::max)
        }
    };
    1.0 / profile.segments().iter().map(curvature).fold(0.0, f64::max)
}

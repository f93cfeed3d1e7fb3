//! The normal gap t, the angle α and both unit normals at single points.

use nalgebra::{Unit, Vector2, Vector3};

use super::arc_length::{RailArcLength, RailPoint};
use super::ray::RayBodies;
use super::sight;
use super::span::RayPoint;
use crate::lofted::{Feet, FramedLoft, LoftFoot};
use crate::placement::Placement;
use crate::profile::Side;

/// Number of equal steps in which the largest and least angle of a range are sought.
const ANGLE_STEPS: usize = 128;

/// Evaluates the normal gap over a placed pair. On a roller t is measured along the normals of its crown, the profile at η = 0: from
/// the roller to the wheel. On a rail that varies along the track it is measured along those of the section through C, from the rail's
/// surface; single points of bodies that vary take a millisecond, and more of one σ some microseconds.
///
/// # Examples
/// ```
/// # use wheelrail::{Arc, Half, Pair, Profile, Segment};
/// use wheelrail::conformal::NormalGap;
/// // A gauge corner of 13 mm in a root of 14 mm, on a wheel of 460 mm.
/// # let rail = Arc::about([0.0, -13.0], 13.0, Half::Upper, [-11.0, 11.0])?;
/// # let rail = Profile::new("corner", "", vec![Segment::arc(rail)])?;
/// # let wheel = Arc::about([0.0, -14.0], 14.0, Half::Upper, [-13.0, 13.0])?;
/// # let wheel = Profile::new("root", "", vec![Segment::arc(wheel)])?;
/// # let pair = Pair::new(rail, wheel, 460.0)?;
/// let placement = pair.placed(0.0, 0.0, 0.0)?;
/// let gap = NormalGap::new(&placement);
/// // At the angle α a ray from the corner's centre is √(14² − sin²α) − cos α − 13 longer to the root's circle.
/// let sigma = 13.0 * std::f64::consts::FRAC_PI_4;
/// let t = gap.gap(sigma, 0.0);
/// assert!((t - (f64::sqrt(14.0 * 14.0 - 0.5) - f64::sqrt(0.5) - 13.0)).abs() < 1e-14);
/// assert!((gap.angle(sigma) + std::f64::consts::FRAC_PI_4).abs() < 1e-15);
/// # Ok::<(), wheelrail::Error>(())
/// ```
#[derive(Debug)]
pub struct NormalGap<'a> {
    pub(super) bodies: RayBodies<'a>,
    pub(super) rail: RailArcLength<'a>,
    pub(super) placement: &'a Placement,
    /// The gap of a roller under its own profile, upside down; `None` on a rail.
    pub(super) under: Option<Box<NormalGap<'a>>>,
}

/// What is known at one point of the rail's surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GapPoint {
    /// The rail's point and normal.
    pub rail: RailPoint,
    /// t \[mm\]; NaN where the ray misses a body.
    pub gap: f64,
    /// The part of t \[mm\] by which a roller lies below its crown along the normal, and a rail that varies below its section through C;
    /// 0 on an extruded rail.
    pub below: f64,
    /// Whether the point lies over both contact segments, where t has its relative accuracy.
    pub over_contact: bool,
    /// Outward unit normal (ξ, η, ζ) of the rail, of a roller's crown, or of the section through C at this σ.
    pub rail_normal: Unit<Vector3<f64>>,
    /// Outward unit normal of the wheel where the ray meets it; `None` where it misses.
    pub wheel_normal: Option<Unit<Vector3<f64>>>,
}

/// A line of constant σ, with what one point of it knows for the next.
#[derive(Debug)]
pub struct Line {
    /// The rail's point and normal at η = 0.
    pub rail: RailPoint,
    /// Feet along that normal on the body that varies; `None` where both are swept.
    feet: Option<Feet<Box<FramedLoft>>>,
}

impl<'a> NormalGap<'a> {
    /// Prepares a placed pair: follows the rail's surface from C.
    pub fn new(placement: &'a Placement) -> Self {
        let under = placement.under().map(|under| Box::new(Self::new(under)));
        Self { bodies: RayBodies::new(placement), rail: RailArcLength::new(placement), placement, under }
    }

    /// Returns the rail by its arc length.
    pub fn rail(&self) -> &RailArcLength<'a> {
        &self.rail
    }

    /// Returns the line of constant σ \[mm\]; `None` beyond the rail's range.
    pub fn line(&self, sigma: f64) -> Option<Line> {
        let rail = self.rail.point(sigma)?;
        let turned = |lofted: &FramedLoft| lofted.turned([rail.xi, rail.zeta], [rail.sin, rail.cos]);
        let feet = self.placement.lofted().map(|lofted| Feet::new(Box::new(turned(lofted))));
        Some(Line { rail, feet })
    }

    /// Computes t(σ, η) \[mm\]: positive apart, negative where the bodies overlap, NaN beyond the rail's range of σ and
    /// where the ray misses a body.
    ///
    /// Method: the sagitta form along a line; see [`crate::docs::conformal`]. Accuracy: over both contact segments the error
    /// is below 1e-13 times the sum of the magnitudes of the terms of t; elsewhere below 2e-12 mm × max(1, R_max/300 mm).
    /// Both are checked against 60-digit values. With a body that varies it is below 1e-11 mm. Cost: about half a microsecond.
    pub fn gap(&self, sigma: f64, eta: f64) -> f64 {
        self.line(sigma).map_or(f64::NAN, |mut line| self.gap_on(&mut line, eta))
    }

    /// Computes t \[mm\] at η \[mm\] of a line.
    pub fn gap_on(&self, line: &mut Line, eta: f64) -> f64 {
        match self.foot(line, eta) {
            Some((Side::Wheel, foot)) => foot.map_or(f64::NAN, |foot| foot.zeta),
            Some((Side::Rail, foot)) => foot.map_or(f64::NAN, |foot| self.above(&line.rail, eta) - foot.zeta),
            None => {
                let above = self.above(&line.rail, eta);
                self.under.as_ref().map_or(above, |under| above + under.gap(line.rail.sigma, eta))
            }
        }
    }

    /// Computes ∂t/∂η at η \[mm\] of a line; NaN where t is.
    pub fn slope_on(&self, line: &mut Line, eta: f64) -> f64 {
        let above = |rail: &RailPoint| {
            self.meeting(rail, eta).map_or(f64::NAN, |point| {
                let normal = self.wheel_normal(&point);
                normal.y / (rail.sin * normal.x - rail.cos * normal.z)
            })
        };
        match self.foot(line, eta) {
            Some((Side::Wheel, foot)) => foot.map_or(f64::NAN, |foot| foot.slopes[1]),
            Some((Side::Rail, foot)) => foot.map_or(f64::NAN, |foot| above(&line.rail) - foot.slopes[1]),
            None => {
                let above = above(&line.rail);
                self.under.as_ref().map_or(above, |under| above + under.slope(line.rail.sigma, eta))
            }
        }
    }

    /// Computes ∂t/∂η at one point; NaN where t is.
    pub fn slope(&self, sigma: f64, eta: f64) -> f64 {
        self.line(sigma).map_or(f64::NAN, |mut line| self.slope_on(&mut line, eta))
    }

    /// Finds the foot on the body that varies, and says which it is; `None` where both are swept.
    fn foot(&self, line: &mut Line, eta: f64) -> Option<(Side, Option<LoftFoot>)> {
        let feet = line.feet.as_mut()?;
        Some((feet.body().side(), feet.at(0.0, eta)))
    }

    /// Computes the height \[mm\] of a wheel of revolution over the rail's point, along its normal.
    fn above(&self, rail: &RailPoint, eta: f64) -> f64 {
        self.meeting(rail, eta).map_or(f64::NAN, |point| point.t)
    }

    /// Returns α(σ) \[rad\], the angle of the rail's outward normal from ζ, positive counter-clockwise; NaN beyond the range of
    /// σ.
    pub fn angle(&self, sigma: f64) -> f64 {
        self.rail.point(sigma).map_or(f64::NAN, |at| at.sin.atan2(at.cos))
    }

    /// Returns the least and largest α \[rad\] over a range of σ \[mm\], at its ends, joints and equal steps between.
    pub fn angles(&self, [a, b]: [f64; 2]) -> [f64; 2] {
        let steps = (0..=ANGLE_STEPS).map(|k| a + (b - a) * k as f64 / ANGLE_STEPS as f64);
        let joints = self.rail.joints().into_iter().filter(|sigma| a < *sigma && *sigma < b);
        let all = steps.chain(joints).map(|sigma| self.angle(sigma)).filter(|angle| !angle.is_nan());
        all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], angle| [low.min(angle), high.max(angle)])
    }

    /// Computes everything at one point; `None` beyond the rail's range of σ.
    pub fn point(&self, sigma: f64, eta: f64) -> Option<GapPoint> {
        self.line(sigma).map(|mut line| self.point_on(&mut line, eta))
    }

    /// Computes everything at η \[mm\] of a line.
    pub fn point_on(&self, line: &mut Line, eta: f64) -> GapPoint {
        let (foot, rail) = (self.foot(line, eta), line.rail);
        let met = self.meeting(&rail, eta);
        let over_contact = foot.is_none() && met.is_some_and(|met| met.over_contact);
        let (above, below, wheel_normal) = match foot {
            Some((Side::Wheel, foot)) => {
                let normal = foot.map(|foot| {
                    let down = -foot.normal();
                    let xi = rail.cos * down.x - rail.sin * down.z;
                    Unit::new_unchecked(Vector3::new(xi, down.y, rail.sin * down.x + rail.cos * down.z))
                });
                (foot.map_or(f64::NAN, |foot| foot.zeta), 0.0, normal)
            }
            varying => {
                let below = match varying {
                    Some((_, foot)) => foot.map_or(f64::NAN, |foot| -foot.zeta),
                    None => self.under.as_ref().map_or(0.0, |under| under.gap(rail.sigma, eta)),
                };
                (met.map_or(f64::NAN, |met| met.t), below, met.map(|point| self.wheel_normal(&point)))
            }
        };
        let rail_normal = Unit::new_unchecked(Vector3::new(-rail.sin, 0.0, rail.cos));
        GapPoint { rail, gap: above + below, below, over_contact, rail_normal, wheel_normal }
    }

    fn meeting(&self, rail: &RailPoint, eta: f64) -> Option<RayPoint> {
        sight::point(&self.bodies.ray(rail, eta))
    }

    /// Computes the wheel's outward unit normal (ξ, η, ζ) at a point of a ray.
    fn wheel_normal(&self, point: &RayPoint) -> Unit<Vector3<f64>> {
        let wheel = &self.bodies.wheel;
        let tangent = wheel.section.branches[point.branch].station(point.abscissa);
        let own = wheel.normal_at(&tangent, point.w, point.eta);
        let turned = self.placement.skew_rotation() * Vector2::new(own.x, own.y);
        Unit::new_unchecked(Vector3::new(turned.x, turned.y, own.z))
    }
}

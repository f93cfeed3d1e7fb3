//! The normal gap t, the angle α and both unit normals at single points.

use nalgebra::{Unit, Vector2, Vector3};

use super::arc_length::{RailArcLength, RailPoint};
use super::ray::RayBodies;
use super::sight;
use super::span::RayPoint;
use crate::lofted::{Feet, FramedLoft, LoftFoot};
use crate::numerics::interval::Interval;
use crate::placement::Placement;
use crate::separation::GapSlopes;

/// Number of equal steps in which the largest and least angle of a range are sought.
const ANGLE_STEPS: usize = 128;

/// Evaluates the normal gap over a placed pair. On a roller t is measured along the normals of its crown, the profile at η = 0: from
/// the roller to the wheel. On a rail that varies along the track it is measured along those of the section through C, from the rail's
/// surface. With a body that varies a single point takes up to a millisecond, and every further one of the same [`GapColumn`] some
/// microseconds.
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

/// The column of one σ, with the feet of its last point, from which those of the next are sought.
#[derive(Debug)]
pub struct GapColumn {
    /// The point and normal of the rail's profile.
    pub rail: RailPoint,
    /// Feet along that normal on a wheel that varies; `None` on a wheel of revolution.
    wheel: Option<Feet<Box<FramedLoft>>>,
    /// Feet along that normal on a rail that varies; `None` on a rail or roller that is swept.
    below: Option<Feet<Box<FramedLoft>>>,
    /// The column of a roller under its own profile, upside down; `None` on a rail.
    under: Option<Box<GapColumn>>,
}

/// The wheel's point on a line along the rail's normal.
enum WheelPoint {
    /// A point of a wheel of revolution.
    Round(RayPoint),
    /// A point of a wheel that varies, as a foot along that normal.
    Varying(LoftFoot),
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

    /// Returns the column of σ \[mm\]; `None` beyond the rail's range.
    pub fn column(&self, sigma: f64) -> Option<GapColumn> {
        let rail = self.rail.point(sigma)?;
        let feet = |body: Option<&FramedLoft>| {
            let turned = body?.turned([rail.xi, rail.zeta], [rail.sin, rail.cos]);
            Some(Feet::new(Box::new(turned)))
        };
        let (wheel, below) = (feet(self.placement.lofted_wheel()), feet(self.placement.lofted_rail()));
        let under = match &self.under {
            Some(under) => Some(Box::new(under.column(sigma)?)),
            None => None,
        };
        Some(GapColumn { rail, wheel, below, under })
    }

    /// Computes t(σ, η) \[mm\]: positive apart, negative where the bodies overlap, NaN beyond the rail's range of σ and
    /// where the ray misses a body.
    ///
    /// Method: the sagitta form along a line; see [`crate::docs::conformal`]. Accuracy: over both contact segments the error
    /// is below 1e-13 times the sum of the magnitudes of the terms of t; elsewhere below 2e-12 mm × max(1, R_max/300 mm).
    /// Both are checked against 60-digit values. With a body that varies it is below 1e-10 mm. Cost: about half a microsecond.
    pub fn gap(&self, sigma: f64, eta: f64) -> f64 {
        self.column(sigma).map_or(f64::NAN, |mut column| self.gap_in(&mut column, eta))
    }

    /// Computes t \[mm\] at η \[mm\] of a column, as [`Self::gap`] does.
    pub fn gap_in(&self, column: &mut GapColumn, eta: f64) -> f64 {
        let above = self.wheel_point(column, eta).map_or(f64::NAN, |point| point.height());
        above + self.below(column, eta)
    }

    /// Computes ∂t/∂η at one point; NaN where t is.
    pub fn slope(&self, sigma: f64, eta: f64) -> f64 {
        let mut column = self.column(sigma);
        column.as_mut().and_then(|column| self.slopes_in(column, eta)).map_or(f64::NAN, |at| at.slopes[1])
    }

    /// Computes t, \[∂t/∂σ, ∂t/∂η\] and the abscissae of the points met at η \[mm\] of a column; `None` where the ray misses a body.
    ///
    /// Method: as σ grows, the foot of the ray moves along the rail and the ray turns by dα; its other end moves by 1 − t dα/dσ along
    /// the rail's tangent, and stays on a surface of which the normal is known.
    pub(crate) fn slopes_in(&self, column: &mut GapColumn, eta: f64) -> Option<GapSlopes> {
        let point = self.wheel_point(column, eta)?;
        let (rail, normal) = (column.rail, self.wheel_normal(&column.rail, &point));
        let (gap, down) = (point.height(), rail.sin * normal.x - rail.cos * normal.z);
        let along = (1.0 - gap * rail.curvature) * (rail.cos * normal.x + rail.sin * normal.z) / down;
        let mut at = GapSlopes { gap, slopes: [along, normal.y / down], abscissae: [f64::NAN; 2] };
        if let WheelPoint::Round(point) = point {
            at.abscissae[0] = point.abscissa;
        }
        if let Some(feet) = &mut column.below {
            let foot = feet.at(0.0, eta)?;
            at.gap -= foot.zeta;
            at.slopes[0] -= (1.0 - foot.zeta * rail.curvature) * foot.slopes[0];
            at.slopes[1] -= foot.slopes[1];
        } else if let (Some(under), Some(column)) = (&self.under, &mut column.under) {
            let below = under.slopes_in(column, eta)?;
            at.gap += below.gap;
            at.slopes = [at.slopes[0] + below.slopes[0], at.slopes[1] + below.slopes[1]];
            at.abscissae[1] = below.abscissae[0];
        }
        Some(at)
    }

    /// Finds the wheel's point on the line along the normal; `None` where it misses.
    fn wheel_point(&self, column: &mut GapColumn, eta: f64) -> Option<WheelPoint> {
        match &mut column.wheel {
            Some(feet) => feet.at(0.0, eta).map(WheelPoint::Varying),
            None => sight::point(&self.bodies.ray(&column.rail, eta)).map(WheelPoint::Round),
        }
    }

    /// Computes how far the lower body lies below the profile of the column along its normal \[mm\]; NaN where it has no surface.
    fn below(&self, column: &mut GapColumn, eta: f64) -> f64 {
        if let Some(feet) = &mut column.below {
            return -feet.height(0.0, eta);
        }
        let under = self.under.as_ref().zip(column.under.as_mut());
        under.map_or(0.0, |(under, column)| under.gap_in(column, eta))
    }

    /// Returns α(σ) \[rad\], the angle of the rail's outward normal from ζ, positive counter-clockwise; NaN beyond the range of
    /// σ.
    pub fn angle(&self, sigma: f64) -> f64 {
        self.rail.point(sigma).map_or(f64::NAN, |at| at.sin.atan2(at.cos))
    }

    /// Returns the least and largest α \[rad\] over a range of σ \[mm\], at its ends, joints and equal steps between.
    pub fn angles(&self, over: Interval) -> Interval {
        let steps = (0..=ANGLE_STEPS).map(|k| over.step(k, ANGLE_STEPS));
        let joints = self.rail.joints().into_iter().filter(|sigma| over.contains(*sigma));
        Interval::around(steps.chain(joints).map(|sigma| self.angle(sigma)))
    }

    /// Computes everything at one point; `None` beyond the rail's range of σ.
    pub fn point(&self, sigma: f64, eta: f64) -> Option<GapPoint> {
        let mut column = self.column(sigma)?;
        let (met, below, rail) =
            (self.wheel_point(&mut column, eta), self.below(&mut column, eta), column.rail);
        Some(GapPoint {
            rail,
            gap: met.as_ref().map_or(f64::NAN, WheelPoint::height) + below,
            below,
            over_contact: matches!(&met, Some(WheelPoint::Round(point)) if point.over_contact),
            rail_normal: Unit::new_unchecked(Vector3::new(-rail.sin, 0.0, rail.cos)),
            wheel_normal: met.map(|point| self.wheel_normal(&rail, &point)),
        })
    }

    /// Computes the wheel's outward unit normal (ξ, η, ζ) at its point on a line along the rail's normal.
    fn wheel_normal(&self, rail: &RailPoint, point: &WheelPoint) -> Unit<Vector3<f64>> {
        let normal = match point {
            WheelPoint::Round(point) => {
                let wheel = &self.bodies.wheel;
                let tangent = wheel.section.branches[point.branch].station(point.abscissa);
                let own = wheel.normal_at(&tangent, point.w, point.eta);
                let turned = self.placement.skew_rotation() * Vector2::new(own.x, own.y);
                Vector3::new(turned.x, turned.y, own.z)
            }
            WheelPoint::Varying(foot) => {
                let down = -foot.normal();
                let xi = rail.cos * down.x - rail.sin * down.z;
                Vector3::new(xi, down.y, rail.sin * down.x + rail.cos * down.z)
            }
        };
        Unit::new_unchecked(normal)
    }
}

impl WheelPoint {
    /// Returns the height over the rail's point along the rail's normal \[mm\].
    fn height(&self) -> f64 {
        match self {
            Self::Round(point) => point.t,
            Self::Varying(foot) => foot.zeta,
        }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::error::Result;
    use crate::placement::Pair;
    use crate::profile::{Arc, Half, Profile, Segment};

    /// Makes a gauge corner of 13 mm in a root of 14 mm, on a wheel of 460 mm.
    pub(crate) fn corner_in_root() -> Result<Pair> {
        let arc = |radius: f64| -> Result<Profile> {
            let arc = Arc::about([0.0, -radius], radius, Half::Upper, [-11.0, 11.0])?;
            Profile::new("arc", "", vec![Segment::arc(arc)])
        };
        Pair::new(arc(13.0)?, arc(14.0)?, 460.0)
    }

    #[test]
    fn slopes_are_those_of_differences_on_a_rail_and_on_a_roller() -> Result<()> {
        let pair = corner_in_root()?;
        for (pair, skew) in [(pair.clone(), 0.0), (pair.clone(), 0.03), (pair.on_roller(350.0)?, 0.03)] {
            let placement = pair.placed(0.0, 0.0, skew)?;
            let gap = NormalGap::new(&placement);
            for at in [[-7.0, 3.0], [0.5, -4.0], [8.0, 6.0]] {
                let mut column = gap.column(at[0]).expect("on the rail");
                let found = gap.slopes_in(&mut column, at[1]).expect("a point of the wheel");
                assert_eq!(found.gap, gap.gap(at[0], at[1]));
                for (axis, slope) in found.slopes.into_iter().enumerate() {
                    let beside = |step: f64| {
                        let mut moved = at;
                        moved[axis] += step;
                        gap.gap(moved[0], moved[1])
                    };
                    let difference = (beside(1e-4) - beside(-1e-4)) / 2e-4;
                    assert!((slope - difference).abs() < 1e-9, "{skew} {at:?}: {slope} and {difference}");
                }
            }
        }
        Ok(())
    }
}

//! The curve of a rail's profile, each of its points raised by what the wheel may sink in there: over the tangent plane by δ along ζ, over
//! the rail's own surface by δ cos α along its normal. A line of constant ξ or σ is straight and runs along η through the raised point,
//! and the patch is where that line lies in the wheel.

use std::cell::Cell;

use crate::conformal::{RailArcLength, RailPoint};
use crate::numerics::interval::Interval;
use crate::numerics::lanes::{Lanes, MANY, lanes};
use crate::placement::Placement;
use crate::profile::Section;
use crate::separation::{Relief, ReliefPoint};

/// Largest kink \[rad\] of the rail over which the raised curve counts as continuous: there it jumps by at most a millionth of δ.
const KINK: f64 = 1e-6;

/// The raised profile of an extruded rail under a wheel of revolution.
#[derive(Debug)]
pub(super) struct Raised<'a> {
    relief: Relief<'a>,
    /// Approach δ \[mm\].
    approach: f64,
    /// The rail's surface by its arc length σ; `None` over the tangent plane, where ξ stands for σ.
    pub(super) surface: Option<RailArcLength<'a>>,
    /// The last point that was asked for.
    last: Cell<RaisedPoint>,
}

/// A point of the rail's profile and how far it is raised.
#[derive(Debug, Clone, Copy)]
pub(super) struct RaisedPoint {
    /// σ \[mm\]; ξ over the tangent plane.
    sigma: f64,
    /// ξ of the profile's point \[mm\].
    pub(super) foot: f64,
    /// How far the raised point lies from there along ξ and ζ \[mm\].
    pub(super) moved: [f64; 2],
}

impl RaisedPoint {
    /// Returns ξ of the raised point \[mm\].
    pub(super) fn xi(&self) -> f64 {
        self.foot + self.moved[0]
    }
}

/// N raised points.
#[derive(Debug, Clone, Copy)]
pub(super) struct RaisedLanes<const N: usize> {
    /// ξ of the profile's points \[mm\].
    pub(super) foot: Lanes<N>,
    /// ξ of the raised points \[mm\].
    pub(super) xi: Lanes<N>,
    /// How far the raised points lie above the profile's along ζ \[mm\].
    pub(super) lift: Lanes<N>,
}

impl<const N: usize> RaisedLanes<N> {
    /// Returns N points of the tangent plane, raised by an approach \[mm\].
    pub(super) fn over_plane(xi: &Lanes<N>, approach: f64) -> Self {
        Self { foot: *xi, xi: *xi, lift: [approach; N] }
    }

    /// Returns one of the points.
    pub(super) fn lane(&self, k: usize) -> RaisedLanes<1> {
        RaisedLanes { foot: [self.foot[k]], xi: [self.xi[k]], lift: [self.lift[k]] }
    }
}

impl<'a> Raised<'a> {
    /// Makes the raised profile of a placed pair for approach δ \[mm\], over the tangent plane or over the rail's `surface`.
    pub(super) fn new(placement: &'a Placement, approach: f64, surface: Option<RailArcLength<'a>>) -> Self {
        let last = Cell::new(RaisedPoint { sigma: f64::NAN, foot: f64::NAN, moved: [f64::NAN; 2] });
        Self { relief: Relief::new(placement), approach, surface, last }
    }

    /// Returns the rail's section.
    pub(super) fn rail(&self) -> &'a Section {
        self.relief.below
    }

    /// Returns the raised point at σ \[mm\]; NaN beyond the rail.
    #[inline]
    pub(super) fn at(&self, sigma: f64) -> RaisedPoint {
        let Some(surface) = &self.surface else {
            return RaisedPoint { sigma, foot: sigma, moved: [0.0, self.approach] };
        };
        if self.last.get().sigma != sigma {
            let nowhere = RaisedPoint { sigma, foot: f64::NAN, moved: [f64::NAN; 2] };
            self.last.set(surface.point(sigma).map_or(nowhere, |at| {
                let lift = self.approach * at.cos;
                RaisedPoint { sigma, foot: at.xi, moved: [-lift * at.sin, lift * at.cos] }
            }));
        }
        self.last.get()
    }

    /// Returns ξ of the raised point \[mm\]; NaN beyond the rail.
    pub(super) fn xi(&self, sigma: f64) -> f64 {
        self.at(sigma).xi()
    }

    /// Returns the raised points at 16 σ \[mm\].
    pub(super) fn lanes(&self, sigma: &Lanes) -> RaisedLanes<MANY> {
        if self.surface.is_none() {
            return RaisedLanes::over_plane(sigma, self.approach);
        }
        let points = sigma.map(|sigma| self.at(sigma));
        RaisedLanes {
            foot: lanes(|k| points[k].foot),
            xi: lanes(|k| points[k].xi()),
            lift: lanes(|k| points[k].moved[1]),
        }
    }

    /// Returns \[dξ, dζ\] along the raised curve, per σ; NaN beyond the rail.
    pub(super) fn direction(&self, sigma: f64) -> [f64; 2] {
        let Some(surface) = &self.surface else {
            let slope =
                self.rail().branch_at(sigma).map_or(f64::NAN, |branch| branch.chord_slope(sigma, sigma));
            return [1.0, slope];
        };
        surface.point(sigma).map_or([f64::NAN; 2], |RailPoint { cos, sin, curvature, .. }| {
            let turned = self.approach * curvature;
            [cos - turned * (cos - sin) * (cos + sin), sin - 2.0 * turned * sin * cos]
        })
    }

    fn point(&mut self, sigma: f64, eta: f64) -> Option<(RaisedPoint, ReliefPoint)> {
        let at = self.at(sigma);
        Some((at, self.relief.point(at.xi(), eta)?))
    }

    /// Computes how far the wheel's surface lies above the profile's own point at σ, at the place of the raised point \[mm\]; NaN where a
    /// body has no surface.
    pub(super) fn over_profile(&mut self, sigma: f64, eta: f64) -> f64 {
        self.point(sigma, eta).map_or(f64::NAN, |(at, point)| self.height(&at, &point))
    }

    /// Returns whether the wheel has a surface over the raised point of σ at η \[mm\], as [`Relief::has_surface`].
    pub(super) fn has_surface(&mut self, sigma: f64, eta: f64) -> bool {
        let xi = self.at(sigma).xi();
        self.relief.has_surface(xi, eta)
    }

    fn height(&self, at: &RaisedPoint, point: &ReliefPoint) -> f64 {
        self.relief.height_over(at.foot, at.moved[0], point)
    }

    /// Computes how far the wheel's surface lies above the raised point \[mm\]: negative in the patch, over the tangent plane s − δ. NaN
    /// where a body has no surface.
    pub(super) fn gap(&mut self, sigma: f64, eta: f64) -> f64 {
        self.over_profile(sigma, eta) - self.at(sigma).moved[1]
    }

    /// Computes the gap \[mm\] and its slopes along σ and η; `None` off the wheel.
    pub(super) fn gap_and_slopes(&mut self, sigma: f64, eta: f64) -> Option<[f64; 3]> {
        let (at, point) = self.point(sigma, eta)?;
        let ([run, rise], [along, across]) = (self.direction(sigma), self.relief.slopes(&point));
        Some([self.height(&at, &point) - at.moved[1], along * run - rise, across])
    }

    /// Returns the abscissa \[mm\] of the profile's point from which the wheel's surface is swept there; NaN off the wheel.
    pub(super) fn abscissa(&mut self, sigma: f64, eta: f64) -> f64 {
        self.point(sigma, eta).map_or(f64::NAN, |(_, point)| self.relief.abscissa(&point))
    }

    /// Returns the range of σ \[mm\] of the rail.
    pub(super) fn reach(&self) -> Option<Interval> {
        self.surface.as_ref().map_or_else(|| self.rail().reach(), RailArcLength::reach)
    }

    /// Returns the σ inside a range \[mm\], ascending, at which the raised curve jumps: at kinks of the rail, where its normal turns at
    /// once.
    pub(super) fn jumps(&self, over: Interval) -> Vec<f64> {
        let joints = self.surface.as_ref().map(RailArcLength::joints).unwrap_or_default();
        let leaps = |sigma: f64| {
            let [before, after] = [sigma, sigma.next_up()].map(|sigma| self.at(sigma).moved);
            (after[0] - before[0]).hypot(after[1] - before[1]) > KINK * self.approach.abs()
        };
        joints.into_iter().filter(|sigma| over.surrounds(*sigma) && leaps(*sigma)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conformal::{NormalGap, corner_in_root};
    use crate::error::Result;
    use crate::numerics::roots::bracketed;

    #[test]
    fn the_raised_point_is_on_the_wheel_where_the_normal_gap_is_the_approach_and_slopes_are_those_of_differences()
    -> Result<()> {
        let pair = corner_in_root()?;
        for skew in [0.0, 0.03] {
            let (placement, approach) = (pair.placed(0.0, 0.0, skew)?, 0.3);
            let normal = NormalGap::new(&placement);
            let mut raised = Raised::new(&placement, approach, Some(normal.rail().clone()));
            for sigma in [-3.0, 0.5, 2.0] {
                let miss = |eta: f64| normal.gap(sigma, eta) - approach * normal.angle(sigma).cos();
                let edge = bracketed(miss, 0.0, 30.0).expect("an edge");
                assert!(raised.gap(sigma, edge).abs() < 1e-13, "{skew} {sigma}: {}", raised.gap(sigma, edge));
                let step = 1e-4;
                let difference =
                    (raised.gap(sigma + step, edge) - raised.gap(sigma - step, edge)) / (2.0 * step);
                let slope = raised.gap_and_slopes(sigma, edge).map_or(f64::NAN, |[_, along, _]| along);
                assert!((slope - difference).abs() < 1e-9, "{skew} {sigma}: {slope} and {difference}");
            }
        }
        Ok(())
    }
}

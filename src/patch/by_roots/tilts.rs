//! Bounds of the directions in which the surface of a wheel is tilted over a part of the tangent plane.

use nalgebra::Vector2;

use crate::numerics::direction;
use crate::numerics::interval::Interval;
use crate::patch::in_valleys::circle::{FARTHEST_SINE, Turned};

/// Rounding of an angle of a surface.
pub(super) const ANGLE_ROUNDING: f64 = 1e-14;

/// Bounds of the direction of a wheel's surface.
#[derive(Debug, Clone, Copy)]
pub(super) struct TiltBounds {
    /// Angle of the surface from ξ in planes of constant η \[rad\].
    pub(super) angle: Interval,
    /// Slope of the surface along η, seen along the normal of its section with such a plane: ∂ζ/∂η is that over the cosine of the angle.
    pub(super) lean: Interval,
    /// Direction of the circles about the axle in ξ, η and ζ.
    pub(super) circle: [Interval; 3],
}

/// Returns the cosines of angles up to a right one.
pub(super) fn cosines(angle: Interval) -> Interval {
    Interval::new(angle.magnitude().cos(), angle.nearest(0.0).cos())
}

/// Bounds the tilts of a wheel's surface.
#[derive(Debug)]
pub(super) struct Tilts<'a> {
    turned: Turned<'a>,
    /// Of all circles \[mm\].
    pub(super) radii: Interval,
}

impl<'a> Tilts<'a> {
    /// Makes the bounds of a wheel's surface; that of a roller is one upside down.
    pub(super) fn new(turned: Turned<'a>) -> Self {
        let mut tilts = Self { turned, radii: Interval::NONE };
        for piece in &turned.section.pieces {
            let heights = turned.section.branches[piece.branch].height_bounds(piece.xi);
            tilts.radii = tilts.radii.hull(tilts.radii_of(piece.xi, heights));
        }
        tilts
    }

    /// Returns bounds of the radii \[mm\] of circles from ranges of their abscissae and heights \[mm\].
    fn radii_of(&self, abscissae: Interval, heights: Interval) -> Interval {
        let Turned { axle, tilt, .. } = self.turned;
        -(abscissae * Interval::of(tilt.im) + heights * Interval::of(tilt.re)) + axle
    }

    /// Returns bounds of the profile's slopes, and of the radii \[mm\] of the circles, over ranges of the wheel's own directions \[mm\].
    fn profile_over(&self, [xi, eta]: [Interval; 2]) -> Option<[Interval; 2]> {
        let Turned { section, tilt, .. } = self.turned;
        let sagitta = |eta: f64, radius: f64| eta * eta / (radius + (radius * radius - eta * eta).sqrt());
        let abscissae = |radii: Interval| {
            let sagittas =
                Interval::new(sagitta(eta.nearest(0.0), radii.high), sagitta(eta.magnitude(), radii.low));
            (xi + -(sagittas * Interval::of(tilt.im))).grown(self.turned.rounding())
        };
        let wide = abscissae(self.radii);
        let slopes = section.slopes_over(wide)?;
        let rise = slopes.magnitude() * wide.width() / 2.0 + self.turned.rounding();
        let heights = Interval::of(section.height(wide.middle())).grown(rise);
        let radii = self.radii.cut(self.radii_of(wide, heights));
        let narrow = abscissae(radii);
        let slopes = if narrow.width() < wide.width() / 2.0 { section.slopes_over(narrow)? } else { slopes };
        Some([slopes, radii])
    }

    /// Returns bounds of the direction of the surface over ranges of ξ and η \[mm\]. `None` where the surface ends or steps in a part of
    /// it, and too far from the midplane.
    ///
    /// Method: at one angle v of the circles the surface's angle from ξ grows with the profile's angle, so that the ends of the latter
    /// bound it. Bounds of the derivatives by v do the rest.
    pub(super) fn over(&self, xi: Interval, eta: Interval) -> Option<TiltBounds> {
        let Turned { tilt, skew, .. } = self.turned;
        let [sin, cos] = [skew.im, skew.re].map(Interval::of);
        let (own_xi, own_eta) = (xi * cos + eta * sin, eta * cos + -(xi * sin));
        if self.radii.is_empty() || own_eta.magnitude() > FARTHEST_SINE * self.radii.low {
            return None;
        }
        let [slopes, radii] = self.profile_over([own_xi, own_eta])?;
        let sines = own_eta.quotient(radii);
        let turn = sines.map(f64::asin);
        let (sin_v, half) = (turn.middle().sin(), turn.width() / 2.0);
        let versine = sin_v * sin_v / (1.0 + turn.middle().cos());
        let (mut angle, mut sideways) = (Interval::NONE, Interval::NONE);
        for slope in slopes.ends() {
            let tangent: Vector2<f64> = direction(slope).into();
            let towards_axle = (tilt * tangent).x;
            let along = tangent.y + towards_axle * versine * tilt.im;
            let up = tangent.x - towards_axle * versine * tilt.re;
            let skewed = skew * Vector2::new(along, towards_axle * sin_v);
            (angle, sideways) = (angle.with(skewed.x.atan2(up)), sideways.with(skewed.y));
        }
        // The normal's part along η is a sine of the profile's angle, no larger than this.
        let largest = skew.im.abs() + sines.magnitude();
        let bulge = largest * (slopes.high.atan() - slopes.low.atan()).powi(2) / 8.0;
        let sideways = sideways.grown(half + bulge + ANGLE_ROUNDING);
        if largest >= 1.0 || sideways.magnitude() >= 1.0 {
            return None;
        }
        let by_turn = largest / (1.0 - largest * largest).sqrt();
        let angle = angle.grown(half * by_turn + ANGLE_ROUNDING);
        let lean = sideways.map(|sine| sine / (1.0 - sine * sine).sqrt());
        let (cosines, aside) = (cosines(turn), sines * Interval::of(tilt.im));
        let circle =
            [aside * cos + -(cosines * sin), aside * sin + cosines * cos, sines * Interval::of(tilt.re)];
        Some(TiltBounds { angle, lean, circle })
    }
}

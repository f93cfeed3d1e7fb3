//! The frame of a placed pair moved to another point of the rail, and turned; the bodies stay where they are.

use std::sync::OnceLock;

use nalgebra::{Point2, UnitComplex, Vector3};

use super::{Body, Generator, Placement};
use crate::error::{Error, Result};
use crate::profile::Station;

impl Placement {
    /// The same bodies in another frame: its origin lies on the rail at `rail_x` \[mm\], its ξ at `angle` \[rad\] in the rail profile's
    /// axes. The wheel does not move, so that s at the new origin is what it was there, along the new ζ; neither body is
    /// smooth in the sense of [`Body::is_smooth`].
    ///
    /// Under a skewed wheel the new ζ lies in a plane through the axle, as it has to, once the origin moves along the rail by
    /// what [`Self::ahead`] tells; the skew changes as well.
    ///
    /// # Errors
    /// An abscissa off the rail; a skewed wheel over a roller, on which nothing moves along a straight line.
    pub fn reframed(&self, rail_x: f64, angle: f64) -> Result<Self> {
        if self.skew != 0.0 && self.rail.generator() != Generator::Extruded {
            let found = format!("a skew of {} rad over a roller", self.skew);
            let advice = "keep the frame of the contact point";
            return Err(Error::new("contact", found, "a wheel without yaw, or a rail", advice));
        }
        let mut point = self.rail.swept.point(rail_x).map_err(|e| e.within("contact: rail_x"))?;
        let here = self.rail.contact_frame();
        let origin = here.inverse_transform_point(&Point2::new(point.station.x, point.station.z));
        let turn = UnitComplex::new(angle) * here.rotation.inverse();
        let along = here.rotation * turn;
        (point.station.cos, point.station.sin) = (along.re, along.im);
        let rail = Body::in_frame(&self.rail.swept, point);
        let mut on_wheel = self.wheel.point;
        let ([ahead, skew], station) = self.wheel_along(origin, turn);
        on_wheel.station = station;
        let wheel = Body::in_frame(&self.wheel.swept, on_wheel);
        let ahead = self.ahead + ahead;
        Ok(Self { rail, wheel, skew, ahead, at_contact: false, under: OnceLock::new(), ..self.clone() })
    }

    /// Gives how far a frame of the rail moves along η \[mm\], its skew χ, and its origin and direction in the wheel profile's axes; `origin`
    /// and `turn` are those of the new frame in the present one.
    fn wheel_along(&self, origin: Point2<f64>, turn: UnitComplex<f64>) -> ([f64; 2], Station) {
        let frame = self.wheel.contact_frame();
        if self.skew == 0.0 {
            let (origin, along) = (frame * origin, frame.rotation * turn);
            return ([0.0; 2], Station { x: origin.x, z: origin.y, cos: along.re, sin: along.im });
        }
        // In (ξ, η, ζ): the axle, and from C towards it; the new ζ; and in the plane of both the wheel's new ξ′.
        let ((sin, cos), wheel) = (self.skew.sin_cos(), frame.rotation);
        let axle = Vector3::new(wheel.re * cos, wheel.re * sin, -wheel.im);
        let inwards = Vector3::new(wheel.im * cos, wheel.im * sin, wheel.re);
        let (xi, zeta) = (Vector3::new(turn.re, 0.0, turn.im), Vector3::new(-turn.im, 0.0, turn.re));
        let sine = -axle.dot(&zeta);
        let across = axle + zeta * sine;
        let cosine = across.norm();
        let across = across / cosine;
        let new_inwards = across * sine + zeta * cosine;
        let (normal, from) = (across.cross(&zeta), Vector3::new(origin.x, 0.0, origin.y));
        let radius = self.rolling_radius();
        let ahead = (inwards * radius - from).dot(&normal) / normal.y;
        let from = from + Vector3::y() * ahead;
        // The difference of the unit vectors, squared, does not cancel as their product would.
        let lifted = 0.5 * radius * (inwards - new_inwards).norm_squared();
        let x = frame.translation.x + from.dot(&axle);
        let z = frame.translation.y + lifted + from.dot(&new_inwards);
        let station = Station { x, z, cos: cosine, sin: sine };
        ([ahead, across.y.atan2(across.dot(&xi))], station)
    }
}

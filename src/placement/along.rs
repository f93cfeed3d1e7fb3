//! Finds where the wheel lies in a contact frame that is moved to another point of the rail and turned.

use nalgebra::{Isometry2, Point2, UnitComplex, Vector3};

use crate::profile::Station;

/// Moves a contact frame to `origin` \[mm\] of its midplane, turned by `turn`. Gives how far it moves along η \[mm\], the new skew χ
/// \[rad\], and its origin and direction in the wheel profile's axes. The present frame is given by its isometry to the wheel profile's
/// axes, its skew \[rad\] and the distance from the axle to its origin \[mm\].
pub(super) fn wheel_along(
    (frame, skew, radius): (&Isometry2<f64>, f64, f64),
    origin: Point2<f64>,
    turn: UnitComplex<f64>,
) -> ([f64; 2], Station) {
    if skew == 0.0 {
        let (origin, along) = (frame * origin, frame.rotation * turn);
        return ([0.0; 2], Station { x: origin.x, z: origin.y, cos: along.re, sin: along.im });
    }
    // In (ξ, η, ζ): the axle, and from C towards it; the new ζ; and in the plane of both the wheel's new ξ′.
    let ((sin, cos), wheel) = (skew.sin_cos(), frame.rotation);
    let axle = Vector3::new(wheel.re * cos, wheel.re * sin, -wheel.im);
    let inwards = Vector3::new(wheel.im * cos, wheel.im * sin, wheel.re);
    let (xi, zeta) = (Vector3::new(turn.re, 0.0, turn.im), Vector3::new(-turn.im, 0.0, turn.re));
    let sine = -axle.dot(&zeta);
    let across = axle + zeta * sine;
    let cosine = across.norm();
    let across = across / cosine;
    let new_inwards = across * sine + zeta * cosine;
    let (normal, from) = (across.cross(&zeta), Vector3::new(origin.x, 0.0, origin.y));
    let ahead = (inwards * radius - from).dot(&normal) / normal.y;
    let from = from + Vector3::y() * ahead;
    // The difference of the unit vectors, squared, does not cancel as their product would.
    let lifted = 0.5 * radius * (inwards - new_inwards).norm_squared();
    let x = frame.translation.x + from.dot(&axle);
    let z = frame.translation.y + lifted + from.dot(&new_inwards);
    let station = Station { x, z, cos: cosine, sin: sine };
    ([ahead, across.y.atan2(across.dot(&xi))], station)
}

//! The varying body's surface in space: a rail's lies along the track; a wheel's is wrapped around its axle.
//!
//! A wheel's surface is given over its developed circumference: y is R times the angle, and the height h of a point, upside down, makes
//! the distance R + h from the axle. At the angle δ from the lowest meridian the point is (x, (R + h) sin δ, (R + h) cos δ − R).

use super::above::{SweptAbove, Varying};
use crate::lofted::SurfacePoint;

/// A point of the varying body in its own axes, y from the middle of the axle: values and derivatives by the surface's parameters.
#[derive(Debug, Clone, Copy)]
pub(super) struct SpacePoint {
    /// The point on the surface before it is wrapped.
    pub own: SurfacePoint,
    /// The point.
    pub at: [f64; 3],
    /// ∂/∂u.
    pub across: [f64; 3],
    /// ∂/∂y.
    pub along: [f64; 3],
    /// ∂²/∂u².
    pub across2: [f64; 3],
    /// ∂²/∂u∂y.
    pub mixed: [f64; 3],
    /// ∂²/∂y².
    pub along2: [f64; 3],
}

/// The directions out from a wheel's axle and around it, forward, at an angle from the lowest meridian; the world upside down.
pub(super) fn directions(angle: f64) -> [[f64; 3]; 2] {
    let (sin, cos) = angle.sin_cos();
    [[0.0, sin, cos], [0.0, cos, -sin]]
}

/// The point at the height h and at τ \[mm\] along the tangent plane of a wheel of radius R, at an angle from the lowest meridian.
pub(super) fn on_wheel(radius: f64, angle: f64, [x, h, tau]: [f64; 3]) -> [f64; 3] {
    let [out, around] = directions(angle);
    let half = (0.5 * angle).sin();
    // R (cos δ − 1) without cancellation.
    [x, (radius + h) * out[1] + tau * around[1], h * out[2] + tau * around[2] - 2.0 * radius * half * half]
}

impl SpacePoint {
    /// Takes a point of the surface into space; the middle of the axle is over `along` \[mm\] of it.
    pub fn new(own: SurfacePoint, above: &SweptAbove<'_>, along: f64) -> Self {
        let y = own.y - along;
        let SurfacePoint { at, across, along, across2, mixed, along2, .. } = own;
        let level = |[x, z]: [f64; 2], y: f64| [x, y, z];
        if above.varying == Varying::Rail {
            return Self {
                own,
                at: level(at, y),
                across: level(across, 0.0),
                along: level(along, 1.0),
                across2: level(across2, 0.0),
                mixed: level(mixed, 0.0),
                along2: level(along2, 0.0),
            };
        }
        let radius = above.attitude.radius;
        let (angle, rolling) = (y / radius, radius + at[1]);
        let [out, around] = directions(angle);
        let wrapped =
            |x: f64, h: f64, tau: f64| [x, h * out[1] + tau * around[1], h * out[2] + tau * around[2]];
        Self {
            own,
            at: on_wheel(radius, angle, [at[0], at[1], 0.0]),
            across: wrapped(across[0], across[1], 0.0),
            along: wrapped(along[0], along[1], rolling / radius),
            across2: wrapped(across2[0], across2[1], 0.0),
            mixed: wrapped(mixed[0], mixed[1], across[1] / radius),
            along2: wrapped(along2[0], along2[1] - rolling / (radius * radius), 2.0 * along[1] / radius),
        }
    }
}

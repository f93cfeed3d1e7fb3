//! A surface of slices in space: a rail's lies along the track; a wheel's is wrapped around its axle.
//!
//! A wheel's surface is given over its developed circumference: y is R times the angle, and the height h of a point, upside down, makes
//! the distance R + h from the axle. At the angle δ from the lowest meridian the point is (x, (R + h) sin δ, (R + h) cos δ − R).

use super::bicubic::SurfacePoint;

/// How a surface lies in its body's own axes: x across, y ahead, z out of the body: up on a rail, down on a wheel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Laid {
    /// Along the track; y is 0 at this coordinate of the list \[mm\].
    Along(f64),
    /// Around an axle.
    Around {
        /// Nominal rolling radius R \[mm\].
        radius: f64,
        /// Place of the lowest meridian on the developed circumference \[mm\].
        lowest: f64,
    },
}

/// A point of a surface in its body's own axes: values and derivatives by the surface's parameters.
#[derive(Debug, Clone, Copy)]
pub struct SpacePoint {
    /// The point on the surface as its slices have it.
    pub own: SurfacePoint,
    /// The point \[mm\].
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

/// Gives the directions out from a wheel's axle, and forward around it, at an angle \[rad\] from the lowest meridian; z points down.
pub(crate) fn directions(angle: f64) -> [[f64; 3]; 2] {
    let (sin, cos) = angle.sin_cos();
    [[0.0, sin, cos], [0.0, cos, -sin]]
}

/// Gives the point at the height h and at τ \[mm\] along the tangent plane of a wheel of radius R, at an angle \[rad\] from the lowest
/// meridian; z points down.
pub(crate) fn on_wheel(radius: f64, angle: f64, [x, h, tau]: [f64; 3]) -> [f64; 3] {
    let [out, around] = directions(angle);
    let half = (0.5 * angle).sin();
    // R (cos δ − 1) without cancellation.
    [x, (radius + h) * out[1] + tau * around[1], h * out[2] + tau * around[2] - 2.0 * radius * half * half]
}

impl Laid {
    /// Gives the distance from the axle to the profile's origin \[mm\]; infinite for a rail.
    pub fn radius(&self) -> f64 {
        match *self {
            Self::Along(_) => f64::INFINITY,
            Self::Around { radius, .. } => radius,
        }
    }

    /// Takes a point \[x, z\] of a section at y \[mm\] into space.
    #[inline(always)]
    pub fn place(&self, [x, z]: [f64; 2], y: f64) -> [f64; 3] {
        match *self {
            Self::Along(from) => [x, y - from, z],
            Self::Around { radius, lowest } => on_wheel(radius, (y - lowest) / radius, [x, z, 0.0]),
        }
    }

    /// Takes a point of the surface into space.
    // Inline, so that derivatives that the caller does not use are not computed.
    #[inline(always)]
    pub fn point(&self, own: SurfacePoint) -> SpacePoint {
        let SurfacePoint { at, across, along, across2, mixed, along2, .. } = own;
        let level = |[x, z]: [f64; 2], y: f64| [x, y, z];
        let (radius, lowest) = match *self {
            Self::Along(from) => {
                return SpacePoint {
                    own,
                    at: [at[0], own.y - from, at[1]],
                    across: level(across, 0.0),
                    along: level(along, 1.0),
                    across2: level(across2, 0.0),
                    mixed: level(mixed, 0.0),
                    along2: level(along2, 0.0),
                };
            }
            Self::Around { radius, lowest } => (radius, lowest),
        };
        let (angle, rolling) = ((own.y - lowest) / radius, radius + at[1]);
        let [out, around] = directions(angle);
        let wrapped =
            |x: f64, h: f64, tau: f64| [x, h * out[1] + tau * around[1], h * out[2] + tau * around[2]];
        SpacePoint {
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

//! The swept body above one that varies, and the vertical gap between the two with its slopes and curvatures.
//!
//! Over a rail that varies, this is a wheel of revolution. Over a wheel that varies, it is an extruded rail, and all is upside down: z
//! counts downward, for both bodies, so that the rail is above the wheel.

use crate::lofted::Laid;
use crate::profile::{Section, Side};
use crate::search::locus::Attitude;

/// Most steps to the swept body along a vertical line. Without roll one is enough; with roll each reduces the error by a factor of
/// roll × slope.
const STEPS: usize = 60;

/// A swept body at one attitude, its profile's origin on the level of the other body's.
#[derive(Debug, Clone, Copy)]
pub(super) struct SweptAbove<'a> {
    /// The profile in its own axes; that of a rail upside down.
    pub section: &'a Section,
    /// The attitude of the wheel over the rail.
    pub attitude: &'a Attitude,
    /// The body below, which varies: a rail along the track, or a wheel around its axle, upside down under the rail.
    pub varying: Side,
    /// Distance from the axle about which the profile is swept to the profile's origin \[mm\]: R of a wheel, infinite for a rail.
    pub radius: f64,
    /// Upward direction of the track in the swept body's axes.
    pub up: [f64; 3],
}

/// The point of the swept body above another one.
#[derive(Debug, Clone, Copy)]
pub(super) struct PointAbove {
    /// Vertical distance \[mm\].
    pub gap: f64,
    /// The point, in the body's axes \[mm\]: x along the axle, z from the profile's origin.
    pub at: [f64; 3],
    /// Sine and cosine of the profile's tangent there.
    pub tangent: [f64; 2],
    /// Curvature of the profile \[1/mm\], + with the hollow side up.
    pub curvature: f64,
    /// ∂/∂x and ∂/∂y of the body's height, in its axes.
    pub slopes: [f64; 2],
    /// ∂²/∂x², ∂²/∂x∂y, ∂²/∂y² of the body's height \[1/mm\].
    pub bends: [f64; 3],
}

/// Turns a vector upside down: reverses z.
pub(super) fn upside_down([x, y, z]: [f64; 3]) -> [f64; 3] {
    [x, y, -z]
}

/// Turns a vector of the rail's axes into the wheel's.
pub(super) fn into_wheel(a: &Attitude, [x, y, z]: [f64; 3]) -> [f64; 3] {
    let unrolled = x * a.cos_roll - z * a.sin_roll;
    [
        unrolled * a.cos_yaw + y * a.sin_yaw,
        y * a.cos_yaw - unrolled * a.sin_yaw,
        z * a.cos_roll + x * a.sin_roll,
    ]
}

/// Turns a vector of the wheel's axes into the rail's.
pub(super) fn out_of_wheel(a: &Attitude, [x, y, z]: [f64; 3]) -> [f64; 3] {
    let across = x * a.cos_yaw - y * a.sin_yaw;
    [
        across * a.cos_roll + z * a.sin_roll,
        x * a.sin_yaw + y * a.cos_yaw,
        z * a.cos_roll - across * a.sin_roll,
    ]
}

impl<'a> SweptAbove<'a> {
    pub fn new(section: &'a Section, attitude: &'a Attitude, varying: Side) -> Self {
        let (radius, up) = match varying {
            Side::Rail => (attitude.radius, into_wheel(attitude, [0.0, 0.0, 1.0])),
            Side::Wheel => (f64::INFINITY, [0.0, 0.0, 1.0]),
        };
        Self { section, attitude, varying, radius, up }
    }

    /// Turns a vector of the varying body's axes into the swept body's.
    pub fn turned(&self, v: [f64; 3]) -> [f64; 3] {
        match self.varying {
            Side::Rail => into_wheel(self.attitude, v),
            Side::Wheel => upside_down(out_of_wheel(self.attitude, upside_down(v))),
        }
    }

    /// Turns a direction of the swept body's axes that points out of the varying body into an upward one of the rail's axes.
    pub fn upward(&self, v: [f64; 3]) -> [f64; 3] {
        match self.varying {
            Side::Rail => out_of_wheel(self.attitude, v),
            Side::Wheel => [-v[0], -v[1], v[2]],
        }
    }

    /// Takes a point of the varying body's axes into the swept body's \[mm\]; y of a rail counts from the middle of the axle.
    pub fn seen(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let Attitude { offset, along, .. } = *self.attitude;
        match self.varying {
            Side::Rail => self.turned([x - offset, y - along, z]),
            Side::Wheel => {
                let [x, y, z] = self.turned([x, y, z]);
                [x + offset, y + along, z]
            }
        }
    }

    /// Tells how the varying body's surface lies in its own axes; `along` \[mm\] of it is under the middle of the axle.
    pub fn laid(&self, along: f64) -> Laid {
        match self.varying {
            Side::Rail => Laid::Along(along),
            Side::Wheel => Laid::Around { radius: self.attitude.radius, lowest: along },
        }
    }

    /// Gives the rounding of a gap \[mm\].
    pub fn rounding(&self) -> f64 {
        16.0 * f64::EPSILON * self.attitude.radius
    }

    /// Finds the swept body's point vertically above or below a point of its axes; `None` where there is none.
    pub fn above(&self, from: [f64; 3]) -> Option<PointAbove> {
        let mut gap = 0.0;
        let size = self.attitude.radius + from[0].abs();
        for _ in 0..STEPS {
            let at = [0, 1, 2].map(|k| from[k] + gap * self.up[k]);
            let mut own = self.over(at[0], at[1])?;
            let [a, b] = own.slopes;
            let rate = self.up[2] - a * self.up[0] - b * self.up[1];
            let step = (own.at[2] - at[2]) / rate;
            if rate <= 0.0 || step.is_nan() {
                return None;
            }
            gap += step;
            if step.abs() <= 4.0 * f64::EPSILON * size || (self.up[0] == 0.0 && self.up[1] == 0.0) {
                own.gap = gap;
                return Some(own);
            }
        }
        None
    }

    /// Finds the lower side of the swept body at (x, y) of its axes; the gap is left at 0.
    fn over(&self, x: f64, y: f64) -> Option<PointAbove> {
        let branch = self.section.branch_at(x)?;
        let (station, curvature) = branch.station_and_curvature(branch.parameter(x));
        if station.cos <= 0.0 {
            return None;
        }
        let slope = station.sin / station.cos;
        let bend = curvature / station.cos.powi(3);
        let tangent = [station.sin, station.cos];
        if self.radius == f64::INFINITY {
            let (at, slopes, bends) = ([x, y, station.z], [slope, 0.0], [bend, 0.0, 0.0]);
            return Some(PointAbove { gap: 0.0, at, tangent, curvature, slopes, bends });
        }
        let rolling = self.radius - station.z;
        let square = (rolling - y) * (rolling + y);
        if square <= 0.0 {
            return None;
        }
        let down = square.sqrt();
        let (across, along) = (rolling * slope / down, y / down);
        Some(PointAbove {
            gap: 0.0,
            at: [x, y, station.z + y * y / (rolling + down)],
            tangent,
            curvature,
            slopes: [across, along],
            bends: [
                (rolling * bend - slope * slope + across * across) / down,
                across * along / down,
                (1.0 + along * along) / down,
            ],
        })
    }
}

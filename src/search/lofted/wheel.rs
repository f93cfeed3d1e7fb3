//! A wheel of revolution above a point: the vertical gap, and its slopes and curvatures.

use crate::profile::Section;
use crate::search::locus::Attitude;

/// Most steps to the wheel along a vertical line. Without roll one is enough; with it each gains a factor of roll × slope.
const STEPS: usize = 60;

/// A wheel at one attitude, its profile's origin on the level of the rail's.
#[derive(Debug, Clone, Copy)]
pub(super) struct WheelAbove<'a> {
    /// The profile in its own axes.
    pub section: &'a Section,
    /// The attitude.
    pub attitude: &'a Attitude,
    /// Upward direction of the track in the wheel's axes.
    pub up: [f64; 3],
}

/// The point of a wheel above another one.
#[derive(Debug, Clone, Copy)]
pub(super) struct Above {
    /// Vertical distance \[mm\].
    pub gap: f64,
    /// Point of the wheel, in its axes \[mm\]: x along the axle, z from the profile's origin.
    pub at: [f64; 3],
    /// Sine and cosine of the profile's tangent there.
    pub tangent: [f64; 2],
    /// Curvature of the profile \[1/mm\], + with the hollow side up.
    pub curvature: f64,
    /// ∂/∂x and ∂/∂y of the wheel's height, in its axes.
    pub slopes: [f64; 2],
    /// ∂²/∂x², ∂²/∂x∂y, ∂²/∂y² of it \[1/mm\].
    pub bends: [f64; 3],
}

impl<'a> WheelAbove<'a> {
    pub fn new(section: &'a Section, attitude: &'a Attitude) -> Self {
        let mut wheel = Self { section, attitude, up: [0.0, 0.0, 1.0] };
        wheel.up = wheel.turned([0.0, 0.0, 1.0]);
        wheel
    }

    /// Turns a vector of the rail's axes into the wheel's.
    pub fn turned(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let a = self.attitude;
        let unrolled = x * a.cos_roll - z * a.sin_roll;
        [
            unrolled * a.cos_yaw + y * a.sin_yaw,
            y * a.cos_yaw - unrolled * a.sin_yaw,
            z * a.cos_roll + x * a.sin_roll,
        ]
    }

    /// Turns a vector of the wheel's axes into the rail's.
    pub fn turned_back(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let a = self.attitude;
        let across = x * a.cos_yaw - y * a.sin_yaw;
        [
            across * a.cos_roll + z * a.sin_roll,
            x * a.sin_yaw + y * a.cos_yaw,
            z * a.cos_roll - across * a.sin_roll,
        ]
    }

    /// Takes a point of the rail's axes, y from the middle of the axle, into the wheel's \[mm\].
    pub fn seen(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        self.turned([x - self.attitude.offset, y - self.attitude.along, z])
    }

    /// Finds the wheel's point above a point of the wheel's axes, or below; `None` where there is none.
    pub fn above(&self, from: [f64; 3]) -> Option<Above> {
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

    /// The wheel's lower side at (x, y) of its axes.
    fn over(&self, x: f64, y: f64) -> Option<Above> {
        let branch = self.section.branch_at(x)?;
        let (station, curvature) = branch.station_and_curvature(branch.parameter(x));
        let rolling = self.attitude.radius - station.z;
        let square = (rolling - y) * (rolling + y);
        if square <= 0.0 || station.cos <= 0.0 {
            return None;
        }
        let down = square.sqrt();
        let slope = station.sin / station.cos;
        let bend = curvature / station.cos.powi(3);
        let (across, along) = (rolling * slope / down, y / down);
        Some(Above {
            gap: 0.0,
            at: [x, y, station.z + y * y / (rolling + down)],
            tangent: [station.sin, station.cos],
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

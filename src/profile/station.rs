//! Points with a direction. They serve as frames, and as points of profiles seen from frames: Report (4.2), (4.3).

use serde::{Deserialize, Serialize};

/// A point of a profile with its unit tangent in the direction of travel, which on a graph z(x) is towards larger x.
///
/// # Examples
/// ```
/// use wheelrail::Station;
///
/// let frame = Station { x: 3.0, z: 4.0, cos: 0.8, sin: 0.6 };
/// let origin = Station::AXES.seen_from(&frame);
/// assert!((origin.x + 4.8).abs() < 1e-15 && (origin.z + 1.4).abs() < 1e-15);
/// assert!((origin.placed_by(&frame).x).abs() < 1e-15);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Station {
    /// Lateral coordinate \[mm\].
    pub x: f64,
    /// Height \[mm\].
    pub z: f64,
    /// cos φ; φ is the angle of the tangent from x to z.
    pub cos: f64,
    /// sin φ.
    pub sin: f64,
}

impl Station {
    /// The profile's own axes: origin (0, 0), tangent along x.
    pub const AXES: Self = Self { x: 0.0, z: 0.0, cos: 1.0, sin: 0.0 };

    /// Returns the tangent angle φ \[rad\] in (−π, π\].
    pub fn angle(&self) -> f64 {
        self.sin.atan2(self.cos)
    }

    /// Returns this station as seen from `frame`, which gives the origin and the first axis: eqs. (4.2-a, b).
    #[must_use]
    pub fn seen_from(&self, frame: &Self) -> Self {
        let (dx, dz) = (self.x - frame.x, self.z - frame.z);
        Self {
            x: dx * frame.cos + dz * frame.sin,
            z: dz * frame.cos - dx * frame.sin,
            cos: self.cos * frame.cos + self.sin * frame.sin,
            sin: self.sin * frame.cos - self.cos * frame.sin,
        }
    }

    /// Returns this station in the axes in which `frame` is given, if it is now given in the axes of `frame`: eqs. (4.3-a,
    /// b). It is the inverse of [`Station::seen_from`].
    #[must_use]
    pub fn placed_by(&self, frame: &Self) -> Self {
        Self {
            x: frame.x + self.x * frame.cos - self.z * frame.sin,
            z: frame.z + self.x * frame.sin + self.z * frame.cos,
            cos: self.cos * frame.cos - self.sin * frame.sin,
            sin: self.sin * frame.cos + self.cos * frame.sin,
        }
    }

    /// Returns the mirror image under z → −z.
    #[must_use]
    pub(crate) fn upside_down(&self) -> Self {
        Self { z: -self.z, sin: -self.sin, ..*self }
    }

    /// Returns the mirror image under x → −x. Its tangent still points towards larger x.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        Self { x: -self.x, z: self.z, cos: self.cos, sin: -self.sin }
    }
}

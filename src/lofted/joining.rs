//! How slices are joined along the track.

use crate::numerics::slopes;

/// How the points of successive slices are joined along the track.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "files", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Joining {
    /// The monotone cubic (pchip): local, and without overshoot where slices do not correspond.
    #[default]
    Monotone,
    /// The cubic spline without end conditions ("not a knot"), which CONTACT takes.
    Cubic,
}

impl Joining {
    pub(super) fn slopes(self, at: &[f64], values: &[f64]) -> Vec<f64> {
        match self {
            Self::Monotone => slopes::monotone(at, values),
            Self::Cubic => slopes::spline(at, values),
        }
    }
}

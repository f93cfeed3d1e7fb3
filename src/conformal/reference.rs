//! The surface over which gaps are given.

use serde::{Deserialize, Serialize};

/// The surface over which the gap of a grid is given.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "files", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Reference {
    /// The tangent plane at C: the first axis is ξ, the gap is s along ζ.
    #[default]
    Plane,
    /// The rail's own surface: the first axis is the arc length σ, and the normal gap t is given besides s.
    Rail,
}

//! The keys of `[left]` and `[right]`: what is different on one side of a wheelset.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::profile_data::ProfileData;

/// One side of a wheelset, described as a right-hand side: the left one is its mirror image.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SideData {
    /// The rail profile of this side.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rail: Option<ProfileData>,
    /// The wheel profile of this side; without `radius` it has that of `[wheel]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wheel: Option<ProfileData>,
    /// Vertical load of this side's wheel, N, instead of an approach or load in `[patch]`; the other side then has its own as well.
    #[schemars(extend("exclusiveMinimum" = 0))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub load: Option<f64>,
    /// How this side's rail deviates from its place on the track.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub deviation: Option<DeviationData>,
}

/// How a rail deviates from its nominal place, in track axes; gauge and top of rail are those of the nominal place.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct DeviationData {
    /// To the right, mm.
    pub lateral: f64,
    /// Up, mm.
    pub vertical: f64,
    /// About the track's y axis through the profile's origin, rad, right-handed: > 0 lowers what is to the right.
    pub roll: f64,
}

//! The keys of `[motion]` and `[friction]`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Speed and rates of a wheelset, or of a wheel alone, against the track at rest.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MotionData {
    /// Forward speed, m/s; negative backwards.
    pub speed: f64,
    /// Lateral velocity of the axle's middle, m/s, + to the right.
    #[serde(default)]
    pub lateral: f64,
    /// Vertical velocity of the axle's middle, m/s, + up.
    #[serde(default)]
    pub vertical: f64,
    /// Rate of yaw, rad/s, + moves the right-hand wheel forward; speed/radius in a steady curve to the left.
    #[serde(default)]
    pub yaw: f64,
    /// Rate of roll, rad/s, + lowers the right-hand wheel.
    #[serde(default)]
    pub roll: f64,
    /// "rolling": neither braked nor driven; "nominal": −speed/R; or rad/s about the axle to the right, < 0 forward.
    #[serde(default)]
    pub pitch: PitchData,
}

/// How fast a wheel turns about its axle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "expected \"rolling\", \"nominal\" or a rate in rad/s")]
pub enum PitchData {
    /// A word.
    Word(PitchWord),
    /// rad/s.
    Rate(f64),
}

impl Default for PitchData {
    fn default() -> Self {
        Self::Word(PitchWord::Rolling)
    }
}

/// The words for a rate of pitch.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum PitchWord {
    /// −speed/r, r the mean of both wheels' rolling radii where they touch first.
    Rolling,
    /// −speed/R, R the nominal rolling radius.
    Nominal,
}

/// Coefficients of friction between rail and wheel.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FrictionData {
    /// Where surfaces stick; 0.3 by default.
    #[schemars(extend("exclusiveMinimum" = 0))]
    #[serde(rename = "static", default, skip_serializing_if = "Option::is_none")]
    pub at_rest: Option<f64>,
    /// Where they slide; the static one by default.
    #[schemars(extend("exclusiveMinimum" = 0))]
    #[serde(rename = "kinetic", default, skip_serializing_if = "Option::is_none")]
    pub sliding: Option<f64>,
}

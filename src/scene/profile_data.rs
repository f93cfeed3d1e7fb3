//! The keys of `[rail]` and `[wheel]`.

use std::fmt;
use std::path::PathBuf;

use nalgebra::UnitComplex;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::{Error, Result, finite};
use crate::lofted::Joining;
use crate::measured::measured_options;
use crate::profile::{SegmentData, inclination};

measured_options! {
    @table
    /// A profile: exactly one of `profile`, `file`, `segments`; then `mirror`, `rotate`, `shift`, in this order.
    #[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(deny_unknown_fields)]
    pub struct ProfileData {
        /// Nominal rolling radius R of a wheel, mm: the distance from the axle to the profile's origin.
        #[schemars(extend("exclusiveMinimum" = 0))]
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub radius: Option<f64>,
        /// Name of a built-in profile (`wheelrail profile list`).
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub profile: Option<String>,
        /// File with `segments` (TOML or JSON) or with a measured profile; its path is relative to the scene.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub file: Option<PathBuf>,
        /// Segments in order of x.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub segments: Option<Vec<SegmentData>>,
        /// First point [x, z], mm, of segments in the drawing form of the Report's Appendix A.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub start: Option<[f64; 2]>,
        /// Turn about the profile's origin, counter-clockwise seen with x to the right and z up: rad, or "1:n".
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub rotate: Option<Rotation>,
        /// Shift [x, z], mm, after the turn.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub shift: Option<[f64; 2]>,
        /// Of an `.slcs` file without `along` or an `.slcw` file without `angle`: how slices are joined along the track or around the
        /// wheel, "monotone" (without overshoot) or "cubic".
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub surface: Option<Joining>,
        /// A flat on a wheel of one profile, in a scene for `wheelrail run`, `check` or `march`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub flat: Option<FlatData>,
        /// Rows [angle around the wheel in rad, deviation from its radius in mm] of a wheel of one profile that is out of round, in a
        /// scene for `wheelrail run`, `check` or `march`: ascending angles, less than a turn, joined by a periodic cubic spline.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub radii: Option<Vec<[f64; 2]>>,
    }
}

measured_options! { @method ProfileData }

impl ProfileData {
    /// Tells whether the source of a profile is given.
    pub fn has_source(&self) -> bool {
        self.profile.is_some() || self.file.is_some() || self.segments.is_some()
    }

    /// Tells whether nothing is given.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

/// A flat: a chord of the wheel's circumference. The profile keeps its shape across it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FlatData {
    /// Length L of the chord, mm; the flat is R − √(R² − L²/4) deep.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub length: f64,
    /// Where its middle lies around the wheel, rad.
    #[serde(default)]
    pub angle: f64,
    /// Radius of its edges, mm; 0 for a fresh flat.
    #[schemars(extend("minimum" = 0))]
    #[serde(default)]
    pub edge_radius: f64,
}

/// An angle, in radians or as an inclination.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "expected an angle in rad, or a ratio such as \"1:40\"")]
pub enum Rotation {
    /// Radians.
    Radians(f64),
    /// The inclination "1:n", which is atan(1/n); "-1:n" turns the other way.
    Ratio(String),
}

impl Rotation {
    /// Gives the rotation that is written, counter-clockwise from x to z.
    ///
    /// # Errors
    /// An angle that is not finite; a ratio of other than two numbers, or with a run of 0.
    pub fn turn(&self) -> Result<UnitComplex<f64>> {
        let bad = |found: String| {
            let advice = "write an inclination with a colon and quotes, an angle as a number without quotes";
            Error::new("", found, "rad, or \"1:n\" with n ≠ 0", advice)
        };
        match self {
            Self::Radians(angle) => Ok(UnitComplex::new(finite("", *angle)?)),
            Self::Ratio(text) => {
                let (one, n) = text.split_once(':').ok_or_else(|| bad(format!("\"{text}\"")))?;
                let number = |s: &str| s.trim().parse::<f64>().ok().filter(|v| v.is_finite());
                match (number(one), number(n)) {
                    (Some(rise), Some(run)) if run != 0.0 => inclination(rise, run),
                    _ => Err(bad(format!("\"{text}\""))),
                }
            }
        }
    }
}

impl fmt::Display for Rotation {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Radians(angle) => write!(f, "{angle}"),
            Self::Ratio(text) => write!(f, "\"{text}\""),
        }
    }
}

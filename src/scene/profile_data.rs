//! The keys of `[rail]` and `[wheel]`.

use std::fmt;
use std::path::PathBuf;

use nalgebra::UnitComplex;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::{Error, Result, finite};
use crate::measured;
use crate::profile::{SegmentData, inclination};

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
    /// Mirror image under x → −x, before `rotate` and `shift`. For a measured profile: whether its first axis points to the
    /// centre of the track.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mirror: Option<bool>,
    /// Turn about the profile's origin, counter-clockwise seen with x to the right and z up: rad, or "1:n".
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotate: Option<Rotation>,
    /// Shift [x, z], mm, after the turn.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shift: Option<[f64; 2]>,
    /// Format of a measured file; if not given, its extension tells.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub format: Option<measured::Format>,
    /// Columns of x and z in a text or CSV file, by number from 1 or by name.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub columns: Option<[measured::Column; 2]>,
    /// Section of an .mpt file, from 1.
    #[schemars(extend("minimum" = 1))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub section: Option<usize>,
    /// Of an .slcs file: place of the section along the track, mm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub along: Option<f64>,
    /// Of an .slcw file: place of the section around the wheel, rad.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub angle: Option<f64>,
    /// Of a measured file: whether its second axis points down.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub flip_z: Option<bool>,
    /// Unit of the coordinates of a measured file, or of `segments`; mm if not given. `radius` and `shift` are in mm in any case.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<measured::Unit>,
    /// Point of a measured file that becomes the origin.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub origin: Option<measured::Origin>,
    /// Depth of a measured rail's gauge point below the top of rail, mm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gauge_height: Option<f64>,
    /// Distance of a measured wheel's taping line from the flange back, mm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tape_distance: Option<f64>,
    /// Whether the points of a measured rail contain its inclination already.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub already_inclined: bool,
    /// Repairs that may be made to a measured file.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub repair: Vec<measured::Repair>,
    /// Kind of curve through the points of a measured file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub curve: Option<measured::CurveKind>,
    /// Wavelength that smoothing of a measured file halves, mm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cutoff_wavelength: Option<f64>,
    /// Kink angle of a measured file, rad; sharper kinks stay corners.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kink_angle: Option<f64>,
    /// Largest distance of a point of a measured file from a chain of arcs, mm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub arc_tolerance: Option<f64>,
}

impl ProfileData {
    /// Tells whether nothing is given.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// Gives the keys of a measured file.
    pub fn measured(&self) -> measured::Options {
        measured::Options {
            format: self.format,
            columns: self.columns.clone(),
            section: self.section,
            along: self.along,
            angle: self.angle,
            mirror: self.mirror,
            flip_z: self.flip_z,
            unit: self.unit,
            origin: self.origin,
            gauge_height: self.gauge_height,
            tape_distance: self.tape_distance,
            already_inclined: self.already_inclined,
            repair: self.repair.clone(),
            curve: self.curve,
            cutoff_wavelength: self.cutoff_wavelength,
            kink_angle: self.kink_angle,
            arc_tolerance: self.arc_tolerance,
        }
    }
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

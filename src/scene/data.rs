//! The keys of a scene. Unknown keys are errors.

use std::path::PathBuf;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::profile::drawing::SegmentData;
use crate::separation::grid::Method;

/// A scene: one wheel on one rail, what is asked of it, and what is to be written.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// Title for pictures and file headers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
    /// The rail profile.
    pub rail: ProfileData,
    /// The wheel profile and its rolling radius.
    pub wheel: ProfileData,
    /// Where the two touch.
    pub contact: ContactData,
    /// How far they approach.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub patch: Option<PatchData>,
    /// Elastic constants, for `load` and for solver decks.
    #[serde(default)]
    pub material: MaterialData,
    /// Where s is evaluated.
    #[serde(default)]
    pub grid: GridData,
    /// What is written.
    #[serde(default)]
    pub output: OutputData,
}

/// A profile: exactly one of `profile`, `file`, `segments`; then `mirror`, `rotate`, `shift`, in this order.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ProfileData {
    /// Of a wheel: nominal rolling radius R, mm, the distance from the axle to the profile's origin.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub radius: Option<f64>,
    /// Name of a built-in profile (`wheelrail profile list`).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub profile: Option<String>,
    /// File with `segments` (TOML or JSON), relative to the scene.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<PathBuf>,
    /// Segments in order of x.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub segments: Option<Vec<SegmentData>>,
    /// First point [x, z], mm, of segments in the drawing form of Appendix A.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub start: Option<[f64; 2]>,
    /// Mirror image under x → −x, before anything else.
    #[serde(default)]
    pub mirror: bool,
    /// Turn about the profile's origin, counter-clockwise seen with x to the right and z up: rad, or "1:n".
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotate: Option<Rotation>,
    /// Shift [x, z], mm, after the turn.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shift: Option<[f64; 2]>,
}

/// An angle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "an angle in rad, or a ratio such as \"1:40\"")]
pub enum Rotation {
    /// Radians.
    Radians(f64),
    /// "1:n", atan(1/n); "-1:n" the other way.
    Ratio(String),
}

/// A chosen pair of points.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ContactData {
    /// Abscissa of C on the rail profile, mm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rail_x: Option<f64>,
    /// Abscissa of C on the wheel profile, mm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wheel_x: Option<f64>,
}

/// The approach δ, or the load that it is estimated from.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PatchData {
    /// δ, mm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub approach: Option<f64>,
    /// Normal load, N; δ is then an estimate.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub load: Option<f64>,
}

/// Elastic constants of both bodies; by default steel.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct MaterialData {
    /// Young's modulus of the rail, N/mm².
    pub rail_youngs_modulus: f64,
    /// Poisson's ratio of the rail.
    pub rail_poissons_ratio: f64,
    /// Young's modulus of the wheel, N/mm².
    pub wheel_youngs_modulus: f64,
    /// Poisson's ratio of the wheel.
    pub wheel_poissons_ratio: f64,
}

impl Default for MaterialData {
    fn default() -> Self {
        Self {
            rail_youngs_modulus: 2.1e5,
            rail_poissons_ratio: 0.28,
            wheel_youngs_modulus: 2.1e5,
            wheel_poissons_ratio: 0.28,
        }
    }
}

/// Where and how well s is evaluated.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct GridData {
    /// Values of ξ.
    pub xi: AxisData,
    /// Values of η.
    pub eta: AxisData,
    /// Step of automatic axes, mm: one for both, or [Δξ, Δη]. Without it 16 cells over the patch's short axis.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spacing: Option<Spacing>,
    /// Absolute tolerance on s, mm.
    pub tolerance: f64,
    /// A method of the accuracy ladder; "auto" takes the cheapest within the tolerance.
    pub method: GridMethod,
}

impl Default for GridData {
    fn default() -> Self {
        Self {
            xi: AxisData::Word(Auto::Auto),
            eta: AxisData::Word(Auto::Auto),
            spacing: None,
            tolerance: 1e-12,
            method: GridMethod::Auto,
        }
    }
}

/// One axis of the grid.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "\"auto\", { from = …, to = …, n = … } or { values = […] }")]
pub enum AxisData {
    /// "auto": the patch and a margin.
    Word(Auto),
    /// n equal steps.
    Steps(StepsData),
    /// Any ascending values.
    Values(ValuesData),
}

/// The word "auto".
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Auto {
    /// "auto".
    Auto,
}

/// n values from `from` to `to`, both included.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StepsData {
    /// First value, mm.
    pub from: f64,
    /// Last value, mm.
    pub to: f64,
    /// How many values.
    pub n: u64,
}

/// A list of values.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ValuesData {
    /// Ascending values, mm.
    pub values: Vec<f64>,
}

/// Step of automatic axes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "a step in mm, or [Δξ, Δη]")]
pub enum Spacing {
    /// The same for both axes.
    Both(f64),
    /// [Δξ, Δη].
    Each([f64; 2]),
}

/// The `method` of a grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[allow(missing_docs, reason = "the variants are those of `Method`")]
pub enum GridMethod {
    #[default]
    Auto,
    Quadratic,
    ConstantRadius,
    Parabolic,
    Spectral,
    Pointwise,
    ReportNewton,
}

impl GridMethod {
    /// The forced method, or `None` for "auto".
    pub fn forced(self) -> Option<Method> {
        match self {
            Self::Auto => None,
            Self::Quadratic => Some(Method::Quadratic),
            Self::ConstantRadius => Some(Method::ConstantRadius),
            Self::Parabolic => Some(Method::Parabolic),
            Self::Spectral => Some(Method::Spectral),
            Self::Pointwise => Some(Method::Pointwise),
            Self::ReportNewton => Some(Method::ReportNewton),
        }
    }
}

/// What is written besides summary.json, the tables and the picture.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct OutputData {
    /// Formats; all but "png" by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub formats: Option<Vec<Format>>,
}

impl OutputData {
    /// The formats to write.
    pub fn wanted(&self) -> &[Format] {
        use Format::{Conform, Contact, Countact, Netcdf, Npy, Text, Vtk};
        self.formats.as_deref().unwrap_or(&[Vtk, Npy, Netcdf, Text, Conform, Countact, Contact])
    }
}

/// One output format.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Format {
    /// .vts, .vtp, .vtu and view.py.
    Vtk,
    /// xi.npy, eta.npy, separation.npy.
    Npy,
    /// separation.nc.
    Netcdf,
    /// separation.wrp.
    Text,
    /// conform.wrp.
    Conform,
    /// countact.wrp.
    Countact,
    /// contact.inp.
    Contact,
    /// patch.png.
    Png,
}

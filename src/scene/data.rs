//! The keys of a scene. Unknown keys are errors.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::method_or_auto;
use super::motion_data::{FrictionData, MotionData};
use super::profile_data::ProfileData;
use super::side_data::SideData;
use crate::case::{FrameOrigin, OutputFormat};
use crate::conformal::Reference;
use crate::error::{Result, finite};
use crate::search::{Position, Roll};
use crate::separation::Method;

/// A scene: a wheel on a rail or a wheelset on a track, the questions about it, and the files to write.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// Title for pictures and file headers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
    /// The rail profile; of both sides, mirrored on the left, unless `left` or `right` has its own.
    #[serde(default, skip_serializing_if = "ProfileData::is_empty")]
    pub rail: ProfileData,
    /// The wheel profile and its rolling radius; of both sides, mirrored on the left, unless `left` or `right` has its own.
    #[serde(default, skip_serializing_if = "ProfileData::is_empty")]
    pub wheel: ProfileData,
    /// The roller that stands in place of each rail: the rail's profile is revolved, not extruded.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub roller: Option<RollerData>,
    /// What is different on the left side of a wheelset.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub left: Option<SideData>,
    /// What is different on the right side of a wheelset.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub right: Option<SideData>,
    /// Where the two touch, for one wheel on one rail.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contact: Option<ContactData>,
    /// The track, for a wheelset.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub track: Option<TrackData>,
    /// The wheelset on the track.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wheelset: Option<WheelsetData>,
    /// How far the bodies approach, or the load that presses them together.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub patch: Option<PatchData>,
    /// Elastic constants, for `load` and for solver decks.
    #[serde(default)]
    pub material: MaterialData,
    /// Where s is evaluated, and how accurately.
    #[serde(default)]
    pub grid: GridData,
    /// How fine the triangle mesh of the patch is.
    #[serde(default, skip_serializing_if = "MeshData::is_default")]
    pub mesh: MeshData,
    /// Which files are written.
    #[serde(default)]
    pub output: OutputData,
    /// How the wheels move, for creepages.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub motion: Option<MotionData>,
    /// Friction, for solver decks.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction: Option<FrictionData>,
}

/// Returns the JSON Schema of a scene.
pub fn schema() -> schemars::Schema {
    schemars::schema_for!(Scene)
}

impl Scene {
    /// Gives the place along the track at which a wheelset or a wheel stands on rails that vary \[mm\]; `None` of a scene without one.
    ///
    /// # Errors
    /// A place that is not finite.
    pub(super) fn along(&self) -> Result<Option<f64>> {
        let of_wheelset = self.wheelset.as_ref().and_then(|wheelset| wheelset.along);
        let of_wheel = self.contact.as_ref().and_then(|contact| contact.along);
        match (of_wheelset, of_wheel) {
            (Some(along), _) => finite("wheelset: along", along).map(Some),
            (None, Some(along)) => finite("contact: along", along).map(Some),
            (None, None) => Ok(None),
        }
    }

    /// Gives how far wheels that vary are turned about their axle \[rad\]; 0 of a scene that does not say.
    ///
    /// # Errors
    /// An angle that is not finite.
    pub(super) fn pitch(&self) -> Result<f64> {
        let of_wheel = self.contact.as_ref().and_then(|contact| contact.pitch);
        match (&self.wheelset, of_wheel) {
            (Some(wheelset), _) => finite("wheelset: pitch", wheelset.pitch),
            (None, Some(pitch)) => finite("contact: pitch", pitch),
            (None, None) => Ok(0.0),
        }
    }

    /// Tells whether a load is given, of the axle, of each wheel or of a side.
    pub fn loaded(&self) -> bool {
        let sides = [&self.left, &self.right].into_iter().flatten();
        self.wheelset.as_ref().is_some_and(|wheelset| wheelset.load.is_some())
            || self.patch.as_ref().is_some_and(|patch| patch.load.is_some())
            || sides.into_iter().any(|side| side.load.is_some())
    }

    /// Lists the profiles that it describes, those of both sides and those of one.
    pub fn profiles(&self) -> impl Iterator<Item = &ProfileData> {
        let sides = [&self.left, &self.right].into_iter().flatten();
        let own = sides.flat_map(|side| [&side.rail, &side.wheel]).flatten();
        [&self.rail, &self.wheel].into_iter().chain(own)
    }

    /// Gives the same scene with its wheelset at another position; a scene without a wheelset as it is. A roll by load stays where the
    /// position asks for a solved roll.
    #[must_use]
    pub fn at(&self, position: &Position) -> Self {
        let roll = match (position.roll, self.wheelset.as_ref().and_then(|wheelset| wheelset.roll)) {
            (Roll::Solve, own @ (None | Some(RollData::Word(RollWord::Load)))) => own,
            (Roll::Solve, _) => Some(RollData::Word(RollWord::Solve)),
            (Roll::Neglect, _) => Some(RollData::Word(RollWord::Neglect)),
            (Roll::Fixed(angle), _) => Some(RollData::Radians(angle)),
        };
        let (lateral, yaw) = (position.lateral, position.yaw);
        let moved = |wheelset: &WheelsetData| WheelsetData { lateral, yaw, roll, ..wheelset.clone() };
        Self { wheelset: self.wheelset.as_ref().map(moved), ..self.clone() }
    }
}

/// A roller below the wheel, with the rail's profile.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RollerData {
    /// Distance from the roller's axle, which is below, to the origin of the rail's profile, mm.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub radius: f64,
}

/// A chosen pair of points, or a placed single wheel that is lowered until it touches.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ContactData {
    /// Abscissa of C on the rail profile, mm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rail_x: Option<f64>,
    /// Abscissa of C on the wheel profile, mm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wheel_x: Option<f64>,
    /// Lateral offset of the wheel profile's origin from that of the rail profile, mm, + to the field side.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub offset: Option<f64>,
    /// Roll of the wheel about the track's y axis, rad, right-handed, applied second.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub roll: Option<f64>,
    /// Yaw of the wheel about z, rad, right-handed, applied first.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub yaw: Option<f64>,
    /// Largest vertical gap, mm, up to which near misses are reported.
    #[schemars(extend("minimum" = 0))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub within: Option<f64>,
    /// Where the wheel's centre is along a rail that varies, mm, as its list of slices counts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub along: Option<f64>,
    /// How far a wheel that varies has turned about its axle, rad, + forward at the bottom, so that what lies at −pitch is lowest.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pitch: Option<f64>,
}

/// A track of two rails: the right one is as described, the left one is its mirror image.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TrackData {
    /// Distance between the rails' inner faces, mm.
    #[schemars(extend("exclusiveMinimum" = 0))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gauge: Option<f64>,
    /// Depth below the top of rail down to which the gauge is measured, mm; 14 if not given.
    #[schemars(extend("minimum" = 0, "default" = 14))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gauge_height: Option<f64>,
    /// Distance between the origins of the rail profiles, mm; instead of the gauge.
    #[schemars(extend("exclusiveMinimum" = 0))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spacing: Option<f64>,
}

/// A wheelset of two wheels on an axle: the right one is as described, the left one is its mirror image.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WheelsetData {
    /// Distance between the flange backs, mm.
    #[schemars(extend("exclusiveMinimum" = 0))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub back_to_back: Option<f64>,
    /// Abscissa of the flange back on the wheel profile, mm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub flange_back_x: Option<f64>,
    /// Distance between the origins of the wheel profiles, mm; instead of `back_to_back` and `flange_back_x`.
    #[schemars(extend("exclusiveMinimum" = 0))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spacing: Option<f64>,
    /// Lateral displacement, mm, + to the right.
    #[serde(default)]
    pub lateral: f64,
    /// Yaw about z, rad, applied first; a positive yaw moves the right-hand wheel forward.
    #[serde(default)]
    pub yaw: f64,
    /// Roll: "solve" (both wheels touch), "load" (each wheel carries its load), "neglect" (0), or rad about the track's y axis;
    /// a positive roll lowers the right-hand wheel. If not given, "load" beside the axle's `load`, otherwise "solve".
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub roll: Option<RollData>,
    /// Pitch about the axle, rad: how far wheels that vary have turned, + forward at the bottom, so that what lies at −pitch is lowest.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub pitch: f64,
    /// Vertical load of the axle, N, instead of an approach or load in `[patch]`: the axle rolls until each wheel carries half; with
    /// another `roll` than "load" both wheels sink by the same distance. δ is an estimate.
    #[schemars(extend("exclusiveMinimum" = 0))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub load: Option<f64>,
    /// Largest vertical gap, mm, up to which near misses are reported.
    #[schemars(extend("minimum" = 0))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub within: Option<f64>,
    /// Where the middle of the axle is along rails that vary, mm, as their lists of slices count; `wheelrail march` goes along all of
    /// them and does not take it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub along: Option<f64>,
}

// serde prescribes the reference to the value.
fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

/// How the roll of a wheelset is found.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "expected \"solve\", \"load\", \"neglect\" or an angle in rad")]
pub enum RollData {
    /// One of the words.
    Word(RollWord),
    /// The roll, rad.
    Radians(f64),
}

impl Default for RollData {
    fn default() -> Self {
        Self::Word(RollWord::Solve)
    }
}

/// The words for a roll.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum RollWord {
    /// Both wheels touch: the roll is sought.
    Solve,
    /// Each wheel carries its load: the roll is sought at which it does.
    Load,
    /// The roll is 0; each side is lowered on its own.
    Neglect,
}

/// The approach δ, or the load that it is estimated from.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PatchData {
    /// Approach δ, mm, at most 200.
    #[schemars(extend("minimum" = 0, "maximum" = 200))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub approach: Option<f64>,
    /// Vertical load of each wheel, N; all its contacts share it. δ is then an estimate.
    #[schemars(extend("exclusiveMinimum" = 0))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub load: Option<f64>,
    /// Whether the pressures over the grid are solved and written, of an elastic half-space without friction.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub pressure: bool,
    /// Longest side of the half-space's cells, mm: the grid's steps are divided by odd numbers. If not given, by three, or by nine
    /// where the largest pressure may then err by more than 1 %.
    #[schemars(extend("exclusiveMinimum" = 0))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pressure_cell: Option<f64>,
    /// Origin and angle of the contact frame: "contact", the contact point and its tangent, or "weighted", the centre of
    /// the overlap and the mean angle of the rail there, as in CONTACT; forces under a load are then continuous. "auto", as if not
    /// given: "weighted" for a region of several places under a load, otherwise "contact".
    #[serde(default, skip_serializing_if = "is_auto")]
    pub frame: FrameOrigin,
}

/// Tells whether the frame is the usual one, which a scene need not name.
fn is_auto(frame: &FrameOrigin) -> bool {
    *frame == FrameOrigin::Auto
}

/// Elastic constants of both bodies; steel if not given.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct MaterialData {
    /// Young's modulus of the rail, N/mm².
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub rail_youngs_modulus: f64,
    /// Poisson's ratio of the rail.
    #[schemars(extend("exclusiveMinimum" = -1, "maximum" = 0.5))]
    pub rail_poissons_ratio: f64,
    /// Young's modulus of the wheel, N/mm².
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub wheel_youngs_modulus: f64,
    /// Poisson's ratio of the wheel.
    #[schemars(extend("exclusiveMinimum" = -1, "maximum" = 0.5))]
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

/// The grid of points on which s is evaluated, and its accuracy.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct GridData {
    /// Values of ξ.
    pub xi: AxisData,
    /// Values of η.
    pub eta: AxisData,
    /// Step of automatic axes, mm: one number for both axes, or [Δξ, Δη]. If not given, 16 cells over the patch's short
    /// axis.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spacing: Option<Spacing>,
    /// Parts of the patch closer to each other than this, mm, share one automatic grid. If not given, each part has a grid
    /// of its own.
    #[schemars(extend("minimum" = 0))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub merge: Option<f64>,
    /// The surface over which the gap is given: "plane", the tangent plane at C, or "rail", the rail's own surface. With "rail"
    /// the values of `xi` are arc lengths σ along the rail from C, and the normal gap is written besides s.
    #[serde(skip_serializing_if = "is_plane")]
    pub reference: Reference,
    /// Absolute tolerance on s, mm.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub tolerance: f64,
    /// Method of the accuracy ladder. "auto" takes the cheapest one within the tolerance.
    #[serde(with = "method_or_auto")]
    #[schemars(schema_with = "method_or_auto::schema")]
    pub method: Option<Method>,
}

// serde prescribes the reference to the value.
fn is_plane(reference: &Reference) -> bool {
    *reference == Reference::Plane
}

impl Default for GridData {
    fn default() -> Self {
        Self {
            xi: AxisData::Word(Auto::Auto),
            eta: AxisData::Word(Auto::Auto),
            spacing: None,
            merge: None,
            reference: Reference::Plane,
            tolerance: 1e-12,
            method: None,
        }
    }
}

/// One axis of the grid.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "expected \"auto\", { from = …, to = …, n = … } or { values = […] }")]
pub enum AxisData {
    /// The word "auto": the patch and a margin.
    Word(Auto),
    /// Equal steps.
    Steps(StepsData),
    /// A list of ascending values.
    Values(ValuesData),
}

/// The word "auto".
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Auto {
    /// The axis covers the patch and a margin.
    Auto,
}

/// The `n` values from `from` to `to` at equal steps, both ends included.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StepsData {
    /// First value, mm.
    pub from: f64,
    /// Last value, mm.
    pub to: f64,
    /// Number of values.
    #[schemars(extend("minimum" = 2, "maximum" = 1000000))]
    pub n: u64,
}

/// A list of values.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ValuesData {
    /// Ascending values, mm.
    #[schemars(extend("minItems" = 1))]
    pub values: Vec<f64>,
}

/// The step of automatic axes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "expected a step in mm, or [Δξ, Δη]")]
pub enum Spacing {
    /// One step for both axes.
    Both(f64),
    /// The steps [Δξ, Δη].
    Each([f64; 2]),
}

/// The triangle mesh of the patch for finite elements.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct MeshData {
    /// Length of its edges where neither curvature nor a narrow place asks for shorter ones, mm; without it, for each part of
    /// the patch a 16th of the side of a square with its area.
    #[schemars(extend("exclusiveMinimum" = 0))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub size: Option<f64>,
}

impl MeshData {
    /// Tells whether no key is given.
    pub fn is_default(&self) -> bool {
        *self == Self::default()
    }
}

/// The files that are written besides summary.json, the tables and the picture.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct OutputData {
    /// Formats; if not given, all but "png", "gmsh", "abaqus", "stl", "ply" and "vtp".
    #[serde(skip_serializing_if = "Option::is_none")]
    pub formats: Option<Vec<OutputFormat>>,
}

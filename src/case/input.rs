//! A case: what is to be computed, as checked values.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::doubts::Doubt;
use super::formats::{FormatFile, OutputFormat, Writer};
use super::landmarks::{Landmarks, SideLandmarks};
use crate::conformal::Reference;
use crate::error::{Error, Result};
use crate::load::{Elastic, effective_modulus};
use crate::lofted::LoftedBody;
use crate::measured::Record;
use crate::numerics::bodies::Bodies;
use crate::placement::{Motion, Pair, Track, Wheelset};
use crate::profile::Side;
use crate::search::{LoftedPair, Pose, Position, ProfilePair, SideOnTrack, TrackSide, WheelsetOnTrack};
use crate::separation::Method;

/// Two prepared profiles, where they stand, what is asked of them, and what is to be written.
///
/// The room `scene` makes one, by its `resolve`. A clone shares the profiles and the search trees over them.
#[derive(Debug, Clone)]
pub struct Case {
    pub(crate) profiles: Profiles,
    pub(crate) setup: Setup,
    pub(crate) question: Question,
    pub(crate) axes: AskedAxes,
    pub(crate) outputs: Outputs,
    pub(crate) echo: Echo,
    pub(crate) file: Option<PathBuf>,
    /// Landmarks by which its contacts are judged.
    pub(crate) landmarks: SideLandmarks,
    /// What in the scene looks like a slip: warnings.
    pub(crate) doubts: Vec<Doubt>,
}

/// The profiles of both sides, the right-hand one's first; a single wheel and a symmetric wheelset have one pair.
#[derive(Debug, Clone)]
pub struct Profiles {
    /// The right-hand side's, or both sides'.
    pub right: SideProfiles,
    /// The left-hand side's where they are others.
    pub left: Option<SideProfiles>,
}

/// Rail and wheel of one side, and what was done to measured ones.
#[derive(Debug, Clone)]
pub struct SideProfiles {
    /// Rail and wheel.
    pub pair: Pair,
    /// The record of each; `None` for a drawn profile.
    pub measured: Bodies<Option<Record>>,
    /// The surface of a rail that varies along the track, or of a wheel that varies around its axle: `pair` then has a section of it, or
    /// the profile before it was made to vary.
    pub varying: Option<LoftedBody>,
}

impl SideProfiles {
    /// Prepares them for searches on a track.
    ///
    /// # Errors
    /// Profiles of which no part faces the other body.
    pub fn on_track(&self, track: Track, axle: Wheelset) -> Result<SideOnTrack> {
        match &self.varying {
            None => SideOnTrack::new(&self.pair, track, axle),
            Some(body) => {
                let pair = LoftedPair::of_pair(&self.pair, body)?;
                Ok(SideOnTrack::lofted(Arc::new(pair), track, axle))
            }
        }
    }

    /// Names rail and wheel, as a title: "60E1 under S1002".
    pub fn names(&self) -> String {
        format!("{} under {}", self.pair.rail().title(), self.pair.wheel().title())
    }
}

impl Profiles {
    /// Makes the profiles of both sides from one drawn pair.
    pub fn drawn(pair: Pair) -> Self {
        Self { right: SideProfiles { pair, measured: Bodies::default(), varying: None }, left: None }
    }

    /// Finds the landmarks of both sides' pairs.
    pub fn landmarks(&self) -> SideLandmarks {
        let own = |side: &SideProfiles| Landmarks::varying(&side.pair, side.varying.as_ref());
        SideLandmarks::new(own(&self.right), self.left.as_ref().map(own))
    }

    /// Lists which bodies vary: rails along the track, or wheels around their axle.
    pub fn varying(&self) -> impl Iterator<Item = Side> {
        self.sides().filter_map(|(_, profiles)| profiles.varying.as_ref()).map(LoftedBody::side)
    }

    /// Refuses bodies that vary, for what takes bodies of one profile.
    ///
    /// # Errors
    /// A rail or a wheel that varies; `advice` says what can be had instead.
    pub fn swept(&self, advice: &str) -> Result<()> {
        let Some(side) = self.varying().next() else { return Ok(()) };
        let (key, expected) = match side {
            Side::Rail => ("rail", "rails of one profile each, or `along` in [rail]"),
            Side::Wheel => {
                ("wheel", "wheels of one profile each: no `flat`, no `radii`, and `angle` with a list")
            }
        };
        Err(Error::new(key, LoftedBody::name(side), expected, advice))
    }

    /// Gives the profiles of a side; a single wheel has the right-hand side's.
    pub fn on(&self, side: Option<TrackSide>) -> &SideProfiles {
        self.left.as_ref().filter(|_| side == Some(TrackSide::Left)).unwrap_or(&self.right)
    }

    /// Lists the profiles of the right-hand side and then of the left, each with its side; one pair without a side where both share it.
    pub fn sides(&self) -> impl Iterator<Item = (Option<TrackSide>, &SideProfiles)> {
        let right = self.left.as_ref().map(|_| TrackSide::Right);
        let left = self.left.iter().map(|left| (Some(TrackSide::Left), left));
        [(right, &self.right)].into_iter().chain(left)
    }
}

/// Where the bodies stand, and how far near misses are looked for.
#[derive(Debug, Clone)]
pub struct Setup {
    /// What is placed, and where.
    pub arrangement: Arrangement,
    /// Largest vertical gap \[mm\] of a near miss that is reported; usually 0.
    pub within: f64,
    /// Whether the roll of a wheelset, where it is solved, is that at which each wheel carries its load.
    pub roll_by_load: RollByLoad,
    /// Where the middle of the axle is along rails that vary, in the coordinate of their lists \[mm\]; 0 on others.
    pub along: f64,
    /// By how much wheels that vary are turned about their axle \[rad\]: what lies at −pitch is lowest; 0 of others.
    pub pitch: f64,
}

/// Whether the roll of a wheelset is that at which each wheel carries its load, not that of first touch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RollByLoad {
    /// It is not.
    No,
    /// It is, as the axle has a load and no other roll is asked for; what knows first touch only, such as a table, has that.
    Unasked,
    /// It is asked for.
    Asked,
}

/// The ways to place bodies.
#[derive(Debug, Clone)]
pub enum Arrangement {
    /// Both profiles touch at chosen points of them, the Report's way.
    Points {
        /// Abscissa on the rail profile \[mm\].
        rail_x: f64,
        /// Abscissa on the wheel profile \[mm\].
        wheel_x: f64,
    },
    /// A single wheel is lowered until it touches.
    Wheel {
        /// The profiles, prepared for searches.
        profiles: Arc<ProfilePair>,
        /// Where the wheel stands.
        pose: Pose,
    },
    /// A single wheel is lowered onto its rail, and one of them varies.
    OnSlices {
        /// Rail and wheel, prepared for searches.
        pair: Arc<LoftedPair>,
        /// Where the wheel stands across.
        pose: Pose,
    },
    /// A wheelset is lowered onto its track.
    Wheelset {
        /// The wheelset and the track, prepared for searches.
        system: Arc<WheelsetOnTrack>,
        /// Displacement, yaw and roll.
        position: Position,
    },
}

/// How far the bodies approach, and how that is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ApproachBy {
    /// δ is given \[mm\].
    Given(f64),
    /// δ of every contact is estimated from the vertical load of each wheel \[N\].
    WheelLoad(f64),
    /// δ of every contact is estimated from the vertical loads of both wheels \[N\].
    WheelLoads {
        /// That of the right-hand wheel.
        right: f64,
        /// That of the left-hand wheel.
        left: f64,
    },
    /// δ of every contact is estimated from the vertical load of the axle \[N\]: both wheels sink alike, or each carries half of it
    /// where the roll follows the loads.
    AxleLoad(f64),
}

impl ApproachBy {
    /// Gives the vertical load of a wheel \[N\], which is half of an axle's; `None` if the approach is given.
    pub fn of_wheel(self, left_hand: bool) -> Option<f64> {
        match self {
            Self::Given(_) => None,
            Self::WheelLoad(load) => Some(load),
            Self::WheelLoads { right, left } => Some(if left_hand { left } else { right }),
            Self::AxleLoad(load) => Some(load / 2.0),
        }
    }
}

/// Where the frame of a contact has its origin, and whose angle.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum FrameOrigin {
    /// Under a load [`Self::Weighted`] for a region of several places, if both bodies have one profile each and the wheel does not stand
    /// with yaw on a roller; otherwise [`Self::Contact`].
    #[default]
    Auto,
    /// The contact point C and the common tangent there.
    Contact,
    /// The centre of the overlap and the mean angle of the rail's surface under it; the weight is the squared vertical overlap.
    Weighted,
}

/// What is asked of every contact.
#[derive(Debug, Clone, PartialEq)]
pub struct Question {
    /// The approach; `None` asks for the geometry only.
    pub approach: Option<ApproachBy>,
    /// Where the frames of contacts under an approach have their origin.
    pub frame: FrameOrigin,
    /// How the wheels move, for the creepages; `None` asks for none.
    pub motion: Option<Motion>,
    /// Elastic constants of rail and wheel.
    pub material: Bodies<Elastic>,
    /// Friction between them; it enters solver decks only.
    pub friction: Friction,
    /// Absolute tolerance on s \[mm\]; 1e-12 asks for all digits.
    pub tolerance: f64,
    /// The pressures over the grid; `None` asks for those only that a load was found with.
    pub pressure: Option<AskedPressure>,
    /// A method of the accuracy ladder; `None` takes the cheapest within the tolerance.
    pub method: Option<Method>,
}

/// What is asked of the pressures over a grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AskedPressure {
    /// Longest side of the cells \[mm\], > 0; `None` takes thirds of the grid's steps, or ninths where thirds may err by more
    /// than 1 %.
    pub cell: Option<f64>,
}

/// Coulomb's friction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Friction {
    /// Coefficient where surfaces stick \[–\], positive, typically 0.3.
    pub at_rest: f64,
    /// Coefficient where they slide \[–\], positive, at most the other.
    pub sliding: f64,
}

impl Default for Friction {
    fn default() -> Self {
        Self { at_rest: 0.3, sliding: 0.3 }
    }
}

impl Question {
    /// Gives E* of both materials \[N/mm²\].
    pub fn modulus(&self) -> f64 {
        effective_modulus(&self.material.rail, &self.material.wheel)
    }
}

/// The axes of a case's grids.
#[derive(Debug, Clone, PartialEq)]
pub struct AskedAxes {
    /// ξ \[mm\], ascending; `None` sizes the axis by the patch.
    pub xi: Option<Vec<f64>>,
    /// η \[mm\], ascending; `None` sizes the axis by the patch.
    pub eta: Option<Vec<f64>>,
    /// \[Δξ, Δη\] \[mm\] of automatic axes; `None` lays 16 cells over the patch's shorter side.
    pub spacing: Option<[f64; 2]>,
    /// Parts of the patch closer than this \[mm\] share a grid; 0 merges none.
    pub merge: f64,
    /// The surface over which gaps are given; with the rail `xi` holds σ.
    pub reference: Reference,
}

/// The files that are written besides the tables and the picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Outputs {
    /// Their formats.
    pub formats: Vec<OutputFormat>,
    /// Whether each of them has to be written. Otherwise a format that cannot hold the grid is left out with a remark.
    pub required: bool,
    /// Length of the edges of the patch's triangle mesh \[mm\]; `None` takes it from each part of the patch.
    pub mesh_size: Option<f64>,
}

impl Outputs {
    /// Lists the files of the formats.
    pub(super) fn files(&self) -> impl Iterator<Item = FormatFile> {
        let formats = OutputFormat::ALL.iter().filter(|format| self.formats.contains(format));
        formats.flat_map(|format| format.row().files).copied()
    }

    /// Tells whether a file of the formats has such a writer.
    pub(super) fn wants(&self, such: fn(&Writer) -> bool) -> bool {
        self.files().any(|(_, writer)| such(&writer))
    }

    /// Gives about how many bytes a point of a grid takes in the files of all formats together.
    pub(super) fn bytes_a_point(&self) -> f64 {
        self.formats.iter().map(|format| format.row().bytes_a_point).sum()
    }
}

/// What files say of the scene that they come from; nothing is computed from it.
#[derive(Debug, Clone, PartialEq)]
pub struct Echo {
    /// Title of files and pictures.
    pub title: String,
    /// The scene as it was read.
    pub scene: serde_json::Value,
    /// SHA-256 of the scene, in hexadecimal.
    pub hash: String,
}

impl Case {
    /// Gives the same case with the file that the scene was read from, for the summary.
    #[must_use]
    pub fn read_from(self, path: &Path) -> Self {
        Self { file: path.canonicalize().ok(), ..self }
    }

    /// Gives the same case with its bodies elsewhere, under another echo. It shares the profiles and the search trees.
    #[must_use]
    pub fn at(&self, setup: Setup, echo: Echo) -> Self {
        Self { setup, echo, ..self.clone() }
    }

    /// Gives the same case as one of many: without the page of every run, unless the scene names that format.
    #[must_use]
    pub fn as_one_of_many(mut self) -> Self {
        if !self.outputs.required {
            self.outputs.formats.retain(|format| *format != OutputFormat::Html);
        }
        self
    }

    /// Gives the profiles of both sides.
    pub fn profiles(&self) -> &Profiles {
        &self.profiles
    }

    /// Gives the landmarks of its pairs, by which contacts are doubted.
    pub fn landmarks(&self) -> &SideLandmarks {
        &self.landmarks
    }

    /// Gives where the bodies stand.
    pub fn setup(&self) -> &Setup {
        &self.setup
    }

    /// Gives what is asked of every contact.
    pub fn question(&self) -> &Question {
        &self.question
    }

    /// Gives the axes of the grids.
    pub fn axes(&self) -> &AskedAxes {
        &self.axes
    }

    /// Gives what files say of the scene.
    pub fn echo(&self) -> &Echo {
        &self.echo
    }

    /// Lists what in the scene looks like a slip.
    pub fn doubts(&self) -> &[Doubt] {
        &self.doubts
    }

    /// Lists what a user should know of the scene and of its measured files.
    pub fn warnings(&self) -> Vec<String> {
        let mut out: Vec<String> = self.doubts.iter().map(Doubt::to_string).collect();
        for (side, profiles) in self.profiles.sides() {
            let findings = profiles.measured.both().into_iter().flatten().flat_map(|record| &record.warnings);
            let place = side.map_or_else(String::new, |side| format!("{side} side: "));
            if let Some(body) = &profiles.varying {
                let key = if body.side() == Side::Rail { "rail" } else { "wheel" };
                out.extend(body.warnings().iter().map(|warning| format!("{place}{key}: {warning}")));
            }
            out.extend(findings.map(|finding| format!("{place}{}: {}", finding.place, finding.found)));
        }
        out
    }

    /// Gives what was done to measured profiles of rail and wheel, of the right-hand side or both.
    pub fn measured(&self) -> &Bodies<Option<Record>> {
        &self.profiles.right.measured
    }
}

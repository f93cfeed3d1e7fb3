//! Hard cases: scenes at the edge of the method, each a file with its provenance, 60-digit values and status.
//!
//! `tests/hard_cases/generate.py` makes the files and explains their keys.

use serde::Deserialize;

use super::reference::{ReferenceFile, embedded, malformed};
use wheelrail::error::Result;
use wheelrail::patch::Window;
use wheelrail::placement::Placement;
use wheelrail::separation::{Choice, EtaAxis, FULL_PRECISION, Method, plan};

/// The methods that a case is run with, in the order of [`HardOutcome::errors`](super::hard_run::HardOutcome::errors).
pub const METHODS: [Method; 3] = [Method::Spectral, Method::Pointwise, Method::ReportNewton];

/// Numbers of columns between those of a case: none, and as many as make strips.
pub(super) const COLUMNS: [usize; 2] = [0, 200];

/// Whether the program is known to pass all checks of a case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Status {
    /// All checks pass.
    Holds,
    /// Some check fails, and the file says why. If all checks pass, this status is out of date.
    ExpectedFailure,
}

impl Status {
    /// Returns the name of the status in the files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::ExpectedFailure => "expected-failure",
        }
    }
}

/// The stated result of the Report's own iteration at the points of a case.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct Stated {
    /// Number of points where it has no value although both bodies have a surface, or the other way round.
    pub undefined: usize,
    /// Bound of its absolute error at the other points \[mm\].
    pub max_abs_error_mm: f64,
    /// Bound of its relative error at the other points, without C itself.
    pub max_rel_error: f64,
    /// Reason for these figures.
    pub remark: String,
}

/// An agreement that a case must have with another one.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct Relation {
    /// Name of the other case.
    pub to: String,
    /// Kind of agreement.
    pub kind: RelationKind,
}

/// The ways in which two cases can agree.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RelationKind {
    /// All lengths are multiplied by a power of four: the bits are the same after rescaling.
    Scaled,
    /// Mirrored, x → −x: the values are the same at −ξ, within rounding.
    Mirrored,
    /// The same surfaces are described in another way: the values are the same, within rounding.
    Same,
    /// Reversed, η → −η, inside one case: the bits are the same.
    EtaReversed,
}

/// The patch at one approach inside one window.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct StatedPatch {
    /// Approach δ \[mm\].
    pub delta: f64,
    /// The window in which the patch is searched for.
    pub window: Window,
    /// The components, by ascending ξ.
    pub components: Vec<StatedComponent>,
}

/// One component of a patch.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct StatedComponent {
    /// Range of ξ \[mm\], 25 digits.
    pub xi: [String; 2],
    /// What bounds the component at either end: "tip", "window" or "profile-end".
    pub ends: [String; 2],
    /// |∂s/∂ξ| at tips, 25 digits.
    pub slope: [Option<String>; 2],
    /// Whether the window cuts the component.
    pub cut_by_window: bool,
}

/// One hard case, as its file has it.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct HardCase {
    /// Title of the case.
    pub title: String,
    /// Origin of the case, and its subject.
    pub provenance: String,
    /// Whether the program passes all checks of the case.
    pub status: Status,
    /// Length \[mm\] by which absolute bounds are multiplied; 1 except for scaled cases.
    #[serde(default = "one")]
    pub unit: f64,
    /// Stated result of the Report's method.
    pub report_newton: Stated,
    /// Agreement with another case.
    #[serde(default)]
    pub relation: Option<Relation>,
    /// Scene and 60-digit values.
    #[serde(flatten)]
    pub reference: ReferenceFile,
    /// Patches of the scene.
    pub patches: Vec<StatedPatch>,
}

fn one() -> f64 {
    1.0
}

impl HardCase {
    /// Reads the text of a file.
    ///
    /// # Errors
    /// Text that is not in the format.
    pub fn read(name: &str, text: &str) -> Result<Self> {
        let mut case: Self = serde_json::from_str(text).map_err(|error| malformed(name, &error))?;
        case.reference.name = name.into();
        Ok(case)
    }

    /// Returns full precision with one method, with all lengths in the case's unit.
    pub(super) fn choice(&self, placement: &Placement, method: Method) -> Choice {
        let [xi, eta] = self.reference.scene.axes();
        let mut choice = plan(placement, &xi, &EtaAxis::new(&eta), FULL_PRECISION, Some(method)).choice;
        choice.demand.absolute *= self.unit;
        choice
    }
}

/// Names and texts of the files of the hard cases.
pub const FILES: &[(&str, &str)] = embedded!("hard_cases/":
    "within_one_nanometre_of_c", "conforming_to_1e-9", "radius_of_one_kilometre", "flange_at_70_degrees",
    "contact_on_a_joint", "contact_on_a_kink", "contact_at_a_profile_end", "curvature_jump_under_the_window",
    "columns_cross_one_joint", "columns_cross_two_joints", "rail_overhangs", "wheel_overhangs",
    "approach_zero", "approach_1e-9", "approach_beyond_the_window", "two_patches", "no_hole",
    "patch_cut_by_the_window", "wheel_radius_20_mm", "wheel_radius_100_m", "lengths_times_4_to_20",
    "lengths_times_4_to_minus_20", "mirrored", "arcs_split_in_two", "eta_reversed",
);

/// Reads all hard cases.
///
/// # Errors
/// A file that is not in the format.
pub fn hard_cases() -> Result<Vec<HardCase>> {
    FILES.iter().map(|(name, text)| HardCase::read(name, text)).collect()
}

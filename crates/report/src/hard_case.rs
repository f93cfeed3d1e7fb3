//! Hard cases: scenes at the edge of the method, each a file with its provenance, 60-digit values and status.
//!
//! The files are made by `tests/hard_cases/generate.py`, which also explains their keys.

use serde::Deserialize;

use super::reference::{Reference, embedded, malformed};
use wheelrail::error::Result;
use wheelrail::placement::Placement;
use wheelrail::separation::axis::EtaAxis;
use wheelrail::separation::grid::{Choice, Method};
use wheelrail::separation::plan::{FULL_PRECISION, plan};

/// The methods that a case is run with, in the order of [`Outcome::errors`](super::hard_run::Outcome::errors).
pub const METHODS: [Method; 3] = [Method::Spectral, Method::Pointwise, Method::ReportNewton];

/// Columns between those of a case: none, and as many as make strips.
pub(super) const COLUMNS: [usize; 2] = [0, 200];

/// Whether the program is known to master a case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Status {
    /// All checks pass.
    Holds,
    /// Some check fails, and the file says why. When all pass, the mark is out of date.
    ExpectedFailure,
}

impl Status {
    /// As in the files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::ExpectedFailure => "expected-failure",
        }
    }
}

/// What the Report's own iteration gives at the points of a case.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct Stated {
    /// Points where it has no value although both bodies have a surface, or the other way round.
    pub undefined: usize,
    /// Bound of its absolute error elsewhere \[mm\].
    pub max_abs_error_mm: f64,
    /// Bound of its relative error there, C itself left out.
    pub max_rel_error: f64,
    /// Why.
    pub remark: String,
}

/// How a case must agree with another one.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct Relation {
    /// Name of the other case.
    pub to: String,
    /// In which way.
    pub kind: RelationKind,
}

/// Ways in which two cases can agree.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RelationKind {
    /// All lengths times a power of four: the same bits after rescaling.
    Scaled,
    /// x → −x: the same values at −ξ, within rounding.
    Mirrored,
    /// The same surfaces described otherwise: the same values, within rounding.
    Same,
    /// η → −η inside one case: the same bits.
    EtaReversed,
}

/// The patch at one approach inside one window.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct StatedPatch {
    /// δ \[mm\].
    pub delta: f64,
    /// The window.
    pub window: StatedWindow,
    /// Parts by ascending ξ.
    pub components: Vec<StatedComponent>,
}

/// A rectangle of the contact frame.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
pub struct StatedWindow {
    /// Range of ξ \[mm\].
    pub xi: [f64; 2],
    /// Range of η \[mm\].
    pub eta: [f64; 2],
}

/// One part of a patch.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct StatedComponent {
    /// Extent in ξ \[mm\], 25 digits.
    pub xi: [String; 2],
    /// "tip", "window", "profile-end" or "fork".
    pub ends: [String; 2],
    /// |∂s/∂ξ| at tips, 25 digits.
    pub slope: [Option<String>; 2],
    /// Whether the window cuts it.
    pub cut_by_window: bool,
}

/// One file.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct HardCase {
    /// What it is.
    pub title: String,
    /// Where it comes from, and what it is about.
    pub provenance: String,
    /// Whether the program masters it.
    pub status: Status,
    /// Length \[mm\] that absolute bounds are multiplied by; 1 but for scaled cases.
    #[serde(default = "one")]
    pub unit: f64,
    /// What the Report's method gives.
    pub report_newton: Stated,
    /// Agreement with another case.
    #[serde(default)]
    pub relation: Option<Relation>,
    /// Scene and 60-digit values.
    #[serde(flatten)]
    pub reference: Reference,
    /// The patch.
    pub patches: Vec<StatedPatch>,
}

fn one() -> f64 {
    1.0
}

impl HardCase {
    /// Reads a file's text.
    ///
    /// # Errors
    /// Text that is not in the format.
    pub fn read(name: &str, text: &str) -> Result<Self> {
        let mut case: Self = serde_json::from_str(text).map_err(|error| malformed(name, &error))?;
        case.reference.name = name.into();
        Ok(case)
    }

    /// Full precision with one method, all lengths in the case's unit.
    pub(super) fn choice(&self, placement: &Placement, method: Method) -> Choice {
        let [xi, eta] = self.reference.scene.axes();
        let mut choice = plan(placement, &xi, &EtaAxis::new(&eta), FULL_PRECISION, Some(method)).choice;
        choice.demand.absolute *= self.unit;
        choice
    }
}

/// The hard cases.
pub const FILES: &[(&str, &str)] = embedded!("../../../tests/hard_cases/":
    "within_one_nanometre_of_c", "conforming_to_1e-9", "radius_of_one_kilometre", "flange_at_70_degrees",
    "contact_on_a_joint", "contact_on_a_kink", "contact_at_a_profile_end", "curvature_jump_under_the_window",
    "columns_cross_one_joint", "columns_cross_two_joints", "rail_overhangs", "wheel_overhangs",
    "approach_zero", "approach_1e-9", "approach_beyond_the_window", "two_patches", "no_hole",
    "patch_cut_by_the_window", "wheel_radius_20_mm", "wheel_radius_100_m", "lengths_times_4_to_20",
    "lengths_times_4_to_minus_20", "mirrored", "arcs_split_in_two", "eta_reversed",
);

/// All hard cases.
///
/// # Errors
/// A file that is not in the format.
pub fn hard_cases() -> Result<Vec<HardCase>> {
    FILES.iter().map(|(name, text)| HardCase::read(name, text)).collect()
}

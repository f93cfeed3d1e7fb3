//! Units of length in files.

use serde::{Deserialize, Serialize};

/// A unit of length.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "files", derive(schemars::JsonSchema))]
pub enum Unit {
    /// Metres.
    #[serde(rename = "m")]
    Metre,
    /// Centimetres.
    #[serde(rename = "cm")]
    Centimetre,
    /// Millimetres.
    #[serde(rename = "mm")]
    Millimetre,
    /// Micrometres.
    #[serde(rename = "um")]
    Micrometre,
    /// Inches of 25.4 mm.
    #[serde(rename = "in")]
    Inch,
    /// Feet of 304.8 mm.
    #[serde(rename = "ft")]
    Foot,
}

impl Unit {
    /// All units.
    pub const ALL: [Self; 6] =
        [Self::Metre, Self::Centimetre, Self::Millimetre, Self::Micrometre, Self::Inch, Self::Foot];

    /// Returns the unit with this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|unit| unit.name() == name)
    }

    /// Returns the name of the unit.
    pub fn name(self) -> &'static str {
        match self {
            Self::Metre => "m",
            Self::Centimetre => "cm",
            Self::Millimetre => "mm",
            Self::Micrometre => "um",
            Self::Inch => "in",
            Self::Foot => "ft",
        }
    }

    /// Returns the length of the unit \[mm\].
    pub fn millimetres(self) -> f64 {
        match self {
            Self::Metre => 1e3,
            Self::Centimetre => 10.0,
            Self::Millimetre => 1.0,
            Self::Micrometre => 1e-3,
            Self::Inch => 25.4,
            Self::Foot => 304.8,
        }
    }
}

//! The page of measured profiles: it walks through them, each over its nominal one, with measures and findings.

use serde::Serialize;

use super::document::document;
use super::numbers::floats;

/// The bundled script; its sources are in `source/measure.js` and the files that this imports.
const SCRIPT: &str = include_str!("measure.js");

/// A measured profile.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MeasuredPage {
    /// Name of the file.
    pub name: String,
    /// Points of the nominal, x, z in turn \[mm\]; empty without one.
    #[serde(serialize_with = "floats")]
    pub nominal: Vec<f64>,
    /// Points of the measured curve in the axes of the nominal, x, z in turn \[mm\]; empty for a file that cannot be read.
    #[serde(serialize_with = "floats")]
    pub measured: Vec<f64>,
    /// Points of the nominal, each with the point of the measured curve on its normal: x, z, x, z in turn \[mm\].
    #[serde(serialize_with = "floats")]
    pub differences: Vec<f64>,
    /// How it was aligned.
    pub alignment: String,
    /// Name of a quantity, value with unit, its change if the alignment is off, the interval of its spread; empty where there is none.
    pub measures: Vec<[String; 4]>,
    /// The limits that the profile exceeds.
    pub broken: Vec<String>,
    /// What cannot be measured and why, and what is doubtful.
    pub findings: Vec<String>,
}

/// The page of measured profiles.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MeasuresPage {
    /// Title.
    pub title: String,
    /// A line below the title.
    pub about: String,
    /// Version of this program.
    pub version: String,
    /// The profiles.
    pub files: Vec<MeasuredPage>,
}

impl MeasuresPage {
    /// Returns the page as HTML. Its size is that of script and style, some 20 kB, and some 15 kB for each file.
    pub fn html(&self) -> Vec<u8> {
        document(&self.title, self, SCRIPT)
    }
}

//! The page of a fleet: distributions, where the wheels touch the rail, the worst pairs and the findings.

use serde::Serialize;

use super::document::document;
use super::numbers::floats;
use super::view::PageProfile;

/// The bundled script; its sources are in `source/fleet.js` and the files that this imports.
const SCRIPT: &str = include_str!("fleet.js");

/// The distribution of a quantity.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FleetDistribution {
    /// Heading.
    pub title: String,
    /// Name of the axis, with its unit.
    pub axis: String,
    /// Lower end of the first bar.
    pub from: f64,
    /// Width of a bar.
    pub width: f64,
    /// Number of values in each bar.
    pub counts: Vec<u32>,
    /// Quantiles in words.
    pub told: String,
}

/// The share of the wheels that touch each cell of the rail at each displacement.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FleetHeat {
    /// Abscissa \[mm\] of the first cell's edge, in the axes of the rail's profile.
    pub from: f64,
    /// Width of a cell \[mm\].
    pub width: f64,
    /// Number of cells.
    pub cells: usize,
    /// First displacement towards the wheel's own rail \[mm\].
    pub first: f64,
    /// Step of the displacements \[mm\].
    pub step: f64,
    /// Shares \[%\], displacement by displacement.
    #[serde(serialize_with = "floats")]
    pub shares: Vec<f64>,
    /// A rail to draw below it.
    pub rail: Option<PageProfile>,
}

/// A pair among the worst.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FleetWorst {
    /// Cells of its row, as many as the page's `columns`.
    pub cells: Vec<String>,
    /// Its own page, relative to this one.
    pub page: String,
}

/// The page of a fleet.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FleetPage {
    /// Title.
    pub title: String,
    /// A line below the title.
    pub about: String,
    /// Version of this program.
    pub version: String,
    /// The distributions.
    pub distributions: Vec<FleetDistribution>,
    /// Where the wheels touch; `None` if none does.
    pub heat: Option<FleetHeat>,
    /// Names of the cells of `worst`.
    pub columns: Vec<String>,
    /// The pairs with the largest conicity.
    pub worst: Vec<FleetWorst>,
    /// Wheelset, rails and finding of the first pairs that have a finding.
    pub findings: Vec<[String; 3]>,
    /// Number of pairs that have a finding.
    pub with_finding: usize,
}

impl FleetPage {
    /// Returns the page as HTML. Its size is that of script and style, some 20 kB, and of the heat map, some 30 kB.
    pub fn html(&self) -> Vec<u8> {
        document(&self.title, self, SCRIPT)
    }
}

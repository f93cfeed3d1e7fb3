//! The page of a sweep or a march: curves over its positions, and the pair of profiles at the position under the pointer.

use serde::Serialize;

use super::document::document;
use super::numbers::floats;
use super::view::PagePair;
use crate::numerics::interval::Interval;

/// The bundled script; its sources are in `source/sweep.js` and the files that this imports.
const SCRIPT: &str = include_str!("sweep.js");

/// One curve, with a value for every position.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SweepCurve {
    /// Name in the legend; empty for the only curve of a panel.
    pub name: String,
    /// Values; NaN where there is none.
    #[serde(serialize_with = "floats")]
    pub values: Vec<f64>,
    /// Indices of positions after which the contact jumps: no line connects them with the next one.
    pub jumps: Vec<usize>,
}

/// The curves of one quantity.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SweepPanel {
    /// Heading of the panel.
    pub title: String,
    /// Name of the axis, with its unit.
    pub axis: String,
    /// The curves.
    pub curves: Vec<SweepCurve>,
    /// Smallest and largest value that is shown; `None` shows all.
    pub shown: Option<Interval>,
}

/// A section in pieces.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PageCut(
    /// x, z \[mm\] of every point in turn; NaN between two pieces.
    #[serde(serialize_with = "floats")]
    pub Vec<f64>,
);

/// Rail and wheel of one side at all positions, in the axes of the rail's profile: x to the field side.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SweepSide {
    /// Whether this is the right-hand side.
    pub right: bool,
    /// Index of its profiles in the page's pairs.
    pub pair: usize,
    /// The rail profile's origin \[mm\]: distance from the middle of the track, and height over the top of rail.
    pub rail: [f64; 2],
    /// Of every position in turn x, z \[mm\] and angle \[rad\], counter-clockwise, of the wheel profile's axes, the wheel's yaw \[rad\]
    /// (the field side is ahead where it is positive), and how far ahead of the wheel profile's origin the section lies \[mm\]; NaN where
    /// the wheel touches nothing.
    #[serde(serialize_with = "floats")]
    pub places: Vec<f64>,
    /// The rail's section at every position; empty for a rail of one profile.
    pub rails: Vec<PageCut>,
    /// The profile of the wheel of revolution that has the wheel's section, at every position; empty for a wheel of one profile.
    pub wheels: Vec<PageCut>,
    /// Index of the position of every contact.
    pub position: Vec<usize>,
    /// Abscissa \[mm\] of every contact on the rail's profile.
    #[serde(serialize_with = "floats")]
    pub rail_x: Vec<f64>,
    /// Abscissa \[mm\] of every contact on the wheel's profile.
    #[serde(serialize_with = "floats")]
    pub wheel_x: Vec<f64>,
    /// Contact angle \[rad\] of every contact.
    #[serde(serialize_with = "floats")]
    pub angle: Vec<f64>,
    /// Vertical gap \[mm\] of every contact at first touch.
    #[serde(serialize_with = "floats")]
    pub gap: Vec<f64>,
    /// Normal force of the region of every contact \[N\], NaN where it has none of its own; empty where none is known.
    #[serde(serialize_with = "floats")]
    pub load: Vec<f64>,
}

/// What happens between two positions.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PageEvent {
    /// Where, on the axis of the curves.
    pub at: f64,
    /// Texts in the columns of the list, the place first.
    pub cells: Vec<String>,
}

/// The list of events.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct PageEvents {
    /// Names of the columns, the place first.
    pub columns: Vec<String>,
    /// The events that are listed.
    pub rows: Vec<PageEvent>,
    /// Number of further events, which are not listed.
    pub more: usize,
}

/// A number with its meaning.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PageFigure {
    /// Its name, as tables have it.
    pub name: String,
    /// The number in words.
    pub value: String,
    /// What it is.
    pub meaning: String,
}

/// A quantity over gauges and amplitudes.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PageMap {
    /// Heading.
    pub title: String,
    /// Name of the axis across, with its unit.
    pub across: String,
    /// Name of the axis up, with its unit.
    pub up: String,
    /// Values across, ascending.
    #[serde(serialize_with = "floats")]
    pub gauges: Vec<f64>,
    /// Values up, ascending.
    #[serde(serialize_with = "floats")]
    pub amplitudes: Vec<f64>,
    /// The quantity at `i_gauge * n_amplitudes + i_amplitude`; NaN where there is none.
    #[serde(serialize_with = "floats")]
    pub values: Vec<f64>,
}

/// The page of a sweep or a march.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SweepPage {
    /// Title.
    pub title: String,
    /// A line below the title.
    pub about: String,
    /// Version of this program.
    pub version: String,
    /// Name of the abscissa, with its unit.
    pub abscissa: String,
    /// The positions on it, ascending.
    #[serde(serialize_with = "floats")]
    pub positions: Vec<f64>,
    /// The panels of curves.
    pub panels: Vec<SweepPanel>,
    /// The profiles of the sides.
    pub pairs: Vec<PagePair>,
    /// Left and right side.
    pub sides: Vec<SweepSide>,
    /// What happens between the positions; none of a sweep.
    pub events: PageEvents,
    /// Key figures; none of a plain sweep.
    pub figures: Vec<PageFigure>,
    /// The conicity over gauge and amplitude; `None` of a plain sweep.
    pub map: Option<PageMap>,
    /// What a reader should know before using the numbers.
    pub findings: Vec<String>,
    /// Statements about the page, below it.
    pub notes: Vec<String>,
}

impl SweepPage {
    /// Returns the page as HTML. Its size is that of script and style, some 30 kB, and 16/3 bytes for every number of an array.
    pub fn html(&self) -> Vec<u8> {
        document(&self.title, self, SCRIPT)
    }
}

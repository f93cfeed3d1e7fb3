//! Draws pictures as SVG: of a patch, of a sweep, of a profile, and the charts of the report. All use one
//! kind of page and one kind of panel.

pub mod chart;
mod contour;
pub mod curves;
mod levels;
mod page;
mod panel;
mod patch;
pub mod profile;

pub use contour::Nodes;
pub use patch::Picture;

/// Separator between the parts of a line of words: SVG readers show several blanks as one.
pub const SEPARATOR: &str = " · ";

/// Returns the line at the foot of pictures that belong to no scene.
fn foot() -> String {
    format!("wheelrail {}", env!("CARGO_PKG_VERSION"))
}

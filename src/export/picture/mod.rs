//! Pictures as SVG: of a patch, of a sweep, of a profile, and the charts of the report. All are drawn with one page and one
//! kind of panel.

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

/// Stands between the parts of a line of words; of several blanks readers of SVG show one.
pub const SEPARATOR: &str = " · ";

/// The line at the foot of pictures that belong to no scene.
fn foot() -> String {
    format!("wheelrail {}", env!("CARGO_PKG_VERSION"))
}

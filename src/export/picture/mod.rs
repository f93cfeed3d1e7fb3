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
pub use page::SEPARATOR;
pub use patch::Picture;

//! Draws pictures as SVG: of a patch, of the gap over the rail's surface, of a sweep, of a profile, of a measured profile over its
//! nominal one, of an average, and the charts of the report. All use one kind of page and one kind of panel.

mod band;
mod chart;
mod conformal;
mod contact;
mod contour;
mod curves;
mod levels;
mod map;
mod overlay;
mod page;
mod panel;
mod patch;
mod profile;

pub use band::{BandPicture, BandPoint};
pub use chart::{Chart, Series};
pub use conformal::{ConformalPicture, RailNormal};
pub use contact::PicturedContact;
pub use contour::Nodes;
pub use curves::{CurvesMap, CurvesPanel, CurvesPicture, JoinedPair, PlottedCurve, jumps};
pub use map::TrueContact;
pub use overlay::OverlayPicture;
pub use page::SEPARATOR;
pub use patch::PatchPicture;
pub use profile::ProfilePicture;

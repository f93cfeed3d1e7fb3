//! Measures profiles: flange height and thickness of wheels, wear of rails, against a nominal profile or alone.
//!
//! Definitions and sources are in [`docs::measures`](crate::docs::measures). Everything is measured on the curve of a profile; for a
//! file, this is the curve that was fitted to its points.

mod align;
mod average;
mod better;
mod curve;
mod fit;
mod found;
mod limits;
mod measures;
mod measuring;
mod noise;
mod nominal;
mod options;
mod overlay;
mod quantity;
mod rail;
mod repeats;
mod rows;
mod smooth;
mod wheel;

pub use align::Alignment;
pub use average::{Average, AveragePoint, average};
pub use limits::{Limit, Limits};
pub use measures::Measures;
pub use measuring::measure;
pub use noise::{PointNoise, measure_noisy};
#[cfg(feature = "files")]
pub(crate) use nominal::flange_back;
pub use options::{Align, GaugeFrom, MeasureOptions};
pub use overlay::{Overlay, overlay};
pub use quantity::Quantity;
#[cfg(feature = "files")]
pub(crate) use quantity::in_micrometres;
pub use repeats::repeated;
pub use rows::{MeasureRow, RowColumns, csv, json, table};

//! INTERPEN (Report Sec. 7): finds the curve s(ξ, η) = δ and the patch inside it.

mod band;
mod by_roots;
mod by_samples;
mod components;
mod corners;
mod divided;
mod edges;
mod grading;
pub(crate) mod in_valleys;
mod level;
mod loops;
mod measure;
mod outline;
mod plain;
mod raised;
mod slice;
mod stretch;
pub(crate) mod turning_points;
mod window;

pub(crate) use band::{Band, BandPlaces};
pub(crate) use by_samples::BySamples;
pub use components::{Component, Patch};
pub(crate) use loops::{BandSide, rings};
pub use outline::{End, Outline};
pub(crate) use plain::least_on_roller;
pub use slice::{Slice, Slicer};
pub(crate) use turning_points::turning_points;
pub use window::Window;

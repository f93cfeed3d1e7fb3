//! INTERPEN (Report Sec. 7): finds the curve s(ξ, η) = δ and the patch inside it.
//!
//! A patch is where one function of the plane is negative: G = s − δ, or over a rail's own surface the wheel's height over the raised point.
//! Of swept bodies `lines` knows G, its slopes, and bounds of both over any box, and finds from them the ranges of ξ whose lines meet the
//! patch, each in one slice. Where it cannot prove that a line of a rail has one slice, slices are found from valleys (`in_valleys`); those of
//! bodies that vary are found from samples (`by_samples`). The edges over a range of ξ are interpolated between corners (`stretch`), 16 of
//! them at once where each lies over one piece (`edges`). Bands that overlap are components, which `loops` goes around.

mod band;
mod by_samples;
mod components;
mod corners;
mod divided;
mod edges;
mod end;
mod grading;
pub(crate) mod in_valleys;
mod level;
mod lines;
mod loops;
mod measure;
mod outline;
mod raised;
mod slice;
mod stretch;
pub(crate) mod turning_points;
mod window;

pub(crate) use band::{Band, BandPlaces};
pub(crate) use by_samples::BySamples;
pub use components::{Component, Patch};
pub use end::End;
pub(crate) use lines::bands::least_on_roller;
pub(crate) use loops::{BandSide, rings};
pub use outline::Outline;
pub use slice::{Slice, Slicer};
pub(crate) use turning_points::turning_points;
pub use window::Window;

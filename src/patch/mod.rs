//! INTERPEN (Report Sec. 7): finds the curve s(ξ, η) = δ and the patch inside it.
//!
//! A patch is where one function of the plane is negative: G = s − δ, or over a rail's own surface the wheel's height over the raised point.
//! Of swept bodies `lines` knows G, its slopes, and bounds of both over any box, and halves ranges of ξ until these prove that no line of a
//! range meets the patch, or each in one slice at most. Over what is left single lines are solved by the same bounds, and boxes prove that their
//! slices go on from one to the next; bodies that vary, and the surface of a roller where its lines may have several slices, are sampled (`fibres`).
//! The edges over a range of ξ are interpolated between corners (`stretch`), 16 of them at once where each lies over one piece (`edges`).
//! Bands that overlap are components, which `loops` goes around.

mod band;
mod components;
mod corners;
mod divided;
mod edges;
mod end;
mod fibres;
mod grading;
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
pub use components::{Component, Patch};
pub use end::End;
pub(crate) use lines::bands::least_separation;
pub(crate) use loops::{BandSide, rings};
pub use outline::Outline;
pub use slice::{Slice, Slicer};
pub(crate) use turning_points::turning_points;
pub use window::Window;

//! INTERPEN (Report Sec. 7): the curve s(ξ, η) = δ and the patch it bounds.

mod components;
mod corners;
mod lanes;
pub mod load;
pub(crate) mod measure;
mod outline;
mod profile_path;
mod skewed;
mod slice;
mod valleys;

pub use components::{BoundingBox, Component, Patch};
pub use outline::{End, Outline, Window};
pub use slice::{Slice, Slicer};

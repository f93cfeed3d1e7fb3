//! INTERPEN (Report Sec. 7): the curve s(ξ, η) = δ and the patch it bounds.

mod components;
mod corners;
pub mod load;
pub(crate) mod measure;
mod outline;
mod slice;

pub use components::{BoundingBox, Component, Patch};
pub use outline::{End, Outline, Window};
pub use slice::{Slice, Slicer};

//! INTERPEN (Report Sec. 7): the curve s(ξ, η) = δ and the patch it bounds.

mod band;
mod components;
mod corners;
mod events;
mod grading;
mod lanes;
pub mod load;
mod loops;
mod measure;
mod outline;
mod plain;
mod skewed;
mod slice;

pub(crate) use band::Band;
pub use components::{Component, Patch};
pub use outline::{End, Outline, Window};
pub use slice::{Slice, Slicer};

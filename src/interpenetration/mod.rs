//! INTERPEN (Report Sec. 7): the curve s(ξ, η) = δ and the patch it bounds.

mod components;
pub mod load;
mod slice;

pub use components::{Component, End, Patch, Window};
pub use slice::{Slice, Slicer};

//! The patch under a skewed wheel on a rail. A line of constant ξ may meet it in several intervals; each is found from a valley.

pub(super) mod circle;
pub(super) mod events;
pub(super) mod lanes;
pub(crate) mod monotone;
mod path;
pub(super) mod slicer;
pub(crate) mod valleys;

//! The patch on a rail under a skewed wheel, beyond the end of a tilted one, and over the rail's own surface. A line of constant ξ or σ may
//! meet it in several intervals; each is found from a valley.

pub(super) mod circle;
pub(super) mod events;
pub(super) mod lanes;
pub(crate) mod monotone;
mod path;
pub(super) mod slicer;
pub(crate) mod valleys;

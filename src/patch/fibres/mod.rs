//! Single lines of constant ξ or σ with all their slices, and what joins the slices of neighbouring lines to bands.
//!
//! Of swept bodies a line's slices are proved, and so is that those of two lines answer one to one on all lines between (`lines`); where
//! that is not proved another line is laid between. Where a body varies, both are judged from samples (`sampled`).

mod bands;
mod sampled;
mod slices;

pub(super) use bands::{LaneEnd, bands, joined};
pub(super) use sampled::BySamples;
pub(super) use slices::{Lane, LaneRow, LineSlice, SlicedLine, refined};

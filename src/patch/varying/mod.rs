//! The patch where a body varies: a rail along the track, or a wheel around its axle.

mod bands;
mod lines;

pub(super) use bands::bands;
pub(super) use lines::{SMOOTH, Varying};

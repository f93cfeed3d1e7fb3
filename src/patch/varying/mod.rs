//! The patch on a rail that varies along the track.

mod bands;
mod lines;

pub(super) use bands::bands;
pub(super) use lines::{SMOOTH, Varying};

//! Solver meshes over the patch, surfaces around it, and how good they are.

pub mod axes;
mod lines;
pub mod quality;
pub mod strips;
pub mod surfaces;
mod trace;

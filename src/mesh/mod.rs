//! Solver meshes over the patch.

pub mod axes;

//! Writers: they take plain arrays and give bytes. Nothing here computes geometry or touches the disk.
//!
//! Large files (grids) are written to any [`std::io::Write`] in one pass and in blocks, so that a grid is
//! never held twice; small files are returned as bytes. Every file is in the contact frame of Report Sec. 4,
//! in mm. [`Header::statements`] is the one place that describes frame, signs, order and mask in words.

mod block;
pub mod csv;
pub mod deck;
pub mod legacy;
mod model;
pub mod netcdf;
pub mod npy;
pub mod picture;
pub mod vtk;
pub mod vts;

pub use model::{Frame, GridFields, Header, Interval, Loop, QuadMesh, SurfaceMesh};

/// The ParaView script that opens its own folder: coloured separation, the boundary, gap vectors.
pub const VIEW_SCRIPT: &str = include_str!("view.py");

#[cfg(test)]
mod sample;

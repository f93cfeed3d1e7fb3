//! Writers: plain arrays in, bytes out. Nothing here computes geometry or touches the disk.
//!
//! Large files (grids) are written to any [`std::io::Write`] in one pass and in blocks, so that a grid is never
//! held twice; small ones are returned as bytes. Every file is in the contact frame of Report Sec. 4 in mm;
//! [`Header::statements`] is the one place where frame, signs, order and mask are put into words.

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

/// The ParaView script that opens the folder it lies in: separation coloured, boundary overlaid, gap vectors.
pub const VIEW_SCRIPT: &str = include_str!("view.py");

#[cfg(test)]
mod sample;

//! Writers: plain arrays in, bytes out. Nothing here computes geometry, and only [`folder`] and [`write_file`] touch the disk.
//!
//! Large files (grids) are written to any [`std::io::Write`] in one pass and in blocks, so that a grid is never
//! held twice; small ones are returned as bytes. Every file is in the contact frame of Report Sec. 4 in mm;
//! [`Header::statements`] is the one place where frame, signs, order and mask are put into words.

mod block;
pub mod csv;
pub mod deck;
mod file;
pub mod folder;
pub mod legacy;
mod model;
pub mod netcdf;
pub mod npy;
pub mod picture;
mod temporary;
pub mod vtk;
pub mod vts;

pub use file::{behind_links, write_file};
pub use folder::{Folder, FolderPart, Names};
pub use model::{Frame, GridFields, Header, Interval, Loop, QuadMesh, SurfaceMesh};

/// The ParaView script that opens the folder it lies in: separation coloured, boundary overlaid, gap vectors.
pub const VIEW_SCRIPT: &str = include_str!("view.py");

/// By what a folder of `wheelrail run` is known, and all that one may contain.
pub const RUN_FOLDER: Names = Names {
    marker: "summary.json",
    files: &[
        "summary.json",
        "xi.npy",
        "eta.npy",
        "separation.npy",
        "boundary.csv",
        "interpen.csv",
        "midsep.txt",
        "separation.vts",
        "rail.vts",
        "wheel.vts",
        "boundary.vtp",
        "patch.vtu",
        "rail.vtu",
        "wheel.vtu",
        "separation.vtk",
        "surface.pvd",
        "patch.svg",
        "patch.png",
        "separation.nc",
        "separation.wrp",
        "conform.wrp",
        "countact.wrp",
        "contact.inp",
        "view.py",
        // Left by a Python that imports or compiles view.py.
        "__pycache__",
    ],
    is_part: |name| {
        let words = ["left", "right", "single", "contact", "patch"];
        name.split('-').all(|word| words.contains(&word) || word.parse::<u32>().is_ok())
    },
};

/// The same of `wheelrail sweep --patches`.
pub const PATCHES_FOLDER: Names = Names { is_part: |name| name.starts_with("position-"), ..RUN_FOLDER };

#[cfg(test)]
mod sample;

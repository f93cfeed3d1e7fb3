//! Writers: they take plain arrays and give bytes. Nothing here computes the geometry of bodies or touches the disk.
//!
//! Large files (grids) are written to any [`std::io::Write`] in one pass and in blocks, without a second copy of the grid; only
//! [`Deck`] holds its numbers as text, too. Small files are returned as bytes. Files of one contact are in the contact frame of
//! Report Sec. 4, in mm, and [`Header::statements`] describes frame, signs, order and mask in words; files of [`InPlace`] are in the
//! axes of the track.

mod abaqus;
mod block;
mod csv;
mod curved;
mod deck;
mod gmsh;
mod html;
mod in_place;
mod legacy;
mod model;
mod netcdf;
mod npy;
mod picture;
mod ply;
mod stl;
mod vtk;
mod vts;

pub use abaqus::patch_inp;
pub use csv::{boundary_csv, interpen_csv, interpen_sigma_csv, table_csv};
pub use curved::CurvedFields;
pub use deck::{
    ContactSettings, CurvedDeck, Deck, Prescribed, conform_curved_wrp, conform_wrp, contact_curved_inp,
    contact_inp, countact_wrp, separation_wrp, table_wrp,
};
pub use gmsh::patch_msh;
pub use html::{
    FleetDistribution, FleetHeat, FleetPage, FleetWorst, MeasuredPage, MeasuresPage, PageConformal, PageCut,
    PageEvent, PageEvents, PageFigure, PageFrame, PageLoop, PageMap, PagePair, PagePressure, PageProfile,
    SweepCurve, SweepPage, SweepPanel, SweepSide, ViewContact, ViewPage,
};
pub use in_place::{ContactInPlace, InPlace};
pub use legacy::separation_vtk;
pub use model::{Frame, GridFields, Header, Loop, PatchMesh, PatchRow, QuadMesh, SurfaceMesh, even_step};
pub use netcdf::{NetCdf, table_nc};
pub use npy::array_npy;
pub use picture::{
    BandPicture, BandPoint, Chart, ConformalPicture, CurvesMap, CurvesPanel, CurvesPicture, JoinedPair,
    Nodes, OverlayPicture, PatchPicture, PicturedContact, PlottedCurve, ProfilePicture, RailNormal,
    SEPARATOR, Series, TrueContact, jumps,
};
pub use ply::surface_ply;
pub use stl::surface_stl;
pub use vtk::{boundary_vtp, collection_pvd, patch_vtu, strips_vtu, surface_vtp, surface_vtu};
pub use vts::{conformal_vts, rail_vts, separation_vts, wheel_vts};

/// The ParaView script that opens its own folder: coloured separation, the boundary, gap vectors.
pub const VIEW_SCRIPT: &str = include_str!("view.py");

#[cfg(test)]
mod sample;

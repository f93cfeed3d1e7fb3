//! The output formats: a row each, with its files, what each is written from, and the writer.
//!
//! A new format is a writer in the room `export`, a row here, and a check in the tests of the clients. The names of a run's
//! files, the formats that a scene may name, those that have no form over the rail's surface, and the size of a run's folder are
//! read off the rows; a test holds output/README.md against them.

use std::io::{self, Write};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::Result;
use crate::export::{
    ContactSettings, CurvedDeck, CurvedFields, Deck, GridFields, Header, InPlace, Loop, PatchMesh, QuadMesh,
    SurfaceMesh, VIEW_SCRIPT, array_npy, boundary_vtp, conform_curved_wrp, conform_wrp, conformal_vts,
    contact_curved_inp, contact_inp, countact_wrp, patch_inp, patch_msh, patch_vtu, rail_vts, separation_vtk,
    separation_vts, separation_wrp, strips_vtu, surface_ply, surface_stl, surface_vtp, surface_vtu,
    wheel_vts,
};
use crate::files::Names;

/// What a file is written from, with the writer that takes it. A file is left out where that is not there.
#[derive(Clone, Copy)]
pub(super) enum Writer {
    /// s over the grid, and the rail below it.
    Grid(fn(&mut dyn Write, &Header, &GridFields<'_>) -> io::Result<()>),
    /// The pressures over the grid, where they are asked for.
    Pressure(fn(&mut dyn Write, &GridFields<'_>, &[f64]) -> io::Result<()>),
    /// t over the rail's surface.
    Curved(fn(&mut dyn Write, &Header, &CurvedFields<'_>) -> io::Result<()>),
    /// s over equal steps in the plane, as NetCDF.
    NetCdf,
    /// s over equal steps in the plane, as text.
    Deck(fn(&Deck<'_>, &mut dyn Write) -> io::Result<()>),
    /// s over equal steps in the plane and the strips of the patch, as text.
    StripsDeck(fn(&Deck<'_>, &QuadMesh, &mut dyn Write) -> io::Result<()>),
    /// s over equal steps in the plane and an approach or a load, as text.
    PressedDeck(fn(&Deck<'_>, &ContactSettings, &mut dyn Write) -> io::Result<()>),
    /// t over equal steps of the rail's surface, as text.
    CurvedDeck(fn(&CurvedDeck<'_>, &mut dyn Write) -> io::Result<()>),
    /// t over equal steps of the rail's surface and an approach or a load, as text.
    PressedCurvedDeck(fn(&CurvedDeck<'_>, &ContactSettings, &mut dyn Write) -> io::Result<()>),
    /// The boundary of the patch.
    Loops(fn(&Header, &[Loop]) -> Result<Vec<u8>>),
    /// The strips of the patch.
    Strips(fn(&Header, &QuadMesh) -> Result<Vec<u8>>),
    /// The triangles of the patch.
    Triangles(fn(&Header, &PatchMesh) -> Result<Vec<u8>>),
    /// A triangulated surface.
    Surface(SurfaceOf, fn(&Header, &SurfaceMesh) -> Result<Vec<u8>>),
    /// All contacts in the axes of the track; written once for a run.
    InPlace(fn(&InPlace) -> Result<Vec<u8>>),
    /// The page of all contacts; written once for a run.
    Page,
    /// The picture over the plane, in pixels.
    Picture,
    /// The picture over the rail's surface, in pixels.
    CurvedPicture,
    /// The same text for all runs.
    Text(&'static str),
}

/// What a surface is of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum SurfaceOf {
    /// The patch, on the rail.
    Patch,
    /// The rail around the patch.
    Rail,
    /// The wheel around the patch.
    Wheel,
}

impl Writer {
    /// Tells whether the file is a text over equal steps in the plane.
    pub(super) fn is_deck(&self) -> bool {
        matches!(self, Self::Deck(_) | Self::StripsDeck(_) | Self::PressedDeck(_))
    }

    /// Tells whether the file is a text over equal steps of the rail's surface.
    pub(super) fn is_curved_deck(&self) -> bool {
        matches!(self, Self::CurvedDeck(_) | Self::PressedCurvedDeck(_))
    }

    /// Tells whether the file is NetCDF.
    pub(super) fn is_netcdf(&self) -> bool {
        matches!(self, Self::NetCdf)
    }

    /// Tells whether the file shows all of a run in the axes of the track.
    pub(super) fn is_in_place(&self) -> bool {
        matches!(self, Self::InPlace(_))
    }

    /// Tells whether the file is a picture in pixels.
    pub(super) fn is_picture(&self) -> bool {
        matches!(self, Self::Picture | Self::CurvedPicture)
    }
}

/// One file of a format: its name and its writer.
pub(super) type FormatFile = (&'static str, Writer);

/// The row of a format.
pub(super) struct FormatRow {
    /// Whether it is written where the scene names no formats.
    pub unasked: bool,
    /// About how many bytes a point of a grid takes in its files.
    pub bytes_a_point: f64,
    /// Its files. One name with two writers is a file over the plane or over the rail's surface.
    pub files: &'static [FormatFile],
}

/// Makes the row of a format that is written where the scene names no formats.
const fn unasked(bytes_a_point: f64, files: &'static [FormatFile]) -> FormatRow {
    FormatRow { unasked: true, bytes_a_point, files }
}

/// Makes the row of a format that is written where the scene names it.
const fn named(bytes_a_point: f64, files: &'static [FormatFile]) -> FormatRow {
    FormatRow { unasked: false, bytes_a_point, files }
}

/// Makes an enum of formats of their rows: a text for the schema, the name, and the row.
macro_rules! formats {
    ($(#[$of_all:meta])* pub enum $format:ident { $($(#[$text:meta])+ $name:ident = $row:expr,)+ }) => {
        $(#[$of_all])*
        pub enum $format {
            $($(#[$text])+ $name,)+
        }

        impl $format {
            /// All formats.
            pub const ALL: &'static [Self] = &[$(Self::$name,)+];

            /// Gives the row of the format.
            pub(super) fn row(self) -> &'static FormatRow {
                match self {
                    $(Self::$name => const { &$row },)+
                }
            }
        }
    };
}

formats! {
    /// One output format.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
    #[serde(rename_all = "lowercase")]
    pub enum OutputFormat {
        /// .vts, .vtp, .vtu, .vtk, .vtm and view.py.
        Vtk = unasked(190.0, &[
            ("separation.vts", Writer::Grid(separation_vts)),
            ("rail.vts", Writer::Grid(rail_vts)),
            ("wheel.vts", Writer::Grid(wheel_vts)),
            ("separation.vtk", Writer::Grid(separation_vtk)),
            ("conformal.vts", Writer::Curved(conformal_vts)),
            ("boundary.vtp", Writer::Loops(boundary_vtp)),
            ("strips.vtu", Writer::Strips(strips_vtu)),
            ("patch.vtu", Writer::Triangles(patch_vtu)),
            ("rail.vtu", Writer::Surface(SurfaceOf::Rail, surface_vtu)),
            ("wheel.vtu", Writer::Surface(SurfaceOf::Wheel, surface_vtu)),
            ("rails.vtp", Writer::InPlace(InPlace::rails_vtp)),
            ("wheels.vtp", Writer::InPlace(InPlace::wheels_vtp)),
            ("patches.vtp", Writer::InPlace(InPlace::patches_vtp)),
            ("boundaries.vtp", Writer::InPlace(InPlace::boundaries_vtp)),
            ("contacts.vtp", Writer::InPlace(InPlace::contacts_vtp)),
            ("wheelset.vtm", Writer::InPlace(InPlace::wheelset_vtm)),
            ("view.py", Writer::Text(VIEW_SCRIPT)),
        ]),
        /// xi.npy, eta.npy, separation.npy, pressure.npy; over the rail's surface also sigma.npy, angle.npy, normal_gap.npy.
        Npy = unasked(8.0, &[
            ("xi.npy", Writer::Grid(|file, _, grid| axis(file, grid.xi()))),
            ("eta.npy", Writer::Grid(|file, _, grid| axis(file, grid.eta()))),
            ("separation.npy", Writer::Grid(|file, _, grid| over_grid(file, grid, grid.separation()))),
            ("pressure.npy", Writer::Pressure(over_grid)),
            ("sigma.npy", Writer::Curved(|file, _, curved| axis(file, curved.sigma()))),
            ("angle.npy", Writer::Curved(|file, _, curved| axis(file, &curved.angles()))),
            ("normal_gap.npy", Writer::Curved(|file, _, curved| over_grid(file, &curved.grid(), curved.grid().separation()))),
        ]),
        /// separation.nc.
        Netcdf = unasked(8.0, &[("separation.nc", Writer::NetCdf)]),
        /// separation.wrp.
        Text = unasked(80.0, &[("separation.wrp", Writer::Deck(separation_wrp))]),
        /// conform.wrp.
        Conform = unasked(130.0, &[
            ("conform.wrp", Writer::Deck(conform_wrp)),
            ("conform.wrp", Writer::CurvedDeck(conform_curved_wrp)),
        ]),
        /// countact.wrp.
        Countact = unasked(0.0, &[("countact.wrp", Writer::StripsDeck(countact_wrp))]),
        /// contact.inp.
        Contact = unasked(28.0, &[
            ("contact.inp", Writer::PressedDeck(contact_inp)),
            ("contact.inp", Writer::PressedCurvedDeck(contact_curved_inp)),
        ]),
        /// view.html.
        Html = unasked(0.0, &[("view.html", Writer::Page)]),
        /// patch.png, conformal.png.
        Png = named(0.0, &[("patch.png", Writer::Picture), ("conformal.png", Writer::CurvedPicture)]),
        /// patch.msh.
        Gmsh = named(0.0, &[("patch.msh", Writer::Triangles(patch_msh))]),
        /// patch.inp.
        Abaqus = named(0.0, &[("patch.inp", Writer::Triangles(patch_inp))]),
        /// patch.stl, rail.stl, wheel.stl.
        Stl = named(0.0, &[
            ("patch.stl", Writer::Surface(SurfaceOf::Patch, surface_stl)),
            ("rail.stl", Writer::Surface(SurfaceOf::Rail, surface_stl)),
            ("wheel.stl", Writer::Surface(SurfaceOf::Wheel, surface_stl)),
        ]),
        /// patch.ply, rail.ply, wheel.ply.
        Ply = named(0.0, &[
            ("patch.ply", Writer::Surface(SurfaceOf::Patch, surface_ply)),
            ("rail.ply", Writer::Surface(SurfaceOf::Rail, surface_ply)),
            ("wheel.ply", Writer::Surface(SurfaceOf::Wheel, surface_ply)),
        ]),
        /// patch.vtp, rail.vtp, wheel.vtp.
        Vtp = named(0.0, &[
            ("patch.vtp", Writer::Surface(SurfaceOf::Patch, surface_vtp)),
            ("rail.vtp", Writer::Surface(SurfaceOf::Rail, surface_vtp)),
            ("wheel.vtp", Writer::Surface(SurfaceOf::Wheel, surface_vtp)),
        ]),
    }
}

fn axis(file: &mut dyn Write, values: &[f64]) -> io::Result<()> {
    array_npy(file, &[values.len() as u64], values)
}

fn over_grid(file: &mut dyn Write, grid: &GridFields<'_>, values: &[f64]) -> io::Result<()> {
    array_npy(file, &[grid.xi().len() as u64, grid.eta().len() as u64], values)
}

impl OutputFormat {
    /// Gives the name of the format in scenes.
    pub fn name(self) -> String {
        format!("{self:?}").to_lowercase()
    }

    /// Gives the first file of a format that has no form over the rail's surface; `None` of any other.
    pub(super) fn plane_only(self) -> Option<&'static str> {
        let files = self.row().files;
        let plane = files.iter().all(|(_, writer)| writer.is_deck() || writer.is_netcdf());
        files.first().filter(|_| plane).map(|(name, _)| *name)
    }

    /// Tells whether the format is written where a scene names none.
    pub fn unasked(self) -> bool {
        self.row().unasked
    }

    /// Lists the names of the format's files.
    pub fn files(self) -> impl Iterator<Item = &'static str> {
        self.row().files.iter().map(|(name, _)| *name)
    }
}

/// Files of every run.
const OF_EVERY_RUN: [&str; 7] = [
    "summary.json",
    "boundary.csv",
    "interpen.csv",
    "interpen_sigma.csv",
    "midsep.txt",
    "patch.svg",
    "conformal.svg",
];

/// Collections of the patches of a sweep, and the folder that Python makes where it imports or compiles view.py.
const BESIDE_RUNS: [&str; 3] = ["surface.pvd", "wheelset.pvd", "__pycache__"];

/// Lists the names of all files that a run may write.
pub fn run_files() -> impl Iterator<Item = &'static str> {
    OF_EVERY_RUN.into_iter().chain(OutputFormat::ALL.iter().flat_map(|format| format.files()))
}

/// The folder of `wheelrail run`.
pub const RUN_FOLDER: Names = Names {
    marker: "summary.json",
    is_file: |name| run_files().chain(BESIDE_RUNS).any(|own| own == name),
    is_part: |name| {
        let words = ["left", "right", "single", "contact", "patch"];
        name.split('-').all(|word| words.contains(&word) || word.parse::<u32>().is_ok())
    },
};

/// The folder of `wheelrail sweep --patches`: its subfolders are folders of runs.
pub const PATCHES_FOLDER: Names = Names { is_part: |name| name.starts_with("position-"), ..RUN_FOLDER };

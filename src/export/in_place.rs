//! Files in the axes of the track: bodies, patches, boundaries and contact points where they are.

use nalgebra::Point3;
use vtkio::model::{Attribute, Attributes, DataSet, PolyDataPiece};

use super::model::{Loop, QuadMesh};
use super::vtk::{EMPTY_POLYDATA, closed, coordinates, distinct, numbered, scalars, xml_text};
use super::vts::comment_of;
use crate::error::Result;

/// What files in the axes of the track show of one contact; all points are in those axes \[mm\].
#[derive(Debug, Clone, PartialEq)]
pub struct ContactInPlace {
    /// Number of the contact in the run, from 1.
    pub number: usize,
    /// C \[mm\].
    pub point: Point3<f64>,
    /// δ \[mm\]; NaN without one.
    pub approach: f64,
    /// Vertical part of the normal force \[N\]; NaN without a load.
    pub vertical_load: f64,
    /// The patch.
    pub patch: QuadMesh,
    /// δ − s at every point of the patch \[mm\].
    pub overlap: Vec<f64>,
    /// Its boundary.
    pub loops: Vec<Loop>,
}

/// Writes a body as polygons; `statements` say what it is.
///
/// # Errors
/// Data that `vtkio` refuses, which would be a fault of this program.
pub fn body_vtp(statements: &[String], points: &[Point3<f64>], faces: &[Vec<usize>]) -> Result<Vec<u8>> {
    let piece = PolyDataPiece {
        points: coordinates(points),
        polys: Some(numbered(faces)),
        ..PolyDataPiece::default()
    };
    annotated(statements, piece)
}

/// Writes `patches.vtp`: the patches of all contacts, with `overlap` δ − s \[mm\] at points and the number of the contact.
///
/// # Errors
/// Meshes that contradict themselves.
pub fn patches_vtp(statements: &[String], contacts: &[ContactInPlace]) -> Result<Vec<u8>> {
    let (mut faces, mut numbers, mut first) = (Vec::new(), Vec::new(), 0);
    for contact in contacts {
        contact.patch.validate()?;
        for quad in &contact.patch.quads {
            faces.push(distinct(quad).into_iter().map(|node| first + node).collect::<Vec<_>>());
            numbers.push(contact.number as i32);
        }
        first += contact.patch.points.len();
    }
    let overlap: Vec<f64> = contacts.iter().flat_map(|contact| &contact.overlap).copied().collect();
    let count = numbers.len();
    let piece = PolyDataPiece {
        points: coordinates(contacts.iter().flat_map(|contact| &contact.patch.points)),
        polys: Some(numbered(&faces)),
        data: Attributes {
            point: vec![scalars("overlap", overlap.into(), first)?],
            cell: vec![scalars("contact", numbers.into(), count)?],
        },
        ..PolyDataPiece::default()
    };
    annotated(statements, piece)
}

/// Writes `boundaries.vtp`: the boundaries of all patches as closed lines, with the number of the contact.
///
/// # Errors
/// Data that `vtkio` refuses, which would be a fault of this program.
pub fn boundaries_vtp(statements: &[String], contacts: &[ContactInPlace]) -> Result<Vec<u8>> {
    let loops =
        contacts.iter().flat_map(|contact| contact.loops.iter().map(|ring| (contact.number as i32, ring)));
    let (numbers, loops): (Vec<i32>, Vec<&Loop>) = loops.filter(|(_, ring)| !ring.points.is_empty()).unzip();
    let piece = PolyDataPiece {
        points: coordinates(loops.iter().flat_map(|ring| &ring.points)),
        lines: Some(closed(&loops)),
        data: Attributes { point: Vec::new(), cell: vec![scalars("contact", numbers.into(), loops.len())?] },
        ..PolyDataPiece::default()
    };
    annotated(statements, piece)
}

/// Writes `contacts.vtp`: C of every contact as a point, with its number, δ \[mm\] and vertical load \[N\].
///
/// # Errors
/// Data that `vtkio` refuses, which would be a fault of this program.
pub fn contacts_vtp(statements: &[String], contacts: &[ContactInPlace]) -> Result<Vec<u8>> {
    let numbers: Vec<i32> = contacts.iter().map(|contact| contact.number as i32).collect();
    let column = |name: &str, of: fn(&ContactInPlace) -> f64| -> Result<Attribute> {
        scalars(name, contacts.iter().map(of).collect::<Vec<f64>>().into(), contacts.len())
    };
    let point = vec![
        scalars("contact", numbers.into(), contacts.len())?,
        column("approach_mm", |contact| contact.approach)?,
        column("vertical_load_n", |contact| contact.vertical_load)?,
    ];
    let piece = PolyDataPiece {
        points: coordinates(contacts.iter().map(|contact| &contact.point)),
        verts: Some(numbered(&(0..contacts.len()).map(|node| [node]).collect::<Vec<_>>())),
        data: Attributes { point, cell: Vec::new() },
        ..PolyDataPiece::default()
    };
    annotated(statements, piece)
}

/// Writes `wheelset.vtm`: the files of a picture as named blocks. `blocks` are (name, path as it is to be written).
pub fn wheelset_vtm(statements: &[String], blocks: &[(&str, &str)]) -> String {
    let set = |(index, (name, path)): (usize, &(&str, &str))| {
        format!("    <DataSet index=\"{index}\" name=\"{name}\" file=\"{path}\"/>\n")
    };
    let sets: String = blocks.iter().enumerate().map(set).collect();
    format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"vtkMultiBlockDataSet\" version=\"1.0\" byte_order=\"LittleEndian\">\n{}  \
         <vtkMultiBlockDataSet>\n{sets}  </vtkMultiBlockDataSet>\n</VTKFile>\n",
        comment_of(statements)
    )
}

fn annotated(statements: &[String], piece: PolyDataPiece) -> Result<Vec<u8>> {
    let text = xml_text(DataSet::inline(piece), EMPTY_POLYDATA)?;
    Ok(text.replacen("<Piece", &format!("{}<Piece", comment_of(statements)), 1).into_bytes())
}

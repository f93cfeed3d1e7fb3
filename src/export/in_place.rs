//! Files in the axes of the track: bodies, patches, boundaries and contact points where they are.

use nalgebra::Point3;
use vtkio::model::{Attribute, Attributes, DataSet, PolyDataPiece, VertexNumbers};

use super::model::{Loop, QuadMesh};
use super::vtk::{EMPTY_POLYDATA, coordinates, distinct, scalars, xml_text};
use super::vts::comment_of;
use crate::error::Result;

/// Polygons, or the loops of boundaries, of one contact.
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
        polys: Some(cells(faces.iter().map(|face| face.iter().map(|&node| node as u64).collect()))),
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
            faces.push(distinct(quad).into_iter().map(|node| (first + node) as u64).collect());
            numbers.push(contact.number as i32);
        }
        first += contact.patch.points.len();
    }
    let overlap: Vec<f64> = contacts.iter().flat_map(|contact| &contact.overlap).copied().collect();
    let count = numbers.len();
    let piece = PolyDataPiece {
        points: coordinates(contacts.iter().flat_map(|contact| &contact.patch.points)),
        polys: Some(cells(faces.into_iter())),
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
        || contacts.iter().flat_map(|contact| contact.loops.iter().map(move |ring| (contact.number, ring)));
    let mut first = 0;
    let closed = loops().map(|(_, ring)| {
        let count = ring.points.len() as u64;
        first += count;
        (first - count..first).chain([first - count]).collect()
    });
    let closed: Vec<Vec<u64>> = closed.collect();
    let numbers: Vec<i32> = loops().map(|(number, _)| number as i32).collect();
    let count = numbers.len();
    let piece = PolyDataPiece {
        points: coordinates(loops().flat_map(|(_, ring)| &ring.points)),
        lines: Some(cells(closed.into_iter())),
        data: Attributes { point: Vec::new(), cell: vec![scalars("contact", numbers.into(), count)?] },
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
        verts: Some(cells((0..contacts.len() as u64).map(|node| vec![node]))),
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

fn cells(all: impl Iterator<Item = Vec<u64>>) -> VertexNumbers {
    let (mut connectivity, mut offsets) = (Vec::new(), Vec::new());
    for nodes in all {
        connectivity.extend(nodes);
        offsets.push(connectivity.len() as u64);
    }
    VertexNumbers::XML { connectivity, offsets }
}

fn annotated(statements: &[String], piece: PolyDataPiece) -> Result<Vec<u8>> {
    let text = xml_text(DataSet::inline(piece), EMPTY_POLYDATA)?;
    Ok(text.replacen("<Piece", &format!("{}<Piece", comment_of(statements)), 1).into_bytes())
}

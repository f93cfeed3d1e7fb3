//! Files in the axes of the track: bodies, patches, boundaries and contact points at their places.

use nalgebra::Point3;
use vtkio::model::{Attribute, Attributes, DataSet, PolyDataPiece};

use super::model::{Loop, QuadMesh};
use super::vtk::{EMPTY_POLYDATA, closed, coordinates, distinct, numbered, scalars, xml_text};
use super::vts::comment_of;
use crate::error::Result;
use crate::mesh::BodyShell;

/// What files in the axes of the track show of one contact; all points are in those axes \[mm\].
#[derive(Debug, Clone, PartialEq)]
pub struct ContactInPlace {
    /// Number of the contact in the run, from 1.
    pub number: usize,
    /// The initial contact point C \[mm\].
    pub point: Point3<f64>,
    /// δ \[mm\]; NaN without one.
    pub approach: f64,
    /// Vertical part of the normal force \[N\]; NaN without a load.
    pub vertical_load: f64,
    /// The patch.
    pub patch: QuadMesh,
    /// δ − s at every point of the patch \[mm\].
    pub overlap: Vec<f64>,
    /// The boundary of the patch.
    pub loops: Vec<Loop>,
}

/// All contacts of a run with both bodies of each side, in the axes of the track.
#[derive(Debug, Clone, PartialEq)]
pub struct InPlace {
    /// Lines that say what the files show and in which axes.
    pub statements: Vec<String>,
    /// The rails.
    pub rails: BodyShell,
    /// The wheels.
    pub wheels: BodyShell,
    /// The contacts.
    pub contacts: Vec<ContactInPlace>,
}

/// Names of the blocks of `wheelset.vtm`; each lies in the file of its name beside it.
const BLOCKS: [&str; 5] = ["rails", "wheels", "patches", "boundaries", "contacts"];

impl InPlace {
    /// Writes `rails.vtp`: the rails as polygons.
    ///
    /// # Errors
    /// Data that `vtkio` refuses, which would be a fault of this program.
    pub fn rails_vtp(&self) -> Result<Vec<u8>> {
        self.body(&self.rails)
    }

    /// Writes `wheels.vtp`: the wheels as polygons.
    ///
    /// # Errors
    /// Data that `vtkio` refuses, which would be a fault of this program.
    pub fn wheels_vtp(&self) -> Result<Vec<u8>> {
        self.body(&self.wheels)
    }

    fn body(&self, BodyShell { points, faces }: &BodyShell) -> Result<Vec<u8>> {
        let polys = Some(numbered(faces));
        self.annotated(PolyDataPiece { points: coordinates(points), polys, ..PolyDataPiece::default() })
    }

    /// Writes `patches.vtp`: the patches of all contacts, with `overlap` δ − s \[mm\] at points and the number of the contact.
    ///
    /// # Errors
    /// Meshes that contradict themselves.
    pub fn patches_vtp(&self) -> Result<Vec<u8>> {
        let (mut faces, mut numbers, mut first) = (Vec::new(), Vec::new(), 0);
        for contact in &self.contacts {
            contact.patch.validate()?;
            for quad in &contact.patch.quads {
                faces.push(distinct(quad).into_iter().map(|node| first + node).collect::<Vec<_>>());
                numbers.push(contact.number as i32);
            }
            first += contact.patch.points.len();
        }
        let overlap: Vec<f64> = self.contacts.iter().flat_map(|contact| &contact.overlap).copied().collect();
        let count = numbers.len();
        self.annotated(PolyDataPiece {
            points: coordinates(self.contacts.iter().flat_map(|contact| &contact.patch.points)),
            polys: Some(numbered(&faces)),
            data: Attributes {
                point: vec![scalars("overlap", overlap.into(), first)?],
                cell: vec![scalars("contact", numbers.into(), count)?],
            },
            ..PolyDataPiece::default()
        })
    }

    /// Writes `boundaries.vtp`: the boundaries of all patches as closed lines, with the number of the contact.
    ///
    /// # Errors
    /// Data that `vtkio` refuses, which would be a fault of this program.
    pub fn boundaries_vtp(&self) -> Result<Vec<u8>> {
        let of = |contact: &'_ ContactInPlace| contact.number as i32;
        let loops = self
            .contacts
            .iter()
            .flat_map(|contact| contact.loops.iter().map(move |ring| (of(contact), ring)));
        let (numbers, loops): (Vec<i32>, Vec<&Loop>) =
            loops.filter(|(_, ring)| !ring.points.is_empty()).unzip();
        let cell = vec![scalars("contact", numbers.into(), loops.len())?];
        self.annotated(PolyDataPiece {
            points: coordinates(loops.iter().flat_map(|ring| &ring.points)),
            lines: Some(closed(&loops)),
            data: Attributes { point: Vec::new(), cell },
            ..PolyDataPiece::default()
        })
    }

    /// Writes `contacts.vtp`: C of every contact as a point, with its number, δ \[mm\] and vertical load \[N\].
    ///
    /// # Errors
    /// Data that `vtkio` refuses, which would be a fault of this program.
    pub fn contacts_vtp(&self) -> Result<Vec<u8>> {
        let count = self.contacts.len();
        let numbers: Vec<i32> = self.contacts.iter().map(|contact| contact.number as i32).collect();
        let column = |name: &str, of: fn(&ContactInPlace) -> f64| -> Result<Attribute> {
            scalars(name, self.contacts.iter().map(of).collect::<Vec<f64>>().into(), count)
        };
        let point = vec![
            scalars("contact", numbers.into(), count)?,
            column("approach_mm", |contact| contact.approach)?,
            column("vertical_load_n", |contact| contact.vertical_load)?,
        ];
        self.annotated(PolyDataPiece {
            points: coordinates(self.contacts.iter().map(|contact| &contact.point)),
            verts: Some(numbered(&(0..count).map(|node| [node]).collect::<Vec<_>>())),
            data: Attributes { point, cell: Vec::new() },
            ..PolyDataPiece::default()
        })
    }

    /// Writes `wheelset.vtm`: the other files as named blocks.
    ///
    /// # Errors
    /// None.
    pub fn wheelset_vtm(&self) -> Result<Vec<u8>> {
        let set = |(index, name): (usize, &str)| {
            format!("    <DataSet index=\"{index}\" name=\"{name}\" file=\"{name}.vtp\"/>\n")
        };
        let sets: String = BLOCKS.into_iter().enumerate().map(set).collect();
        let text = format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"vtkMultiBlockDataSet\" version=\"1.0\" byte_order=\"LittleEndian\">\n{}  \
             <vtkMultiBlockDataSet>\n{sets}  </vtkMultiBlockDataSet>\n</VTKFile>\n",
            comment_of(&self.statements)
        );
        Ok(text.into_bytes())
    }

    fn annotated(&self, piece: PolyDataPiece) -> Result<Vec<u8>> {
        let text = xml_text(DataSet::inline(piece), EMPTY_POLYDATA)?;
        Ok(text.replacen("<Piece", &format!("{}<Piece", comment_of(&self.statements)), 1).into_bytes())
    }
}

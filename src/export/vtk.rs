//! Writes VTK files with `vtkio` 0.7.0-rc2: boundaries, patches and surfaces. Grids are written by
//! [`vts`](super::vts) and [`legacy`](super::legacy).
//!
//! `vtkio` has five faults, and each is avoided here. It reports partial writes as success (files are encoded in memory).
//! It does not check lengths of arrays (they are checked here). It leaves out counts of zero, which makes empty files
//! unreadable (they are put in here). It drops FieldData from XML (it is inserted as text). Its node numbers are unsigned,
//! which meshio turns into floating-point numbers (they are declared as signed). Array names contain no blanks, which break
//! readers. Only the version and the cell kinds that meshio reads are used: XML 1.0.

use super::model::{Header, Loop, QuadMesh, SurfaceMesh, same_length};
use super::vts::{comment, field_data};
use crate::error::{Error, Result};
use nalgebra::Point3;
use vtkio::model::{
    Attribute, Attributes, ByteOrder, CellType, Cells, DataArray, DataSet, ElementType, IOBuffer,
    PolyDataPiece, UnstructuredGridPiece, Version, VertexNumbers, Vtk,
};

/// The counts of an empty PolyData piece. `vtkio` leaves them out, and no reader takes a file without them.
pub(super) const EMPTY_POLYDATA: &str = "<Piece NumberOfPoints=\"0\" NumberOfVerts=\"0\" NumberOfLines=\"0\" \
    NumberOfStrips=\"0\" NumberOfPolys=\"0\">";

/// The counts of an empty unstructured grid, which `vtkio` leaves out.
const EMPTY_UNSTRUCTURED: &str = "<Piece NumberOfPoints=\"0\" NumberOfCells=\"0\">";

/// Writes `boundary.vtp`: each loop as one closed polyline on the rail's surface, with the cell array
/// `component`.
///
/// # Errors
/// Data that `vtkio` refuses, which would be a fault of this program.
pub fn boundary_vtp(header: &Header, loops: &[Loop]) -> Result<Vec<u8>> {
    let loops: Vec<_> = loops.iter().filter(|ring| !ring.points.is_empty()).collect();
    let (mut connectivity, mut offsets, mut first) = (Vec::new(), Vec::new(), 0);
    for ring in &loops {
        let count = ring.points.len() as u64;
        connectivity.extend((first..first + count).chain([first]));
        offsets.push(connectivity.len() as u64);
        first += count;
    }
    let components = loops.iter().map(|ring| ring.component as i32).collect::<Vec<_>>();
    let cell = vec![scalars("component", components.into(), loops.len())?];
    let piece = PolyDataPiece {
        points: coordinates(loops.iter().flat_map(|ring| &ring.points)),
        lines: Some(VertexNumbers::XML { connectivity, offsets }),
        data: Attributes { point: Vec::new(), cell },
        ..PolyDataPiece::default()
    };
    xml(header, DataSet::inline(piece), EMPTY_POLYDATA)
}

/// Writes `patch.vtu`: the boundary-fitted cells on the rail's surface, with the cell arrays `area` \[mm²\]
/// and `component`. A cell with a repeated node is written as a triangle.
///
/// # Errors
/// A mesh that contradicts itself.
pub fn patch_vtu(header: &Header, mesh: &QuadMesh) -> Result<Vec<u8>> {
    mesh.validate()?;
    let components: Vec<i32> = mesh.component.iter().map(|&c| c as i32).collect();
    let cell = vec![
        scalars("area", mesh.area.clone().into(), mesh.quads.len())?,
        scalars("component", components.into(), mesh.quads.len())?,
    ];
    let cells: Vec<Vec<usize>> = mesh.quads.iter().map(distinct).collect();
    unstructured(header, &mesh.points, &cells, cell)
}

/// Writes a triangulated surface as `.vtu`.
///
/// # Errors
/// A mesh that contradicts itself.
pub fn surface_vtp(header: &Header, mesh: &SurfaceMesh) -> Result<Vec<u8>> {
    mesh.validate()?;
    let cells: Vec<Vec<usize>> = mesh.triangles.iter().map(|triangle| triangle.to_vec()).collect();
    unstructured(header, &mesh.points, &cells, Vec::new())
}

/// Writes `surface.pvd`: the files of a sweep on one time axis, which ParaView plays. `steps` are (time, part, path), with
/// the paths as they are to be written.
pub fn collection_pvd(steps: &[(f64, usize, String)]) -> String {
    let set = |(time, part, path): &(f64, usize, String)| {
        format!("    <DataSet timestep=\"{time:?}\" group=\"\" part=\"{part}\" file=\"{path}\"/>\n")
    };
    let sets: String = steps.iter().map(set).collect();
    format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n  \
         <Collection>\n{sets}  </Collection>\n</VTKFile>\n"
    )
}

fn unstructured(
    header: &Header,
    points: &[Point3<f64>],
    cells: &[Vec<usize>],
    cell: Vec<Attribute>,
) -> Result<Vec<u8>> {
    let mut end = 0;
    let offsets = cells.iter().map(|nodes| {
        end += nodes.len() as u64;
        end
    });
    let offsets = offsets.collect();
    let types = cells.iter().map(|nodes| if nodes.len() == 3 { CellType::Triangle } else { CellType::Quad });
    let types = types.collect();
    let connectivity = cells.iter().flatten().map(|&node| node as u64).collect();
    let piece = UnstructuredGridPiece {
        points: coordinates(points),
        cells: Cells { cell_verts: VertexNumbers::XML { connectivity, offsets }, types },
        data: Attributes { point: Vec::new(), cell },
    };
    xml(header, DataSet::inline(piece), EMPTY_UNSTRUCTURED)
}

/// Returns the coordinates of points one after another.
pub(super) fn coordinates<'a>(points: impl IntoIterator<Item = &'a Point3<f64>>) -> IOBuffer {
    points.into_iter().flat_map(|point| point.coords.as_slice()).copied().collect::<Vec<f64>>().into()
}

/// Returns the nodes of a cell without equal neighbours.
pub(super) fn distinct(quad: &[usize; 4]) -> Vec<usize> {
    let mut nodes = quad.to_vec();
    nodes.dedup();
    if nodes.len() == 4 && nodes[0] == nodes[3] {
        nodes.pop();
    }
    nodes
}

pub(super) fn scalars(name: &str, data: IOBuffer, expected: usize) -> Result<Attribute> {
    same_length(name, data.len(), expected)?;
    let elem = ElementType::Scalars { num_comp: 1, lookup_table: None };
    Ok(Attribute::DataArray(DataArray { name: name.into(), elem, data }))
}

fn xml(header: &Header, data: DataSet, empty_piece: &str) -> Result<Vec<u8>> {
    Ok(annotate(xml_text(data, empty_piece)?, header))
}

/// Encodes a data set; `empty_piece` is the tag of a piece without points.
pub(super) fn xml_text(data: DataSet, empty_piece: &str) -> Result<String> {
    let mut bytes = Vec::new();
    let (version, byte_order) = (Version::new_xml(1, 0), ByteOrder::LittleEndian);
    let file = Vtk { version, title: String::new(), byte_order, file_path: None, data };
    file.write_xml(&mut bytes).map_err(refused)?;
    let text = String::from_utf8(bytes).map_err(refused)?;
    // Node numbers are far below 2⁶³, so that their bytes are the same in both types.
    let text = text.replace("<DataArray type=\"UInt64\"", "<DataArray type=\"Int64\"");
    Ok(text.replacen("<Piece>", empty_piece, 1))
}

/// Puts δ and the frame into field data, and the header's statements into a comment.
fn annotate(text: String, header: &Header) -> Vec<u8> {
    let text = text.replacen("<Piece", &format!("{}{}<Piece", comment(header), field_data(header)), 1);
    text.into_bytes()
}

fn refused(error: impl std::fmt::Display) -> Error {
    Error::new("VTK file", error.to_string(), "data that vtkio takes", "report this as a fault of wheelrail")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::sample::{header, mesh, square};

    fn text(bytes: &[u8]) -> String {
        String::from_utf8_lossy(bytes).into_owned()
    }

    #[test]
    fn xml_files_carry_frame_and_statements() {
        for file in [
            boundary_vtp(&header(), &[square()]).unwrap(),
            boundary_vtp(&header(), &[]).unwrap(),
            patch_vtu(&header(), &mesh()).unwrap(),
            patch_vtu(&header(), &QuadMesh::default()).unwrap(),
        ] {
            let text = text(&file);
            assert!(text.contains("approach_mm") && text.contains("scene 0123abcd"), "{text}");
            assert!(!text.contains("<DataArray type=\"UInt64"), "{text}");
            assert!(text.contains("version=\"1.0\"") && text.trim_end().ends_with("</VTKFile>"), "{text}");
        }
    }

    #[test]
    fn what_is_written_reads_back() {
        let file = Vtk::parse_xml(&patch_vtu(&header(), &mesh()).unwrap()[..]).unwrap();
        let DataSet::UnstructuredGrid { pieces, .. } = file.data else { panic!("{file:?}") };
        let piece = pieces[0].clone().into_loaded_piece_data(None).unwrap();
        let points: Vec<f64> = piece.points.cast_into().unwrap();
        assert_eq!(points, mesh().points.into_iter().flat_map(<[f64; 3]>::from).collect::<Vec<_>>());
        assert_eq!((piece.cells.num_cells(), piece.cells.num_verts()), (4, 16));
    }

    #[test]
    fn a_repeated_node_makes_a_triangle() {
        assert_eq!(distinct(&[1, 2, 2, 3]), [1, 2, 3]);
        assert_eq!(distinct(&[1, 2, 3, 1]), [1, 2, 3]);
        assert_eq!(distinct(&[1, 2, 3, 4]), [1, 2, 3, 4]);
    }

    #[test]
    fn arrays_and_meshes_that_do_not_fit_are_refused() {
        let mut broken = mesh();
        broken.area.pop();
        assert!(patch_vtu(&header(), &broken).unwrap_err().place.contains("areas"));
        let surface_mesh = SurfaceMesh { points: vec![Point3::origin(); 3], triangles: vec![[0, 1, 3]] };
        assert!(surface_vtp(&header(), &surface_mesh).is_err());
    }
}

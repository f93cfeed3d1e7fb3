//! Writes VTK files with `vtkio` 0.7.0-rc2: boundaries, patches and surfaces. Grids are written by
//! [`vts`](super::vts) and [`legacy`](super::legacy).
//!
//! `vtkio` has five faults, and each is avoided here. It reports partial writes as success (files are encoded in memory).
//! It does not check lengths of arrays (they are checked here). It leaves out counts of zero, which makes empty files
//! unreadable (they are put in here). It drops FieldData from XML (it is inserted as text). Its node numbers are unsigned,
//! which meshio turns into floating-point numbers (they are declared as signed). Array names contain no blanks, which break
//! readers. Only the version and the cell kinds that meshio reads are used: XML 1.0.

use super::model::{Header, Loop, PatchMesh, QuadMesh, SurfaceMesh, same_length};
use super::vts::{comment, field_data};
use crate::error::{Error, Result};
use nalgebra::{Point3, Vector3};
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
    let components = loops.iter().map(|ring| ring.component as i32).collect::<Vec<_>>();
    let cell = vec![scalars("component", components.into(), loops.len())?];
    let piece = PolyDataPiece {
        points: coordinates(loops.iter().flat_map(|ring| &ring.points)),
        lines: Some(closed(&loops)),
        data: Attributes { point: Vec::new(), cell },
        ..PolyDataPiece::default()
    };
    xml(header, &[], DataSet::inline(piece), EMPTY_POLYDATA)
}

/// Writes `strips.vtu`: the boundary-fitted cells on the rail's surface, with the cell arrays `area` \[mm²\] and `component`.
/// All quads come first, then the cells with a repeated node, which are written as triangles; each kind is in the order of
/// the mesh. With one block per kind meshio converts the file to any format.
///
/// # Errors
/// A mesh that contradicts itself.
pub fn strips_vtu(header: &Header, mesh: &QuadMesh) -> Result<Vec<u8>> {
    mesh.validate()?;
    let cells: Vec<Vec<usize>> = mesh.quads.iter().map(distinct).collect();
    let mut order: Vec<usize> = (0..cells.len()).collect();
    order.sort_by_key(|&k| std::cmp::Reverse(cells[k].len()));
    let areas: Vec<f64> = order.iter().map(|&k| mesh.area[k]).collect();
    let components: Vec<i32> = order.iter().map(|&k| mesh.component[k] as i32).collect();
    let cell = vec![
        scalars("area", areas.into(), cells.len())?,
        scalars("component", components.into(), cells.len())?,
    ];
    let cells: Vec<&[usize]> = order.iter().map(|&k| &cells[k][..]).collect();
    let grid = unstructured(&mesh.points, &cells, Attributes { point: Vec::new(), cell });
    xml(header, &[], grid, EMPTY_UNSTRUCTURED)
}

/// Writes `patch.vtu`: the triangle mesh of the patch on the rail's surface. Point arrays are separation \[mm\],
/// `rail_normal`, `wheel_normal` and boundary (1 on the boundary, 0 inside); cell arrays are `component`, and
/// `component_area`, the exact area \[mm²\] of the cell's component. Field data hold the exact areas, the sizes and the chord
/// errors of all components.
///
/// # Errors
/// A mesh that contradicts itself.
pub fn patch_vtu(header: &Header, patch: &PatchMesh) -> Result<Vec<u8>> {
    patch.validate()?;
    let PatchMesh { mesh, separation, rail_normals, wheel_normals, areas } = patch;
    let (nodes, cells) = (mesh.points.len(), mesh.triangles.len());
    let mut boundary = vec![0; nodes];
    patch.boundary_nodes().into_iter().for_each(|node| boundary[node] = 1);
    let own_areas: Vec<f64> = mesh.component.iter().map(|&component| areas[component]).collect();
    let components: Vec<i32> = mesh.component.iter().map(|&component| component as i32).collect();
    let data = Attributes {
        point: vec![
            scalars("separation", separation.clone().into(), nodes)?,
            vectors("rail_normal", rail_normals),
            vectors("wheel_normal", wheel_normals),
            scalars("boundary", boundary.into(), nodes)?,
        ],
        cell: vec![
            scalars("component", components.into(), cells)?,
            scalars("component_area", own_areas.into(), cells)?,
        ],
    };
    let fields: [(&str, &[f64]); 3] = [
        ("component_areas_mm2", areas),
        ("component_sizes_mm", &mesh.size),
        ("component_chord_errors_mm", &mesh.chord_error),
    ];
    xml(header, &fields, unstructured(&mesh.points, &mesh.triangles, data), EMPTY_UNSTRUCTURED)
}

/// Writes a triangulated surface as unstructured grid (`.vtu`), with the point arrays separation \[mm\] and normal.
///
/// # Errors
/// A mesh that contradicts itself.
pub fn surface_vtu(header: &Header, mesh: &SurfaceMesh) -> Result<Vec<u8>> {
    let data = surface_data(mesh)?;
    xml(header, &[], unstructured(&mesh.points, &mesh.triangles, data), EMPTY_UNSTRUCTURED)
}

/// Writes a triangulated surface as polygons (`.vtp`), which viewers in browsers open, with the point arrays separation \[mm\] and
/// normal.
///
/// # Errors
/// A mesh that contradicts itself.
pub fn surface_vtp(header: &Header, mesh: &SurfaceMesh) -> Result<Vec<u8>> {
    let data = surface_data(mesh)?;
    let piece = PolyDataPiece {
        points: coordinates(&mesh.points),
        polys: Some(numbered(&mesh.triangles)),
        data,
        ..PolyDataPiece::default()
    };
    xml(header, &[], DataSet::inline(piece), EMPTY_POLYDATA)
}

fn surface_data(mesh: &SurfaceMesh) -> Result<Attributes> {
    mesh.validate()?;
    let separation = scalars("separation", mesh.separation.clone().into(), mesh.points.len())?;
    Ok(Attributes { point: vec![separation, vectors("normal", &mesh.normals)], cell: Vec::new() })
}

/// Writes a `.pvd` collection: the files of a sweep on one time axis, which ParaView plays. `steps` are (time, part, path), with
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

fn unstructured<C: AsRef<[usize]>>(points: &[Point3<f64>], cells: &[C], data: Attributes) -> DataSet {
    let kind = |cell: &C| if cell.as_ref().len() == 3 { CellType::Triangle } else { CellType::Quad };
    let types = cells.iter().map(kind).collect();
    let cells = Cells { cell_verts: numbered(cells), types };
    DataSet::inline(UnstructuredGridPiece { points: coordinates(points), cells, data })
}

/// Returns the nodes of all cells one after another, and where each cell ends among them.
pub(super) fn numbered<C: AsRef<[usize]>>(cells: &[C]) -> VertexNumbers {
    let mut end = 0;
    let offsets = cells.iter().map(|nodes| {
        end += nodes.as_ref().len() as u64;
        end
    });
    let offsets = offsets.collect();
    let connectivity = cells.iter().flat_map(AsRef::as_ref).map(|&node| node as u64).collect();
    VertexNumbers::XML { connectivity, offsets }
}

/// Returns the node numbers of loops as closed lines; the points of the loops follow one another.
pub(super) fn closed(loops: &[&Loop]) -> VertexNumbers {
    let mut first = 0;
    let line = |ring: &&Loop| -> Vec<usize> {
        let from = first;
        first += ring.points.len();
        (from..first).chain([from]).collect()
    };
    numbered(&loops.iter().map(line).collect::<Vec<_>>())
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

/// Returns an array with one vector for each point.
fn vectors(name: &str, vectors: &[Vector3<f64>]) -> Attribute {
    let data = vectors.iter().flat_map(|vector| vector.as_slice()).copied().collect::<Vec<f64>>().into();
    Attribute::DataArray(DataArray { name: name.into(), elem: ElementType::Vectors, data })
}

fn xml(header: &Header, fields: &[(&str, &[f64])], data: DataSet, empty_piece: &str) -> Result<Vec<u8>> {
    Ok(annotate(xml_text(data, empty_piece)?, header, fields))
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

/// Puts δ, the frame and other numbers into field data, and the header's statements into a comment.
fn annotate(text: String, header: &Header, fields: &[(&str, &[f64])]) -> Vec<u8> {
    let text =
        text.replacen("<Piece", &format!("{}{}<Piece", comment(header), field_data(header, fields)), 1);
    text.into_bytes()
}

fn refused(error: impl std::fmt::Display) -> Error {
    Error::new("VTK file", error.to_string(), "data that vtkio takes", "report this as a fault of wheelrail")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_repeated_node_makes_a_triangle() {
        assert_eq!(distinct(&[1, 2, 2, 3]), [1, 2, 3]);
        assert_eq!(distinct(&[1, 2, 3, 1]), [1, 2, 3]);
        assert_eq!(distinct(&[1, 2, 3, 4]), [1, 2, 3, 4]);
    }
}

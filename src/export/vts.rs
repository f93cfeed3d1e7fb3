//! Writes VTK structured grids (`.vts`): XML with the arrays appended raw, little-endian, in one pass.
//!
//! The writer is our own: `vtkio` cannot append raw data, and its base64 runs at 75 MB/s, a thirtieth of the speed of the
//! disk's cache. Points are (ξ, η, ζ) in the contact frame. The first index of VTK runs fastest, so that it is η.
//!
//! A point where a body has no surface still needs coordinates: ζ is 0 there, and VTK's own array `vtkGhostType` hides the
//! point. This array is written only if there are such points.

use super::block::{Block, put_bytes, put_f64, put_vectors};
use super::curved::CurvedFields;
use super::model::{GridFields, Header, known, plain};
use std::fmt::Write as _;
use std::io::{self, Write};

/// VTK's flag for a hidden point (`vtkDataSetAttributes::HIDDENPOINT`).
const HIDDEN: u8 = 2;

/// A function that fills the bytes of column i.
type FillColumn<'a> = Box<dyn Fn(usize, &mut [u8]) + 'a>;

/// One array of a grid, given column by column; ξ is constant in a column.
struct Array<'a> {
    name: &'a str,
    kind: &'a str,
    components: usize,
    bytes_per_point: usize,
    column: FillColumn<'a>,
}

impl<'a> Array<'a> {
    fn scalar<I: Iterator<Item = f64>>(name: &'a str, column: impl Fn(usize) -> I + 'a) -> Self {
        let column = Box::new(move |i, room: &mut [u8]| put_f64(room, column(i)));
        Self { name, kind: "Float64", components: 1, bytes_per_point: 8, column }
    }

    fn vector<I: Iterator<Item = [f64; 3]>>(name: &'a str, column: impl Fn(usize) -> I + 'a) -> Self {
        let column = Box::new(move |i, room: &mut [u8]| put_vectors(room, column(i)));
        Self { name, kind: "Float64", components: 3, bytes_per_point: 24, column }
    }

    fn byte<I: Iterator<Item = u8>>(name: &'a str, column: impl Fn(usize) -> I + 'a) -> Self {
        let column = Box::new(move |i, room: &mut [u8]| {
            put_bytes(room, column(i));
        });
        Self { name, kind: "UInt8", components: 1, bytes_per_point: 1, column }
    }
}

/// Writes `separation.vts`: the grid on the rail's surface with separation \[mm\], interpenetration max(δ − s, 0) \[mm\],
/// gap_vector s·e_ζ \[mm\] (Warp By Vector moves the rail onto the wheel by it), rail_normal, mask (1 where s is
/// defined), and pressure \[N/mm²\] where it was solved. Undefined values are NaN; in gap_vector they are 0, because a NaN
/// would destroy the picture.
///
/// # Errors
/// The errors of the sink.
pub fn separation_vts(sink: &mut dyn Write, header: &Header, grid: &GridFields) -> io::Result<()> {
    let delta = header.approach;
    let depth = move |s: f64| if s > delta { 0.0 } else { delta - s };
    let mut arrays = vec![
        separation_array(grid),
        Array::scalar("interpenetration", move |i| grid.column(i).iter().map(move |&s| depth(s))),
        Array::vector("gap_vector", |i| grid.column(i).iter().map(|&s| [0.0, 0.0, known(s)])),
        Array::vector("rail_normal", |i| grid.lower_normals(i)),
        Array::byte("mask", |i| grid.mask(i)),
    ];
    if let Some(pressure) = grid.pressure() {
        let n = grid.eta().len();
        arrays.push(Array::scalar("pressure", move |i| pressure[i * n..(i + 1) * n].iter().copied()));
    }
    structured_grid(sink, header, grid, "separation", rail_points(grid), arrays)
}

/// Writes `conformal.vts`: the rail's surface over σ and η with normal_gap t \[mm\], angle α \[rad\], sigma \[mm\],
/// interpenetration max(δ cos α − t, 0) \[mm\], gap_vector t·n_R \[mm\] (Warp By Vector moves the rail onto the wheel by it),
/// the outward unit normals of both bodies, and mask (1 where t is defined). Undefined values are NaN; in gap_vector and
/// wheel_normal they are 0.
///
/// # Errors
/// The errors of the sink.
pub fn conformal_vts(sink: &mut dyn Write, header: &Header, fields: &CurvedFields<'_>) -> io::Result<()> {
    let (delta, grid) = (header.approach, &fields.grid());
    let depth = move |t: f64, cos: f64| if t > delta * cos { 0.0 } else { delta * cos - t };
    let n = grid.eta().len();
    let repeated = move |value: f64| std::iter::repeat_n(value, n);
    let arrays = vec![
        Array::scalar("normal_gap", |i| grid.column(i).iter().copied()),
        Array::scalar("angle", move |i| repeated(fields.angle(i))),
        Array::scalar("sigma", move |i| repeated(fields.sigma()[i])),
        Array::scalar("interpenetration", move |i| {
            let cos = fields.normal(i)[1];
            grid.column(i).iter().map(move |&t| depth(t, cos))
        }),
        Array::vector("gap_vector", |i| {
            let [n_xi, n_zeta] = fields.normal(i);
            grid.column(i).iter().map(move |&t| [known(t * n_xi), 0.0, known(t * n_zeta)])
        }),
        Array::vector("rail_normal", |i| {
            let [n_xi, n_zeta] = fields.normal(i);
            grid.eta().iter().map(move |_| [n_xi, 0.0, n_zeta])
        }),
        Array::vector("wheel_normal", |i| fields.wheel_normals(i).iter().map(|normal| normal.map(known))),
        Array::byte("mask", |i| grid.mask(i)),
    ];
    structured_grid(sink, header, grid, "normal_gap", rail_points(grid), arrays)
}

/// Writes `rail.vts`: the rail's surface ζ^R(ξ), with the separation as its scalar.
///
/// # Errors
/// The errors of the sink.
pub fn rail_vts(sink: &mut dyn Write, header: &Header, grid: &GridFields) -> io::Result<()> {
    structured_grid(sink, header, grid, "separation", rail_points(grid), vec![separation_array(grid)])
}

/// Writes `wheel.vts`: the wheel's surface ζ^R + s before any approach, with the separation as its scalar.
///
/// # Errors
/// The errors of the sink.
pub fn wheel_vts(sink: &mut dyn Write, header: &Header, grid: &GridFields) -> io::Result<()> {
    let points = Array::vector("Points", |i| {
        let above = move |([xi, eta, lower], s): ([f64; 3], &f64)| {
            [xi, eta, if s.is_nan() { 0.0 } else { lower + s }]
        };
        grid.rail_points(i).zip(grid.column(i)).map(above)
    });
    structured_grid(sink, header, grid, "separation", points, vec![separation_array(grid)])
}

fn rail_points<'a>(grid: &'a GridFields) -> Array<'a> {
    Array::vector("Points", |i| grid.rail_points(i))
}

fn separation_array<'a>(grid: &'a GridFields) -> Array<'a> {
    Array::scalar("separation", |i| grid.column(i).iter().copied())
}

fn hidden<'a>(grid: &'a GridFields) -> Option<Array<'a>> {
    let flag = |s: &f64| if s.is_nan() { HIDDEN } else { 0 };
    let any = grid.separation().iter().any(|s| s.is_nan());
    any.then(|| Array::byte("vtkGhostType", move |i| grid.column(i).iter().map(flag)))
}

fn structured_grid(
    sink: &mut dyn Write,
    header: &Header,
    grid: &GridFields,
    scalars: &str,
    points: Array,
    fields: Vec<Array>,
) -> io::Result<()> {
    let hidden = hidden(grid);
    let arrays: Vec<_> = [&points].into_iter().chain(&fields).chain(&hidden).collect();
    let mut block = Block::new(sink);
    block.bytes(head(header, grid, scalars, &arrays).as_bytes())?;
    for array in &arrays {
        let column_bytes = grid.eta().len() * array.bytes_per_point;
        block.bytes(&((grid.xi().len() * column_bytes) as u64).to_le_bytes())?;
        for i in 0..grid.xi().len() {
            (array.column)(i, block.room(column_bytes)?);
        }
    }
    block.bytes(b"\n  </AppendedData>\n</VTKFile>\n")?;
    block.finish()
}

/// Returns everything up to the first appended byte. `arrays[0]` are the points; `scalars` names the array that gives the colours.
fn head(header: &Header, grid: &GridFields, scalars: &str, arrays: &[&Array]) -> String {
    let extent = format!("0 {} 0 {} 0 0", grid.eta().len() - 1, grid.xi().len() - 1);
    let mut offset = 0;
    let mut declared = arrays.iter().map(|array| {
        let here = offset;
        offset += 8 + grid.separation().len() * array.bytes_per_point;
        format!(
            "        <DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" \
             offset=\"{here}\"/>\n",
            array.kind, array.name, array.components
        )
    });
    let points = declared.next().unwrap_or_default();
    let fields: String = declared.collect();
    format!(
        "<?xml version=\"1.0\"?>\n\
         <VTKFile type=\"StructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n\
         {}  <StructuredGrid WholeExtent=\"{extent}\">\n{}    <Piece Extent=\"{extent}\">\n\
         \x20     <PointData Scalars=\"{scalars}\">\n{fields}      </PointData>\n\
         \x20     <Points>\n{points}      </Points>\n\
         \x20   </Piece>\n  </StructuredGrid>\n  <AppendedData encoding=\"raw\">\n   _",
        comment(header),
        field_data(header, &[]),
    )
}

/// Returns the header's statements as an XML comment.
pub(super) fn comment(header: &Header) -> String {
    comment_of(&header.statements())
}

/// Returns lines as an XML comment, made plain.
pub(super) fn comment_of(statements: &[String]) -> String {
    let mut text = String::from("  <!--\n");
    for line in statements {
        text += "    ";
        text += &plain(line);
        text += "\n";
    }
    text + "  -->\n"
}

/// Returns δ, the frame and other named numbers as numeric field data. Text there would make a file unreadable to meshio.
pub(super) fn field_data(header: &Header, more: &[(&str, &[f64])]) -> String {
    let frame = &header.frame;
    let mut text = String::from("    <FieldData>\n");
    let approach = [header.approach];
    let entries: [(&str, &[f64]); 5] = [
        ("approach_mm", &approach),
        ("frame_origin_mm", frame.origin.coords.as_slice()),
        ("frame_xi", frame.xi.as_slice()),
        ("frame_eta", frame.eta.as_slice()),
        ("frame_zeta", frame.zeta.as_slice()),
    ];
    for (name, values) in entries.iter().chain(more) {
        let numbers: Vec<_> = values.iter().map(|v| format!("{v:?}")).collect();
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "      <DataArray type=\"Float64\" Name=\"{name}\" NumberOfTuples=\"{}\" format=\"ascii\">{}</DataArray>",
            values.len(),
            numbers.join(" ")
        );
    }
    text + "    </FieldData>\n"
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::sample::{Sample, header};

    /// Returns the appended array that starts `offset` bytes after the underscore.
    fn appended(file: &[u8], offset: usize) -> &[u8] {
        let mark = b"encoding=\"raw\">\n   _";
        let begin = file.windows(mark.len()).position(|w| w == mark).unwrap() + mark.len() + offset;
        let size = u64::from_le_bytes(file[begin..begin + 8].try_into().unwrap()) as usize;
        &file[begin + 8..begin + 8 + size]
    }

    #[test]
    fn arrays_lie_where_the_head_says_bit_for_bit() {
        let sample = Sample::new(3, 4);
        let mut file = Vec::new();
        separation_vts(&mut file, &header(), &sample.fields()).unwrap();
        let points = appended(&file, 0);
        let last: Vec<f64> =
            points[11 * 24..].chunks_exact(8).map(|c| f64::from_le_bytes(c.try_into().unwrap())).collect();
        assert_eq!(last, [sample.xi[2], sample.eta[3], sample.rail_height[2]]);
        let s: Vec<u8> = sample.separation.iter().flat_map(|s| s.to_le_bytes()).collect();
        assert_eq!(appended(&file, 8 + 12 * 24), s);
        let mask = 8 + 12 * 24 + 2 * (8 + 12 * 8) + 2 * (8 + 12 * 24);
        assert_eq!(appended(&file, mask), [0, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1]);
        assert_eq!(appended(&file, mask + 8 + 12)[..2], [HIDDEN, 0]);
        assert!(file.ends_with(b"</VTKFile>\n"));
    }

    #[test]
    fn grids_without_undefined_points_hide_none() {
        let mut sample = Sample::new(2, 2);
        sample.separation[0] = 0.5;
        for writer in [separation_vts, rail_vts, wheel_vts] {
            let mut file = Vec::new();
            writer(&mut file, &header(), &sample.fields()).unwrap();
            assert!(!String::from_utf8_lossy(&file).contains("vtkGhostType"));
        }
    }
}

//! Writes `separation.vtk`: the grid in VTK's legacy format, in one pass, for readers without `.vts` such as
//! meshio.
//!
//! The version is 4.2, the last one that meshio reads. The file is binary, which in this format is always
//! big-endian.

use super::block::{Block, put_bytes, put_f64_be};
use super::model::{GridFields, Header, plain};
use std::io::{self, Write};

/// Writes the rail's surface with the point arrays separation \[mm\] (NaN where undefined) and mask (1 where
/// separation is defined).
///
/// # Errors
/// The errors of the sink.
pub fn separation_vtk(sink: &mut dyn Write, header: &Header, grid: &GridFields) -> io::Result<()> {
    let (n_xi, n_eta) = (grid.xi().len(), grid.eta().len());
    let count = n_xi * n_eta;
    // The format has one line for remarks.
    let remark = plain(&format!(
        "wheelrail {}; mm; s > 0 apart; delta {:?}; scene {}",
        header.version, header.approach, header.scene_hash
    ));
    let mut block = Block::new(sink);
    let head = format!(
        "# vtk DataFile Version 4.2\n{remark}\nBINARY\nDATASET STRUCTURED_GRID\nDIMENSIONS {n_eta} {n_xi} 1\n\
         POINTS {count} double\n"
    );
    block.bytes(head.as_bytes())?;
    for i in 0..n_xi {
        put_f64_be(block.room(24 * n_eta)?, grid.rail_points(i).flatten());
    }
    let scalars = |name: &str, kind: &str| format!("SCALARS {name} {kind} 1\nLOOKUP_TABLE default\n");
    let fields = format!("\nPOINT_DATA {count}\n{}", scalars("separation", "double"));
    block.bytes(fields.as_bytes())?;
    for i in 0..n_xi {
        put_f64_be(block.room(8 * n_eta)?, grid.column(i).iter().copied());
    }
    block.bytes(format!("\n{}", scalars("mask", "unsigned_char")).as_bytes())?;
    for i in 0..n_xi {
        put_bytes(block.room(n_eta)?, grid.mask(i));
    }
    block.bytes(b"\n")?;
    block.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::sample::{Sample, header};

    /// Returns what follows the line `head`, which the file contains once.
    fn after<'a>(file: &'a [u8], head: &str) -> &'a [u8] {
        let found: Vec<_> =
            file.windows(head.len()).enumerate().filter(|(_, w)| *w == head.as_bytes()).collect();
        assert_eq!(found.len(), 1, "{head}");
        &file[found[0].0 + head.len()..]
    }

    #[test]
    fn arrays_are_big_endian_bit_for_bit_and_the_remark_says_what_they_are() {
        let sample = Sample::new(3, 4);
        let mut file = Vec::new();
        separation_vtk(&mut file, &header(), &sample.fields()).unwrap();
        let remark =
            "# vtk DataFile Version 4.2\nwheelrail 0.0.0; mm; s > 0 apart; delta 0.05; scene 0123abcd\n";
        assert!(file.starts_with(remark.as_bytes()));
        let dimensions = after(&file, "\nDIMENSIONS 4 3 1\n");
        let points = after(dimensions, "POINTS 12 double\n");
        let last = [sample.xi[2], sample.eta[3], sample.rail_height[2]].map(f64::to_be_bytes).concat();
        assert_eq!(points[11 * 24..12 * 24], last);
        let values: Vec<u8> = sample.separation.iter().flat_map(|s| s.to_be_bytes()).collect();
        let fields =
            after(&points[12 * 24..], "\nPOINT_DATA 12\nSCALARS separation double 1\nLOOKUP_TABLE default\n");
        assert_eq!(fields[..12 * 8], values);
        let mask = after(&fields[12 * 8..], "\nSCALARS mask unsigned_char 1\nLOOKUP_TABLE default\n");
        assert_eq!(mask, [0, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, b'\n']);
    }
}

//! Writes `separation.wrp`, `conform.wrp`, `countact.wrp`: a fixed-column text format for Fortran programs.
//!
//! ```text
//! WRPATCH    1 mm                            (a8,i4,1x,a8)   magic, version, unit
//!       15                                   (i8)            comment lines that follow
//! # …
//!      128      96                           (2i8)           n_xi n_eta
//! xi0 eta0                                   (2e25.16)       centre of the first cell
//! dxi deta                                   (2e25.16)
//! delta                                      (e25.16)
//! origin, xi axis, eta axis, normal          4 × (3e25.16)   contact frame in rail profile axes (x, y, z)
//! m xi eta s                                 (i2,3e25.16)    n_xi·n_eta records, eta fastest; m = 1 defined
//! END
//! ```
//!
//! The first word tells the three files apart. In `CONFORM` each record has a second line with the rail's
//! outward unit normal n_xi n_zeta, (2x,2e25.16), as a single line would exceed 80 columns. `COUNTACT` has
//! the boundary-fitted cells between the records and END:
//!
//! ```text
//! n_points n_cells                           (2i8)
//! xi eta zeta                                (3e25.16)       n_points nodes on the rail's surface
//! component p1 p2 p3 p4 area                 (i4,4i8,e25.16) n_cells cells; nodes counted from 1
//! ```
//!
//! If m = 0, the number in the column of s is 10 × the largest |s|. A normal that does not exist is 0 0.

use super::super::block::Block;
use super::super::model::{Header, QuadMesh};
use super::number::{Field, WIDTH, field};
use super::text::{Deck, Lattice, line};
use crate::error::{Error, ErrorKind, Result};
use std::fmt::Write as _;
use std::io::{self, Write};

/// Bytes of one grid record: mask, three numbers, line feed.
const RECORD: usize = 2 + 3 * WIDTH + 1;

/// Bytes of a record's second line: two blanks, two numbers, line feed.
const NORMAL: usize = 2 + 2 * WIDTH + 1;

const SEPARATION_NOTES: [&str; 3] = [
    "then n_xi n_eta; first cell's centre; d_xi d_eta; delta; frame's origin,",
    "xi, eta, zeta axes in rail profile axes x (lateral), y (rolling), z (up);",
    "records (i2,3e25.16): m xi eta s; m = 0: undefined, s is a filler",
];

const CONFORM_NOTES: [&str; 2] = [
    "each record has a second line (2x,2e25.16): n_xi n_zeta, the outward unit",
    "normal of the rail (0 0 where it has no surface)",
];

const COUNTACT_NOTES: [&str; 4] = [
    "after the grid the boundary-fitted cells: n_points n_cells (2i8);",
    "nodes (3e25.16): xi eta zeta on the rail's surface;",
    "cells (i4,4i8,e25.16): component, 4 nodes from 1 on, counter-clockwise in",
    "(xi, eta), exact area in the xi-eta plane [mm2]; a tip may repeat a node",
];

/// Writes `separation.wrp`.
///
/// # Errors
/// The errors of the sink.
pub fn separation_wrp(deck: &Deck<'_>, sink: &mut dyn Write) -> io::Result<()> {
    let mut block = Block::new(sink);
    block.bytes(plane_head(deck, "WRPATCH", &[]).as_bytes())?;
    records(deck, &mut block)?;
    block.bytes(b"END\n")?;
    block.finish()
}

/// Writes `conform.wrp`: the records with the rail's normal.
///
/// # Errors
/// The errors of the sink.
pub fn conform_wrp(deck: &Deck<'_>, sink: &mut dyn Write) -> io::Result<()> {
    let mut block = Block::new(sink);
    block.bytes(plane_head(deck, "CONFORM", &CONFORM_NOTES).as_bytes())?;
    for i in 0..deck.xi.len() {
        let [n_xi, n_zeta] = deck.grid.rail_normal()[i].map(|n| field(if n.is_nan() { 0.0 } else { n }));
        let mut second = [b' '; NORMAL];
        second[2..2 + WIDTH].copy_from_slice(&n_xi);
        second[2 + WIDTH..NORMAL - 1].copy_from_slice(&n_zeta);
        second[NORMAL - 1] = b'\n';
        let room = block.room((RECORD + NORMAL) * deck.eta.len())?;
        for (j, place) in room.chunks_exact_mut(RECORD + NORMAL).enumerate() {
            record(deck, i, j, &mut place[..RECORD]);
            place[RECORD..].copy_from_slice(&second);
        }
    }
    block.bytes(b"END\n")?;
    block.finish()
}

/// Writes `countact.wrp`: the records, then the boundary-fitted cells.
///
/// # Errors
/// `InvalidInput` for a mesh that contradicts itself, or is too large for the columns; the errors of the
/// sink.
pub fn countact_wrp(deck: &Deck<'_>, mesh: &QuadMesh, sink: &mut dyn Write) -> io::Result<()> {
    let cells = cells(mesh).map_err(|error| io::Error::new(io::ErrorKind::InvalidInput, error))?;
    let mut block = Block::new(sink);
    block.bytes(plane_head(deck, "COUNTACT", &COUNTACT_NOTES).as_bytes())?;
    records(deck, &mut block)?;
    block.bytes(cells.as_bytes())?;
    block.bytes(b"END\n")?;
    block.finish()
}

fn records(deck: &Deck<'_>, block: &mut Block) -> io::Result<()> {
    for i in 0..deck.xi.len() {
        let room = block.room(RECORD * deck.eta.len())?;
        for (j, place) in room.chunks_exact_mut(RECORD).enumerate() {
            record(deck, i, j, place);
        }
    }
    Ok(())
}

fn record(deck: &Deck<'_>, i: usize, j: usize, place: &mut [u8]) {
    let defined = !deck.grid.column(i)[j].is_nan();
    place[0] = b' ';
    place[1] = b'0' + u8::from(defined);
    let columns: [&Field; 3] = [&deck.xi[i], &deck.eta[j], &deck.column(i)[j]];
    for (k, column) in columns.into_iter().enumerate() {
        place[2 + k * WIDTH..2 + (k + 1) * WIDTH].copy_from_slice(column);
    }
    place[RECORD - 1] = b'\n';
}

/// Returns the head of a deck over the tangent plane.
fn plane_head(deck: &Deck<'_>, magic: &str, notes: &[&str]) -> String {
    let notes = SEPARATION_NOTES.iter().chain(notes).map(|note| (*note).to_string());
    let comments = deck.header.statements().into_iter().chain(notes).collect::<Vec<_>>();
    head(deck.header, magic, &comments, &deck.lattice())
}

/// Returns the head of a deck, up to the contact frame, with these comments.
pub(super) fn head(header: &Header, magic: &str, comments: &[String], grid: &Lattice) -> String {
    let mut text = format!("{magic:<8}{:>4} {:<8}\n{:>8}\n", 1, "mm", comments.len());
    for comment in comments {
        text += "# ";
        text += comment;
        text += "\n";
    }
    let frame = &header.frame;
    // Writing to a String cannot fail.
    let _ = writeln!(text, "{:>8}{:>8}", grid.count[0], grid.count[1]);
    text += &line(&grid.first);
    text += &line(&grid.steps);
    text += &line(&[header.approach]);
    let vectors = [frame.origin.coords, *frame.xi, *frame.eta, *frame.zeta];
    vectors.iter().for_each(|vector| text += &line(vector.as_slice()));
    text
}

/// Returns the boundary-fitted cells as text.
fn cells(mesh: &QuadMesh) -> Result<String> {
    mesh.validate()?;
    // The largest number that the format i8 holds.
    const LARGEST: usize = 99_999_999;
    if mesh.points.len().max(mesh.quads.len()) > LARGEST {
        let found = format!("{} nodes, {} cells", mesh.points.len(), mesh.quads.len());
        return Err(Error::new("countact.wrp", found, format!("at most {LARGEST}"), "use a coarser mesh")
            .of_kind(ErrorKind::Limit));
    }
    let mut text = format!("{:>8}{:>8}\n", mesh.points.len(), mesh.quads.len());
    mesh.points.iter().for_each(|point| text += &line(point.coords.as_slice()));
    for ((quad, &area), component) in mesh.quads.iter().zip(&mesh.area).zip(&mesh.component) {
        let [a, b, c, d] = quad.map(|node| node + 1);
        let _ = write!(text, "{component:>4}{a:>8}{b:>8}{c:>8}{d:>8}");
        text += &line(&[area]);
    }
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::sample::{Sample, header, mesh};

    fn text(write: impl Fn(&Deck, &mut Vec<u8>), sample: &Sample) -> String {
        let (header, grid) = (header(), sample.fields());
        let mut bytes = Vec::new();
        write(&Deck::new(&header, &grid).unwrap(), &mut bytes);
        String::from_utf8(bytes).unwrap()
    }

    fn numbers(line: &str) -> Vec<f64> {
        line.split_whitespace().map(|word| word.parse().unwrap()).collect()
    }

    #[test]
    fn separation_follows_its_grammar() {
        let sample = Sample::new(3, 4);
        let text = text(|deck, out| separation_wrp(deck, out).unwrap(), &sample);
        assert!(text.is_ascii() && text.lines().all(|line| line.len() < 80), "{text}");
        assert!(text.starts_with("WRPATCH    1 mm      \n"), "{text}");
        let lines: Vec<_> = text.lines().collect();
        let body = 2 + lines[1].trim().parse::<usize>().unwrap();
        assert!(lines[2..body].iter().all(|line| line.starts_with("# ")));
        assert_eq!(lines[body], "       3       4");
        assert_eq!(numbers(lines[body + 1]), [sample.xi[0], sample.eta[0]]);
        assert_eq!(numbers(lines[body + 3]), [0.05]);
        assert_eq!(numbers(lines[body + 4]), [10.0, 0.0, -0.2]);
        let records = &lines[body + 8..body + 20];
        let largest = sample.fields().fill_value() / 10.0;
        assert_eq!(numbers(records[0]), [0.0, sample.xi[0], sample.eta[0], 10.0 * largest]);
        for (k, record) in records.iter().enumerate().skip(1) {
            assert_eq!(numbers(record), [1.0, sample.xi[k / 4], sample.eta[k % 4], sample.separation[k]]);
            assert_eq!(&record[..2], " 1");
        }
        assert_eq!(lines[body + 20..], ["END"]);
    }

    #[test]
    fn conform_adds_the_normal_and_countact_the_cells() {
        let sample = Sample::new(3, 4);
        let conform = text(|deck, out| conform_wrp(deck, out).unwrap(), &sample);
        assert!(conform.lines().all(|line| line.len() < 80));
        let lines: Vec<_> = conform.lines().collect();
        let last = lines.len() - 3;
        assert_eq!(numbers(lines[last]), [1.0, sample.xi[2], sample.eta[3], sample.separation[11]]);
        assert_eq!(numbers(lines[last + 1]), sample.rail_normal[2]);

        let written = text(|deck, out| countact_wrp(deck, &mesh(), out).unwrap(), &sample);
        assert!(written.lines().all(|line| line.len() < 80));
        let lines: Vec<_> = written.lines().collect();
        let cells = lines.iter().position(|line| *line == "       9       4").unwrap();
        assert_eq!(numbers(lines[cells + 1]), [-1.0, -1.0, 0.0]);
        assert_eq!(numbers(lines[cells + 13]), [1.0, 5.0, 8.0, 9.0, 6.0, 1.0]);
        assert_eq!(lines[cells + 14], "END");

        let mut broken = mesh();
        broken.quads[0][0] = 9;
        let (header, grid) = (header(), sample.fields());
        let deck = Deck::new(&header, &grid).unwrap();
        assert!(countact_wrp(&deck, &broken, &mut Vec::new()).unwrap_err().to_string().contains("node 9"));
    }

    #[test]
    fn an_empty_patch_is_a_deck_too() {
        let written =
            text(|deck, out| countact_wrp(deck, &QuadMesh::default(), out).unwrap(), &Sample::new(2, 2));
        assert!(written.ends_with("       0       0\nEND\n"));
    }
}

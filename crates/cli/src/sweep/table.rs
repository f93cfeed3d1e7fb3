//! Computes the table of a sweep block by block.

use std::fmt::Write;
use std::sync::Arc;
use std::time::Instant;

use super::super::progress::Progress;
use super::doubts::Tally;
use wheelrail::case::{ApproachBy, Columns, ContactDoubts, SweepDoubts};
use wheelrail::error::Result;
use wheelrail::search::{Conicity, ParallelSweep, Position, Selection, WheelsetOnTrack};

/// Columns of the table.
const HEADER: [&str; 21] = [
    "lateral_mm",
    "yaw_rad",
    "roll_rad",
    "side",
    "contact",
    "z_mm",
    "rail_x_mm",
    "wheel_x_mm",
    "y_mm",
    "contact_angle_rad",
    "rolling_radius_mm",
    "delta_r_mm",
    "conicity",
    "gap_mm",
    "skew_rad",
    "rail_curvature_per_mm",
    "wheel_curvature_per_mm",
    "kink",
    "hertz_xi_mm",
    "hertz_eta_mm",
    "doubt",
];

/// Columns that are empty where there is no number: without a conicity or an ellipse.
const PERHAPS_EMPTY: [&str; 3] = ["conicity", "hertz_xi_mm", "hertz_eta_mm"];

/// The table of a sweep, ready to be computed.
pub(super) struct SweepTable<'a> {
    pub system: &'a Arc<WheelsetOnTrack>,
    pub conicity: Option<Conicity>,
    pub selection: Selection,
    pub positions: Vec<Position>,
    /// Approach or load, and E*, for the contact ellipses; `None` without them.
    pub ellipses: Option<(ApproachBy, f64)>,
    pub doubts: SweepDoubts,
}

/// What one chunk of positions becomes.
#[derive(Default)]
struct Chunk {
    columns: Columns,
    text: String,
    doubts: Tally,
}

impl SweepTable<'_> {
    /// Passes the table's text to `sink`, block by block, until the sink wants no more. Returns the doubts of its positions.
    pub(super) fn blocks(
        &self,
        progress: &Progress,
        mut sink: impl FnMut(&str) -> Result<bool>,
    ) -> Result<Tally> {
        let (start, all, mut doubts) = (Instant::now(), self.positions.len(), Tally::default());
        progress.at(format!("0 of {all} positions"));
        if !sink(&format!("{}\n", HEADER.join(",")))? {
            return Ok(doubts);
        }
        let (sweep, cells) = (self.sweep(&self.positions), cells());
        // One position at a time becomes columns, and these text: threads share the work.
        let lines = |chunk: &mut Chunk, position, rows: &[_]| {
            let Chunk { columns, text, doubts } = chunk;
            columns.clear();
            let push = |(row, found): &(&_, ContactDoubts)| {
                columns.push(position, row, self.ellipses, found.kinds());
            };
            doubts.add(self.doubts.of_rows(rows).inspect(push));
            append(text, &cells, columns);
            Ok(())
        };
        sweep.blocks(lines, |done, chunks: Vec<Chunk>| {
            chunks.iter().for_each(|chunk| doubts.join(&chunk.doubts));
            let wanted = sink(&chunks.iter().map(|chunk| chunk.text.as_str()).collect::<String>())?;
            let rate = done as f64 / start.elapsed().as_secs_f64();
            let step = format!("{done} of {all} positions, {rate:.0} a second");
            progress.share(step, done as f64 / all as f64);
            Ok(wanted)
        })?;
        Ok(doubts)
    }

    /// Gives the sweep over some of the positions.
    pub(super) fn sweep<'a>(&'a self, positions: &'a [Position]) -> ParallelSweep<'a> {
        let conicity = self.conicity.as_ref();
        ParallelSweep { system: self.system, selection: self.selection, conicity, positions }
    }
}

/// What a cell of the text shows.
enum Cell {
    Side,
    Contact,
    Kink,
    Doubt,
    /// The quantity with this index; the flag tells whether the cell is empty where there is no number.
    Quantity(usize, bool),
}

/// Gives the cells of a line, in the order of [`HEADER`].
fn cells() -> Vec<Cell> {
    let quantity = |name: &str| Columns::QUANTITIES.iter().position(|known| *known == name);
    let cell = |name: &&str| match *name {
        "side" => Some(Cell::Side),
        "contact" => Some(Cell::Contact),
        "kink" => Some(Cell::Kink),
        "doubt" => Some(Cell::Doubt),
        name => quantity(name).map(|index| Cell::Quantity(index, PERHAPS_EMPTY.contains(&name))),
    };
    HEADER.iter().filter_map(cell).collect()
}

/// Adds the rows of some columns as text.
fn append(out: &mut String, cells: &[Cell], columns: &Columns) {
    for row in 0..columns.rows() {
        for (k, cell) in cells.iter().enumerate() {
            if k > 0 {
                out.push(',');
            }
            let _ = match cell {
                Cell::Side => write!(out, "{}", if columns.right[row] { "right" } else { "left" }),
                Cell::Contact => write!(out, "{}", columns.contact[row]),
                Cell::Kink => write!(out, "{}", u8::from(columns.kink[row])),
                Cell::Doubt => write!(out, "{}", columns.doubt[row]),
                Cell::Quantity(index, perhaps_empty) => match columns.quantities[*index][row] {
                    value if *perhaps_empty && value.is_nan() => Ok(()),
                    value => write!(out, "{value}"),
                },
            };
        }
        out.push('\n');
    }
}

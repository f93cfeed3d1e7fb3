//! Computes a sweep block by block: its table, and the positions that are drawn.

use std::sync::Arc;
use std::time::Instant;

use super::super::progress::Progress;
use wheelrail::case::{
    ApproachBy, ContactDoubts, DoubtSet, MOST_DRAWN, RollEnds, SideLandmarks, SweepColumns, Tally,
};
use wheelrail::error::Result;
use wheelrail::search::{Conicity, ParallelSweep, Position, Selection, WheelsetOnTrack};

/// A sweep, ready to be computed.
pub(super) struct SweepTable<'a> {
    pub system: &'a Arc<WheelsetOnTrack>,
    pub conicity: Option<Conicity>,
    pub selection: Selection,
    pub positions: Vec<Position>,
    /// Approach or load, and E*, for the contact ellipses; `None` without them.
    pub ellipses: Option<(ApproachBy, f64)>,
    pub landmarks: &'a SideLandmarks,
    /// Whether positions are drawn.
    pub drawn: bool,
}

/// The results of a chunk of positions, or of all.
#[derive(Default)]
pub(super) struct SweptChunks {
    /// The rows of the position that is being computed.
    columns: SweepColumns,
    text: String,
    /// The doubts of all positions.
    pub doubts: Tally,
    /// Where the roll may end between positions.
    pub roll_ends: RollEnds,
    /// The contacts of the positions that are drawn, which are numbered among themselves.
    pub drawn: SweepColumns,
}

impl SweepTable<'_> {
    /// Computes the sweep and passes the table's text to `sink`, block by block, until the sink wants no more. Returns the
    /// doubts, and what is drawn.
    pub(super) fn blocks(
        &self,
        progress: &Progress,
        mut sink: impl FnMut(&str) -> Result<bool>,
    ) -> Result<SweptChunks> {
        let (start, all, mut swept) = (Instant::now(), self.positions.len(), SweptChunks::default());
        progress.at(format!("0 of {all} positions"));
        if !sink(&SweepColumns::csv_head())? {
            return Ok(swept);
        }
        let (conicity, stride) = (self.conicity.as_ref(), self.stride());
        let sweep = ParallelSweep {
            system: self.system,
            selection: self.selection,
            conicity,
            positions: &self.positions,
        };
        // One position at a time becomes columns, and these text: threads share the work.
        let make = |chunk: &mut SweptChunks, position: usize, rows: &[_]| {
            let SweptChunks { columns, text, doubts, roll_ends, drawn } = chunk;
            columns.clear();
            let push = |(row, found): &(&_, ContactDoubts)| {
                columns.push(position, row, self.ellipses, found.kinds());
                if self.drawn && position.is_multiple_of(stride) {
                    drawn.push(position / stride, row, None, DoubtSet::default());
                }
            };
            doubts.add(self.landmarks.of_rows(rows).inspect(push));
            roll_ends.add(&self.positions[position], rows);
            columns.append_csv(text);
            Ok(())
        };
        sweep.blocks(make, |done, chunks: Vec<SweptChunks>| {
            for chunk in &chunks {
                swept.doubts.join(&chunk.doubts);
                swept.roll_ends.join(&chunk.roll_ends);
                swept.drawn.extend(&chunk.drawn);
            }
            let wanted = sink(&chunks.iter().map(|chunk| chunk.text.as_str()).collect::<String>())?;
            let rate = done as f64 / start.elapsed().as_secs_f64();
            let step = format!("{done} of {all} positions, {rate:.0} a second");
            progress.share(step, done as f64 / all as f64);
            Ok(wanted)
        })?;
        Ok(swept)
    }

    /// Gives the lateral displacements \[mm\] of the positions that are drawn.
    pub(super) fn drawn_lateral(&self) -> Vec<f64> {
        self.positions.iter().step_by(self.stride()).map(|position| position.lateral).collect()
    }

    /// Gives the number of positions from one that is drawn to the next.
    fn stride(&self) -> usize {
        self.positions.len().div_ceil(MOST_DRAWN).max(1)
    }
}

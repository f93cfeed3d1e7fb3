//! A sweep over many positions, on all threads.

use rayon::prelude::*;

use super::position::{Position, Roll};
use super::sweep::{Conicity, Sweep, SweepRow};
use super::touch::Selection;
use super::wheelset::WheelsetOnTrack;
use crate::error::{Result, in_order};

/// Positions of one block: enough work for all threads, and little memory.
const BLOCK: usize = 8192;

/// Positions that one thread takes at a time.
const CHUNK: usize = 256;

/// A sweep over many positions, run on all threads.
#[derive(Debug, Clone, Copy)]
pub struct ParallelSweep<'a> {
    /// The wheelset on its track.
    pub system: &'a WheelsetOnTrack,
    /// Which places of contact are reported.
    pub selection: Selection,
    /// The equivalent conicity of the system, if it is asked for.
    pub conicity: Option<&'a Conicity>,
    /// The positions, in the order of the rows.
    pub positions: &'a [Position],
}

impl ParallelSweep<'_> {
    /// Hands the contacts of all positions to `sink`, block by block in the order of the positions, as long as it returns
    /// true. `make` turns one position into what a block holds: it gets the number of the position from 0, its rows, and
    /// what it has made of the positions before it in the same chunk. `sink` gets the number of positions done, and the
    /// chunks.
    ///
    /// It runs on the threads of the current rayon pool; any number of threads gives the same bits. Cost: that of the
    /// searches, [`Sweep::position`], over the number of threads.
    ///
    /// # Errors
    /// The errors of `make` and `sink`; a position with values that are not finite, or angles beyond ±0.5 rad.
    pub fn blocks<T: Send + Default>(
        &self,
        make: impl Fn(&mut T, usize, &[SweepRow]) -> Result<()> + Sync,
        mut sink: impl FnMut(usize, Vec<T>) -> Result<bool>,
    ) -> Result<()> {
        let mut done = 0;
        for block in self.positions.chunks(BLOCK) {
            let chunk = |(k, chunk)| self.chunk(done + k * CHUNK, chunk, &make);
            let chunks = in_order(block.par_chunks(CHUNK).enumerate().map(chunk))?;
            done += block.len();
            if !sink(done, chunks)? {
                break;
            }
        }
        Ok(())
    }

    /// Makes one chunk; `before` positions come before it.
    fn chunk<T: Default>(
        &self,
        before: usize,
        positions: &[Position],
        make: impl Fn(&mut T, usize, &[SweepRow]) -> Result<()>,
    ) -> Result<T> {
        let mut sweep = Sweep::new(self.system, self.selection, self.conicity);
        let (mut rows, mut made) = (Vec::new(), T::default());
        for (k, position) in positions.iter().enumerate() {
            rows.clear();
            let number = before + k;
            sweep
                .position(position, &mut rows)
                .map_err(|error| error.within(format!("position {}", number + 1)))?;
            make(&mut made, number, &rows)?;
        }
        Ok(made)
    }
}

/// Lists the positions whose roll is not given: those that have a conicity.
pub fn free(positions: &[Position]) -> impl Iterator<Item = &Position> {
    positions.iter().filter(|position| !matches!(position.roll, Roll::Fixed(_)))
}

/// Tabulates the equivalent conicity up to the largest amplitude of the positions whose roll is not given: all of them
/// have to solve it, or all to neglect it. `None` where no such position is off the centre. `progress` is told
/// the number of searches done and the most there will be.
///
/// # Errors
/// The errors of [`Conicity::new`].
pub fn conicity_over(
    system: &WheelsetOnTrack,
    positions: &[Position],
    progress: &mut dyn FnMut(usize, usize),
) -> Result<Option<Conicity>> {
    let amplitude = free(positions).fold(0.0, |most: f64, position| most.max(position.lateral.abs()));
    let Some(first) = free(positions).next().filter(|_| amplitude > 0.0) else { return Ok(None) };
    Conicity::told(system, amplitude, first.roll, progress).map(Some)
}

//! The table: cells with their polynomials, and how they are looked up.

use rayon::prelude::*;

use super::cell::{Beginning, COEFFICIENTS, Cell, share};
use super::quantity::{MOST, Quantity};
use super::read::{Parsed, parse};
use crate::error::{Error, Result};

/// A contact table.
///
/// # Examples
/// ```
/// # use wheelrail::{Pair, Position, RailDistance, Roll, Selection, WheelDistance, WheelsetOnTrack, standards};
/// use wheelrail::table::{Asked, build};
///
/// let pair = Pair::new(standards::rail("60E1")?, standards::wheel("S1002")?, 460.0)?;
/// let system = WheelsetOnTrack::new(&pair, RailDistance::Spacing(1500.0), WheelDistance::Spacing(1500.0))?;
/// let asked = Asked { lateral: [-1.0, 1.0], yaw: 0.0, roll: Roll::Solve, tolerance: 1e-3, pressed: None };
/// let table = build(&system, &asked)?;
///
/// let radius = table.number("rolling_radius_mm", Some(true)).expect("a column of every table");
/// let mut values = vec![0.0; table.quantities().len()];
/// table.fill(0.25, &mut values);
/// let position = Position { lateral: 0.25, yaw: 0.0, roll: Roll::Solve };
/// let mut search = system.search();
/// let touch = search.touch(&position, &Selection { within: 0.0, apart: 0.0 })?.expect("a wheelset on its track");
/// let direct = touch.sides[1].touch.contacts[0].rolling_radius;
/// assert!((values[radius] - direct).abs() <= table.quantities()[radius].error);
/// # Ok::<(), wheelrail::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct ContactTable {
    lateral: [f64; 2],
    yaw: f64,
    radius: f64,
    tolerance: f64,
    quantities: Vec<Quantity>,
    cells: Vec<Cell>,
    /// Coefficient number k of the powers of t of quantity q in cell c, at (c · [`COEFFICIENTS`] + k) · quantities + q; not a number
    /// where the quantity does not exist.
    coefficients: Vec<f64>,
    /// For equal parts of the range: the cell in which each begins.
    hints: Vec<u32>,
}

/// Displacements that one thread takes at a time.
const TOGETHER: usize = 4096;

/// Displacements whose values are found before they are put into columns: 7 kB.
const ROWS: usize = 32;

/// Parts of the range for each cell, with whose help a cell is found: one or two steps from the hint are enough.
const HINTS: usize = 4;

impl ContactTable {
    /// Joins the cells of a table, in ascending order.
    ///
    /// # Errors
    /// Cells that do not ascend or do not fill the range; another number of coefficients.
    pub(super) fn of(
        (lateral, yaw, radius, tolerance): ([f64; 2], f64, f64, f64),
        quantities: Vec<Quantity>,
        cells: Vec<Cell>,
        coefficients: Vec<f64>,
    ) -> Result<Self> {
        let wrong =
            |found: String, expected: &str| Error::new("table", found, expected, "write the table anew");
        let ascends = cells.iter().all(|cell| cell.lateral[0] <= cell.lateral[1])
            && cells.windows(2).all(|pair| pair[0].lateral[1] <= pair[1].lateral[0]);
        let ends = [cells.first(), cells.last()].map(|cell| cell.map(|cell| cell.lateral));
        let [Some([first, _]), Some([_, last])] = ends else {
            return Err(wrong("no cell".into(), "cells over the whole range"));
        };
        if !ascends || first != lateral[0] || last != lateral[1] || first >= last {
            return Err(wrong("cells out of order".into(), "ascending cells over the whole range"));
        }
        if coefficients.len() != cells.len() * COEFFICIENTS * quantities.len() {
            return Err(wrong(format!("{} coefficients", coefficients.len()), "9 of each quantity and cell"));
        }
        let mut table =
            Self { lateral, yaw, radius, tolerance, quantities, cells, coefficients, hints: Vec::new() };
        table.hints = table.found_hints();
        Ok(table)
    }

    /// Reads a table from the text of `table.wrp`; [`crate::docs::tables`] has the grammar.
    ///
    /// # Errors
    /// Another grammar, version or order, with the line; a file that was cut off; more than a million cells.
    pub fn read(text: &str) -> Result<Self> {
        let Parsed { about, quantities, cells, coefficients } = parse(text)?;
        Self::of(about, quantities, cells, coefficients)
    }

    fn found_hints(&self) -> Vec<u32> {
        let count = HINTS * self.cells.len();
        let [from, to] = self.lateral;
        let mut cell = 0;
        let begin = |k: usize| from + (to - from) * (k as f64 / count as f64);
        (0..count)
            .map(|k| {
                // A rounding lower, so that no displacement of the part lies before its hint.
                let y = begin(k.saturating_sub(1));
                while cell + 1 < self.cells.len() && self.cells[cell + 1].lateral[0] <= y {
                    cell += 1;
                }
                cell as u32
            })
            .collect()
    }

    /// Returns the range of lateral displacements \[mm\].
    pub fn lateral(&self) -> [f64; 2] {
        self.lateral
    }

    /// Returns the yaw \[rad\] that all displacements have.
    pub fn yaw(&self) -> f64 {
        self.yaw
    }

    /// Returns the nominal rolling radius \[mm\], over which the tolerance of angles is taken.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Returns the tolerance of lengths \[mm\].
    pub fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// Returns the quantities, in the order of the values of [`ContactTable::fill`].
    pub fn quantities(&self) -> &[Quantity] {
        &self.quantities
    }

    /// Returns the cells in ascending order.
    pub fn cells(&self) -> &[Cell] {
        &self.cells
    }

    /// Returns the number of a quantity: of the right-hand side, the left-hand side, or the wheelset (`None`).
    pub fn number(&self, name: &str, right: Option<bool>) -> Option<usize> {
        self.quantities.iter().position(|quantity| quantity.name == name && quantity.right == right)
    }

    /// Returns the coefficients of 1, t, … t⁸ of a quantity over a cell, with t from −1 to 1 over the cell; not numbers where the quantity
    /// does not exist.
    pub fn coefficients(&self, cell: usize, quantity: usize) -> [f64; COEFFICIENTS] {
        let count = self.quantities.len();
        std::array::from_fn(|k| self.coefficients[(cell * COEFFICIENTS + k) * count + quantity])
    }

    /// Returns the number of the cell of a lateral displacement \[mm\]; `None` outside the range.
    pub fn cell(&self, lateral: f64) -> Option<usize> {
        let [from, to] = self.lateral;
        if !(from..=to).contains(&lateral) {
            return None;
        }
        let count = self.hints.len();
        let part = ((lateral - from) / (to - from) * count as f64) as usize;
        let mut cell = self.hints[part.min(count - 1)] as usize;
        while self.cells.get(cell + 1).is_some_and(|next| next.lateral[0] <= lateral) {
            cell += 1;
        }
        Some(cell)
    }

    /// Gives all quantities at a lateral displacement \[mm\]: `out` has their number. What does not exist is not a number: outside the
    /// range, where a wheel is off its rail, curvatures at a kink.
    ///
    /// Accuracy: the stated error of each quantity, but for [`BREAK`](super::BREAK) around hops and joints. Cost: some 50 ns.
    pub fn fill(&self, lateral: f64, out: &mut [f64]) {
        let Some(number) = self.cell(lateral) else {
            out.fill(f64::NAN);
            return;
        };
        let t = share(self.cells[number].lateral, lateral);
        let count = self.quantities.len();
        let rows = &self.coefficients[number * COEFFICIENTS * count..][..COEFFICIENTS * count];
        let mut rows = rows.chunks_exact(count).rev();
        rows.next().into_iter().for_each(|highest| out.copy_from_slice(highest));
        for row in rows {
            out.iter_mut().zip(row).for_each(|(value, c)| *value = *value * t + c);
        }
    }

    /// Gives the quantities with these numbers at many lateral displacements \[mm\]: `out` has the values of the first at all
    /// displacements, then those of the second, and so on. It runs on the threads of the current rayon pool; any number of threads gives
    /// the bits of [`ContactTable::fill`].
    pub fn fill_many(&self, lateral: &[f64], numbers: &[usize], out: &mut [f64]) {
        let mut parts: Vec<Vec<&mut [f64]>> = Vec::new();
        parts.resize_with(lateral.len().div_ceil(TOGETHER), Vec::new);
        for column in out.chunks_exact_mut(lateral.len().max(1)) {
            parts.iter_mut().zip(column.chunks_mut(TOGETHER)).for_each(|(part, piece)| part.push(piece));
        }
        let parts = parts.into_par_iter().zip(lateral.par_chunks(TOGETHER));
        parts.for_each(|(mut columns, lateral)| self.fill_columns(lateral, numbers, &mut columns));
    }

    /// Fills a part of each column, by rows that stay in the nearest cache.
    fn fill_columns(&self, lateral: &[f64], numbers: &[usize], columns: &mut [&mut [f64]]) {
        let mut rows = [[0.0; MOST]; ROWS];
        let count = self.quantities.len();
        for (k, lateral) in lateral.chunks(ROWS).enumerate() {
            rows.iter_mut().zip(lateral).for_each(|(row, y)| self.fill(*y, &mut row[..count]));
            for (column, &number) in columns.iter_mut().zip(numbers) {
                let places = &mut column[k * ROWS..][..lateral.len()];
                places.iter_mut().zip(&rows).for_each(|(place, row)| *place = row[number]);
            }
        }
    }

    /// Returns the intervals of displacements \[mm\] in which a wheel is off its rail, in ascending order: the table has nothing there.
    pub fn off_rail(&self) -> impl Iterator<Item = [f64; 2]> {
        self.cells.iter().filter(|cell| !cell.touches).map(|cell| cell.lateral)
    }

    /// Returns the displacements \[mm\] of hops, joints or edges between cells, in ascending order.
    pub fn places(&self, kind: Beginning) -> impl Iterator<Item = f64> {
        self.cells.iter().skip(1).filter(move |cell| cell.begins == kind).map(|cell| cell.lateral[0])
    }
}

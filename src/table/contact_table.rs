//! The table: cells with their polynomials, and how they are looked up.

use std::array::from_fn;

use rayon::prelude::*;

use super::about::About;
use super::cell::{Beginning, COEFFICIENTS, Cell};
use super::curve::{Curve, share};
use super::quantity::{MOST, TableQuantity};
use super::read::{Parsed, parse};
use super::tree::{Fork, PlanePart, Tree};
use crate::error::{Error, Result};
use crate::numerics::interval::Interval;

/// A contact table.
///
/// # Examples
/// ```
/// # use wheelrail::{Interval, Pair, Position, RailDistance, Roll, Selection, WheelDistance, WheelsetOnTrack, standards};
/// use wheelrail::table::{Asked, build};
///
/// let pair = Pair::new(standards::rail("60E1")?, standards::wheel("S1002")?, 460.0)?;
/// let system = WheelsetOnTrack::new(&pair, RailDistance::Spacing(1500.0), WheelDistance::Spacing(1500.0))?;
/// let (lateral, yaw) = (Interval::new(-1.0, 1.0), Interval::of(0.0));
/// let asked = Asked { lateral, yaw, roll: Roll::Solve, tolerance: 1e-3, pressed: None };
/// let table = build(&system, &asked)?;
///
/// let radius = table.number("rolling_radius_mm", Some(true)).expect("a column of every table");
/// let mut values = vec![0.0; table.quantities().len()];
/// table.fill(0.25, 0.0, &mut values);
/// let position = Position { lateral: 0.25, yaw: 0.0, roll: Roll::Solve };
/// let mut search = system.search();
/// let touch = search.touch(&position, &Selection { within: 0.0, apart: 0.0 })?;
/// let direct = touch.sides[1].touch.contacts[0].rolling_radius;
/// assert!((values[radius] - direct).abs() <= table.quantities()[radius].error);
/// # Ok::<(), wheelrail::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct ContactTable {
    about: About,
    quantities: Vec<TableQuantity>,
    curves: Vec<Curve>,
    forks: Vec<Fork>,
    cells: Vec<Cell>,
    /// Coefficient number k of the powers of t, of number j of those of u, of quantity q in cell c, at
    /// ((c · powers of u + j) · [`COEFFICIENTS`] + k) · stride + q; NaN where the quantity does not exist.
    coefficients: Vec<f64>,
}

/// Distance \[mm\] from a hop at which the values on both sides of it are looked up: beyond what it is known to.
const BESIDE: f64 = 1e-6;

/// Quantities that are computed together.
const LANES: usize = 8;

/// Positions that one thread takes at a time: their values, 500 kB, stay in its cache until all are computed.
const TOGETHER: usize = 2048;

impl ContactTable {
    /// Makes a table of a tree.
    ///
    /// # Errors
    /// Parts, curves or coefficients that do not fit each other.
    pub(super) fn of(about: About, quantities: Vec<TableQuantity>, tree: Tree) -> Result<Self> {
        let wrong =
            |found: String, expected: &str| Error::new("table", found, expected, "write the table anew");
        let Tree { curves, forks, cells, coefficients: by_cell } = tree;
        if cells.is_empty() || by_cell.len() != cells.len() {
            return Err(wrong("no cell".into(), "cells over the whole range"));
        }
        let known = |fork: usize, part: &PlanePart| match *part {
            PlanePart::Fork(next) => next > fork && next < forks.len(),
            PlanePart::Cell(cell) => cell < cells.len(),
        };
        for (f, fork) in forks.iter().enumerate() {
            if !fork.parts.iter().all(|part| known(f, part)) || fork.curve.is_some_and(|c| c >= curves.len())
            {
                return Err(wrong(format!("fork {}", f + 1), "parts and curves of the table"));
            }
        }
        if let Some(c) = (0..cells.len()).find(|&c| cells[c].curves.iter().any(|k| *k >= curves.len())) {
            return Err(wrong(format!("cell {}", c + 1), "curves of the table"));
        }
        let (rows, count) = (about.yaw_coefficients() * COEFFICIENTS, quantities.len());
        let stride = stride(&quantities);
        let mut coefficients = vec![f64::NAN; cells.len() * rows * stride];
        for (own, all) in by_cell.iter().zip(coefficients.chunks_exact_mut((rows * stride).max(1))) {
            // A cell under one yaw in a table over many has only the first coefficients of the yaw.
            if !own.is_empty() {
                all.fill(0.0);
            }
            for (row, out) in own.iter().zip(all.chunks_exact_mut(stride)) {
                out[..count].copy_from_slice(&row[..count]);
            }
        }
        Ok(Self { about, quantities, curves, forks, cells, coefficients })
    }

    /// Reads a table from the text of `table.wrp`; [`crate::docs::tables`] has the grammar.
    ///
    /// # Errors
    /// Another grammar, version or order, with the line; a file that was cut off; more than a million cells.
    pub fn read(text: &str) -> Result<Self> {
        let Parsed { about, quantities, tree } = parse(text)?;
        Self::of(about, quantities, tree)
    }

    /// Returns the ranges, the nominal radius and the tolerance of the table.
    pub fn about(&self) -> About {
        self.about
    }

    /// Returns the quantities, in the order of the values of [`ContactTable::fill`].
    pub fn quantities(&self) -> &[TableQuantity] {
        &self.quantities
    }

    /// Lists where the roll jumps under a yaw \[rad\]: displacement \[mm\] and jump \[rad\], + where it grows. There ends the one roll at
    /// which both wheels touch, and contact goes on at another one.
    pub fn roll_jumps(&self, yaw: f64) -> Vec<[f64; 2]> {
        let roll = |lateral: f64| {
            let mut values = vec![f64::NAN; self.quantities.len()];
            self.fill(lateral, yaw, &mut values);
            values[0]
        };
        let jump = |lateral: f64| [lateral, roll(lateral + BESIDE) - roll(lateral - BESIDE)];
        let jumps = self.places(Beginning::Hop, yaw).into_iter().map(jump);
        jumps.filter(|[_, jump]| jump.abs() > self.quantities[0].tolerance).collect()
    }

    /// Returns the cells, in ascending order under one yaw.
    pub fn cells(&self) -> &[Cell] {
        &self.cells
    }

    /// Returns the curves at which cells begin and end.
    pub fn curves(&self) -> &[Curve] {
        &self.curves
    }

    /// Returns the forks on the way to cells. The way begins at the first; without any there is one cell. What a fork leads to has a
    /// greater number.
    pub fn forks(&self) -> &[Fork] {
        &self.forks
    }

    /// Returns the number of the quantity with this name, of the right-hand side (`true`), the left-hand side or the wheelset (`None`);
    /// `None` if the table does not have it.
    pub fn number(&self, name: &str, right: Option<bool>) -> Option<usize> {
        self.quantities.iter().position(|quantity| quantity.name == name && quantity.right == right)
    }

    /// Returns the coefficients of 1, t, … t⁸ of a quantity over a cell that belong to u^j, with t from −1 to 1 from curve to curve and
    /// u over the yaws of the cell; NaN where the quantity does not exist.
    pub fn coefficients(&self, cell: usize, quantity: usize, j: usize) -> [f64; COEFFICIENTS] {
        let (stride, rows) = (stride(&self.quantities), self.about.yaw_coefficients());
        from_fn(|k| self.coefficients[((cell * rows + j) * COEFFICIENTS + k) * stride + quantity])
    }

    /// Returns the number of the cell of a lateral displacement \[mm\] and a yaw \[rad\]; `None` outside the range.
    #[inline(always)]
    pub fn cell(&self, lateral: f64, yaw: f64) -> Option<usize> {
        if !self.about.lateral.contains(lateral) || !self.about.yaw.contains(yaw) {
            return None;
        }
        let mut part = if self.forks.is_empty() { PlanePart::Cell(0) } else { PlanePart::Fork(0) };
        loop {
            match part {
                PlanePart::Cell(cell) => return Some(cell),
                PlanePart::Fork(fork) => {
                    let fork = &self.forks[fork];
                    let above = match fork.curve {
                        Some(curve) => lateral >= self.curves[curve].at(yaw),
                        None => yaw >= fork.yaw,
                    };
                    part = fork.parts[usize::from(above)];
                }
            }
        }
    }

    /// Returns the displacements \[mm\] at which a cell begins and ends under a yaw \[rad\].
    #[inline(always)]
    pub fn ends(&self, cell: usize, yaw: f64) -> Interval {
        self.cells[cell].curves.map(|curve| self.curves[curve].at(yaw)).into()
    }

    /// Returns how a cell begins.
    pub fn begins(&self, cell: usize) -> Beginning {
        self.curves[self.cells[cell].curves[0]].kind
    }

    /// Gives all quantities at a lateral displacement \[mm\] and a yaw \[rad\]; `out` has a place for each. What does not exist is NaN:
    /// everything outside the range or where a wheel is off its rail, curvatures at a kink.
    ///
    /// Accuracy: the stated error of each quantity, except within [`About::beside_curves`] of hops and joints. Cost: some 50 ns under
    /// one yaw, 300 ns over a range of yaws.
    pub fn fill(&self, lateral: f64, yaw: f64, out: &mut [f64]) {
        match self.cell(lateral, yaw) {
            Some(cell) => self.fill_from(cell, lateral, yaw, out),
            None => out.fill(f64::NAN),
        }
    }

    /// Gives all quantities at a position in a cell.
    #[inline(always)]
    fn fill_from(&self, cell: usize, lateral: f64, yaw: f64, out: &mut [f64]) {
        let stride = stride(&self.quantities);
        let count = self.about.yaw_coefficients() * COEFFICIENTS * stride;
        let rows = &self.coefficients[cell * count..][..count];
        let t = share(self.ends(cell, yaw), lateral).clamp(-1.0, 1.0);
        let u = share(self.cells[cell].yaw, yaw);
        for (group, out) in out.chunks_mut(LANES).enumerate() {
            let mut values = [0.0; LANES];
            for k in (0..COEFFICIENTS).rev() {
                let mut sums = [0.0; LANES];
                for row in rows.chunks_exact(COEFFICIENTS * stride).rev() {
                    let own = &row[k * stride + LANES * group..][..LANES];
                    sums = from_fn(|i| sums[i] * u + own[i]);
                }
                values = from_fn(|i| values[i] * t + sums[i]);
            }
            out.copy_from_slice(&values[..out.len()]);
        }
    }

    /// Gives the quantities with these numbers at many lateral displacements \[mm\] and as many yaws \[rad\], or one yaw for all. `out`
    /// gets the values of the first quantity at all positions, then those of the second, and so on. It runs on the threads of the
    /// current rayon pool; any number of threads gives the bits of [`ContactTable::fill`].
    ///
    /// # Errors
    /// A number of yaws or of values that does not fit, and a number of no quantity.
    pub fn fill_many(&self, lateral: &[f64], yaw: &[f64], numbers: &[usize], out: &mut [f64]) -> Result<()> {
        let each = lateral.len();
        if out.len() != numbers.len() * each {
            let expected =
                format!("{}, {each} of each of {} quantities", numbers.len() * each, numbers.len());
            return Err(ill_fitting("out", out.len(), expected));
        }
        let mut columns: Vec<&mut [f64]> = out.chunks_exact_mut(each.max(1)).collect();
        self.fill_columns(lateral, yaw, numbers, &mut columns)
    }

    /// Gives the quantities as [`ContactTable::fill_many`] does, but the values of each in a slice of its own, so that many positions can
    /// be filled part by part.
    ///
    /// # Errors
    /// A number of yaws, of columns or of values that does not fit, and a number of no quantity.
    pub fn fill_columns(
        &self,
        lateral: &[f64],
        yaw: &[f64],
        numbers: &[usize],
        columns: &mut [&mut [f64]],
    ) -> Result<()> {
        let each = lateral.len();
        if yaw.len() != 1 && yaw.len() != each {
            return Err(ill_fitting("yaw", yaw.len(), format!("one, or {each} as of lateral")));
        }
        if let Some(number) = numbers.iter().find(|number| **number >= self.quantities.len()) {
            let expected = format!("a number below {}", self.quantities.len());
            return Err(Error::new("numbers", number.to_string(), expected, "take those of `quantities`"));
        }
        if each > 0 && columns.len() != numbers.len() {
            let (found, expected) = (format!("{} columns", columns.len()), format!("{}", numbers.len()));
            return Err(Error::new("columns", found, expected, "give one for each of `numbers`"));
        }
        if let Some(other) = columns.iter().find(|column| column.len() != each) {
            return Err(ill_fitting("columns", other.len(), format!("{each} as of lateral")));
        }
        let mut parts: Vec<Vec<&mut [f64]>> = Vec::new();
        parts.resize_with(each.div_ceil(TOGETHER), Vec::new);
        for column in columns {
            parts.iter_mut().zip(column.chunks_mut(TOGETHER)).for_each(|(part, piece)| part.push(piece));
        }
        let arch = pulp::Arch::new();
        let parts = parts.into_par_iter().zip(lateral.par_chunks(TOGETHER)).enumerate();
        parts.for_each(|(k, (mut columns, lateral))| {
            let yaw = if let [one] = yaw {
                std::slice::from_ref(one)
            } else {
                &yaw[k * TOGETHER..][..lateral.len()]
            };
            arch.dispatch(ColumnsPart { table: self, lateral, yaw, numbers, columns: &mut columns });
        });
        Ok(())
    }

    /// Returns the numbers of the cells under a yaw \[rad\], in ascending order.
    fn under(&self, yaw: f64) -> Vec<usize> {
        let (mut cells, mut open) = (Vec::new(), Vec::new());
        open.push(if self.forks.is_empty() { PlanePart::Cell(0) } else { PlanePart::Fork(0) });
        while let Some(part) = open.pop() {
            match part {
                PlanePart::Cell(cell) => cells.push(cell),
                PlanePart::Fork(fork) => {
                    let Fork { curve, yaw: at, parts: [below, above] } = self.forks[fork];
                    match curve {
                        Some(_) => open.extend([above, below]),
                        None => open.push(if yaw >= at { above } else { below }),
                    }
                }
            }
        }
        cells
    }

    /// Returns the intervals of displacements \[mm\] in which a wheel is off its rail under a yaw \[rad\], in ascending order; the table
    /// has no values there.
    pub fn off_rail(&self, yaw: f64) -> Vec<Interval> {
        let off = self.under(yaw).into_iter().filter(|cell| !self.cells[*cell].touches);
        off.map(|cell| self.ends(cell, yaw)).collect()
    }

    /// Returns the intervals of displacements \[mm\] in which a wheel is off its rail under some yaw, in ascending order: those of each
    /// cell under the two ends and the middle of its yaws.
    pub fn off_rail_somewhere(&self) -> Vec<Interval> {
        let off = (0..self.cells.len()).filter(|cell| !self.cells[*cell].touches);
        let mut ranges: Vec<Interval> = off
            .map(|cell| {
                let yaw = self.cells[cell].yaw;
                let ends = [yaw.low, yaw.at(0.5), yaw.high].map(|yaw| self.ends(cell, yaw));
                ends.into_iter().fold(Interval::NONE, Interval::hull)
            })
            .collect();
        ranges.sort_by(|a, b| a.low.total_cmp(&b.low));
        ranges.dedup_by(|next, before| {
            let joined = next.low <= before.high;
            if joined {
                before.high = before.high.max(next.high);
            }
            joined
        });
        ranges
    }

    /// Returns the displacements \[mm\] of hops, joints or edges under a yaw \[rad\], in ascending order, without the ends of the range.
    pub fn places(&self, kind: Beginning, yaw: f64) -> Vec<f64> {
        let cells = self.under(yaw).into_iter().skip(1);
        cells.filter(|cell| self.begins(*cell) == kind).map(|cell| self.ends(cell, yaw).low).collect()
    }
}

/// Gives the number of coefficients in a row: that of the quantities, rounded up to whole lanes.
#[inline(always)]
fn stride(quantities: &[TableQuantity]) -> usize {
    quantities.len().next_multiple_of(LANES)
}

/// Makes the error of an argument with so many values.
fn ill_fitting(place: &str, found: usize, expected: String) -> Error {
    Error::new(place, format!("{found} values"), expected, "give as many as there are positions")
}

/// A part of each column. The work on it is compiled for each set of vector instructions.
struct ColumnsPart<'p, 'c> {
    table: &'p ContactTable,
    lateral: &'p [f64],
    yaw: &'p [f64],
    numbers: &'p [usize],
    columns: &'p mut [&'c mut [f64]],
}

impl pulp::WithSimd for ColumnsPart<'_, '_> {
    type Output = ();

    /// Goes from cell to cell: the coefficients of one over yaw, 12 kB, are then read from the nearest cache.
    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        let Self { table, lateral, yaw, numbers, columns } = self;
        let mut order = Vec::with_capacity(lateral.len());
        for (i, y) in lateral.iter().enumerate() {
            let yaw = if let [one] = yaw { *one } else { yaw[i] };
            order.push((table.cell(*y, yaw), i));
        }
        order.sort_unstable();
        let mut row = [0.0; MOST];
        let row = &mut row[..table.quantities.len()];
        for (cell, i) in order {
            let yaw = if let [one] = yaw { *one } else { yaw[i] };
            match cell {
                Some(cell) => table.fill_from(cell, lateral[i], yaw, row),
                None => row.fill(f64::NAN),
            }
            for (column, &number) in columns.iter_mut().zip(numbers) {
                column[i] = row[number];
            }
        }
    }
}

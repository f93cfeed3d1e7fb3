//! Reads the text of a table, `table.wrp`: see `export::table_wrp` for the grammar.

use std::str::Lines;

use super::cell::{Beginning, COEFFICIENTS, Cell, Lacks};
use super::fit::exists;
use super::quantity::Quantity;
use crate::error::{Error, ErrorKind, Result};

/// Columns of a number.
const WIDTH: usize = 25;

/// Most cells of a table: some hundred times what rough measured profiles make; they take 2 GB.
const MOST_CELLS: usize = 1_000_000;

/// The lines of a table, with the number of the next one.
struct Deck<'a> {
    lines: Lines<'a>,
    number: usize,
}

/// What a table is made of.
pub(super) struct Parsed {
    /// Range \[mm\], yaw \[rad\], nominal rolling radius and tolerance of lengths \[mm\].
    pub about: ([f64; 2], f64, f64, f64),
    pub quantities: Vec<Quantity>,
    pub cells: Vec<Cell>,
    pub coefficients: Vec<f64>,
}

/// Reads the text of `table.wrp`.
///
/// # Errors
/// Another grammar or version, with the line; a file that was cut off; more than a million cells.
pub(super) fn parse(text: &str) -> Result<Parsed> {
    let mut deck = Deck { lines: text.lines(), number: 0 };
    let head = deck.line()?;
    if head.trim_end() != "WRTABLE    1 mm" {
        return Err(deck.wrong(head, "WRTABLE    1 mm"));
    }
    let [comments] = deck.whole::<1>(8)?;
    for _ in 0..comments {
        deck.line()?;
    }
    let [cell_count, quantity_count, coefficients] = deck.whole::<3>(8)?;
    if coefficients != COEFFICIENTS || cell_count > MOST_CELLS || quantity_count > super::quantity::MOST {
        let found = format!("{cell_count} {quantity_count} {coefficients}");
        let expected = format!("at most {MOST_CELLS} cells, known quantities, {COEFFICIENTS} coefficients");
        return Err(deck.wrong(&found, &expected).of_kind(ErrorKind::Limit));
    }
    let lateral = deck.numbers::<2>(0)?;
    let [yaw, radius, tolerance] = deck.numbers::<3>(0)?;
    let quantities = (0..quantity_count).map(|_| deck.quantity()).collect::<Result<Vec<_>>>()?;
    let (mut cells, mut all) = (Vec::new(), Vec::new());
    for _ in 0..cell_count {
        let cell = deck.cell()?;
        cells.push(cell);
        deck.coefficients(&cell, &quantities, &mut all)?;
    }
    if deck.line()?.trim_end() != "END" {
        return Err(deck.wrong("another line", "END"));
    }
    Ok(Parsed { about: (lateral, yaw, radius, tolerance), quantities, cells, coefficients: all })
}

impl<'a> Deck<'a> {
    fn line(&mut self) -> Result<&'a str> {
        self.number += 1;
        self.lines.next().ok_or_else(|| self.wrong("the end of the file", "a line; the file was cut off"))
    }

    fn wrong(&self, found: &str, expected: &str) -> Error {
        let advice = "write the table anew by `wheelrail table`";
        Error::new(format!("table.wrp: line {}", self.number), found, expected, advice)
    }

    /// Reads whole numbers of so many columns each.
    fn whole<const N: usize>(&mut self, width: usize) -> Result<[usize; N]> {
        let line = self.line()?;
        let mut out = [0; N];
        for (k, number) in out.iter_mut().enumerate() {
            let field = line.get(k * width..(k + 1) * width).map(str::trim);
            let parsed = field.and_then(|field| field.parse().ok());
            *number = parsed.ok_or_else(|| self.wrong(line, &format!("{N} whole numbers")))?;
        }
        Ok(out)
    }

    /// Reads numbers from a column on.
    fn numbers<const N: usize>(&mut self, from: usize) -> Result<[f64; N]> {
        let line = self.line()?;
        self.of_line(line, from)
    }

    fn of_line<const N: usize>(&self, line: &str, from: usize) -> Result<[f64; N]> {
        let mut out = [0.0; N];
        for (k, number) in out.iter_mut().enumerate() {
            let field = line.get(from + k * WIDTH..from + (k + 1) * WIDTH).map(str::trim);
            let parsed =
                field.and_then(|field| field.parse::<f64>().ok()).filter(|number| number.is_finite());
            *number = parsed.ok_or_else(|| self.wrong(line, &format!("{N} numbers of {WIDTH} columns")))?;
        }
        Ok(out)
    }

    fn quantity(&mut self) -> Result<Quantity> {
        let line = self.line()?;
        let field = |from: usize, to: usize| line.get(from..to).map(str::trim).unwrap_or_default();
        let right = match field(21, 29) {
            "wheelset" => None,
            "left" => Some(false),
            "right" => Some(true),
            _ => return Err(self.wrong(line, "wheelset, left or right in columns 22 to 29")),
        };
        let numbers = self.of_line::<2>(line, 29)?;
        Quantity::named(field(0, 18), right, numbers)
            .ok_or_else(|| self.wrong(line, "a quantity of this version of wheelrail"))
    }

    fn cell(&mut self) -> Result<Cell> {
        let line = self.line()?;
        let flag = |k: usize| line.get(2 * k..2 * k + 2).and_then(|field| field.trim().parse::<usize>().ok());
        let lacks = |k: usize| flag(k).and_then(|code| Lacks::ALL.get(code).copied());
        let begins = flag(1).and_then(|code| Beginning::ALL.get(code).copied());
        let (Some(touches @ 0..=1), Some(begins), Some(left), Some(right)) =
            (flag(0), begins, lacks(2), lacks(3))
        else {
            return Err(self.wrong(line, "four flags"));
        };
        let lateral = self.of_line::<2>(line, 8)?;
        Ok(Cell { lateral, begins, touches: touches == 1, lacks: [left, right] })
    }

    /// Appends the coefficients of a cell, in the order of the table.
    fn coefficients(&mut self, cell: &Cell, quantities: &[Quantity], all: &mut Vec<f64>) -> Result<()> {
        let (first, count) = (all.len(), quantities.len());
        all.resize(first + COEFFICIENTS * count, f64::NAN);
        if !cell.touches {
            return Ok(());
        }
        for (q, quantity) in quantities.iter().enumerate() {
            for k in (0..COEFFICIENTS).step_by(3) {
                let three = self.numbers::<3>(0)?;
                if exists(cell, quantity) {
                    (0..3).for_each(|i| all[first + (k + i) * count + q] = three[i]);
                }
            }
        }
        Ok(())
    }
}

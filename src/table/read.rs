//! Reads the text of a table, `table.wrp`: see `export::table_wrp` for the grammar.

use std::str::Lines;

use super::about::About;
use super::cell::{Beginning, COEFFICIENTS, Cell, Lacks, YAW_COEFFICIENTS};
use super::curve::Curve;
use super::fit::exists;
use super::quantity::{MOST, QuantityValues, TableQuantity};
use super::tree::{Fork, PlanePart, Tree};
use crate::error::{Error, ErrorKind, Result};
use crate::numerics::interval::Interval;

/// Columns of a number.
const WIDTH: usize = 25;

/// Most cells of a table: some hundred times what rough measured profiles make; under one yaw they take 2 GB.
const MOST_CELLS: usize = 1_000_000;

/// The lines of a table, with the number of the next one.
struct TableLines<'a> {
    lines: Lines<'a>,
    number: usize,
}

/// What a table is made of.
pub(super) struct Parsed {
    pub about: About,
    pub quantities: Vec<TableQuantity>,
    pub tree: Tree,
}

/// Reads the text of `table.wrp`.
///
/// # Errors
/// Another grammar or version, with the line; a file that was cut off; more than a million cells.
pub(super) fn parse(text: &str) -> Result<Parsed> {
    let mut deck = TableLines { lines: text.lines(), number: 0 };
    let head = deck.line()?;
    let over_yaw = match head.trim_end() {
        "WRTABLE    1 mm" => false,
        "WRTABLE    2 mm" => true,
        _ => return Err(deck.wrong(head, "WRTABLE    1 mm, or 2 mm over yaw")),
    };
    let [comments] = deck.whole::<1>(8)?;
    for _ in 0..comments {
        deck.line()?;
    }
    let [cells, count, powers, yaw_powers, curves, forks] = if over_yaw {
        deck.whole::<6>(8)?
    } else {
        let [cells, count, powers] = deck.whole::<3>(8)?;
        [cells, count, powers, YAW_COEFFICIENTS, 0, 0]
    };
    let most = [cells, curves, forks].into_iter().max().unwrap_or_default();
    let found = || format!("{cells} {count} {powers} {yaw_powers} {curves} {forks}");
    if [powers, yaw_powers] != [COEFFICIENTS, YAW_COEFFICIENTS] || count > MOST {
        let expected = format!("known quantities, {COEFFICIENTS} and {YAW_COEFFICIENTS} coefficients");
        return Err(deck.wrong(&found(), &expected));
    }
    if most > MOST_CELLS {
        let expected = format!("at most {MOST_CELLS} cells, curves and forks");
        return Err(deck.wrong(&found(), &expected).of_kind(ErrorKind::Limit));
    }
    let lateral = Interval::from(deck.numbers(0)?);
    let (yaw, radius, tolerance) = if over_yaw {
        let yaw = Interval::from(deck.numbers(0)?);
        let [radius, tolerance, _] = deck.numbers::<3>(0)?;
        (yaw, radius, tolerance)
    } else {
        let [yaw, radius, tolerance] = deck.numbers::<3>(0)?;
        (Interval::of(yaw), radius, tolerance)
    };
    let about = About { lateral, yaw, radius, tolerance };
    if over_yaw != about.over_yaw() {
        return Err(deck.wrong(&format!("yaws {:?}", yaw.ends()), "ascending ones"));
    }
    let quantities = (0..count).map(|_| deck.quantity()).collect::<Result<Vec<_>>>()?;
    let tree = if over_yaw {
        deck.tree([cells, curves, forks], &quantities)?
    } else {
        deck.row_of_cells(cells, about, &quantities)?
    };
    if deck.line()?.trim_end() != "END" {
        return Err(deck.wrong("another line", "END"));
    }
    Ok(Parsed { about, quantities, tree })
}

impl<'a> TableLines<'a> {
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

    fn quantity(&mut self) -> Result<TableQuantity> {
        let line = self.line()?;
        let field = |from: usize, to: usize| line.get(from..to).map(str::trim).unwrap_or_default();
        let right = match field(21, 29) {
            "wheelset" => None,
            "left" => Some(false),
            "right" => Some(true),
            _ => return Err(self.wrong(line, "wheelset, left or right in columns 22 to 29")),
        };
        let numbers = self.of_line::<2>(line, 29)?;
        TableQuantity::named(field(0, 18), right, numbers)
            .ok_or_else(|| self.wrong(line, "a quantity of this version of wheelrail"))
    }

    /// Reads the cells of a table under one yaw, in ascending order over the whole range.
    fn row_of_cells(&mut self, count: usize, about: About, quantities: &[TableQuantity]) -> Result<Tree> {
        let (mut cells, mut all) = (Vec::new(), Vec::new());
        let mut before = about.lateral.low;
        for c in 0..count {
            let line = self.line()?;
            let (cell, begins) = self.flags(line)?;
            let [from, to] = self.of_line::<2>(line, 8)?;
            let whole = (c > 0 || from == before) && (c + 1 < count || to == about.lateral.high);
            if !whole || from < before || to < from {
                return Err(self.wrong(line, "ascending cells over the whole range"));
            }
            before = to;
            cells.push((Interval::new(from, to), begins, Cell { yaw: about.yaw, ..cell }));
            all.push(self.coefficients(&cell, quantities, 1)?);
        }
        Ok(Tree { coefficients: all, ..Tree::of_cells(cells, about.yaw) })
    }

    /// Reads the curves, forks and cells of a table over yaw.
    fn tree(&mut self, [cells, curves, forks]: [usize; 3], quantities: &[TableQuantity]) -> Result<Tree> {
        let mut tree = Tree::default();
        for _ in 0..curves {
            let line = self.line()?;
            let kind = line.get(..8).and_then(|field| field.trim().parse::<usize>().ok());
            let Some(kind) = kind.and_then(|code| Beginning::ALL.get(code).copied()) else {
                return Err(self.wrong(line, "the code of a curve, 0 to 3"));
            };
            let yaw = self.of_line(line, 8)?.into();
            let [c0, c1, c2] = self.numbers::<3>(0)?;
            let [c3, c4] = self.numbers::<2>(0)?;
            tree.curves.push(Curve { yaw, kind, coefficients: [c0, c1, c2, c3, c4] });
        }
        for _ in 0..forks {
            let line = self.line()?;
            let [below, above, curve] = self.signed::<3>(line, 0)?;
            let [yaw] = self.of_line::<1>(line, 24)?;
            let part = |code: i64| match code {
                1.. => Some(PlanePart::Fork(code as usize - 1)),
                0 => None,
                _ => Some(PlanePart::Cell(code.unsigned_abs() as usize - 1)),
            };
            let (Some(below), Some(above), 0..) = (part(below), part(above), curve) else {
                return Err(self.wrong(line, "two parts, and a curve or 0"));
            };
            tree.forks.push(Fork { curve: (curve as usize).checked_sub(1), yaw, parts: [below, above] });
        }
        for _ in 0..cells {
            let line = self.line()?;
            let (cell, _) = self.flags(line)?;
            let [begin, end] = self.signed::<2>(line, 8)?;
            let (1.., 1..) = (begin, end) else { return Err(self.wrong(line, "two curves")) };
            let yaw = self.of_line(line, 24)?.into();
            tree.cells.push(Cell { yaw, curves: [begin as usize - 1, end as usize - 1], ..cell });
            tree.coefficients.push(self.coefficients(&cell, quantities, YAW_COEFFICIENTS)?);
        }
        Ok(tree)
    }

    /// Reads whole numbers of eight columns each, from a column on.
    fn signed<const N: usize>(&self, line: &str, from: usize) -> Result<[i64; N]> {
        let mut out = [0; N];
        for (k, number) in out.iter_mut().enumerate() {
            let field = line.get(from + 8 * k..from + 8 * (k + 1)).map(str::trim);
            let parsed = field.and_then(|field| field.parse().ok());
            *number = parsed.ok_or_else(|| self.wrong(line, &format!("{N} whole numbers")))?;
        }
        Ok(out)
    }

    /// Reads the flags of a cell, and how it begins.
    fn flags(&self, line: &str) -> Result<(Cell, Beginning)> {
        let flag = |k: usize| line.get(2 * k..2 * k + 2).and_then(|field| field.trim().parse::<usize>().ok());
        let lacks = |k: usize| flag(k).and_then(|code| Lacks::ALL.get(code).copied());
        let begins = flag(1).and_then(|code| Beginning::ALL.get(code).copied());
        let (Some(touches @ 0..=1), Some(begins), Some(left), Some(right)) =
            (flag(0), begins, lacks(2), lacks(3))
        else {
            return Err(self.wrong(line, "four flags"));
        };
        let (yaw, curves) = (Interval::of(0.0), [0; 2]);
        Ok((Cell { yaw, curves, touches: touches == 1, lacks: [left, right] }, begins))
    }

    /// Reads the coefficients of a cell, in the order of the table.
    fn coefficients(
        &mut self,
        cell: &Cell,
        quantities: &[TableQuantity],
        powers: usize,
    ) -> Result<Vec<QuantityValues>> {
        if !cell.touches {
            return Ok(Vec::new());
        }
        let mut all = vec![[f64::NAN; MOST]; powers * COEFFICIENTS];
        for (q, quantity) in quantities.iter().enumerate() {
            for k in (0..all.len()).step_by(3) {
                let three = self.numbers::<3>(0)?;
                if exists(cell, quantity) {
                    all[k..].iter_mut().zip(three).for_each(|(row, c)| row[q] = c);
                }
            }
        }
        Ok(all)
    }
}

//! The head of a table: the names of its columns, and the unit that it states.

use super::dialect::{is_missing, is_numeric};
use super::scan::Line;
use crate::error::Result;
use crate::measured::unit::Unit;

/// The head of a table.
#[derive(Debug)]
pub(super) struct TableHead<'a> {
    /// Names of the columns, as the file writes them; none without a row of names.
    names: Vec<String>,
    /// Units of the columns by their titles or by the row of units, with the line.
    of_columns: Vec<Option<(Unit, Line<'a>)>>,
    /// Unit that other lines of the head state, each with its line.
    of_lines: Vec<(Unit, Line<'a>)>,
}

impl<'a> TableHead<'a> {
    /// Reads the lines before the first row of numbers; `width` is the number of columns.
    pub(super) fn of(lines: &[Line<'a>], split: &[Vec<&str>], width: usize) -> Self {
        let mut head = Self { names: Vec::new(), of_columns: vec![None; width], of_lines: Vec::new() };
        for (line, fields) in lines.iter().zip(split) {
            let titles = fields.len() >= 2 && fields.len() == width;
            let units: Vec<Option<Unit>> = fields.iter().map(|field| unit_alone(field)).collect();
            let blank = |k: usize| units[k].is_some() || is_missing(fields[k]);
            let several = !head.names.is_empty() && units.iter().flatten().count() >= 2;
            if titles && units.iter().any(Option::is_some) && (several || (0..width).all(blank)) {
                for (own, unit) in head.of_columns.iter_mut().zip(units) {
                    *own = unit.map(|unit| (unit, *line)).or(*own);
                }
            } else if titles && !fields.iter().any(|field| is_numeric(field)) {
                head.names = fields.iter().map(|field| (*field).to_owned()).collect();
                for (own, field) in head.of_columns.iter_mut().zip(fields) {
                    *own = unit_in(field).map(|unit| (unit, *line)).or(*own);
                }
            } else if let Some(unit) = unit_in(line.text).or_else(|| unit_of_key(line.text)) {
                head.of_lines.push((unit, *line));
            }
        }
        head
    }

    /// Returns the names of the columns; none without a row of names.
    pub(super) fn names(&self) -> &[String] {
        &self.names
    }

    /// Finds a column by its name, in upper or lower case, with or without the unit behind it.
    pub(super) fn column(&self, name: &str) -> Option<usize> {
        let name = name.to_lowercase();
        let whole = self.names.iter().position(|title| title.to_lowercase() == name);
        whole.or_else(|| self.names.iter().position(|title| bare(title) == name))
    }

    /// Returns the two columns that are called y and z, x and z, or x and y.
    pub(super) fn likely_columns(&self) -> Option<[usize; 2]> {
        let pairs = [["y", "z"], ["x", "z"], ["x", "y"]];
        pairs.into_iter().find_map(|[a, b]| Some([self.column(a)?, self.column(b)?]))
    }

    /// Returns the length of the unit \[mm\] that the head states for two columns, with its line; `None` if it states none, or
    /// several in lines that are no titles.
    ///
    /// # Errors
    /// Titles with two different units.
    pub(super) fn unit(&self, at: [usize; 2]) -> Result<Option<(f64, usize)>> {
        let stated: Vec<(Unit, Line)> = at.iter().filter_map(|&k| self.of_columns[k]).collect();
        if let [(a, _), (b, line)] = stated[..]
            && a != b
        {
            let found = format!("columns in {} and in {}", a.name(), b.name());
            return Err(line.error(found, "one unit", "write both columns in one unit"));
        }
        let first = |of: &[(Unit, Line)]| of.first().map(|(unit, line)| (unit.millimetres(), line.number));
        if !stated.is_empty() {
            return Ok(first(&stated));
        }
        let one = self.of_lines.iter().all(|(unit, _)| Some(*unit) == self.of_lines.first().map(|(u, _)| *u));
        Ok(first(&self.of_lines).filter(|_| one))
    }
}

/// Returns the unit of length that a word means.
fn named(word: &str) -> Option<Unit> {
    match word.trim().trim_end_matches('.').to_lowercase().as_str() {
        "µm" | "μm" | "micron" | "microns" => Some(Unit::Micrometre),
        "inch" | "inches" => Some(Unit::Inch),
        "metre" | "meter" | "metres" | "meters" => Some(Unit::Metre),
        "feet" | "foot" => Some(Unit::Foot),
        word => Unit::named(word),
    }
}

/// Returns the unit of a field that is nothing but a unit, with or without brackets.
fn unit_alone(field: &str) -> Option<Unit> {
    named(field.trim().trim_matches(['[', ']', '(', ')']))
}

/// Returns the unit in the brackets of a title or a line, or behind its last underscore, slash or "in".
fn unit_in(text: &str) -> Option<Unit> {
    let brackets = [('[', ']'), ('(', ')')];
    let inside = brackets
        .into_iter()
        .find_map(|(open, close)| text.split(open).skip(1).find_map(|rest| named(rest.split(close).next()?)));
    let tail = || text.rsplit(['_', '/', ' ']).next().filter(|tail| tail.len() < text.len()).and_then(named);
    inside.or_else(|| tail().filter(|_| text.split_whitespace().count() <= 3))
}

/// Returns the unit of a line like "LENGTH = 'mm'" or "unit: mm".
fn unit_of_key(text: &str) -> Option<Unit> {
    let (key, value) = text.split_once(['=', ':'])?;
    let key = key.trim().trim_start_matches(['#', '!', '%', ' ']).to_lowercase();
    let known = ["length", "unit", "units", "einheit", "unité", "unidad", "length unit", "length_unit"];
    known.contains(&key.as_str()).then(|| named(value.trim().trim_matches(['\'', '"'])))?
}

/// Returns a title in lower case, without the unit behind it.
pub(super) fn bare(title: &str) -> String {
    let end = title.find(['[', '(', '/', '_']).unwrap_or(title.len());
    title[..end].trim().to_lowercase()
}

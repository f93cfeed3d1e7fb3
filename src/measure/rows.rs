//! Rows of measured files, as values with keys, and as CSV, JSON and a table.

use std::fmt::Write;

use serde_json::{Map, Value};

use super::limits::Limits;
use super::measures::Measures;
use super::options::name;
use super::quantity::{Quantity, in_micrometres};
use crate::error::Result;
use crate::measured::noise::{Spread, spread_text};
use crate::profile::Side;

/// What rows show besides values, alignments and findings.
#[derive(Debug, Clone, Copy, Default)]
pub struct RowColumns<'a> {
    /// Limits, with a column of those that a row breaks.
    pub limits: Option<&'a Limits>,
    /// What the spread is over, in words, with columns of the spread of each quantity.
    pub spread: Option<&'a str>,
}

/// A column of the spread of a quantity: what follows the key, and its value.
type SpreadColumn = (&'static str, fn(&Spread) -> Value);

const SPREAD: [SpreadColumn; 9] = [
    ("samples", |of| of.samples.into()),
    ("mean", |of| of.mean.into()),
    ("mean_error", |of| of.mean_error.into()),
    ("deviation", |of| of.deviation.into()),
    ("deviation_error", |of| of.deviation_error.into()),
    ("low", |of| of.low.into()),
    ("low_error", |of| of.low_error.into()),
    ("high", |of| of.high.into()),
    ("high_error", |of| of.high_error.into()),
];

/// What was measured of a file, or why nothing was.
#[derive(Debug, Clone)]
pub struct MeasureRow {
    /// Name of the file or profile.
    pub file: String,
    /// Its body, where it is known.
    pub side: Option<Side>,
    /// The measures, or the error of the file.
    pub measured: Result<Measures>,
}

impl MeasureRow {
    /// Returns what breaks the limits; a file that cannot be measured breaks any.
    pub fn broken(&self, limits: &Limits) -> Vec<String> {
        match &self.measured {
            Ok(measures) => limits.broken(measures),
            Err(_) => vec!["not measured".into()],
        }
    }

    /// Returns the findings: what cannot be had, and why.
    pub fn findings(&self) -> Vec<String> {
        match &self.measured {
            Ok(measures) => measures.findings.clone(),
            Err(error) => vec![error.to_string()],
        }
    }

    /// Returns the columns with their values, null where there is none: `file`, `kind`, the quantities, `alignment`, `alignment_text`,
    /// `alignment_residual_mm`, `…_if_off` of each quantity, `limits` if there are any, `finding`; the
    /// spread of each quantity, if it is asked for.
    pub fn values(&self, columns: RowColumns) -> Map<String, Value> {
        let measures = self.measured.as_ref().ok();
        let alignment = measures.and_then(|measures| measures.alignment.as_ref());
        let mut row = Map::new();
        row.insert("file".into(), self.file.clone().into());
        row.insert("kind".into(), self.side.map(name).into());
        for quantity in Quantity::ALL {
            row.insert(quantity.key().into(), measures.and_then(|of| of.value(quantity)).into());
        }
        row.insert("alignment".into(), alignment.map(|of| of.align.word()).into());
        row.insert("alignment_text".into(), alignment.map(|of| of.text.clone()).into());
        row.insert("alignment_residual_mm".into(), alignment.and_then(|of| of.residual).into());
        for quantity in Quantity::ALL {
            row.insert(quantity.key_if_off(), measures.and_then(|of| of.if_off(quantity)).into());
        }
        let text = |parts: Vec<String>| Some(parts.join("; ")).filter(|text| !text.is_empty());
        if let Some(limits) = columns.limits {
            row.insert("limits".into(), text(self.broken(limits)).into());
        }
        row.insert("finding".into(), text(self.findings()).into());
        for quantity in Quantity::ALL.into_iter().filter(|_| columns.spread.is_some()) {
            let spread = measures.and_then(|of| of.spread(quantity));
            for (name, of) in SPREAD {
                row.insert(format!("{}_{name}", quantity.key()), spread.map(of).into());
            }
        }
        row
    }
}

/// Writes rows as CSV, with a header; empty where there is no value.
pub fn csv(rows: &[MeasureRow], columns: RowColumns) -> String {
    let mut text = String::new();
    for (k, row) in rows.iter().enumerate() {
        let values = row.values(columns);
        if k == 0 {
            let keys: Vec<&str> = values.keys().map(String::as_str).collect();
            text += &format!("{}\n", keys.join(","));
        }
        let cells: Vec<String> = values.values().map(cell).collect();
        text += &format!("{}\n", cells.join(","));
    }
    text
}

/// Writes a value of CSV; text that holds a comma, a quote or a line's end stands in quotes.
fn cell(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) if text.contains([',', '"', '\n', '\r']) => {
            format!("\"{}\"", text.replace('"', "\"\""))
        }
        Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}

/// Writes rows as a JSON list of objects, with null where there is no value.
pub fn json(rows: &[MeasureRow], columns: RowColumns) -> String {
    let list: Vec<Value> = rows.iter().map(|row| row.values(columns).into()).collect();
    // Values without infinities cannot fail to be written.
    serde_json::to_string_pretty(&list).unwrap_or_default() + "\n"
}

/// Writes rows as a table of the quantities that any of them has, with alignments, broken limits and findings below it.
pub fn table(rows: &[MeasureRow], columns: RowColumns) -> String {
    let of = |row: &MeasureRow, quantity| {
        row.measured.as_ref().ok().and_then(|of| Some((of.value(quantity)?, of.if_off(quantity))))
    };
    let shown: Vec<Quantity> = Quantity::ALL
        .into_iter()
        .filter(|&quantity| rows.iter().any(|row| of(row, quantity).is_some()))
        .collect();
    let head = ["file", "kind"].into_iter().chain(shown.iter().map(|quantity| quantity.key()));
    let mut lines: Vec<Vec<String>> = vec![head.map(String::from).collect()];
    for row in rows {
        let number = |&quantity: &Quantity| match of(row, quantity) {
            None => "-".to_owned(),
            Some((value, None)) => in_micrometres(value),
            Some((value, Some(off))) => format!("{} ±{off:.3}", in_micrometres(value)),
        };
        let texts = [row.file.clone(), row.side.map_or("-", name).to_owned()];
        lines.push(texts.into_iter().chain(shown.iter().map(number)).collect());
    }
    let mut text = below_each_other(&lines);
    if !shown.is_empty() {
        text += "± is how far a value may be off: if the profile lay 0.1 mm or 0.1° otherwise, or as a fit has it, and by the noise of its points\n";
    }
    for row in rows {
        text += &notes(row, columns);
    }
    text
}

/// Writes alignment, broken limits, findings and spreads of a row.
fn notes(row: &MeasureRow, columns: RowColumns) -> String {
    let mut text = String::new();
    let mut say = |what: &str, found: &str| {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{}: {what}: {found}", row.file);
    };
    if let Some(alignment) = row.measured.as_ref().ok().and_then(|of| of.alignment.as_ref()) {
        let rms = alignment.residual.map_or_else(String::new, |rms| format!("; residual {rms:.4} mm"));
        say("alignment", &format!("{}, {}{rms}", alignment.align.word(), alignment.text));
    }
    let broken = columns.limits.map_or_else(Vec::new, |limits| row.broken(limits));
    broken.iter().for_each(|broken| say("limit", broken));
    row.findings().iter().for_each(|finding| say("finding", finding));
    text + &spreads(row, columns)
}

/// Writes the spread of each quantity that a row has.
fn spreads(row: &MeasureRow, columns: RowColumns) -> String {
    let (Some(over), Ok(measures)) = (columns.spread, &row.measured) else { return String::new() };
    let known =
        Quantity::ALL.into_iter().filter_map(|quantity| Some((quantity.key(), measures.spread(quantity)?)));
    let known: Vec<_> = known.map(|(key, spread)| (key, Some(spread))).collect();
    if known.is_empty() {
        return String::new();
    }
    format!("{}: spread: {over}\n{}", row.file, spread_text(known))
}

/// Sets cells below each other, the first two columns to the left and numbers to the right.
fn below_each_other(lines: &[Vec<String>]) -> String {
    let count = lines.first().map_or(0, Vec::len);
    let wide = |k: usize| lines.iter().map(|line| line[k].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..count).map(wide).collect();
    let mut text = String::new();
    for line in lines {
        let cells = line.iter().zip(&widths).enumerate().map(|(k, (cell, &width))| {
            if k < 2 { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
        });
        text += &format!("{}\n", cells.collect::<Vec<_>>().join("  ").trim_end());
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_has_no_sign() {
        let texts = [-1e-4, -0.0, -6e-4, 0.0312].map(in_micrometres);
        assert_eq!(texts, ["0.000", "0.000", "-0.001", "0.031"]);
    }
}

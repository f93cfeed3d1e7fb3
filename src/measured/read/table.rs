//! Reads tables of text: rows of numbers under a head, with any separators and decimal marks.
//!
//! Nothing about the writing is a question where the rows answer it: what separates the fields is what gives most rows of numbers;
//! which mark is decimal is what no group of three digits explains. A row without a value is a gap, blocks of rows are sections.

use super::dialect::{Dialect, Marks, is_missing, is_numeric};
use super::head::{self, TableHead};
use super::points::{ColumnChoice, Points};
use super::scan::{Line, clipped, last_place, lines};
use super::slices::position_and_file;
use crate::error::{Error, Result};
use crate::measured::Format;
use crate::measured::column::Column;

/// Least number of rows over which a column keeps its value, where it numbers the profiles of a file.
const LEAST_RUN: usize = 3;

/// Least number of rows that a row of two numbers may count.
const LEAST_COUNTED: usize = 10;

/// A row of the file: its line and what it is.
struct Row<'a> {
    line: Line<'a>,
    fields: Vec<&'a str>,
    /// Whether its first and its second column have a number each.
    numbers: [bool; 2],
}

impl Row<'_> {
    /// Tells whether the row is a sentence, such as "Profile 2", rather than numbers of which one is spoilt.
    fn begins_with_word(&self) -> bool {
        self.fields
            .first()
            .is_some_and(|first| first.chars().take(3).filter(|c| c.is_alphabetic()).count() == 3)
    }
}

/// Reads two columns of a table, by their numbers or by their names in its head.
///
/// Comments begin with `#`, `!`, `%` or `//`. A table of more than two columns without `wanted` is read by its likeliest two, and
/// the question which ones to take goes with the points.
///
/// # Errors
/// A wanted column that the table does not have; a row that is none of head, numbers and missing values; marks that may be decimal or
/// not. The error gives the line.
pub(in crate::measured) fn read_table(
    text: &str,
    format: Format,
    wanted: Option<&[Column; 2]>,
) -> Result<Points> {
    let rows: Vec<Line> = lines(text).collect();
    let dialect = Dialect::of(&rows)?;
    let split: Vec<Vec<&str>> = rows.iter().map(|line| dialect.fields(uncommented(*line))).collect();
    let Some((width, first)) = shape(&rows, &split)? else {
        return Err(no_rows(text, &rows));
    };
    let head = TableHead::of(&rows[..first], &split[..first], width);
    let (at, open) = choose(rows[first], &split, (width, first), &head, wanted)?;
    let kept = rows.into_iter().zip(split).skip(first);
    let body: Vec<Row> = kept
        .map(|(line, fields)| {
            let numbers = at.map(|k| fields.get(k).is_some_and(|field| is_numeric(field)));
            Row { line, fields, numbers }
        })
        .collect();
    let unit = head.unit(at)?;
    let mut points = Points::new(format, unit.map(|(unit, _)| unit));
    points.unit_line = unit.map(|(_, line)| line);
    points.columns = open;
    fill(&mut points, &body, at, width)?;
    points.join_sections();
    points.finish(text)
}

/// Returns a line without its comment. Words of spreadsheets and of C for missing values ("#N/A", "1.#QNAN") are none.
fn uncommented(line: Line<'_>) -> &str {
    if line.text.starts_with("//") {
        return "";
    }
    let words = ["#N/A", "#NV", "#NUM!", "#WERT!", "#VALUE!", "#DIV/0!", "#REF!", "#NAME?", "#BEZUG!"];
    let mut from = 0;
    while let Some(at) = line.text[from..].find(['#', '!', '%']).map(|at| from + at) {
        let rest = &line.text[at..];
        if let Some(word) = words.iter().find(|word| rest.starts_with(**word)) {
            from = at + word.len();
        } else if line.text[..at].ends_with('.') {
            from = at + 1;
        } else {
            return line.text[..at].trim_end();
        }
    }
    line.text
}

/// Returns the usual number of fields of the rows with two numbers or more, and the index of the first row of numbers; `None` without
/// such rows.
///
/// # Errors
/// A row of numbers alone with another number of fields.
fn shape(rows: &[Line], split: &[Vec<&str>]) -> Result<Option<(usize, usize)>> {
    let numbers = |fields: &[&str]| fields.iter().filter(|field| is_numeric(field)).count();
    let mut counts = std::collections::BTreeMap::new();
    for fields in split.iter().filter(|fields| numbers(fields) >= 2) {
        *counts.entry(fields.len()).or_insert(0_usize) += 1;
    }
    let Some((&width, &many)) = counts.iter().max_by_key(|(_, many)| **many) else { return Ok(None) };
    let full = |fields: &[&str]| fields.len() == width && numbers(fields) >= 2;
    let text = |field: &&str| !is_numeric(field) && !is_missing(field);
    // A head has words; the row of numbers that is least unlike the others is the first one without, or with theirs.
    let words = |fields: &[&str]| fields.iter().filter(|field| text(field)).count();
    let usual = split.iter().filter(|fields| full(fields)).map(|fields| words(fields)).min().unwrap_or(0);
    let Some(mut first) = split.iter().position(|fields| full(fields) && words(fields) == usual) else {
        return Ok(None);
    };
    let odd = |fields: &[&str]| fields.len() != width && numbers(fields) >= 2 && !fields.iter().any(text);
    if let Some(k) = (0..first).find(|&k| odd(&split[k])) {
        let found = format!("{} numbers in a row", split[k].len());
        let expected = format!("{width} columns, as {many} other rows have");
        return Err(rows[k].error(found, expected, "correct or delete the line"));
    }
    // A head may give the numbers of the rows below it and of the columns.
    let below = split[first + 1..].iter().filter(|fields| full(fields)).count();
    if below >= LEAST_COUNTED && split[first][0].parse() == Ok(below) && split[first][1].parse() == Ok(width)
    {
        first += 1 + split[first + 1..].iter().position(|fields| full(fields)).unwrap_or(0);
    }
    Ok(Some((width, first)))
}

fn no_rows(text: &str, rows: &[Line]) -> Error {
    if let Some(line) = rows.iter().find(|line| position_and_file(line.text).is_some()) {
        let found = "a position and the file of a slice";
        let expected = "points, or a list of slices in a file .slcs (rail) or .slcw (wheel)";
        let advice =
            "rename the file, and put the unit of the positions (m, mm or km) on a line before the first one";
        return line.error(found, expected, advice);
    }
    if let Some(line) = rows.iter().find(|line| !line.text.is_empty() && is_numeric(line.text)) {
        return line.error("one column", "two columns of numbers", "give both columns in one file");
    }
    let found = "no row of numbers up to the end of the file";
    Error::new(last_place(text), found, "two columns of numbers", "give another file")
}

/// Chooses two columns; the question goes with them where neither `wanted` nor their number answers it.
fn choose(
    line: Line,
    split: &[Vec<&str>],
    (width, first): (usize, usize),
    head: &TableHead,
    wanted: Option<&[Column; 2]>,
) -> Result<([usize; 2], Option<ColumnChoice>)> {
    let Some([a, b]) = wanted else {
        if width == 2 {
            return Ok(([0, 1], None));
        }
        let likely = head.likely_columns().or_else(|| {
            // Else the only two that do not number the profiles.
            let varying = |k: &usize| {
                let rows = || split[first..].iter().filter_map(|fields| fields.get(*k));
                let values: std::collections::BTreeSet<&str> = rows().copied().collect();
                values.len() * LEAST_RUN > rows().count()
            };
            let mut all = (0..width).filter(varying);
            all.next().zip(all.next()).filter(|_| all.next().is_none()).map(|(a, b)| [a, b])
        });
        let names = head.names();
        // By a name of one word that finds it, or by its number.
        let column = |k: usize| match names.get(k).map(|name| head::bare(name)) {
            Some(name) if head.column(&name) == Some(k) && name.chars().all(char::is_alphanumeric) => {
                Column::Name(name)
            }
            _ => Column::Number(k + 1),
        };
        let choice = ColumnChoice {
            count: width,
            names: names.to_vec(),
            line: line.number,
            likely: likely.map(|at| at.map(column)),
        };
        return Ok((likely.unwrap_or([0, 1]), Some(choice)));
    };
    let find = |column: &Column| match column {
        Column::Number(n) => n.checked_sub(1).filter(|&k| k < width),
        Column::Name(name) => head.column(name),
    };
    match (find(a), find(b)) {
        (Some(a), Some(b)) if a != b => Ok(([a, b], None)),
        _ => {
            let names = head.names();
            let names = if names.is_empty() { String::new() } else { format!(" ({})", names.join(", ")) };
            let found = format!("{width} columns{names}");
            let expected = format!("columns {a} and {b}, two different ones");
            Err(line.error(found, expected, "correct `columns`"))
        }
    }
}

/// Takes the points, the gaps and the sections of rows.
fn fill(points: &mut Points, body: &[Row], at: [usize; 2], width: usize) -> Result<()> {
    let fields = body.iter().filter(|row| row.numbers == [true; 2]);
    let marks = Marks::of(fields.flat_map(|row| at.map(|k| (row.line, row.fields[k]))))?;
    let counters = counters(body, at, width);
    let mut between = true;
    let mut last: Option<&Row> = None;
    for row in body {
        let field = |k: usize| row.fields.get(at[k]).copied().unwrap_or_default();
        let lacks = |k: usize| match row.fields.get(at[k]) {
            Some(field) => is_missing(field),
            None => row.line.text.ends_with([',', ';']),
        };
        if row.numbers == [true; 2] {
            let number = |k: usize| marks.number(row.line, field(k), &format!("column {}", at[k] + 1));
            let point = [number(0)?, number(1)?];
            let other = |of: &&Row| counters.iter().any(|&k| of.fields.get(k) != row.fields.get(k));
            if !points.at.is_empty() && (between || last.as_ref().is_some_and(other)) {
                points.begin_section();
            }
            points.push(row.line, point, 1.0)?;
            (between, last) = (false, Some(row));
        } else if row.fields.iter().all(|field| field.is_empty()) {
            between = true;
        } else if (0..2).all(|k| row.numbers[k] || lacks(k)) && (lacks(0) || lacks(1)) {
            points.no_value(row.line);
        } else if row.numbers == [false; 2] || between || row.begins_with_word() {
            if !between {
                points.note(row.line.number, "a line of text after points: not used");
            }
            between = true;
        } else {
            let k = usize::from(row.numbers[0]);
            let found = format!("column {} \"{}\"", at[k] + 1, clipped(field(k)));
            return Err(row.line.error(found, "a number", "correct or delete the line"));
        }
    }
    Ok(())
}

/// Returns the other columns that keep a value over three rows or more, each: they may number the profiles of the file.
fn counters(body: &[Row], at: [usize; 2], width: usize) -> Vec<usize> {
    let rows = || body.iter().filter(|row| row.numbers == [true; 2]);
    let runs = |k: usize| {
        let mut runs: Vec<(&str, usize)> = Vec::new();
        for field in rows().filter_map(|row| row.fields.get(k).copied()) {
            match runs.last_mut() {
                Some((value, many)) if *value == field => *many += 1,
                _ => runs.push((field, 1)),
            }
        }
        runs
    };
    (0..width).filter(|k| !at.contains(k) && runs(*k).iter().all(|(_, many)| *many >= LEAST_RUN)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measured::{Gap, Point};

    fn xz(text: &str, columns: Option<&[Column; 2]>) -> Result<Vec<[f64; 2]>> {
        Ok(read_table(text, Format::Csv, columns)?.at.iter().map(Point::xz).collect())
    }

    #[test]
    fn tables_have_any_two_columns() -> Result<()> {
        let text = "s;Y;Z\n0,0;1,5;2,5\n0,1;1,6;2,6\n";
        let by_name = [Column::Name("y".into()), Column::Name("z".into())];
        let by_number = [Column::Number(2), Column::Number(3)];
        for columns in [&by_name, &by_number] {
            assert_eq!(xz(text, Some(columns))?, [[1.5, 2.5], [1.6, 2.6]]);
        }
        let choice = read_table(text, Format::Csv, None)?.columns;
        assert!(choice.is_some_and(|c| c.count == 3
            && c.line == 2
            && c.likely == Some(["y", "z"].map(|n| Column::Name(n.into())))));
        let wrong = [Column::Number(0), Column::Number(4)];
        assert!(xz(text, Some(&wrong)).is_err_and(|e| e.place == "line 2"));
        assert_eq!(xz("% c\n1 2\n// x\n3 4", None)?, [[1.0, 2.0], [3.0, 4.0]]);
        assert!(xz("1 2\nx 4", None).is_err_and(|e| e.place == "line 2"));
        assert!(xz("", None).is_err_and(|e| e.place == "line 1"));
        Ok(())
    }

    #[test]
    fn marks_and_separators_are_told_by_the_rows() -> Result<()> {
        let expected = [[-1471.5, 26.0728], [1472.25, -0.5]];
        for text in [
            "-1.471,500;26,0728\n1472,250;-0,5\n",
            "\"y, mm\";z\n\"-1.471,500\";\"26,0728\"\n\"1472,250\";-0,5\n",
            "y\tz\n-1 471,5\t26,0728\n1 472,25\t-0,5\n",
            "\u{2212}1471,5 26,0728\n1472,25 \u{2212}0,5\n",
            "-1471,5,26,0728\n1472,25,-0,5\n-0,0,0,00\n",
            "\"-1471,5\",\"26,0728\"\n\"1472,25\",\"-0,5\"\n",
            "-1'471.5, 26.0728\n1'472.25, -0.5\n",
            "Gleis 3 - rechts\nmm;mm\n-1471.5;26.0728;\n1472.25;-.5;\n",
            "2\n-1471.5D0 26.0728\n1.47225e3 -0.5 # end\n",
        ] {
            let found = xz(text, None).map_err(|error| error.within(text))?;
            assert_eq!(found[..2], expected, "{text}");
        }
        let counted = format!("12 2\n{}", "-1471.5 26.0728\n1472.25 -0.5\n".repeat(6));
        assert_eq!(xz(&counted, None)?[..2], expected);
        for text in ["1.471;26,07\n1.472;26,08\n", "1 2 3\n1 2\n1 2\n"] {
            assert!(xz(text, None).is_err(), "{text}");
        }
        Ok(())
    }

    #[test]
    fn rows_without_values_are_gaps_and_blocks_are_profiles() -> Result<()> {
        let points = read_table("1 2\n2 NaN\n3 1.#QNAN\n4 2\n5 2\n", Format::Text, None)?;
        assert_eq!(points.gaps, [Gap { between: [1, 2], lines: (2, 3) }]);
        assert_eq!(points.at.len(), 3);
        let block = |z: f64| (0..9).map(|k| format!("{k};{z}\n")).collect::<String>();
        for (text, sections) in [
            (format!("{}\n\n{}", block(0.0), block(1.0)), vec![0, 9]),
            (format!("y;z\n{}y;z\n{}", block(0.0), block(1.0)), vec![0, 9]),
            (format!("Profile 1\n{}Profile;2\n{}", block(0.0), block(1.0)), vec![0, 9]),
            (block(0.5).replace('\n', "\n\n"), vec![0]),
            (format!("{}# more\n9;1\n10;1\n", block(1.0)), vec![0]),
        ] {
            assert_eq!(read_table(&text, Format::Csv, None)?.sections, sections, "{text}");
        }
        let numbered: String = (0..12).map(|k| format!("{};{};0.5\n", k / 6, k % 6)).collect();
        let read = read_table(&format!("km;y;z\n{numbered}"), Format::Csv, None)?;
        assert_eq!(read.sections, [0, 6]);
        Ok(())
    }

    #[test]
    fn heads_state_units() -> Result<()> {
        let unit = |head: &str| {
            read_table(&format!("{head}\n1;2\n3;4\n"), Format::Csv, None).map(|points| points.unit)
        };
        for (head, expected) in [
            ("Y [mm];Z [mm]", Some(1.0)),
            ("Querprofil;H\u{f6}he [m]", Some(1e3)),
            ("y;z\n\u{b5}m;\u{b5}m", Some(1e-3)),
            ("x_in;y_in", Some(25.4)),
            ("LENGTH = 'mm'", Some(1.0)),
            ("y;z", None),
            ("speed [m/s];z", None),
        ] {
            assert_eq!(unit(head)?, expected, "{head}");
        }
        assert!(unit("y [mm];z [um]").is_err());
        Ok(())
    }
}

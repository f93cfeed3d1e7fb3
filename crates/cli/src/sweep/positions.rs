//! Reads the positions of a sweep from a table.

use std::path::Path;

use crate::range::{FARTHEST, MOST_POSITIONS, check_count};
use wheelrail::error::{Error, Result, finite};
use wheelrail::files::read_text;
use wheelrail::scene::perhaps;
use wheelrail::search::{Position, Roll};

/// Largest table of positions \[bytes\]: a hundred bytes for each position.
const LARGEST_TABLE: usize = 100 * MOST_POSITIONS;

/// Columns of a table of positions. The first is required.
const COLUMNS: [&str; 3] = ["lateral_mm", "yaw_rad", "roll_rad"];

/// Reads a table with the column `lateral_mm` and optionally `yaw_rad` and `roll_rad`. A missing yaw is 0; a missing roll
/// is solved. Columns are separated as in files of measured points: by semicolons or tabs if the first line has any, and
/// commas are decimal then; else by commas.
pub(super) fn read_positions(path: &Path) -> Result<Vec<Position>> {
    let table = read_text(path, LARGEST_TABLE)?;
    read_table(&path.display().to_string(), &table)
}

fn read_table(place: &str, table: &str) -> Result<Vec<Position>> {
    let unreadable = |error: csv::Error| match error.kind() {
        csv::ErrorKind::UnequalLengths { pos, expected_len, len } => {
            let line = pos.as_ref().map_or(0, csv::Position::line);
            let expected = format!("{expected_len}, as in the first line");
            let advice = "correct the line; where commas are decimal, separate the columns by semicolons";
            Error::new(format!("{place}: line {line}"), format!("{len} cells"), expected, advice)
        }
        _ => Error::new(place, error.to_string(), "columns lateral_mm,yaw_rad,roll_rad", "correct the file"),
    };
    let names = table.lines().next().unwrap_or_default();
    let separator = [b';', b'\t'].into_iter().find(|mark| names.as_bytes().contains(mark));
    let mut reader = csv::ReaderBuilder::new();
    reader.trim(csv::Trim::All).delimiter(separator.unwrap_or(b','));
    let mut reader = reader.from_reader(table.as_bytes());
    let [lateral, yaw, roll] = columns(place, reader.headers().map_err(unreadable)?)?;
    let mut positions = Vec::new();
    for record in reader.records() {
        let record = record.map_err(unreadable)?;
        let line = record.position().map_or(0, csv::Position::line);
        let place = format!("{place}: line {line}");
        let number = |column: Option<usize>| -> Result<Option<f64>> {
            let Some(text) = column.and_then(|c| record.get(c)).filter(|text| !text.is_empty()) else {
                return Ok(None);
            };
            let point = if separator.is_some() { text.replace(',', ".") } else { text.to_owned() };
            let value = point
                .parse()
                .map_err(|_| Error::new(&place, format!("\"{text}\""), "a number", "correct it"))?;
            finite(&place, value).map(Some)
        };
        let nothing =
            || Error::new(&place, "an empty lateral_mm", "a number of mm", "give it, or drop the line");
        let lateral = number(lateral)?.ok_or_else(nothing)?;
        if lateral.abs() > FARTHEST {
            let expected = format!("a displacement within ±{FARTHEST:e} mm");
            return Err(Error::new(place, format!("{lateral:e}"), expected, "check the unit"));
        }
        positions.push(Position {
            lateral,
            yaw: number(yaw)?.unwrap_or(0.0),
            roll: number(roll)?.map_or(Roll::Solve, Roll::Fixed),
        });
        check_count(&place, positions.len() as f64)?;
    }
    if positions.is_empty() {
        let advice = "give a line for each position";
        return Err(Error::new(place, "no positions", "at least one below the columns' names", advice));
    }
    Ok(positions)
}

/// Returns the place of each of [`COLUMNS`] in the first line. The first column is required.
fn columns(place: &str, headers: &csv::StringRecord) -> Result<[Option<usize>; 3]> {
    let place = format!("{place}: line 1");
    let mut found = [None; COLUMNS.len()];
    // Spreadsheets may end each line with separators.
    let named = headers.iter().enumerate().filter(|(_, header)| !header.is_empty()).last();
    for (at, header) in headers.iter().take(named.map_or(0, |(last, _)| last + 1)).enumerate() {
        let Some(k) = COLUMNS.iter().position(|name| *name == header) else {
            let advice = perhaps(header, &COLUMNS);
            let expected = format!("columns {} only", COLUMNS.join(", "));
            return Err(Error::new(place, format!("a column \"{header}\""), expected, advice));
        };
        if found[k].replace(at).is_some() {
            return Err(Error::new(place, format!("two columns {header}"), "each column once", "delete one"));
        }
    }
    if found[0].is_none() {
        let there = headers.iter().collect::<Vec<_>>().join(",");
        let advice = "name the columns in the first line";
        return Err(Error::new(place, format!("columns \"{there}\""), "a column lateral_mm", advice));
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_read_as_their_columns_say() -> Result<()> {
        let positions = read_table("p.csv", "roll_rad, lateral_mm\n,1.5\n0.001,2\n")?;
        assert_eq!(positions[0], Position { lateral: 1.5, yaw: 0.0, roll: Roll::Solve });
        assert_eq!(positions[1], Position { lateral: 2.0, yaw: 0.0, roll: Roll::Fixed(0.001) });
        let spreadsheets =
            ["lateral_mm;yaw_rad;\r\n1,5;0,01;\r\n-2;;\r\n", "lateral_mm\tyaw_rad\n1,5\t0.01\n-2\t\n"];
        for table in spreadsheets {
            let positions = read_table("p.csv", table)?;
            let read: Vec<[f64; 2]> =
                positions.iter().map(|position| [position.lateral, position.yaw]).collect();
            assert_eq!(read, [[1.5, 0.01], [-2.0, 0.0]], "{table}");
        }
        for (table, message) in [
            (
                "lateral_mm\n1,5\n",
                "p.csv: line 2: found 2 cells; expected 1, as in the first line; correct the line; where commas are decimal,",
            ),
            (
                "lateral_mm,yaw\n1,0\n",
                "p.csv: line 1: found a column \"yaw\"; expected columns lateral_mm, yaw_rad, \
                                       roll_rad only; perhaps `yaw_rad` is meant",
            ),
            ("yaw_rad\n1\n", "p.csv: line 1: found columns \"yaw_rad\"; expected a column lateral_mm"),
            ("lateral_mm,lateral_mm\n1,2\n", "p.csv: line 1: found two columns lateral_mm"),
            (
                "lateral_mm,yaw_rad\n1,0\n,0.1\n",
                "p.csv: line 3: found an empty lateral_mm; expected a number of mm",
            ),
            ("lateral_mm\nx\n", "p.csv: line 2: found \"x\"; expected a number"),
            ("lateral_mm\n", "p.csv: found no positions; expected at least one"),
            ("lateral_mm\n1e308\n", "p.csv: line 2: found 1e308; expected a displacement within ±1e9 mm;"),
            ("lateral_mm\n1\n2,3\n", "p.csv: line 3: found 2 cells; expected 1, as in the first line;"),
        ] {
            let error = read_table("p.csv", table).err().map(|e| e.to_string()).unwrap_or_default();
            assert!(error.starts_with(message), "{error}");
        }
        Ok(())
    }
}

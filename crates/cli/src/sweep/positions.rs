//! Reads the positions of a sweep, from a range or a table.

use std::path::Path;

use wheelrail::error::{Error, Result, finite};
use wheelrail::files::read_text;
use wheelrail::scene::perhaps;
use wheelrail::search::{Position, Roll};

/// Most positions of one sweep. They and their results take a GiB.
const MOST_POSITIONS: usize = 10_000_000;

/// Largest table of positions \[bytes\]: a hundred bytes for each position.
const LARGEST_TABLE: usize = 100 * MOST_POSITIONS;

/// Largest displacement \[mm\]. It is far beyond any track, and its sums do not overflow.
const FARTHEST: f64 = 1e9;

/// Columns of a table of positions. The first is required.
const COLUMNS: [&str; 3] = ["lateral_mm", "yaw_rad", "roll_rad"];

/// Most decimals with which a number is treated as a decimal one. Doubles of a millimetre and more have no more digits.
const MOST_DECIMALS: i32 = 15;

/// Reads FROM:TO:STEP, both ends included. Each position is the double nearest to its decimal number, so that it is printed
/// as that number.
pub(super) fn lateral_range(text: &str) -> Result<Vec<f64>> {
    let bad = || {
        let expected = format!("FROM:TO:STEP in mm with FROM <= TO within ±{FARTHEST:e} and STEP > 0");
        Error::new("--lateral", text, expected, "for example --lateral -8:8:0.1")
    };
    let parts = text.split(':').map(|part| part.trim().parse().ok()).collect::<Option<Vec<f64>>>();
    let Some([from, to, step]) = parts.and_then(|parts| <[f64; 3]>::try_from(parts).ok()) else {
        return Err(bad());
    };
    if !(-FARTHEST <= from && from <= to && to <= FARTHEST && step.is_finite() && step > 0.0) {
        return Err(bad());
    }
    // A last step that ends within a millionth of TO ends at TO.
    let steps = ((to - from) / step + 1e-6).floor();
    check_count("--lateral", steps + 1.0)?;
    let at = positions_of(from, step, to);
    Ok((0..=steps as usize).map(|k| at(k as f64).min(to)).collect())
}

/// Returns the function k ↦ from + k·step. If both are decimal numbers, it is one division of whole numbers, so that no
/// rounding shows. If they have too many digits, it is the rounded sum.
fn positions_of(from: f64, step: f64, to: f64) -> impl Fn(f64) -> f64 {
    /// Whole numbers below this are exact doubles.
    const EXACT: f64 = 9_007_199_254_740_992.0;
    let decimal = |scale: f64| {
        let small = [from, step, to].iter().all(|v| (v * scale).abs() < EXACT);
        small && [from, step].iter().all(|v| (v * scale).round() / scale == *v)
    };
    let scale = (0..=MOST_DECIMALS).map(|decimals| 10f64.powi(decimals)).find(|&scale| decimal(scale));
    move |k| match scale {
        Some(scale) => ((from * scale).round() + k * (step * scale).round()) / scale,
        None => from + step * k,
    }
}

fn check_count(place: &str, count: f64) -> Result<()> {
    if count <= MOST_POSITIONS as f64 {
        return Ok(());
    }
    let expected = format!("at most {MOST_POSITIONS} positions");
    Err(Error::new(place, format!("{count:e} positions"), expected, "take a larger step, or several sweeps"))
}

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
    fn positions_are_printed_as_they_were_asked_for() -> Result<()> {
        let printed = |range: &str| -> Result<Vec<String>> {
            Ok(lateral_range(range)?.iter().map(f64::to_string).collect())
        };
        assert_eq!(printed("0:1:0.3")?, ["0", "0.3", "0.6", "0.9"]);
        assert_eq!(printed("1e-3:0.004:1e-3")?, ["0.001", "0.002", "0.003", "0.004"]);
        assert_eq!(printed("-0.1:0.2:0.1")?, ["-0.1", "0", "0.1", "0.2"]);
        assert_eq!(printed("0.25:0.25:7")?, ["0.25"]);
        for range in ["-6:6:0.01", "-8:8:0.1", "-0.7:0.7:0.007"] {
            let all = lateral_range(range)?;
            assert!(all.iter().zip(all.iter().rev()).all(|(a, b)| *a == -b), "{range}");
            assert!(all.iter().all(|v| v.to_string().len() <= 6), "{range}: {all:?}");
        }
        // A third has too many decimals. The range ends at TO all the same.
        let third = lateral_range("0:1:0.33333333333333333")?;
        assert!(third.len() == 4 && third[3] == 1.0 && (third[2] - 2.0 / 3.0).abs() < 1e-15, "{third:?}");
        Ok(())
    }

    #[test]
    fn too_many_positions_and_bad_ranges_are_errors() {
        for bad in ["0:1:1e-9", "0:1:1e-300"] {
            assert!(lateral_range(bad).is_err_and(|e| e.expected == "at most 10000000 positions"), "{bad}");
        }
        for bad in [
            "",
            "0:1",
            "0:1e10:1e9",
            "0:1:0",
            "1:0:1",
            "0:1:x:0.5",
            "nan:1:1",
            "0:inf:1",
            "0:1:inf",
            "0:1:0.5:2",
        ] {
            assert!(lateral_range(bad).is_err_and(|e| e.expected.starts_with("FROM:TO:STEP")), "{bad}");
        }
    }

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

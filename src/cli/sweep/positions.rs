//! The positions of a sweep: a range, or a table.

use std::path::Path;

use crate::contact::search::wheelset::{Position, Roll};
use crate::error::{Error, Result, finite};

/// Most positions of one `--lateral` range: a day's work.
const MOST_POSITIONS: f64 = 1e9;

/// FROM:TO:STEP, both ends included.
pub(super) fn lateral_range(text: &str) -> Result<Vec<f64>> {
    let bad = || {
        let expected = "FROM:TO:STEP in mm with FROM <= TO and STEP > 0";
        Error::new("--lateral", text, expected, "for example --lateral -8:8:0.1")
    };
    let parts: Vec<f64> = text.split(':').filter_map(|part| part.trim().parse().ok()).collect();
    let [from, to, step] = parts[..] else { return Err(bad()) };
    if !(from.is_finite()
        && to.is_finite()
        && step > 0.0
        && from <= to
        && (to - from) / step < MOST_POSITIONS)
    {
        return Err(bad());
    }
    // A last step that ends within a millionth of TO ends there.
    let n = ((to - from) / step + 1e-6).floor() as usize;
    Ok((0..=n).map(|k| (from + step * k as f64).min(to)).collect())
}

/// A table with columns `lateral_mm` and perhaps `yaw_rad` and `roll_rad`.
pub(super) fn read_positions(path: &Path) -> Result<Vec<Position>> {
    let place = path.display().to_string();
    let unreadable = |error: csv::Error| {
        Error::new(&place, error.to_string(), "columns lateral_mm,yaw_rad,roll_rad", "correct the file")
    };
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_path(path).map_err(unreadable)?;
    let headers = reader.headers().map_err(unreadable)?.clone();
    let column = |name: &str| headers.iter().position(|header| header == name);
    let Some(lateral) = column("lateral_mm") else {
        let found = format!("columns {}", headers.iter().collect::<Vec<_>>().join(","));
        return Err(Error::new(place, found, "a column lateral_mm", "name the columns in the first line"));
    };
    let (yaw, roll) = (column("yaw_rad"), column("roll_rad"));
    let mut positions = Vec::new();
    for record in reader.records() {
        let record = record.map_err(unreadable)?;
        let line = record.position().map_or(0, csv::Position::line);
        let number = |column: Option<usize>| -> Result<Option<f64>> {
            let Some(text) = column.and_then(|c| record.get(c)).filter(|text| !text.is_empty()) else {
                return Ok(None);
            };
            let place = format!("{place}: line {line}");
            let value = text
                .parse()
                .map_err(|_| Error::new(&place, format!("\"{text}\""), "a number", "correct it"))?;
            finite(&place, value).map(Some)
        };
        positions.push(Position {
            lateral: number(Some(lateral))?.unwrap_or(0.0),
            yaw: number(yaw)?.unwrap_or(0.0),
            roll: number(roll)?.map_or(Roll::Solve, Roll::Fixed),
        });
    }
    Ok(positions)
}

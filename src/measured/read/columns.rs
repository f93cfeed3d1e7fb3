//! Reads files of columns: GENSYS, plain text and CSV.
//!
//! | format | axes | source |
//! |---|---|---|
//! | GENSYS | first column y towards the centre of the track for both sides, second z down, mm; `#` begins a comment; origin at the nominal running circle | manual of program KPF, "Wheel profile input data" |
//! | text, CSV | not known: `mirror`, `flip_z`, `unit` or the shape say | |

use super::points::Points;
use super::scan::{Line, is_number, last_place, lines};
use crate::error::{Error, Result};
use crate::measured::Format;
use crate::measured::column::Column;

/// Reads two columns in mm: y towards the centre of the track, and z down.
///
/// # Errors
/// A row that is not two numbers; the error gives its line.
pub(in crate::measured) fn read_gensys(text: &str) -> Result<Points> {
    let mut points = Points::new(Format::Gensys, Some(1.0));
    for line in lines(text).map(|line| line.without_comment(&['#', '!'])) {
        match line.fields()?[..] {
            [] => {}
            [y, z] => points.push(line, [line.number(y, "y")?, line.number(z, "z")?], 1.0)?,
            _ => return Err(line.error(line.text, "two numbers, y and z", "delete the other columns")),
        }
    }
    points.finish(text)
}

/// Reads two columns of a table, by their numbers or by their names in its first row.
///
/// Comments begin with `#`, `!`, `%` or `//`. Without `wanted` the table must have two columns.
///
/// # Errors
/// A wanted column that the table does not have; a row without a number in it. The error gives the line.
pub(in crate::measured) fn read_table(
    text: &str,
    format: Format,
    wanted: Option<&[Column; 2]>,
) -> Result<Points> {
    let mut points = Points::new(format, None);
    let mut header: Option<Vec<String>> = None;
    let mut chosen: Option<[usize; 2]> = None;
    for line in lines(text) {
        let line = if line.text.starts_with("//") { Line { text: "", ..line } } else { line };
        let line = line.without_comment(&['#', '!', '%']);
        let fields = line.fields()?;
        if fields.is_empty() {
            continue;
        }
        if header.is_none() && points.at.is_empty() && !fields.iter().any(|field| is_number(field)) {
            header = Some(fields.iter().map(|field| field.to_lowercase()).collect());
            continue;
        }
        let at = match chosen {
            Some(at) => at,
            None => *chosen.insert(choose(line, &fields, header.as_deref(), wanted)?),
        };
        let number = |k: usize| {
            let field = fields.get(at[k]).copied().unwrap_or_default();
            line.number(field, &format!("column {}", at[k] + 1))
        };
        points.push(line, [number(0)?, number(1)?], 1.0)?;
    }
    if chosen.is_none() {
        let found = "no row of numbers up to the end of the file";
        return Err(Error::new(last_place(text), found, "two columns of numbers", "give another file"));
    }
    points.finish(text)
}

fn choose(
    line: Line,
    fields: &[&str],
    header: Option<&[String]>,
    wanted: Option<&[Column; 2]>,
) -> Result<[usize; 2]> {
    let Some([first, second]) = wanted else {
        if fields.len() == 2 {
            return Ok([0, 1]);
        }
        let found = format!("{} columns", fields.len());
        let advice = "give `columns = [m, n]`, numbers from 1 or names of the first row";
        return Err(line.error(found, "two columns, or which ones to take", advice));
    };
    let find = |column: &Column| match column {
        Column::Number(n) => n.checked_sub(1).filter(|&k| k < fields.len()),
        Column::Name(name) => header?.iter().position(|title| *title == name.to_lowercase()),
    };
    match (find(first), find(second)) {
        (Some(a), Some(b)) if a != b => Ok([a, b]),
        _ => {
            let names = header.map_or_else(String::new, |names| format!(" ({})", names.join(", ")));
            let found = format!("{} columns{names}", fields.len());
            let expected = format!("columns {first} and {second}, two different ones");
            Err(line.error(found, expected, "correct `columns`"))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn xz(points: &Points) -> Vec<[f64; 2]> {
        points.at.iter().map(|p| p.xz()).collect()
    }

    #[test]
    fn gensys_has_two_columns_and_comments() -> Result<()> {
        let points = read_gensys(" -60.0  -2.6\n -59.9   -2.5  # far out on the tread\n\n# end\n")?;
        assert_eq!(xz(&points), [[-60.0, -2.6], [-59.9, -2.5]]);
        assert_eq!(points.at[1].line, 2);
        let error = read_gensys("1 2\n3 4\n5 6 7\n").err().map(|e| e.place);
        assert_eq!(error.as_deref(), Some("line 3"));
        Ok(())
    }

    #[test]
    fn tables_have_any_two_columns() -> Result<()> {
        let text = "s;Y;Z\n0,0;1,5;2,5\n0,1;1,6;2,6\n";
        let by_name = [Column::Name("y".into()), Column::Name("z".into())];
        let by_number = [Column::Number(2), Column::Number(3)];
        for columns in [&by_name, &by_number] {
            assert_eq!(xz(&read_table(text, Format::Csv, Some(columns))?), [[1.5, 2.5], [1.6, 2.6]]);
        }
        assert!(read_table(text, Format::Csv, None).is_err_and(|e| e.place == "line 2"));
        let wrong = [Column::Number(0), Column::Number(4)];
        assert!(read_table(text, Format::Csv, Some(&wrong)).is_err_and(|e| e.place == "line 2"));
        assert_eq!(xz(&read_table("% c\n1 2\n// x\n3 4", Format::Text, None)?), [[1.0, 2.0], [3.0, 4.0]]);
        assert!(read_table("1 2\nx 4", Format::Text, None).is_err_and(|e| e.place == "line 2"));
        assert!(read_table("", Format::Text, None).is_err_and(|e| e.place == "line 1"));
        Ok(())
    }
}

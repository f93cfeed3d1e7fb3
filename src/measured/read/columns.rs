//! Reads files of two columns: GENSYS.
//!
//! | format | axes | source |
//! |---|---|---|
//! | GENSYS | first column y towards the centre of the track for both sides, second z down, mm; `#` begins a comment; origin at the nominal running circle | manual of program KPF, "Wheel profile input data" |

use super::dialect::is_missing;
use super::points::Points;
use super::scan::lines;
use crate::error::Result;
use crate::measured::Format;

/// Reads two columns in mm: y towards the centre of the track, and z down.
///
/// # Errors
/// A row that is not two numbers; the error gives its line.
pub(in crate::measured) fn read_gensys(text: &str) -> Result<Points> {
    let mut points = Points::new(Format::Gensys, Some(1.0));
    for line in lines(text).map(|line| line.without_comment(&['#', '!'])) {
        match line.fields()?[..] {
            [] => {}
            [y, z] if is_missing(y) || is_missing(z) => points.no_value(line),
            [y, z] => points.push(line, [line.number(y, "y")?, line.number(z, "z")?], 1.0)?,
            _ => return Err(line.error(line.text, "two numbers, y and z", "delete the other columns")),
        }
    }
    points.finish(text)
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
}

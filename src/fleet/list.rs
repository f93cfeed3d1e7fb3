//! What a fleet consists of: the wheelsets of a folder or a table, and the rail sections.

use std::fmt;
use std::path::{Path, PathBuf};

use crate::error::{Error, Result};
use crate::files::{files_in, read_text};
use crate::profile::standards;
use crate::scene::perhaps;

/// Largest table of wheelsets \[bytes\]: a million lines of some 300 bytes.
const LARGEST_TABLE: usize = 300_000_000;

/// Columns of a table of wheelsets. The first three are required, the last two go together.
const COLUMNS: [&str; 7] =
    ["wheelset", "left", "right", "radius_left_mm", "radius_right_mm", "rail_left", "rail_right"];

/// Where a profile comes from.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) enum Source {
    /// The scene's own profile.
    Scene,
    /// A file.
    File(PathBuf),
    /// A built-in profile.
    BuiltIn(String),
}

/// A wheelset; arrays are \[left, right\].
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ListedWheelset {
    pub name: String,
    pub wheels: [Source; 2],
    /// Nominal rolling radii \[mm\]; `None` for the scene's.
    pub radii: [Option<f64>; 2],
    /// The rails of a given pair.
    pub rails: Option<[Source; 2]>,
}

impl fmt::Display for Source {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Scene => f.write_str("scene"),
            Self::File(path) => write!(f, "{}", path.display()),
            Self::BuiltIn(name) => f.write_str(name),
        }
    }
}

impl Source {
    /// Returns the file of this name in a folder; a built-in profile where there is none and the name is known.
    fn of(name: &str, folder: &Path) -> Self {
        let path = folder.join(name);
        let known = || standards::rail(name).is_ok() || standards::wheel(name).is_ok();
        if !path.exists() && known() { Self::BuiltIn(name.into()) } else { Self::File(path) }
    }
}

/// Lists the wheelsets of a folder, where each file is both wheels, or of a table.
///
/// # Errors
/// A folder without files; anything wrong with the table, with its line.
pub(super) fn wheelsets(path: &Path) -> Result<Vec<ListedWheelset>> {
    if !path.is_dir() {
        let text = read_text(path, LARGEST_TABLE)?;
        return table(&text, path.parent().unwrap_or(Path::new("")))
            .map_err(|error| error.within(path.display()));
    }
    let files = files_in(path)?;
    let wheelset = |file: PathBuf| ListedWheelset {
        name: file.file_stem().unwrap_or_default().to_string_lossy().into_owned(),
        wheels: [Source::File(file.clone()), Source::File(file)],
        radii: [None; 2],
        rails: None,
    };
    some(path, files).map(|files| files.into_iter().map(wheelset).collect())
}

/// Lists the rail sections of a folder, a file or a built-in name; both rails of a track have the same.
///
/// # Errors
/// A folder without files; a name that is neither a folder, a file nor a built-in rail.
pub(super) fn rails(name: &str) -> Result<Vec<Source>> {
    let path = Path::new(name);
    if path.is_dir() {
        return some(path, files_in(path)?).map(|files| files.into_iter().map(Source::File).collect());
    }
    if path.exists() {
        return Ok(vec![Source::File(path.into())]);
    }
    let known: Vec<&str> = standards::rail_names().collect();
    if !known.contains(&name) {
        let expected = "a folder, a file or a built-in rail";
        return Err(Error::new(name, "nothing of this name", expected, perhaps(name, &known)));
    }
    Ok(vec![Source::BuiltIn(name.into())])
}

/// Refuses a folder without files.
fn some(folder: &Path, files: Vec<PathBuf>) -> Result<Vec<PathBuf>> {
    if files.is_empty() {
        let place = folder.display().to_string();
        return Err(Error::new(place, "no files", "a folder with a file for each profile", "check the path"));
    }
    Ok(files)
}

fn table(text: &str, folder: &Path) -> Result<Vec<ListedWheelset>> {
    let unreadable = |error: csv::Error| {
        let expected = "rows with as many cells as the first line";
        Error::new("table", error.to_string(), expected, "correct the file")
    };
    let names = text.lines().next().unwrap_or_default();
    let separator = [b';', b'\t'].into_iter().find(|mark| names.as_bytes().contains(mark));
    let mut reader = csv::ReaderBuilder::new();
    reader.trim(csv::Trim::All).delimiter(separator.unwrap_or(b','));
    let mut reader = reader.from_reader(text.as_bytes());
    let columns = columns(reader.headers().map_err(unreadable)?)?;
    let mut all = Vec::new();
    for record in reader.records() {
        let record = record.map_err(unreadable)?;
        let line = record.position().map_or(0, csv::Position::line);
        let cell = |k: usize| {
            let text = columns[k].and_then(|column| record.get(column)).unwrap_or_default();
            (!text.is_empty()).then_some(text)
        };
        all.push(wheelset(cell, separator.is_some(), folder).map_err(|e| e.within(format!("line {line}")))?);
    }
    if all.is_empty() {
        return Err(Error::new("", "no wheelsets", "at least one below the columns' names", "add a line"));
    }
    Ok(all)
}

/// Reads a line; `cell` gives the text of a column, `None` where it is empty.
fn wheelset<'a>(
    cell: impl Fn(usize) -> Option<&'a str>,
    decimal_commas: bool,
    folder: &Path,
) -> Result<ListedWheelset> {
    let needed = |k: usize| {
        cell(k).ok_or_else(|| Error::new(COLUMNS[k], "an empty cell", "a name", "give it, or drop the line"))
    };
    let radius = |k: usize| {
        let Some(text) = cell(k) else { return Ok(None) };
        let point = if decimal_commas { text.replace(',', ".") } else { text.to_owned() };
        let value: Option<f64> =
            point.parse().ok().filter(|radius: &f64| *radius > 0.0 && radius.is_finite());
        let found = || Error::new(COLUMNS[k], format!("\"{text}\""), "a radius in mm", "correct it");
        value.map(Some).ok_or_else(found)
    };
    let rails = match (cell(5), cell(6)) {
        (None, None) => None,
        (Some(left), Some(right)) => Some([left, right].map(|name| Source::of(name, folder))),
        _ => {
            let expected = "both rails of a pair, or none";
            return Err(Error::new("rail_left, rail_right", "one of them", expected, "give both"));
        }
    };
    Ok(ListedWheelset {
        name: needed(0)?.into(),
        wheels: [Source::of(needed(1)?, folder), Source::of(needed(2)?, folder)],
        radii: [radius(3)?, radius(4)?],
        rails,
    })
}

/// Returns the place of each of [`COLUMNS`] in the first line.
fn columns(headers: &csv::StringRecord) -> Result<[Option<usize>; COLUMNS.len()]> {
    let mut found = [None; COLUMNS.len()];
    for (at, header) in headers.iter().enumerate().filter(|(_, header)| !header.is_empty()) {
        let Some(k) = COLUMNS.iter().position(|name| *name == header) else {
            let expected = format!("columns {} only", COLUMNS.join(", "));
            let found = format!("a column \"{header}\"");
            return Err(Error::new("line 1", found, expected, perhaps(header, &COLUMNS)));
        };
        if found[k].replace(at).is_some() {
            let found = format!("two columns {header}");
            return Err(Error::new("line 1", found, "each column once", "delete one"));
        }
    }
    if found[..3].contains(&None) {
        let there = headers.iter().collect::<Vec<_>>().join(",");
        let expected = "columns wheelset, left and right";
        return Err(Error::new("line 1", format!("columns \"{there}\""), expected, "name all three"));
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_read_by_the_names_of_their_columns() {
        let text = "wheelset;left;right;radius_right_mm;rail_left;rail_right\nA;S1002;a.whl;455,5;60E1;b.ban\nB;EN13715-S1002-h28-e31;x;;;\n";
        let read = table(text, Path::new("/nowhere")).unwrap();
        let file = |name: &str| Source::File(Path::new("/nowhere").join(name));
        let built_in = |name: &str| Source::BuiltIn(name.into());
        assert_eq!(read[0].wheels, [built_in("S1002"), file("a.whl")]);
        assert_eq!(
            (&read[0].radii, &read[0].rails),
            (&[None, Some(455.5)], &Some([built_in("60E1"), file("b.ban")]))
        );
        assert_eq!((&*read[1].name, &read[1].rails), ("B", &None));
        assert_eq!(read[1].wheels, [built_in("EN13715-S1002-h28-e31"), file("x")]);
        for (text, message) in [
            (
                "wheelset,left\nA,x\n",
                "line 1: found columns \"wheelset,left\"; expected columns wheelset, left and right",
            ),
            ("wheelset,left,right,rail\n", "line 1: found a column \"rail\"; expected columns wheelset, "),
            ("wheelset,left,right\n", ": found no wheelsets;"),
            ("wheelset,left,right\nA,,x\n", "line 2: left: found an empty cell;"),
            ("wheelset,left,right,radius_left_mm\nA,x,x,-1\n", "line 2: radius_left_mm: found \"-1\";"),
            (
                "wheelset,left,right,rail_left,rail_right\nA,x,x,y,\n",
                "line 2: rail_left, rail_right: found one of them",
            ),
            ("wheelset,left,right\nA,x\n", "table: found CSV error"),
        ] {
            let error = table(text, Path::new("")).unwrap_err().to_string();
            assert!(error.starts_with(message), "{error}");
        }
    }
}

//! Reads MiniProf files (Greenwood Engineering): `.ban` rails, `.whl` wheels, `.mpt` files of several sections.
//!
//! Coordinates are in mm; `Xoffset` and `Yoffset` are added to the points. Axes (`src/docs/measured-files.md`): for wheels
//! X goes from the flange back to the field side, and Y towards the flange tip, so downwards. For rails neither sign is
//! defined, but most files have the foot at negative Y.
//!
//! | style | told by | header | points |
//! |---|---|---|---|
//! | new | | `key=value`, `ColumnDef=X,Y,A,C` | after a blank line |
//! | old | `MINIPROF` in the first three lines | a line each, `32.58 37.11 14.71 (Sd/Sh/qR)` | after a blank line |
//! | sections | `[FileInfo]`, `[Profile1Info]` | as new | after `[Profile1Points]` |
//!
//! A line that begins with `"`, `!`, `%` or `#` is a comment. Text after a number is a comment too. Design profiles give
//! `MPDk=A x y radius from to` (degrees, counter-clockwise) and `MPDk=L x y x y`.

use super::dialect::is_missing;
use super::points::{ElementShape, Points, StatedValue};
use super::scan::{Line, clipped, is_number, lines, unquoted};
use crate::error::Result;
use crate::measured::Format;

/// Values that instruments write beside their points, and those of the line that old files have of them.
const STATED: [&str; 6] = ["Sd", "Sh", "qR", "W1", "W2", "W3"];
const OLD_STATED: &str = "(Sd/Sh/qR)";

const COMMENTS: [char; 4] = ['"', '!', '%', '#'];

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Style {
    New,
    Old,
    Sections,
}

/// The content of the present header.
#[derive(Debug, Clone)]
struct MiniProfHeader {
    /// Indices of X and Y among the columns.
    columns: [usize; 2],
    /// Number of columns that `ColumnDef` names.
    width: usize,
    offset: [f64; 2],
    /// Value of `XYPoints`, and its line.
    count: Option<(usize, usize)>,
    /// Design elements as (k, line, shape).
    elements: Vec<(usize, usize, ElementShape)>,
    /// Value of `MPDC`, and its line.
    element_count: Option<(usize, usize)>,
    /// Value of `DiameterTaperline` \[mm\]; instruments without a gauge for it write 0 or nothing.
    diameter: Option<f64>,
    stated: Vec<StatedValue>,
}

#[derive(Debug)]
struct Reader {
    style: Style,
    points: Points,
    header: MiniProfHeader,
    in_data: bool,
    /// Index of the first point under the present header.
    from: usize,
}

/// Reads a MiniProf file of any of the three styles.
///
/// # Errors
/// A row without two numbers; a bad `ColumnDef`, offset or element; a key after points. The error gives the line.
pub(in crate::measured) fn read(text: &str) -> Result<Points> {
    let style = style(text);
    let old_data = if style == Style::Old { first_old_row(text) } else { 0 };
    let points = Points::new(Format::MiniProf, Some(1.0));
    let in_data = style == Style::Old;
    let mut reader = Reader { style, points, header: MiniProfHeader::default(), in_data, from: 0 };
    if style == Style::Old {
        reader.points.stated = old_stated(text);
    }
    for line in lines(text).filter(|line| line.number >= old_data) {
        reader.line(line)?;
    }
    reader.close_header()?;
    reader.points.finish(text)
}

fn style(text: &str) -> Style {
    let first: Vec<_> = lines(text).filter(|line| !line.text.is_empty()).take(3).collect();
    if first.iter().any(|line| line.text.starts_with('[')) {
        Style::Sections
    } else if first.iter().any(|line| line.text.contains("MINIPROF") && !line.text.contains('=')) {
        Style::Old
    } else {
        Style::New
    }
}

/// Returns the number of the line where the points of an old file begin: the first row of numbers after a blank line.
/// Without a blank line it is the first row of numbers that no `(Sd/Sh/qR)` follows.
fn first_old_row(text: &str) -> usize {
    let rows: Vec<Line> = lines(text).collect();
    let numeric = |k: usize| {
        let fields = rows[k].without_comment(&COMMENTS).fields().unwrap_or_default();
        fields.len() >= 2 && fields.iter().all(|field| is_number(field))
    };
    let after_blank = |k: &usize| k.checked_sub(1).is_some_and(|before| rows[before].text.is_empty());
    let no_key_follows = |k: &usize| !rows.get(k + 1).is_some_and(|next| next.text.starts_with('('));
    let all = || (0..rows.len()).filter(|&k| numeric(k));
    let first = all().find(after_blank).or_else(|| all().find(no_key_follows));
    first.unwrap_or(rows.len()) + 1
}

/// Returns Sd, Sh and qR of an old file: three numbers before their names, on the same line or on the one before it.
fn old_stated(text: &str) -> Vec<StatedValue> {
    let mut before: Option<Line> = None;
    for line in lines(text) {
        if let Some((own, _)) = line.text.split_once(OLD_STATED) {
            let row = if own.trim().is_empty() { before } else { Some(Line { text: own, ..line }) };
            let numbers = row.and_then(|row| {
                let fields = row.text.trim_matches(['"', ' ']).split_whitespace();
                fields.map(|field| field.parse().ok()).collect::<Option<Vec<f64>>>()
            });
            let numbers = numbers.filter(|all| all.len() == 3 && all.iter().all(|value| value.is_finite()));
            let named = STATED.iter().zip(numbers.unwrap_or_default());
            let stated =
                |(key, value): (&&str, f64)| StatedValue { key: (*key).into(), value, line: line.number };
            return named.map(stated).collect();
        }
        before = Some(line);
    }
    Vec::new()
}

impl Reader {
    fn line(&mut self, line: Line) -> Result<()> {
        if self.style == Style::Sections && line.text.starts_with('[') {
            return self.section(line);
        }
        if line.text.is_empty() {
            // In `.mpt` files a section name begins the points; in other files a blank line does.
            self.in_data |= self.style != Style::Sections && line.number > 1;
            return Ok(());
        }
        // A header line may have quotes around the whole of it.
        let whole = unquoted(line.text);
        let line = if whole.contains('=') { Line { text: whole, ..line } } else { line };
        if line.text.starts_with(COMMENTS) {
            return Ok(());
        }
        if let Some((key, value)) = line.key_value() {
            if self.points.at.len() > self.from {
                let advice = "move the header before the points";
                return Err(line.error(line.text, "points up to the end", advice));
            }
            return self.header.set(line, key, value);
        }
        if !self.in_data {
            self.begin_data(line)?;
        }
        if self.header.lacks_value(line)? {
            self.points.no_value(line);
            return Ok(());
        }
        let point = self.header.point(line)?;
        self.points.push(line, point, 1.0)
    }

    /// Begins the points where no blank line precedes them.
    fn begin_data(&mut self, line: Line) -> Result<()> {
        let fields = line.without_comment(&COMMENTS).fields()?;
        if fields.len() < 2 || !fields[..2].iter().all(|field| is_number(field)) {
            let expected = "`key=value`, or a row of numbers";
            return Err(line.error(line.text, expected, "correct or delete the line"));
        }
        self.points.note(line.number, "no blank line before the points");
        self.in_data = true;
        Ok(())
    }

    fn section(&mut self, line: Line) -> Result<()> {
        let name = line.text.to_lowercase();
        if name.ends_with("points]") {
            self.in_data = true;
        } else if name.ends_with("info]") {
            self.close_header()?;
            if self.points.at.len() > self.from {
                self.points.sections.push(self.points.at.len());
            }
            (self.header, self.from, self.in_data) = (MiniProfHeader::default(), self.points.at.len(), false);
        } else {
            let expected = "[FileInfo], [Profile1Info], [Profile1Points], …";
            return Err(line.error(line.text, expected, "delete the section"));
        }
        Ok(())
    }

    /// Ends a header: moves the points by its offset, keeps its elements, and compares its counts.
    fn close_header(&mut self) -> Result<()> {
        let header = std::mem::take(&mut self.header);
        for point in &mut self.points.at[self.from..] {
            point.x += header.offset[0];
            point.z += header.offset[1];
        }
        self.points.diameter = self.points.diameter.or(header.diameter);
        self.points.stated.extend(header.stated);
        let points = self.points.at.len() - self.from;
        let elements = header.elements.len();
        let counts = [("XYPoints", header.count, points), ("MPDC", header.element_count, elements)];
        for (key, stated, found) in counts {
            if let Some((stated, line)) = stated.filter(|(stated, _)| *stated != found && found > 0) {
                self.points.note(line, format!("{key}={stated}, but {found} follow: all are taken"));
            }
        }
        let mut elements = header.elements;
        elements.sort_by_key(|(k, ..)| *k);
        for (_, number, shape) in elements {
            let [dx, dz] = header.offset;
            self.points.push_element(Line { number, text: "" }, moved(shape, dx, dz))?;
        }
        Ok(())
    }
}

fn moved(shape: ElementShape, dx: f64, dz: f64) -> ElementShape {
    let by = |[x, z]: [f64; 2]| [x + dx, z + dz];
    match shape {
        ElementShape::Line { from, to } => ElementShape::Line { from: by(from), to: by(to) },
        ElementShape::Arc { center, radius, angles } => {
            ElementShape::Arc { center: by(center), radius, angles }
        }
    }
}

impl Default for MiniProfHeader {
    fn default() -> Self {
        let (elements, element_count) = (Vec::new(), None);
        let (columns, offset) = ([0, 1], [0.0; 2]);
        let (diameter, stated) = (None, Vec::new());
        Self { columns, width: 2, offset, count: None, elements, element_count, diameter, stated }
    }
}

impl MiniProfHeader {
    fn set(&mut self, line: Line, key: &str, value: &str) -> Result<()> {
        // Keys have several spellings: XOffset, Xoffset.
        let key = key.to_lowercase();
        match key.as_str() {
            "columndef" if !value.is_empty() => self.set_columns(line, value)?,
            "xoffset" => self.offset[0] = optional(line, value, "offset")?,
            "yoffset" => self.offset[1] = optional(line, value, "offset")?,
            "xypoints" => self.count = count(line, value)?,
            "diametertaperline" => {
                self.diameter = Some(optional(line, value, "diameter")?).filter(|value| *value > 0.0);
            }
            "mpdc" => self.element_count = count(line, value)?,
            _ => {
                let known = STATED.iter().find(|own| key.eq_ignore_ascii_case(own));
                let own = known.zip(value.trim().parse().ok().filter(|value: &f64| value.is_finite()));
                self.stated.extend(own.map(|(key, value)| StatedValue {
                    key: (*key).into(),
                    value,
                    line: line.number,
                }));
                if let Some(k) = key.strip_prefix("mpd").and_then(|k| k.parse().ok()) {
                    self.elements.push((k, line.number, element(line, value)?));
                }
            }
        }
        Ok(())
    }

    fn set_columns(&mut self, line: Line, value: &str) -> Result<()> {
        let names: Vec<_> = value.split([',', ' ', ';']).map(str::trim).filter(|n| !n.is_empty()).collect();
        let find = |name: &str| {
            let mut all = (0..names.len()).filter(|&k| names[k].eq_ignore_ascii_case(name));
            all.next().filter(|_| all.next().is_none())
        };
        let (Some(x), Some(y)) = (find("X"), find("Y")) else {
            let advice = "name each column once, X and Y among them";
            return Err(line.error(line.text, "ColumnDef=X,Y or X,Y,A,C", advice));
        };
        (self.columns, self.width) = ([x, y], names.len());
        Ok(())
    }

    /// Tells whether a row says that X or Y has no value.
    fn lacks_value(&self, line: Line) -> Result<bool> {
        let fields = line.without_comment(&COMMENTS).fields()?;
        let lacks = |k: &usize| fields.get(*k).is_some_and(|field| !field.is_empty() && is_missing(field));
        Ok(self.columns.iter().any(lacks))
    }

    /// Returns X and Y of a row. Text after the numbers of the columns is a comment.
    fn point(&self, line: Line) -> Result<[f64; 2]> {
        let row = line.without_comment(&COMMENTS);
        let fields = row.fields()?;
        let number = |k: usize, what| match fields.get(self.columns[k]) {
            Some(field) => row.number(field, what),
            None => Err(line.error(line.text, "X and Y by ColumnDef", "correct or delete the line")),
        };
        let point = [number(0, "X")?, number(1, "Y")?];
        for (k, field) in fields.iter().enumerate().take(self.width) {
            if !is_number(field) {
                if field.starts_with(|c: char| c.is_alphabetic()) && !self.columns.iter().any(|&c| c > k) {
                    break;
                }
                row.number(field, "column")?;
            }
        }
        Ok(point)
    }
}

/// Reads a number that may be left out; it is then 0.
fn optional(line: Line, value: &str, what: &str) -> Result<f64> {
    let value = Line { text: value, ..line }.without_comment(&COMMENTS).text;
    if value.is_empty() { Ok(0.0) } else { line.number(value, what) }
}

fn count(line: Line, value: &str) -> Result<Option<(usize, usize)>> {
    let value = Line { text: value, ..line }.without_comment(&COMMENTS).text;
    if value.is_empty() {
        return Ok(None);
    }
    let count = value.parse().map_err(|_| line.error(line.text, "a count", "correct or empty the value"))?;
    Ok(Some((count, line.number)))
}

/// Reads `A x y radius from to` with angles in degrees, or `L x y x y`.
fn element(line: Line, value: &str) -> Result<ElementShape> {
    let fields = Line { text: value, ..line }.fields()?;
    let kind = fields.first().copied().unwrap_or_default().to_uppercase();
    let numbers: Vec<f64> =
        fields.iter().skip(1).map(|field| line.number(field, "element")).collect::<Result<_>>()?;
    match (kind.as_str(), &numbers[..]) {
        ("L", &[x0, y0, x1, y1]) => Ok(ElementShape::Line { from: [x0, y0], to: [x1, y1] }),
        ("A", &[x, y, radius, from, to]) if radius > 0.0 && to > from && to - from <= 360.0 => {
            let angles = [from.to_radians(), to.to_radians()];
            Ok(ElementShape::Arc { center: [x, y], radius, angles })
        }
        _ => {
            let expected = "`A x y radius from to` with radius > 0 and angles ascending, or `L x y x y`";
            Err(line.error(clipped(value), expected, "correct or delete the element"))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RAIL: &str = include_str!("../../../tests/profiles/new-style.ban");
    const WHEEL: &str = include_str!("../../../tests/profiles/old-style.whl");
    const SECTIONS: &str = include_str!("../../../tests/profiles/sections.mpt");
    const DESIGN: &str = include_str!("../../../tests/profiles/design.ban");

    #[test]
    fn new_style_with_its_quirks() -> Result<()> {
        let points = read(RAIL)?;
        assert_eq!(points.at.len(), 53);
        // Yoffset=1.5 is added. The quoted ColumnDef counts until the plain one; the quoted row does not count.
        assert_eq!(points.at[0].xz(), [-37.0621, -36.602 + 1.5]);
        assert_eq!(points.at[3].line, 26);
        assert_eq!(points.notes.len(), 1, "{:?}", points.notes);
        assert!(points.notes[0].text.starts_with("XYPoints=54"), "{:?}", points.notes);
        Ok(())
    }

    #[test]
    fn old_style_with_and_without_its_blank_line() -> Result<()> {
        let points = read(WHEEL)?;
        let without_blank = read(&WHEEL.replace("(Sd/Sh/qR)\n\n", "(Sd/Sh/qR)\n"))?;
        assert_eq!(points.at[0].xz(), without_blank.at[0].xz());
        assert_eq!(points.at.len(), without_blank.at.len());
        let split = read(&WHEEL.replace("  (Sd/Sh/qR)\n\n", "\n(Sd/Sh/qR)\n"))?;
        assert_eq!(points.at[0].xz(), split.at[0].xz());
        Ok(())
    }

    #[test]
    fn sections_are_kept_apart() -> Result<()> {
        let points = read(SECTIONS)?;
        assert_eq!(points.sections, [0, 30]);
        assert_eq!(points.clone().section(2)?.at.len(), 28);
        assert!(points.section(3).is_err());
        Ok(())
    }

    #[test]
    fn design_elements_need_no_points() -> Result<()> {
        let points = read(DESIGN)?;
        assert_eq!((points.at.len(), points.elements.len()), (0, 7));
        assert!(read("MPD1=A 0 0 -1 0 90\n").is_err_and(|e| e.place == "line 1"));
        assert!(read("MPD1=Q 0 0\n").is_err_and(|e| e.place == "line 1"));
        Ok(())
    }

    #[test]
    fn a_missing_blank_line_is_noted_and_nonsense_is_an_error() -> Result<()> {
        let points = read("ColumnDef=Y,X\n1.0, 2.0\n3.0, 4.0 note\n")?;
        assert_eq!(points.at[1].xz(), [4.0, 3.0]);
        assert_eq!(points.notes.len(), 1);
        for (text, place) in [
            ("ColumnDef=A,C\n\n1 2\n", "line 1"),
            ("ColumnDef=X,X,Y\n\n1 2\n", "line 1"),
            ("Rail=\n\n1 2\n3\n", "line 4"),
            ("Rail=\n\n1 2\n3 4x\n", "line 4"),
            ("Rail=\n\n1 2\n3 4\nRail=2\n", "line 5"),
            ("Rail\n1 2\n3 4\n", "line 1"),
            ("Xoffset=abc\n\n1 2\n3 4\n", "line 1"),
            ("XYPoints=x\n\n1 2\n3 4\n", "line 1"),
            ("[FileInfo]\n[Foo]\n", "line 2"),
            ("Rail=low\n", "line 2"),
        ] {
            assert!(read(text).is_err_and(|e| e.place == place), "{text:?}: {:?}", read(text));
        }
        Ok(())
    }
}

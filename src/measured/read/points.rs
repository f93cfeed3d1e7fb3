//! The content of a file: points, design elements, and notes on oddities.

use serde::{Deserialize, Serialize};

use super::scan::{Line, last_place};
use crate::error::{Error, ErrorKind, Result, finite};
use crate::measured::Format;
use crate::measured::column::Column;
use crate::numerics::interval::Interval;
use crate::profile::Side;

/// Most points of one file. A profile of 200 mm would have a point every 0.2 µm; a file with more points is not a profile.
pub const MOST_POINTS: usize = 1_000_000;
/// Most design elements of one file.
pub const MOST_ELEMENTS: usize = 10_000;

/// One measured point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Lateral coordinate: as in the file before placing, \[mm\] in profile axes after it.
    pub x: f64,
    /// Height: as in the file before placing, \[mm\] in profile axes after it.
    pub z: f64,
    /// Relative weight in a smoothing fit; 1 unless the file gives one; typical 0.1–10.
    pub weight: f64,
    /// Number of the point in the file, from 1.
    pub number: usize,
    /// Line of the point in the file, from 1; 0 for points that no file holds.
    pub line: usize,
}

impl Point {
    /// Returns the coordinates \[x, z\].
    pub fn xz(&self) -> [f64; 2] {
        [self.x, self.z]
    }

    /// Returns the place of the point in the file: "point 12 (line 40)".
    pub fn place(&self) -> String {
        if self.line == 0 {
            return format!("point {}", self.number);
        }
        format!("point {} (line {})", self.number, self.line)
    }
}

/// One element of a design profile (MiniProf `MPDk=`), in the file's own axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DesignElement {
    /// Shape of the element.
    pub shape: ElementShape,
    /// Line of the element in the file, from 1.
    pub line: usize,
}

/// A line or an arc of a design profile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ElementShape {
    /// A straight line.
    Line {
        /// One end.
        from: [f64; 2],
        /// The other end.
        to: [f64; 2],
    },
    /// A circular arc, counter-clockwise in the file's axes from the first to the second angle.
    Arc {
        /// Centre.
        center: [f64; 2],
        /// Radius, positive.
        radius: f64,
        /// Angles of the two ends \[rad\] from the file's first axis to its second, ascending.
        angles: [f64; 2],
    },
}

/// An oddity in a file that was read all the same.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Note {
    /// Line in the file, from 1.
    pub line: usize,
    /// What is odd and what was done about it.
    pub text: String,
}

/// A value \[mm\] that a file states of its profile.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StatedValue {
    /// Name of the value in the file: Sd, Sh, qR, W1, W2 or W3.
    pub key: String,
    /// The value \[mm\].
    pub value: f64,
    /// Line of the file.
    pub line: usize,
}

/// The content of a file, in its order, its unit and its axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Points {
    /// Format of the file.
    pub format: Format,
    /// Body that the file names; `None` if it names none.
    pub body: Option<Side>,
    /// Length \[mm\] of the unit of the coordinates; `None` if neither the format nor the file states it.
    pub unit: Option<f64>,
    /// The measured points.
    pub at: Vec<Point>,
    /// Index of the first point of each section. Formats without sections have one.
    pub sections: Vec<usize>,
    /// Design elements, in the numbering of the file.
    pub elements: Vec<DesignElement>,
    /// Diameter of the wheel at its taping line \[mm\], if the file holds it.
    pub diameter: Option<f64>,
    /// Values of the profile that the file holds.
    pub stated: Vec<StatedValue>,
    /// Notes on oddities.
    pub notes: Vec<Note>,
    /// Length \[mm\] of the file's unit by which the coordinates were multiplied already; 1 if they were not.
    pub applied: f64,
    /// Line of a table's head that states the unit; `None` for other formats, and where it states none.
    pub unit_line: Option<usize>,
    /// Rows without values between points.
    pub gaps: Vec<Gap>,
    /// The first and the last line of rows without values behind the last point.
    pub(in crate::measured) pending: Option<(usize, usize)>,
    /// The columns of a table that was read by its likeliest two, for want of an option.
    pub columns: Option<ColumnChoice>,
}

/// Rows of a file that have no value, between two of its points.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Gap {
    /// Numbers of the points before and after them.
    pub between: [usize; 2],
    /// The first and the last of these lines; of points that no file holds, of their rows.
    pub lines: (usize, usize),
}

/// The columns of a table, of which two are to be chosen.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ColumnChoice {
    /// Number of columns.
    pub count: usize,
    /// Their names; none without a row of names.
    pub names: Vec<String>,
    /// Line of the first row.
    pub line: usize,
    /// The two by which the table was read, where their names or the others tell them; `None` where it is any two.
    pub likely: Option<[Column; 2]>,
}

/// Largest distance between the end of one section and the beginning of the next one of a profile, as a share of the whole file's
/// reach; and the least share of a section's reach that lies within the previous ones if it is a profile of its own.
const APART: f64 = 0.5;
/// Least share of the reach of the previous sections that a section has if it may be a profile of its own.
const PIECE: f64 = 0.25;

impl Points {
    pub(in crate::measured) fn new(format: Format, unit: Option<f64>) -> Self {
        Self {
            format,
            unit,
            body: None,
            at: Vec::new(),
            sections: vec![0],
            elements: Vec::new(),
            diameter: None,
            stated: Vec::new(),
            notes: Vec::new(),
            applied: 1.0,
            unit_line: None,
            gaps: Vec::new(),
            pending: None,
            columns: None,
        }
    }

    /// Begins a section with the next point.
    pub(in crate::measured) fn begin_section(&mut self) {
        self.pending = None;
        if self.sections.last() != Some(&self.at.len()) {
            self.sections.push(self.at.len());
        }
    }

    /// Takes a row without a value: a gap, if points follow.
    pub(in crate::measured) fn no_value(&mut self, line: Line) {
        let first = self.pending.map_or(line.number, |(first, _)| first);
        self.pending = Some((first, line.number));
    }

    /// Returns the indices at which profiles begin: sections that go on where the previous one ends belong to one profile.
    pub(in crate::measured) fn profiles(&self) -> Vec<usize> {
        let whole = Self::reach(&self.at);
        let size = whole[0].width().max(whole[1].width());
        let mut out = vec![0];
        let inside = self.sections.iter().copied().filter(|from| (1..self.at.len()).contains(from));
        let starts: Vec<usize> = inside.collect();
        let end = |k: usize| starts.get(k).copied().unwrap_or(self.at.len());
        let mut before = Self::reach(&self.at[..end(0)]);
        for (k, &from) in starts.iter().enumerate() {
            let next = end(k + 1);
            let own = Self::reach(&self.at[from..next]);
            let (last, begin) = (self.at[from - 1], self.at[from]);
            let apart = (begin.x - last.x).hypot(begin.z - last.z) > APART * size;
            let larger = |of: &[Interval; 2]| of[0].width().max(of[1].width());
            let whole = larger(&own) > PIECE * larger(&before);
            let within = (0..2).all(|k| {
                let least = before[k].width().min(own[k].width());
                before[k].cut(own[k]).width() >= APART * least
            });
            if apart || whole && within {
                out.push(from);
                before = own;
            } else {
                before = [before[0].hull(own[0]), before[1].hull(own[1])];
            }
        }
        out
    }

    fn reach(at: &[Point]) -> [Interval; 2] {
        [Interval::around(at.iter().map(|p| p.x)), Interval::around(at.iter().map(|p| p.z))]
    }

    /// Joins the sections that belong to one profile.
    pub(in crate::measured) fn join_sections(&mut self) {
        self.sections = self.profiles();
    }

    pub(in crate::measured) fn push(&mut self, line: Line, at: [f64; 2], weight: f64) -> Result<()> {
        self.push_numbered(self.at.len() + 1, line, at, weight)
    }

    fn push_numbered(&mut self, number: usize, line: Line, [x, z]: [f64; 2], weight: f64) -> Result<()> {
        if self.at.len() >= MOST_POINTS {
            return Err(line.error(
                "one more point",
                format!("{MOST_POINTS} points at most"),
                "thin them out",
            ));
        }
        if let (Some(lines), Some(before)) = (self.pending.take(), self.at.last()) {
            self.gaps.push(Gap { between: [before.number, number], lines });
        }
        self.at.push(Point { x, z, weight, number, line: line.number });
        Ok(())
    }

    /// Takes rows \[x, z\] that no file holds; NaN is no value. Points are numbered by their rows.
    ///
    /// # Errors
    /// An infinite coordinate, at the place that is named before the row's number; more points than [`MOST_POINTS`].
    pub(in crate::measured) fn take_rows(&mut self, place: &str, rows: &[[f64; 2]]) -> Result<()> {
        for (row, &[x, z]) in (1..).zip(rows) {
            if x.is_nan() || z.is_nan() {
                self.no_value(Line { number: row, text: "" });
                continue;
            }
            let place = format!("{place}: point {row}");
            let at = [finite(&place, x)?, finite(&place, z)?];
            self.push_numbered(row, Line { number: 0, text: "" }, at, 1.0)?;
        }
        Ok(())
    }

    pub(in crate::measured) fn push_element(&mut self, line: Line, shape: ElementShape) -> Result<()> {
        if self.elements.len() >= MOST_ELEMENTS {
            let expected = format!("{MOST_ELEMENTS} elements at most");
            let error = line.error("one more element", expected, "give the points instead");
            return Err(error.of_kind(ErrorKind::Limit));
        }
        self.elements.push(DesignElement { shape, line: line.number });
        Ok(())
    }

    pub(in crate::measured) fn note(&mut self, line: usize, text: impl Into<String>) {
        self.notes.push(Note { line, text: text.into() });
    }

    /// Ends the reading.
    ///
    /// # Errors
    /// Fewer than two points and no design element; coordinates that overflowed.
    pub(in crate::measured) fn finish(self, text: &str) -> Result<Self> {
        if self.at.len() < 2 && self.elements.is_empty() {
            let found = format!("{} points up to the end of the file", self.at.len());
            let expected = format!("a profile as {} writes it", self.format.title());
            return Err(Error::new(last_place(text), found, expected, "give another file or its `format`"));
        }
        if let Some(far) = self.at.iter().find(|point| !(point.x.is_finite() && point.z.is_finite())) {
            let advice = "correct the numbers, the shift or the unit";
            return Err(Error::new(far.place(), "an overflow", "finite coordinates", advice));
        }
        Ok(self)
    }

    /// Keeps only one section, counted from 1.
    ///
    /// # Errors
    /// A section that the file does not have.
    pub fn section(mut self, number: usize) -> Result<Self> {
        let bounds = number.checked_sub(1).and_then(|k| self.sections.get(k).map(|&from| (k, from)));
        let Some((k, from)) = bounds else {
            let expected = format!("1 to {}", self.sections.len());
            return Err(Error::new("section", number.to_string(), expected, "choose one of the file's"));
        };
        let to = self.sections.get(k + 1).copied().unwrap_or(self.at.len());
        let numbers = from..to;
        self.gaps.retain(|gap| numbers.contains(&gap.between[0]));
        self.at = self.at[from..to].to_vec();
        self.sections = vec![0];
        Ok(self)
    }
}

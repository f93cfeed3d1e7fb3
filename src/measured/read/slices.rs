//! Reads the lists of slices of CONTACT: `.slcs`, rails that vary along the track, and `.slcw`, wheels that vary around
//! their circumference. Such a file names the files of its slices, each a profile of its own, and where they lie.
//!
//! ```text
//! offset scale                        position = scale (offset + number), mm or rad
//! n_slices
//! n_features [n_kinks [n_jumps]]
//! method [perturbations]              1 or 2
//! number 'file'                       n_slices times
//! part …                              n_kinks, then n_jumps numbers, where there are any
//! number s_1 … s_n                    n_slices times, where n_features > 1: arc lengths, mm; < 0 for a missing one
//! ```
//!
//! `!`, `%` and `"` begin a comment, and a group of values may be spread over lines. What follows the last value of a
//! group on its line is a comment, too.
//!
//! A list may also be no more than a position and a file in each line, in either order and with any separator, under a line that has
//! the unit of the positions: `mm`, `m` or `km`, of wheels `rad` or `deg`, alone or in the brackets of a title.

use super::dialect::is_numeric;
use super::points::Note;
use super::scan::{self, Line, clipped, is_number, unquoted};
use crate::error::{Error, ErrorKind, Result};
use crate::measured::unit::Unit;
use crate::profile::Side;

/// Most slices of one file.
pub const MOST_SLICES: usize = 10_000;
/// Most features of a slice, as CONTACT has it.
const MOST_FEATURES: usize = 999;
/// Least distance of two slices \[mm or rad\], as CONTACT has it; and largest difference between the position of a slice and
/// that which the row of its features gives.
const LEAST_APART: f64 = 1e-3;

/// One slice of a list.
#[derive(Debug, Clone, PartialEq)]
pub struct ListedSlice {
    /// Position: along the track \[mm\], or around the wheel \[rad\].
    pub at: f64,
    /// File of the slice, relative to the list.
    pub file: String,
    /// Arc lengths of the features \[mm\], negative where the slice does not have one; none if the list has no features.
    /// They count from the side of the track's centre on a rail, and from the field side on a wheel.
    pub features: Vec<f64>,
    /// Line of the slice in the list, from 1.
    pub line: usize,
}

/// The content of a list, without that of its slices.
#[derive(Debug, Clone, PartialEq)]
pub struct SliceList {
    /// Body of the slices.
    pub side: Side,
    /// The slices by ascending position.
    pub slices: Vec<ListedSlice>,
    /// Whether the file asks for a spline near its slices, not through them (method 2).
    pub approximated: bool,
    /// What the file says and this program does not use.
    pub notes: Vec<Note>,
}

/// Returns the body that a list of slices describes, by its extension in upper or lower case; `None` for a file that is no
/// such list.
pub fn listed_body(file: &str) -> Option<Side> {
    let extension = file.rsplit_once('.').map_or("", |(_, extension)| extension);
    let lists = [("slcs", Side::Rail), ("slcw", Side::Wheel)];
    lists.into_iter().find(|(own, _)| extension.eq_ignore_ascii_case(own)).map(|(_, side)| side)
}

impl SliceList {
    /// Reads a list of slices of a body.
    ///
    /// # Errors
    /// Anything that is not of the grammar, with its line; positions that do not ascend; perturbations.
    pub fn read(bytes: &[u8], side: Side) -> Result<Self> {
        let text = scan::text(bytes)?;
        if let Some(slices) = plain_list(&text, side)? {
            check_positions(&slices, side)?;
            return Ok(Self { side, slices, approximated: false, notes: Vec::new() });
        }
        let mut groups = Groups::new(&text);
        let first = groups.next("offset and scale of the positions", 2)?;
        let (offset, scale) = (first.number(0, "an offset")?, first.number(1, "a scale")?);
        if scale <= 0.0 {
            return Err(first.error(0, format!("a scale of {scale}"), "a positive one", "correct it"));
        }
        let position = |number: f64| scale * (offset + number);
        let count = groups.next("the number of slices", 1)?;
        let count = count.count(0, "a number of slices", 1..=MOST_SLICES)?;
        let head = groups.next("the numbers of features, kinks and jumps", 1)?;
        let features = head.count(0, "a number of features", 0..=MOST_FEATURES)?;
        let [kinks, jumps] = [1, 2].map(|k| head.optional(k).filter(|_| features > 1).unwrap_or(0));
        let (approximated, mut notes) = method(&groups.next("the method of interpolation", 1)?)?;
        let mut slices = Vec::with_capacity(count);
        for number in 1..=count {
            slices.push(slice(&groups.next(&format!("slice {number} of {count}"), 2)?, position)?);
        }
        check_positions(&slices, side)?;
        for (what, several) in [("kinks", kinks), ("jumps of curvature", jumps)] {
            if several > 0 {
                let row = groups.next(&format!("the parts with {what}"), several)?;
                let text = format!("{what} between parts are not used");
                notes.push(Note { line: row.line.number, text });
            }
        }
        if features > 1 {
            for slice in &mut slices {
                let row = groups.next(&format!("the features of {}", slice.file), 1 + features)?;
                let at = position(row.number(0, "a position")?);
                if (at - slice.at).abs() >= LEAST_APART {
                    let expected = format!("the features of the slice at {}", slice.at);
                    return Err(row.error(0, format!("those of one at {at}"), expected, "sort the rows"));
                }
                slice.features =
                    (1..=features).map(|k| row.number(k, "an arc length")).collect::<Result<_>>()?;
            }
        }
        Ok(Self { side, slices, approximated, notes })
    }
}

/// Reads a list of positions and files alone; `None` for a list in CONTACT's grammar, which begins with two numbers.
///
/// # Errors
/// No unit before the first row; a row that is not a position and a file.
fn plain_list(text: &str, side: Side) -> Result<Option<Vec<ListedSlice>>> {
    let rows: Vec<Line> = scan::lines(text).filter(|line| !line.text.is_empty()).collect();
    let is_number = |word: &str| is_numeric(word);
    let contact =
        |line: &&Line| without_comment(**line).text.split_whitespace().next().is_some_and(is_number);
    let Some(first) = rows.iter().position(|line| position_and_file(without_comment(*line).text).is_some())
    else {
        return Ok(None);
    };
    if rows[..first].iter().any(|line| contact(&line)) {
        return Ok(None);
    }
    let Some(unit) = rows[..first].iter().find_map(|line| position_unit(line.text, side)) else {
        let found = "positions without a unit";
        let (expected, advice) = match side {
            Side::Rail => (
                "mm, m or km before them, or CONTACT's list",
                "put `m`, `mm` or `km` on a line of its own before this one",
            ),
            Side::Wheel => (
                "rad or deg before them, or CONTACT's list",
                "put `rad` or `deg` on a line of its own before this one",
            ),
        };
        return Err(rows[first].error(found, expected, advice));
    };
    let mut slices = Vec::new();
    for line in rows[first..].iter().map(|line| without_comment(*line)).filter(|line| !line.text.is_empty()) {
        let Some((position, file)) = position_and_file(line.text) else {
            return Err(line.error(line.text, "a position and a file", "correct or delete the line"));
        };
        if slices.len() == MOST_SLICES {
            let error =
                line.error("one more slice", format!("{MOST_SLICES} slices at most"), "thin them out");
            return Err(error.of_kind(ErrorKind::Limit));
        }
        let at = unit * line.number(&position.replace('\u{2212}', "-"), "a position")?;
        slices.push(ListedSlice { at, file: file.into(), features: Vec::new(), line: line.number });
    }
    Ok(Some(slices))
}

/// Returns the length \[mm or rad\] of the unit that a line of a plain list names, alone or in brackets.
fn position_unit(text: &str, side: Side) -> Option<f64> {
    let marks = |c: char| c.is_whitespace() || "[](){}!%#\",;:=_".contains(c);
    text.split(marks).find_map(|word| match (side, word.to_lowercase().as_str()) {
        (Side::Rail, "km") => Some(1e6),
        (Side::Rail, word) => Unit::named(word).map(Unit::millimetres),
        (Side::Wheel, "rad") => Some(1.0),
        (Side::Wheel, "deg" | "°") => Some(std::f64::consts::PI / 180.0),
        _ => None,
    })
}

/// Splits a line into a position and the name of a file, in either order; `None` if it has other words.
pub(super) fn position_and_file(text: &str) -> Option<(&str, &str)> {
    // A comma before a digit is decimal.
    let between = |c: char| c.is_whitespace() || c == ';' || c == ',';
    let decimal =
        |at: usize| text[at..].starts_with(',') && text[at + 1..].starts_with(|c: char| c.is_ascii_digit());
    let file = |text: &'_ str| -> Option<(usize, usize)> {
        // A name ends with its extension; what follows it is a comment.
        let quoted = text.starts_with(['\'', '"']).then(|| text[1..].find(['\'', '"'])).flatten();
        let (from, to) = match quoted {
            Some(end) => (1, 1 + end),
            None => {
                let dot = text.rfind('.')?;
                (0, text[dot..].find(between).map_or(text.len(), |end| dot + end))
            }
        };
        let extension = text[from..to].rsplit_once('.').map_or("", |(_, extension)| extension);
        let named = extension.starts_with(|c: char| c.is_alphabetic()) && !is_numeric(&text[from..to]);
        named.then_some((from, to))
    };
    let ends = text.char_indices().filter(|(at, c)| between(*c) && !decimal(*at)).map(|(at, _)| at);
    for at in ends {
        let (head, rest) = (text[..at].trim(), text[at..].trim_start_matches(between));
        if is_numeric(head)
            && let Some((from, to)) = file(rest)
        {
            return Some((head, &rest[from..to]));
        }
    }
    let (from, to) = file(text)?;
    let position = text[to..].trim_matches(|c| between(c) || c == '\'' || c == '"');
    is_numeric(position).then(|| (position, &text[from..to]))
}

/// Reads whether the method of interpolation approximates, with a note that sections do not use the method. Refuses perturbations.
fn method(row: &Group<'_>) -> Result<(bool, Vec<Note>)> {
    let method = row.count(0, "a method of interpolation", 1..=2)?;
    if let Some(kind) = row.optional(1).filter(|kind| *kind != 0) {
        let found = format!("perturbations of kind {kind}");
        let expected = "slices alone: the sign of waves that are added to them is not documented";
        return Err(row.error(1, found, expected, "put the waves into slices and write 0"));
    }
    let name = if method == 1 { "a spline" } else { "an approximating spline" };
    let text = format!("{name} between slices is asked for; sections are interpolated in straight lines");
    Ok((method == 2, vec![Note { line: row.line.number, text }]))
}

fn slice(row: &Group<'_>, position: impl Fn(f64) -> f64) -> Result<ListedSlice> {
    let at = position(row.number(0, "a position")?);
    let file = unquoted(row.words[1].1);
    if file.is_empty() || is_number(file) {
        let expected = "the file of the slice, in single quotes";
        return Err(row.error(1, format!("\"{}\"", clipped(row.words[1].1)), expected, "name it"));
    }
    Ok(ListedSlice { at, file: file.into(), features: Vec::new(), line: row.line.number })
}

/// Rejects positions that do not ascend, and angles beyond ±π, unless they go all around a wheel and stay within ±1.5 π.
fn check_positions(slices: &[ListedSlice], side: Side) -> Result<()> {
    use std::f64::consts::PI;
    /// Rounding of π \[rad\] in files that give it with four decimals.
    const DIGITS: f64 = 1e-4;
    let unit = unit(side);
    for pair in slices.windows(2) {
        let apart = pair[1].at - pair[0].at;
        if apart <= LEAST_APART || apart.is_nan() {
            let found = format!("a slice at {} {unit} after one at {} {unit}", pair[1].at, pair[0].at);
            let expected = format!("ascending positions, more than {LEAST_APART} {unit} apart");
            let place = format!("line {}", pair[1].line);
            return Err(Error::new(place, found, expected, "sort the slices, or check the scale"));
        }
    }
    let ([first, .., last], Side::Wheel) = (slices, side) else { return Ok(()) };
    let once = first.at >= -PI - DIGITS && last.at <= PI + DIGITS;
    let around = first.at <= -PI + DIGITS && last.at >= PI - DIGITS;
    if (once || around) && first.at >= -1.5 * PI && last.at <= 1.5 * PI {
        return Ok(());
    }
    let found = format!("slices from {} to {} rad", first.at, last.at);
    let expected = "angles within [-π, π], or all around it and within [-1.5 π, 1.5 π]";
    Err(Error::new(format!("line {}", first.line), found, expected, "check offset and scale"))
}

/// Returns the unit of positions.
pub(in crate::measured) fn unit(side: Side) -> &'static str {
    match side {
        Side::Rail => "mm",
        Side::Wheel => "rad",
    }
}

/// The groups of values of a file.
struct Groups<'a> {
    text: &'a str,
    lines: Vec<Line<'a>>,
    next: usize,
}

/// One group of values, and what follows it on its last line.
struct Group<'a> {
    /// Its first line.
    line: Line<'a>,
    /// Each word with its line; strings keep their quotes.
    words: Vec<(Line<'a>, &'a str)>,
}

impl<'a> Groups<'a> {
    fn new(text: &'a str) -> Self {
        let lines = scan::lines(text).map(without_comment).filter(|line| !line.text.is_empty()).collect();
        Self { text, lines, next: 0 }
    }

    /// Takes lines until there are `count` words.
    fn next(&mut self, what: &str, count: usize) -> Result<Group<'a>> {
        let mut words = Vec::new();
        let mut first = None;
        while words.len() < count {
            let Some(&line) = self.lines.get(self.next) else {
                let place = scan::last_place(self.text);
                let found = format!("the end of the file after {} of {count} values", words.len());
                return Err(Error::new(place, found, what, "complete the file"));
            };
            self.next += 1;
            first.get_or_insert(line);
            words.extend(split(line.text).map(|word| (line, word)));
        }
        let line = first.unwrap_or(Line { number: 1, text: "" });
        Ok(Group { line, words })
    }
}

impl Group<'_> {
    fn number(&self, k: usize, what: &str) -> Result<f64> {
        let (line, word) = self.words[k];
        line.number(word, what)
    }

    fn count(&self, k: usize, what: &str, bounds: std::ops::RangeInclusive<usize>) -> Result<usize> {
        let (line, word) = self.words[k];
        if let Some(count) = word.parse().ok().filter(|count| bounds.contains(count)) {
            return Ok(count);
        }
        let expected = format!("{what} from {} to {}", bounds.start(), bounds.end());
        let error = line.error(format!("\"{}\"", clipped(word)), expected, "correct it");
        let many = word.parse::<usize>().is_ok_and(|count| count > *bounds.end());
        Err(if many { error.of_kind(ErrorKind::Limit) } else { error })
    }

    /// Returns a whole number that may be missing.
    fn optional(&self, k: usize) -> Option<usize> {
        self.words.get(k)?.1.parse().ok()
    }

    fn error(&self, k: usize, found: String, expected: impl Into<String>, advice: &str) -> Error {
        self.words[k].0.error(found, expected, advice)
    }
}

/// Returns a line without the comment at its end; marks between single quotes do not count.
fn without_comment(line: Line<'_>) -> Line<'_> {
    let mut quoted = false;
    let mark = line.text.char_indices().find(|(_, c)| {
        quoted ^= *c == '\'';
        !quoted && matches!(c, '!' | '%' | '"')
    });
    Line { text: mark.map_or(line.text, |(at, _)| line.text[..at].trim_end()), ..line }
}

/// Splits a line at white space and commas that are not between single quotes.
fn split(text: &str) -> impl Iterator<Item = &str> {
    let mut quoted = false;
    let words = text.split(move |c: char| {
        quoted ^= c == '\'';
        !quoted && (c == ',' || c.is_whitespace())
    });
    words.filter(|word| !word.is_empty())
}

//! How a table is written: what separates its fields, and which marks are decimal.

use std::borrow::Cow;

use super::scan::{Line, clipped, unquoted};
use crate::error::Result;

/// Most rows from which the separator is told.
const SAMPLE: usize = 2000;

/// Share of the most rows that a separator gives, from which on another one gives as many.
const NEARLY: f64 = 0.9;

/// What separates the fields of a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Dialect {
    /// Semicolons.
    Semicolon,
    /// Tabs.
    Tab,
    /// Commas, and white space beside them.
    Comma,
    /// White space.
    White,
    /// Every second comma; the others are decimal.
    SecondComma,
}

impl Dialect {
    /// Finds the separator that gives most rows of numbers and missing values: the first one in the order above that gives nearly as many
    /// as any, since white space may also separate thousands.
    ///
    /// # Errors
    /// Commas of which some separate and some are decimal, and nothing tells which.
    pub(super) fn of(rows: &[Line]) -> Result<Self> {
        let sample = || rows.iter().filter(|line| !line.text.is_empty()).take(SAMPLE);
        let score = |dialect: Self| {
            let is_row = |line: &&Line| {
                let fields = dialect.fields(line.text);
                let numbers = fields.iter().filter(|field| is_numeric(field)).count();
                let missing = fields.iter().filter(|field| !field.is_empty() && is_missing(field)).count();
                numbers >= 1 && numbers + missing >= 2
            };
            sample().filter(is_row).count()
        };
        let all =
            [Self::Semicolon, Self::Tab, Self::Comma, Self::White].map(|dialect| (score(dialect), dialect));
        let most = all.iter().map(|(score, _)| *score).max().unwrap_or(0);
        let near = |score: usize| score as f64 >= NEARLY * most as f64 && score > 0;
        let best = all.into_iter().find(|(score, _)| near(*score)).map_or(Self::White, |(_, best)| best);
        if best != Self::Comma {
            return Ok(best);
        }
        Self::of_commas(sample())
    }

    /// Tells whether every second comma is decimal: rows of four whole numbers whose second and fourth have no sign, and one
    /// begins with 0.
    fn of_commas<'a>(sample: impl Iterator<Item = &'a Line<'a>>) -> Result<Self> {
        let (mut fractions, mut proven, mut rows, mut uneven) = (0, false, 0, None);
        let digits = |field: &str| !field.is_empty() && field.bytes().all(|b| b.is_ascii_digit());
        for line in sample {
            let fields = Self::Comma.fields(line.text);
            if fields.iter().filter(|field| is_numeric(field)).count() < 2 {
                continue;
            }
            rows += 1;
            let whole = |field: &&&str| !field.contains(['.', ',']) && is_numeric(field);
            let wholes = fields.iter().filter(whole).count() == fields.len();
            let alternate = || fields.iter().skip(1).step_by(2).all(|field| digits(field));
            if fields.len() == 4 && wholes && alternate() {
                fractions += 1;
                proven |= fields.iter().skip(1).step_by(2).any(|f| f.len() > 1 && f.starts_with('0'));
            } else if wholes && fields.len() == 3 {
                uneven = uneven.or(Some(*line));
            }
        }
        if proven && fractions == rows {
            return Ok(Self::SecondComma);
        }
        if let Some(line) = uneven.filter(|_| proven) {
            let advice = "separate the columns by semicolons or tabs, or write decimal points";
            return Err(line.error(line.text, "separators or decimal commas, not both", advice));
        }
        Ok(Self::Comma)
    }

    /// Splits a row into fields, without the quotes around them. What is between double quotes stays one field.
    pub(super) fn fields(self, text: &str) -> Vec<&str> {
        if text.is_empty() {
            return Vec::new();
        }
        match self {
            Self::Semicolon => cut(text, ';'),
            Self::Tab => cut(text, '\t'),
            Self::White => text.split_whitespace().map(unquoted).collect(),
            Self::Comma => {
                // Two numbers with white space between them are no field of a table of commas.
                let apart = |part: &&str| {
                    let inner = part.split_whitespace();
                    !part.contains(',') && inner.clone().count() > 1 && inner.clone().all(is_numeric)
                };
                let fields = cut(text, ',');
                if fields.iter().any(apart) { Vec::new() } else { fields }
            }
            Self::SecondComma if text.contains(char::is_alphabetic) => cut(text, ','),
            Self::SecondComma => {
                let mut at = 0;
                let parts = text.split(|c: char| {
                    at += usize::from(c == ',');
                    c == ',' && at % 2 == 0
                });
                parts.map(str::trim).collect()
            }
        }
    }
}

/// Splits at a mark that is not between double quotes. Empty fields at the end go.
fn cut(text: &str, mark: char) -> Vec<&str> {
    let mut quoted = false;
    let parts = text.split(|c: char| {
        quoted ^= c == '"';
        !quoted && c == mark
    });
    let mut fields: Vec<&str> = parts.map(|part| unquoted(part.trim())).collect();
    while fields.last().is_some_and(|last| last.is_empty()) {
        fields.pop();
    }
    fields
}

/// What a point or a comma means in a file's numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Role {
    Decimal,
    Thousands,
}

/// What points and commas mean in the numbers of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Marks {
    point: Role,
    comma: Role,
}

impl Marks {
    /// Tells from all numbers of a file what its marks mean.
    ///
    /// # Errors
    /// A number like "1.471" beside decimal commas, which may be 1471 or 1.471.
    pub(super) fn of<'a>(fields: impl Iterator<Item = (Line<'a>, &'a str)>) -> Result<Self> {
        // For point and comma: a field that proves it decimal, one that proves thousands, one that is open.
        let mut decimal: [Option<(Line, &str)>; 2] = [None; 2];
        let (mut thousands, mut open) = (decimal, decimal);
        for (line, field) in fields {
            for (k, [own, other]) in [['.', ','], [',', '.']].into_iter().enumerate() {
                let slot = match (field.matches(own).count(), field.rfind(other)) {
                    (0, _) => continue,
                    (1, Some(at)) if field.rfind(own) > Some(at) => &mut decimal[k],
                    (_, Some(_)) => &mut thousands[k],
                    (1, None) if !group_like(field, own) => &mut decimal[k],
                    (1, None) => &mut open[k],
                    (_, None) => &mut thousands[k],
                };
                slot.get_or_insert((line, field));
            }
        }
        let role = |k: usize| -> Result<Role> {
            let other = 1 - k;
            match (decimal[k], thousands[k], open[k]) {
                (Some((line, field)), Some(_), _) => Err(ambiguous(line, field)),
                (Some(_), None, _) => Ok(Role::Decimal),
                (None, Some(_), _) => Ok(Role::Thousands),
                (None, None, Some((line, field))) if decimal[other].or(open[other]).is_some() => {
                    Err(ambiguous(line, field))
                }
                _ => Ok(Role::Decimal),
            }
        };
        Ok(Self { point: role(0)?, comma: role(1)? })
    }

    /// Reads a number; `what` names it in an error.
    ///
    /// # Errors
    /// Any other text; digits between thousands' marks that are not three.
    pub(super) fn number(self, line: Line, field: &str, what: &str) -> Result<f64> {
        let role = |mark: char| if mark == '.' { self.point } else { self.comma };
        value(field, role).ok_or_else(|| {
            line.error(format!("{what} \"{}\"", clipped(field)), "a number", "correct or delete the line")
        })
    }
}

fn ambiguous(line: Line, field: &str) -> crate::error::Error {
    let found = format!("\"{field}\" beside numbers whose decimal mark is another");
    line.error(found, "one decimal mark in all numbers", "write all numbers with decimal points")
}

/// Tells whether the only mark of a field may separate thousands: one to three digits before it, the first not 0, and three after it.
fn group_like(field: &str, mark: char) -> bool {
    let bare = field.trim_start_matches(['-', '+', '\u{2212}', '\u{2013}', '\u{fe63}', '\u{ff0d}']);
    let Some((whole, group)) = bare.split_once(mark) else { return false };
    let digits = |text: &str| text.bytes().all(|b| b.is_ascii_digit());
    (1..=3).contains(&whole.len())
        && !whole.starts_with('0')
        && group.len() == 3
        && digits(whole)
        && digits(group)
}

/// Tells whether a field is a number in any writing.
pub(super) fn is_numeric(field: &str) -> bool {
    let (point, comma) = (field.rfind('.'), field.rfind(','));
    let role = |mark: char| {
        let (own, other) = if mark == '.' { (point, comma) } else { (comma, point) };
        let many = field.matches(mark).count() > 1;
        if many || (other.is_some() && own < other) { Role::Thousands } else { Role::Decimal }
    };
    value(field, role).is_some()
}

/// Reads a number with these meanings of points and commas. White space and apostrophes separate thousands.
fn value(field: &str, role: impl Fn(char) -> Role) -> Option<f64> {
    let text: Cow<str> =
        if field.is_ascii() { Cow::Borrowed(field) } else { Cow::Owned(field.chars().map(plain).collect()) };
    let simple = text.bytes().all(|b| b.is_ascii_digit() || matches!(b, b'-' | b'+' | b'.' | b'e' | b'E'));
    if simple && role('.') == Role::Decimal {
        return text.parse().ok().filter(|value: &f64| value.is_finite());
    }
    let end = text.find(['e', 'E', 'd', 'D']).unwrap_or(text.len());
    let (mantissa, exponent) = text.split_at(end);
    let (sign, bare) = match mantissa.strip_prefix(['-', '+']) {
        Some(bare) => (&mantissa[..1], bare),
        None => ("", mantissa),
    };
    let at = bare.rfind(|c| matches!(c, '.' | ',') && role(c) == Role::Decimal);
    let (whole, fraction) = at.map_or((bare, ""), |at| (&bare[..at], &bare[at + 1..]));
    let groups: Vec<&str> = whole.split(['.', ',', ' ', '\'']).collect();
    let digits = |text: &str| text.bytes().all(|b| b.is_ascii_digit());
    let grouped = |groups: &[&str]| {
        (1..=3).contains(&groups[0].len()) && groups[1..].iter().all(|group| group.len() == 3)
    };
    if !groups.iter().all(|group| digits(group)) || groups.len() > 1 && !grouped(&groups) || !digits(fraction)
    {
        return None;
    }
    let marks = whole.chars().filter(|c| matches!(c, '.' | ',') && role(*c) == Role::Decimal);
    if marks.count() > 0 || whole.is_empty() && fraction.is_empty() {
        return None;
    }
    let exponent = exponent.replace(['d', 'D'], "e");
    format!("{sign}{}.{fraction}{exponent}", groups.concat()).parse().ok().filter(|v: &f64| v.is_finite())
}

/// Returns the plain sign or mark that another one of Unicode stands for.
fn plain(c: char) -> char {
    match c {
        '\u{2212}' | '\u{2013}' | '\u{fe63}' | '\u{ff0d}' => '-',
        '\u{a0}' | '\u{2009}' | '\u{202f}' => ' ',
        '\u{2019}' => '\'',
        other => other,
    }
}

/// Tells whether a field says that there is no value.
pub(super) fn is_missing(field: &str) -> bool {
    const WORDS: [&str; 28] = [
        "",
        "nan",
        "+nan",
        "-nan",
        "nan(ind)",
        "-nan(ind)",
        "1.#qnan",
        "-1.#qnan",
        "1.#ind",
        "-1.#ind",
        "1.#inf",
        "-1.#inf",
        "inf",
        "+inf",
        "-inf",
        "na",
        "n/a",
        "#n/a",
        "#nv",
        "null",
        "none",
        "nil",
        "-",
        "--",
        "---",
        "*",
        "#value!",
        "#wert!",
    ];
    let field = field.to_lowercase();
    WORDS.contains(&field.as_str())
        || ["#num!", "#div/0!", "#ref!", "#name?", "#bezug!", "missing"].contains(&field.as_str())
}

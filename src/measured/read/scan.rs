//! Scans an instrument's file: bytes become numbered lines, fields and numbers. Every reader uses it.

use std::borrow::Cow;

use crate::error::{Error, Result};

/// Largest file that is read \[bytes\]: a million points at 64 characters a line. A larger file is not a profile.
pub const LARGEST_FILE: usize = 64 << 20;

/// One line of a file, without the white space around it, numbered from 1.
#[derive(Debug, Clone, Copy)]
pub(in crate::measured) struct Line<'a> {
    pub number: usize,
    pub text: &'a str,
}

/// Decodes the text of a file: UTF-8, or UTF-16 with its byte order mark, otherwise Latin-1, which instruments of the
/// nineties write (`Chars=Win`). The numbers of lines do not change.
///
/// # Errors
/// A file over [`LARGEST_FILE`]; zero bytes, which mean that it is not text; broken UTF-16.
pub(in crate::measured) fn text(bytes: &[u8]) -> Result<Cow<'_, str>> {
    if bytes.len() > LARGEST_FILE {
        let (found, expected) = (format!("{} bytes", bytes.len()), format!("{LARGEST_FILE} bytes at most"));
        return Err(Error::new("line 1", found, expected, "give the file of one profile"));
    }
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    if let Some(rest) = bytes.strip_prefix(b"\xff\xfe") {
        return utf16(rest, u16::from_le_bytes).map(Cow::Owned);
    }
    if let Some(rest) = bytes.strip_prefix(b"\xfe\xff") {
        return utf16(rest, u16::from_be_bytes).map(Cow::Owned);
    }
    if let Some(zero) = bytes.iter().position(|&b| b == 0) {
        let line = 1 + bytes[..zero].iter().filter(|&&b| b == b'\n').count();
        let advice = "give a text file, or save it as UTF-8";
        return Err(Error::new(format!("line {line}"), "a zero byte", "text", advice));
    }
    Ok(match std::str::from_utf8(bytes) {
        Ok(text) => Cow::Borrowed(text),
        Err(_) => Cow::Owned(bytes.iter().map(|&b| char::from(b)).collect()),
    })
}

fn utf16(bytes: &[u8], unit: fn([u8; 2]) -> u16) -> Result<String> {
    // An odd last byte counts as half of a pair.
    let last = bytes.chunks_exact(2).remainder().first().map(|_| 0xd800);
    let units = bytes.chunks_exact(2).map(|pair| unit([pair[0], pair[1]])).chain(last);
    let mut text = String::with_capacity(bytes.len() / 2);
    for c in char::decode_utf16(units) {
        let c = c.map_err(|_| {
            let line = 1 + text.matches('\n').count();
            Error::new(format!("line {line}"), "broken UTF-16", "text", "save the file as UTF-8")
        })?;
        text.push(c);
    }
    Ok(text)
}

/// Splits a text into lines. They end with \n or \r\n, or with \r if the text has no \n. An end-of-file mark (Ctrl-Z) is
/// dropped.
pub(in crate::measured) fn lines(text: &str) -> impl Iterator<Item = Line<'_>> {
    let end = if text.contains('\n') { '\n' } else { '\r' };
    text.split(end).enumerate().map(|(index, text)| Line {
        number: index + 1,
        text: text.trim_matches(|c: char| c.is_whitespace() || c == '\u{1a}'),
    })
}

/// Returns the last line of a text, for messages: the place of what is missing.
pub(in crate::measured) fn last_place(text: &str) -> String {
    format!("line {}", lines(text).count())
}

impl<'a> Line<'a> {
    /// Returns the line up to the first comment mark of `marks`.
    pub fn without_comment(self, marks: &[char]) -> Self {
        let text = self.text.find(marks).map_or(self.text, |at| self.text[..at].trim_end());
        Self { text, ..self }
    }

    /// Returns (key, value) of `key = value`. Returns `None` if the key does not begin with a letter. Quotes around the
    /// value are dropped.
    pub fn key_value(self) -> Option<(&'a str, &'a str)> {
        let (key, value) = self.text.split_once('=')?;
        let key = key.trim();
        key.starts_with(|c: char| c.is_alphabetic()).then(|| (key, unquoted(value.trim())))
    }

    /// Splits a row into fields. Fields are separated by semicolons if there are any, else by commas, else by white space.
    /// Commas are decimal if semicolons separate the fields, or if tabs do and there is no decimal point.
    ///
    /// # Errors
    /// A row like "1,5 2,5", whose commas may separate or be decimal.
    pub fn fields(self) -> Result<Vec<&'a str>> {
        if self.text.contains(';') {
            let mut fields: Vec<_> = self.text.split(';').map(|f| unquoted(f.trim())).collect();
            while fields.last().is_some_and(|last| last.is_empty()) {
                fields.pop();
            }
            return Ok(fields);
        }
        let decimal_comma = self.text.contains('\t') && !self.text.contains('.');
        if !self.text.contains(',') || decimal_comma {
            return Ok(self.text.split_whitespace().map(unquoted).collect());
        }
        let mut fields = Vec::new();
        for part in self.text.split(',') {
            let from = fields.len();
            fields.extend(part.split_whitespace().map(unquoted));
            match fields[from..] {
                [] => fields.push(""),
                [a, b, ..] if is_number(a) && is_number(b) => {
                    let advice = "separate the columns by semicolons or tabs, or write decimal points";
                    return Err(self.error(self.text, "separators or decimal commas, not both", advice));
                }
                _ => {}
            }
        }
        Ok(fields)
    }

    /// Reads the number in a field: with decimal point or comma, and with an exponent after e or Fortran's d. `what` names
    /// the number in an error.
    ///
    /// # Errors
    /// Any other text, infinities and NaN included.
    pub fn number(self, field: &str, what: &str) -> Result<f64> {
        number(field).ok_or_else(|| {
            self.error(format!("{what} \"{}\"", clipped(field)), "a number", "correct or delete the line")
        })
    }

    /// Makes an error whose place is this line. `found` is clipped to a readable length.
    pub fn error(self, found: impl AsRef<str>, expected: impl Into<String>, advice: &str) -> Error {
        Error::new(format!("line {}", self.number), clipped(found.as_ref()), expected, advice)
    }
}

/// Returns whether [`Line::number`] can read a field.
pub(in crate::measured) fn is_number(field: &str) -> bool {
    number(field).is_some()
}

fn number(field: &str) -> Option<f64> {
    let plain = field.bytes().all(|b| b.is_ascii_digit() || matches!(b, b'+' | b'-' | b'.' | b'e' | b'E'));
    let value: f64 = if plain {
        field.parse().ok()?
    } else {
        // Typographers' minus signs. `parse` alone would accept "inf" and "nan" too.
        let field = field.replace(['\u{2212}', '\u{2013}'], "-");
        if !field.bytes().all(|b| b.is_ascii_digit() || b"+-.,eEdD".contains(&b)) {
            return None;
        }
        field.replace(',', ".").replace(['d', 'D'], "e").parse().ok()?
    };
    value.is_finite().then_some(value)
}

/// Returns a text without one pair of quotes around it.
pub(in crate::measured) fn unquoted(text: &str) -> &str {
    let without = |mark| text.strip_prefix(mark).and_then(|rest: &str| rest.strip_suffix(mark));
    without('"').or_else(|| without('\'')).unwrap_or(text).trim()
}

/// Returns at most two hundred characters of a text, for messages. A line of a profile's file is shorter; a file without
/// line ends is not.
pub(in crate::measured) fn clipped(text: &str) -> String {
    const LONGEST: usize = 200;
    let mut out: String = text.chars().take(LONGEST).collect();
    if out.len() < text.len() {
        out.push('…');
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(text: &str) -> Line<'_> {
        Line { number: 7, text }
    }

    #[test]
    fn fields_are_separated_by_what_is_there() -> Result<()> {
        assert_eq!(line("1.0\t 2.0  3").fields()?, ["1.0", "2.0", "3"]);
        assert_eq!(line("1.0, 2.0,,a b").fields()?, ["1.0", "2.0", "", "a", "b"]);
        assert_eq!(line("1,5; 2,5;").fields()?, ["1,5", "2,5"]);
        assert_eq!(line("1,5\t2,5").fields()?, ["1,5", "2,5"]);
        assert_eq!(line("\"1.5\",\"2.5\"").fields()?, ["1.5", "2.5"]);
        let error = line("1,5 2,5").fields().err().map(|e| e.place);
        assert_eq!(error.as_deref(), Some("line 7"));
        Ok(())
    }

    #[test]
    fn half_a_unit_of_utf_16_is_broken() -> Result<()> {
        let bytes: Vec<u8> = "\u{feff}1 2\n".encode_utf16().flat_map(u16::to_le_bytes).collect();
        assert_eq!(text(&bytes)?, "1 2\n");
        let cut = text(&bytes[..bytes.len() - 1]).expect_err("an odd number of bytes");
        assert!(cut.to_string().contains("broken UTF-16"), "{cut}");
        Ok(())
    }

    #[test]
    fn numbers_are_finite_and_nothing_else() -> Result<()> {
        for (text, value) in [
            ("1.5", 1.5),
            ("-1,5", -1.5),
            ("1.5D+01", 15.0),
            ("+2e-3", 2e-3),
            (".5", 0.5),
            ("\u{2212}2.5", -2.5),
        ] {
            assert_eq!(line("").number(text, "x")?, value);
        }
        for text in ["", "inf", "NaN", "1e999", "1.2.3", "1.0x", "--1", "e"] {
            assert!(line("").number(text, "x").is_err(), "{text}");
        }
        Ok(())
    }

    #[test]
    fn encodings_keep_their_lines() -> Result<()> {
        assert_eq!(text(b"\xef\xbb\xbfa")?, "a");
        assert_eq!(text(b"\xff\xfea\0\n\0b\0")?, "a\nb");
        assert_eq!(text(b"stra\xdfe")?, "straße");
        let error = text(b"a\nb\0").err().map(|e| e.place);
        assert_eq!(error.as_deref(), Some("line 2"));
        assert_eq!(lines("a\r\n\r\nb\u{1a}").map(|l| l.text).collect::<Vec<_>>(), ["a", "", "b"]);
        assert_eq!(lines("a\rb").map(|l| l.text).collect::<Vec<_>>(), ["a", "b"]);
        Ok(())
    }
}

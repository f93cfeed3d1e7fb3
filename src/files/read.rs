//! Reads whole files of a limited size. The errors name the file.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use super::complaint::bad;
use crate::error::{Error, ErrorKind, Result};

/// Returns the bytes of a file of at most `largest` bytes. From a pipe or device it reads no more than that, either.
///
/// # Errors
/// An unreadable or larger file.
pub fn read_bytes(path: &Path, largest: usize) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let read = File::open(path).and_then(|file| file.take(largest as u64 + 1).read_to_end(&mut bytes));
    read.map_err(|error| {
        let found = match error.kind() {
            io::ErrorKind::NotFound => "no such file".to_owned(),
            io::ErrorKind::PermissionDenied => "a file that you may not read".to_owned(),
            io::ErrorKind::IsADirectory => "a folder".to_owned(),
            _ => error.to_string(),
        };
        bad(path, &found, "a readable file", "check the path").caused_by(error)
    })?;
    if bytes.len() > largest {
        let (found, expected) = (format!("more than {largest} bytes"), format!("at most {largest} bytes"));
        return Err(bad(path, &found, &expected, "is this the right file?").of_kind(ErrorKind::Limit));
    }
    Ok(bytes)
}

/// Returns the text of a file of at most `largest` bytes, without the byte order mark that some editors put
/// before it.
///
/// # Errors
/// An unreadable or larger file; text that is not UTF-8, with its line.
pub fn read_text(path: &Path, largest: usize) -> Result<String> {
    let text = String::from_utf8(read_bytes(path, largest)?).map_err(|error| {
        let (bytes, good) = (error.as_bytes(), error.utf8_error().valid_up_to());
        let line = 1 + bytes[..good].iter().filter(|byte| **byte == b'\n').count();
        let found = format!("the byte 0x{:02X}, which is no UTF-8 there", bytes[good]);
        let place = format!("{}: line {line}", path.display());
        Error::new(place, found, "text in UTF-8", "save the file as UTF-8")
    })?;
    Ok(text.strip_prefix('\u{feff}').map(String::from).unwrap_or(text))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_that_is_no_utf_8_is_shown_by_its_line_and_a_mark_before_it_is_no_text() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("text");
        let read = |bytes: &[u8]| {
            std::fs::write(&path, bytes).unwrap();
            read_text(&path, 100)
        };
        assert_eq!(read(b"\xEF\xBB\xBF[rail]").unwrap(), "[rail]");
        let error = read(b"# 1\n# caf\xE9\n").unwrap_err().to_string();
        let expected = ": line 2: found the byte 0xE9, which is no UTF-8 there; expected text in UTF-8; save";
        assert!(error.contains(expected), "{error}");
        assert_eq!(read(&[b'x'; 101]).unwrap_err().found, "more than 100 bytes");
    }
}

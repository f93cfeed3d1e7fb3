//! Makes errors about paths.

use std::io;
use std::path::Path;

use crate::error::{Error, ErrorKind};

/// Makes the error about a path.
pub(super) fn bad(path: &Path, found: &str, expected: &str, advice: &str) -> Error {
    Error::new(path.display().to_string(), found, expected, advice).of_kind(ErrorKind::Io)
}

/// Makes the error about a folder, or a file in it, that the disk refuses to write.
pub(super) fn unwritable(path: &Path, error: io::Error) -> Error {
    let advice = "check its permissions or give another folder";
    bad(path, &error.to_string(), "a folder that can be written", advice).caused_by(error)
}

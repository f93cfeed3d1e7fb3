//! Makes errors about paths.

use std::path::Path;

use crate::error::{Error, ErrorKind};

/// Makes the error about a path.
pub(super) fn bad(path: &Path, found: &str, expected: &str, advice: &str) -> Error {
    Error::new(path.display().to_string(), found, expected, advice).of_kind(ErrorKind::Io)
}

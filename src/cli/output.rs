//! Single files that a command writes: none of those it reads, and pictures in the format of their name.

use std::path::{Path, PathBuf};

use crate::error::{Error, Result};

/// Refuses to write a file that the command reads or has another use for.
///
/// # Errors
/// `out` is one of `taken`, by whatever path; a file that does not exist yet is compared by its name in its folder.
pub(super) fn refuse_taken(option: &str, out: &Path, taken: &[PathBuf]) -> Result<()> {
    let Some(own) = real(out) else { return Ok(()) };
    match taken.iter().find(|other| real(other).is_some_and(|other| other == own)) {
        None => Ok(()),
        Some(other) => {
            let found = format!("{}, which the same command reads or writes", other.display());
            Err(Error::new(option, found, "a file of its own", "give another name"))
        }
    }
}

/// The path without links; `None` where even its folder is missing.
fn real(path: &Path) -> Option<PathBuf> {
    path.canonicalize().ok().or_else(|| {
        // The folder of a bare name is the empty path.
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        Some(folder.canonicalize().ok()?.join(path.file_name()?))
    })
}

/// The format of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum PictureFormat {
    /// Vectors.
    Svg,
    /// Pixels.
    Png,
}

impl PictureFormat {
    /// The format that a file's name ends in, in upper or lower case.
    ///
    /// # Errors
    /// Any other end.
    pub(super) fn of_file(option: &str, file: &Path) -> Result<Self> {
        let extension = file.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        match extension.as_str() {
            "svg" => Ok(Self::Svg),
            "png" => Ok(Self::Png),
            _ => {
                let found = format!("\"{}\"", file.display());
                Err(Error::new(option, found, "a name that ends in .svg or .png", "choose one of the two"))
            }
        }
    }
}

//! What a command writes: no file that it reads, nobody else's results unasked, pictures in the format of their name.

use std::path::{Path, PathBuf};

use super::png::png;
use wheelrail::error::{Error, Result};
use wheelrail::files::read_bytes;

/// Largest summary \[bytes\] that is looked into: many times one of a run with a hundred contacts.
const LARGEST_SUMMARY: usize = 1 << 28;

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

/// Refuses a folder that the program has chosen and that holds the results of another scene file, which still exists:
/// two of one name in different folders.
///
/// # Errors
/// The folder's summary names another file.
pub(super) fn refuse_results_of_another(folder: &Path, scene: &Path) -> Result<()> {
    let summary = read_bytes(&folder.join("summary.json"), LARGEST_SUMMARY).unwrap_or_default();
    let summary: serde_json::Value = serde_json::from_slice(&summary).unwrap_or_default();
    let Some(file) = summary["scene_file"].as_str() else { return Ok(()) };
    match (folder.join(file).canonicalize(), scene.canonicalize()) {
        (Ok(other), Ok(own)) if other != own => {
            let (place, found) = (folder.display().to_string(), format!("results of {}", other.display()));
            let expected = format!("those of {}, or nothing yet", scene.display());
            Err(Error::new(place, found, expected, "give --out with a folder for each"))
        }
        _ => Ok(()),
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

    /// A picture in this format.
    ///
    /// # Errors
    /// What the renderer of PNG refuses.
    pub(super) fn bytes(self, svg: String) -> Result<Vec<u8>> {
        match self {
            Self::Svg => Ok(svg.into_bytes()),
            Self::Png => png(&svg),
        }
    }
}

//! Checks what a command may write: never a file that it reads, and never over the results of another scene unasked.
//! Chooses the format of a picture.

use std::path::{Path, PathBuf};

use super::png::png;
use crate::answer::folder_of;
use wheelrail::error::{Error, Result};
use wheelrail::files::read_bytes;
use wheelrail::scene::Scene;

/// Largest summary that is read \[bytes\]: many times that of a run with a hundred contacts.
const LARGEST_SUMMARY: usize = 1 << 28;

/// Rejects an output file that the command reads or uses in another way.
///
/// # Errors
/// `out` is one of `taken`, by whatever path. A file that does not exist yet is compared by its name in its folder.
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

/// Rejects output files of options that are the scene, one of its profiles, one of `read`, or each other.
///
/// # Errors
/// The first that is, with its option.
pub(super) fn refuse_files(
    scene_file: &Path,
    scene: &Scene,
    read: Option<&PathBuf>,
    outputs: &[(&str, &Option<PathBuf>)],
) -> Result<()> {
    let folder = folder_of(scene_file);
    let profiles = scene.profiles().filter_map(|profile| profile.file.as_ref());
    let mut taken: Vec<PathBuf> = profiles.map(|file| folder.join(file)).collect();
    taken.extend(read.cloned().into_iter().chain([scene_file.to_owned()]));
    for (option, file) in outputs {
        let Some(file) = file else { continue };
        refuse_taken(option, file, &taken)?;
        taken.push(file.clone());
    }
    Ok(())
}

/// Rejects a default folder that holds the results of another scene file, if that file still exists: two scene files can
/// have one name in different folders.
///
/// # Errors
/// The folder's summary names another scene file.
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

/// Returns the path without links; `None` if even its folder is missing.
fn real(path: &Path) -> Option<PathBuf> {
    path.canonicalize().ok().or_else(|| {
        // The folder of a bare name is the empty path, which means the working folder.
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        Some(folder.canonicalize().ok()?.join(path.file_name()?))
    })
}

/// The format of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum PictureFormat {
    /// SVG: vectors.
    Svg,
    /// PNG: pixels.
    Png,
}

impl PictureFormat {
    /// Returns the format that the end of a file's name tells. Upper and lower case are the same.
    ///
    /// # Errors
    /// Any other end of the name.
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

    /// Returns a picture in this format, from its SVG.
    ///
    /// # Errors
    /// SVG that the renderer of PNG rejects.
    pub(super) fn bytes(self, svg: String) -> Result<Vec<u8>> {
        match self {
            Self::Svg => Ok(svg.into_bytes()),
            Self::Png => png(&svg),
        }
    }
}

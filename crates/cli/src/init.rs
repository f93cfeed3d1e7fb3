//! `wheelrail init`: writes a commented scene to begin with.

use std::path::Path;

use crate::answer::{Outcome, print};
use wheelrail::error::{Error, Result};
use wheelrail::files::write_file;

/// The scene.
const SCENE: &str = include_str!("init.toml");

/// Writes the scene and says what to do with it.
///
/// # Errors
/// A file that exists already; any error of the disk.
pub(super) fn init(file: &Path) -> Result<Outcome> {
    let place = file.display().to_string();
    if file.symlink_metadata().is_ok() {
        let expected = "a name that is free";
        return Err(Error::new(place, "a file that exists already", expected, "give another name"));
    }
    write_file(file, SCENE.as_bytes())?;
    print(&format!("{place}: a scene to begin with; next: wheelrail run {place}\n"))
}

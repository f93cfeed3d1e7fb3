//! Replaces a single file in one step.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::complaint::bad;
use super::temporary;
use crate::error::{Error, Result};

/// A file being written. Nothing appears under its name before [`NewFile::commit`]; nothing remains if it is dropped
/// without a commit. A pipe or a device gets the bytes at once.
#[derive(Debug)]
pub struct NewFile {
    target: PathBuf,
    /// The locked file beside the target that will replace it; `None` for a pipe or a device.
    temporary: Option<PathBuf>,
    sink: File,
}

impl NewFile {
    /// Opens a temporary file beside `path`, after removing those left there by killed processes. If `path`
    /// is a symbolic link, the file behind it is replaced.
    ///
    /// # Errors
    /// A folder, a symbolic link to nothing, a place that cannot be written.
    pub fn create(path: &Path) -> Result<Self> {
        let target = behind_links(path)?;
        let there = target.metadata();
        if there.as_ref().is_ok_and(fs::Metadata::is_dir) {
            return Err(bad(path, "a folder", "a file, or nothing yet", "give another name"));
        }
        let opened = if there.is_ok_and(|found| !found.is_file()) {
            File::options().write(true).open(&target).map(|sink| (None, sink))
        } else {
            beside(&target).map(|(temporary, sink)| (Some(temporary), sink))
        };
        let (temporary, sink) = opened.map_err(|error| unwritable(&target, error))?;
        Ok(Self { target, temporary, sink })
    }

    /// Adds bytes at the end. They are not buffered, so pass large files in blocks.
    ///
    /// # Errors
    /// Any error of the disk.
    pub fn put(&mut self, bytes: &[u8]) -> Result<()> {
        self.sink.write_all(bytes).map_err(|error| unwritable(&self.target, error))
    }

    /// Gives the file its name. Every reader finds either the whole old content or the whole new one.
    ///
    /// # Errors
    /// Any error of the disk; the old file is then as it was.
    pub fn commit(self) -> Result<()> {
        let _whole = temporary::uninterrupted();
        let moved = self.temporary.iter().try_for_each(|temporary| fs::rename(temporary, &self.target));
        moved.map_err(|error| unwritable(&self.target, error))
    }
}

impl Drop for NewFile {
    fn drop(&mut self) {
        // After a commit the temporary file is gone.
        self.temporary.iter().for_each(|temporary| temporary::discard(temporary));
    }
}

/// Writes a whole file by [`NewFile`], in one call.
///
/// # Errors
/// The errors of [`NewFile`].
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<()> {
    let mut file = NewFile::create(path)?;
    file.put(bytes)?;
    file.commit()
}

/// Makes a folder, with those above it, unless it is there.
///
/// # Errors
/// Any error of the disk.
pub fn make_folder(path: &Path) -> Result<()> {
    fs::create_dir_all(path).map_err(|error| unwritable(path, error))
}

fn beside(target: &Path) -> io::Result<(PathBuf, File)> {
    // The folder of a bare name is the empty path.
    let target = std::path::absolute(target)?;
    target.parent().into_iter().for_each(temporary::remove_stale);
    temporary::locked(&target, |name| File::create_new(name))
}

/// Returns the file behind a symbolic link, and any other path unchanged.
///
/// # Errors
/// A link to nothing, because its purpose is unknown.
fn behind_links(path: &Path) -> Result<PathBuf> {
    match path.canonicalize() {
        Ok(real) if path.is_symlink() => Ok(real),
        Err(_) if path.is_symlink() => Err(bad(
            path,
            "a broken symbolic link",
            "a file, or nothing yet",
            "remove it or give another name",
        )),
        _ => Ok(path.to_path_buf()),
    }
}

fn unwritable(path: &Path, error: io::Error) -> Error {
    let advice = "check path, permissions and free space";
    bad(path, &error.to_string(), "a file that can be written", advice).caused_by(error)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn count(folder: &Path) -> usize {
        fs::read_dir(folder).unwrap().count()
    }

    #[test]
    fn a_file_is_replaced_or_left_as_it_was() {
        let root = tempfile::tempdir().unwrap();
        let path = root.path().join("curves.svg");
        for text in ["old", "new"] {
            write_file(&path, text.as_bytes()).unwrap();
            assert_eq!(fs::read_to_string(&path).unwrap(), text);
        }
        let mut half = NewFile::create(&path).unwrap();
        half.put(b"half").unwrap();
        assert_eq!((fs::read(&path).unwrap().as_slice(), count(root.path())), (&b"new"[..], 2));
        drop(half);
        assert!(write_file(&root.path().join("missing/curves.svg"), b"x").is_err());
        assert_eq!(write_file(root.path(), b"x").unwrap_err().found, "a folder");
        assert_eq!((fs::read(&path).unwrap().as_slice(), count(root.path())), (&b"new"[..], 1));
    }

    #[test]
    #[cfg(unix)]
    fn the_file_behind_a_link_is_replaced() {
        let root = tempfile::tempdir().unwrap();
        let [path, link, lost] = ["curves.svg", "link.svg", "lost.svg"].map(|name| root.path().join(name));
        fs::write(&path, "old").unwrap();
        std::os::unix::fs::symlink(&path, &link).unwrap();
        write_file(&link, b"new").unwrap();
        assert!(link.is_symlink() && fs::read(&path).unwrap() == b"new");
        std::os::unix::fs::symlink(root.path().join("missing"), &lost).unwrap();
        assert_eq!(write_file(&lost, b"x").unwrap_err().found, "a broken symbolic link");
    }

    #[test]
    fn what_a_dead_process_left_goes_and_what_a_living_one_writes_stays() {
        let root = tempfile::tempdir().unwrap();
        let names = ["curves.svg", ".wheelrail-tmp.curves.svg.1.0", ".wheelrail-tmp.curves.svg.2.0"];
        let [path, dead, living] = names.map(|name| root.path().join(name));
        fs::write(&dead, "half").unwrap();
        let lock = File::create(&living).unwrap();
        lock.lock().unwrap();
        write_file(&path, b"x").unwrap();
        assert!(!dead.exists() && living.exists());
    }
}

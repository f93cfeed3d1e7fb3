//! A folder whose files are kept from run to run, so that a study goes on where it was stopped.

use std::fs;
use std::path::{Path, PathBuf};

use super::complaint::{bad, unwritable};
use super::file::write_file;
use super::foreign::marked;
use super::names::Names;
use crate::error::Result;

/// A folder of ours that is added to file by file. Each file appears whole or not at all, as [`write_file`] makes it.
#[derive(Debug, Clone)]
pub struct KeptFolder {
    path: PathBuf,
}

impl KeptFolder {
    /// Opens a folder, and makes it if it is missing.
    ///
    /// # Errors
    /// A file; a folder that is neither empty nor ours; a place that cannot be written.
    pub fn open(path: &Path, names: Names) -> Result<Self> {
        let own = Self { path: path.to_path_buf() };
        fs::create_dir_all(path).map_err(|error| unwritable(path, error))?;
        let mut entries = fs::read_dir(path).map_err(|error| unwritable(path, error))?.flatten();
        if !marked(path, names) && entries.any(|entry| !(names.is_file)(&entry.file_name().to_string_lossy()))
        {
            let expected = format!("an empty folder, or one with {} of wheelrail", names.marker);
            return Err(bad(path, "a folder with other files", &expected, "give another folder"));
        }
        Ok(own)
    }

    /// Opens a subfolder, and makes it if it is missing.
    ///
    /// # Errors
    /// Any error of the disk.
    pub fn part(&self, name: &str) -> Result<Self> {
        let path = self.path.join(name);
        fs::create_dir_all(&path).map_err(|error| unwritable(&path, error))?;
        Ok(Self { path })
    }

    /// Returns the path of a file in it.
    pub fn file(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }

    /// Writes a file, in place of an older one.
    ///
    /// # Errors
    /// Any error of the disk.
    pub fn write(&self, name: &str, bytes: &[u8]) -> Result<()> {
        write_file(&self.file(name), bytes)
    }

    /// Removes the files of earlier runs: those that are `ours` by name.
    ///
    /// # Errors
    /// A file that cannot be removed.
    pub fn remove(&self, ours: impl Fn(&str) -> bool) -> Result<()> {
        for path in files_in(&self.path)? {
            if path.file_name().is_some_and(|name| ours(&name.to_string_lossy())) {
                fs::remove_file(&path).map_err(|error| unwritable(&path, error))?;
            }
        }
        Ok(())
    }
}

/// Lists the files of a folder by their names, without those whose names begin with a dot.
///
/// # Errors
/// A folder that cannot be read.
pub fn files_in(folder: &Path) -> Result<Vec<PathBuf>> {
    let read = |error: std::io::Error| {
        bad(folder, &error.to_string(), "a folder that can be read", "check the path").caused_by(error)
    };
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).map_err(read)? {
        let path = entry.map_err(read)?.path();
        let hidden = path.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.'));
        if !hidden && path.is_file() {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}

#[cfg(test)]
mod tests {
    use super::*;

    const NAMES: Names =
        Names { marker: "study.json", is_file: |name| name == "study.json", is_part: |_| false };

    #[test]
    fn a_folder_of_others_is_left_alone_and_ours_is_added_to() {
        let root = tempfile::tempdir().unwrap();
        let path = root.path().join("a/b");
        let folder = KeptFolder::open(&path, NAMES).unwrap();
        folder.write("study.json", b"wheelrail").unwrap();
        let parts = folder.part("parts").unwrap();
        ["part-2", "part-1", ".hidden"].iter().for_each(|name| parts.write(name, b"x").unwrap());
        assert!(KeptFolder::open(&path, NAMES).is_ok());
        assert_eq!(files_in(&path.join("parts")).unwrap(), [parts.file("part-1"), parts.file("part-2")]);
        parts.remove(|name| name == "part-2").unwrap();
        assert_eq!(files_in(&path.join("parts")).unwrap(), [parts.file("part-1")]);
        let error = KeptFolder::open(&path.join("parts"), NAMES).unwrap_err();
        assert_eq!(error.found, "a folder with other files");
        assert!(KeptFolder::open(&path.join("study.json"), NAMES).is_err());
    }
}

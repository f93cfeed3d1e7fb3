//! What is in an output folder and is not ours: a solver's output, notes, pictures, whole subfolders.

use super::complaint::{bad, unwritable};
use super::names::Names;
use crate::error::Result;
use std::fs::{self, DirEntry};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// An entry of an output folder that is not ours, by its path inside it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Foreign {
    /// A file, a link or a device.
    File(PathBuf),
    /// A folder; its content follows it.
    Folder(PathBuf),
}

/// Tells whether a folder has our marker.
pub(super) fn marked(folder: &Path, names: Names) -> bool {
    let marker = fs::read(folder.join(names.marker)).unwrap_or_default();
    marker.windows(9).any(|word| word == b"wheelrail")
}

/// Lists what is in one of our folders and is not ours, folders before their content.
///
/// Files with one of our names are ours, and so are the files of a subfolder that is named and marked like one of
/// ours. Everything else is foreign: in a subfolder that is not ours, the subfolder and all that is in it. Links
/// are not followed.
///
/// # Errors
/// A folder that cannot be read.
pub(super) fn foreign(folder: &Path, names: Names) -> io::Result<Vec<Foreign>> {
    let mut out = Vec::new();
    collect(folder, Path::new(""), Some(names), &mut out)?;
    Ok(out)
}

/// Adds what is foreign in the folder `inside` of `root`; without `names` that is all of it.
fn collect(root: &Path, inside: &Path, names: Option<Names>, out: &mut Vec<Foreign>) -> io::Result<()> {
    let entries = fs::read_dir(root.join(inside))?.collect::<io::Result<Vec<DirEntry>>>()?;
    for entry in entries {
        let (name, path) = (entry.file_name(), inside.join(entry.file_name()));
        if names.is_some_and(|names| name.to_str().is_some_and(names.is_file)) {
            continue;
        }
        if !entry.file_type()?.is_dir() {
            out.push(Foreign::File(path));
            continue;
        }
        let is_part =
            |names: &Names| name.to_str().is_some_and(names.is_part) && marked(&entry.path(), *names);
        let part = names.filter(is_part);
        if part.is_none() {
            out.push(Foreign::Folder(path.clone()));
        }
        collect(root, &path, part, out)?;
    }
    Ok(())
}

/// Gives foreign entries of the folder `from` a second name at the same path in the folder `to`, so that they are
/// never only in a place where a kill or another run could remove them. Files that are there already stay, and
/// those that have gone are left out.
///
/// Files are linked, and copied where the file system has no links. Cost: one link a file.
///
/// # Errors
/// A file where `to` has a folder, or a folder where it has a file; a disk that refuses.
pub(super) fn keep(foreign: &[Foreign], from: &Path, to: &Path) -> Result<()> {
    for entry in foreign {
        match entry {
            Foreign::Folder(path) => keep_folder(&from.join(path), &to.join(path))?,
            Foreign::File(path) => keep_file(&from.join(path), &to.join(path))?,
        }
    }
    // Rights come last and from the inside out: a folder may be closed to writing. Where the system refuses,
    // the new folder has those of any new folder.
    for entry in foreign.iter().rev() {
        if let Foreign::Folder(path) = entry {
            let old = fs::metadata(from.join(path));
            drop(old.and_then(|old| fs::set_permissions(to.join(path), old.permissions())));
        }
    }
    Ok(())
}

fn keep_folder(old: &Path, new: &Path) -> Result<()> {
    match fs::create_dir_all(new) {
        Ok(()) => Ok(()),
        Err(_) if new.symlink_metadata().is_ok_and(|there| !there.is_dir()) => {
            let found = "a folder named like a file of this run";
            Err(bad(old, found, "another name", "rename it or give another folder"))
        }
        Err(error) => Err(unwritable(new, error)),
    }
}

fn keep_file(old: &Path, new: &Path) -> Result<()> {
    if new.is_dir() {
        let found = "a file named like a folder of this run";
        return Err(bad(old, found, "another name", "rename it or give another folder"));
    }
    // A file of a part that this run does not have: its folder is made for it.
    if let Some(folder) = new.parent() {
        fs::create_dir_all(folder).map_err(|error| unwritable(folder, error))?;
    }
    match fs::hard_link(old, new) {
        Ok(()) => Ok(()),
        Err(e) if matches!(e.kind(), ErrorKind::NotFound | ErrorKind::AlreadyExists) => Ok(()),
        Err(_) => fs::copy(old, new).map(drop).map_err(|error| unwritable(old, error)),
    }
}

//! Puts the output folder onto the disk.
//!
//! A run writes into a temporary folder beside DIR and puts it in DIR's place in one step at the end. Every reader of DIR
//! therefore finds the whole old folder or the whole new one, even if the run is killed.
//!
//! - **The step.** A plain `rename` if DIR is missing or empty; otherwise the kernel's exchange of two names
//!   (`renameat2` with `RENAME_EXCHANGE`), after which the old folder has the temporary name and is deleted.
//!   Systems and file systems without the exchange (Windows, NFS, some FUSE) get two renames: between them
//!   DIR is missing for an instant, and the old folder waits beside it under a name that the next run puts
//!   back.
//! - **Killed runs.** The temporary folder is locked as long as its run lives: `files::temporary`. On systems
//!   that lock folders, the next run into the same parent removes what a killed run left. A program that catches the signal
//!   removes it at once: [`discard_all`](temporary::discard_all).
//! - **No fsync.** Twenty of them cost more than the whole run. The promise holds for a kill of the process,
//!   not for a power cut: the END lines and the sizes in the headers show that a folder is incomplete.
//! - **Foreign files.** A folder is replaced only if it is empty or contains our own marker. What is in it and
//!   is not ours (a solver's output, notes, pictures, whole subfolders) gets a second name in the new folder
//!   before the step, at the same path, by hard links: at every moment it is in DIR, whole, and a program that
//!   is writing to it goes on. What came into the old folder during the step is linked after it.

use super::complaint::{bad, unwritable};
use super::foreign::{Foreign, foreign, keep, marked};
use super::names::Names;
use super::{system, temporary};
use crate::error::Result;
use std::fs::{self, File};
use std::io::{self, ErrorKind, Write};
use std::path::{Component, Path, PathBuf};

/// Beginning of the old folder's name while two folders are swapped on a file system without the exchange of names.
const ASIDE: &str = ".wheelrail-old.";

/// Most attempts to put the new folder in place. An attempt fails only if another run does the same at that moment.
const SWAPS_TRIED: u32 = 100;

/// A folder being written. Nothing appears in DIR before [`Folder::commit`]; nothing remains if it is dropped without a
/// commit.
#[derive(Debug)]
pub struct Folder {
    target: PathBuf,
    temporary: PathBuf,
    names: Names,
    /// The open temporary folder, locked; the lock ends with it.
    _lock: File,
}

/// A folder being written, or one of its subfolders.
#[derive(Debug)]
pub struct FolderPart<'a> {
    temporary: PathBuf,
    target: PathBuf,
    _whole: &'a Folder,
}

impl Folder {
    /// Makes a temporary folder beside `dir`, after removing stale ones of killed runs. Missing parents are
    /// created; a symbolic link to a folder is followed.
    ///
    /// # Errors
    /// `dir` is a file, a mount point, the working folder or above it, or a folder that is neither empty nor
    /// ours; the parent cannot be written.
    pub fn create(dir: &Path, names: Names) -> Result<Self> {
        let target = resolve(dir)?;
        let parent = parent_of(&target);
        fs::create_dir_all(parent).map_err(|e| unwritable(parent, e))?;
        put_back(&target);
        temporary::remove_stale(parent);
        if target.exists() {
            reject_unsafe(&target)?;
            entries_not_ours(&target, names)?;
        }
        let made = temporary::locked(&target, |path| {
            fs::create_dir(path)?;
            system::open_folder(path)
        });
        let (temporary, lock) = made.map_err(|e| unwritable(parent, e))?;
        Ok(Self { target, temporary, names, _lock: lock })
    }

    /// Makes a subfolder whose files have the same names. An empty `name` is the folder itself.
    ///
    /// # Errors
    /// Any error of the disk.
    pub fn part(&self, name: &str) -> Result<FolderPart<'_>> {
        let (temporary, target) = (self.temporary.join(name), self.target.join(name));
        let _whole = temporary::uninterrupted();
        fs::create_dir_all(&temporary).map_err(|e| unwritable(&target, e))?;
        Ok(FolderPart { temporary, target, _whole: self })
    }

    /// Writes one file of the folder.
    ///
    /// # Errors
    /// The errors of [`FolderPart::write`].
    pub fn write(&self, name: &str, bytes: &[u8]) -> Result<()> {
        self.part("")?.write(name, bytes)
    }

    /// Writes one file of the folder piece by piece.
    ///
    /// # Errors
    /// The errors of [`FolderPart::write`].
    pub fn stream(&self, name: &str, content: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<()> {
        self.part("")?.stream(name, content)
    }

    /// Puts the folder in DIR's place and deletes the old one. An old folder that cannot be deleted keeps its
    /// temporary name; the next run deletes it.
    ///
    /// # Errors
    /// DIR has meanwhile become something that may not be replaced; the disk refuses. DIR is then as it was.
    pub fn commit(self) -> Result<()> {
        let _whole = temporary::uninterrupted();
        self.put_in_place()
    }

    fn put_in_place(&self) -> Result<()> {
        use ErrorKind::{AlreadyExists, DirectoryNotEmpty, PermissionDenied};
        for _ in 0..SWAPS_TRIED {
            // The rename also replaces an empty folder.
            match fs::rename(&self.temporary, &self.target) {
                Ok(()) => return Ok(()),
                // Systems report one of these errors if a folder is in the way.
                Err(e) if matches!(e.kind(), DirectoryNotEmpty | AlreadyExists | PermissionDenied) => {}
                Err(e) => return Err(unwritable(&self.target, e)),
            }
            let foreign = entries_not_ours(&self.target, self.names)?;
            keep(&foreign, &self.target, &self.temporary)?;
            // The lock keeps other runs from taking the old folder for stale before it is left.
            let old = system::open_folder(&self.target);
            let _lock = old.as_ref().map(File::try_lock);
            match exchange(&self.temporary, &self.target) {
                Ok(()) => return self.leave(),
                // Another run has just moved DIR.
                Err(e) if e.kind() == ErrorKind::NotFound => {}
                Err(e) => return Err(unwritable(&self.target, e)),
            }
        }
        Err(bad(
            &self.target,
            "other runs that keep replacing it",
            "one run at a time",
            "give each run its own",
        ))
    }

    /// Takes over what came into the old folder, which now has the temporary name, while the two were
    /// exchanged. Dropping the folder then deletes the old folder; where something in it cannot be taken over, the old
    /// folder gets a name of its own instead.
    fn leave(&self) -> Result<()> {
        let late = match foreign(&self.temporary, self.names) {
            // Another run has cleaned up.
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(()),
            late => late.map_err(|error| unwritable(&self.temporary, error)),
        };
        late.and_then(|late| keep(&late, &self.temporary, &self.target)).map_err(|error| {
            let aside = self.target.with_file_name(left_name(&self.target));
            match fs::rename(&self.temporary, &aside) {
                Ok(()) => error.within(format!("{}, the old folder", aside.display())),
                Err(_) => error,
            }
        })
    }
}

impl FolderPart<'_> {
    /// Returns the relative path from here to an absolute path without links. It remains valid after both
    /// have been moved together.
    pub fn relative(&self, path: &Path) -> PathBuf {
        let common = self.target.components().zip(path.components()).take_while(|(a, b)| a == b).count();
        let up = self.target.components().skip(common).map(|_| Component::ParentDir);
        up.chain(path.components().skip(common)).collect()
    }

    /// Writes one file.
    ///
    /// # Errors
    /// Any error of the disk (full, quota, …); a name that was written already.
    pub fn write(&self, name: &str, bytes: &[u8]) -> Result<()> {
        self.stream(name, |sink| sink.write_all(bytes))
    }

    /// Gives the size of a file that was written \[bytes\].
    ///
    /// # Errors
    /// Any error of the disk.
    pub fn size(&self, name: &str) -> Result<u64> {
        let found = fs::metadata(self.temporary.join(name));
        found.map(|found| found.len()).map_err(|e| unwritable(&self.target.join(name), e))
    }

    /// Writes one file piece by piece, for large files. The sink is not buffered: pass blocks of at least
    /// some ten kilobytes.
    ///
    /// # Errors
    /// The errors of [`FolderPart::write`].
    pub fn stream(&self, name: &str, content: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<()> {
        let path = self.temporary.join(name);
        let file = File::options().write(true).create_new(true).open(&path);
        file.and_then(|mut file| {
            content(&mut file)?;
            file.flush()
        })
        .map_err(|e| {
            let advice = match e.kind() {
                ErrorKind::StorageFull | ErrorKind::QuotaExceeded => "free some space or give another folder",
                _ => "check the folder, or give another folder",
            };
            bad(&self.target.join(name), &e.to_string(), "a file written whole", advice)
        })
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        temporary::discard(&self.temporary);
    }
}

/// Returns `dir` as an absolute path without symbolic links. Its last parts need not exist.
fn resolve(dir: &Path) -> Result<PathBuf> {
    if let Ok(real) = dir.canonicalize() {
        return Ok(real);
    }
    // If another run has made the folder since, it is no link.
    if dir.symlink_metadata().is_ok_and(|found| found.is_symlink()) {
        return Err(bad(
            dir,
            "a broken symbolic link",
            "a folder, or nothing yet",
            "remove it or give another folder",
        ));
    }
    if dir.file_name().is_none() {
        return Err(bad(dir, "a path without a name at its end", "a folder's name", "give one with a name"));
    }
    let dir = std::path::absolute(dir).map_err(|e| unwritable(dir, e))?;
    // Missing folders will be made below the nearest existing one, and contain no links.
    let real = dir.ancestors().find_map(|above| {
        let missing = dir.strip_prefix(above).ok()?;
        above.canonicalize().ok().map(|above| above.join(missing))
    });
    Ok(real.unwrap_or(dir))
}

fn parent_of(target: &Path) -> &Path {
    target.parent().unwrap_or(target)
}

/// Rejects what cannot or must not be replaced, whatever it contains.
fn reject_unsafe(target: &Path) -> Result<()> {
    let here = target.metadata().map_err(|e| unwritable(target, e))?;
    if !here.is_dir() {
        return Err(bad(target, "a file", "a folder, or nothing yet", "remove it or give another folder"));
    }
    if std::env::current_dir().is_ok_and(|cwd| cwd.starts_with(target)) {
        // The shell that started us would be left inside a deleted folder.
        return Err(bad(target, "the working folder or one above it", "a folder inside it", "give ./NAME"));
    }
    if parent_of(target).metadata().is_ok_and(|parent| system::is_mount_point(&here, &parent)) {
        return Err(bad(target, "a mount point", "a folder that can be replaced", "give a folder inside it"));
    }
    Ok(())
}

/// Returns what is in `target` and is not ours.
///
/// # Errors
/// A folder that is neither empty nor ours; one that cannot be read.
fn entries_not_ours(target: &Path, names: Names) -> Result<Vec<Foreign>> {
    let count = fs::read_dir(target).map_err(|e| unwritable(target, e))?.count();
    if count > 0 && !marked(target, names) {
        let found = format!("a folder with {count} entries and no {} of ours", names.marker);
        return Err(bad(
            target,
            &found,
            "an empty or missing folder, or one of an earlier run",
            "give another folder: the folder would be replaced",
        ));
    }
    foreign(target, names).map_err(|e| unwritable(target, e))
}

/// Returns a free name beside `target` for an old folder that could not be taken over.
fn left_name(target: &Path) -> String {
    let name = target.file_name().unwrap_or_default().to_string_lossy();
    let mut number = 1_u32;
    while target.with_file_name(format!("{name}.old-{number}")).exists() {
        number += 1;
    }
    format!("{name}.old-{number}")
}

/// Exchanges the names of two folders.
fn exchange(new: &Path, old: &Path) -> io::Result<()> {
    system::exchanged(new, old).unwrap_or_else(|| exchange_in_two(new, old))
}

/// Exchanges the names of two folders by two renames; [`put_back`] undoes a kill in between.
fn exchange_in_two(new: &Path, old: &Path) -> io::Result<()> {
    let aside = aside_of(old);
    fs::rename(old, &aside)?;
    match fs::rename(new, old) {
        // The old folder takes the temporary name, and is deleted under it.
        Ok(()) => fs::rename(&aside, new),
        Err(e) => fs::rename(&aside, old).and(Err(e)),
    }
}

/// Undoes an [`exchange_in_two`] that was killed half-way. If a rename is refused, the next run tries again.
fn put_back(target: &Path) {
    let aside = aside_of(target);
    if !aside.is_dir() {
        return;
    }
    if target.exists() {
        drop(fs::remove_dir_all(aside));
    } else {
        drop(fs::rename(aside, target));
    }
}

fn aside_of(target: &Path) -> PathBuf {
    let name = target.file_name().unwrap_or_default().to_string_lossy();
    parent_of(target).join(format!("{ASIDE}{name}"))
}

#[cfg(test)]
mod tests;

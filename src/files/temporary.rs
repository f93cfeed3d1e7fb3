//! Makes temporary names beside what will be replaced. A process locks the name that it uses (`flock`), and the kernel
//! drops the lock when the process ends. A name without a lock therefore belonged to a process that was killed; the next
//! process that writes into the same folder removes it.

use super::system;
use std::fs::{self, File, TryLockError};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::process;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError, RwLock, RwLockReadGuard};

/// Beginning of every temporary name, followed by `NAME.PID.NUMBER`.
pub(super) const TEMPORARY: &str = ".wheelrail-tmp.";

/// Most names tried. A name is lost only to a run that cleans up at that very instant, or to a killed process that had the
/// same number.
const NAMES_TRIED: u32 = 100;

/// Most characters of the target's name in a temporary name. File systems limit the length of names.
const NAME_SHOWN: usize = 40;

/// Number of the next temporary name of this process. No number is used twice: the owner of a name deletes it after its
/// content has moved away, and must not find another thread's content there.
static NUMBER: AtomicU64 = AtomicU64::new(0);

/// The temporary names of this process.
static IN_USE: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Locked for reading while a temporary name is made, removed or put in place. [`discard_all`] locks it for writing and never unlocks it.
static UNINTERRUPTED: RwLock<()> = RwLock::new(());

/// Most attempts to remove a folder into which other threads write.
const REMOVALS_TRIED: u32 = 100;

/// Keeps [`discard_all`] waiting until the guard is dropped; never returns once that runs. A thread must hold at most one guard.
pub(super) fn uninterrupted() -> RwLockReadGuard<'static, ()> {
    UNINTERRUPTED.read().unwrap_or_else(PoisonError::into_inner)
}

/// Removes every temporary folder and file of this process. It waits for those that are being put in place; afterwards none is
/// made or put in place: threads that try wait for ever. For a program that a signal ends.
pub fn discard_all() {
    // The guard is forgotten, so that the lock is never released.
    std::mem::forget(UNINTERRUPTED.write().unwrap_or_else(PoisonError::into_inner));
    for path in IN_USE.lock().unwrap_or_else(PoisonError::into_inner).iter() {
        // Under another name no thread makes a new file in it. A file that was made just before refuses the removal.
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let gone = path.with_file_name(format!("{name}.gone"));
        let path = if fs::rename(path, &gone).is_ok() { &gone } else { path };
        let mut tries = 0..REMOVALS_TRIED;
        while tries.next().is_some() && path.exists() {
            drop(remove(path));
        }
    }
}

/// Removes a temporary name of this process. The next process removes what cannot be removed here; after a plain rename there is
/// nothing to remove.
pub(super) fn discard(path: &Path) {
    let _whole = uninterrupted();
    drop(remove(path));
    IN_USE.lock().unwrap_or_else(PoisonError::into_inner).retain(|used| used != path);
}

fn remove(path: &Path) -> io::Result<()> {
    if path.symlink_metadata()?.is_dir() { fs::remove_dir_all(path) } else { fs::remove_file(path) }
}

/// Makes a new folder or file beside `target` with `make`, open and locked. The lock comes a moment after the name. If
/// another process cleans up in between, it takes the name for stale: then the lock is refused or the name is gone, and the
/// next name is tried.
///
/// # Errors
/// The errors of `make`; too many names in use.
pub(super) fn locked(target: &Path, make: impl Fn(&Path) -> io::Result<File>) -> io::Result<(PathBuf, File)> {
    let name = target.file_name().unwrap_or_default().to_string_lossy();
    let name: String = name.chars().take(NAME_SHOWN).collect();
    let text = format!("{NAMES_TRIED} temporary names in use by other runs");
    let mut error = io::Error::new(ErrorKind::AlreadyExists, text);
    let _whole = uninterrupted();
    for _ in 0..NAMES_TRIED {
        let number = NUMBER.fetch_add(1, Ordering::Relaxed);
        let path = target.with_file_name(format!("{TEMPORARY}{name}.{}.{number}", process::id()));
        let made = match make(&path) {
            Ok(made) => made,
            // Another process may have removed a folder between its making and its opening.
            Err(e) if matches!(e.kind(), ErrorKind::AlreadyExists | ErrorKind::NotFound) => {
                error = e;
                continue;
            }
            Err(e) => return Err(e),
        };
        // A file system without locks (`Error`) is never cleaned up.
        let lost = matches!(made.try_lock(), Err(TryLockError::WouldBlock));
        if !lost && system::is_at(&made, &path) {
            IN_USE.lock().unwrap_or_else(PoisonError::into_inner).push(path.clone());
            return Ok((path, made));
        }
    }
    Err(error)
}

/// Removes what killed processes have left in a folder. What cannot be removed belongs to another user, or the next process
/// tries again.
pub(super) fn remove_stale(parent: &Path) {
    for entry in fs::read_dir(parent).into_iter().flatten().flatten() {
        let ours = entry.file_name().to_string_lossy().starts_with(TEMPORARY);
        let Ok(kind) = entry.file_type() else { continue };
        // Opening a pipe of that name would wait for a writer.
        if !ours || !(kind.is_dir() || kind.is_file()) {
            continue;
        }
        let Ok(lock) = File::open(entry.path()) else { continue };
        // The lock is held until all is gone, so that no process writes into what is being removed.
        if lock.try_lock().is_ok() {
            drop(remove(&entry.path()));
        }
    }
}

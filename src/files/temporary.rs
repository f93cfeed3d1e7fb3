//! Makes temporary names beside what will be replaced. A process locks the name that it uses (`flock`), and the kernel
//! drops the lock when the process ends. A name without a lock therefore belonged to a process that was killed; the next
//! process that writes into the same folder removes it.

use super::system;
use std::fs::{self, File, TryLockError};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::process;
use std::sync::atomic::{AtomicU64, Ordering};

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
            let path = entry.path();
            drop(if kind.is_dir() { fs::remove_dir_all(path) } else { fs::remove_file(path) });
        }
    }
}

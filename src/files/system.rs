//! Functions that only some operating systems offer, each with a plain alternative for the others.

use std::fs::{self, File};
use std::io;
use std::path::Path;

/// Returns whether an open file or folder is still the one with this name. Systems that cannot tell answer
/// yes if anything has the name.
pub(super) fn is_at(open: &File, path: &Path) -> bool {
    match (open.metadata(), path.metadata()) {
        (Ok(open), Ok(named)) => same(&open, &named),
        _ => false,
    }
}

#[cfg(unix)]
fn same(a: &fs::Metadata, b: &fs::Metadata) -> bool {
    use std::os::unix::fs::MetadataExt;
    (a.dev(), a.ino()) == (b.dev(), b.ino())
}

#[cfg(not(unix))]
fn same(_: &fs::Metadata, _: &fs::Metadata) -> bool {
    true
}

/// Returns whether a folder is on another file system than its parent. Systems that cannot tell answer no.
#[cfg(unix)]
pub(super) fn is_mount_point(folder: &fs::Metadata, parent: &fs::Metadata) -> bool {
    use std::os::unix::fs::MetadataExt;
    folder.dev() != parent.dev()
}

/// Returns whether a folder is on another file system than its parent. Systems that cannot tell answer no.
#[cfg(not(unix))]
pub(super) fn is_mount_point(_: &fs::Metadata, _: &fs::Metadata) -> bool {
    false
}

/// Opens a folder, to lock it.
#[cfg(not(windows))]
pub(super) fn open_folder(path: &Path) -> io::Result<File> {
    File::open(path)
}

/// Opens a folder. Windows does not lock folders: no process takes one for stale there.
#[cfg(windows)]
pub(super) fn open_folder(path: &Path) -> io::Result<File> {
    use std::os::windows::fs::OpenOptionsExt;
    /// Folders cannot be opened without this flag.
    const FILE_FLAG_BACKUP_SEMANTICS: u32 = 0x0200_0000;
    File::options().read(true).custom_flags(FILE_FLAG_BACKUP_SEMANTICS).open(path)
}

/// Exchanges the names of two folders in one step; `None` if the system or the file system cannot do that.
#[cfg(any(target_os = "linux", target_os = "macos"))]
pub(super) fn exchanged(a: &Path, b: &Path) -> Option<io::Result<()>> {
    use rustix::fs::{CWD, RenameFlags, renameat_with};
    use rustix::io::Errno;
    match renameat_with(CWD, a, CWD, b, RenameFlags::EXCHANGE) {
        Err(Errno::INVAL | Errno::NOSYS | Errno::OPNOTSUPP) => None,
        done => Some(done.map_err(io::Error::from)),
    }
}

/// Exchanges the names of two folders in one step; `None` if the system or the file system cannot do that.
#[cfg(not(any(target_os = "linux", target_os = "macos")))]
pub(super) fn exchanged(_: &Path, _: &Path) -> Option<io::Result<()>> {
    None
}

//! What only some operating systems offer, each with a plain alternative for the others.

use std::fs::{self, File};
use std::io;
use std::path::Path;

/// Whether an open file or folder is still the one that bears this name. Systems that cannot tell say yes where anything
/// bears the name.
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

/// Whether a folder lies on another file system than its parent. Systems that cannot tell say no.
#[cfg(unix)]
pub(super) fn is_mount_point(folder: &fs::Metadata, parent: &fs::Metadata) -> bool {
    use std::os::unix::fs::MetadataExt;
    folder.dev() != parent.dev()
}

/// Whether a folder lies on another file system than its parent. Systems that cannot tell say no.
#[cfg(not(unix))]
pub(super) fn is_mount_point(_: &fs::Metadata, _: &fs::Metadata) -> bool {
    false
}

/// A folder, opened to be locked.
#[cfg(not(windows))]
pub(super) fn open_folder(path: &Path) -> io::Result<File> {
    File::open(path)
}

/// A folder, opened; Windows does not lock folders, so that nobody takes it for stale.
#[cfg(windows)]
pub(super) fn open_folder(path: &Path) -> io::Result<File> {
    use std::os::windows::fs::OpenOptionsExt;
    /// Without it folders cannot be opened.
    const FILE_FLAG_BACKUP_SEMANTICS: u32 = 0x0200_0000;
    File::options().read(true).custom_flags(FILE_FLAG_BACKUP_SEMANTICS).open(path)
}

/// Exchanges the names of two folders in one step; `None` where the system or the file system cannot do that.
#[cfg(any(target_os = "linux", target_os = "macos"))]
pub(super) fn exchanged(a: &Path, b: &Path) -> Option<io::Result<()>> {
    use rustix::fs::{CWD, RenameFlags, renameat_with};
    use rustix::io::Errno;
    match renameat_with(CWD, a, CWD, b, RenameFlags::EXCHANGE) {
        Err(Errno::INVAL | Errno::NOSYS | Errno::OPNOTSUPP) => None,
        done => Some(done.map_err(io::Error::from)),
    }
}

/// Exchanges the names of two folders in one step; `None` where the system or the file system cannot do that.
#[cfg(not(any(target_os = "linux", target_os = "macos")))]
pub(super) fn exchanged(_: &Path, _: &Path) -> Option<io::Result<()>> {
    None
}

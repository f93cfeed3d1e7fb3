//! A single file, replaced in one step.

use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::temporary;
use crate::error::{Error, Result};

/// Writes a file so that whoever looks finds the old content or the new one, each whole; what is no ordinary file (a pipe,
/// a device) is written to as it is. Of a symbolic link the file behind it is replaced. What a killed process has left
/// beside it is removed.
///
/// # Errors
/// Whatever the disk says; the old file is then as it was.
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<()> {
    let path = &behind_links(path)?;
    let written = if path.metadata().is_ok_and(|found| !found.is_file()) {
        std::fs::write(path, bytes)
    } else {
        replace(path, bytes)
    };
    written.map_err(|error| {
        let (expected, advice) = ("a file that can be written", "check path, permissions and free space");
        Error::new(path.display().to_string(), error.to_string(), expected, advice)
    })
}

/// The file behind a symbolic link, which is the one to be replaced; any other path as it is.
///
/// # Errors
/// A link to nothing: what it is meant for is unknown.
pub fn behind_links(path: &Path) -> Result<PathBuf> {
    match path.canonicalize() {
        Ok(real) if path.is_symlink() => Ok(real),
        Err(_) if path.is_symlink() => {
            let (expected, advice) = ("a file, or nothing yet", "remove it or give another name");
            Err(Error::new(path.display().to_string(), "a broken symbolic link", expected, advice))
        }
        _ => Ok(path.to_path_buf()),
    }
}

fn replace(path: &Path, bytes: &[u8]) -> io::Result<()> {
    // The folder of a bare name is the empty path.
    let path = std::path::absolute(path)?;
    path.parent().into_iter().for_each(temporary::remove_stale);
    let (temporary, mut file) = temporary::locked(&path, |name| File::create_new(name))?;
    let moved = file.write_all(bytes).and_then(|()| std::fs::rename(&temporary, path));
    if moved.is_err() {
        // What cannot be removed is left to the next one.
        let _ = std::fs::remove_file(&temporary);
    }
    moved
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_replaced_or_left_as_it_was() -> Result<()> {
        let folder = std::env::temp_dir().join(format!("wheelrail-file-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap_or_default();
        let path = folder.join("curves.svg");
        for text in ["old", "new"] {
            write_file(&path, text.as_bytes())?;
            assert_eq!(std::fs::read_to_string(&path).unwrap_or_default(), text);
        }
        let link = folder.join("link.svg");
        std::os::unix::fs::symlink(&path, &link).unwrap_or_default();
        write_file(&link, b"newest")?;
        assert!(link.is_symlink() && std::fs::read(&path).is_ok_and(|text| text == b"newest"));
        std::fs::remove_file(&link).unwrap_or_default();
        std::os::unix::fs::symlink(folder.join("missing"), &link).unwrap_or_default();
        assert!(write_file(&link, b"x").is_err_and(|e| e.found == "a broken symbolic link"));
        std::fs::remove_file(&link).unwrap_or_default();
        // Left by a killed process, and in use by a living one.
        let [dead, living] =
            [".wheelrail-tmp.curves.svg.1.0", ".wheelrail-tmp.curves.svg.2.0"].map(|name| folder.join(name));
        std::fs::write(&dead, "half").unwrap_or_default();
        let lock = File::create(&living).map_err(|e| Error::new("", e.to_string(), "", ""))?;
        lock.lock().unwrap_or_default();
        write_file(&path, b"x")?;
        assert!(!dead.exists() && living.exists());
        std::fs::remove_file(&living).unwrap_or_default();
        assert!(write_file(&folder.join("missing/curves.svg"), b"x").is_err());
        assert!(write_file(&folder, b"x").is_err());
        assert_eq!(std::fs::read_dir(&folder).map(Iterator::count).unwrap_or_default(), 1);
        std::fs::remove_dir_all(&folder).unwrap_or_default();
        Ok(())
    }
}

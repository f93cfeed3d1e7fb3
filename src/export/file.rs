//! A single file, replaced in one step.

use std::path::Path;

use crate::error::{Error, Result};

/// Writes a file so that whoever looks finds the old content or the new one, each whole; what is no ordinary file (a pipe,
/// a device) is written to as it is. Of a symbolic link the file behind it is replaced.
///
/// # Errors
/// Whatever the disk says; the old file is then as it was.
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<()> {
    let behind = path.canonicalize();
    let path = behind.as_deref().unwrap_or(path);
    let written = if path.metadata().is_ok_and(|found| !found.is_file()) {
        std::fs::write(path, bytes)
    } else {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let temporary = path.with_file_name(format!(".{name}.{}.wheelrail-tmp", std::process::id()));
        let moved = std::fs::write(&temporary, bytes).and_then(|()| std::fs::rename(&temporary, path));
        if moved.is_err() {
            // There may be nothing to remove.
            let _ = std::fs::remove_file(&temporary);
        }
        moved
    };
    written.map_err(|error| {
        let expected = "a file that can be written";
        Error::new(path.display().to_string(), error.to_string(), expected, "check path and permissions")
    })
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
        assert!(write_file(&folder.join("missing/curves.svg"), b"x").is_err());
        assert!(write_file(&folder, b"x").is_err());
        assert_eq!(std::fs::read_dir(&folder).map(Iterator::count).unwrap_or_default(), 1);
        std::fs::remove_dir_all(&folder).unwrap_or_default();
        Ok(())
    }
}

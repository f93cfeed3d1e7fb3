//! Replaces the generated table inside a page that people write.

use std::path::{Path, PathBuf};

use wheelrail::error::{Error, Result};
use wheelrail::files::{read_text, write_file};

/// First of the two marker lines. Everything between them is generated.
const BEGIN: &str = "<!-- report:begin -->";
const END: &str = "<!-- report:end -->";

/// Largest page that is read \[bytes\].
const LARGEST_PAGE: usize = 1 << 26;

/// A file that has both markers.
#[derive(Debug)]
pub(super) struct SplicedFile {
    path: PathBuf,
}

impl SplicedFile {
    /// Checks that the file can be read and has its markers.
    ///
    /// # Errors
    /// A file that cannot be read; a marker that is missing, doubled or misplaced.
    pub(super) fn open(path: &Path) -> Result<Self> {
        let target = Self { path: path.to_path_buf() };
        target.spliced("").map(|_| target)
    }

    /// Replaces the text between the markers. The file is read again, and replaced in one step.
    ///
    /// # Errors
    /// The errors of [`SplicedFile::open`]; a folder that cannot be written.
    pub(super) fn replace(&self, generated: &str) -> Result<()> {
        write_file(&self.path, self.spliced(generated)?.as_bytes())
    }

    fn spliced(&self, generated: &str) -> Result<String> {
        let text = read_text(&self.path, LARGEST_PAGE)?;
        spliced(&text, generated).map_err(|error| error.within(self.path.display()))
    }
}

/// Returns `text` with `generated` between its markers.
fn spliced(text: &str, generated: &str) -> Result<String> {
    let parts = text.split_once(BEGIN).and_then(|(before, rest)| {
        let (_, after) = rest.split_once(END)?;
        Some((before, after))
    });
    let unique = text.matches(BEGIN).count() == 1 && text.matches(END).count() == 1;
    match parts.filter(|_| unique) {
        Some((before, after)) => Ok(format!("{before}{BEGIN}\n\n{}\n\n{END}{after}", generated.trim())),
        None => {
            let found =
                format!("{} × {BEGIN}, {} × {END}", text.matches(BEGIN).count(), text.matches(END).count());
            Err(Error::new(
                "",
                found,
                "each once, in this order",
                "put both markers where the table is to be",
            ))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_is_between_the_markers_changes() -> Result<()> {
        let text = format!("a\n{BEGIN}\nold\n{END}\nb\n");
        let new = spliced(&text, "| new |\n")?;
        assert_eq!(new, format!("a\n{BEGIN}\n\n| new |\n\n{END}\nb\n"));
        assert_eq!(spliced(&new, "| new |\n")?, new);
        Ok(())
    }

    #[test]
    fn missing_doubled_or_swapped_markers_are_refused() {
        for text in ["", BEGIN, &format!("{END}{BEGIN}"), &format!("{BEGIN}{END}{BEGIN}")] {
            assert!(spliced(text, "x").is_err(), "{text}");
        }
    }
}

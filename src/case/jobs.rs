//! Files to be written, each with the writer of its content, and the writing of all of them on all threads.

use std::io::Write;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use super::formats::Writer;
use super::input::Outputs;
use crate::error::{Error, Result};
use crate::files::FolderPart;

/// A file and the writer of its content.
pub(super) type Job<'a> = (&'static str, Box<dyn Fn(&FolderPart<'_>) -> Result<()> + Sync + Send + 'a>);

/// Writes files on all threads, tells how many are done, and gives their names in order.
pub(super) fn write_jobs(
    jobs: &[Job<'_>],
    folder: &FolderPart<'_>,
    tell: impl Fn(usize) + Sync,
) -> Result<Vec<String>> {
    let written = AtomicUsize::new(0);
    jobs.par_iter().try_for_each(|(_, job)| {
        job(folder)?;
        tell(1 + written.fetch_add(1, Ordering::Relaxed));
        Ok(())
    })?;
    let mut names: Vec<String> = jobs.iter().map(|(name, _)| (*name).to_string()).collect();
    names.sort();
    Ok(names)
}

/// Makes what files of such writers are written from, if any of them is asked for. What cannot be made (decks need
/// equal steps) is an error where the formats are required, and a remark elsewhere.
pub(super) fn possible<T>(
    outputs: &Outputs,
    files: &str,
    such: fn(&Writer) -> bool,
    content: impl FnOnce() -> Result<T>,
    skipped: &mut Vec<String>,
) -> Result<Option<T>> {
    if !outputs.wants(such) {
        return Ok(None);
    }
    match content() {
        Ok(content) => Ok(Some(content)),
        Err(Error { place, found, .. }) if !outputs.required => {
            skipped.push(format!("{files}: {place} has {found}"));
            Ok(None)
        }
        Err(error) => Err(error),
    }
}

/// Makes the job of a small file, made in memory.
pub(super) fn bytes<'a>(
    name: &'static str,
    content: impl Fn() -> Result<Vec<u8>> + Sync + Send + 'a,
) -> Job<'a> {
    let content = move || content().map_err(|error| error.within(name));
    (name, Box::new(move |folder: &FolderPart<'_>| folder.write(name, &content()?)))
}

/// Makes the job of a large file, written piece by piece.
pub(super) fn stream<'a>(
    name: &'static str,
    content: impl Fn(&mut dyn Write) -> std::io::Result<()> + Sync + Send + 'a,
) -> Job<'a> {
    (name, Box::new(move |folder: &FolderPart<'_>| folder.stream(name, &content)))
}

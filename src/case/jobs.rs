//! Files to be written, each with the writer of its content, and the writing of all of them on all threads.

use std::io::{self, Write};
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use super::formats::Writer;
use super::input::Outputs;
use crate::error::{Error, ErrorKind, Result};
use crate::files::FolderPart;

/// A file's name and content.
pub(super) type Job<'a> = (&'static str, Content<'a>);

/// Writes a file piece by piece.
type Pieces<'a> = dyn Fn(&mut dyn Write) -> io::Result<()> + Sync + Send + 'a;

/// How the content of a file comes about.
pub(super) enum Content<'a> {
    /// All at once.
    Bytes(Box<dyn Fn() -> Result<Vec<u8>> + Sync + Send + 'a>),
    /// Piece by piece: a large file.
    Stream(Box<Pieces<'a>>),
}

/// Writes files on all threads, tells how many are done, and gives their names in order.
pub(super) fn write_jobs(
    jobs: &[Job<'_>],
    folder: &FolderPart<'_>,
    tell: impl Fn(usize) + Sync,
) -> Result<Vec<String>> {
    let written = AtomicUsize::new(0);
    jobs.par_iter().try_for_each(|(name, content)| {
        match content {
            Content::Bytes(bytes) => folder.write(name, &bytes()?)?,
            Content::Stream(write) => folder.stream(name, write)?,
        }
        tell(1 + written.fetch_add(1, Ordering::Relaxed));
        Ok(())
    })?;
    let mut names: Vec<String> = jobs.iter().map(|(name, _)| (*name).to_string()).collect();
    names.sort();
    Ok(names)
}

/// Makes the contents of files on all threads; gives them by name.
pub(super) fn contents(jobs: &[Job<'_>]) -> Result<Vec<(&'static str, Vec<u8>)>> {
    let content = |(name, content): &Job<'_>| match content {
        Content::Bytes(bytes) => Ok((*name, bytes()?)),
        Content::Stream(write) => {
            let mut bytes = Vec::new();
            write(&mut bytes).map_err(|error| {
                let expected = "memory for the whole file";
                Error::new(*name, error.to_string(), expected, "take a coarser grid").of_kind(ErrorKind::Io)
            })?;
            Ok((*name, bytes))
        }
    };
    jobs.par_iter().map(content).collect()
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
    (name, Content::Bytes(Box::new(move || content().map_err(|error| error.within(name)))))
}

/// Makes the job of a large file, written piece by piece.
pub(super) fn stream<'a>(
    name: &'static str,
    content: impl Fn(&mut dyn Write) -> io::Result<()> + Sync + Send + 'a,
) -> Job<'a> {
    (name, Content::Stream(Box::new(content)))
}

//! The answer of a command: data on stdout, messages on stderr, and the outcome.

use std::path::Path;

use wheelrail::files::write_file;
use wheelrail::{Error, Result};

/// The outcome of a command, which decides its exit code.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// The command did what it was asked to do.
    Done,
    /// The answer is "no": for example an infeasible contact, an empty patch or a failed check.
    No,
}

/// Writes data to stdout. A reader that has gone away early (`| head`) is not an error.
pub fn print(text: &str) -> Result<Outcome> {
    print_to_reader(text).map(|_| Outcome::Done)
}

/// Writes data to stdout. Returns whether the reader is still there.
pub fn print_to_reader(text: &str) -> Result<bool> {
    use std::io::Write;
    match std::io::stdout().lock().write_all(text.as_bytes()) {
        Ok(()) => Ok(true),
        Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => Ok(false),
        Err(error) => {
            Err(Error::new("stdout", error.to_string(), "a stream that takes the data", "check the disk"))
        }
    }
}

/// Writes to stderr why contacts are infeasible or patches empty. Returns [`Outcome::No`] if any is.
pub fn outcome(noes: impl IntoIterator<Item = String>) -> Outcome {
    let said = noes.into_iter().map(|no| complain(&format!("no: {no}"))).count();
    if said == 0 { Outcome::Done } else { Outcome::No }
}

/// Returns a number of things in words: "1 point", "2 points".
pub fn counted(n: usize, thing: &str) -> String {
    format!("{n} {thing}{}", if n == 1 { "" } else { "s" })
}

/// Writes a line to stderr. A failure is ignored, because it could not be reported.
pub fn complain(text: &str) {
    use std::io::Write;
    let _ = writeln!(std::io::stderr().lock(), "{text}");
}

/// Returns the folder to which the paths in a scene are relative.
pub fn folder_of(scene: &Path) -> &Path {
    scene.parent().unwrap_or(Path::new("."))
}

/// Writes text to a file, or to stdout if none is given.
pub fn put(text: &str, out: Option<&Path>) -> Result<Outcome> {
    let Some(path) = out else { return print(text) };
    write_file(path, text.as_bytes())?;
    Ok(Outcome::Done)
}

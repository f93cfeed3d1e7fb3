//! The error type of the whole crate. Its text has four parts: where → found → expected → what to do.

use std::sync::Arc;

use rayon::iter::ParallelIterator;

/// The kind of an error.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum ErrorKind {
    /// The input is malformed, contradictory or impossible.
    Input,
    /// The bodies do not lie as the input supposes: a point is off its profile, for example.
    Geometry,
    /// A wheel stands where it touches nothing.
    NoContact,
    /// A file or a stream cannot be opened, read or written.
    Io,
    /// The input asks for more than the program computes or reads: points, cells, bytes.
    Limit,
}

/// An error in four parts: where, what was found, what was expected, and what to do.
///
/// The command line ends with exit code 2 on every error. An infeasible contact or an empty patch is a
/// result, not an error. Two errors are equal if their kinds and their texts are equal.
#[derive(Debug, Clone, thiserror::Error)]
#[error("{place}: found {found}; expected {expected}; {advice}")]
pub struct Error {
    /// Kind of the error, for programs that decide by it.
    pub kind: ErrorKind,
    /// Where: file, key, segment or line.
    pub place: String,
    /// What was found there.
    pub found: String,
    /// What was expected there.
    pub expected: String,
    /// What the user can do about it.
    pub advice: String,
    /// The error of another library that this one reports.
    source: Option<Arc<dyn std::error::Error + Send + Sync>>,
}

/// The result type of every function of this crate that can fail.
pub type Result<T> = std::result::Result<T, Error>;

/// Collects the results of a parallel iterator in order. Of several errors it returns the first in order, whichever thread fails
/// first.
///
/// # Errors
/// The first error among them.
pub fn in_order<T: Send>(made: impl ParallelIterator<Item = Result<T>>) -> Result<Vec<T>> {
    let made: Vec<Result<T>> = made.collect();
    made.into_iter().collect()
}

impl PartialEq for Error {
    fn eq(&self, other: &Self) -> bool {
        self.kind == other.kind && self.to_string() == other.to_string()
    }
}

impl Eq for Error {}

impl Error {
    /// Makes an error about the input.
    ///
    /// # Examples
    /// ```
    /// use wheelrail::{Error, ErrorKind};
    ///
    /// let error = Error::new("wheel: radius", "-460", "a positive length in mm", "correct the sign");
    /// assert_eq!(error.kind, ErrorKind::Input);
    /// assert_eq!(
    ///     error.within("scene.toml").to_string(),
    ///     "scene.toml: wheel: radius: found -460; expected a positive length in mm; correct the sign"
    /// );
    /// ```
    pub fn new(
        place: impl Into<String>,
        found: impl Into<String>,
        expected: impl Into<String>,
        advice: impl Into<String>,
    ) -> Self {
        Self {
            kind: ErrorKind::Input,
            place: place.into(),
            found: found.into(),
            expected: expected.into(),
            advice: advice.into(),
            source: None,
        }
    }

    /// Returns this error with another kind.
    #[must_use]
    pub fn of_kind(self, kind: ErrorKind) -> Self {
        Self { kind, ..self }
    }

    /// Returns this error with the error of another library that caused it.
    #[must_use]
    pub fn caused_by(self, source: impl std::error::Error + Send + Sync + 'static) -> Self {
        Self { source: Some(Arc::new(source)), ..self }
    }

    /// Returns this error with another place: for example the option that a value came from.
    #[must_use]
    pub fn at(self, place: impl Into<String>) -> Self {
        Self { place: place.into(), ..self }
    }

    /// Returns this error with `outer` put before its place, for example the file before the key.
    #[must_use]
    pub fn within(mut self, outer: impl std::fmt::Display) -> Self {
        self.place =
            if self.place.is_empty() { outer.to_string() } else { format!("{outer}: {}", self.place) };
        self
    }
}

/// Returns `value` if it is finite. No quantity of a scene may be NaN or infinite.
///
/// # Errors
/// `value` is NaN or infinite; the error names `place`.
pub fn finite(place: &str, value: f64) -> Result<f64> {
    if value.is_finite() {
        return Ok(value);
    }
    Err(Error::new(place, value.to_string(), "a finite number", "give a number"))
}

/// Returns the names of the keys that are given, for messages: "`from` and `slope`". Each entry is (key, whether it is
/// given).
pub fn given(keys: &[(&str, bool)]) -> String {
    let given: Vec<String> =
        keys.iter().filter(|(_, given)| *given).map(|(key, _)| format!("`{key}`")).collect();
    match given.as_slice() {
        [] => {
            let all: Vec<String> = keys.iter().map(|(key, _)| format!("`{key}`")).collect();
            format!("none of {}", all.join(", "))
        }
        [one] => format!("{one} alone"),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

//! The one error type: where → found → expected → what to do.

use std::sync::Arc;

/// What kind of thing went wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum ErrorKind {
    /// The input is malformed, contradictory or impossible.
    Input,
    /// The bodies do not lie as the input supposes: a point off its profile, a wheel beside its rail.
    Geometry,
    /// The disk or a stream does not do what it is asked.
    Io,
    /// More is asked for than the program computes or reads: points, cells, bytes.
    Limit,
}

/// An error in four parts: where, what was found, what was expected, and what to do.
///
/// The command line ends with exit code 2 on each. A geometric "no" (an infeasible contact, an empty patch) is a result,
/// not an error. Two errors are equal if their kinds and texts are.
#[derive(Debug, Clone, thiserror::Error)]
#[error("{place}: found {found}; expected {expected}; {advice}")]
pub struct Error {
    /// ErrorKind of the error, for programs.
    pub kind: ErrorKind,
    /// Where: file, key, segment or line.
    pub place: String,
    /// What stands there.
    pub found: String,
    /// What could stand there.
    pub expected: String,
    /// What the user can do about it.
    pub advice: String,
    /// The error of another library that this one reports.
    source: Option<Arc<dyn std::error::Error + Send + Sync>>,
}

/// Result of everything that can fail.
pub type Result<T> = std::result::Result<T, Error>;

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

    /// Makes it an error of another kind.
    #[must_use]
    pub fn of_kind(self, kind: ErrorKind) -> Self {
        Self { kind, ..self }
    }

    /// Adds the error that it reports.
    #[must_use]
    pub fn caused_by(self, source: impl std::error::Error + Send + Sync + 'static) -> Self {
        Self { source: Some(Arc::new(source)), ..self }
    }

    /// Names another place instead of its own: the option, say, that a value came from.
    #[must_use]
    pub fn at(self, place: impl Into<String>) -> Self {
        Self { place: place.into(), ..self }
    }

    /// Puts `outer` before the place: the error seen from one level further out.
    #[must_use]
    pub fn within(mut self, outer: impl std::fmt::Display) -> Self {
        self.place =
            if self.place.is_empty() { outer.to_string() } else { format!("{outer}: {}", self.place) };
        self
    }
}

/// Rejects NaN and infinities, which no quantity of a scene may be.
///
/// # Errors
/// Names `place` when `value` is not finite.
pub fn finite(place: &str, value: f64) -> Result<f64> {
    if value.is_finite() {
        return Ok(value);
    }
    Err(Error::new(place, value.to_string(), "a finite number", "give a number"))
}

/// Names the keys that are given, for messages: "`from` and `slope`".
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

//! The one error type: where → found → expected → what to do.

/// Something in the input that the program cannot work with.
///
/// Always exit code 2. A geometric "no" (an infeasible contact, an empty patch) is a result, not an error.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{place}: found {found}; expected {expected}; {advice}")]
pub struct Error {
    /// Where: file, key, segment or line.
    pub place: String,
    /// What stands there.
    pub found: String,
    /// What could stand there.
    pub expected: String,
    /// What the user can do about it.
    pub advice: String,
}

/// Result of everything that reads input.
pub type Result<T> = std::result::Result<T, Error>;

impl Error {
    /// An error in the house form.
    pub fn new(
        place: impl Into<String>,
        found: impl Into<String>,
        expected: impl Into<String>,
        advice: impl Into<String>,
    ) -> Self {
        Self { place: place.into(), found: found.into(), expected: expected.into(), advice: advice.into() }
    }

    /// The same error seen from one level further out: `outer` is put before the place.
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

/// Those of some keys that are given, for messages: "`from` and `slope`".
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

//! A value of each body.

/// A value of the rail and one of the wheel.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Bodies<T> {
    /// The rail's.
    pub rail: T,
    /// The wheel's.
    pub wheel: T,
}

impl<T> Bodies<T> {
    /// Gives both values in the order rail, wheel.
    pub fn both(&self) -> [&T; 2] {
        [&self.rail, &self.wheel]
    }

    /// Applies `of` to each value.
    pub fn map<U>(self, of: impl Fn(T) -> U) -> Bodies<U> {
        Bodies { rail: of(self.rail), wheel: of(self.wheel) }
    }
}

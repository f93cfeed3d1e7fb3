//! How accurate the program is, measured by itself.

pub mod measured;

//! A column of a table, as a user names it.

use std::fmt;

use serde::{Deserialize, Serialize};

/// A column of a table.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "files", derive(schemars::JsonSchema))]
#[serde(untagged, expecting = "expected a column's number, from 1, or its name in the first row")]
pub enum Column {
    /// Number of the column, from 1.
    Number(usize),
    /// Name of the column in the first row, in upper or lower case.
    Name(String),
}

impl fmt::Display for Column {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Number(n) => write!(f, "{n}"),
            Self::Name(name) => write!(f, "\"{name}\""),
        }
    }
}

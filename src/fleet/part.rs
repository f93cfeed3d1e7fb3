//! A part of a fleet as a file.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::pair::FleetRow;
use crate::error::{Error, Result};
use crate::files::read_bytes;

/// Largest file of a part \[bytes\]: a quarter of a megabyte for each of a thousand pairs.
const LARGEST: usize = 1 << 28;
/// Beginning of the names of the parts' files.
const NAME: &str = "part-";

/// The rows of a part, and how many wheels touch each cell of the rail at each displacement.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct FleetPart {
    hash: String,
    pub rows: Vec<FleetRow>,
    /// Number of the displacement, of the cell, and of the wheels that touch there.
    pub touched: Vec<(i32, i32, u32)>,
}

/// Names the file of a part.
pub(super) fn name(number: usize) -> String {
    format!("{NAME}{number:06}.json")
}

/// Tells whether a file is that of a part.
pub(super) fn is_part(name: &str) -> bool {
    name.starts_with(NAME) && name.ends_with(".json")
}

impl FleetPart {
    /// Takes the rows of a part and counts where its wheels touch.
    pub fn new(hash: String, mut rows: Vec<FleetRow>) -> Self {
        let mut touched: BTreeMap<[i32; 2], u32> = BTreeMap::new();
        for row in &mut rows {
            for cell in std::mem::take(&mut row.touched) {
                *touched.entry(cell).or_default() += 1;
            }
        }
        let touched = touched.into_iter().map(|([position, cell], count)| (position, cell, count)).collect();
        Self { hash, rows, touched }
    }

    pub fn bytes(&self) -> Vec<u8> {
        // Rows have text and finite numbers alone, which cannot fail to be written.
        serde_json::to_vec(self).unwrap_or_default()
    }

    /// Returns the hash of the part in a file; `None` if there is no whole part.
    pub fn hash_of(path: &Path) -> Option<String> {
        Self::read(path).ok().map(|part| part.hash)
    }

    /// Reads a part.
    ///
    /// # Errors
    /// An unreadable file; one that is no part.
    pub fn read(path: &Path) -> Result<Self> {
        let bytes = read_bytes(path, LARGEST)?;
        serde_json::from_slice(&bytes).map_err(|error| {
            let place = path.display().to_string();
            Error::new(place, error.to_string(), "a part of a fleet", "delete it and start again")
        })
    }
}

//! Writes arrays into the data of a page.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::Serializer;

/// Writes numbers in single precision: little-endian, as base64. A page only draws them; the full digits are in other files.
pub(super) fn floats<S: Serializer>(
    values: &impl AsRef<[f64]>,
    serializer: S,
) -> std::result::Result<S::Ok, S::Error> {
    let bytes: Vec<u8> = values.as_ref().iter().flat_map(|&value| (value as f32).to_le_bytes()).collect();
    serializer.serialize_str(&STANDARD.encode(bytes))
}

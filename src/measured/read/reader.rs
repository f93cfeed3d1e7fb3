//! Calls the reader of a file's format.

use super::format::Format;
use super::points::Points;
use super::{columns, miniprof, scan, simpack, table, vampire};
use crate::error::Result;
use crate::measured::column::Column;

/// Reads a file of a format. `free` names the two columns in formats whose columns are free.
///
/// # Errors
/// Anything that is not of the format, with its line; more than [`super::points::MOST_POINTS`] points.
pub fn read(bytes: &[u8], format: Format, free: Option<&[Column; 2]>) -> Result<Points> {
    let text = scan::text(bytes)?;
    match format {
        Format::MiniProf => miniprof::read(&text),
        Format::Simpack => simpack::read(&text),
        Format::Gensys => columns::read_gensys(&text),
        Format::Text | Format::Csv => table::read_table(&text, format, free),
        Format::Vampire => vampire::read(&text),
    }
}

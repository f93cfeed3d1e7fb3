//! `wheelrail midsep`: the Report's MIDSEP as text.

use std::path::Path;

use super::{Outcome, folder_of, print};
use crate::error::Result;
use crate::placement::midsep::table;
use crate::run::first_contact;
use crate::scene::{self, equal_steps};

/// Values of ξ when the scene leaves the axis to the program.
const DEFAULT_ROWS: usize = 101;

/// Prints the table of a scene.
pub(super) fn midsep(path: &Path) -> Result<Outcome> {
    let scene = scene::load(path)?;
    let pair = scene.pair(folder_of(path))?;
    let placement = first_contact(&scene, &pair)?;
    let xi = match scene.axis("xi")? {
        Some(xi) => xi,
        None => placement.overlap().map_or_else(Vec::new, |[a, b]| equal_steps(a, b, DEFAULT_ROWS)),
    };
    print(&table(&placement, &xi))
}

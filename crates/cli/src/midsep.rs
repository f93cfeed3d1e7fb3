//! `wheelrail midsep`: the Report's MIDSEP as text.

use std::path::Path;

use super::progress::Progress;
use super::{Outcome, folder_of, print};
use wheelrail::case::contacts;
use wheelrail::error::{Error, Result};
use wheelrail::placement::Placement;
use wheelrail::scene::{self, equal_steps};
use wheelrail::separation::midplane::table;

/// Values of ξ when the scene leaves the axis to the program.
const DEFAULT_ROWS: usize = 101;

/// Prints a table for every contact of a scene, under its name where there are several.
pub(super) fn midsep(path: &Path) -> Result<Outcome> {
    let _progress = Progress::of("midsep", "contacts");
    let scene = scene::load(path)?;
    let found = || Ok((scene.axis("xi")?, contacts(&scene, &scene.pair(folder_of(path))?)?));
    let (axis, contacts) = found().map_err(|error: Error| error.within(path.display()))?;
    let tables = contacts.iter().map(|(name, placement)| {
        let xi = axis.clone().unwrap_or_else(|| over(placement));
        let head = if contacts.len() > 1 { format!("# {name}\n") } else { String::new() };
        head + &table(placement, &xi)
    });
    print(&tables.collect::<Vec<_>>().join("\n"))
}

/// Equal steps over both bodies.
fn over(placement: &Placement) -> Vec<f64> {
    placement.overlap().map_or_else(Vec::new, |[a, b]| equal_steps(a, b, DEFAULT_ROWS))
}

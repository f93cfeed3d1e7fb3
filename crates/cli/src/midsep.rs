//! `wheelrail midsep`: the Report's MIDSEP as text.

use std::path::Path;

use super::progress::Progress;
use crate::answer::{Outcome, folder_of, print};
use wheelrail::case::contacts;
use wheelrail::error::Result;
use wheelrail::mesh::equal_steps;
use wheelrail::placement::Placement;
use wheelrail::scene;
use wheelrail::separation::midplane_table;

/// Number of values of ξ if the scene leaves the axis to the program.
const DEFAULT_ROWS: usize = 101;

/// Prints a table for every contact of a scene. Several contacts get their names as headings.
pub(super) fn midsep(path: &Path) -> Result<Outcome> {
    let _progress = Progress::of("midsep", "contacts");
    let scene = scene::load(path)?;
    let found =
        scene::resolve(&scene, folder_of(path), "midsep").and_then(|case| Ok((contacts(&case)?, case)));
    let (contacts, case) = found.map_err(|error| error.within(path.display()))?;
    case.profiles().swept("`wheelrail run` writes the separation over the whole grid")?;
    let tables = contacts.iter().map(|(name, placement)| {
        let xi = case.axes().xi.clone().unwrap_or_else(|| over(placement));
        let head = if contacts.len() > 1 { format!("# {name}\n") } else { String::new() };
        head + &midplane_table(placement, &xi)
    });
    print(&tables.collect::<Vec<_>>().join("\n"))
}

/// Returns equal steps of ξ \[mm\] over both bodies.
fn over(placement: &Placement) -> Vec<f64> {
    placement.overlap().map_or_else(Vec::new, |over| equal_steps(over.low, over.high, DEFAULT_ROWS))
}

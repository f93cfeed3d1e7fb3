//! Builds a table: finds the breaks between branches, then fits polynomials between them.

use rayon::prelude::*;

use super::asked::Asked;
use super::breaks::{breaks, stretches};
use super::cell::{Beginning, COEFFICIENTS};
use super::contact_table::ContactTable;
use super::fit::{Fitted, MARGIN, fit};
use super::quantity::Quantity;
use super::state::Sampler;
use crate::error::{Error, ErrorKind, Result, finite};
use crate::search::WheelsetOnTrack;

/// Tolerances \[mm\] that a table can have: below the first the rounding of a search counts, above the other nobody reads places.
const TOLERANCES: [f64; 2] = [1e-6, 1.0];

/// Widest range \[mm\]: far beyond any play of a wheelset.
const WIDEST: f64 = 200.0;

/// Builds a table.
///
/// Method: searches every 0.02 mm. Where the elements that touch differ, or a near miss may close in between, the step is halved until
/// its parts are clear or narrower than [`BREAK`](super::BREAK). Between breaks every quantity is interpolated at nine Chebyshev points, on cells
/// that are halved until eight other points agree to a quarter of the tolerance.
/// Accuracy: [`Quantity::error`]. Cost: some 2500 searches for a drawn pair over 18 mm, 5000 for a measured one, most of which begin from
/// one nearby; on the threads of the current rayon pool, and any number of threads gives the same bits.
///
/// # Errors
/// A range that is empty or wider than 200 mm; a tolerance outside 1e-6 to 1 mm; an angle beyond ±0.5 rad; a rail that varies along the track, and a
/// roller; no contact in the whole range.
pub fn build(system: &WheelsetOnTrack, asked: &Asked) -> Result<ContactTable> {
    check(system, asked)?;
    let radius = system.right().wheelset().radius;
    let pressed = asked.pressed.is_some();
    let mut quantities = Quantity::all(asked.tolerance, radius, pressed);
    let (ends, breaks) = breaks(system, asked)?;
    let stretches = stretches(ends, Beginning::Edge, breaks);
    let fitted = stretches.par_iter().map(|stretch| {
        let mut sampler = Sampler::new(system, asked);
        fit(&mut sampler, &quantities, stretch)
    });
    let cells: Vec<Fitted> = fitted.collect::<Result<Vec<_>>>()?.into_iter().flatten().collect();
    if cells.iter().all(|cell| !cell.cell.touches) {
        let [from, to] = asked.lateral;
        let found = format!("no contact from {from} to {to} mm");
        let error = Error::new("table: lateral", found, "wheels over their rails", "take another range");
        return Err(error.of_kind(ErrorKind::NoContact));
    }
    for fitted in &cells {
        for (quantity, error) in quantities.iter_mut().zip(fitted.errors) {
            quantity.error = quantity.error.max(MARGIN * error);
        }
    }
    let count = quantities.len();
    let mut coefficients = Vec::with_capacity(cells.len() * COEFFICIENTS * count);
    for fitted in &cells {
        fitted.coefficients.iter().for_each(|row| coefficients.extend_from_slice(&row[..count]));
    }
    let cells = cells.iter().map(|fitted| fitted.cell).collect();
    ContactTable::of((asked.lateral, asked.yaw, radius, asked.tolerance), quantities, cells, coefficients)
}

fn check(system: &WheelsetOnTrack, asked: &Asked) -> Result<()> {
    let [from, to] = asked.lateral;
    finite("table: lateral", from)?;
    finite("table: lateral", to)?;
    if from >= to || to - from > WIDEST {
        let expected = format!("FROM < TO, at most {WIDEST} mm apart");
        return Err(Error::new("table: lateral", format!("{from}:{to}"), expected, "for example -9:9"));
    }
    let [least, most] = TOLERANCES;
    if !(least..=most).contains(&asked.tolerance) {
        let expected = format!("a length from {least:e} to {most} mm");
        return Err(Error::new(
            "table: tolerance",
            asked.tolerance.to_string(),
            expected,
            "for example 1e-3",
        ));
    }
    if !system.on_plain_rails() {
        let found = "a rail that varies along the track, or a roller";
        return Err(Error::new("table: rail", found, "rails of one profile", "take one slice of the rail"));
    }
    Ok(())
}

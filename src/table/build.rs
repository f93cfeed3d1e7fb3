//! Builds a table: divides the range into cells with polynomials, and states their errors.

use super::about::About;
use super::asked::Asked;
use super::contact_table::ContactTable;
use super::fit::MARGIN;
use super::quantity::{MOST, TableQuantity};
use super::region::Divider;
use super::tree::Tree;
use crate::error::{Error, ErrorKind, Result, finite};
use crate::numerics::interval::Interval;
use crate::search::WheelsetOnTrack;

/// Tolerances \[mm\] that a table can have: below the first one the rounding of a search counts; above the other one places are useless.
const TOLERANCES: Interval = Interval::new(1e-6, 1.0);

/// Widest range \[mm\]: far beyond any play of a wheelset.
const WIDEST: f64 = 200.0;

/// Builds a table.
///
/// Method: searches every 0.02 mm. Where the elements that touch differ, or a near miss may close in between, the step is halved until
/// its parts are clear or narrower than [`BREAK`](super::BREAK). Between breaks every quantity is interpolated at nine Chebyshev
/// points, on cells that are halved until eight other points agree to a quarter of the tolerance. [`crate::docs::tables`] has the method
/// over a range of yaws. Accuracy: [`TableQuantity::error`]. Cost: some 2500 searches for a drawn pair over 18 mm, 5000 for a measured
/// one, most of which begin from one nearby; on the threads of the current rayon pool, and any number of threads gives the same bits.
///
/// # Errors
/// A range that is empty or wider than 200 mm; yaws that descend; a tolerance outside 1e-6 to 1 mm; an angle beyond ±0.5 rad; a rail
/// that varies along the track, or a roller; more than 10,000 hops and joints close together, or 15,000 cells over a range of yaws; no
/// contact in the whole range.
pub fn build(system: &WheelsetOnTrack, asked: &Asked) -> Result<ContactTable> {
    check(system, asked)?;
    let radius = system.right().wheelset().radius;
    let pressed = asked.pressed.is_some();
    let mut quantities = TableQuantity::all(asked.tolerance, radius, pressed);
    let branch = Divider::new(system, asked, &quantities).whole()?;
    let about = About { lateral: asked.lateral, yaw: asked.yaw, radius, tolerance: asked.tolerance };
    let mut errors = [0.0_f64; MOST];
    branch.cells().iter().for_each(|fitted| {
        errors.iter_mut().zip(fitted.errors).for_each(|(error, found)| *error = error.max(MARGIN * found));
    });
    for (quantity, error) in quantities.iter_mut().zip(errors) {
        quantity.error = quantity.error.max(error);
    }
    let table = ContactTable::of(about, quantities, Tree::of(branch, about))?;
    if table.cells().iter().all(|cell| !cell.touches) {
        let [from, to] = asked.lateral.ends();
        let found = format!("no contact from {from} to {to} mm");
        let error = Error::new("table: lateral", found, "wheels over their rails", "take another range");
        return Err(error.of_kind(ErrorKind::NoContact));
    }
    Ok(table)
}

fn check(system: &WheelsetOnTrack, asked: &Asked) -> Result<()> {
    let [from, to] = asked.lateral.ends();
    finite("table: lateral", from)?;
    finite("table: lateral", to)?;
    if from >= to || to - from > WIDEST {
        let expected = format!("FROM < TO, at most {WIDEST} mm apart");
        return Err(Error::new("table: lateral", format!("{from}:{to}"), expected, "for example -9:9"));
    }
    let [first, last] = asked.yaw.ends();
    finite("table: yaw", first)?;
    finite("table: yaw", last)?;
    if first > last {
        let found = format!("{first}:{last}");
        return Err(Error::new("table: yaw", found, "FROM < TO in rad", "for example -0.02:0.02"));
    }
    if !TOLERANCES.contains(asked.tolerance) {
        let expected = format!("a length from {:e} to {} mm", TOLERANCES.low, TOLERANCES.high);
        return Err(Error::new(
            "table: tolerance",
            asked.tolerance.to_string(),
            expected,
            "for example 1e-3",
        ));
    }
    if !system.on_plain_rails() {
        let found = "a rail or wheel that varies, or a roller";
        return Err(Error::new("table: rail", found, "rails of one profile", "take one slice of the rail"));
    }
    Ok(())
}

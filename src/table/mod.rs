//! Contact tables: the places of contact of a wheelset over its lateral displacement as piecewise polynomials with a stated error.
//!
//! Vehicle dynamics looks contact up, thousands of times a second. A table divides the range of displacements into cells. Over a cell
//! the same elements of the profiles touch on both sides, so that every quantity is analytic there, and each is one polynomial. Cells
//! end where contact hops to another place, where it crosses a joint, where a wheel leaves its rail, and where a polynomial would err
//! by more than the tolerance: see [`crate::docs::tables`].

mod about;
mod asked;
mod breaks;
mod build;
mod cell;
mod contact_table;
mod curve;
mod fit;
mod quantity;
mod read;
mod region;
mod state;
mod tree;

pub use about::About;
pub use asked::{Asked, Pressed};
pub use breaks::roll_ends;
pub use build::build;
pub use cell::{BREAK, Beginning, COEFFICIENTS, Cell, Lacks, YAW_COEFFICIENTS};
pub use contact_table::ContactTable;
pub use curve::Curve;
pub use quantity::{Needs, TOLERANCE_LENGTH, TableQuantity};
pub use tree::{Fork, PlanePart};

//! Checks measured points, and makes the repairs that the options allow.

pub(in crate::measured) mod bridges;
pub mod checks;
mod course;
pub mod findings;
mod loops;
mod order;
pub mod repairs;
pub mod reversals;
pub(super) mod runs;
mod walk;

//! Checks measured points, and makes the repairs that the options allow.

pub(in crate::measured) mod bridges;
pub mod checks;
mod course;
mod loops;
mod order;
pub mod repairs;
pub(super) mod runs;

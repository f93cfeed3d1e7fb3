//! Checks measured points, and makes the repairs that the options allow.

pub mod checks;
mod loops;
pub mod repairs;

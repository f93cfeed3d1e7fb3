//! Checks measured points, and makes the repairs that an option allows.

pub mod checks;
mod loops;
pub mod repairs;

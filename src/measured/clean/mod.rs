//! What can be wrong with measured points, and the repairs that an option allows.

pub mod checks;
mod loops;
pub mod repairs;

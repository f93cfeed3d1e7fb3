//! The contact point: is it feasible, and what does Hertz say of it.

pub mod feasibility;
pub mod hertz;
pub mod search;
pub mod sweep;
pub(crate) mod valleys;

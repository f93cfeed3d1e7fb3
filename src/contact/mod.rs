//! Where wheel and rail touch, and how.

pub mod search;
pub mod sweep;

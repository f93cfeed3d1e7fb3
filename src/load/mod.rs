//! From a normal load to an approach δ, and whether a chosen contact can stand at all.

pub mod feasibility;
pub mod hertz;
pub mod virtual_interpenetration;

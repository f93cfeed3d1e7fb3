//! From a normal load to an approach δ, and whether a chosen contact can stand at all.

mod feasibility;
mod hertz;
mod virtual_interpenetration;

pub use feasibility::{Feasibility, feasibility};
pub use hertz::{Curvatures, Elastic, Ellipse, curvatures, curvatures_at, effective_modulus};
pub use virtual_interpenetration::{Estimate, VirtualContact, approach_under_load};

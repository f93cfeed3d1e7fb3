//! From a load to approaches δ and back, and whether a chosen contact can stand at all.

mod approach;
mod feasibility;
mod half_space;
mod hertz;
mod weighted;

pub use approach::{Estimate, hertz_holds, under_total};
pub use feasibility::{Feasibility, feasibility};
pub use half_space::HalfSpace;
pub use hertz::{Curvatures, Elastic, Ellipse, curvatures, curvatures_at, effective_modulus};
pub use weighted::weighted_frame;

//! The approach δ under a load, the load under an approach, and whether a chosen contact is feasible.

mod approach;
mod feasibility;
mod half_space;
mod hertz;
mod weighted;

pub use approach::under_total;
pub use feasibility::{Feasibility, feasibility};
pub use half_space::{
    Cells, HalfSpace, Largest, Located, Pressures, SharpEdge, on_finer_cells, on_wider_cells, press,
    press_alone, sharp_edge,
};
pub use hertz::{
    Curvatures, Elastic, Ellipse, curvatures, curvatures_at, effective_modulus, quadratic_form_at,
};
pub use weighted::{WeightedFrame, weighted_frame};

//! The independent check: wheel and rail as triangle meshes, measured by parry3d.
//!
//! Nothing that is measured comes from the separation code: points of the meshes come from the profiles' own parametrisation,
//! turned about the axle and moved along the rail (`sampler`). Rays along ζ give s (`ray`), closest points
//! give distances (`closest`), and the error of all of it is first measured on closed forms (`floor`).

mod body;
mod closest;
mod compare;
mod floor;
mod meshes;
mod patch;
mod points;
mod ray;
mod relation;
mod report;
mod request;
mod sampler;

pub use compare::check;
pub use floor::Floor;
pub use relation::RELATION;
pub use report::{Counts, Differences, Distances, Orders, Report};
pub use request::{Answer, Request};

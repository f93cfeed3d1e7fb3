//! The independent check: wheel and rail as triangle meshes, measured by parry3d.
//!
//! No measured quantity comes from the separation code. Points of the meshes come from the profiles' own
//! parametrisation, turned about an axle or moved along the rail (`sampler`), or from the strips of a body that varies
//! (`lofted`). Rays along ζ give s (`ray`), closest points give distances (`closest`). The checker's own error is first
//! measured on closed forms (`floor`).

#![cfg_attr(not(test), warn(unused_crate_dependencies))]

mod body;
mod closest;
mod compare;
mod floor;
mod lofted;
mod meshes;
mod normal_gap;
mod patch;
mod points;
mod ray;
mod relation;
mod report;
mod request;
mod sampler;
mod site;

pub use compare::check;
pub use floor::Floor;
pub use lofted::LoftedReport;
pub use normal_gap::{NormalGapReport, NormalGapSample, check_normal_gap};
pub use relation::RELATION;
pub use report::{ClosestDistances, Counts, Differences, Orders, Report};
pub use request::{Answer, Request};
pub use site::{SiteReport, check_site};

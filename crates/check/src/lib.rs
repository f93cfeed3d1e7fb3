//! The independent check: wheel and rail as triangle meshes, measured by parry3d.
//!
//! No measured quantity comes from the separation code. Points of the meshes come from the profiles' own
//! parametrisation, turned about the axle and moved along the rail (`sampler`). Rays along ζ give s (`ray`),
//! closest points give distances (`closest`). The error of all this is first measured on closed forms
//! (`floor`).

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
mod sampler;

pub use compare::check;
pub use floor::Floor;
pub use relation::RELATION;
pub use report::{Counts, Differences, Distances, Orders, Report};

use wheelrail::patch::Window;
use wheelrail::separation::{Evaluator, Normals};

/// The extent of a check of a placed pair.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Request {
    /// Rectangle of the ξ–η plane over which points are spread \[mm\].
    pub window: Window,
    /// Approach δ \[mm\]: tips, boundary and deepest points of the patch s < δ are among the points.
    pub approach: f64,
}

/// The program's answer at one (ξ, η).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Answer {
    /// s \[mm\], NaN where a body has no surface.
    pub separation: f64,
    /// Outward unit normals of both bodies.
    pub normals: Normals,
}

impl Answer {
    /// Returns the answer of the point-wise evaluator.
    pub fn of(evaluator: &mut Evaluator<'_>, xi: f64, eta: f64) -> Self {
        Self { separation: evaluator.separation(xi, eta), normals: evaluator.normals(xi, eta) }
    }
}

//! What is asked of a check, and what the program answers.

use wheelrail::patch::Window;
use wheelrail::separation::{Evaluator, Normals};

/// What is checked of a placed pair.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Request {
    /// The rectangle of the ξ–η plane over which points are spread \[mm\].
    pub window: Window,
    /// δ \[mm\]: tips, boundary and deepest points of the patch s < δ are among them.
    pub approach: f64,
}

/// What the program says of one (ξ, η).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Answer {
    /// s \[mm\], NaN where a body has no surface.
    pub separation: f64,
    /// Both outward unit normals.
    pub normals: Normals,
}

impl Answer {
    /// The answer of the point-wise evaluator.
    pub fn of(evaluator: &mut Evaluator<'_>, xi: f64, eta: f64) -> Self {
        Self { separation: evaluator.separation(xi, eta), normals: evaluator.normals(xi, eta) }
    }
}

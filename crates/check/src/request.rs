//! The question to a check, and the program's answers.

use wheelrail::patch::Window;
use wheelrail::separation::{Evaluator, Normals};

/// The part of a placed pair that is checked.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Request {
    /// The rectangle of the ξ–η plane over which points are spread \[mm\].
    pub window: Window,
    /// Approach δ \[mm\]. Tips, boundary and deepest points of the patch s < δ are among the checked points.
    pub approach: f64,
}

/// The program's answer at one (ξ, η).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Answer {
    /// s \[mm\]; NaN where a body has no surface.
    pub separation: f64,
    /// Both outward unit normals.
    pub normals: Normals,
}

impl Answer {
    /// Returns the answer of the point-wise evaluator.
    pub fn of(evaluator: &mut Evaluator<'_>, xi: f64, eta: f64) -> Self {
        Self { separation: evaluator.separation(xi, eta), normals: evaluator.normals(xi, eta) }
    }
}

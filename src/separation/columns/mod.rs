//! Columns s(ξ, ·) as polynomials: how they are fitted, and how many of them are evaluated at once.

pub(super) mod fit;
pub(crate) mod horner;
pub(super) mod neighbours;
pub(crate) mod skewed;
pub(super) mod strip;
pub(super) mod strips;
pub(super) mod truncation;

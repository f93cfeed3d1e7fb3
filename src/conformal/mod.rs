//! Conformal contact: the gap t(σ, η) along the rail's own turning normal, over the rail's surface unrolled by its arc length σ.
//!
//! The definition and the derivation are in [`crate::docs::conformal`].
//!
//! | What | File |
//! |---|---|
//! | the rail by its arc length σ | `arc_length`: [`RailArcLength`] |
//! | where a line meets a segment of the wheel's profile | `meeting` |
//! | the line along the normal, and several of one σ at once | `ray`, `rays` |
//! | the spans of a line's column over the wheel | `span` |
//! | the wheel's point on a line that enters it more than once | `sight` |
//! | t, α and both normals at single points | `gap`: [`NormalGap`] |
//! | t(σ, ·) as polynomials, grids | `columns`: [`fill_normal_gap`] |
//! | the patch t < δ cos α | [`crate::Patch::over_rail`] |
//! | the two surfaces over which gaps are given | `reference`: [`Reference`] |

mod arc_length;
mod columns;
mod gap;
mod meeting;
mod ray;
mod rays;
mod reference;
mod sight;
mod span;

pub use arc_length::{RailArcLength, RailPoint};
pub use columns::fill_normal_gap;
#[cfg(test)]
pub(crate) use gap::tests::corner_in_root;
pub use gap::{GapColumn, GapPoint, NormalGap};
pub use reference::Reference;

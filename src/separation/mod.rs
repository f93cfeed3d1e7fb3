//! INSEP (Report Sec. 6): the separation s(ξ, η) = ζ^W − ζ^R and the unit normals.
//!
//! | What | File |
//! |---|---|
//! | the wheel in sagitta form, u = e (2w + e) | `wheel_surface`, over one branch `span` |
//! | g(ξ), the midplane gap | `gap` |
//! | the height of a wheel over the profile below it | `relief` |
//! | s and the normals at one point | [`Evaluator`] |
//! | s over columns: the accuracy ladder | `kernel`, `methods` |
//! | where the bodies have a surface | `mask` |
//! | s(ξ, ·) as polynomials in η² or η, many columns at once | `columns` |
//! | s over a grid, and the cheapest method for it | `grid`: [`Method`], [`Choice`]; `plan`: [`Plan`] |
//! | heights and normals of the lower body under a grid | `lower`: [`LowerBody`] |
//! | the midplane table, MIDSEP (Sec. 5) | `midplane`: [`midplane_table`] |

mod axis;
mod columns;
mod crossings;
mod demand;
mod evaluator;
mod gap;
mod grid;
mod kernel;
mod lower;
mod mask;
pub(crate) mod methods;
mod midplane;
mod plan;
mod relief;
mod rounding;
mod samples;
pub(crate) mod span;
pub(crate) mod wheel_surface;

pub use axis::EtaAxis;
pub(crate) use axis::mirror;
pub(crate) use columns::horner::{ColumnPolynomial, MOST_COEFFICIENTS};
pub(crate) use columns::skewed::{AlongEta, chebyshev_points, inside_piece, interpolate};
pub(crate) use demand::ROUNDING_LEVEL;
pub use demand::{Demand, FULL_PRECISION};
pub(crate) use evaluator::GapSlopes;
pub use evaluator::{Evaluator, Normals};
pub(crate) use gap::{contact_gap, contact_gaps, midplane_gap};
pub(crate) use grid::{BLOCK, ReliefSum, fill_all};
pub use grid::{Choice, Method};
pub(crate) use kernel::Kernel;
pub use lower::{LowerBody, LowerSurface};
pub use midplane::{MidplaneRow, Transformed, midplane_rows, midplane_table, transformed_parameters};
pub use plan::{Plan, plan};
pub(crate) use relief::{Relief, ReliefPoint, Skew};
pub(crate) use wheel_surface::{WheelSurface, sagitta};

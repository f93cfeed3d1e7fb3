//! INSEP (Report Sec. 6): the separation s(ξ, η) = ζ^W − ζ^R and the unit normals.
//!
//! | Equation | File |
//! |---|---|
//! | the wheel in sagitta form, u = e (2w + e) | [`wheel_surface`] |
//! | g(ξ), the midplane gap | [`gap`] |
//! | s and the normals at one point | [`Evaluator`] |
//! | s over columns: the accuracy ladder | [`kernel`], [`methods`] |
//! | s(ξ, ·) as polynomials in η² or η, many columns at once | `columns` |
//! | s over a grid, and the cheapest method for it | [`grid`], [`plan`] |
//! | the midplane table, MIDSEP (Sec. 5) | [`midplane`] |

pub mod axis;
mod columns;
pub mod demand;
mod evaluator;
pub mod gap;
pub mod grid;
pub mod kernel;
pub mod methods;
pub mod midplane;
pub mod plan;
mod rounding;
mod samples;
pub mod values;
pub mod wheel_surface;

pub use evaluator::{Evaluator, Normals};

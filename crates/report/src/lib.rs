//! Measures speed against error: times every method of the ladder, compares it with 60-digit values, and runs the hard
//! cases.
//!
//! [`mod@reference`] reads the 60-digit files, which are part of the program; [`errors`] compares a method with them.
//! [`speed`] races methods against a plain store of the same array, [`spline_cost`] splines against arcs. [`hard_case`]
//! runs the cases of `hard_cases`; [`verification`] checks placed pairs by parry3d's meshes. [`measured`] compares
//! curves through points with the drawing from which the points come; [`specimen`] makes worn profiles as instruments
//! measure them. [`rates`] counts positions of a wheelset a second over them, [`loads`] compares approaches under load with
//! solved ones, [`whole_case`] times a case from first touch to its mesh, [`conformal`] measures the normal gap,
//! [`processes`] names the runs of the program that are timed as a whole.
//! [`practice`] compares whole cases of engineers with brute force. [`measurements`] does all of this with a given effort;
//! [`requirements`] judges the ratios; [`page`] and [`table`] turn the numbers into Markdown, CSV and charts. Nothing here
//! touches the disk.

#![cfg_attr(not(test), warn(unused_crate_dependencies))]

pub mod conformal;
pub mod errors;
pub mod hard_case;
mod hard_checks;
pub mod hard_run;
mod inclined;
pub mod loads;
pub mod measured;
pub mod measurements;
pub mod page;
pub mod practice;
pub mod processes;
pub mod rates;
pub mod reference;
pub mod requirements;
pub mod specimen;
pub mod speed;
pub mod spline_cost;
pub mod table;
pub mod verification;
pub mod whole_case;

pub use hard_checks::{BOUNDS, HardCheck};

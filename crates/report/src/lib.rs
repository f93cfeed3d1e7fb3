//! Speed against error: every method of the ladder timed and held to 60-digit values, and the hard cases.
//!
//! [`mod@reference`] reads the 60-digit files, which are part of the program; [`errors`] compares a method with them;
//! [`speed`] races methods against a plain store of the same array, [`spline_cost`] splines against arcs; [`hard_case`] runs the cases of
//! `tests/hard_cases`; [`verification`] has parry3d's meshes check them; [`measured`] compares curves through points
//! with the drawing that the points are from; [`specimen`] makes worn profiles as instruments measure them;
//! [`rates`] counts positions of a wheelset a second over them, [`whole_case`] times a case from first touch to its mesh;
//! [`measurements`] does all of it to a given effort; [`requirements`] judges the ratios;
//! [`practice`] runs whole cases as engineers have them against brute force;
//! [`page`] and [`table`] turn the numbers into Markdown and CSV, and into charts. Nothing here touches the disk.

pub mod errors;
pub mod hard_case;
mod hard_checks;
pub mod hard_run;
pub mod measured;
pub mod measurements;
pub mod page;
pub mod practice;
pub mod random;
pub mod rates;
pub mod reference;
pub mod requirements;
pub mod specimen;
pub mod speed;
pub mod spline_cost;
pub mod table;
pub mod verification;
pub mod whole_case;

pub use hard_checks::{BOUNDS, Check};

//! Wheel/rail contact-patch preprocessor.
//!
//! Rail = extruded profile, wheel = revolved profile. For a placed pair the crate gives the initial contact point
//! and its feasibility, the separation s(ξ, η) with unit normals, the interpenetration boundary s = δ, solver meshes
//! over it, and the files that contact solvers and people read. It is a preprocessor: no elasticity beyond the
//! estimate that turns a load into an approach.
//!
//! ```text
//! scene → profiles → placement → separation → patch → meshes → files
//!                         └─────────── check (parry3d) ── report
//! ```
//!
//! | Report FRA/ORD-78/41 | what it does | here |
//! |---|---|---|
//! | Sec. 3, App. A | segment equations, smooth chains from drawing data | [`profile`], [`profile::builder`] |
//! | Sec. 4 | contact frame, transformed parameters, feasibility | [`placement`], [`load::feasibility`] |
//! | MIDSEP, Sec. 5 | transformed parameters and Δζ on the midplane | [`separation::midplane`] |
//! | INSEP, Sec. 6 | s(ξ, η) and unit normals over the grid | [`separation`] |
//! | INTERPEN, Sec. 7 | η(ξ) with s = δ | [`patch`] |
//! | CONFORM, COUNTACT | the solvers that read all this | [`mod@export`] (decks), [`mesh`] |
//!
//! # In eight lines
//!
//! ```
//! use wheelrail::patch::{Patch, Window};
//! use wheelrail::placement::Pair;
//! use wheelrail::profile::{inclination, standards};
//! use wheelrail::search::{ONE_CONTACT, Pose, ProfilePair, Selection};
//! use wheelrail::separation::Evaluator;
//!
//! let rail = standards::rail("60E1")?.rotated(inclination(1.0, 40.0)?);
//! let pair = Pair::new(rail, standards::wheel("S1002")?, 460.0)?;
//! let profiles = ProfilePair::new(&pair)?;
//! let mut search = profiles.search();
//! let touch = search.touch(&Pose::new(0.0, 0.0, 0.0)?, &Selection { within: 0.0, apart: ONE_CONTACT });
//! let placement = touch.expect("a wheel over its rail").contacts[0].placed(&pair)?;
//! let s = Evaluator::new(&placement).separation(2.0, 5.0);
//! let patch = Patch::new(&placement, 0.05, &Window::UNBOUNDED);
//!
//! assert!((s - 0.040_428).abs() < 1e-6, "{s}");
//! assert!((patch.area() - 88.828).abs() < 1e-3, "{}", patch.area());
//! # Ok::<(), wheelrail::Error>(())
//! ```
//!
//! # What is guaranteed, and what is not
//!
//! Relative error of s below 1e-13 where a point lies over both bodies' contact segments (relative to what s is the sum of:
//! gap, rise across, and under yaw climb along; of s itself where bodies do not overlap), absolute error below
//! 2e-12 mm (× R_max/300 mm for radii beyond 300 mm) elsewhere, |Δη| ≤ (R/η) × that on the boundary: checked against
//! 60-digit values on every test run, and against triangle meshes of another library by `wheelrail check`. Not
//! guaranteed: anything elastic. See [`docs::numerics`] for the formulas and [`docs::errata`] for what differs from
//! the Report.

#![cfg_attr(not(test), warn(unused_crate_dependencies))]

pub mod case;
pub mod docs;
pub mod error;
pub mod export;
pub mod files;
pub mod load;
pub mod measured;
pub mod mesh;
pub mod numerics;
pub mod patch;
pub mod placement;
pub mod profile;
pub mod scene;
pub mod search;
pub mod separation;

pub use error::{Error, Kind as ErrorKind, Result};
/// Points, normals, rotations and frames of the public API are of this version of nalgebra.
pub use nalgebra;

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
//! | Report FRA/ORD-78/41 | what it is | here |
//! |---|---|---|
//! | (3.2) | lines and arcs | [`Arc`]; polynomials [`Polynomial`], chains [`Profile`] |
//! | App. A | smooth chains from drawing data | [`profile::ChainBuilder`] |
//! | (4.1) | feasibility of a contact point | [`load::feasibility`](fn@load::feasibility) |
//! | (4.2), (4.3) | a point seen from a frame | [`Station`] |
//! | (4.4)–(4.8) | the transformed profile ζ(ξ) | [`profile::Section`] |
//! | (4.9)–(4.12) | the contact frame of two points | [`placement`] |
//! | MIDSEP, Sec. 5 | transformed parameters and Δζ on the midplane | [`separation::midplane_table`], [`separation::transformed_parameters`] |
//! | INSEP, (6.1)–(6.12) | s(ξ, η) and unit normals | [`Evaluator`]; over grids [`separation::plan`](fn@separation::plan), [`separation::Plan`] |
//! | (6.13)–(6.16) | the Report's own iteration | [`separation::Method::ReportNewton`] |
//! | INTERPEN, (7.1)–(7.3) | the boundary s = δ | [`patch::Slicer`], [`Patch`] |
//! | CONFORM | the gap along the turning normal | [`conformal`] |
//! | CONFORM, COUNTACT | the solvers that read all this | [`export::Deck`], [`mesh`] |
//!
//! The Report chooses contact points; [`search`] finds them. [`measured`] reads profiles from instruments' files.
//!
//! # In eight lines
//!
//! ```
//! use wheelrail::{Evaluator, ONE_CONTACT, Pair, Patch, Pose, ProfilePair, Selection, Window, inclination, standards};
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
//! guaranteed: anything elastic. The same bounds hold for the normal gap t of
//! [`conformal`]. See [`docs::numerics`] and [`docs::conformal`] for the formulas and [`docs::errata`] for what differs from
//! the Report.

#![deny(missing_docs, rustdoc::broken_intra_doc_links)]
#![cfg_attr(not(test), warn(unused_crate_dependencies))]

#[cfg(feature = "files")]
pub mod case;
pub mod conformal;
pub mod docs;
pub mod error;
pub mod export;
#[cfg(feature = "files")]
pub mod files;
#[cfg(feature = "files")]
pub mod fleet;
pub mod load;
pub mod lofted;
pub mod measure;
pub mod measured;
pub mod mesh;
mod numerics;
pub mod patch;
pub mod placement;
pub mod profile;
#[cfg(feature = "files")]
pub mod scene;
pub mod search;
pub mod separation;
pub mod table;

#[cfg(feature = "files")]
pub use case::{Case, Run};
pub use error::{Error, ErrorKind, Result};
pub use load::{Feasibility, feasibility};
pub use mesh::{Axes, StripCounts, StripMesh};
/// Points, normals, rotations and frames of the public API are of this version of nalgebra.
pub use nalgebra;
pub use numerics::bodies::Bodies;
pub use numerics::interval::Interval;
pub use patch::{Component, Patch, Window};
pub use placement::{Body, Pair, Placement, RailDistance, WheelDistance};
pub use profile::{Arc, Half, Polynomial, Profile, Segment, Shape, Side, Station, inclination, standards};
#[cfg(feature = "files")]
pub use scene::Scene;
pub use search::{
    Conicity, ContactSearch, ONE_CONTACT, Pose, Position, ProfilePair, Roll, Selection, Sweep, Touch,
    WheelsetOnTrack,
};
pub use separation::{Evaluator, Normals};

/// What the crates of this workspace and the tests need besides the public API. Nothing here is promised: any release may
/// change or remove it.
#[doc(hidden)]
pub mod internal {
    pub use crate::numerics::lanes::MANY;
    pub use crate::numerics::polynomial::recentred;
    pub use crate::numerics::roots::bracketed;
    pub use crate::numerics::twice::Twice;
    pub use crate::numerics::{largest, nan_max};
    pub use crate::patch::turning_points::turning_points;
    pub use crate::separation::methods::report_newton::missing as missing_for_report_newton;
}

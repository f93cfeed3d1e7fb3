//! Wheel/rail contact-patch preprocessor.
//!
//! Rail = extruded profile, wheel = revolved profile. For a placed pair the crate gives the initial contact point
//! and its feasibility, the separation s(ξ, η) with unit normals, the interpenetration boundary s = δ, solver meshes
//! over it, and the files that contact solvers and people read. It is a preprocessor: only Hertz's theory and
//! half-spaces are elastic, to turn a load into an approach and pressures.
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
//! | MIDSEP, Sec. 5 | transformed parameters, midplane Δζ | [`separation::midplane_table`], [`separation::transformed_parameters`] |
//! | INSEP, (6.1)–(6.12) | s(ξ, η), unit normals | [`Evaluator`]; grids [`separation::plan`](fn@separation::plan), [`separation::Plan`] |
//! | (6.13)–(6.16) | the Report's own iteration | [`separation::Method::ReportNewton`] |
//! | INTERPEN, (7.1)–(7.3) | the boundary s = δ | [`patch::Slicer`], [`Patch`] |
//! | CONFORM | the gap along the turning normal | [`conformal`] |
//! | CONFORM, COUNTACT | the solvers that read all this | [`export::Deck`], [`mesh`] |
//!
//! The Report chooses contact points; [`search`] finds them. [`measured`] reads profiles from instruments' files.
//!
//! # Five programs
//!
//! The separation around a contact, over a grid, and the patch there:
//!
//! ```
//! use wheelrail::separation::{EtaAxis, FULL_PRECISION, plan};
//! use wheelrail::{Pair, Patch, Pose, Window, first_touch, inclination, mesh::equal_steps, standards};
//!
//! let rail = standards::rail("60E1")?.rotated(inclination(1.0, 40.0)?);
//! let pair = Pair::new(rail, standards::wheel("S1002")?, 460.0)?;
//! let placement = first_touch(&pair, &Pose::new(0.0, 0.0, 0.0)?)?;
//! let (xi, eta) = (equal_steps(-8.0, 8.0, 81), EtaAxis::new(&equal_steps(-10.0, 10.0, 101)));
//! let mut s = vec![0.0; 81 * 101]; // at i_xi * 101 + i_eta
//! plan(&placement, &xi, &eta, FULL_PRECISION, None).fill(&placement, &xi, &eta, &mut s);
//! let patch = Patch::new(&placement, 0.05, &Window::UNBOUNDED);
//!
//! assert!((s[50 * 101 + 75] - 0.040_428).abs() < 1e-6, "{}", s[50 * 101 + 75]); // ξ = 2 mm, η = 5 mm
//! assert!((patch.area() - 88.828).abs() < 1e-3, "{}", patch.area());
//! # Ok::<(), wheelrail::Error>(())
//! ```
//!
//! The difference of the rolling radii over the lateral displacement of a wheelset:
//!
//! ```
//! # use wheelrail::{inclination, standards};
//! use wheelrail::{ONE_CONTACT, Pair, Position, RailDistance, Roll, Selection, Sweep, WheelDistance, WheelsetOnTrack};
//!
//! # let rail = standards::rail("60E1")?.rotated(inclination(1.0, 40.0)?);
//! let pair = Pair::new(rail, standards::wheel("S1002")?, 460.0)?;
//! let system = WheelsetOnTrack::new(&pair, RailDistance::Spacing(1506.0), WheelDistance::Spacing(1500.0))?;
//! let mut sweep = Sweep::new(&system, Selection { within: 0.0, apart: ONE_CONTACT }, None);
//! let mut rows = Vec::new();
//! for lateral in [-3.0, 0.0, 3.0] {
//!     sweep.position(&Position { lateral, yaw: 0.0, roll: Roll::Solve }, &mut rows)?;
//! }
//! let delta_r: Vec<f64> = rows.iter().step_by(2).map(|left| left.delta_r).collect();
//!
//! assert!(delta_r[1].abs() < 1e-9 && (delta_r[0] + delta_r[2]).abs() < 1e-9 && delta_r[2] > 0.5, "{delta_r:?}");
//! # Ok::<(), wheelrail::Error>(())
//! ```
//!
//! A load, and the patch that carries it, of a half-space of steel:
//!
//! ```
//! use wheelrail::load::{Elastic, HalfSpace, effective_modulus, press_alone, under_total};
//! use wheelrail::{Pair, Patch, Pose, Window, first_touch, standards};
//!
//! # let rail = standards::rail("60E1")?.rotated(wheelrail::inclination(1.0, 40.0)?);
//! let pair = Pair::new(rail, standards::wheel("S1002")?, 460.0)?;
//! let placement = first_touch(&pair, &Pose::new(0.0, 0.0, 0.0)?)?;
//! let modulus = effective_modulus(&Elastic::STEEL, &Elastic::STEEL);
//! let patch = |approach: f64| Patch::new(&placement, approach, &Window::UNBOUNDED);
//! let carried = |approach: f64| {
//!     let region = HalfSpace::over(&placement, &patch(approach).extent()?, approach);
//!     Some(press_alone(region, 1e-4, modulus).ok()?[0].load())
//! };
//! let approach = under_total(|approach| carried(approach).unwrap_or(0.0), 80_000.0, 0.05, 1.0, 1e-4);
//!
//! let approach = approach.expect("80 kN below an approach of 1 mm");
//! assert!((0.05..0.15).contains(&approach) && patch(approach).area() > 100.0, "{approach}");
//! # Ok::<(), wheelrail::Error>(())
//! ```
//!
//! A measured file, and its smoothed profile:
//!
//! ```
//! use wheelrail::measured::{Options, profile};
//! use wheelrail::Side;
//!
//! # let point = |x: f64| format!("{x},{}\n", -x * x / 600.0 + 0.002 * (37.0 * x).sin());
//! # let file = (-300..=300).map(|k| point(f64::from(k) / 10.0)).collect::<String>();
//! let axes = Options { mirror: Some(false), flip_z: Some(false), ..Options::default() };
//! let measured = profile("crown.csv", file.as_bytes(), Side::Rail, &axes)?; // file: a crown of 300 mm with 2 µm of noise
//! let largest = measured.record.curve.residual.map_or(f64::NAN, |residual| residual.largest); // mm
//!
//! assert!(measured.profile.segments().len() < 600 && largest < 0.005, "{largest}");
//! # Ok::<(), wheelrail::Error>(())
//! ```
//!
//! A deck for CONTACT:
//!
//! ```
//! use wheelrail::export::{ContactSettings, Deck, Frame, GridFields, Header, Prescribed, contact_inp};
//! use wheelrail::separation::{EtaAxis, FULL_PRECISION, LowerBody, plan};
//! use wheelrail::{Pair, Patch, Pose, Window, first_touch, mesh::groups, standards};
//!
//! # let rail = standards::rail("60E1")?.rotated(wheelrail::inclination(1.0, 40.0)?);
//! let pair = Pair::new(rail, standards::wheel("S1002")?, 460.0)?;
//! let placement = first_touch(&pair, &Pose::new(0.0, 0.0, 0.0)?)?;
//! let grid = groups(&Patch::new(&placement, 0.05, &Window::UNBOUNDED), 0.0, None)[0].axes(Some([0.5; 2]))?;
//! let (eta, mut s) = (EtaAxis::new(&grid.eta), vec![0.0; grid.xi.len() * grid.eta.len()]);
//! plan(&placement, &grid.xi, &eta, FULL_PRECISION, None).fill(&placement, &grid.xi, &eta, &mut s);
//! let lower = LowerBody::under(&placement, &grid.xi, &grid.eta);
//! let fields = GridFields::over(&grid.xi, &grid.eta, &s, &lower)?;
//! let header = Header::new("60E1 under S1002".into(), Frame::of(&placement), 0.05);
//! let (steel, mut deck) = (ContactSettings::steel(Prescribed::Approach(0.05)), Vec::new());
//! contact_inp(&Deck::new(&header, &fields)?, &steel, &mut deck).expect("room in memory"); // or a file
//!
//! assert!(deck.starts_with(b"% title: 60E1 under S1002"));
//! # Ok::<(), wheelrail::Error>(())
//! ```
//!
//! # What is guaranteed, and what is not
//!
//! Where a point lies over both bodies' contact segments, the relative error of s is below 1e-13: relative to s itself, or, where
//! the bodies overlap before any approach, to the terms of s (midplane gap, rise across, under yaw climb along). Elsewhere the
//! absolute error is below 2e-12 mm (× R_max/300 mm for radii beyond 300 mm). On the boundary |Δη| ≤ (R/η) × the error of s.
//! The same bounds hold for the normal gap t of [`conformal`]. Every test run checks them against 60-digit values, and
//! `wheelrail check` compares with triangle meshes of another library. Not guaranteed: anything elastic. See
//! [`docs::numerics`] and [`docs::conformal`] for the formulas and [`docs::errata`] for what differs from the Report.

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
    WheelsetOnTrack, first_touch,
};
pub use separation::{Evaluator, Normals};

/// What the crates of this workspace and the tests need besides the public API. Nothing here is promised: any release may
/// change or remove it.
#[doc(hidden)]
pub mod internal {
    pub use crate::numerics::lanes::MANY;
    pub use crate::numerics::polynomial::recentred;
    pub use crate::numerics::random::Random;
    pub use crate::numerics::roots::bracketed;
    pub use crate::numerics::twice::Twice;
    pub use crate::numerics::{largest, nan_max};
    pub use crate::patch::turning_points::turning_points;
    pub use crate::separation::methods::report_newton::missing as missing_for_report_newton;
    pub use crate::separation::methods::spectral::columns_by;
}

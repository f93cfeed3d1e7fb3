//! Surfaces that vary along the track: switches, crossings, check rails; and around an axle: wheels with flats, out of round. A list of
//! slices gives them, each a section at its own place.
//!
//! # The surface between slices
//!
//! Features divide every slice into parts. Points at equal shares of a part's arc length belong together on all slices, at most
//! [`SPACING`] apart. Along the track a cubic goes through the points of equal share, by default the monotone one (pchip): it does not
//! overshoot where slices do not correspond. Across, a cubic spline goes through all points of a part. So the surface is a bicubic
//! over each cell, continuous with its slopes along the track and with its curvature across, and bounded by its control points.
//!
//! A part that a slice does not have begins or ends at its neighbour. Without features a slice is one part, beside what an instrument
//! has seen of a flank deeper down than on the slice's neighbour; where its length or its ends jump otherwise, the list defines no
//! surface between the two ([`Loft::holes`]).
//!
//! # A profile that keeps its shape
//!
//! A wheel with a flat or a radius that varies has a closed form: its points are those of the profile's own segments, their heights those
//! of a chord, a circle or a periodic spline. Bicubics that approximate it, with a bound of their error, bound it.

use std::sync::Arc;

use crate::profile::Side;

mod around;
mod bicubic;
mod build;
mod framed;
mod joining;
mod kept;
mod parts;
mod runs;
mod section;
mod slice;
mod space;
mod strip;
mod tree;

pub(crate) use around::turned;
pub use around::{Flat, LoftedWheel};
pub use bicubic::{Bicubic, SurfacePoint};
pub use build::Loft;
pub use framed::{Feet, FramedLoft, LoftFoot};
pub use joining::Joining;
pub(crate) use section::section_through;
pub use section::{ends, joined, section};
pub use slice::{LoftSlice, SPACING};
pub use space::{Laid, SpacePoint};
pub(crate) use space::{directions, on_wheel};
pub use strip::{Bay, LoftStrip};

/// The body of a pair that varies.
#[derive(Debug, Clone)]
pub enum LoftedBody {
    /// A rail, along the track.
    Rail(Arc<Loft>),
    /// A wheel, around its axle.
    Wheel(Arc<LoftedWheel>),
}

impl LoftedBody {
    /// Tells which body it is.
    pub fn side(&self) -> Side {
        match self {
            Self::Rail(_) => Side::Rail,
            Self::Wheel(_) => Side::Wheel,
        }
    }

    /// Names the body of a side that varies, for messages.
    pub fn name(side: Side) -> &'static str {
        match side {
            Side::Rail => "a rail that varies along the track",
            Side::Wheel => "a wheel that varies around its axle",
        }
    }

    /// Gives the warnings about its slices: where they leave the surface undefined, and why.
    pub fn warnings(&self) -> &[String] {
        match self {
            Self::Rail(loft) => &loft.warnings,
            Self::Wheel(wheel) => wheel.warnings(),
        }
    }
}

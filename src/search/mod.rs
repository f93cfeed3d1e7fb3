//! The contact search: finds how far a placed wheel can be lowered onto its rail, and where the two then
//! touch.
//!
//! # Axes, signs and order of rotation
//!
//! All quantities of one side are in the rail's profile axes: x towards the field side, y forward along the
//! rail, z up. For the right-hand wheel they are the track's directions. The left-hand side is solved as its
//! mirror image (x → −x), with lateral displacement, yaw and roll reversed; its axes are then left-handed.
//!
//! The wheel is turned by A = R_y(roll) · R_z(yaw) ([`wheel_rotation`]): first the yaw about z, then the roll about the *unyawed* y axis
//! of the track, both by the right-hand rule. So with the yaw ψ and the roll φ the axle, from flange to field side, points along
//! (cosψ cosφ, sinψ, −cosψ sinφ).
//! A single wheel ([`Pose`]) is turned about its **profile origin**, the lowest point of the nominal running circle:
//! `offset` is where that origin lies, whatever the angles. A wheelset ([`WheelsetOnTrack`]) is turned about the middle of
//! its axle.
//!
//! # Method
//!
//! `locus`: the outline of the yawed wheel along the rail reduces the search to two plane curves. A local
//! minimum of the vertical gap has a common tangent (at kinks and ends: a common normal within the fan). A
//! tree over the elements of each profile (`body`) bounds the gap of whole stretches at once (`placed`), so
//! that only pairs of elements that may be lowest are solved (`walk`). Arcs and lines have closed forms
//! (`arcs`); polynomials and yawed arcs are solved by bounds of their curvatures and Newton's method
//! (`stretches`). So the lowest contact cannot be missed. Over a roller a search in one of its meridian planes bounds all gaps,
//! and each place of contact is followed to a plane of its own (`roller`). Where a body varies, parts of its surface are bounded
//! instead (`lofted`).
//!
//! Only the part of each profile that faces the other body in its own axes counts
//! ([`Section`](crate::profile::Section)): a part of a wheel that faces down only because of the roll (a
//! flange back beyond the vertical) does not take part.

mod arcs;
mod body;
mod bounds;
mod candidates;
mod element;
mod far;
mod geometry;
mod locus;
mod lofted;
mod march;
mod over_rail;
mod parallel;
mod placed;
mod position;
mod roller;
mod side;
mod stretches;
mod sweep;
mod touch;
mod walk;
mod wheelset;
mod wheelset_touch;

pub use geometry::{
    AMPLITUDE, ContactBand, GeometryAt, KeyFigures, NONLINEARITY, active_faces, gauge, geometry_over,
    key_figures, nonlinearity,
};
pub use lofted::{Cut, LoftedPair};
pub use march::{Event, EventKind, March, Stop};
pub use over_rail::Work;
pub use parallel::{ParallelSweep, conicity_over, free};
pub use position::{Position, Roll};
pub use side::SideOnTrack;
pub use sweep::{ACCURACY, Conicity, Equivalent, NoConicity, Sweep, SweepRow, TrackSide, TwoStep};
#[cfg(feature = "files")]
pub(crate) use touch::small_angle;
pub use touch::{
    Contact, ContactSearch, ONE_CONTACT, Pose, ProfilePair, Selection, Touch, first_touch, wheel_rotation,
};
pub use wheelset::{WheelsetOnTrack, WheelsetSearch};
pub(crate) use wheelset_touch::LowestPlaces;
pub use wheelset_touch::{SideTouch, WheelsetTouch};

#[cfg(test)]
mod tests;

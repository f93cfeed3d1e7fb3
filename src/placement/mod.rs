//! Puts rail and wheel in contact: the contact frame ξηζ and both profiles in it (Report Sec. 4); where rails and wheels are on a
//! track, and how fast they move.

mod along;
mod motion;
mod placed;
mod swept;
mod track;

#[cfg(feature = "files")]
pub(crate) use motion::on_roller;
pub use motion::{Creepages, Motion, Pitch, Rates};
pub use placed::{Body, Pair, Placement};
pub use swept::Generator;
pub use track::{RailDistance, Track, WheelDistance, Wheelset};

//! The patch found from samples along lines of constant ξ: where a body varies, a rail along the track or a wheel around its axle; and
//! where a hollow kink of a skewed wheel on a roller divides these lines.

mod bands;
mod lines;

pub(super) use bands::bands;
pub(crate) use lines::BySamples;
pub(super) use lines::SMOOTH;

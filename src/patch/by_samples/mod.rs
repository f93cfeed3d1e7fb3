//! The patch found from samples along lines of constant ξ: where a body varies, a rail along the track or a wheel around its axle; and
//! on a roller where a hollow kink of a skewed wheel, or the end of a tilted body, divides these lines.

mod bands;
mod lines;

pub(super) use bands::bands;
pub(crate) use lines::BySamples;
pub(super) use lines::SMOOTH;

//! Draws the curve through measured points: a smoothing or interpolating spline, arcs, or the file's own
//! elements.

mod biarc;
pub mod curve;
pub mod elements;
mod kinks;
mod parabola;
mod smoothing;
mod spline;

//! Draws the curve through measured points: a smoothing spline, an interpolating spline, arcs, or the file's own design
//! elements.

mod biarc;
pub mod curve;
pub mod elements;
mod kinks;
mod parabola;
mod scatter;
mod smoothing;
mod spline;

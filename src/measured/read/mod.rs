//! Bytes of an instrument's file → points, design elements, and what is odd about the file; one reader a format.

mod columns;
pub mod format;
mod miniprof;
pub mod points;
pub mod scan;
mod simpack;

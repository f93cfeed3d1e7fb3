//! Reads an instrument's file: bytes become points, design elements and notes on oddities. Each format has a reader of its
//! own.

mod columns;
mod dialect;
pub mod format;
mod head;
mod miniprof;
pub mod points;
pub mod reader;
pub mod scan;
mod simpack;
pub mod slices;
mod table;
mod vampire;

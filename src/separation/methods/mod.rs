//! The methods of the accuracy ladder, one file for each.

pub mod parabolic;
pub mod pointwise;
pub mod quadratic;
pub mod report_newton;
pub mod spectral;

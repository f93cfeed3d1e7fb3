//! Numerical methods without railway words, for one value or for values in lanes.

pub mod chebyshev;
pub mod elliptic;
pub mod lanes;
pub mod polynomial;
pub mod quadrature;
pub mod roots;
pub mod twice;

/// Gives the larger of two numbers, and NaN if either is NaN.
#[inline(always)]
pub fn nan_max(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }
}

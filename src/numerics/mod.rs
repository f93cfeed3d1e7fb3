//! Roots, polynomials, Chebyshev series, quadrature and elliptic integrals: no railway words here.

pub mod chebyshev;
pub mod elliptic;
pub mod polynomial;
pub mod polynomials;
pub mod quadrature;
pub mod roots;
pub mod twice;

/// The larger of two, NaN if either is.
#[inline(always)]
pub fn nan_max(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }
}

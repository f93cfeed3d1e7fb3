//! Roots, polynomials, Chebyshev series, quadrature and elliptic integrals: no railway words here.

pub mod chebyshev;
pub mod elliptic;
pub mod polynomial;
pub mod polynomials;
pub mod quadrature;
pub mod roots;
pub mod twice;

//! Roots, polynomials, quadrature and elliptic integrals: no railway words here.

pub mod elliptic;
pub mod polynomial;
pub mod quadrature;
pub mod roots;

//! Numerical methods without railway words, for one value or for values in lanes.

pub mod bodies;
pub mod chebyshev;
pub mod elliptic;
pub mod interval;
pub mod lanes;
pub mod noise;
pub mod polynomial;
pub mod quadrature;
pub mod random;
pub mod roots;
pub mod sign_changes;
pub mod slopes;
pub mod twice;

/// Gives the larger of two numbers, and NaN if either is NaN.
#[inline(always)]
pub fn nan_max(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }
}

/// Gives √(1 − sin²) without cancellation, and 0 where rounding has carried |sin| past 1.
#[inline(always)]
pub fn cosine(sin: f64) -> f64 {
    ((1.0 - sin) * (1.0 + sin)).max(0.0).sqrt()
}

/// Gives the cosine and the sine of the angle of a slope, which may be infinite.
pub fn direction(slope: f64) -> [f64; 2] {
    let cos = 1f64.hypot(slope).recip();
    [cos, if cos == 0.0 { slope.signum() } else { slope * cos }]
}

/// Gives the largest of numbers ≥ 0: 0 of none, and NaN if one is NaN.
pub fn largest(all: impl IntoIterator<Item = f64>) -> f64 {
    all.into_iter().fold(0.0, nan_max)
}

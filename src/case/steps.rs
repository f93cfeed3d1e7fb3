//! Equal steps along an axis.

/// Gives n ≥ 2 values from a to b in equal steps, both ends included, symmetric to the last bit where a = −b.
pub fn equal_steps(a: f64, b: f64, n: usize) -> Vec<f64> {
    let last = n as f64 - 1.0;
    (0..n).map(|k| (a * (last - k as f64) + b * k as f64) / last).collect()
}

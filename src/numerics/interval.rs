//! Arithmetic of intervals \[low, high\].

/// Returns the interval between two numbers.
pub fn ordered(a: f64, b: f64) -> [f64; 2] {
    if a <= b { [a, b] } else { [b, a] }
}

/// Multiplies two intervals.
pub fn product(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    let all = [a[0] * b[0], a[0] * b[1], a[1] * b[0], a[1] * b[1]];
    [all.into_iter().fold(f64::INFINITY, f64::min), all.into_iter().fold(f64::NEG_INFINITY, f64::max)]
}

/// Divides an interval by a positive one.
pub fn quotient(a: [f64; 2], positive: [f64; 2]) -> [f64; 2] {
    product(a, [positive[1].recip(), positive[0].recip()])
}

/// Adds two intervals. The ends of b may be swapped, as a change of sign swaps them.
pub fn add(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    let b = ordered(b[0], b[1]);
    [a[0] + b[0], a[1] + b[1]]
}

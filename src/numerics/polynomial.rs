//! Power-form polynomials: evaluation, recentring in twice the working precision, bounds.

use twofloat::TwoFloat;

/// p(t) = Σ c_k t^k by Horner's rule.
pub fn value(c: &[f64], t: f64) -> f64 {
    c.iter().rev().fold(0.0, |sum, &c| sum * t + c)
}

/// The value and the first derivative at t.
#[inline]
pub fn value_and_slope(c: &[f64], t: f64) -> [f64; 2] {
    c.iter().rev().fold([0.0; 2], |[p, d], &c| [p * t + c, d * t + p])
}

/// The value and the first two derivatives at t.
pub fn derivatives(c: &[f64], t: f64) -> [f64; 3] {
    c.iter().rev().fold([0.0; 3], |[p, d, h], &c| [p * t + c, d * t + p, h * t + 2.0 * d])
}

/// The divided difference p\[a, b\] = (p(b) − p(a))/(b − a), which is p′(a) for a = b; nothing cancels.
pub fn divided_difference(c: &[f64], a: f64, b: f64) -> f64 {
    // Synthetic division by (t − a), evaluated at b on the way.
    let (mut quotient, mut sum) = (0.0, 0.0);
    for &c in c.iter().skip(1).rev() {
        quotient = quotient * a + c;
        sum = sum * b + quotient;
    }
    sum
}

/// p(t) in twice the working precision.
pub fn value_twofloat(c: &[TwoFloat], t: TwoFloat) -> TwoFloat {
    c.iter().rev().fold(TwoFloat::from(0.0), |sum, &c| sum * t + c)
}

/// p′(t) in twice the working precision.
pub fn slope_twofloat(c: &[TwoFloat], t: TwoFloat) -> TwoFloat {
    let mut sum = TwoFloat::from(0.0);
    for (k, &c) in c.iter().enumerate().skip(1).rev() {
        sum = sum * t + c * k as f64;
    }
    sum
}

/// The coefficients about t = `centre`: p(centre + u) = Σ c′_k u^k, in twice the working precision.
///
/// A standard's power form about a far origin loses digits at every evaluation; moved once with 32 digits, it does not.
pub fn recentred(c: &[TwoFloat], centre: TwoFloat) -> Vec<TwoFloat> {
    let mut out = c.to_vec();
    for start in 0..out.len() {
        for k in (start..out.len().saturating_sub(1)).rev() {
            out[k] = out[k] + centre * out[k + 1];
        }
    }
    out
}

/// Bounds of p over \[t0, t1\], from its Bernstein coefficients: never too narrow by more than rounding, exact
/// at the ends, and converging with the square of the width.
pub fn range(c: &[f64], t0: f64, t1: f64) -> [f64; 2] {
    let around = |[low, high]: [f64; 2], v: f64| [low.min(v), high.max(v)];
    bernstein(c, t0, t1).into_iter().fold([f64::INFINITY, f64::NEG_INFINITY], around)
}

/// Bernstein coefficients of p over \[t0, t1\]: p lies in their hull, and p of a curve in the plane in that of its control points.
pub fn bernstein(c: &[f64], t0: f64, t1: f64) -> Vec<f64> {
    let shifted = shifted_scaled(c, t0, t1 - t0);
    let n = shifted.len().saturating_sub(1);
    let coefficient = |i: usize| {
        let (mut sum, mut weight) = (0.0, 1.0);
        for (k, &c) in shifted.iter().enumerate().take(i + 1) {
            sum += weight * c;
            weight *= (i as f64 - k as f64) / (n as f64 - k as f64).max(1.0);
        }
        sum
    };
    (0..shifted.len()).map(coefficient).collect()
}

/// The coefficients of the product of two polynomials; none where one has none.
pub fn convolution(a: &[f64], b: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; (a.len() + b.len()).saturating_sub(1)];
    for (i, a) in a.iter().enumerate() {
        for (k, b) in b.iter().enumerate() {
            out[i + k] += a * b;
        }
    }
    out
}

/// Coefficients of p(t0 + w u) in u.
fn shifted_scaled(c: &[f64], t0: f64, w: f64) -> Vec<f64> {
    let mut out = c.to_vec();
    for start in 0..out.len() {
        for k in (start..out.len().saturating_sub(1)).rev() {
            out[k] += t0 * out[k + 1];
        }
    }
    let mut power = 1.0;
    for c in &mut out {
        *c *= power;
        power *= w;
    }
    out
}

/// The coefficients of p′.
pub fn derivative(c: &[f64]) -> Vec<f64> {
    c.iter().enumerate().skip(1).map(|(k, &c)| c * k as f64).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const C: [f64; 5] = [1.0, -2.0, 0.5, 3.0, -0.25];

    #[test]
    fn divided_difference_agrees_with_the_quotient_and_with_the_slope() {
        let quotient = (value(&C, 1.5) - value(&C, -0.5)) / 2.0;
        assert!((divided_difference(&C, -0.5, 1.5) - quotient).abs() < 1e-14);
        assert_eq!(divided_difference(&C, 0.7, 0.7), derivatives(&C, 0.7)[1]);
    }

    #[test]
    fn recentring_keeps_values() {
        let exact: Vec<TwoFloat> = C.iter().map(|&c| c.into()).collect();
        let moved = recentred(&exact, TwoFloat::from(3.0));
        let there = value_twofloat(&moved, TwoFloat::from(-2.25));
        assert!((f64::from(there) - value(&C, 0.75)).abs() < 1e-15);
    }

    #[test]
    fn range_holds_every_value_and_touches_the_ends() {
        let [low, high] = range(&C, -1.0, 2.0);
        for k in 0..=100 {
            let p = value(&C, -1.0 + 0.03 * f64::from(k));
            assert!(low - 1e-13 <= p && p <= high + 1e-13);
        }
        assert_eq!(range(&[2.0, 1.0], 0.0, 4.0), [2.0, 6.0]);
    }
}

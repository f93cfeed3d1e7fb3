//! All roots of a function whose slope can be bounded.

use crate::numerics::roots::bracketed;

/// A stretch this many times halved is a root's place if nothing has excluded it: on stretches of a millimetre
/// 1e-6 mm. A gap is stationary there, so its error is the square of that times a curvature: below rounding.
/// Deeper costs time where two bodies conform, shallower shows in the gap.
const DEEPEST: u32 = 20;

/// A function to be searched for roots, with what is known about it.
pub(super) trait Bounded {
    /// The function.
    fn value(&self, x: f64) -> f64;
    /// Bounds of its slope over \[a, b\]; infinite where none are known.
    fn slope(&self, a: f64, b: f64) -> [f64; 2];
}

/// Calls `found` with every root of `f` over \[a, b\].
///
/// Method: a stretch is dropped when the mean value theorem keeps f away from zero there, solved when the slope
/// has one sign, halved otherwise; so no root is missed as long as the slope's bounds hold.
/// `rounding`: |f| that counts as zero at the ends of a stretch, since a root on a joint may fall just outside
/// of both neighbours.
/// Degenerate: a stretch where f vanishes all along comes out as its middle; a double root comes out several times or as the middle of a stretch of 2⁻²⁰ of the whole;
/// stretches with NaN at their middle and no bounds are dropped at that width.
pub(super) fn isolate(
    f: &impl Bounded,
    [a, b]: [f64; 2],
    slope: [f64; 2],
    rounding: f64,
    found: &mut impl FnMut(f64),
) {
    refine(f, [a, b], slope, rounding, DEEPEST, found);
}

fn refine(
    f: &impl Bounded,
    [a, b]: [f64; 2],
    slope: [f64; 2],
    rounding: f64,
    depth: u32,
    found: &mut impl FnMut(f64),
) {
    let half = (b - a) / 2.0;
    let middle = a + half;
    let value = f.value(middle);
    if value.abs() - rounding > half * slope[0].abs().max(slope[1].abs()) {
        return;
    }
    if value.abs() + half * slope[0].abs().max(slope[1].abs()) <= rounding {
        return found(middle);
    }
    if slope[0] > 0.0 || slope[1] < 0.0 {
        let root = monotone(&mut |x| f.value(x), [a, b], [f.value(a), f.value(b)], rounding);
        root.into_iter().for_each(found);
        return;
    }
    if depth == 0 || middle <= a || middle >= b {
        if value.is_finite() {
            found(middle);
        }
        return;
    }
    refine(f, [a, middle], f.slope(a, middle), rounding, depth - 1, found);
    refine(f, [middle, b], f.slope(middle, b), rounding, depth - 1, found);
}

/// The root of a monotone function with known values at the ends; an end whose value is within `rounding` counts.
///
/// Method: false position with Anderson and Björck's factors, three to five steps on nearly straight functions; ends
/// when the value is a sixteenth of `rounding` or the bracket is; bisection where that fails.
pub(super) fn monotone(
    f: &mut impl FnMut(f64) -> f64,
    [mut a, mut b]: [f64; 2],
    [mut at_a, mut at_b]: [f64; 2],
    rounding: f64,
) -> Option<f64> {
    if at_a.is_nan() || at_b.is_nan() {
        return None;
    }
    if (at_a > 0.0) == (at_b > 0.0) {
        let (end, value) = if at_a.abs() < at_b.abs() { (a, at_a) } else { (b, at_b) };
        return (value.abs() <= rounding).then_some(end);
    }
    for _ in 0..FALSE_POSITIONS {
        let x = a + (b - a) * (at_a / (at_a - at_b));
        let value = f(x);
        if value.abs() <= rounding / 16.0 {
            return Some(x);
        }
        if (value > 0.0) == (at_b > 0.0) {
            let factor = 1.0 - value / at_b;
            at_a *= if factor > 0.0 { factor } else { 0.5 };
        } else {
            (a, at_a) = (b, at_b);
        }
        (b, at_b) = (x, value);
        if (b - a).abs() <= f64::EPSILON * b.abs() {
            return Some(b);
        }
    }
    bracketed(f, a.min(b), a.max(b))
}

/// Steps after which false position has met a function it is not made for.
const FALSE_POSITIONS: u32 = 16;

#[cfg(test)]
mod tests {
    use super::*;

    struct Sine;
    impl Bounded for Sine {
        fn value(&self, x: f64) -> f64 {
            x.sin() - 0.5
        }
        fn slope(&self, a: f64, b: f64) -> [f64; 2] {
            let (middle, half) = ((a + b) / 2.0, (b - a) / 2.0);
            [(middle.cos() - half).max(-1.0), (middle.cos() + half).min(1.0)]
        }
    }

    #[test]
    fn every_root_is_found_once() {
        let mut roots = Vec::new();
        isolate(&Sine, [0.0, 20.0], [-1.0, 1.0], 1e-15, &mut |x| roots.push(x));
        let (first, half) = (std::f64::consts::FRAC_PI_6, std::f64::consts::PI);
        let expected: Vec<f64> = (0..4)
            .flat_map(|k| [first, half - first].map(|x| x + 2.0 * half * f64::from(k)))
            .filter(|&x| x < 20.0)
            .collect();
        assert_eq!(roots.len(), expected.len(), "{roots:?}");
        for (found, expected) in roots.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-14, "{found} is not {expected}");
        }
    }
}

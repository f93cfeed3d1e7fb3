//! Turns a polynomial segment into a frame, and finds the parts of it that face the other body.

use crate::numerics::interval::Interval;
use crate::numerics::polynomial::{derivative, exact_coefficients, range, recentred, value};
use crate::numerics::roots::bracketed;
use crate::numerics::twice::Twice;
use crate::profile::polynomial::{Polynomial, turned};
use crate::profile::station::Station;

/// Run of a curve along ξ, as a share of its speed, below which the curve is vertical to rounding. The direction of a
/// straight wall is known to this accuracy only, so that the sign of a smaller run means nothing.
const VERTICAL: f64 = 16.0 * f64::EPSILON;

/// Finds the parts of a range of t where ξ(t) rises by more than rounding, from the coefficients of ξ and ζ. Method: a bound
/// of the slope that costs one sum settles most spans; the others are bisected down to 2⁻⁴⁰ of the range.
pub(super) fn rising_parts([xi, zeta]: [&[f64]; 2], over: Interval) -> Vec<Interval> {
    if rises_throughout(xi, over) {
        return vec![over];
    }
    let [run, rise] = [xi, zeta].map(derivative);
    let [run_size, rise_size] = [&run, &rise].map(|c| range(c, over).magnitude());
    rising_intervals(&run, VERTICAL * run_size.max(rise_size), over)
}

/// Returns whether one sum proves that a polynomial has a positive derivative all over a range of t. If not, the polynomial
/// may rise all the same.
fn rises_throughout(c: &[f64], over: Interval) -> bool {
    let farthest = over.magnitude();
    let Some(first) = c.get(1) else { return false };
    let (mut others, mut power) = (0.0, 1.0);
    for (k, c) in c.iter().enumerate().skip(2) {
        power *= farthest;
        others += k as f64 * c.abs() * power;
    }
    // The slope is then at least half its constant term, which is far above rounding.
    0.5 * first > others
}

/// Finds the parts of a range of t where the polynomial `slope` is positive. There are none if it is nowhere larger than
/// `rounding`.
fn rising_intervals(slope: &[f64], rounding: f64, over: Interval) -> Vec<Interval> {
    let mut parts = Vec::new();
    if range(slope, over).high <= rounding {
        return parts;
    }
    let mut cuts = vec![over.low];
    sign_changes(slope, rounding, over, 40, &mut cuts);
    cuts.push(over.high);
    let between = cuts.windows(2).map(|pair| Interval::new(pair[0], pair[1]));
    parts.extend(between.filter(|part| part.has_width() && value(slope, part.middle()) > 0.0));
    parts
}

/// Appends the places where a polynomial changes its sign. Parts where it is no larger than `rounding` are passed over.
fn sign_changes(c: &[f64], rounding: f64, over: Interval, depth: u32, out: &mut Vec<f64>) {
    let Interval { low, high } = range(c, over);
    if low > 0.0 || high < 0.0 || depth == 0 || (low >= -rounding && high <= rounding) {
        return;
    }
    let monotone = range(&derivative(c), over);
    if !monotone.contains(0.0) {
        let Interval { low: a, high: b } = over;
        out.extend(bracketed(|t| value(c, t), a, b).filter(|&t| t > a && t < b));
        return;
    }
    let [lower, upper] = over.halves();
    sign_changes(c, rounding, lower, depth - 1, out);
    if value(c, upper.low) == 0.0 {
        out.push(upper.low);
    }
    sign_changes(c, rounding, upper, depth - 1, out);
}

/// Turns a segment into a frame. Returns the coefficients of ξ(t) and of ζ(t), and the range of t.
pub(super) fn seen_from(polynomial: &Polynomial, frame: &Station) -> ([Vec<Twice>; 2], Interval) {
    let c = [polynomial.x.as_slice(), polynomial.z.as_slice()];
    (turned(c, [frame.x, frame.z], frame.cos, frame.sin), polynomial.t)
}

/// Turns a segment into the contact frame of its own point t = `origin`. ζ(t) then has no constant and no linear term,
/// exactly.
pub(super) fn seen_from_own_point(polynomial: &Polynomial, origin: Twice) -> ([Vec<Twice>; 2], Interval) {
    let [mut x, mut z] = [&polynomial.x, &polynomial.z].map(|c| recentred(c, origin));
    z.resize(z.len().max(2), Twice::ZERO);
    (x[0], z[0]) = (Twice::ZERO, Twice::ZERO);
    let norm = (x[1] * x[1] + z[1] * z[1]).sqrt();
    let [xi, mut zeta] = turned([&x, &z], [0.0; 2], x[1] / norm, z[1] / norm);
    zeta[1] = Twice::ZERO;
    ([xi, zeta], polynomial.t.map(|t| (Twice::from(t) - origin).into()))
}

/// Returns the station of a segment, in profile axes, at a parameter in twice the working precision.
pub(super) fn station_at(polynomial: &Polynomial, t: Twice) -> Station {
    let [[x, dx], [z, dz]] = [&polynomial.x, &polynomial.z].map(|c| exact_coefficients(c, t));
    let norm = (dx * dx + dz * dz).sqrt();
    Station { x: x.into(), z: z.into(), cos: (dx / norm).into(), sin: (dz / norm).into() }
}

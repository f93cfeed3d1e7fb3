//! Tells where a line of constant σ may meet a patch over a roller's own surface in several intervals of η.

use super::lines::opening;
use super::lines::rims::Rims;
use crate::placement::Placement;
use crate::profile::Side;

/// Largest height \[mm\] of the lowest place that is found by roots over another one of its line. Samples would find both, but miss parts that
/// are as deep and narrow.
const LOW_RIDGE: f64 = 1e-4;

/// Returns whether a line on a roller may have two lowest places near or within the patch at approach δ \[mm\]: at a hollow kink or beyond a
/// hollow end.
pub(super) fn lines_divide(placement: &Placement, approach: f64) -> bool {
    placement.under().is_some()
        && ((placement.skew() != 0.0 && has_hollow_kink(placement, approach))
            || has_hollow_end(placement, approach))
}

/// Returns whether a hollow kink of a skewed wheel on a roller divides lines that cross it.
///
/// At the kink the slope of the gap along the line falls by sin χ times the change of the profile's slope, J. With a the opening the
/// two places are up to J/2a apart, and one of them up to J²/4a lower than the other.
fn has_hollow_kink(placement: &Placement, approach: f64) -> bool {
    let (wheel, roller) = (&placement.wheel().section, &placement.rail().section);
    let lower = |slope: f64| (slope * placement.skew().sin()).powi(2) / (4.0 * opening(placement));
    wheel.pieces.windows(2).any(|pair| {
        let (xi, slopes) = (pair[1].xi.low, [wheel.end_slope(&pair[0], 1), wheel.end_slope(&pair[1], 0)]);
        let Some(below) = roller.branch_at(xi).filter(|_| pair[0].xi.high == xi) else { return false };
        // Along the line and along the circle of the kink the gap falls by no more.
        let steepest = slopes[0].abs().max(slopes[1].abs()) + below.chord_slope(xi, xi).abs();
        let least = pair[1].heights[0] - below.height(xi) - lower(steepest);
        lower((slopes[0] - slopes[1]).max(0.0)) > LOW_RIDGE && least < approach
    })
}

/// Returns whether lines leave the wheel or the roller over an end of its profile where the gap is below δ, and enter it again.
fn has_hollow_end(placement: &Placement, approach: f64) -> bool {
    Rims::new(placement).hollow_ends().any(|(body, [xi, _, height])| {
        let other = match body {
            Side::Wheel => -placement.rail().section.height(xi),
            Side::Rail => placement.wheel().section.height(xi),
        };
        height + other < approach
    })
}

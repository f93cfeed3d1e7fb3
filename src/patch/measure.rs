//! Integrates the area of a band and the length of its branches.

use super::band::Band;

/// Relative accuracy demanded of the quadrature of the area.
const AREA_DEMAND: f64 = 1e-13;

/// Relative accuracy demanded of the quadrature of the perimeter.
const PERIMETER_DEMAND: f64 = 1e-11;

/// Returns the area of a band and the length of both its branches \[mm², mm\].
pub(super) fn area_and_length(band: &Band) -> [f64; 2] {
    let mut sums = [0.0; 2];
    let grading = band.grading();
    for t in band.pieces() {
        let width_and_speed = |xi: f64| {
            let ([low, high], slopes) = band.edges_and_slopes(xi);
            // A slope is infinite only where rounding has moved ξ onto a round end, which contributes nothing.
            let speeds =
                slopes.map(|slope| if slope.is_finite() { (1.0 + slope * slope).sqrt() } else { 0.0 });
            [high - low, speeds[0] + speeds[1]]
        };
        let [area, length] = grading.integrals(t, width_and_speed, [AREA_DEMAND, PERIMETER_DEMAND]);
        sums = [sums[0] + area, sums[1] + length];
    }
    sums
}

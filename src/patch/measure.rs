//! Areas and lengths along a band.

use super::band::Band;
use super::outline::Outline;

/// Demand on the quadrature of the area, relative.
const AREA_DEMAND: f64 = 1e-13;

/// Demand on the quadrature of the perimeter, relative.
const PERIMETER_DEMAND: f64 = 1e-11;

/// Area of a band, and the length of both its branches \[mm², mm\].
pub(super) fn area_and_length(outline: &mut Outline<'_>, band: &Band) -> [f64; 2] {
    let mut sums = [0.0; 2];
    let grading = band.grading();
    for t in band.pieces() {
        let width_and_speed = |xi: f64| match outline.edges_and_slopes(band.valley(xi), xi) {
            Some(([low, high], slopes)) => {
                // Infinite only where ξ has been rounded onto a round end itself, which has no measure.
                let speeds = slopes.map(|slope| if slope.is_finite() { 1f64.hypot(slope) } else { 0.0 });
                [high.eta - low.eta, speeds[0] + speeds[1]]
            }
            None => [0.0; 2],
        };
        let [area, length] = grading.integrals(t, width_and_speed, [AREA_DEMAND, PERIMETER_DEMAND]);
        sums = [sums[0] + area, sums[1] + length];
    }
    sums
}

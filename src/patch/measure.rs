//! Integrates the area of a band and the length of its branches.

use super::band::{Band, BandPlaces};
use crate::numerics::lanes::lanes;

/// Relative accuracy demanded of the quadrature of the area.
const AREA_DEMAND: f64 = 1e-13;

/// Relative accuracy demanded of the quadrature of the perimeter.
const PERIMETER_DEMAND: f64 = 1e-11;

/// Returns the area of a band and the length of both its branches \[mm², mm\].
pub(super) fn area_and_length(band: &Band) -> [f64; 2] {
    let width_and_speed = |at: &BandPlaces| {
        let ([low, high], slopes) = (&at.edges, &at.slopes);
        // A slope is infinite only where rounding has moved ξ onto a round end, which contributes nothing.
        let speed = |slope: f64| if slope.is_finite() { (1.0 + slope * slope).sqrt() } else { 0.0 };
        [lanes(|k| high[k] - low[k]), lanes(|k| speed(slopes[0][k]) + speed(slopes[1][k]))]
    };
    band.integrals(band.xi, true, width_and_speed, [AREA_DEMAND, PERIMETER_DEMAND])
}

//! The ranges, the nominal radius and the tolerance of a table.

use super::cell::{BREAK, INSIDE, YAW_COEFFICIENTS};
use crate::numerics::interval::Interval;

/// The ranges, the nominal radius and the tolerance of a table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct About {
    /// Range of lateral displacements \[mm\].
    pub lateral: Interval,
    /// Range of yaws \[rad\]; with equal ends it is the one yaw of all displacements.
    pub yaw: Interval,
    /// Nominal rolling radius \[mm\], over which the tolerance of angles is taken.
    pub radius: f64,
    /// Tolerance of lengths \[mm\].
    pub tolerance: f64,
}

impl About {
    /// Tells whether the table is over a range of yaws.
    pub fn over_yaw(&self) -> bool {
        self.yaw.high > self.yaw.low
    }

    /// Returns how many coefficients the polynomials of the yaw have.
    pub fn yaw_coefficients(&self) -> usize {
        if self.over_yaw() { YAW_COEFFICIENTS } else { 1 }
    }

    /// Returns the distance \[mm\] from curves within which a table states nothing: there the values of the other side may be given.
    pub fn beside_curves(&self) -> f64 {
        if self.over_yaw() { INSIDE } else { BREAK }
    }
}

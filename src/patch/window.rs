//! The part of the ξ–η plane in which a patch is sought.

use serde::{Deserialize, Serialize};

use crate::numerics::interval::Interval;

/// A rectangle of the ξ–η plane \[mm\] inside which a patch is sought.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Window {
    /// Range of ξ \[mm\].
    pub xi: Interval,
    /// Range of η \[mm\].
    pub eta: Interval,
}

impl Window {
    /// The whole plane: only the ends of the bodies bound the patch.
    pub const UNBOUNDED: Self = Self { xi: Interval::ALL, eta: Interval::ALL };

    /// Tells whether this window and another share a point, their edges included.
    pub fn meets(&self, other: &Self) -> bool {
        self.xi.meets(other.xi) && self.eta.meets(other.eta)
    }

    /// Tells whether another window lies inside this one and touches no edge of it.
    pub fn surrounds(&self, other: &Self) -> bool {
        let around = |own: Interval, other: Interval| own.low < other.low && other.high < own.high;
        around(self.xi, other.xi) && around(self.eta, other.eta)
    }

    /// Tells whether a point lies in the window, its edges included.
    pub fn contains(&self, xi: f64, eta: f64) -> bool {
        self.xi.contains(xi) && self.eta.contains(eta)
    }

    /// Returns the smallest window that holds this one and another.
    pub fn hull(self, other: Self) -> Self {
        Self { xi: self.xi.hull(other.xi), eta: self.eta.hull(other.eta) }
    }
}

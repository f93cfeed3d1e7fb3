//! What is measured of a profile, with what it is worth.

use super::align::Alignment;
use super::quantity::Quantity;
use crate::profile::Side;

/// What was measured of a profile.
#[derive(Debug, Clone, PartialEq)]
pub struct Measures {
    /// The body.
    pub side: Side,
    pub(super) values: [Option<f64>; Quantity::ALL.len()],
    pub(super) if_off: [Option<f64>; Quantity::ALL.len()],
    /// How it was aligned; `None` if it could not be.
    pub alignment: Option<Alignment>,
    /// What cannot be had and why, and what is doubtful.
    pub findings: Vec<String>,
}

impl Measures {
    /// Takes the diameter of a wheel \[mm\] that its file states: no profile tells it.
    #[must_use]
    pub fn with_diameter(mut self, diameter: Option<f64>) -> Self {
        self.values[Quantity::Diameter as usize] = diameter.filter(|_| self.side == Side::Wheel);
        self
    }

    /// Returns a value in its unit; `None` where it cannot be had.
    pub fn value(&self, quantity: Quantity) -> Option<f64> {
        self.values[quantity as usize]
    }

    /// Returns the largest change of a value if the profile lay 0.1 mm or 0.1° otherwise, about X = 0 at the tread or the top of rail.
    pub fn if_off(&self, quantity: Quantity) -> Option<f64> {
        self.if_off[quantity as usize]
    }
}

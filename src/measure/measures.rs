//! What is measured of a profile, with what it is worth.

use super::align::Alignment;
use super::quantity::Quantity;
use crate::measured::noise::Spread;
use crate::profile::Side;

/// What was measured of a profile.
#[derive(Debug, Clone, PartialEq)]
pub struct Measures {
    /// The body.
    pub side: Side,
    pub(super) values: [Option<f64>; Quantity::ALL.len()],
    pub(super) if_off: [Option<f64>; Quantity::ALL.len()],
    pub(super) spreads: [Option<Spread>; Quantity::ALL.len()],
    /// How it was aligned; `None` if it could not be.
    pub alignment: Option<Alignment>,
    /// What cannot be had and why, and what is doubtful.
    pub findings: Vec<String>,
}

impl Measures {
    /// Returns measures without values.
    pub(super) fn empty(side: Side) -> Self {
        Self {
            side,
            values: Default::default(),
            if_off: Default::default(),
            spreads: Default::default(),
            alignment: None,
            findings: Vec::new(),
        }
    }

    /// Returns measures without values, and why.
    pub(super) fn none(side: Side, why: String) -> Self {
        Self { findings: vec![why], ..Self::empty(side) }
    }

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

    /// Returns how far a value spreads under noise or over repeats, in its unit; `None` if neither was asked for.
    pub fn spread(&self, quantity: Quantity) -> Option<&Spread> {
        self.spreads[quantity as usize].as_ref()
    }
}

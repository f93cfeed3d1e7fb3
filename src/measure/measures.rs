//! The measures of a profile, with their sensitivity to the alignment and their spread.

use super::align::Alignment;
use super::quantity::Quantity;
use crate::measured::StatedValue;
use crate::measured::noise::Spread;
use crate::profile::Side;

/// Difference \[mm\] of a value from that which its file states above which it is a finding.
const MOST_OFF: f64 = 0.1;

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

    /// Returns measures without values, with a finding that says why.
    pub(super) fn none(side: Side, why: String) -> Self {
        Self { findings: vec![why], ..Self::empty(side) }
    }

    /// Adds the diameter \[mm\] that the file of a wheel states: no profile tells it. A rail has none.
    #[must_use]
    pub fn with_diameter(mut self, diameter: Option<f64>) -> Self {
        self.values[Quantity::Diameter as usize] = diameter.filter(|_| self.side == Side::Wheel);
        self
    }

    /// Compares the values with those that the file states; a difference above 0.1 mm is a finding.
    #[must_use]
    pub fn compared(mut self, stated: &[StatedValue]) -> Self {
        for StatedValue { key, value, line } in stated {
            let quantity = Quantity::stated_as(key).filter(|quantity| quantity.side() == self.side);
            let Some((quantity, own)) = quantity.and_then(|of| Some((of, self.value(of)?))) else { continue };
            let off = own - value;
            if off.abs() > MOST_OFF {
                self.findings.push(format!(
                    "line {line}: the file states {key} = {value} mm, and {} is {own:.3}: {off:+.3} mm",
                    quantity.key()
                ));
            }
        }
        self
    }

    /// Returns a value in its unit; `None` where it cannot be had.
    pub fn value(&self, quantity: Quantity) -> Option<f64> {
        self.values[quantity as usize]
    }

    /// Returns how far a value may be off, a third of the largest error: its largest change if the profile is moved by 0.1 mm, or turned
    /// by 0.1° about the tread at X = 0 or the top of rail (or half and a third of it if twice and three times as far), or lies as the fit
    /// on the nominal has it, or its points are smoothed half as far; and twice the standard deviation that the noise of the points gives
    /// it. `None` where a motion by 0.1 takes the quantity away.
    pub fn if_off(&self, quantity: Quantity) -> Option<f64> {
        self.if_off[quantity as usize]
    }

    /// Returns how far a value spreads under noise or over repeats, in its unit; `None` if neither was asked for, or
    /// too few have the quantity.
    pub fn spread(&self, quantity: Quantity) -> Option<&Spread> {
        self.spreads[quantity as usize].as_ref()
    }
}

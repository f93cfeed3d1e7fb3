//! The request for a table.

use crate::numerics::interval::Interval;
use crate::search::Roll;

/// What presses a wheel onto its rail.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Pressed {
    /// An approach δ along the normal of its lowest place \[mm\].
    Approach(f64),
    /// A vertical load \[N\].
    Load(f64),
}

/// The request for a table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Asked {
    /// Range of the lateral displacement \[mm\], + to the right.
    pub lateral: Interval,
    /// Range of the yaw \[rad\]; with equal ends it is the one yaw of all displacements.
    pub yaw: Interval,
    /// How the roll is found.
    pub roll: Roll,
    /// Tolerance of lengths \[mm\], from which those of other quantities follow:
    /// [`TableQuantity::tolerance`](super::TableQuantity::tolerance).
    pub tolerance: f64,
    /// What presses the left and the right wheel, and E* \[N/mm²\]; `None` leaves Hertz's ellipses out.
    pub pressed: Option<([Pressed; 2], f64)>,
}

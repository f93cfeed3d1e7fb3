//! What is asked of a table.

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

/// What is asked of a table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Asked {
    /// Range of the lateral displacement \[mm\], + to the right.
    pub lateral: Interval,
    /// Range of the yaw \[rad\]: with equal ends the one yaw of all displacements.
    pub yaw: Interval,
    /// How the roll is found.
    pub roll: Roll,
    /// Tolerance of lengths \[mm\]; the tolerances of other quantities follow from it: [`TableQuantity::tolerance`](super::TableQuantity::tolerance).
    pub tolerance: f64,
    /// What presses the left and the right wheel, and E* \[N/mm²\]; `None` leaves Hertz's ellipses out.
    pub pressed: Option<([Pressed; 2], f64)>,
}

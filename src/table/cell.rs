//! Cells: pieces of the plane of lateral displacement and yaw over which nothing jumps.

use crate::numerics::interval::Interval;

/// Coefficients of a polynomial along the lateral displacement: its degree is 8.
pub const COEFFICIENTS: usize = 9;

/// Coefficients of a polynomial along the yaw: its degree is 4.
pub const YAW_COEFFICIENTS: usize = 5;

/// Width \[mm\] to which a place is found where contact hops or crosses a joint.
pub const BREAK: f64 = 1e-9;

/// Distance \[mm\] from a curve over yaw at which a search certainly finds the contact of its own side: above the curve's error.
pub(super) const INSIDE: f64 = 1e-7;

/// How a cell begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Beginning {
    /// In the middle of a branch: the cell before goes on smoothly.
    Smooth,
    /// Where contact crosses a joint of a profile: places are continuous, curvatures jump.
    Joint,
    /// Where contact hops to another place.
    Hop,
    /// Where the table begins, a wheel leaves its rail or comes back onto it.
    Edge,
}

impl Beginning {
    /// All, in the order of their codes.
    pub const ALL: [Self; 4] = [Self::Smooth, Self::Joint, Self::Hop, Self::Edge];

    /// Returns its code in files: 0 smooth, 1 joint, 2 hop, 3 edge.
    pub fn code(self) -> u8 {
        self as u8
    }
}

/// What does not exist over a cell on one side.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Lacks {
    /// Everything exists.
    #[default]
    Nothing,
    /// s is not convex at C, so that Hertz has no ellipse.
    Ellipse,
    /// A body touches with a kink, step or end: there are no curvatures either.
    Curvatures,
}

impl Lacks {
    /// All, in the order of their codes.
    pub const ALL: [Self; 3] = [Self::Nothing, Self::Ellipse, Self::Curvatures];

    /// Returns its code in files: 0 nothing, 1 ellipse, 2 curvatures and ellipse.
    pub fn code(self) -> u8 {
        self as u8
    }
}

/// A cell: a piece of the plane between two curves and two yaws, over which every quantity is one polynomial.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cell {
    /// The yaws \[rad\] between which it lies: u is −1 at the first one, 1 at the last one.
    pub yaw: Interval,
    /// Numbers of the curves at which it begins and ends.
    pub curves: [usize; 2],
    /// Whether both wheels touch; where they do not, the cell has no polynomials.
    pub touches: bool,
    /// What does not exist on the left and on the right side.
    pub lacks: [Lacks; 2],
}

//! Where a wheelset stands over its track.

use nalgebra::Rotation3;

use super::touch::wheel_rotation;

/// How the roll of a wheelset is found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Roll {
    /// Finds the roll at which both wheels touch.
    Solve,
    /// Takes a roll of 0 (the convention of EN 15302): each side is lowered on its own.
    Neglect,
    /// Takes this roll \[rad\], + lowers the right-hand wheel: each side is lowered on its own.
    Fixed(f64),
}

/// The position of a wheelset over its track.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Position {
    /// Lateral displacement of the axle's middle \[mm\], + to the right.
    pub lateral: f64,
    /// Yaw ψ \[rad\], + moves the right-hand wheel forward.
    pub yaw: f64,
    /// How the roll is found.
    pub roll: Roll,
}

impl Position {
    /// Gives the rotation of the wheelset about the middle of its axle, in track axes, at a given or solved roll \[rad\]: see
    /// [`wheel_rotation`].
    pub fn rotation(&self, roll: f64) -> Rotation3<f64> {
        wheel_rotation(self.yaw, roll)
    }
}

//! What a search for the first touch of a wheelset finds.

use super::candidates::Meeting;
use super::touch::Touch;

/// First touch of both wheels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WheelsetTouch<'a> {
    /// Roll \[rad\], solved or given.
    pub roll: f64,
    /// Left and right side.
    pub sides: [SideTouch<'a>; 2],
    /// Where the lowest places are, for searches nearby.
    pub(crate) places: LowestPlaces,
}

/// The lowest places of a first touch, from which searches nearby begin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LowestPlaces {
    pub(super) roll: f64,
    pub(super) meetings: [Meeting; 2],
    /// Derivative of the difference of the sides' heights with respect to the roll, over that of two treads \[1\].
    pub(super) steadiness: f64,
}

impl LowestPlaces {
    /// Gives the elements of wheel and rail that meet on each side. While they stay the same, results are analytic in the position.
    pub fn elements(&self) -> [[u32; 2]; 2] {
        self.meetings.map(|meeting| meeting.elements)
    }

    /// Gives the rate at which the heights of both sides part with the roll, as a share of that of level treads. Where it falls to 0 the
    /// roll at which both wheels touch ends: beyond there is another one, or none.
    pub fn steadiness(&self) -> f64 {
        self.steadiness
    }

    /// Gives the roll \[rad\].
    pub fn roll(&self) -> f64 {
        self.roll
    }
}

/// First touch of one side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SideTouch<'a> {
    /// Height \[mm\] of the axle's middle above R, the right-hand wheel's, over the top of rail when this side touches, + up: −0.18
    /// for a centred S1002 on 60E1 at 1:40. Equal on both sides if the roll is solved.
    pub z: f64,
    /// Contacts of the side, in its own axes.
    pub touch: Touch<'a>,
}

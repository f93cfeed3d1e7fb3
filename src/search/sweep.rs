//! Sweeps: gives the contact geometry of a wheelset at many positions, one row per side and contact.

mod conicity;
mod two_step;

pub use conicity::{ACCURACY, Conicity, Equivalent, NoConicity};
pub use two_step::TwoStep;

use std::fmt;

use super::position::{Position, Roll};
use super::touch::{Contact, Selection};
use super::wheelset::{WheelsetOnTrack, WheelsetSearch};
use crate::error::Result;

/// A side of the track.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TrackSide {
    /// The side at negative x of the track.
    Left,
    /// The side at positive x of the track.
    Right,
}

impl TrackSide {
    /// Gives the name of the side: "left", "right".
    pub const fn name(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
        }
    }
}

impl fmt::Display for TrackSide {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// One row of a sweep: a contact of one side at one position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SweepRow {
    /// Lateral displacement of the axle's middle \[mm\], + to the right.
    pub lateral: f64,
    /// Yaw \[rad\], + moves the right-hand wheel forward.
    pub yaw: f64,
    /// Roll \[rad\], solved or given, + lowers the right-hand wheel.
    pub roll: f64,
    /// Side of the wheel.
    pub side: TrackSide,
    /// Number of the contact on its side, from 0, by ascending gap.
    pub number: usize,
    /// Height \[mm\] of the axle's middle above R, the right-hand wheel's, over the top of rail when this side touches, + up.
    pub z: f64,
    /// The contact, in the axes of its side.
    pub contact: Contact,
    /// Right less left rolling radius of the two sides' lowest contacts \[mm\]; positive when the wheelset is
    /// to the right.
    pub delta_r: f64,
    /// Equivalent conicity tan γ_e at the amplitude |lateral|, or why there is none.
    pub conicity: std::result::Result<Equivalent, NoConicity>,
}

/// Sweeps over positions; keeps its buffers.
///
/// # Examples
/// ```
/// # use wheelrail::{Arc, Pair, Profile, RailDistance, Segment, WheelDistance, standards};
/// use wheelrail::{Conicity, ONE_CONTACT, Position, Roll, Selection, Sweep, WheelsetOnTrack};
/// # let cone = Profile::new("cone", "", vec![Segment::arc(Arc::line([-60.0, -3.0], [60.0, 3.0])?)])?;
/// # let pair = Pair::new(standards::rail("60E1")?, cone, 460.0)?;
/// let system = WheelsetOnTrack::new(&pair, RailDistance::Spacing(1500.0), WheelDistance::Spacing(1500.0))?; // cones 1:20
/// let conicity = Conicity::new(&system, 3.0, Roll::Neglect)?;
/// let mut sweep = Sweep::new(&system, Selection { within: 0.0, apart: ONE_CONTACT }, Some(&conicity));
/// let mut rows = Vec::new();
/// sweep.position(&Position { lateral: 3.0, yaw: 0.0, roll: Roll::Neglect }, &mut rows)?;
/// assert_eq!(rows.len(), 2); // left, right
/// assert!((rows[1].delta_r - 0.3).abs() < 1e-9);
/// assert!(rows[1].conicity.is_ok_and(|found| (found.conicity - 0.05).abs() < 1e-4));
/// # Ok::<(), wheelrail::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Sweep<'a> {
    search: WheelsetSearch<'a>,
    selection: Selection,
    conicity: Option<&'a Conicity>,
}

impl<'a> Sweep<'a> {
    /// Makes a sweep that reports the contacts of `selection`, with the equivalent conicity from `conicity`
    /// if that is given. A position with a given roll has no conicity, as Δr is not odd there.
    pub fn new(system: &'a WheelsetOnTrack, selection: Selection, conicity: Option<&'a Conicity>) -> Self {
        Self { search: system.search(), selection, conicity }
    }

    /// Moves the wheelset to a place along the track \[mm\] and a pitch \[rad\]: see [`WheelsetSearch::stand_at`].
    pub fn stand_at(&mut self, along: f64, pitch: f64) {
        self.search.stand_at(along, pitch);
    }

    /// Tells which wheels had a hole under them at the last position: see [`WheelsetSearch::over_holes`].
    pub fn over_holes(&self) -> [bool; 2] {
        self.search.over_holes()
    }

    /// Appends the rows of one position to `rows`, left side first; none if the position has no contact.
    ///
    /// # Errors
    /// Values that are not finite; angles beyond ±0.5 rad; a body that varies and follows the other one's shape all over.
    pub fn position(&mut self, position: &Position, rows: &mut Vec<SweepRow>) -> Result<()> {
        let Some(touch) = self.search.touch_near(position, &self.selection, None)? else { return Ok(()) };
        let [left, right] = touch.sides.map(|side| side.touch.contacts[0].rolling_radius);
        let conicity = match (position.roll, self.conicity) {
            (_, None) => Err(NoConicity::NotAsked),
            (Roll::Fixed(_), _) => Err(NoConicity::GivenRoll),
            (Roll::Solve | Roll::Neglect, Some(conicity)) => conicity.at(position.lateral),
        };
        for (side, found) in [TrackSide::Left, TrackSide::Right].into_iter().zip(touch.sides) {
            rows.extend(found.touch.contacts.iter().enumerate().map(|(number, contact)| SweepRow {
                lateral: position.lateral,
                yaw: position.yaw,
                roll: touch.roll,
                side,
                number,
                z: found.z,
                contact: *contact,
                delta_r: right - left,
                conicity,
            }));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::placement::{Pair, RailDistance, WheelDistance};
    use crate::profile::standards;

    #[test]
    fn a_position_has_a_row_for_each_side_and_contact() -> Result<()> {
        let pair = Pair::new(standards::rail("60E1")?, standards::wheel("cone-1:20")?, 460.0)?;
        let (rails, wheels) = (RailDistance::Spacing(1500.0), WheelDistance::Spacing(1500.0));
        let system = WheelsetOnTrack::new(&pair, rails, wheels)?;
        let conicity = Conicity::new(&system, 5.0, Roll::Neglect)?;
        let mut sweep = Sweep::new(&system, Selection { within: 0.0, apart: 0.0 }, Some(&conicity));
        let mut rows = Vec::new();
        sweep.position(&Position { lateral: 3.0, yaw: 0.0, roll: Roll::Neglect }, &mut rows)?;
        assert_eq!(rows.iter().map(|row| row.side).collect::<Vec<_>>(), [TrackSide::Left, TrackSide::Right]);
        for row in &rows {
            assert!((row.delta_r - 0.3).abs() < 1e-12, "{row:?}");
            assert!(row.conicity.is_ok_and(|found| (found.conicity - 0.05).abs() < 1e-9), "{row:?}");
            assert_eq!((row.number, row.lateral, row.roll), (0, 3.0, 0.0));
        }
        // A cone that moves to the right rises on the right.
        assert!((rows[1].z - rows[0].z - 0.3).abs() < 1e-12, "{rows:?}");
        // A given roll has no conicity.
        rows.clear();
        sweep.position(&Position { lateral: 3.0, yaw: 0.0, roll: Roll::Fixed(0.0) }, &mut rows)?;
        assert!(
            rows.len() == 2 && rows.iter().all(|row| row.conicity == Err(NoConicity::GivenRoll)),
            "{rows:?}"
        );
        // A wheelset off its track has no rows.
        sweep.position(&Position { lateral: 300.0, yaw: 0.0, roll: Roll::Solve }, &mut rows)?;
        assert_eq!(rows.len(), 2);
        Ok(())
    }
}

//! Finds the places of contact and near miss at one displacement, and how they change beside it.

use crate::error::Result;
use crate::numerics::roots::bracketed;
use crate::search::position::{Position, Roll};
use crate::search::wheelset::{WheelsetOnTrack, WheelsetSearch};
use crate::search::wheelset_touch::SideTouch;
use crate::search::{Contact, Selection};

/// The near misses that are considered: gaps up to 1 µm close within a displacement of 0.01 to 0.1 mm. With a
/// smaller limit hops would be found by halving; with a larger one rough profiles have hundreds of near
/// misses. Places within 1 µm of each other are one: a hop that short changes Δr by less than 0.1 µm on a
/// tread.
const NEAR: Selection = Selection { within: 1e-3, apart: 1e-3 };

/// Step at which the centre of the movement is looked for \[mm\], and the largest number of steps to one side: a metre, more than
/// wheels move over rails.
const STEP: f64 = 0.1;
const FARTHEST: u32 = 10_000;

/// Signs of the left and the right side's own x axis along the track's.
const SIGNS: [f64; 2] = [-1.0, 1.0];

/// A place where a side touches, or nearly touches, at one displacement y of the wheelset.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct TouchBranch {
    /// Vertical gap \[mm\].
    pub gap: f64,
    /// Height of the axle's middle \[mm\] at which this side touches.
    pub height: f64,
    /// Rate \[mm/mm\] at which the axle's middle has to rise with y for this place to keep its gap.
    pub climb: f64,
    /// Rolling radius ϱ \[mm\].
    pub radius: f64,
    /// dϱ/dy \[mm/mm\]; infinite or NaN where the curvatures do not determine it.
    pub growth: f64,
}

/// The places of the left and the right side, by ascending gap.
pub(super) type SideBranches = [Vec<TouchBranch>; 2];

/// Searches at one displacement after another.
pub(super) struct Searched<'a> {
    system: &'a WheelsetOnTrack,
    search: WheelsetSearch<'a>,
    roll: Roll,
}

impl<'a> Searched<'a> {
    pub(super) fn new(system: &'a WheelsetOnTrack, roll: Roll) -> Self {
        Self { system, search: system.search(), roll }
    }

    /// Finds the places at one displacement \[mm\] without yaw; false if the wheelset is off its track.
    ///
    /// # Errors
    /// A displacement or roll that is not finite.
    pub(super) fn at(&mut self, lateral: f64, sides: &mut SideBranches) -> Result<bool> {
        let position = Position { lateral, yaw: 0.0, roll: self.roll };
        let Some(touch) = self.search.touch_near(&position, &NEAR, None)? else { return Ok(false) };
        let arms = [0, 1].map(|k| Arm::new(self.system, lateral, k, &touch.sides[k]));
        let lowest = [0, 1].map(|k| arms[k].turning(&touch.sides[k].touch.contacts[0]));
        // With the roll solved both sides rise alike: the roll turns by this much with y.
        let turn = match self.roll {
            Roll::Solve => -(lowest[0][0] + lowest[1][0]) / (lowest[0][1] + lowest[1][1]),
            Roll::Neglect | Roll::Fixed(_) => 0.0,
        };
        for (k, places) in sides.iter_mut().enumerate() {
            places.clear();
            places.extend(touch.sides[k].touch.contacts.iter().map(|contact| arms[k].branch(contact, turn)));
        }
        Ok(true)
    }
}

impl Searched<'_> {
    /// Finds the places at a distance \[mm\] from a centre to one side: +1 to the right; −1 to the left, where they are those that the
    /// mirror image of the wheelset has to the right. The sides are then swapped, and rates with respect to the displacement change
    /// sign.
    ///
    /// # Errors
    /// The errors of [`Searched::at`].
    pub(super) fn beside(
        &mut self,
        centre: f64,
        sign: f64,
        u: f64,
        sides: &mut SideBranches,
    ) -> Result<bool> {
        let found = self.at(centre + sign * u, sides)?;
        if sign < 0.0 {
            sides.swap(0, 1);
            for place in sides.iter_mut().flatten() {
                (place.climb, place.growth) = (-place.climb, -place.growth);
            }
        }
        Ok(found)
    }

    /// Finds the displacement nearest to 0 at which Δr grows through 0, continuously or by a jump \[mm\]; 0 where Δr vanishes there;
    /// `None` if there is none as far as the track goes to both sides of 0.
    ///
    /// Method: searches every 0.1 mm, so that two such displacements nearer to each other may be missed.
    ///
    /// # Errors
    /// The errors of [`Searched::at`].
    pub(super) fn centre(&mut self) -> Result<Option<f64>> {
        let mut sides = SideBranches::default();
        let mut failure = None;
        let mut difference = |y: f64| match self.at(y, &mut sides) {
            Ok(true) => sides[1][0].radius - sides[0][0].radius,
            Ok(false) => f64::NAN,
            Err(error) => {
                failure = Some(error);
                f64::NAN
            }
        };
        let mut ends = [(0.0, difference(0.0)); 2];
        let mut centre = (ends[0].1 == 0.0).then_some(0.0);
        for step in 1..=FARTHEST {
            if centre.is_some() || ends.iter().all(|(_, value)| value.is_nan()) {
                break;
            }
            for (end, sign) in ends.iter_mut().zip(SIGNS).filter(|(end, _)| !end.1.is_nan()) {
                let next = sign * STEP * f64::from(step);
                let far = (next, difference(next));
                let [low, high] = if sign < 0.0 { [far, *end] } else { [*end, far] };
                *end = far;
                if low.1 <= 0.0 && high.1 >= 0.0 {
                    let crossing = bracketed(&mut difference, low.0, high.0);
                    let nearer = |y: &f64| centre.is_none_or(|other: f64| y.abs() < other.abs());
                    centre = crossing.filter(nearer).or(centre);
                }
            }
        }
        failure.map_or(Ok(centre), Err)
    }
}

/// Height of the axle's middle, and position of the rail from it, in the axes of one side.
struct Arm {
    sign: f64,
    height: f64,
    /// Position of the rail profile's origin from the axle's middle \[mm\], in the side's axes.
    origin: [f64; 2],
}

impl Arm {
    fn new(system: &WheelsetOnTrack, lateral: f64, index: usize, side: &SideTouch) -> Self {
        let (sign, track) = (SIGNS[index], system.sides[index].track());
        let x = track.rail_x() - sign * lateral;
        let z = track.rail_z() - side.z - system.reference_radius();
        Self { sign, height: side.z, origin: [x, z] }
    }

    /// Returns the rates at which the axle's middle rises with the displacement and with the roll of the
    /// side's own axes.
    fn turning(&self, contact: &Contact) -> [f64; 2] {
        let [x, z] = [self.origin[0] + contact.rail_x, self.origin[1] + contact.rail_z];
        let slope = contact.contact_angle.tan();
        [slope, x + z * slope]
    }

    /// Makes the branch of a contact; `turn` is the rate of the track's roll with y \[rad/mm\].
    fn branch(&self, contact: &Contact, turn: f64) -> TouchBranch {
        let [slope, rise] = self.turning(contact);
        let turn = self.sign * turn;
        // The wheel's material at the contact moves across by this much with y.
        let across = self.sign + turn * (self.origin[1] + contact.rail_z);
        TouchBranch {
            gap: contact.gap,
            height: self.height,
            climb: self.sign * slope + rise * turn,
            radius: contact.rolling_radius,
            growth: -contact.wheel_angle.sin() * travel(contact, across, turn),
        }
    }
}

/// Returns the rate at which the contact travels along the wheel's profile with y \[mm/mm\], from κ_R ds_R =
/// κ_W ds_W − dα and ds_R − ds_W = dx/cosθ. It divides by the larger curvature, which is infinite at a kink.
fn travel(contact: &Contact, across: f64, turn: f64) -> f64 {
    let (rail, wheel) = (contact.rail_curvature, contact.wheel_curvature);
    let along = across / contact.contact_angle.cos();
    if rail.abs() >= wheel.abs() {
        (along + turn / rail) / (wheel / rail - 1.0)
    } else {
        (along * (rail / wheel) + turn / wheel) / (1.0 - rail / wheel)
    }
}

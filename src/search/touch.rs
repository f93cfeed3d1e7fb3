//! Single wheels: finds where a wheel touches its rail, and how far it can be lowered.

use std::sync::Arc;

use nalgebra::{Rotation3, Vector3};
use serde::{Deserialize, Serialize};

use super::body::SearchBody;
use super::candidates::{Candidate, Meeting};
use super::locus::Attitude;
use super::over_rail::{RailSearch, SearchPair, Work};
use super::roller::{Meridian, at_own_turn, lower_on_roller};
use crate::error::{Error, ErrorKind, Result, finite};
use crate::lofted::{FramedLoft, LoftedBody, section_through};
use crate::placement::{Pair, Placement};
use crate::profile::{Profile, Section, Side};

/// Distance below which two candidates are one point, as a share of the two profiles' extents. Candidates of
/// one contact on a joint differ by up to 1e-8 of the extents; the closest contacts that a drawing can mean
/// are 1e-4 apart.
const SAME_POINT: f64 = 1e-7;

/// Largest yaw and roll \[rad\] of a pose. It is far above the angles of any running gear; from about 1 rad
/// on, the parts of a profile that face down are no longer those that do so in the profile's own axes.
const LARGEST_ANGLE: f64 = 0.5;

/// A rail and a wheel profile, prepared for searches.
#[derive(Debug, Clone)]
pub struct ProfilePair {
    pub(super) bodies: SearchPair,
    /// Distance \[mm\] from a roller's axle to the origin of its profile; `None` for a rail.
    roller: Option<f64>,
}

/// The place and attitude of a single wheel over its rail, without the height.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    offset: f64,
    yaw: f64,
    roll: f64,
}

/// Distance below which two places count as one contact \[mm\]: steps and kinks of drawings make groups
/// within 0.1 mm.
pub const ONE_CONTACT: f64 = 0.5;

/// Which places of contact a search reports.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Selection {
    /// Vertical gap \[mm\] above first touch up to which near misses are reported; 0 reports only touching
    /// places. Typically 0.1.
    pub within: f64,
    /// Distance along x on both profiles \[mm\] below which only the lower of two places is reported; 0
    /// reports all. Usually [`ONE_CONTACT`].
    pub apart: f64,
}

/// A place of contact or a near miss; x and angles are in the profile axes of its side.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Contact {
    /// Abscissa x_R on the rail profile \[mm\], from its origin, + to the field side.
    pub rail_x: f64,
    /// Abscissa x_W on the wheel profile \[mm\], from its origin, + to the field side (a flange has −38).
    pub wheel_x: f64,
    /// Height of the rail's point over the rail profile's origin \[mm\].
    pub rail_z: f64,
    /// Height of the wheel profile's point over the wheel profile's origin \[mm\].
    pub wheel_z: f64,
    /// Position along the rail, + forward \[mm\], from the vertical plane across the track through the wheel
    /// profile's origin: sinψ (x_W − ϱ tanθ_W) on an extruded rail. Behind it at a flange when yaw > 0.
    pub y: f64,
    /// Angle ν \[rad\] by which the common normal leans forward out of the rail's section; 0 on a rail of one profile. On a roller it is
    /// the angle about its axle from the crown to the contact, which lies at (R + z) sin ν ahead of the crown, with R the roller's
    /// radius and z = `rail_z`.
    pub turn: f64,
    /// Angle \[rad\] around a wheel that varies at which the contact lies, as its slices or keys count; 0 on a round wheel.
    pub around: f64,
    /// Angle \[rad\] by which the common normal leans forward out of the meridian plane of a wheel that varies; 0 on a round wheel.
    pub lean: f64,
    /// Contact angle θ_R \[rad\]: tangent angle of the common tangent in the rail's axes, + counter-clockwise
    /// from x to z; on a roller, in its meridian plane through the contact. A flange contact has 1.2.
    pub contact_angle: f64,
    /// Tangent angle θ_W \[rad\] of the wheel profile at the contact, in the wheel profile's axes. Without
    /// yaw it is the contact angle plus the roll.
    pub wheel_angle: f64,
    /// Skew χ \[rad\]: angle about the common normal ζ, + from ξ to η, from the rail's contact frame (ξ along
    /// its profile's tangent, η = y) to the wheel's (ξ' along its meridian tangent, η' along its
    /// circumference, forward): ξ' = ξ cosχ + η sinχ, η' = η cosχ − ξ sinχ, ζ' = ζ. sinχ = sinψ/cosθ_W on an
    /// extruded rail.
    pub skew: f64,
    /// Vertical gap left at first touch \[mm\]; 0 for the lowest contact.
    pub gap: f64,
    /// Actual rolling radius ϱ = R − z_W \[mm\].
    pub rolling_radius: f64,
    /// Curvature of the rail profile \[1/mm\], + hollow side up (a crown has −1/300); −∞ at a kink.
    pub rail_curvature: f64,
    /// Curvature of the wheel profile \[1/mm\], + hollow side up, −1/13 in a flange root; +∞ at a kink.
    pub wheel_curvature: f64,
    /// Curvature of a roller around its axle \[1/mm\]: cosθ_R over the distance of the contact from the axle; 0 on a rail.
    pub roller_curvature: f64,
    /// Whether the rail touches with a kink, step or end: the contact angle is then that of the common
    /// normal, not of a tangent.
    pub rail_kink: bool,
    /// Whether the wheel touches with a kink, step or end: θ_W is then that of the common normal, not of a
    /// tangent.
    pub wheel_kink: bool,
}

/// First touch of a wheel and its rail.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Touch<'a> {
    /// Height of the wheel's profile origin over the rail's at first touch \[mm\], + up.
    pub height: f64,
    /// The places of contact and near miss, the lowest gap first; never empty.
    pub contacts: &'a [Contact],
}

/// Searches over one pair; keeps its buffers, so that a search allocates nothing.
#[derive(Debug, Clone)]
pub struct ContactSearch<'a> {
    /// Distance \[mm\] from a roller's axle to the origin of its profile; `None` for a rail.
    roller: Option<f64>,
    over_rail: RailSearch<'a>,
    contacts: Vec<Contact>,
}

impl ProfilePair {
    /// Prepares a pair for searches; the rail is the one as placed (inclined).
    ///
    /// # Errors
    /// A profile has no part that faces the other body.
    pub fn new(pair: &Pair) -> Result<Self> {
        let body = |profile: &Profile, section: &Section, side| {
            SearchBody::new(section, profile.extent(), side).ok_or_else(|| {
                let expected = "a profile travelled from left to right";
                Error::new(&profile.name, "no surface", expected, "reverse or mirror it")
            })
        };
        let ([rail, wheel], [below, above]) = ([pair.rail(), pair.wheel()], pair.sections());
        Ok(Self {
            bodies: SearchPair {
                rail: body(rail, below, Side::Rail)?,
                wheel: body(wheel, above, Side::Wheel)?,
                radius: pair.wheel_radius(),
                extent: rail.extent() + wheel.extent(),
            },
            roller: pair.roller_radius(),
        })
    }

    /// Returns the nominal rolling radius R \[mm\].
    pub fn radius(&self) -> f64 {
        self.bodies.radius
    }

    /// Returns the distance \[mm\] from a roller's axle to the origin of its profile; `None` for a rail.
    pub fn roller(&self) -> Option<f64> {
        self.roller
    }

    /// Makes a search over this pair.
    pub fn search(&self) -> ContactSearch<'_> {
        ContactSearch { roller: self.roller, over_rail: RailSearch::new(&self.bodies), contacts: Vec::new() }
    }
}

impl Pose {
    /// Makes the pose of a wheel whose profile origin lies `offset` mm beside the rail's, + to the field
    /// side. The wheel is turned about that origin by `yaw` and then `roll` \[rad\], right-handed about z and
    /// y.
    ///
    /// # Errors
    /// Values that are not finite; angles beyond ±0.5 rad.
    pub fn new(offset: f64, yaw: f64, roll: f64) -> Result<Self> {
        finite("offset", offset)?;
        Ok(Self { offset, yaw: small_angle("yaw", yaw)?, roll: small_angle("roll", roll)? })
    }

    /// Gives the attitude of a wheel of this nominal rolling radius \[mm\].
    pub(super) fn attitude(&self, radius: f64) -> Attitude {
        Attitude::new(self.offset, self.yaw, self.roll, radius)
    }

    /// Returns the roll \[rad\].
    pub fn roll(&self) -> f64 {
        self.roll
    }

    /// Gives the rotation of the wheel about its profile origin: see [`wheel_rotation`].
    pub fn rotation(&self) -> Rotation3<f64> {
        wheel_rotation(self.yaw, self.roll)
    }
}

/// Gives the rotation A = R_y(roll) · R_z(yaw) of a wheel or wheelset, angles in rad: the yaw is applied first, the roll
/// second, about the unyawed y axis. It takes vectors (x, y, z) of the wheel, x along its axle, to the rail's axes.
pub fn wheel_rotation(yaw: f64, roll: f64) -> Rotation3<f64> {
    Rotation3::from_axis_angle(&Vector3::y_axis(), roll) * Rotation3::from_axis_angle(&Vector3::z_axis(), yaw)
}

/// Returns the angle \[rad\], or an error if it is larger than any wheel's.
pub(crate) fn small_angle(place: &str, angle: f64) -> Result<f64> {
    if finite(place, angle)?.abs() <= LARGEST_ANGLE {
        return Ok(angle);
    }
    let expected = format!("an angle within ±{LARGEST_ANGLE} rad");
    Err(Error::new(place, angle.to_string(), expected, "give angles in rad"))
}

/// Lowers the wheel of a pair onto its rail, and places the pair at the contact where it touches first.
///
/// Accuracy and degenerate cases are those of [`ContactSearch::touch`]. Cost: that of [`ProfilePair::new`], which many positions share,
/// of a search and of a placement.
///
/// # Errors
/// A wheel that is nowhere over its rail; a profile without a surface.
///
/// # Examples
/// ```
/// use wheelrail::{Pair, Pose, first_touch, inclination, standards};
///
/// let rail = standards::rail("60E1")?.rotated(inclination(1.0, 40.0)?);
/// let pair = Pair::new(rail, standards::wheel("S1002")?, 460.0)?;
/// let placement = first_touch(&pair, &Pose::new(0.0, 0.01, 0.0)?)?; // on the tread, yawed by 10 mrad
/// assert!((placement.rolling_radius() - 460.0).abs() < 1.0, "{}", placement.rolling_radius());
/// assert!(first_touch(&pair, &Pose::new(500.0, 0.0, 0.0)?).is_err()); // beside its rail
/// # Ok::<(), wheelrail::Error>(())
/// ```
pub fn first_touch(pair: &Pair, pose: &Pose) -> Result<Placement> {
    let profiles = ProfilePair::new(pair)?;
    let mut search = profiles.search();
    search.touch(pose, &Selection { within: 0.0, apart: ONE_CONTACT })?.contacts[0].placed(pair)
}

/// Says that a single wheel touches nothing where it stands.
pub(super) fn beside_its_rail() -> Error {
    no_contact("contact: offset", "a wheel over its rail", "check offset and signs")
}

/// Says that a list of slices defines no surface where wheels stand or would touch.
pub(super) fn over_hole(place: &str, wheels: &str) -> Error {
    let found = format!("a hole of the list: no surface under {wheels}");
    let expected = "a place where neighbouring slices show the same, or a list that gives its features";
    Error::new(place, found, expected, "take another place; the warnings about the list say why")
        .of_kind(ErrorKind::NoContact)
}

/// Says that a wheel or a wheelset touches nothing.
pub(super) fn no_contact(place: &str, expected: &str, advice: &str) -> Error {
    Error::new(place, "no contact", expected, advice).of_kind(ErrorKind::NoContact)
}

impl ContactSearch<'_> {
    /// Lowers a wheel until it touches.
    ///
    /// Accuracy: heights and gaps to a few roundings of the profiles' extents, whatever R; abscissae to that
    /// over √(difference of curvatures), from the common tangent, not from a flat minimum.
    /// Cost: about half a microsecond for arcs, a few for polynomials of any number; yaw doubles it. The
    /// first search has no place to start from and costs several times as much.
    /// Degenerate: bodies that touch along a stretch (parallel lines, equal arcs) give its middle.
    ///
    /// # Errors
    /// A wheel no part of which is over the rail, of the kind [`ErrorKind::NoContact`].
    pub fn touch(&mut self, pose: &Pose, selection: &Selection) -> Result<Touch<'_>> {
        let attitude = pose.attitude(self.over_rail.pair.radius);
        let height = -self.lower(&attitude, selection.within).ok_or_else(beside_its_rail)?.gap;
        Ok(self.collect(&attitude, height, selection))
    }

    /// Collects the contacts of `selection` among the candidates that [`Self::lower`] left, at the height
    /// that it gave.
    pub(super) fn collect(&mut self, attitude: &Attitude, height: f64, selection: &Selection) -> Touch<'_> {
        self.over_rail.candidates.retain(|c| c.gap + height <= selection.within);
        self.over_rail.candidates.sort_unstable_by(|a, b| a.gap.total_cmp(&b.gap));
        let apart = selection.apart.max(SAME_POINT * self.over_rail.pair.extent);
        // A smooth contact on a joint is also one of the joint's fan, a rounding away.
        let rounding = 16.0 * f64::EPSILON * self.over_rail.pair.extent;
        self.contacts.clear();
        for candidate in &self.over_rail.candidates {
            let contact = match self.roller_under(attitude) {
                Some(roller) => contact_on_roller(attitude, roller, candidate, height),
                None => contact(attitude, self.roller, candidate, height),
            };
            let near = |c: &&mut Contact| {
                (c.rail_x - contact.rail_x).abs() <= apart && (c.wheel_x - contact.wheel_x).abs() <= apart
            };
            match self.contacts.iter_mut().find(near) {
                None => self.contacts.push(contact),
                Some(kept) if kept.kink() && !contact.kink() && contact.gap - kept.gap <= rounding => {
                    *kept = Contact { gap: kept.gap, ..contact };
                }
                Some(_) => {}
            }
        }
        Touch { height, contacts: &self.contacts }
    }

    /// Returns the lowest candidate, and leaves all others up to `within` above it in the buffer.
    pub(super) fn lower(&mut self, attitude: &Attitude, within: f64) -> Option<Candidate> {
        match self.roller_under(attitude) {
            Some(roller) => lower_on_roller(&mut self.over_rail, attitude, roller, within),
            None => self.over_rail.lower(attitude, within),
        }
    }

    /// Returns the place of least gap near a former one at another attitude; `None` if it has left its two
    /// elements.
    pub(super) fn follow(&mut self, attitude: &Attitude, meeting: &Meeting) -> Option<Candidate> {
        match self.roller_under(attitude) {
            Some(roller) => at_own_turn(&mut self.over_rail, attitude, roller, meeting, None),
            None => self.over_rail.follow(attitude, meeting),
        }
    }

    /// Returns the radius \[mm\] of a roller on which a wheel of this attitude may touch off the crown; `None` where the search
    /// over a rail finds the contact.
    fn roller_under(&self, attitude: &Attitude) -> Option<f64> {
        self.roller.filter(|_| attitude.sin_yaw != 0.0 || attitude.along != 0.0)
    }

    /// Returns what this search has done so far.
    pub fn work(&self) -> Work {
        self.over_rail.work
    }
}

impl Contact {
    /// Returns whether one of the bodies touches with a kink, a step or an end.
    pub fn kink(&self) -> bool {
        self.rail_kink || self.wheel_kink
    }

    /// Gives the cosine of the angle between the common normal and the vertical.
    pub fn upright(&self) -> f64 {
        self.contact_angle.cos() * self.turn.cos()
    }

    /// Gives the slope of the wheel's path along the track where it rolls over this contact: that of the common tangent plane, + where it
    /// rises ahead.
    pub fn slope_along(&self) -> f64 {
        // 0 without a sign.
        0.0 - self.turn.tan() / self.contact_angle.cos()
    }

    /// Places the searched pair in contact here: contact frame along the common tangent, skew, and all that follows.
    ///
    /// Where a body touches with its smooth profile, ξ is the profile's own tangent to the last bit; at a kink, step or end
    /// it is the common tangent, and s has no second-order expansion at C.
    ///
    /// # Errors
    /// A contact of another pair, which has no point at these abscissae.
    ///
    /// # Examples
    /// ```
    /// use wheelrail::placement::Pair;
    /// use wheelrail::profile::standards;
    /// use wheelrail::search::{ONE_CONTACT, Pose, ProfilePair, Selection};
    ///
    /// let pair = Pair::new(standards::rail("60E1")?, standards::wheel("S1002")?, 460.0)?;
    /// let profiles = ProfilePair::new(&pair)?;
    /// let mut search = profiles.search();
    /// let selection = Selection { within: 0.0, apart: ONE_CONTACT };
    /// let touch = search.touch(&Pose::new(0.0, 0.01, 0.0)?, &selection)?;
    /// let placement = touch.contacts[0].placed(&pair)?;
    /// assert_eq!(placement.skew(), touch.contacts[0].skew);
    /// # Ok::<(), wheelrail::Error>(())
    /// ```
    pub fn placed(&self, pair: &Pair) -> Result<Placement> {
        let placed = pair.placed_along(
            [self.rail_x, self.contact_angle],
            [self.wheel_x, self.wheel_angle],
            self.skew,
        )?;
        Ok(placed.turned(self.turn))
    }

    /// Places wheel and rail, one of which is `body`, which varies, in contact here. `pair` has the other one, and any profile in place of
    /// `body`; `from` is the coordinate \[mm\] in the list of a rail's slices from which [`Self::y`] counts.
    ///
    /// The contact frame's ξ lies in the section across the track, and its ζ leans ahead by [`Self::turn`]. The profile of the body that
    /// varies is the section through C.
    ///
    /// # Errors
    /// A contact of another body, which has no surface here.
    pub fn placed_on(&self, pair: &Pair, body: &LoftedBody, from: f64) -> Result<Placement> {
        let nowhere = || {
            let expected = "a place of contact on this body";
            Error::new("contact", "no surface there", expected, "take the bodies that were searched")
        };
        let framed = match body {
            LoftedBody::Rail(loft) => {
                let origin = [self.rail_x, self.y + from, self.rail_z];
                FramedLoft::of_rail(Arc::clone(loft), origin, self.contact_angle, self.turn)?
            }
            LoftedBody::Wheel(wheel) => {
                let place = ([self.wheel_x, self.wheel_z], self.around);
                FramedLoft::of_wheel(wheel, place, [self.wheel_angle, self.lean, self.skew])?
            }
        };
        let (loft, foot) = (framed.loft(), framed.foot(0.0, 0.0).ok_or_else(nowhere)?);
        let reach = loft.strips[foot.strip].reach();
        let y = framed.along().clamp(reach.low, reach.high);
        let section = section_through(loft, foot.strip, [foot.place[0], y])?;
        let pair = match framed.side() {
            Side::Rail => pair.with_rail(section)?,
            Side::Wheel => pair.with_wheel(section.upside_down())?,
        };
        // At the end of a part the section may end a rounding before.
        let mut here = *self;
        let ([rail, wheel], side) = (pair.sections(), framed.side());
        let (section, x) = match side {
            Side::Rail => (rail, &mut here.rail_x),
            Side::Wheel => (wheel, &mut here.wheel_x),
        };
        *x = section.reach().ok_or_else(nowhere)?.nearest(*x);
        Ok(here.placed(&pair)?.with_loft(Arc::new(framed)))
    }
}

/// Makes the contact with a rail, or with the crown of a roller of this radius \[mm\].
fn contact(attitude: &Attitude, roller: Option<f64>, c: &Candidate, height: f64) -> Contact {
    let rolling_radius = attitude.radius - c.wheel.z;
    let sin = c.wheel.sin / attitude.cos_yaw;
    let unrolled_cos = ((1.0 - sin) * (1.0 + sin)).max(0.0).sqrt();
    Contact {
        rail_x: c.rail.x,
        wheel_x: c.wheel.x,
        rail_z: c.rail.z,
        wheel_z: c.wheel.z,
        // Without yaw y is 0, not −0.
        y: attitude.sin_yaw * (c.wheel.x - rolling_radius * c.wheel.sin / c.wheel.cos) + 0.0,
        turn: 0.0,
        around: 0.0,
        lean: 0.0,
        contact_angle: c.rail.angle(),
        wheel_angle: c.wheel.angle(),
        skew: attitude.sin_yaw.atan2(attitude.cos_yaw * unrolled_cos) + 0.0,
        gap: c.gap + height,
        rolling_radius,
        rail_curvature: c.rail_radius.recip(),
        wheel_curvature: c.wheel_radius.recip(),
        roller_curvature: roller.map_or(0.0, |radius| c.rail.cos / (radius + c.rail.z)),
        rail_kink: c.rail_radius == 0.0,
        wheel_kink: c.wheel_radius == 0.0,
    }
}

/// Makes the contact with a roller of this radius \[mm\], whose own meridian plane holds the common normal.
fn contact_on_roller(attitude: &Attitude, roller: f64, c: &Candidate, height: f64) -> Contact {
    let turn = c.meeting.turn;
    let seen = contact(&Meridian::new(attitude, roller, turn).attitude, Some(roller), c, height);
    Contact { y: (roller + c.rail.z) * turn.sin() - attitude.along, turn, ..seen }
}

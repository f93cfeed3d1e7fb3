//! The contact search: how far a placed wheel can be lowered onto its rail, and where it then touches.
//!
//! # Axes, signs and order of rotation
//!
//! Everything of one side is in the rail's profile axes: x towards the field side, y forward along the rail, z up.
//! For the right-hand wheel they are the track's directions; the left-hand side is solved as its mirror image
//! (x → −x), with lateral displacement, yaw and roll reversed; its axes are then left-handed.
//!
//! The wheel is turned by A = R_y(roll) · R_z(yaw): first the yaw about z, then the roll about the *unyawed* y axis of
//! the track, both by the right-hand rule. So the axle, from flange to field side, points along
//! (cosψ cosφ, sinψ, −cosψ sinφ).
//! A single wheel ([`Pose`]) is turned about its **profile origin**, the lowest point of the nominal running circle:
//! `offset` is where that origin lies, whatever the angles. A wheelset ([`wheelset`]) is turned about the middle of
//! its axle.
//!
//! # Method
//!
//! `locus`: the outline of the yawed wheel along the rail reduces the search to two plane curves. A local minimum of
//! the vertical gap has a common tangent (at kinks, steps and ends: a common normal within the fan). All such places
//! are found pair by pair of segments: in closed form or from guaranteed brackets for arcs and lines
//! (`arcs`), by interval bounds for polynomials (`polynomials`). So the lowest cannot be missed.
//!
//! What counts is the part of each profile that faces the other body in its own axes ([`Section`]): parts of a
//! wheel that face down only by virtue of the roll (a flange back beyond the vertical) do not take part.

mod arcs;
mod element;
mod isolate;
mod locus;
mod polynomials;
mod walk;
pub mod wheelset;

use crate::error::{Error, Result, finite};
use crate::profile::{Profile, Section, Side};
use element::Element;
use locus::Attitude;
use walk::{Candidate, Placed, Walk};

/// Share of the two profiles' extents below which two candidates are one point. Candidates of one contact that
/// sits on a joint differ by up to 1e-8 of it; the closest contacts that a drawing can mean are 1e-4 apart.
const SAME_POINT: f64 = 1e-7;

/// Largest yaw and roll \[rad\] that a pose may have. Far above any running gear's; from about 1 rad on, parts of a
/// profile that face down are no longer those that do so in the profile's own axes.
const LARGEST_ANGLE: f64 = 0.5;

/// A rail and a wheel profile, prepared for searches.
#[derive(Debug, Clone)]
pub struct ProfilePair {
    rail: Vec<Element>,
    wheel: Vec<Element>,
    rail_section: Section,
    wheel_section: Section,
    radius: f64,
    /// Sum of both extents: the size that rounding is judged by \[mm\].
    extent: f64,
}

/// Where a single wheel stands over its rail, but for the height.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    offset: f64,
    yaw: f64,
    roll: f64,
}

/// Places closer than this \[mm\] are one contact: drawings' steps and kinks make groups within 0.1 mm.
pub const ONE_CONTACT: f64 = 0.5;

/// Which of the places of contact to report.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Selection {
    /// Vertical gap \[mm\] above first touch up to which near misses are reported; 0 for touching ones only. Typically
    /// 0.1.
    pub within: f64,
    /// Of two places closer than this on both profiles \[mm along x\] only the lower is reported; 0 for all. Usually
    /// [`ONE_CONTACT`].
    pub apart: f64,
}

/// A place of contact or near miss; x and angles in the side's own profile axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// Abscissa x_R on the rail profile \[mm\], from its origin, + to the field side.
    pub rail_x: f64,
    /// Abscissa x_W on the wheel profile \[mm\], from its origin, + to the field side (a flange has −38).
    pub wheel_x: f64,
    /// Height of the rail's point over the rail profile's origin \[mm\].
    pub rail_z: f64,
    /// Height of the wheel profile's point over the wheel profile's origin \[mm\].
    pub wheel_z: f64,
    /// Place along the rail from the vertical plane across the track through the wheel's centre \[mm\], + forward:
    /// sinψ (x_W − ϱ tanθ_W). Behind the centre at a flange when yaw > 0.
    pub y: f64,
    /// Contact angle θ_R \[rad\]: of the common tangent in the rail's axes, + counter-clockwise from x to z. A flange
    /// contact has 1.2.
    pub contact_angle: f64,
    /// Wheel profile's tangent angle θ_W \[rad\] that belongs to the common normal, in the wheel profile's axes. Without
    /// yaw the contact angle plus the roll.
    pub wheel_angle: f64,
    /// Skew χ \[rad\]: how far the wheel's contact frame (ξ' along its meridian tangent, η' along its circumference,
    /// forward) is turned about the common normal ζ, + from ξ to η, against the rail's (ξ along its profile's
    /// tangent, η = y): ξ' = ξ cosχ + η sinχ, η' = η cosχ − ξ sinχ, ζ' = ζ. sinχ = sinψ/cosθ_W.
    pub skew: f64,
    /// Vertical gap left at first touch \[mm\]; 0 for the lowest.
    pub gap: f64,
    /// Actual rolling radius ϱ = R − z_W \[mm\].
    pub rolling_radius: f64,
    /// Curvature of the rail profile \[1/mm\], + hollow side up (a crown has −1/300); −∞ at a kink.
    pub rail_curvature: f64,
    /// Curvature of the wheel profile \[1/mm\], + hollow side up, −1/13 in a flange root; +∞ at a kink.
    pub wheel_curvature: f64,
    /// The rail touches with a kink, step or end: the contact angle is the common normal's, not that of a tangent.
    pub rail_kink: bool,
    /// The wheel touches with a kink, step or end; likewise θ_W.
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

/// Searches over one pair; keeps its buffers, so that searching allocates nothing.
#[derive(Debug, Clone)]
pub struct ContactSearch<'a> {
    pair: &'a ProfilePair,
    placed: Vec<Placed>,
    candidates: Vec<Candidate>,
    contacts: Vec<Contact>,
}

impl ProfilePair {
    /// Prepares a rail profile as placed (inclined) and a wheel profile with its nominal rolling radius R \[mm\].
    ///
    /// # Errors
    /// A radius that is not a number, or that does not reach beyond the wheel profile's highest point; a profile
    /// without any part that faces the other body.
    pub fn new(rail: &Profile, wheel: &Profile, radius: f64) -> Result<Self> {
        let rail_section = Section::own_axes(rail, Side::Rail);
        let wheel_section = Section::own_axes(wheel, Side::Wheel);
        for (section, profile) in [(&rail_section, rail), (&wheel_section, wheel)] {
            if section.pieces.is_empty() {
                let expected = "a profile travelled from left to right";
                return Err(Error::new(&profile.name, "no surface", expected, "reverse or mirror it"));
            }
        }
        let ends = wheel.segments().iter().flat_map(|s| [s.start().z, s.end().z]);
        let highest = ends.fold(0.0, f64::max);
        if finite("wheel radius", radius)? <= highest {
            let expected = format!("more than {highest} mm, the height of the wheel profile");
            return Err(Error::new("wheel radius", radius.to_string(), expected, "give R in mm"));
        }
        Ok(Self {
            rail: element::elements(rail, &rail_section, Side::Rail),
            wheel: element::elements(wheel, &wheel_section, Side::Wheel),
            rail_section,
            wheel_section,
            radius,
            extent: rail.extent() + wheel.extent(),
        })
    }

    /// Nominal rolling radius R \[mm\].
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// A search over this pair.
    pub fn search(&self) -> ContactSearch<'_> {
        ContactSearch { pair: self, placed: Vec::new(), candidates: Vec::new(), contacts: Vec::new() }
    }
}

impl Pose {
    /// A wheel with its profile origin `offset` mm beside the rail's, + to the field side, turned about that origin
    /// by `yaw` and then `roll` \[rad\], right-handed about z and y.
    ///
    /// # Errors
    /// Values that are not finite; angles beyond ±0.5 rad.
    pub fn new(offset: f64, yaw: f64, roll: f64) -> Result<Self> {
        finite("offset", offset)?;
        Ok(Self { offset, yaw: small_angle("yaw", yaw)?, roll: small_angle("roll", roll)? })
    }

    /// Roll \[rad\].
    pub fn roll(&self) -> f64 {
        self.roll
    }
}

/// Rejects angles that no wheel has.
pub(super) fn small_angle(place: &str, angle: f64) -> Result<f64> {
    if finite(place, angle)?.abs() <= LARGEST_ANGLE {
        return Ok(angle);
    }
    let expected = format!("an angle within ±{LARGEST_ANGLE} rad");
    Err(Error::new(place, angle.to_string(), expected, "give angles in rad"))
}

impl ContactSearch<'_> {
    /// Lowers a wheel until it touches; `None` when no part of it is over the rail.
    ///
    /// Accuracy: heights and gaps to a few roundings of the profiles' extents, whatever R; abscissae to that over
    /// √(difference of curvatures), from the common tangent, not from a flat minimum.
    /// Cost: about a microsecond for arcs, four with polynomials; yaw doubles or triples it.
    /// Degenerate: bodies that touch along a stretch (parallel lines, equal arcs) give its middle.
    pub fn touch(&mut self, pose: &Pose, selection: &Selection) -> Option<Touch<'_>> {
        let attitude = Attitude::new(pose.offset, pose.yaw, pose.roll, self.pair.radius);
        let height = self.lower(&attitude, selection.within)?;
        Some(self.collect(&attitude, height, selection))
    }

    /// The contacts of `selection` among the candidates that [`Self::lower`] left, at the height that it gave.
    fn collect(&mut self, attitude: &Attitude, height: f64, selection: &Selection) -> Touch<'_> {
        self.candidates.retain(|c| c.gap + height <= selection.within);
        self.candidates.sort_unstable_by(|a, b| a.gap.total_cmp(&b.gap));
        let apart = selection.apart.max(SAME_POINT * self.pair.extent);
        // A smooth contact on a joint is also one of the joint's fan, a rounding apart.
        let rounding = 16.0 * f64::EPSILON * self.pair.extent;
        self.contacts.clear();
        for candidate in &self.candidates {
            let contact = contact(attitude, candidate, height);
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

    /// Height of first touch, with all candidates up to `within` above it left in the buffer.
    fn lower(&mut self, attitude: &Attitude, within: f64) -> Option<f64> {
        let pair = self.pair;
        self.placed.clear();
        self.placed.extend(
            pair.wheel
                .iter()
                .enumerate()
                .filter_map(|(index, element)| walk::place(attitude, index, element)),
        );
        self.candidates.clear();
        let candidates = &mut self.candidates;
        let mut walk = Walk { pair, attitude, within, lowest: f64::INFINITY, candidates };
        walk.all(&self.placed);
        let lowest = walk.lowest;
        lowest.is_finite().then_some(-lowest)
    }

    /// The lowest candidate of the last search.
    fn lowest(&self) -> Option<&Candidate> {
        self.candidates.iter().min_by(|a, b| a.gap.total_cmp(&b.gap))
    }
}

impl Contact {
    /// Whether one of the bodies touches with a kink, a step or an end.
    pub fn kink(&self) -> bool {
        self.rail_kink || self.wheel_kink
    }
}

fn contact(attitude: &Attitude, c: &Candidate, height: f64) -> Contact {
    let rolling_radius = attitude.radius - c.wheel.z;
    let sin = c.wheel.sin / attitude.cos_yaw;
    let unrolled_cos = ((1.0 - sin) * (1.0 + sin)).max(0.0).sqrt();
    Contact {
        rail_x: c.rail.x,
        wheel_x: c.wheel.x,
        rail_z: c.rail.z,
        wheel_z: c.wheel.z,
        // Without yaw 0, not −0.
        y: attitude.sin_yaw * (c.wheel.x - rolling_radius * c.wheel.sin / c.wheel.cos) + 0.0,
        contact_angle: c.rail.angle(),
        wheel_angle: c.wheel.angle(),
        skew: attitude.sin_yaw.atan2(attitude.cos_yaw * unrolled_cos) + 0.0,
        gap: c.gap + height,
        rolling_radius,
        rail_curvature: c.rail_radius.recip(),
        wheel_curvature: c.wheel_radius.recip(),
        rail_kink: c.rail_radius == 0.0,
        wheel_kink: c.wheel_radius == 0.0,
    }
}

#[cfg(test)]
mod tests;

//! The contacts of a case: the chosen one, or those that a search finds.

use std::cell::OnceCell;

use nalgebra::Point2;
use serde::Serialize;

use super::contact::PlacedContact;
use super::input::{ApproachBy, Case, Place};
use crate::error::{Error, Result};
use crate::mesh::groups;
use crate::placement::Placement;
use crate::search;
use crate::search::{ONE_CONTACT, Selection, Touch};

/// Vertical gap \[mm\] up to which places of contact are looked for at least: any approach that a load makes.
const SEARCHED_GAP: f64 = 1.0;

/// What a wheel sinks by for an approach of 1 along the normal of a flange of 75°; flanges are not steeper.
const STEEPEST: f64 = 4.0;

/// Contacts of one wheel, and parts of one patch, beyond which nobody looks through their folders: the profiles are rough.
pub(super) const MOST_PARTS: usize = 100;

/// One contact to analyse.
pub(super) struct Placed {
    /// Subfolder of its files.
    pub folder: String,
    pub found: Option<Found>,
    pub contact: PlacedContact,
    /// ξ \[mm\] over which the part of its patch around C extends, with what is merged into it, once it was asked for.
    extent: OnceCell<Option<[f64; 2]>>,
}

/// How a contact was found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Found {
    /// "left" or "right" of a wheelset, "single" otherwise. The left side's axes are mirrored.
    pub side: &'static str,
    /// Height at first touch \[mm\], + up: of a wheelset's centre above R over the top of rail, of a single wheel's
    /// profile origin over the rail's.
    pub height_mm: f64,
    /// Roll \[rad\], solved or given.
    pub roll_rad: f64,
    /// Number on its side, from 1.
    pub contact: usize,
    /// This contact.
    pub place: PlaceOfContact,
    /// Other places on this side within `within` that are no contact of their own.
    pub near_misses: Vec<PlaceOfContact>,
}

/// A place of contact or near miss.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PlaceOfContact {
    /// Abscissa on the rail profile \[mm\].
    pub rail_x_mm: f64,
    /// Abscissa on the wheel profile \[mm\].
    pub wheel_x_mm: f64,
    /// Along the rail from the wheel's centre \[mm\].
    pub y_mm: f64,
    /// Contact angle in the rail profile's axes \[rad\].
    pub contact_angle_rad: f64,
    /// Rolling radius \[mm\].
    pub rolling_radius_mm: f64,
    /// Vertical gap at first touch \[mm\].
    pub gap_mm: f64,
    /// Whether a body touches with a kink, step or end.
    pub kink: bool,
}

impl Found {
    /// Names side and number, as messages call the contact.
    pub fn name(&self) -> String {
        match self.side {
            "single" => format!("contact {}", self.contact),
            side => format!("{side} side, contact {}", self.contact),
        }
    }
}

impl From<&search::Contact> for PlaceOfContact {
    fn from(c: &search::Contact) -> Self {
        Self {
            rail_x_mm: c.rail_x,
            wheel_x_mm: c.wheel_x,
            y_mm: c.y,
            contact_angle_rad: c.contact_angle,
            rolling_radius_mm: c.rolling_radius,
            gap_mm: c.gap,
            kink: c.kink(),
        }
    }
}

/// First touch of one side.
struct Side<'a> {
    name: &'static str,
    height: f64,
    roll: f64,
    touch: Touch<'a>,
}

/// Places the pair at every contact of a case, the first one first, with their names; computes no grid and no patch but
/// those that tell contacts apart.
///
/// # Errors
/// No contact, or more than anybody looks through; a load that no approach carries.
pub fn contacts(case: &Case) -> Result<Vec<(String, Placement)>> {
    // A chosen contact is one whatever the approach.
    let chosen = matches!(case.standing.place, Place::Points { .. });
    let placed = find(case, case.question.approach.filter(|_| !chosen))?;
    Ok(placed.into_iter().map(|place| (place.name(), place.contact.placement)).collect())
}

/// Finds all contacts of a case under an approach, the first one first.
///
/// # Errors
/// No contact, or more than anybody looks through; a load that no approach carries.
pub(super) fn find(case: &Case, approach: Option<ApproachBy>) -> Result<Vec<Placed>> {
    let sunk = match approach {
        Some(ApproachBy::Given(approach)) => STEEPEST * approach,
        _ => 0.0,
    };
    let within = SEARCHED_GAP.max(case.standing.within).max(sunk);
    let selection = Selection { within, apart: ONE_CONTACT };
    match &case.standing.place {
        Place::Points { rail_x, wheel_x } => {
            let placement = case.profiles.pair.placed(*rail_x, *wheel_x, 0.0)?;
            let contact = PlacedContact::new(placement, approach, case.question.modulus())?;
            Ok(vec![Placed { folder: String::new(), found: None, contact, extent: OnceCell::new() }])
        }
        Place::Wheel { profiles, pose } => {
            let mut search = profiles.search();
            let Some(touch) = search.touch(pose, &selection) else {
                return Err(no_touch("contact: offset", "a wheel over its rail", "check offset and signs"));
            };
            Side { name: "single", height: touch.height, roll: pose.roll(), touch }.contacts(case, approach)
        }
        Place::Wheelset { system, position } => {
            let mut search = system.search();
            let Some(touch) = search.touch(position, &selection)? else {
                let expected =
                    "wheels over their rails, and a roll within ±0.1 rad at which both sides touch";
                return Err(no_touch("wheelset: lateral", expected, "check lateral, gauge and signs"));
            };
            let mut all = Vec::new();
            // The right-hand side is the one that is described.
            for (name, side) in [("right", touch.sides[1]), ("left", touch.sides[0])] {
                let side = Side { name, height: side.z, roll: touch.roll, touch: side.touch };
                all.extend(side.contacts(case, approach)?);
            }
            Ok(all)
        }
    }
}

fn no_touch(place: &str, expected: &str, advice: &str) -> Error {
    Error::new(place, "no contact", expected, advice)
}

impl Side<'_> {
    /// Places the first touch, and every other place that the approach closes and that is not in the patch of one before.
    fn contacts(&self, case: &Case, asked: Option<ApproachBy>) -> Result<Vec<Placed>> {
        let within = case.standing.within;
        let mut placed: Vec<Placed> = Vec::new();
        let mut missed = Vec::new();
        for place in self.touch.contacts {
            let approach = match placed.first() {
                None => asked,
                Some(first) => {
                    let approach = approach_left(first, place);
                    if approach.is_some_and(|approach| approach <= 0.0)
                        || placed.iter().any(|p| p.holds(place, case.axes.merge))
                    {
                        missed.push(PlaceOfContact::from(place));
                        continue;
                    }
                    approach.map(ApproachBy::Given)
                }
            };
            if asked.is_some() || place.gap <= within {
                placed.push(self.contact(case, place, placed.len() + 1, approach)?);
            }
        }
        missed.retain(|place| place.gap_mm <= within);
        for found in placed.iter_mut().filter_map(|place| place.found.as_mut()) {
            found.near_misses.clone_from(&missed);
        }
        Ok(placed)
    }

    /// Places the contact with this number, from 1.
    fn contact(
        &self,
        case: &Case,
        place: &search::Contact,
        number: usize,
        approach: Option<ApproachBy>,
    ) -> Result<Placed> {
        if number > MOST_PARTS {
            let found = format!("more than {MOST_PARTS} places of contact of one wheel");
            let advice = "smooth the profiles, or give grid.merge";
            return Err(Error::new("contact", found, format!("at most {MOST_PARTS}"), advice));
        }
        let placement = place.placed(&case.profiles.pair)?;
        let found = Found {
            side: self.name,
            height_mm: self.height,
            roll_rad: self.roll,
            contact: number,
            place: place.into(),
            near_misses: Vec::new(),
        };
        let folder =
            if number == 1 { self.name.to_string() } else { format!("{}-contact-{number}", self.name) };
        let contact = PlacedContact::new(placement, approach, case.question.modulus())?;
        Ok(Placed { folder, found: Some(found), contact, extent: OnceCell::new() })
    }
}

/// Gives δ \[mm\] at another place of a side when the first contact approaches by its own δ₁ along its normal: the wheel sinks
/// by δ₁/cosθ₁, closes the gap at the place, and the rest counts along the place's normal. `None` without an approach.
fn approach_left(first: &Placed, place: &search::Contact) -> Option<f64> {
    let (approach, _) = first.contact.approach?;
    let sunk = approach / first.contact.placement.rail().point.station.cos;
    Some((sunk - place.gap) * place.contact_angle.cos())
}

impl Placed {
    /// Names the contact as messages call it: by side and number, or "contact" for a chosen one.
    pub(super) fn name(&self) -> String {
        self.found.as_ref().map_or_else(|| "contact".into(), Found::name)
    }

    /// Tells whether the part of this contact's patch around C, with what is merged into it, holds another place.
    fn holds(&self, place: &search::Contact, merge: f64) -> bool {
        let Some(patch) = self.contact.whole_patch() else { return false };
        let placement = &self.contact.placement;
        let frame = placement.rail().contact_frame();
        let xi = frame.inverse_transform_point(&Point2::new(place.rail_x, place.rail_z)).x;
        let around = || groups(patch, merge, None).first().map(|group| group.extent.xi);
        self.extent.get_or_init(around).is_some_and(|[from, to]| from <= xi && xi <= to)
    }
}

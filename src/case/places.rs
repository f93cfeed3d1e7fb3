//! The contacts of a scene: the chosen one, or those that a search finds.

use std::cell::OnceCell;

use nalgebra::Point2;
use serde::Serialize;

use super::analysis::{ApproachBy, Contact, Question};
use crate::error::{Error, Result};
use crate::mesh::axes;
use crate::placement::Pair;
use crate::scene::{Place, Standing};
use crate::search;
use crate::search::wheelset::WheelsetOnTrack;
use crate::search::{ONE_CONTACT, ProfilePair, Selection, Touch};

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
    pub contact: Contact,
    /// ξ over which the part of its patch around C extends, with what is merged into it, once it was asked for.
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
    /// Side and number, as messages call it.
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

/// One side of a search, as it is turned into contacts.
struct Side<'a> {
    name: &'static str,
    height: f64,
    roll: f64,
    touch: Touch<'a>,
    within: f64,
}

/// All contacts of a scene, the first one first.
pub(super) fn find(standing: &Standing, pair: &Pair, question: &Question) -> Result<Vec<Placed>> {
    let sunk = match question.approach {
        Some(ApproachBy::Given(approach)) => STEEPEST * approach,
        _ => 0.0,
    };
    let selection = Selection { within: SEARCHED_GAP.max(standing.within).max(sunk), apart: ONE_CONTACT };
    match standing.place {
        Place::Points { rail_x, wheel_x } => {
            let contact = Contact::new(pair.placed(rail_x, wheel_x, 0.0)?, question)?;
            Ok(vec![Placed { folder: String::new(), found: None, contact, extent: OnceCell::new() }])
        }
        Place::Wheel(pose) => {
            let profiles = ProfilePair::new(pair)?;
            let mut search = profiles.search();
            let Some(touch) = search.touch(&pose, &selection) else {
                return Err(no_touch("contact: offset", "a wheel over its rail", "check offset and signs"));
            };
            let side = Side {
                name: "single",
                height: touch.height,
                roll: pose.roll(),
                touch,
                within: standing.within,
            };
            side.contacts(pair, question)
        }
        Place::Wheelset { rails, wheels, position } => {
            let system = WheelsetOnTrack::new(pair, rails, wheels)?;
            let mut search = system.search();
            let Some(touch) = search.touch(&position, &selection)? else {
                let expected =
                    "wheels over their rails, and a roll within ±0.1 rad at which both sides touch";
                return Err(no_touch("wheelset: lateral", expected, "check lateral, gauge and signs"));
            };
            let mut all = Vec::new();
            // The right-hand side is the one that a scene describes.
            for (name, side) in [("left", touch.sides[0]), ("right", touch.sides[1])].into_iter().rev() {
                let (height, touch_of_side) = (side.z, side.touch);
                let side =
                    Side { name, height, roll: touch.roll, touch: touch_of_side, within: standing.within };
                all.extend(side.contacts(pair, question)?);
            }
            Ok(all)
        }
    }
}

fn no_touch(place: &str, expected: &str, advice: &str) -> Error {
    Error::new(place, "no contact", expected, advice)
}

impl Side<'_> {
    /// First touch, and every other place that the approach closes and that is not in the patch of one before.
    fn contacts(&self, pair: &Pair, question: &Question) -> Result<Vec<Placed>> {
        let mut placed: Vec<Placed> = Vec::new();
        let mut missed = Vec::new();
        for place in self.touch.contacts {
            let placement = place.placed(pair)?;
            let asked = match placed.first() {
                None => question.clone(),
                Some(first) => {
                    let approach = approach_left(first, place);
                    if approach.is_some_and(|approach| approach <= 0.0)
                        || placed.iter().any(|p| p.holds(place, question.merge))
                    {
                        missed.push(PlaceOfContact::from(place));
                        continue;
                    }
                    Question { approach: approach.map(ApproachBy::Given), ..question.clone() }
                }
            };
            if question.approach.is_none() && place.gap > self.within {
                continue;
            }
            let number = placed.len() + 1;
            if number > MOST_PARTS {
                let found = format!("more than {MOST_PARTS} places of contact of one wheel");
                let advice = "smooth the profiles, or give grid.merge";
                return Err(Error::new("contact", found, format!("at most {MOST_PARTS}"), advice));
            }
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
            let contact = Contact::new(placement, &asked)?;
            placed.push(Placed { folder, found: Some(found), contact, extent: OnceCell::new() });
        }
        missed.retain(|place| place.gap_mm <= self.within);
        for place in &mut placed {
            if let Some(found) = &mut place.found {
                found.near_misses.clone_from(&missed);
            }
        }
        Ok(placed)
    }
}

/// δ at another place of a side when the first contact approaches by its own along its normal: the wheel sinks by
/// δ₁/cosθ₁, closes the gap there, and the rest counts along that place's normal.
fn approach_left(first: &Placed, place: &search::Contact) -> Option<f64> {
    let (approach, _) = first.contact.approach?;
    let sunk = approach / first.contact.placement.rail().point.station.cos;
    Some((sunk - place.gap) * place.contact_angle.cos())
}

impl Placed {
    /// As [`Found::name`]; a chosen contact has no number.
    pub(super) fn name(&self) -> String {
        self.found.as_ref().map_or_else(|| "contact".into(), Found::name)
    }

    /// Whether the part of this contact's patch around C, with what is merged into it, holds another place.
    fn holds(&self, place: &search::Contact, merge: f64) -> bool {
        let Some(patch) = self.contact.whole_patch() else { return false };
        let placement = &self.contact.placement;
        let frame = placement.rail().contact_frame();
        let xi = frame.inverse_transform_point(&Point2::new(place.rail_x, place.rail_z)).x;
        let around = || axes::groups(patch, merge, None).first().map(|group| group.extent.xi);
        self.extent.get_or_init(around).is_some_and(|[from, to]| from <= xi && xi <= to)
    }
}

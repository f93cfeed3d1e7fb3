//! Doubts about the sites of a run: how their wheels stand, and how far bodies approach.

use super::doubts::Doubt;
use super::input::{Arrangement, Case};
use super::landmarks::{Landmarks, SideLandmarks, Touching};
use super::site::Site;
use super::usual;
use crate::error::Error;
use crate::search::TrackSide;

/// Puts the doubts about a scene before the advice of the error that it leads to: they are its likeliest cause.
pub(super) fn doubted(mut error: Error, doubts: &[Doubt]) -> Error {
    let causes: String = doubts.iter().map(|doubt| format!("{doubt}; ")).collect();
    error.advice.insert_str(0, &causes);
    error
}

/// Returns how far the other wheel of a site's axle is lifted \[mm\]; 0 for a single wheel.
pub(super) fn other_lift(site: &Site, all: &[Site], landmarks: &SideLandmarks) -> f64 {
    let first = |other: &&Site| other.contact.found.as_ref().is_some_and(|found| found.contact == 1);
    let other = all.iter().filter(first).find(|other| other.side() != site.side());
    other.map_or(0.0, |other| marks_of(other, landmarks).lift(&Touching::from(&other.contact.placement)))
}

fn marks_of<'a>(site: &Site, landmarks: &'a SideLandmarks) -> &'a Landmarks {
    landmarks.on(site.side().unwrap_or(TrackSide::Right))
}

/// Lists what is doubtful about a contact and its approach. `other` is the height \[mm\] of the other wheel's tread over its
/// rail, 0 for a single wheel.
pub(super) fn doubts_of(site: &Site, landmarks: &SideLandmarks, other: f64) -> Vec<Doubt> {
    let contact = &site.contact;
    // Further contacts of a wheel follow from the first one, which bears the doubts.
    let first = contact.found.as_ref().is_none_or(|found| found.contact == 1);
    let standing = || usual::standing(marks_of(site, landmarks), &contact.placement, other);
    let mut out = if first { standing() } else { Vec::new() };
    out.extend(contact.open_end().map(usual::profile_end));
    out.extend(contact.bridge().map(usual::unmeasured));
    let rail = contact.placement.rail().profile();
    out.extend(contact.approach.and_then(|approach| usual::approach(rail, approach, contact.is_loaded())));
    out
}

/// Gives the doubt about points chosen at tangents that differ; `None` where a search finds the contacts.
pub(super) fn doubts_of_placing(case: &Case, site: &Site) -> Option<Doubt> {
    let Arrangement::Points { .. } = case.setup.arrangement else { return None };
    usual::tilt("contact", &site.contact.placement)
}

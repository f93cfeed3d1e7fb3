//! Doubts about the sites of a run: how their wheels stand, and how far bodies approach.

use super::doubts::{Doubt, DoubtKind};
use super::input::{Case, Place};
use super::landmarks::{Landmarks, Touching};
use super::site::Site;
use crate::error::Error;
use crate::profile::trace;

/// Approaches outside of this range \[mm\] are no elastic ones: steel yields at a tenth of the larger one, and no load that a
/// wheel carries makes the smaller one.
const APPROACHES: std::ops::RangeInclusive<f64> = 1e-3..=1.0;

/// Largest difference of the tangents at chosen points that is no doubt \[degrees\]: wheels roll by less.
const TILT: f64 = 2.0;

/// Puts the doubts about a scene before the advice of the error that it leads to: they are its likeliest cause.
pub(super) fn doubted(mut error: Error, doubts: &[Doubt]) -> Error {
    let causes: String = doubts.iter().map(|doubt| format!("{doubt}; ")).collect();
    error.advice.insert_str(0, &causes);
    error
}

/// Returns how far the other wheel of a site's axle is lifted \[mm\]; 0 for a single wheel.
pub(super) fn other_lift(site: &Site, all: &[Site]) -> f64 {
    let first = |other: &&Site| other.contact.found.as_ref().is_some_and(|found| found.contact == 1);
    let other = all.iter().filter(first).find(|other| other.side() != site.side());
    other.map_or(0.0, |other| {
        let placement = &other.contact.placement;
        Landmarks::new(&placement.pair()).lift(&Touching::from(placement))
    })
}

/// Lists what is doubtful about a contact and its approach. `other` is the height \[mm\] of the other wheel's tread over its
/// rail, 0 for a single wheel.
pub(super) fn doubts_of(site: &Site, other: f64) -> Vec<Doubt> {
    // Further contacts of a wheel follow from the first one, which bears the doubts.
    let first = site.contact.found.as_ref().is_none_or(|found| found.contact == 1);
    let mut out = if first { of_contact(site, other) } else { Vec::new() };
    out.extend(approach(site));
    out
}

fn of_contact(site: &Site, other: f64) -> Vec<Doubt> {
    let placement = &site.contact.placement;
    let (marks, touching) = (Landmarks::new(&placement.pair()), Touching::from(placement));
    let doubts = marks.doubts(&touching, [marks.lift(&touching), other]);
    doubts.list().map(|(kind, value)| Doubt::of_contact(kind, value, placement.wheel_radius())).collect()
}

/// Lists what is doubtful about the way that bodies are placed.
pub(super) fn doubts_of_placing(case: &Case, site: &Site) -> Vec<Doubt> {
    let Place::Points { .. } = case.standing.place else { return Vec::new() };
    let placement = &site.contact.placement;
    let angles = [placement.rail(), placement.wheel()].map(|body| body.contact_angle().to_degrees());
    let tilt = angles[0] - angles[1];
    let text = format!("contact: the tangents at rail_x and wheel_x differ by {tilt:.2} degrees");
    Vec::from_iter((tilt.abs() > TILT).then(|| Doubt::new(DoubtKind::Tilt, text)))
}

fn approach(site: &Site) -> Option<Doubt> {
    let approach = site.contact.approach?;
    // Estimates are as small as their loads, which have doubts of their own; 0 asks for the geometry.
    let small = !site.contact.is_loaded() && approach > 0.0 && approach < *APPROACHES.start();
    if !small && approach <= *APPROACHES.end() {
        return None;
    }
    if small {
        let found =
            format!("an approach of {approach:e} mm, which would be {} mm if it were in m", 1e3 * approach);
        return Some(Doubt::new(DoubtKind::Approach, found));
    }
    let marks = trace(site.contact.placement.rail().profile(), 1.0);
    let heights = || marks.iter().map(|mark| mark.station.z);
    let height = heights().fold(f64::NEG_INFINITY, f64::max) - heights().fold(f64::INFINITY, f64::min);
    let beyond = if approach > height { ", more than the rail's profile is high" } else { "" };
    Some(Doubt::new(DoubtKind::Approach, format!("an approach of {approach:.4} mm{beyond}")))
}

//! What is possible in a result but seldom meant: each doubt with its number and its likely cause.

use super::input::{Case, Place};
use super::site::Site;
use crate::placement::Placement;
use crate::profile::{Profile, Shape, Station, trace};

/// Approaches beyond this \[mm\] are no elastic ones: steel yields at a tenth of it.
const LARGE_APPROACH: f64 = 1.0;

/// Largest difference of the tangents at chosen points that is not spoken of \[degrees\]: wheels roll by less.
const TILT: f64 = 2.0;

/// Largest difference of a tread's rolling radius from the nominal one that is not spoken of \[mm\].
const RADIUS_OFF: f64 = 15.0;

/// Contact angles below this \[degrees\] are those of treads.
const TREAD: f64 = 20.0;

/// Depth of the lowest point below the profile's origin from which on it is a flange's tip \[mm\].
const FLANGE: f64 = 10.0;

/// Height above the lowest point up to which a contact is on the tip \[mm\].
const TIP: f64 = 2.0;

/// Lists what is doubtful about a contact and its approach.
pub(super) fn doubts_of(site: &Site) -> Vec<String> {
    let placement = &site.contact.placement;
    [flange(placement), approach(site), rolling_radius(placement)].into_iter().flatten().collect()
}

/// Lists what is doubtful about the way that bodies are placed.
pub(super) fn doubts_of_placing(case: &Case, site: &Site) -> Vec<String> {
    let Place::Points { .. } = case.standing.place else { return Vec::new() };
    let placement = &site.contact.placement;
    let angles = [placement.rail(), placement.wheel()].map(|body| body.contact_angle().to_degrees());
    let tilt = angles[0] - angles[1];
    let text = format!(
        "contact: the tangents at rail_x and wheel_x differ by {tilt:.2} degrees: the wheel is tilted by as much to touch there; \
         [contact] offset finds the points at which it touches upright"
    );
    Vec::from_iter((tilt.abs() > TILT).then_some(text))
}

fn flange(placement: &Placement) -> Option<String> {
    let tip = lowest(placement.wheel().profile())?;
    let at = placement.wheel().point().station;
    if tip.z > -FLANGE {
        return None;
    }
    let place = if at.z < tip.z + TIP {
        "tip"
    } else if at.x < tip.x {
        "back"
    } else {
        return None;
    };
    Some(format!(
        "the wheel stands on the {place} of its flange, x = {:.2} mm on the wheel: check the offset, the gauge, the side that the \
         profiles' x points to (mirror), and the origin (a wheel measured from its flange back needs shift = [-70.0, 0.0])",
        at.x
    ))
}

/// Gives the lowest point of a profile, to a few tenths of a millimetre.
fn lowest(profile: &Profile) -> Option<Station> {
    let stations = profile.segments().iter().flat_map(|segment| match &segment.shape {
        Shape::Arc(arc) => [0.0, 0.25, 0.5, 0.75, 1.0].map(|share| arc.station_at(share)).to_vec(),
        Shape::Polynomial(_) => vec![segment.start(), segment.end()],
    });
    stations.min_by(|a, b| a.z.total_cmp(&b.z))
}

fn approach(site: &Site) -> Option<String> {
    let (approach, _) = site.contact.approach?;
    if approach <= LARGE_APPROACH {
        return None;
    }
    let marks = trace(site.contact.placement.rail().profile(), 1.0);
    let heights = || marks.iter().map(|mark| mark.station.z);
    let height = heights().fold(f64::NEG_INFINITY, f64::max) - heights().fold(f64::INFINITY, f64::min);
    let beyond = if approach > height { ", more than the rail's profile is high" } else { "" };
    Some(format!(
        "an approach of {approach:.4} mm{beyond}: wheels and rails approach each other by 0.05 to 0.2 mm; check the unit, mm for an \
         approach and N for a load"
    ))
}

fn rolling_radius(placement: &Placement) -> Option<String> {
    let (rolling, nominal) = (placement.rolling_radius(), placement.wheel_radius());
    let tread = placement.rail().contact_angle().to_degrees().abs() < TREAD;
    (tread && (rolling - nominal).abs() > RADIUS_OFF).then(|| {
        format!(
            "the rolling radius, {rolling:.2} mm, differs by {:.2} mm from wheel.radius: R is measured to the profile's origin, which \
             some drawings (APTA) have at the gauge point; give the radius there, or move the profile by shift or origin",
            rolling - nominal
        )
    })
}

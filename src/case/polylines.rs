//! The profiles of a case as pages draw them.

use super::input::{Profiles, SideProfiles};
use crate::export::{PagePair, PageProfile};
use crate::profile::{Profile, Station, trace};

/// Distance of a profile's points \[mm\].
const STEP: f64 = 0.25;

/// Most points of a profile, which only measured ones have more of.
const MOST_POINTS: usize = 1200;

/// Gives the profiles of all sides, the right-hand one's first.
pub(super) fn pairs(profiles: &Profiles) -> Vec<PagePair> {
    let pair = |side: &SideProfiles| {
        let [rail, wheel] = [side.pair.rail(), side.pair.wheel()].map(polyline);
        PagePair { rail, wheel, radius: side.pair.wheel_radius(), roller: side.pair.roller_radius() }
    };
    profiles.sides().map(|(_, side)| pair(side)).collect()
}

/// Gives a profile as a polyline; one of very many points is thinned.
fn polyline(profile: &Profile) -> PageProfile {
    let marks = thinned(&trace(profile, STEP), MOST_POINTS);
    let coordinate = |of: fn(&Station) -> f64| marks.iter().map(|mark| of(&mark.station)).collect();
    PageProfile { name: profile.name.clone(), x: coordinate(|s| s.x), z: coordinate(|s| s.z) }
}

/// Gives at most about `most` of some items, evenly chosen, the first and the last among them.
pub(super) fn thinned<T: Copy>(items: &[T], most: usize) -> Vec<T> {
    let stride = items.len().div_ceil(most).max(1);
    let mut kept: Vec<T> = items.iter().step_by(stride).copied().collect();
    if stride > 1 && !(items.len() - 1).is_multiple_of(stride) {
        kept.extend(items.last());
    }
    kept
}

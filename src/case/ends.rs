//! Open ends of profiles: what stands beyond was not measured or drawn, so that a contact there is none that can be trusted.

use nalgebra::Point2;

use crate::lofted::{Loft, LoftedBody, ends};
use crate::patch::{Component, Patch};
use crate::placement::{Body, Pair, Placement};
use crate::profile::{Profile, Side};
use crate::search::Contact;
use crate::separation::Evaluator;

/// Distance \[mm\] from an end within which a contact lies on it. Searches put it there to some roundings; a file's points are that far
/// apart at least.
const ON_END: f64 = 1e-6;

/// Distance \[mm\] to either side of an end at which s tells whether the end is in the patch: more than the ends of a wheel in the frame
/// are off, less than what a patch shows.
const BESIDE: f64 = 1e-3;

/// Difference of s \[mm\] across an end over which one surface goes on: over twice [`BESIDE`] a face of 85° rises by less.
const GOES_ON: f64 = 0.03;

/// Places along an end at which s is asked for.
const PLACES: usize = 33;

/// An open end of a profile in a contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OpenEnd {
    /// The body whose profile ends.
    pub side: Side,
    /// Abscissa of the end on its profile \[mm\].
    pub x: f64,
}

/// The open ends of both profiles of a pair, one of which may vary.
#[derive(Debug, Clone)]
pub(super) struct OpenEnds {
    /// Those of the rail's profile and of the wheel's.
    drawn: [[Point2<f64>; 2]; 2],
    varying: Option<LoftedBody>,
}

impl OpenEnds {
    /// Lists the ends of a pair; `varying` is its body that is no swept profile.
    pub fn new(pair: &Pair, varying: Option<&LoftedBody>) -> Self {
        Self { drawn: [pair.rail(), pair.wheel()].map(of_profile), varying: varying.cloned() }
    }

    /// Tells whether a body touches with an end.
    pub fn hold(&self, contact: &Contact) -> bool {
        let places = [(contact.rail_x, contact.rail_z), (contact.wheel_x, contact.wheel_z)];
        let near = |k: usize| {
            let at = Point2::new(places[k].0, places[k].1);
            self.drawn[k].iter().any(|end| (at - end).norm() <= ON_END)
        };
        match &self.varying {
            None => near(0) || near(1),
            Some(LoftedBody::Rail(loft)) => (contact.rail_kink && on_an_end(loft, places[0])) || near(1),
            Some(LoftedBody::Wheel(wheel)) => {
                let here = || ends(&wheel.loft, contact.around * wheel.radius);
                let on = |end: [f64; 2]| (end[0] - contact.wheel_x).abs() <= ON_END;
                near(0) || (contact.wheel_kink && here().into_iter().any(on))
            }
        }
    }
}

fn of_profile(profile: &Profile) -> [Point2<f64>; 2] {
    let ends = [profile.segments().first().map(|s| s.start()), profile.segments().last().map(|s| s.end())];
    ends.map(|end| end.map_or(Point2::new(f64::NAN, f64::NAN), |end| Point2::new(end.x, end.z)))
}

/// Tells whether a point (x, z) \[mm\] lies on an end of a rail's slices, wherever along the track.
fn on_an_end(loft: &Loft, (x, z): (f64, f64)) -> bool {
    /// Steps into which the way between two slices is divided; distances have one lowest place within two of them.
    const STEPS: usize = 8;
    /// Thirds that are left out: the rest is a rounding.
    const THIRDS: usize = 80;
    let far = |end: [f64; 2]| (end[0] - x).hypot(end[1] - z);
    let distance = |y: f64| ends(loft, y).into_iter().map(far).fold(f64::INFINITY, f64::min);
    let mut bays = loft.strips.iter().flat_map(|strip| strip.bays().map(|bay| bay.y()));
    bays.any(|bay| {
        // Ends run along the track, or flare by less than its length.
        if distance(bay.low + 0.5 * bay.width()) > bay.width() {
            return false;
        }
        let at = |k: usize| bay.low + bay.width() * k as f64 / STEPS as f64;
        let nearest = (0..=STEPS).min_by(|a, b| distance(at(*a)).total_cmp(&distance(at(*b)))).unwrap_or(0);
        let (mut low, mut high) = (at(nearest.saturating_sub(1)), at((nearest + 1).min(STEPS)));
        for _ in 0..THIRDS {
            let third = (high - low) / 3.0;
            if distance(low + third) < distance(high - third) { high -= third } else { low += third }
        }
        distance(0.5 * (low + high)) <= ON_END
    })
}

/// Finds an open end at C, or in the patch: the end of a profile that is in contact, or that cuts the patch off. Ends that another part of
/// the same body covers do not count.
pub(super) fn end_in_contact(placement: &Placement, patch: Option<&Patch>) -> Option<OpenEnd> {
    let mut evaluator = Evaluator::new(placement);
    let listed = listed(placement, patch);
    let at_contact =
        |[xi, eta, zeta]: [f64; 3]| placement.is_at_contact() && xi.hypot(eta).hypot(zeta) <= ON_END;
    // Parts of the patch away from C are contacts of their own.
    let holds = |part: &&Component, xi: f64, eta: f64| {
        part.xi.grown(BESIDE).contains(xi) && part.eta.grown(BESIDE).contains(eta)
    };
    let parts = || patch.into_iter().flat_map(|patch| &patch.components);
    let of_contact = placement.is_at_contact() && parts().any(|part| holds(&part, 0.0, 0.0));
    let own: Vec<&Component> = parts().filter(|part| !of_contact || holds(part, 0.0, 0.0)).collect();
    let mut cut_off = |[xi, eta, _]: [f64; 3]| {
        let Some(patch) = patch.filter(|_| own.iter().any(|part| holds(part, xi, eta))) else { return false };
        let [before, behind] = [-BESIDE, BESIDE].map(|beside| evaluator.separation(xi + beside, eta));
        // NaN stands for no surface.
        let ends =
            |here: f64, there: f64| here < patch.approach && (there.is_nan() || there - here > GOES_ON);
        ends(before, behind) || ends(behind, before)
    };
    listed.into_iter().find(|(_, at)| at_contact(*at) || cut_off(*at)).map(|(end, _)| end)
}

/// Lists the ends of both bodies with points of each, (ξ, η, ζ) \[mm\] in the frame.
fn listed(placement: &Placement, patch: Option<&Patch>) -> Vec<(OpenEnd, [f64; 3])> {
    let reach = patch.and_then(Patch::extent).map(|extent| extent.eta);
    let along: Vec<f64> = reach.map_or_else(Vec::new, |eta| {
        (0..PLACES).map(|k| eta.low + eta.width() * k as f64 / (PLACES - 1) as f64).collect()
    });
    let mut out = Vec::new();
    for (side, body) in [(Side::Rail, placement.rail()), (Side::Wheel, placement.wheel())] {
        if let Some(lofted) = placement.lofted().filter(|lofted| lofted.side() == side) {
            let places = along.iter().map(|eta| lofted.along_at(0.0, *eta)).chain([lofted.along()]);
            for y in places {
                let point = |at: [f64; 2]| (OpenEnd { side, x: at[0] }, lofted.seen_from(at, y));
                out.extend(ends(lofted.loft(), y).into_iter().map(point));
            }
            continue;
        }
        for end in of_profile(body.profile()) {
            let at = body.contact_frame().inverse_transform_point(&end);
            let place = |eta: &f64| (OpenEnd { side, x: end.x }, place(placement, (side, body), at, *eta));
            out.extend([0.0].iter().chain(&along).map(place));
        }
    }
    out
}

/// Gives the point of an end's line or circle at η \[mm\], whose point of the midplane is (ξ, ζ).
fn place(placement: &Placement, (side, body): (Side, &Body), at: Point2<f64>, eta: f64) -> [f64; 3] {
    if side == Side::Rail {
        return [at.x, eta, at.y];
    }
    // The wheel's circles rise by e along the radius, and stand skewed.
    let (sin, cos) = body.contact_angle().sin_cos();
    let radius = placement.rolling_radius();
    let rise = eta * eta / (radius + (radius * radius + eta * eta).sqrt());
    let skew = placement.skew_rotation();
    let [across, ahead] = [at.x + rise * sin, eta];
    [skew.re * across - skew.im * ahead, skew.im * across + skew.re * ahead, at.y + rise * cos]
}

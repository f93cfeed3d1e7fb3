//! How far patches of measured profiles reach along the track, where corners of the boundary crowd.

use crate::campaign;
use wheelrail::Interval;
use wheelrail::internal::Random;
use wheelrail::measured::{self, CurveKind};
use wheelrail::patch::{Component, Patch, Window};
use wheelrail::placement::Pair;
use wheelrail::profile::{Profile, Side, standards, trace};
use wheelrail::search::{ONE_CONTACT, Pose, ProfilePair, Selection};
use wheelrail::separation::Evaluator;

/// Standard deviation of the points, and their distance \[mm\].
const NOISE: f64 = 2e-3;
const STEP: f64 = 0.25;

/// Patches of one pair of measured profiles.
const OF_ONE: u64 = 20;

/// Places on a line, and its distance from the boundary as a share of η.
const PLACES: usize = 400;
const BEYOND: f64 = 1e-7;

/// Rounding of s \[mm\].
const ROUNDING: f64 = 1e-11;

/// A built-in profile as an instrument might have measured it.
fn measured(drawn: &Profile, side: Side, dice: &mut Random) -> Profile {
    let points: Vec<[f64; 2]> = trace(drawn, STEP)
        .iter()
        .map(|mark| [mark.station.x, mark.station.z + NOISE * dice.normal()])
        .collect();
    let mut apart: Vec<[f64; 2]> = Vec::new();
    for [x, z] in points {
        if apart.last().is_none_or(|last| (last[0] - x).hypot(last[1] - z) > 0.4 * STEP) {
            apart.push([x, z]);
        }
    }
    let options = measured::Options {
        curve: Some(CurveKind::Smoothing),
        mirror: Some(false),
        flip_z: Some(false),
        ..measured::Options::default()
    };
    measured::of_points("measured", &apart, side, &options).expect("points of a profile").profile
}

/// Checks that s is not below δ just beyond the largest η of a component.
fn reaches(name: &str, component: &Component, bodies: &mut Evaluator<'_>, approach: f64) {
    let eta = component.eta.high;
    let near = component.boundary.iter().filter(|[_, y]| *y > 0.999 * eta).map(|[xi, _]| *xi);
    let near = near.fold(Interval::NONE, Interval::with);
    let least = (0..=PLACES)
        .map(|k| bodies.separation(near.step(k, PLACES), eta * (1.0 + BEYOND)))
        .fold(f64::INFINITY, f64::min);
    assert!(least > approach - ROUNDING, "{name}: s = δ − {:e} beyond η = {eta}", approach - least);
}

#[test]
fn no_measured_patch_reaches_beyond_its_extent() {
    let (mut parts, mut number) = (0, 0);
    while number < campaign::scenes() {
        let dice = &mut Random::new(number);
        let drawn =
            [standards::rail("60E1"), standards::wheel("S1002")].map(|drawn| drawn.expect("a profile"));
        let [rail, wheel] =
            [(0, Side::Rail), (1, Side::Wheel)].map(|(k, side)| measured(&drawn[k], side, dice));
        let pair = Pair::new(rail, wheel, 460.0).expect("a pair");
        let places = ProfilePair::new(&pair).expect("a pair with surfaces");
        for _ in 0..OF_ONE.min(campaign::scenes() - number) {
            number += 1;
            let (offset, approach) = (dice.between(-9.0, 9.0), 10f64.powf(dice.between(-3.0, 0.2)));
            let pose = Pose::new(offset, 0.0, 0.0).expect("small angles");
            let mut search = places.search();
            let touch = search.touch(&pose, &Selection { within: 0.0, apart: ONE_CONTACT });
            let contact = touch.expect("a contact").contacts[0];
            let placement = contact.placed(&pair).expect("a placed pair");
            let mut bodies = Evaluator::new(&placement);
            let patch = Patch::new(&placement, approach, &Window::UNBOUNDED);
            for component in &patch.components {
                parts += 1;
                let name = format!("patch {number}, offset {offset}, δ = {approach}");
                reaches(&name, component, &mut bodies, approach);
            }
        }
    }
    assert!(parts >= campaign::scenes(), "{parts} parts");
}

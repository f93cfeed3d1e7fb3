//! Patches of yawed wheels over polynomials of any degree, on rails and rollers, against a flood fill, and their feasibility against its
//! least s.

use std::path::Path;

use crate::campaign;
use crate::common::repository;
use crate::flood_fill::{Case, Open, check, check_all};
use wheelrail::Interval;
use wheelrail::case::{Run, SILENT, contacts};
use wheelrail::internal::Random;
use wheelrail::load::feasibility;
use wheelrail::patch::{Patch, Window};
use wheelrail::placement::{Pair, Placement};
use wheelrail::profile::{Arc, Half, Polynomial, Profile, Segment, Shape};
use wheelrail::scene;
use wheelrail::search::{ONE_CONTACT, Pose, ProfilePair, Selection};
use wheelrail::separation::{Evaluator, Method};

/// Points on an axis of the grid whose least s is compared with that of [`feasibility`].
const POINTS: usize = 160;

/// Distance of the places \[mm\] at which the least s is looked at.
const BESIDE: f64 = 1e-9;

/// Largest difference of s \[mm\] that counts as rounding.
const ROUNDING: f64 = 1e-10;

/// A polynomial over [−half, half], `bend` mm from its chord or so.
fn coefficients(dice: &mut Random, half: f64, bend: f64) -> Vec<f64> {
    if dice.below(4) == 0 {
        // Two wells of one depth, or nearly.
        let b = half * dice.between(0.2, 0.9);
        let scale = bend / b.powi(4);
        let tilt = *dice.pick(&[0.0, 1e-6, 1e-3]) * dice.normal();
        return vec![scale * b.powi(4), tilt, -2.0 * scale * b * b, 0.0, scale];
    }
    let degree = 2 + dice.below(7);
    (0..=degree).map(|k| bend * dice.normal() / half.powi(k as i32)).collect()
}

/// A profile of one to three polynomials with kinks, and steps by vertical lines, where they meet.
fn polynomials(dice: &mut Random, half: f64, bend: f64) -> Option<Profile> {
    let count = *dice.pick(&[1, 1, 2, 3]);
    let mut segments: Vec<Segment> = Vec::new();
    for k in 0..count {
        let at = |k: usize| -half + 2.0 * half * k as f64 / count as f64;
        let x = [at(k), at(k + 1)];
        let mut c = coefficients(dice, half, bend);
        let curve = Polynomial::graph(&c, x).ok()?;
        if let Some(last) = segments.last().map(Segment::end) {
            let step = if dice.below(4) == 0 { bend * dice.between(-0.5, 0.5) } else { 0.0 };
            c[0] += last.z + step - curve.station(curve.range()[0]).z;
            if step != 0.0 {
                segments.push(Segment::arc(Arc::line([x[0], last.z], [x[0], last.z + step]).ok()?));
            }
        }
        let shape = Shape::Polynomial(Polynomial::graph(&c, x).ok()?);
        segments.push(Segment { label: String::new(), shape });
    }
    Profile::new("polynomials", "test", segments).ok()
}

fn plain(dice: &mut Random, half: f64) -> Option<Profile> {
    let arc = if dice.below(2) == 0 {
        Arc::line([-half, 0.0], [half, 0.0])
    } else {
        let radius = *dice.pick(&[80.0, 300.0, 2000.0]);
        Arc::about([0.0, -radius], radius, Half::Upper, [-half, half])
    };
    Profile::new("plain", "test", vec![Segment::arc(arc.ok()?)]).ok()
}

/// A yawed pair of which one body or both are polynomials, lowered until it touches or put together at two points.
fn case(number: u64, on_roller: bool) -> Option<Case> {
    let mut dice = Random::new(number ^ 0x706f_6c79);
    let half = *dice.pick(&[8.0, 20.0, 40.0]);
    let bend = 10f64.powf(dice.between(-2.0, 0.0));
    let (rail, wheel) = match dice.below(4) {
        0 => (
            polynomials(&mut dice, half, bend)?,
            Profile::new(
                "line",
                "test",
                vec![Segment::arc(Arc::line([-1.3 * half, 0.0], [1.3 * half, 0.0]).ok()?)],
            )
            .ok()?,
        ),
        1 => (polynomials(&mut dice, 1.2 * half, bend)?, polynomials(&mut dice, half, bend)?),
        _ => (plain(&mut dice, 1.3 * half)?, polynomials(&mut dice, half, bend)?),
    };
    let pair = Pair::new(rail, wheel, dice.between(200.0, 600.0)).ok()?;
    let pair = if on_roller { pair.on_roller(dice.between(200.0, 600.0)).ok()? } else { pair };
    let yaw = dice.between(-1.0, 1.0) * *dice.pick(&[2e-4, 5e-3, 0.04, 0.1]);
    let placement = if dice.below(5) == 0 {
        pair.placed(dice.between(-half, half), dice.between(-half, half), yaw).ok()?
    } else {
        let profiles = ProfilePair::new(&pair).ok()?;
        let mut search = profiles.search();
        let pose = Pose::new(dice.between(-1.0, 1.0), yaw, 0.0).ok()?;
        let touch = search.touch(&pose, &Selection { within: 0.0, apart: ONE_CONTACT }).ok()?;
        touch.contacts.first()?.placed(&pair).ok()?
    };
    let approach = bend * 10f64.powf(dice.between(-2.5, 0.0));
    let long = 2.5 * (2.0 * placement.rolling_radius() * (approach + bend)).sqrt();
    let mut ends = |wide: f64, cut: f64| {
        let share = *dice.pick(&[1.0, 1.0, cut]);
        Interval::new(-wide * share, wide * dice.between(share, 1.0))
    };
    let window = Window { xi: ends(1.5 * half, 0.3), eta: ends(long, 0.2) };
    Some(Case {
        name: format!("polynomials {number}{}", if on_roller { " on a roller" } else { "" }),
        placement,
        approach,
        window,
        method: Method::Pointwise,
    })
}

/// Feasibility against the least s of a grid over the whole of both bodies, and against s where it says it is.
fn check_feasibility(case: &Case) {
    let found = feasibility(&case.placement);
    let reach = [case.placement.rail(), case.placement.wheel()].map(|body| body.section().reach());
    let [Some(rail), Some(wheel)] = reach else { return };
    let wide = 0.6 * case.placement.rolling_radius();
    let xi = rail.cut(wheel.grown(30.0));
    let filled = case.filled(&Window { xi, eta: Interval::symmetric(wide.min(60.0)) }, POINTS);
    let least = filled.depth.iter().fold(f64::INFINITY, |least, depth| depth.min(least)) + case.approach;
    if least.is_infinite() {
        return;
    }
    let found = found.unwrap_or_else(|| panic!("{}: bodies that do not meet, s = {least}", case.name));
    let (s, feasible) = (found.least_separation_mm, found.feasible);
    assert!(s <= least + ROUNDING, "{}: least s {s}, on the grid {least}", case.name);
    assert!(!feasible || least > -ROUNDING, "{}: feasible, on the grid {least}", case.name);
    // Beside a step rounding decides on which side of it a place is. Where a surface stands upright, s is a square root of the
    // distance, of which twice the slope times the distance is the change.
    let mut evaluator = Evaluator::new(&case.placement);
    let near = [-BESIDE, 0.0, BESIDE];
    let places = near.iter().flat_map(|xi| near.map(|eta| [found.at_xi_mm + xi, found.at_eta_mm + eta]));
    let there = places.map(|[xi, eta]| evaluator.separation_and_gradient(xi, eta));
    let lowest = there.filter(|(there, _)| !there.is_nan()).min_by(|a, b| a.0.total_cmp(&b.0));
    let Some((there, slopes)) = lowest else { return };
    let allowed = 1e-7 + 3.0 * BESIDE * (slopes[0].abs() + slopes[1].abs());
    assert!((there - s).abs() < allowed, "{}: {s}, {there} there", case.name);
}

fn both(case: &Case) -> Open {
    check_feasibility(case);
    check(case)
}

#[test]
fn patches_over_polynomials_are_what_a_flood_fill_finds() {
    check_all(5 * campaign::scenes(), &[], |number| case(number, false), both);
}

/// Hollow kinks, steps and ends divide the lines of rollers, too.
#[test]
fn patches_on_rollers_over_polynomials_are_what_a_flood_fill_finds() {
    check_all(campaign::scenes(), &[], |number| case(number, true), both);
}

/// The first contacts of a scene of `tests/defects`, as cases of its own approach and grid.
fn scene_cases(name: &str) -> Vec<Case> {
    let path = repository("tests/defects").join(name);
    let text = std::fs::read_to_string(&path).expect("a scene");
    let scene: scene::Scene = scene::parse(&text, true).expect("a scene");
    let resolved = scene::resolve(&scene, Path::new("."), name).expect("a case");
    let approach = scene.patch.as_ref().and_then(|patch| patch.approach).expect("an approach");
    let case = |placement: Placement| {
        let window = Window { xi: Interval::symmetric(40.0), eta: Interval::symmetric(30.0) };
        Case { name: name.into(), placement, approach, window, method: Method::Pointwise }
    };
    contacts(&resolved).expect("contacts").into_iter().map(|(_, placement)| case(placement)).collect()
}

/// Scenes over which parts of a patch were missed, or an overlap.
#[test]
fn scenes_with_parts_that_were_missed() {
    for name in [
        "yawed-feasible-but-overlap.json",
        "yawed-patch-cubic.json",
        "yawed-patch-double-well.json",
        "yawed-patch-empty-though-feasible.json",
        "yawed-patch-end.json",
        "yawed-patch-least.json",
        "yawed-patch-missed-minimal.json",
    ] {
        let cases = scene_cases(name);
        assert!(!cases.is_empty(), "{name}: no contact");
        for case in &cases {
            both(case);
            assert!(
                !Patch::new(&case.placement, case.approach, &Window::UNBOUNDED).components.is_empty(),
                "{name}"
            );
        }
        let text = std::fs::read_to_string(repository("tests/defects").join(name)).expect("a scene");
        let scene = scene::parse(&text, true).expect("a scene");
        let run = scene::resolve(&scene, Path::new("."), name).and_then(|case| Run::new(case, SILENT));
        for part in &run.expect("a run").parts {
            let empty = part.analysis.patch.as_ref().is_none_or(|patch| patch.components.is_empty());
            assert!(!empty, "{name}: found a contact, and no patch");
        }
    }
}

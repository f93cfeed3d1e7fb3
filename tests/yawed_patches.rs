//! Patches under yawed wheels against every point of lines of constant ξ.

#![allow(clippy::panic, clippy::expect_used, reason = "a test may fail")]

mod common;

use std::path::Path;
use std::time::{Duration, Instant};

use common::{profile, references};
use wheelrail::interpenetration::{End, Patch, Slicer, Window};
use wheelrail::mesh::strips::{Counts, StripMesh};
use wheelrail::numerics::roots::bracketed;
use wheelrail::placement::{Pair, Placement};
use wheelrail::profile::{Arc, Half, Profile, Section, Side, standards};
use wheelrail::run::Run;
use wheelrail::scene;
use wheelrail::separation::Evaluator;

/// Points of a line of constant ξ at which s is looked at.
const POINTS: usize = 600;

/// Lines of constant ξ over a patch, and beyond it by this share on each side.
const LINES: usize = 60;
const MARGIN: f64 = 0.05;

/// What is looked at \[mm\].
const NEAR: Window = Window { xi: [-8.0, 8.0], eta: [-15.0, 15.0] };

/// No scene may take longer, on a loaded machine.
const LONGEST: Duration = Duration::from_secs(20);

/// All intervals of η in which s < δ, but for those between two of the points.
fn scanned(evaluator: &mut Evaluator<'_>, xi: f64, [from, to]: [f64; 2], delta: f64) -> Vec<[f64; 2]> {
    let mut inside = |eta: f64| evaluator.separation(xi, eta) < delta;
    let eta = |k: usize| from + (to - from) * k as f64 / POINTS as f64;
    let mut intervals: Vec<[f64; 2]> = Vec::new();
    let mut before = inside(from);
    intervals.extend(before.then_some([from, to]));
    for k in 1..=POINTS {
        let here = inside(eta(k));
        if here != before {
            let side = |eta: f64| if inside(eta) == before { -1.0 } else { 1.0 };
            let change = bracketed(side, eta(k - 1), eta(k)).expect("a change");
            match intervals.last_mut().filter(|_| before) {
                Some(last) => last[1] = change,
                None => intervals.push([change, to]),
            }
        }
        before = here;
    }
    intervals
}

/// The slices of all components at ξ.
fn sliced(patch: &Patch, slicer: &mut Slicer<'_>, xi: f64) -> Vec<[f64; 2]> {
    let [from, to] = patch.window.eta;
    let here = patch.components.iter().filter(|c| c.xi[0] <= xi && xi <= c.xi[1]);
    let mut all: Vec<[f64; 2]> = here.filter_map(|c| slicer.slice_in(c, xi)).map(|slice| slice.eta).collect();
    all.sort_by(|a, b| a[0].total_cmp(&b[0]));
    all.into_iter().map(|[a, b]| [a.max(from), b.min(to)]).filter(|[a, b]| a < b).collect()
}

fn widths(intervals: &[[f64; 2]]) -> f64 {
    intervals.iter().map(|[a, b]| b - a).sum()
}

/// Checks a patch near C line by line, its area, loops and mesh; the patch.
fn check(name: &str, placement: &Placement, delta: f64) -> Patch {
    let patch = Patch::new(placement, delta, &NEAR);
    let extent = patch.extent().unwrap_or_else(|| panic!("{name}: empty"));
    let wider = |[a, b]: [f64; 2], [from, to]: [f64; 2]| {
        let margin = MARGIN * (b - a);
        [(a - margin).max(from), (b + margin).min(to)]
    };
    let [xi, eta] = [wider(extent.xi, NEAR.xi), wider(extent.eta, NEAR.eta)];
    let (mut evaluator, mut slicer) = (Evaluator::new(placement), Slicer::new(placement, delta));
    let (step, fine) = ((xi[1] - xi[0]) / LINES as f64, (eta[1] - eta[0]) / POINTS as f64);
    let mut area = 0.0;
    for k in 0..LINES {
        let xi = xi[0] + step * (k as f64 + 0.5);
        let [expected, found] = [scanned(&mut evaluator, xi, eta, delta), sliced(&patch, &mut slicer, xi)];
        area += step * widths(&expected);
        // What is narrower than two points the scan may miss.
        let all_wide = expected.iter().chain(&found).all(|[a, b]| b - a > 2.0 * fine);
        let allowed = if all_wide && expected.len() == found.len() { 1e-8 } else { 4.0 * fine };
        let off = (widths(&expected) - widths(&found)).abs();
        assert!(off <= allowed, "{name}: at ξ = {xi} {found:?}, not {expected:?}");
    }
    let error = (patch.area() / area - 1.0).abs();
    assert!(error < 0.01, "{name}: area {}, {area} by lines", patch.area());
    for c in &patch.components {
        let around = c.boundary.iter().zip(c.boundary.iter().cycle().skip(1));
        let enclosed: f64 = around.map(|(p, q)| (p[0] * q[1] - q[0] * p[1]) / 2.0).sum();
        assert!((enclosed - c.area).abs() < 2e-3 * area, "{name}: loop around {enclosed} of {}", c.area);
    }
    let mesh = StripMesh::new(placement, &patch, Counts::default()).expect("a mesh");
    let meshed: f64 = mesh.cells.iter().map(|cell| cell.area).sum();
    assert!((meshed / patch.area() - 1.0).abs() < 1e-6, "{name}: mesh of {meshed} over {}", patch.area());
    patch
}

#[test]
fn built_in_pairs_have_the_patch_that_the_points_have() {
    let pairs = [("60E1", "S1002"), ("56E1", "EN15302-A"), ("49E1", "APTA-120"), ("54E3", "EN15302-I")];
    for (rail, wheel) in pairs {
        let [r, w] = [standards::rail(rail), standards::wheel(wheel)].map(|p| p.expect("a profile"));
        let [first, last] = Section::own_axes(&w, Side::Wheel).reach().expect("a profile with points");
        let pair = Pair::new(r, w, 460.0).expect("a pair");
        for yaw in [-0.1, -0.02, -0.003, 0.003, 0.02, 0.1] {
            // On the flange, in its root, on the tread, and towards the wheel's end.
            for wheel_x in [first + 15.0, first + 40.0, 0.0, last - 3.0, last - 0.3] {
                let placement = pair.placed(if wheel_x < first + 41.0 { -34.0 } else { 5.0 }, wheel_x, yaw);
                let name = format!("{rail} under {wheel} at {wheel_x}, yaw {yaw}");
                check(&name, &placement.expect("a placement"), 0.05);
            }
        }
    }
}

#[test]
fn hollow_wheels_and_throats_have_theirs() {
    let names = ["hollow_tread", "throat", "steep_flange", "UIC60_EN15302A_root", "joint_in_column"];
    for reference in references().iter().filter(|reference| names.contains(&reference.name.as_str())) {
        for yaw in [-0.15, -0.05, 0.01, 0.05, 0.3] {
            let mut placement = reference.placement().expect("a placement");
            placement.skew = yaw;
            check(&format!("{}, yaw {yaw}", reference.name), &placement, 0.05);
        }
    }
}

/// A crown of 50 mm radius under a cone of 45° that ends beside C, on the left or on the right.
fn at_the_end(from: f64, to: f64, yaw: f64) -> Placement {
    let rail = Arc::about([0.0, -50.0], 50.0, Half::Upper, [-45.0, 20.0]).and_then(profile);
    let wheel = Arc::line([from, from], [to, to]).and_then(profile);
    let pair = Pair::new(rail.expect("a crown"), wheel.expect("a cone"), 460.0).expect("a pair");
    pair.placed(-50.0 / 2f64.sqrt(), 0.0, yaw).expect("a placement")
}

#[test]
fn the_end_of_a_wheel_beside_the_midplane() {
    for yaw in [-0.05, -0.01, 0.01, 0.05] {
        let left = check(&format!("left end, yaw {yaw}"), &at_the_end(-0.05, 20.0, yaw), 0.2);
        assert_eq!(left.components.len(), 1, "yaw {yaw}");
        check(&format!("right end, yaw {yaw}"), &at_the_end(-20.0, 0.05, yaw), 0.2);
    }
}

#[test]
fn a_patch_divides_where_its_lines_touch_the_wheel_s_end() {
    for yaw in [-1e-3, 1e-3] {
        let patch = check(&format!("yaw {yaw}"), &at_the_end(-20.0, 0.05, yaw), 0.2);
        let ends: Vec<_> = patch.components.iter().map(|c| c.ends).collect();
        let prong = [End::Fork, End::Tip];
        assert_eq!(ends, [[End::Tip, End::Fork], prong, prong], "yaw {yaw}");
    }
}

/// Two lines of a wheel that meet in a hollow kink have a lowest place each.
#[test]
fn a_hollow_kink_divides_the_lines() {
    let rail = Arc::about([0.0, -80.0], 80.0, Half::Upper, [-30.0, 30.0]).and_then(profile).expect("a crown");
    let sides = [Arc::line([-30.0, -1.5], [1.0, 0.05]), Arc::line([1.0, 0.05], [30.0, -8.65])];
    let sides = sides.map(|side| wheelrail::profile::Segment::arc(side.expect("a line")));
    let wheel = Profile::new("roof", "test", sides.to_vec()).expect("a wheel");
    for yaw in [-0.1, 0.02, 0.1, 0.2] {
        let pair = Pair::new(rail.clone(), wheel.clone(), 460.0).expect("a pair");
        let placement = pair.placed(4.0, 0.0, yaw).expect("a placement");
        check(&format!("roof, yaw {yaw}"), &placement, 0.02);
    }
}

#[test]
fn any_yaw_ends_in_time() {
    for (rail, wheel, radius) in
        [("56E1", "S1002", 1200.0), ("60E1", "EN15302-A", 2500.0), ("49E1", "S1002", 460.0)]
    {
        for yaw in [-0.334, -0.22, 0.25, 0.334, 0.5, 0.9, 1.3] {
            let text = format!(
                "[rail]\nprofile = \"{rail}\"\n[wheel]\nprofile = \"{wheel}\"\nradius = {radius}\n\
                 [contact]\noffset = 0.0\nyaw = {yaw}\n[patch]\napproach = 0.05\n"
            );
            let start = Instant::now();
            let scene = scene::parse(&text, false).expect("a scene");
            let run = Run::new(scene, Path::new("."), "yawed");
            assert!(start.elapsed() < LONGEST, "{rail}, {wheel}, {yaw}: {:?}", start.elapsed());
            for part in run.iter().flat_map(|run| &run.parts) {
                check(
                    &format!("{rail} under {wheel}, R = {radius}, yaw {yaw}"),
                    &part.contact.placement,
                    0.05,
                );
            }
        }
    }
}

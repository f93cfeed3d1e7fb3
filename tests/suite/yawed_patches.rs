//! Patches under yawed wheels against every point of lines of constant ξ.

use std::path::Path;

use crate::common::{profile, references};
use crate::in_time::InTime;
use wheelrail::Interval;
use wheelrail::case::{Run, SILENT};
use wheelrail::conformal::NormalGap;
use wheelrail::internal::bracketed;
use wheelrail::load::feasibility;
use wheelrail::mesh::{StripCounts, StripMesh};
use wheelrail::patch::{End, Patch, Window};
use wheelrail::placement::{Pair, Placement};
use wheelrail::profile::{Arc, Half, Profile, Section, Side, standards};
use wheelrail::scene;
use wheelrail::search::{Pose, first_touch};
use wheelrail::separation::Evaluator;

/// Points of a line of constant ξ at which s is looked at.
const POINTS: usize = 600;

/// Lines of constant ξ over a patch, and beyond it by this share on each side.
const LINES: usize = 60;
const MARGIN: f64 = 0.05;

/// What is looked at \[mm\].
const NEAR: Window = Window { xi: Interval::symmetric(8.0), eta: Interval::symmetric(15.0) };

/// All intervals of η in which a gap is negative at ξ, but for those between two of the points.
fn scanned(gap: &mut impl FnMut(f64, f64) -> f64, xi: f64, over: Interval) -> Vec<Interval> {
    let mut inside = |eta: f64| gap(xi, eta) < 0.0;
    let eta = |k: usize| over.step(k, POINTS);
    let mut intervals: Vec<Interval> = Vec::new();
    let mut before = inside(over.low);
    intervals.extend(before.then_some(over));
    for k in 1..=POINTS {
        let here = inside(eta(k));
        if here != before {
            let side = |eta: f64| if inside(eta) == before { -1.0 } else { 1.0 };
            let change = bracketed(side, eta(k - 1), eta(k)).expect("a change");
            match intervals.last_mut().filter(|_| before) {
                Some(last) => last.high = change,
                None => intervals.push(Interval { low: change, ..over }),
            }
        }
        before = here;
    }
    intervals
}

/// The slices of all components at ξ.
fn sliced(patch: &Patch, xi: f64) -> Vec<Interval> {
    let mut all: Vec<Interval> = patch.slices(xi).into_iter().map(|(_, slice)| slice.eta).collect();
    all.sort_by(|a, b| a.low.total_cmp(&b.low));
    all.retain(|eta| eta.low < eta.high);
    all
}

fn shoelace(points: &[[f64; 2]]) -> f64 {
    let around = points.iter().zip(points.iter().cycle().skip(1));
    around.map(|(p, q)| (p[0] * q[1] - q[0] * p[1]) / 2.0).sum()
}

fn widths(intervals: &[Interval]) -> f64 {
    intervals.iter().map(|eta| eta.width()).sum()
}

/// Checks a patch line by line, its area and loops. `gap` is negative inside it.
fn by_lines(name: &str, patch: &Patch, mut gap: impl FnMut(f64, f64) -> f64) {
    let extent = patch.extent().unwrap_or_else(|| panic!("{name}: empty"));
    let wider = |side: Interval, most: Interval| side.grown(MARGIN * side.width()).cut(most);
    let [xi, eta] = [wider(extent.xi, NEAR.xi), wider(extent.eta, NEAR.eta)];
    let (step, fine) = (xi.width() / LINES as f64, eta.width() / POINTS as f64);
    let mut area = 0.0;
    for k in 0..LINES {
        let xi = xi.low + step * (k as f64 + 0.5);
        let [expected, found] = [scanned(&mut gap, xi, eta), sliced(patch, xi)];
        area += step * widths(&expected);
        // What is narrower than two points the scan may miss.
        let all_wide = expected.iter().chain(&found).all(|eta| eta.width() > 2.0 * fine);
        let allowed = if all_wide && expected.len() == found.len() { 1e-8 } else { 4.0 * fine };
        let off = (widths(&expected) - widths(&found)).abs();
        assert!(off <= allowed, "{name}: at ξ = {xi} {found:?}, not {expected:?}");
    }
    let error = (patch.area() / area - 1.0).abs();
    assert!(error < 0.01, "{name}: area {}, {area} by lines", patch.area());
    for c in &patch.components {
        let enclosed: f64 = [&c.boundary].into_iter().chain(&c.holes).map(|points| shoelace(points)).sum();
        assert!((enclosed - c.area).abs() < 2e-3 * area, "{name}: loops around {enclosed} of {}", c.area);
        assert!(c.holes.iter().all(|hole| shoelace(hole) < 0.0), "{name}: a hole that runs the other way");
    }
}

/// Checks the patches near C over the tangent plane and over the rail's surface, and the mesh of the first; that patch.
fn check(name: &str, placement: &Placement, delta: f64) -> Patch {
    let (patch, mut evaluator) = (Patch::new(placement, delta, &NEAR), Evaluator::new(placement));
    by_lines(name, &patch, |xi, eta| evaluator.separation(xi, eta) - delta);
    let mesh = StripMesh::new(placement, &patch, StripCounts::default()).expect("a mesh");
    let meshed: f64 = mesh.cells.iter().map(|cell| cell.area).sum();
    assert!((meshed / patch.area() - 1.0).abs() < 1e-6, "{name}: mesh of {meshed} over {}", patch.area());
    let over_rail = Patch::over_rail(placement, delta, &NEAR);
    by_lines(&format!("{name}, over the rail"), &over_rail, over_surface(placement, delta));
    patch
}

/// How far the wheel is above the rail's point, raised by δ cos α along its normal; over a roller t − δ cos α.
fn over_surface(placement: &Placement, delta: f64) -> impl FnMut(f64, f64) -> f64 {
    let (mut evaluator, normal) = (Evaluator::new(placement), NormalGap::new(placement));
    move |sigma, eta| {
        if placement.under().is_some() {
            return normal.gap(sigma, eta) - delta * normal.angle(sigma).cos();
        }
        let Some(at) = normal.rail().point(sigma) else { return f64::NAN };
        let (xi, zeta) = (at.xi - delta * at.cos * at.sin, at.zeta + delta * at.cos * at.cos);
        evaluator.separation(xi, eta) + evaluator.rail_height(xi) - zeta
    }
}

#[test]
fn built_in_pairs_have_the_patch_that_the_points_have() {
    let pairs = [("60E1", "S1002"), ("56E1", "EN15302-A"), ("49E1", "APTA-120"), ("54E3", "EN15302-I")];
    for (rail, wheel) in pairs {
        let [r, w] = [standards::rail(rail), standards::wheel(wheel)].map(|p| p.expect("a profile"));
        let [first, last] = Section::own_axes(&w, Side::Wheel).reach().expect("a profile with points").ends();
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
            let placement = reference.placement().and_then(|placement| placement.with_skew(yaw));
            check(&format!("{}, yaw {yaw}", reference.name), &placement.expect("a placement"), 0.05);
        }
    }
}

/// A crown of 50 mm radius under a cone of 45° that ends beside C, on the left or on the right.
fn at_the_end(from: f64, to: f64, yaw: f64, roller: Option<f64>) -> Placement {
    let rail = Arc::about([0.0, -50.0], 50.0, Half::Upper, [-45.0, 20.0]).and_then(profile);
    let wheel = Arc::line([from, from], [to, to]).and_then(profile);
    let pair = Pair::new(rail.expect("a crown"), wheel.expect("a cone"), 460.0).expect("a pair");
    let pair = roller.map_or(Ok(pair.clone()), |radius| pair.on_roller(radius)).expect("a roller");
    pair.placed(-50.0 / 2f64.sqrt(), 0.0, yaw).expect("a placement")
}

/// The most intervals of a patch on one of many lines.
fn most_slices(patch: &Patch, xi: Interval) -> usize {
    (0..400).map(|k| sliced(patch, xi.step(2 * k + 1, 800)).len()).max().unwrap_or(0)
}

#[test]
fn the_end_of_a_wheel_beside_the_midplane() {
    for yaw in [-0.05, -0.01, 0.0, 0.01, 0.05] {
        let left = check(&format!("left end, yaw {yaw}"), &at_the_end(-0.05, 20.0, yaw, None), 0.2);
        assert_eq!(left.components.len(), 1, "yaw {yaw}");
        check(&format!("right end, yaw {yaw}"), &at_the_end(-20.0, 0.05, yaw, None), 0.2);
    }
}

/// The wheel ends at or beside its contact, so that some lines meet it ahead of C or behind alone.
#[test]
fn the_end_of_a_wheel_on_a_roller() {
    let rail = Arc::about([0.0, -80.0], 80.0, Half::Upper, [-30.0, 30.0]).and_then(profile).expect("a crown");
    let tread = |from: f64| Arc::about([0.0, 300.0], 300.0, Half::Lower, [from, 30.0]).and_then(profile);
    for from in [0.0, -1.5] {
        let pair = Pair::new(rail.clone(), tread(from).expect("a tread"), 460.0).expect("a pair");
        let pair = pair.on_roller(350.0).expect("a roller");
        for yaw in [-0.1, -0.01, 0.003, 0.05] {
            let placement = pair.placed(0.0, 0.0, yaw).expect("a placement");
            let patch = check(&format!("from {from}, yaw {yaw}"), &placement, 0.1);
            assert_eq!(patch.components.len(), 1, "from {from}, yaw {yaw}");
        }
    }
}

/// Lines of constant ξ that touch the circle of the wheel's end divide: two prongs, of one component with one loop.
#[test]
fn a_component_goes_on_on_both_sides_of_the_wheel_s_end() {
    for yaw in [-1e-3, -1e-4, 0.0, 1e-9, 1e-7, 1e-3] {
        // The window cuts the longer prongs.
        for (end, approach, last) in [(0.05, 0.2, End::Window), (0.0, 0.1, End::Tip)] {
            let placement = at_the_end(-20.0, end, yaw, None);
            let patch = check(&format!("end at {end}, yaw {yaw}"), &placement, approach);
            let [c] = patch.components.as_slice() else { panic!("{} components", patch.components.len()) };
            assert_eq!((c.ends, c.holes.len()), ([End::Tip, last], 0), "end at {end}, yaw {yaw}");
            assert_eq!(most_slices(&patch, c.xi), 2, "end at {end}, yaw {yaw}");
        }
    }
}

/// The smallest yaws change nothing, and the prongs of a nearly level end are as narrow as a micrometre.
#[test]
fn the_patch_without_yaw_is_that_of_the_smallest_yaw() {
    let rail =
        Arc::about([0.0, -300.0], 300.0, Half::Upper, [-65.0, 65.0]).and_then(profile).expect("a crown");
    for slope in [0.0, 0.003, -0.003, 0.02, 0.2] {
        let cone = Arc::line([-30.0, -30.0 * slope], [7.0, 7.0 * slope]).and_then(profile).expect("a cone");
        let pair = Pair::new(rail.clone(), cone, 430.0).expect("a pair");
        let patch = |yaw: f64| {
            let foot = -300.0 * f64::sin(slope.atan());
            let placement = pair.placed(foot, 0.0, yaw).expect("a placement");
            let _in_time = InTime::begin();
            let patches = [Patch::new, Patch::over_rail].map(|of| of(&placement, 0.3, &Window::UNBOUNDED));
            patches.map(|patch| (patch.components.len(), patch.area()))
        };
        let without = patch(0.0);
        for yaw in [1e-14, -1e-12, 1e-9] {
            for ((parts, area), (expected, level)) in patch(yaw).into_iter().zip(without) {
                assert_eq!(parts, expected, "slope {slope}, yaw {yaw}");
                assert!((area / level - 1.0).abs() < 1e-12, "slope {slope}, yaw {yaw}: {area}, {level}");
            }
        }
    }
}

/// A profile of lines through points.
fn chain(points: &[[f64; 2]]) -> Profile {
    let line = |pair: &[[f64; 2]]| Arc::line(pair[0], pair[1]).expect("a line");
    let segments = points.windows(2).map(|pair| wheelrail::profile::Segment::arc(line(pair)));
    Profile::new("chain", "test", segments.collect()).expect("a profile")
}

/// At a hollow kink the normals of the rail's surface cross, so that the wheel is met again behind it.
#[test]
fn a_kink_of_the_rail_parts_the_patch_over_its_surface() {
    let rail = chain(&[[-20.0, -1.0], [0.0, 0.0], [0.54, 0.0], [3.0, 0.31]]);
    let pair = Pair::new(rail, chain(&[[-10.0, 1.0], [0.0, 0.0], [10.0, 5.71]]), 460.0).expect("a pair");
    for yaw in [0.0, 0.01] {
        let placement = Pose::new(0.1, yaw, 0.0).and_then(|pose| first_touch(&pair, &pose)).expect("a touch");
        let patch = check(&format!("yaw {yaw}"), &placement, 0.24);
        let over_rail = Patch::over_rail(&placement, 0.24, &NEAR);
        assert_eq!([patch, over_rail].map(|patch| patch.components.len()), [1, 2], "yaw {yaw}");
    }
}

/// The areas of a patch in windows side by side are that of the whole.
#[test]
fn windows_add_up() {
    let crown =
        Arc::about([0.0, -300.0], 300.0, Half::Upper, [-45.0, 45.0]).and_then(profile).expect("a crown");
    let roof = chain(&[[-30.0, -1.0], [0.0, 0.0], [30.0, -0.3]]);
    let cone = |[from, to]: [f64; 2], slope: f64| chain(&[[from, from * slope], [to, to * slope]]);
    let scenes = [
        (
            "an end that leaves the patch next to its tip",
            crown.clone(),
            cone([-30.0, 7.0], -0.003),
            [0.9, 0.0],
        ),
        ("a prong of a micrometre", crown, cone([-30.0, 7.0], 0.003), [-0.9, 0.0]),
        ("a contact at a kink of the rail", roof, cone([-30.0, 30.0], 0.005), [0.0, 0.0]),
        (
            "a wheel that ends beside the rail",
            cone([0.0, 30.0], -0.03),
            cone([-0.016, 9.0], -0.01),
            [0.0, 0.0],
        ),
    ];
    for (name, rail, wheel, [rail_x, wheel_x]) in scenes {
        let pair = Pair::new(rail, wheel, 430.0).expect("a pair");
        for yaw in [0.0, 1e-12, 1e-9, 1e-4, 0.01] {
            let pose = Pose::new(rail_x - wheel_x, yaw, 0.0).expect("a pose");
            let placement = first_touch(&pair, &pose).expect("a touch");
            for of in [Patch::new, Patch::over_rail] {
                let whole = of(&placement, 0.3, &Window::UNBOUNDED);
                let Some(extent) = whole.extent() else { continue };
                let cut = |k: usize| match k {
                    0 => f64::NEG_INFINITY,
                    13 => f64::INFINITY,
                    k => extent.xi.step(k, 13),
                };
                let window = |k: usize| Window { xi: Interval::new(cut(k), cut(k + 1)), eta: Interval::ALL };
                let parts: f64 = (0..13).map(|k| of(&placement, 0.3, &window(k)).area()).sum();
                assert!(
                    (parts / whole.area() - 1.0).abs() < 2e-12,
                    "{name}, yaw {yaw}: {parts}, {}",
                    whole.area()
                );
            }
        }
    }
}

/// On a roller these lines are sampled.
#[test]
fn both_prongs_beyond_a_hollow_end_are_found() {
    for (yaw, roller) in [0.0, 1e-3, -0.01].into_iter().flat_map(|yaw| [(yaw, None), (yaw, Some(350.0))]) {
        let name = format!("roller {roller:?}, yaw {yaw}");
        let patch = check(&name, &at_the_end(-20.0, 0.05, yaw, roller), 0.2);
        let [c] = patch.components.as_slice() else {
            panic!("{name}: {} components", patch.components.len())
        };
        assert_eq!(most_slices(&patch, c.xi), 2, "{name}");
        check(&name, &at_the_end(-0.05, 20.0, yaw, roller), 0.2);
    }
}

/// An edge that turns between two lines on which it lies at one η, where a flank elsewhere on these lines stands upright.
#[test]
fn edges_that_turn_keep_to_the_level() {
    let [rail, wheel] =
        [standards::rail("49E5"), standards::wheel("APTA-240")].map(|p| p.expect("a profile"));
    let pair = Pair::new(rail, wheel, 451.604).expect("a pair");
    let placement =
        pair.placed(17.664_920_183_710_414, 5.708_765_111_303_457, -0.045_851).expect("a placement");
    let delta = 0.001_948_6;
    let (patch, mut gap) =
        (Patch::over_rail(&placement, delta, &Window::UNBOUNDED), over_surface(&placement, delta));
    for sigma in (0..=200).map(|k| Interval::symmetric(0.5).step(k, 200)) {
        let [slice] = sliced(&patch, sigma)[..] else { panic!("one slice at {sigma}") };
        for eta in slice.ends() {
            let off = gap(sigma, eta);
            assert!(off.abs() < 1e-9, "{off:e} at {sigma}, {eta}");
        }
    }
}

/// Two lines of a wheel that meet in a hollow kink have a lowest place each.
#[test]
fn a_hollow_kink_divides_the_lines() {
    let rail = Arc::about([0.0, -80.0], 80.0, Half::Upper, [-30.0, 30.0]).and_then(profile).expect("a crown");
    let sides = [Arc::line([-30.0, -1.5], [1.0, 0.05]), Arc::line([1.0, 0.05], [30.0, -8.65])];
    let sides = sides.map(|side| wheelrail::profile::Segment::arc(side.expect("a line")));
    let wheel = Profile::new("roof", "test", sides.to_vec()).expect("a wheel");
    let pair = Pair::new(rail, wheel, 460.0).expect("a pair");
    for pair in [pair.on_roller(350.0).expect("a roller"), pair] {
        for yaw in [-0.1, 0.02, 0.1, 0.2] {
            let placement = pair.placed(4.0, 0.0, yaw).expect("a placement");
            check(&format!("roof, yaw {yaw}, roller {:?}", pair.roller_radius()), &placement, 0.02);
        }
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
            let scene = scene::parse(&text, false).expect("a scene");
            let in_time = InTime::begin();
            let run = scene::resolve(&scene, Path::new("."), "yawed").and_then(|case| Run::new(case, SILENT));
            drop(in_time);
            for part in run.iter().flat_map(|run| &run.parts) {
                check(
                    &format!("{rail} under {wheel}, R = {radius}, yaw {yaw}"),
                    &part.site.contact.placement,
                    0.05,
                );
            }
        }
    }
}

/// The least s over a box, by grids that close in on the lowest point of the one before.
fn least_by_grids(placement: &Placement, [xi, eta]: [[f64; 2]; 2]) -> f64 {
    let mut evaluator = Evaluator::new(placement);
    let (mut centre, mut half) =
        ([(xi[0] + xi[1]) / 2.0, (eta[0] + eta[1]) / 2.0], [(xi[1] - xi[0]) / 2.0, (eta[1] - eta[0]) / 2.0]);
    let mut least = f64::INFINITY;
    for (round, points) in [(0, 400), (1, 40), (2, 40), (3, 40), (4, 40), (5, 40)] {
        let around = centre;
        for i in 0..=points {
            for j in 0..=points {
                let at = [(i, 0), (j, 1)].map(|(k, axis)| {
                    around[axis] + half[axis] * (2.0 * f64::from(k) / f64::from(points) - 1.0)
                });
                let s = evaluator.separation(at[0], at[1]);
                if s < least {
                    (least, centre) = (s, at);
                }
            }
        }
        let share = if round == 0 { 0.02 } else { 0.2 };
        half = half.map(|half| half * share);
    }
    least
}

/// Flange contacts that overlap before or behind the midplane, and some that do not.
#[test]
fn the_least_separation_under_yaw_is_that_of_all_points() {
    let (mut overlaps, mut beside) = (0, 0);
    for (rail, wheel) in [("60E1", "S1002"), ("56E1", "EN15302-A"), ("49E1", "APTA-120")] {
        let profiles = [standards::rail(rail), standards::wheel(wheel)].map(|p| p.expect("a profile"));
        let [r, w] = profiles;
        let pair = Pair::new(r, w, 460.0).expect("a pair");
        for (rail_x, wheel_x) in [(-34.0, -33.0), (-35.0, -38.0), (-35.5, -42.0), (-20.0, -24.0), (4.0, 6.0)]
        {
            for yaw in [-0.05, -0.01, 0.003, 0.02, 0.08] {
                // Not every wheel has a flange that wide.
                let Ok(placement) = pair.placed(rail_x, wheel_x, yaw) else { continue };
                let found = feasibility(&placement).expect("an overlap");
                let name = format!("{rail} at {rail_x} under {wheel} at {wheel_x}, yaw {yaw}: {found:?}");
                let over = placement.overlap().expect("an overlap").grown(20.0);
                let by_grids = least_by_grids(&placement, [over.ends(), [-150.0, 150.0]]);
                let least = found.least_separation_mm;
                assert!(least <= by_grids + 1e-10, "{name}, {by_grids} by grids");
                // Where the surfaces end the grids do not hit the lowest point.
                assert!(least > by_grids - 0.02 * (1.0 + by_grids.abs()), "{name}, {by_grids} by grids");
                let there = Evaluator::new(&placement).separation(found.at_xi_mm, found.at_eta_mm);
                assert!(there.is_nan() || (there - least).abs() < 1e-9, "{name}: {there} there");
                overlaps += usize::from(!found.feasible);
                beside += usize::from(found.at_eta_mm.abs() > 1.0);
            }
        }
    }
    assert!(overlaps > 10 && beside > 10, "{overlaps} overlap, {beside} beside the midplane");
}

/// Joints of S1002 and 60E1 as drawn miss each other by a tenth of a micrometre: no patch may be torn there, and no grid cut it.
#[test]
fn joints_of_drawings_do_not_tear_patches() {
    let rail = "[rail]\nprofile = \"60E1\"\nrotate = \"1:40\"\n";
    let single = |wheel: &str, offset: f64, yaw: f64| {
        format!(
            "{rail}[wheel]\nprofile = {wheel:?}\nradius = 460.0\n[contact]\noffset = {offset}\nyaw = {yaw}\n"
        )
    };
    let wheelset = |lateral: f64, yaw: f64| {
        format!(
            "{rail}[wheel]\nprofile = \"S1002\"\nradius = 460.0\n[track]\ngauge = 1435.0\ngauge_height = 14.0\n\
             [wheelset]\nback_to_back = 1360.0\nflange_back_x = -70.0\nlateral = {lateral}\nyaw = {yaw}\n"
        )
    };
    let mut scenes = Vec::new();
    for k in 0..11 {
        let more = 0.02 * f64::from(k) - 0.1;
        scenes.extend(["S1002", "S1002-arcs-1um"].map(|wheel| single(wheel, 3.5 + more, 0.01)));
        scenes.push(single("S1002", 3.4 + more, 0.012));
        scenes.push(wheelset(6.15 + more, 0.01));
    }
    for scene in scenes {
        let text = format!("{scene}[patch]\napproach = 0.08\n");
        let parsed = scene::parse(&text, false).expect("a scene");
        let case = scene::resolve(&parsed, Path::new("."), "joints").expect("a case");
        let run = Run::new(case, SILENT).expect("a run");
        for part in &run.parts {
            let patch = part.analysis.patch.as_ref().expect("a patch");
            let [c] = patch.components.as_slice() else { panic!("{text}: {} parts", patch.components.len()) };
            assert_eq!((c.ends, c.cut_by_window, c.holes.len()), ([End::Tip; 2], false, 0), "{text}");
        }
    }
}

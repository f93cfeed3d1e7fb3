//! The patch against closed forms, an independent quadrature and its own invariants.

use std::f64::consts::PI;

use crate::common::{approached_references, profile, references, two_crowns};
use wheelrail::Interval;
use wheelrail::Result;
use wheelrail::internal::bracketed;
use wheelrail::patch::{Component, End, Patch, Slicer, Window};
use wheelrail::placement::{Pair, Placement};
use wheelrail::profile::{Arc, Half, Profile, standards};
use wheelrail::separation::Evaluator;

fn crown(radius: f64) -> Result<Profile> {
    profile(Arc::about([0.0, -radius], radius, Half::Upper, [-30.0, 30.0])?)
}

/// A 300 mm crown under a 460 mm cylinder, turned about the normal.
fn crossed(skew: f64) -> Result<Placement> {
    Pair::new(crown(300.0)?, profile(Arc::line([-40.0, 0.0], [40.0, 0.0])?)?, 460.0)?.placed(0.0, 0.0, skew)
}

fn standard(rail_x: f64, wheel_x: f64, skew: f64) -> Result<Placement> {
    Pair::new(standards::rail("60E1")?, standards::wheel("S1002")?, 460.0)?.placed(rail_x, wheel_x, skew)
}

/// Every reference scene at each of its approaches, plain and turned, and some pairs of this file.
fn cases() -> Vec<(String, Placement, f64)> {
    let mut all = approached_references();
    for skew in [0.0, 0.02] {
        for delta in [1e-9, 0.02, 0.1] {
            let placement = two_crowns(-1e-3, skew).expect("a placement");
            all.push((format!("two crowns δ = {delta} χ = {skew}"), placement, delta));
            let placement = standard(-2.5, 1.5, skew).expect("a placement");
            all.push((format!("60E1/S1002 δ = {delta} χ = {skew}"), placement, delta));
        }
    }
    all
}

/// Area of a component from rows of constant η: midpoint rule in the angle of η = centre + half sin φ, which
/// converges spectrally for a smooth loop.
fn area_by_rows(placement: &Placement, approach: f64, component: &Component, rows: usize) -> f64 {
    let mut evaluator = Evaluator::new(placement);
    let (centre, half) = (component.eta.middle(), component.eta.width() / 2.0);
    let steps = 400;
    let mut sum = 0.0;
    for row in 0..rows {
        let phi = PI * ((row as f64 + 0.5) / rows as f64 - 0.5);
        let eta = centre + half * phi.sin();
        let at = |k: usize| {
            let psi = PI * (k as f64 / steps as f64 - 0.5);
            component.xi.nearest(component.xi.middle() + component.xi.width() / 2.0 * psi.sin())
        };
        let mut length = 0.0;
        for k in 0..steps {
            let (a, b) = (at(k), at(k + 1));
            let mut depth = |xi: f64| evaluator.separation(xi, eta) - approach;
            let (p, q) = (depth(a), depth(b));
            length += match (p < 0.0, q < 0.0) {
                (true, true) => b - a,
                (false, false) => 0.0,
                (inside, _) => {
                    let root = bracketed(depth, a, b).unwrap_or(if inside { b } else { a });
                    if inside { root - a } else { b - root }
                }
            };
        }
        sum += length * half * phi.cos() * PI / rows as f64;
    }
    sum
}

/// Middle of the loop's points at one ξ.
fn centre_at(component: &Component, xi: f64) -> f64 {
    let here = component.boundary.iter().filter(|p| p[0] == xi).map(|p| p[1]);
    let (low, high) = here.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), eta| (l.min(eta), h.max(eta)));
    (low + high) / 2.0
}

fn shoelace(loop_: &[[f64; 2]]) -> f64 {
    let [x0, y0] = loop_[0];
    let pairs = loop_.iter().zip(loop_.iter().cycle().skip(1));
    pairs.map(|(p, q)| ((p[0] - x0) * (q[1] - y0) - (q[0] - x0) * (p[1] - y0)) / 2.0).sum()
}

#[test]
fn crossed_cylinders_give_their_ellipse() -> Result<()> {
    for delta in [1e-9, 1e-6, 1e-3, 0.05] {
        let patch = Patch::new(&crossed(0.0)?, delta, &Window::UNBOUNDED);
        let [c] = patch.components.as_slice() else { panic!("{} components", patch.components.len()) };
        let (a, b) = ((delta * (600.0 - delta)).sqrt(), (delta * (920.0 - delta)).sqrt());
        // Rounding of s − δ moves a tip by ε δ × dξ/ds = ε ξ/2.
        for (found, exact) in [(-c.xi.low, a), (c.xi.high, a), (-c.eta.low, b), (c.eta.high, b)] {
            assert!((found - exact).abs() <= 8.0 * f64::EPSILON * exact, "δ = {delta}: {found}, not {exact}");
        }
        let hertz = (PI * 2.0 * delta * (300f64 * 460.0).sqrt(), delta / 300.0);
        assert!((c.area / hertz.0 - 1.0).abs() < hertz.1 + 1e-12, "δ = {delta}: {}", c.area / hertz.0);
        assert_eq!(c.ends, [End::Tip; 2]);
        assert!(!c.cut_by_window);
        assert_eq!(c.deepest, [0.0; 3]);
    }
    Ok(())
}

#[test]
fn the_turned_ellipse_keeps_its_area_and_extents() -> Result<()> {
    // A turned cylinder on a cylinder: s = ξ²/600 + η′²/920 with η′ = η cos χ − ξ sin χ.
    for (skew, delta) in [(0.1f64, 1e-9), (-0.03, 1e-4), (0.02, 1e-2)] {
        let patch = Patch::new(&crossed(skew)?, delta, &Window::UNBOUNDED);
        let [c] = patch.components.as_slice() else { panic!("{} components", patch.components.len()) };
        let (sin, cos) = skew.sin_cos();
        let area = PI * delta * (600f64 * 920.0).sqrt() / cos;
        assert!((c.area / area - 1.0).abs() < delta / 300.0 + 1e-10, "{} {area}", c.area);
        let (xi, eta) = ((600.0 * delta).sqrt(), (delta * (920.0 + 600.0 * sin * sin)).sqrt() / cos);
        assert!((c.xi.high / xi - 1.0).abs() < delta / 300.0 + 1e-10, "{} {xi}", c.xi.high);
        assert!((c.eta.high / eta - 1.0).abs() < delta / 300.0 + 1e-9, "{} {eta}", c.eta.high);
        let tip = c.boundary[0];
        assert!((tip[1] / (tip[0] * skew.tan()) - 1.0).abs() < delta / 300.0 + 1e-6, "{tip:?}");
    }
    Ok(())
}

#[test]
fn a_cone_on_a_cylinder_has_its_closed_form() -> Result<()> {
    let (radius, slope, delta) = (300.0f64, 0.05f64, 0.1);
    let wheel = profile(Arc::line([-60.0, -60.0 * slope], [60.0, 60.0 * slope])?)?;
    let sin = slope / 1f64.hypot(slope);
    let cos = sin / slope;
    let placement = Pair::new(crown(radius)?, wheel, 460.0)?.placed(-radius * sin, 0.0, 0.0)?;
    let patch = Patch::new(&placement, delta, &Window::UNBOUNDED);
    let [c] = patch.components.as_slice() else { panic!("{} components", patch.components.len()) };
    for &[xi, eta] in &c.boundary {
        let zeta = delta - xi * xi / (radius + (radius * radius - xi * xi).sqrt());
        let e = zeta / cos;
        let square = e * (2.0 * (460.0 - xi * sin - zeta * cos) + e);
        assert!((eta * eta - square).abs() < 1e-12, "η({xi}) = {eta}, not √{square}");
    }
    Ok(())
}

#[test]
fn areas_agree_with_rows_of_constant_eta() {
    for (name, placement, delta) in cases() {
        let patch = Patch::new(&placement, delta, &Window::UNBOUNDED);
        for component in patch.components.iter().filter(|c| c.ends == [End::Tip; 2]) {
            let rows = area_by_rows(&placement, delta, component, 240);
            // Kinks of the boundary at joints slow the rows down, not the area.
            let allowed = if component.corners.len() == 2 { 1e-9 } else { 1e-4 };
            let error = (component.area / rows - 1.0).abs();
            assert!(error < allowed, "{name}: area {} by columns, {rows} by rows", component.area);
        }
    }
}

#[test]
fn loops_run_counter_clockwise_along_s_equal_delta() {
    for (name, placement, delta) in cases() {
        let patch = Patch::new(&placement, delta, &Window::UNBOUNDED);
        assert!(!patch.components.is_empty(), "{name}: empty");
        let mut evaluator = Evaluator::new(&placement);
        for c in &patch.components {
            let enclosed = shoelace(&c.boundary);
            assert!((enclosed / c.area - 1.0).abs() < 1e-3, "{name}: {enclosed} of {}", c.area);
            let twins = c.boundary.iter().zip(c.boundary.iter().cycle().skip(1)).filter(|(p, q)| p == q);
            assert_eq!(twins.count(), 0, "{name}: repeated points");
            let [a, b] = c.xi.ends();
            let next = c.boundary.iter().cycle().skip(1);
            for (&[xi, eta], &[xi_next, eta_next]) in c.boundary.iter().zip(next) {
                assert!(c.extent().contains(xi, eta), "{name}: ({xi}, {eta})");
                // Closed by a body's end or step: s < δ, and just outside there is no surface, or s has jumped.
                let centre = centre_at(c, xi);
                let beyond = evaluator.separation(xi, centre + (eta - centre) * (1.0 + 1e-9));
                let end = (xi == a && c.ends[0] != End::Tip) || (xi == b && c.ends[1] != End::Tip);
                let [slope, across] = evaluator.wheel_slopes(xi, eta);
                let smooth = 1e-9 * (across * (eta - centre)).abs();
                let jump = beyond >= delta && beyond - evaluator.separation(xi, eta) > 10.0 * smooth;
                let side = end || beyond.is_nan() || jump;
                // A point on the very end may round off it, and farther where the end is steep: ξ has a rounding, too.
                let steep = if xi_next == xi { 0.0 } else { ((eta_next - eta) / (xi_next - xi)).abs() };
                let off = 1e-12 * (eta - centre).abs() + f64::EPSILON * xi.abs() * steep;
                let inside = if eta > centre { (eta - off).max(centre) } else { (eta + off).min(centre) };
                let s = evaluator.separation(xi, if side { inside } else { eta });
                // What a rounding of ξ does to s: the wheel may be steep there.
                let rounding = 16.0 * f64::EPSILON * (slope.abs() + 1.0) * (xi.abs() + 1.0);
                assert!(
                    (s - delta).abs() <= 1e-13 * delta + rounding * delta.sqrt() || (side && s < delta),
                    "{name}: s({xi}, {eta}) − δ = {:e}",
                    s - delta
                );
            }
            let floor = c.boundary.iter().map(|&[xi, eta]| evaluator.separation(xi, eta));
            assert!(c.deepest[0] <= floor.fold(f64::INFINITY, f64::min), "{name}: {:?}", c.deepest);
            let [s, xi, eta] = c.deepest;
            assert_eq!(evaluator.separation(xi, eta), s, "{name}");
            let [_, across] = evaluator.wheel_slopes(xi, eta);
            assert!(across.abs() < 1e-9, "{name}: slope {across:e} across at the deepest point");
        }
    }
}

#[test]
fn the_perimeter_is_the_loop_s_length() {
    for (name, placement, delta) in cases() {
        for c in Patch::new(&placement, delta, &Window::UNBOUNDED).components {
            let sides = c.boundary.iter().zip(c.boundary.iter().cycle().skip(1));
            let polygon: f64 = sides.map(|(p, q)| (q[0] - p[0]).hypot(q[1] - p[1])).sum();
            let excess = c.perimeter / polygon - 1.0;
            // The sides' lengths are no better than ξ resolves them, where a body's end is steep and short.
            assert!((-1e-7..1e-3).contains(&excess), "{name}: {} for a polygon of {polygon}", c.perimeter);
        }
    }
}

/// Error of the interpolated η \[mm\] at the end of a wheel's surface, where both patches end.
const SAME_END: f64 = 1e-11;

#[test]
fn a_larger_approach_contains_the_smaller_patch() {
    for (name, placement, delta) in cases() {
        let small = Patch::new(&placement, delta, &Window::UNBOUNDED);
        let large = Patch::new(&placement, 1.5 * delta, &Window::UNBOUNDED);
        assert!(large.area() > small.area(), "{name}");
        let mut slicer = Slicer::new(&placement, 1.5 * delta);
        for &[xi, eta] in small.components.iter().flat_map(|c| &c.boundary) {
            let wide = slicer.slice(xi).map(|s| s.eta);
            assert!(
                wide.is_some_and(|wide| wide.grown(SAME_END).contains(eta)),
                "{name}: ({xi}, {eta}) outside {wide:?}"
            );
            let of = large.components.iter().filter(|c| c.xi.contains(xi)).count();
            assert_eq!(of, 1, "{name}: ξ = {xi} lies in {of} components");
        }
    }
}

/// However near to C: no rounding of a profile's parameter is left over.
#[test]
fn the_gap_is_a_parabola_down_to_c() {
    for (name, placement, _) in cases().into_iter().filter(|(_, placement, _)| placement.skew() == 0.0) {
        let mut evaluator = Evaluator::new(&placement);
        for side in [-1.0, 1.0] {
            let mut opening = |xi: f64| evaluator.separation(side * xi, 0.0) / (xi * xi);
            let expected = opening(1e-11);
            for decade in 12..100 {
                let found = opening(0.1f64.powi(decade));
                let close = (found - expected).abs() <= 1e-9 * expected;
                assert!(close, "{name} ξ = {side}e-{decade}: {found} {expected}");
            }
        }
    }
}

#[test]
fn no_approach_gives_no_patch() {
    for (name, placement, _) in cases() {
        let patch = Patch::new(&placement, 0.0, &Window::UNBOUNDED);
        // Scenes whose chosen points overlap elsewhere have a patch at δ = 0, but none at C.
        for c in &patch.components {
            assert!(c.deepest[0] < -1e-12, "{name}: {c:?}");
        }
        assert!(Patch::new(&placement, f64::NAN, &Window::UNBOUNDED).components.is_empty());
    }
}

#[test]
fn a_tiny_approach_finds_the_tiny_patch_at_c() {
    for reference in references() {
        for (skew, delta) in [(0.0, 1e-9), (0.0, 1e-15), (0.015, 1e-9), (0.015, 1e-12)] {
            let placement = reference.placement().and_then(|placement| placement.with_skew(skew));
            let placement = placement.expect("a placement");
            let patch = Patch::new(&placement, delta, &Window::UNBOUNDED);
            let at_c = patch.components.iter().find(|c| c.xi.low < 0.0 && c.xi.high > 0.0);
            let Some(c) = at_c else { panic!("{} δ = {delta} χ = {skew}: no patch at C", reference.name) };
            assert!(c.area > 0.0 && c.eta.low < 0.0 && c.eta.high > 0.0, "{}: {c:?}", reference.name);
            let scaled = Patch::new(&placement, delta / 4.0, &Window::UNBOUNDED);
            let quarter =
                scaled.components.iter().find(|c| c.xi.low < 0.0 && c.xi.high > 0.0).map(|c| c.area);
            // Far inside both contact segments the patch is an ellipse, whose area goes with δ.
            let ratio = quarter.map(|q| c.area / q);
            let smooth = c.ends == [End::Tip; 2] && c.xi.width() < 0.05;
            assert!(
                !smooth || ratio.is_some_and(|r| (r - 4.0).abs() < 1e-2),
                "{} δ = {delta} χ = {skew}: {ratio:?}",
                reference.name
            );
        }
    }
}

#[test]
fn two_crowns_give_two_components_that_merge() -> Result<()> {
    for skew in [0.0, 0.01] {
        let placement = two_crowns(-1e-3, skew)?;
        let two = Patch::new(&placement, 0.08, &Window::UNBOUNDED);
        assert_eq!(two.components.len(), 2, "χ = {skew}");
        let [left, right] = [&two.components[0], &two.components[1]];
        assert!(left.xi[1] < right.xi[0] && right.xi[0] < 0.0 && right.xi[1] > 0.0);
        assert!(right.deepest[0].abs() < 1e-15, "{:?}", right.deepest);
        assert_eq!(Patch::new(&placement, 0.3, &Window::UNBOUNDED).components.len(), 1, "χ = {skew}");
        assert_eq!(Patch::new(&placement, 0.01, &Window::UNBOUNDED).components.len(), 1, "χ = {skew}");
    }
    Ok(())
}

#[test]
fn windows_cut_and_say_so() -> Result<()> {
    let delta = 0.05;
    for skew in [0.0, 0.02] {
        let placement = crossed(skew)?;
        let whole = Patch::new(&placement, delta, &Window::UNBOUNDED);
        let [a, b] = [whole.components[0].xi.high, whole.components[0].eta.high];
        let parts = |xi: [f64; 2], eta: [f64; 2]| {
            Patch::new(&placement, delta, &Window { xi: xi.into(), eta: eta.into() })
        };
        let infinity = f64::INFINITY;
        let left = parts([-infinity, 1.0], [-infinity, infinity]);
        let right = parts([1.0, infinity], [-infinity, infinity]);
        assert_eq!(left.components[0].ends, [End::Tip, End::Window]);
        assert_eq!(right.components[0].ends, [End::Window, End::Tip]);
        assert!(left.cut_by_window() && right.cut_by_window() && !whole.cut_by_window());
        assert!(((left.area() + right.area()) / whole.area() - 1.0).abs() < 1e-12);
        for cut in [-0.9 * b, -0.3, 0.0, 1.0, 0.999 * b] {
            let (low, high) = (parts([-20.0, 20.0], [-infinity, cut]), parts([-20.0, 20.0], [cut, infinity]));
            let sum = low.area() + high.area();
            assert!(
                (sum / whole.area() - 1.0).abs() < 1e-11,
                "χ = {skew} η = {cut}: {sum} of {}",
                whole.area()
            );
            for patch in [&low, &high] {
                let [c] = patch.components.as_slice() else { panic!("{}", patch.components.len()) };
                assert!(c.cut_by_window && c.eta.ends().contains(&cut), "{:?} {cut}", c.eta);
                assert!((shoelace(&c.boundary) / c.area - 1.0).abs() < 1e-2, "χ = {skew} η = {cut}");
                let extent = patch.extent().expect("an extent");
                assert_eq!((extent.xi, extent.eta), (c.xi, c.eta));
            }
        }
        assert!(parts([-1.0, 1.0], [b + 1.0, b + 2.0]).components.is_empty());
        assert!(parts([a + 1.0, a + 2.0], [-1.0, 1.0]).components.is_empty());
        let inner = parts([-1.0, 1.0], [-1.0, 1.0]);
        assert!((inner.area() - 4.0).abs() < 1e-12 && (inner.components[0].perimeter - 8.0).abs() < 1e-9);
        assert_eq!(inner.components[0].ends, [End::Window; 2]);
    }
    Ok(())
}

#[test]
fn pointed_parts_beyond_a_window_edge_end_at_the_window() -> Result<()> {
    // Only the cap η > 4 of the ellipse is seen: its ends are corners with the window, not tips.
    let patch = Patch::new(
        &crossed(0.0)?,
        0.05,
        &Window { xi: Interval::symmetric(9.0), eta: Interval::new(4.0, 9.0) },
    );
    let [c] = patch.components.as_slice() else { panic!("{} components", patch.components.len()) };
    assert_eq!(c.ends, [End::Window; 2]);
    assert!(c.boundary.iter().all(|p| p[1] >= 4.0));
    assert!(c.deepest[2] == 4.0 && c.deepest[1].abs() < 1e-6, "{:?}", c.deepest);
    Ok(())
}

#[test]
fn the_end_of_a_profile_cuts_the_patch() -> Result<()> {
    // The rail ends 2 mm right of C, the patch would reach 5.5 mm.
    let rail = profile(Arc::about([0.0, -300.0], 300.0, Half::Upper, [-30.0, 2.0])?)?;
    for skew in [0.0, 0.02] {
        let wheel = profile(Arc::line([-40.0, 0.0], [40.0, 0.0])?)?;
        let placement = Pair::new(rail.clone(), wheel, 460.0)?.placed(0.0, 0.0, skew)?;
        let patch = Patch::new(&placement, 0.05, &Window::UNBOUNDED);
        let [c] = patch.components.as_slice() else { panic!("{} components", patch.components.len()) };
        assert_eq!((c.ends, c.xi.high), ([End::Tip, End::ProfileEnd], 2.0));
        assert!(!c.cut_by_window);
        let last: Vec<_> = c.boundary.iter().filter(|p| p[0] == 2.0).collect();
        assert_eq!(last.len(), 2);
    }
    Ok(())
}

#[test]
fn the_end_of_a_wheel_profile_cuts_the_patch_along_eta() -> Result<()> {
    // A 45° cone whose profile ends 0.05 mm left of C: the column leaves it before s reaches δ.
    let rail = profile(Arc::about([0.0, -50.0], 50.0, Half::Upper, [-45.0, 20.0])?)?;
    let wheel = profile(Arc::line([-0.05, -0.05], [20.0, 20.0])?)?;
    let placement = Pair::new(rail, wheel, 460.0)?.placed(-50.0 / 2f64.sqrt(), 0.0, 0.0)?;
    let delta = 0.2;
    for skew in [0.0, 1e-3] {
        let placement = placement.with_skew(skew)?;
        let patch = Patch::new(&placement, delta, &Window::UNBOUNDED);
        let [c] = patch.components.as_slice() else { panic!("{} components", patch.components.len()) };
        let mut evaluator = Evaluator::new(&placement);
        assert!((shoelace(&c.boundary) / c.area - 1.0).abs() < 2e-3, "{} {}", shoelace(&c.boundary), c.area);
        let rows = area_by_rows(&placement, delta, c, 400);
        assert!((rows / c.area - 1.0).abs() < 1e-3, "χ = {skew}: {rows} by rows, {}", c.area);
        for &[xi, eta] in &c.boundary {
            let inside = eta + (centre_at(c, xi) - eta) * 1e-9;
            assert!(evaluator.separation(xi, inside) <= delta * (1.0 + 1e-9), "({xi}, {eta})");
        }
    }
    Ok(())
}

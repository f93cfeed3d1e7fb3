//! Separations and patches that have closed forms of their own, independent of the code and of the references.
//!
//! The comparison is made in twice the working precision where the closed form cancels; the bounds of each
//! form are in its own test.

use twofloat::TwoFloat;
use wheelrail::load::{curvatures, feasibility};
use wheelrail::patch::{Patch, Slicer, Window};
use wheelrail::placement::{Pair, Placement};
use wheelrail::profile::{Arc, Half, Profile, Segment, standards};
use wheelrail::search::{Pose, ProfilePair, Selection};
use wheelrail::separation::Evaluator;
use wheelrail::{Interval, Result};

/// Relative error of s \[1\]: 1e-13 is promised over both contact segments, which is everywhere here. Measured: two
/// roundings where C is at a profile's own flattest point or on a line, and eight on a sphere at an angle, where
/// the wheel's rise and its sagitta along ξ partly cancel. A bound of more than four times that is no test.
const RELATIVE: f64 = 1e-15;
const RELATIVE_AT_AN_ANGLE: f64 = 4e-15;

fn line(slope: f64, half: f64) -> Profile {
    let arc = Arc::line([-half, -slope * half], [half, slope * half]).expect("a line");
    Profile::new("line", "closed form", vec![Segment::arc(arc)]).expect("a chain")
}

fn arc(centre: f64, radius: f64, half: Half, x: [f64; 2]) -> Profile {
    let arc = Arc::about([0.0, centre], radius, half, x).expect("an arc");
    Profile::new("arc", "closed form", vec![Segment::arc(arc)]).expect("a chain")
}

fn placed(rail: Profile, wheel: Profile, radius: f64, x: [f64; 2]) -> Placement {
    Pair::new(rail, wheel, radius).and_then(|pair| pair.placed(x[0], x[1], 0.0)).expect("a placement")
}

fn two(a: f64, b: f64) -> TwoFloat {
    TwoFloat::new_mul(a, b)
}

/// Largest relative difference of s from `exact` over a window that holds C, and down to 1e-4 of it.
fn worst(placement: &Placement, reach: [f64; 2], exact: impl Fn(f64, f64) -> TwoFloat) -> f64 {
    let mut evaluator = Evaluator::new(placement);
    let mut worst = 0f64;
    for scale in [1.0, 1e-1, 1e-2, 1e-4] {
        for k in 0..17 * 13 {
            let (i, j) = (f64::from(k / 13), f64::from(k % 13));
            let (xi, eta) = (reach[0] * scale * (i / 8.0 - 1.0), reach[1] * scale * (j / 6.0 - 1.0));
            let (s, exact) = (evaluator.separation(xi, eta), f64::from(exact(xi, eta)));
            let error = if s == exact { 0.0 } else { ((s - exact) / exact).abs() };
            assert!(!error.is_nan(), "s({xi}, {eta}) = {s}, {exact}");
            worst = worst.max(error);
        }
    }
    worst
}

/// A cylinder along the axle on a cylindrical rail crown, both curved one way only: s = (ρ − √(ρ² − η²)) + (r − √(r² − ξ²)).
#[test]
fn crossed_cylinders() {
    let (crown, wheel) = (300.0, 460.0);
    let placement = placed(arc(-crown, crown, Half::Upper, [-50.0, 50.0]), line(0.0, 60.0), wheel, [0.0; 2]);
    let sagitta = |r: f64, x: f64| {
        let square = two(x, x);
        square / ((-square + two(r, r)).sqrt() + r)
    };
    let worst = worst(&placement, [30.0, 40.0], |xi, eta| sagitta(crown, xi) + sagitta(wheel, eta));
    println!("crossed cylinders: {worst:e}");
    assert!(worst < RELATIVE);
}

/// A cone on a cylindrical rail crown, contact on its flank: the height over (ξ, η) solves a quadratic.
#[test]
fn cone_on_cylinder() {
    for slope in [-0.05, 0.05, 0.7, -1.5] {
        let (crown, radius, x) = (300.0, 460.0, -12.0);
        let placement =
            placed(arc(-crown, crown, Half::Upper, [-60.0, 60.0]), line(slope, 60.0), radius, [0.0, x]);
        // In the contact frame of a straight profile h = 0: ζ = e cosθ, where e, the height of the point over the
        // profile along the wheel's own z, satisfies (w + e)² = w² + η² with w = A − e cos²θ and A the axle
        // distance at ξ: e² (1 − 2cos²θ) + 2Ae − η² = 0.
        let norm = slope.hypot(1.0);
        let (sin, cos) = (slope / norm, 1.0 / norm);
        let axle = radius - slope * x;
        let exact = |xi: f64, eta: f64| {
            let a = -two(xi, sin) + axle;
            let k = -two(cos, cos) * 2.0 + 1.0;
            let eta2 = two(eta, eta);
            let e = eta2 / (a + (a * a + k * eta2).sqrt());
            let square = two(xi, xi);
            let crown_drop = square / ((-square + two(crown, crown)).sqrt() + crown);
            e * cos + crown_drop
        };
        let worst = worst(&placement, [20.0, 15.0], exact);
        println!("cone {slope} on cylinder: {worst:e}");
        assert!(worst < RELATIVE);
    }
}

/// A sphere (a wheel profile with its centre on the axle, a torus without a hole) in a cylindrical groove along the
/// track, at its bottom; closely conforming ones too.
#[test]
fn sphere_in_groove() {
    for (sphere, groove) in [(400.0, 460.0), (300.0, 300.0 * (1.0 + 1e-10)), (250.0, 1e4), (460.0, 460.5)] {
        // Convex wheel profile with centre on the axle: a sphere; concave rail: a groove, both tangent at the bottom.
        let wheel = arc(sphere, sphere, Half::Lower, [-60.0, 60.0]);
        let rail = arc(groove, groove, Half::Lower, [-60.0, 60.0]);
        let placement = placed(rail, wheel, sphere, [0.0; 2]);
        let exact = |xi: f64, eta: f64| {
            // With a² = ξ²: (R − √(R² − a² − η²)) − (G − √(G² − a²)) without cancellation of close radii:
            // sagitta_R(a² + η²) − sagitta_R(a²) + [sagitta_R(a²) − sagitta_G(a²)].
            let (xx, all) = (two(xi, xi), two(xi, xi) + two(eta, eta));
            let root = |r: f64, q: TwoFloat| (-q + two(r, r)).sqrt();
            let around = two(eta, eta) / (root(sphere, xx) + root(sphere, all));
            let (r, g) = (root(sphere, xx), root(groove, xx));
            // q/(R + r) − q/(G + g) = q (G − R + g − r)/(…), g − r = (G² − R²)/(g + r).
            let apart = TwoFloat::new_sub(groove, sphere);
            let legs = apart * (TwoFloat::new_add(groove, sphere)) / (g + r);
            around + xx * (apart + legs) / ((r + sphere) * (g + groove))
        };
        let worst = worst(&placement, [30.0, 20.0], exact);
        println!("sphere {sphere} in groove {groove}: {worst:e}");
        assert!(worst < RELATIVE);
    }
}

/// The same sphere touched off its bottom, in a groove along the track: the contact frame is turned, and the sphere
/// looks the same from every direction.
#[test]
fn sphere_in_groove_at_a_contact_angle() {
    let (sphere, groove) = (400.0, 430.0);
    let wheel = arc(sphere, sphere, Half::Lower, [-330.0, 330.0]);
    let rail = arc(groove, groove, Half::Lower, [-340.0, 340.0]);
    for angle in [0.3f64, -0.7] {
        let x = [groove * angle.sin(), sphere * angle.sin()];
        let placement = placed(rail.clone(), wheel.clone(), sphere, x);
        let exact = |xi: f64, eta: f64| {
            let (xx, all) = (two(xi, xi), two(xi, xi) + two(eta, eta));
            let root = |r: f64, q: TwoFloat| (-q + two(r, r)).sqrt();
            all / (root(sphere, all) + sphere) - xx / (root(groove, xx) + groove)
        };
        let worst = worst(&placement, [30.0, 20.0], exact);
        println!("sphere in groove at {angle}: {worst:e}");
        assert!(worst < RELATIVE_AT_AN_ANGLE);
    }
}

/// Crossed cylinders of radii R_x (crown) and R_y (wheel): the curve s = δ is the ellipse with semi-axes √(2R_xδ),
/// √(2R_yδ), up to a share of δ/R.
#[test]
fn crossed_cylinders_interpenetrate_in_an_ellipse() {
    let (crown, wheel) = (300.0, 460.0);
    let placement = placed(arc(-crown, crown, Half::Upper, [-50.0, 50.0]), line(0.0, 60.0), wheel, [0.0; 2]);
    let c = curvatures(&placement);
    let half = |r: f64| 0.5 / r;
    assert!((c.b_per_mm - half(crown)).abs() < 1e-18 && (c.a_per_mm - half(wheel)).abs() < 1e-18, "{c:?}");
    let mut last = None;
    for delta in [1e-1, 1e-2, 1e-3, 1e-4] {
        let semi = [(2.0 * crown * delta).sqrt(), (2.0 * wheel * delta).sqrt()];
        let window = Window { xi: Interval::symmetric(30.0), eta: Interval::symmetric(40.0) };
        let patch = Patch::new(&placement, delta, &window);
        assert_eq!(patch.components.len(), 1);
        let component = &patch.components[0];
        // Exactly: R − √(R² − a²) = δ, a² = δ(2R − δ).
        let exact = [crown, wheel].map(|r| (delta * (2.0 * r - delta)).sqrt());
        for (k, extent) in [component.xi, component.eta].into_iter().enumerate() {
            let error = (extent[1] - exact[k]).abs().max((extent[0] + exact[k]).abs()) / exact[k];
            // η's own extent is taken among the loop's points.
            assert!(error < [1e-14, 1e-4][k], "{delta}: {error:e} of {}", exact[k]);
        }
        let at_middle = Slicer::new(&placement, delta).slice(0.0).expect("the middle of the patch").eta[1];
        assert!((at_middle / exact[1] - 1.0).abs() < 1e-14, "{at_middle}");
        let ellipse = std::f64::consts::PI * semi[0] * semi[1];
        let off = (component.area / ellipse - 1.0).abs();
        assert!(off < delta / crown, "{delta}: area off by {off:e}");
        // O(δ): ten times less for a tenth of δ.
        if let Some(before) = last {
            let ratio: f64 = before / off;
            assert!((ratio - 10.0).abs() < 0.1, "{delta}: {ratio}");
        }
        last = Some(off);
        let inside = |[xi, eta]: [f64; 2]| (xi / semi[0]).hypot(eta / semi[1]) - 1.0;
        let farthest = component.boundary.iter().map(|p| inside(*p).abs()).fold(0.0, f64::max);
        assert!(farthest < delta / crown, "{delta}: {farthest:e}");
    }
}

/// The patch's area by a quadrature of its own: the trapezoid rule in the angle about C, radii by bisection of s.
#[test]
fn patch_areas_agree_with_a_polar_quadrature() {
    let conforming = placed(
        arc(-300.0, 300.0, Half::Upper, [-60.0, 60.0]),
        arc(-330.0, 330.0, Half::Upper, [-60.0, 60.0]),
        460.0,
        [3.0, 4.0],
    );
    let cone = placed(arc(-80.0, 80.0, Half::Upper, [-50.0, 50.0]), line(0.4, 60.0), 460.0, [0.0, -10.0]);
    for (placement, delta) in [(&conforming, 0.002), (&cone, 0.05), (&cone, 1e-5)] {
        let window = Window { xi: Interval::symmetric(50.0), eta: Interval::symmetric(50.0) };
        let patch = Patch::new(placement, delta, &window);
        assert_eq!(patch.components.len(), 1);
        let polar = polar_area(placement, delta);
        let error = (patch.area() / polar - 1.0).abs();
        println!("area {} by slices, {polar} by rays: {error:e}", patch.area());
        assert!(error < 1e-9, "{error:e}");
    }
}

/// ½ ∫ r² dφ about C by the trapezoid rule, which converges geometrically for a periodic integrand.
fn polar_area(placement: &Placement, delta: f64) -> f64 {
    const RAYS: u32 = 4096;
    let mut evaluator = Evaluator::new(placement);
    let mut sum = 0.0;
    for k in 0..RAYS {
        let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / f64::from(RAYS)).sin_cos();
        let mut low = 0.0;
        let mut high = 45.0;
        for _ in 0..60 {
            let r = 0.5 * (low + high);
            let s = evaluator.separation(r * cos, r * sin);
            if s < delta { low = r } else { high = r }
        }
        sum += 0.5 * low * low;
    }
    sum * std::f64::consts::TAU / f64::from(RAYS)
}

#[test]
fn a_contact_on_a_kink_is_where_the_closed_segments_cross() -> Result<()> {
    // The flange tip of this drawing: a kink of 10° whose arcs, drawn with a step of 2 µm, cross 11 µm beside it.
    let pair = Pair::new(standards::rail("56E1")?, standards::wheel("APTA-120")?, 625.0)?;
    let profiles = ProfilePair::new(&pair)?;
    let mut search = profiles.search();
    let contact =
        search.touch(&Pose::new(8.045, 0.0, 0.0)?, &Selection { within: 0.0, apart: 0.0 })?.contacts[0];
    assert!(contact.kink(), "{contact:?}");
    let placement = contact.placed(&pair)?;
    let z = placement.wheel().point().station.z;
    assert!((z + 9.525_298_313_755).abs() < 1e-12, "{z}");
    assert!(feasibility(&placement).is_some_and(|found| found.feasible));
    Ok(())
}

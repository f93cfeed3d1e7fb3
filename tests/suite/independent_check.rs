//! The parry3d check agrees on every scene it should agree on, and on no mutation.

use crate::common::{ReferenceFile, ReferenceSegment, references};
use wheelrail::Interval;
use wheelrail::nalgebra::{Unit, Vector3};
use wheelrail::patch::Window;
use wheelrail::placement::{Pair, Placement};
use wheelrail::profile::{Arc, Half, Polynomial, Profile, Segment, Shape, standards};
use wheelrail::separation::Evaluator;
use wheelrail_check::{Answer, Report, Request, check};
use wheelrail_report::verification::{Subject, Verified, built_in_pairs, verify};

/// What the checker must reach itself, so that its verdict means something \[mm\].
const FLOOR: f64 = 1e-12;
const BRACKET: f64 = 1e-9;

/// The check of a placed pair against the point-wise evaluator over `own`, with a mutation of its answers.
fn checked(
    placement: &Placement,
    own: &Placement,
    request: &Request,
    mutate: impl Fn(&mut Answer, f64, f64),
) -> Report {
    let mut evaluator = Evaluator::new(own);
    let mut answer = |xi: f64, eta: f64| {
        let mut answer = Answer::of(&mut evaluator, xi, eta);
        mutate(&mut answer, xi, eta);
        answer
    };
    check(placement, request, &mut answer).expect("finite profiles")
}

fn assert_agrees(Verified { name, report }: &Verified) {
    assert!(report.agrees, "{name}\n{report}");
    let counts = report.counts;
    assert!(counts.compared >= counts.points / 2, "{name}\n{report}");
    assert!(report.floors.len() == 4 && report.floors.iter().all(|f| f.ray_mm < FLOOR), "{name}\n{report}");
    assert!(report.bracket_mm > 0.0 && report.bracket_mm < BRACKET, "{name}\n{report}");
    assert!(report.distances.violation.compared > 0, "{name}\n{report}");
    assert!(report.distances.bodies_mm > 0.0, "{name}\n{report}");
}

fn subject(reference: &ReferenceFile) -> Subject {
    Subject::of_reference(reference).expect("a scene that can be placed")
}

#[test]
fn every_reference_scene_agrees_with_and_without_skew() {
    for reference in references() {
        let subject = subject(&reference);
        for subject in subject.skewed().expect("finite skews").into_iter().chain([subject.clone()]) {
            let verified = subject.verify().expect("finite profiles");
            println!("{}: {:.3} s\n{}", verified.name, verified.report.seconds, verified.report);
            assert_agrees(&verified);
        }
    }
}

#[test]
fn every_built_in_pair_agrees() {
    let pairs = built_in_pairs().expect("profiles with a point at x = 0");
    assert_eq!(pairs.len(), 40 * 14);
    verify(&pairs).expect("finite profiles").iter().for_each(assert_agrees);
}

/// Scenes whose bodies are one arc or line each.
fn simple_references() -> Vec<ReferenceFile> {
    let simple = |r: &ReferenceFile| r.scene.rail.len() == 1 && r.scene.wheel.len() == 1;
    let all: Vec<_> = references().into_iter().filter(simple).collect();
    assert!(all.len() >= 5);
    all
}

#[test]
fn a_wrong_separation_is_caught() {
    for reference in references() {
        let Subject { placement, request, .. } = subject(&reference);
        for wrong in [1e-6, -1e-6, 1e-10] {
            let report = checked(&placement, &placement, &request, |a, _, _| a.separation += wrong);
            assert!(!report.agrees, "{}: {wrong} mm\n{report}", reference.name);
            assert!((report.separation.median - wrong.abs()).abs() < 1e-12, "{report}");
        }
        // At a single point.
        let at = [request.window.xi.high, request.window.eta.low];
        let report = checked(&placement, &placement, &request, |a, xi, eta| {
            if [xi, eta] == at {
                a.separation += 1e-6;
            }
        });
        assert!(!report.agrees && report.separation.worst_at_mm == at, "{}\n{report}", reference.name);
        let report = checked(&placement, &placement, &request, |a, _, eta| {
            if eta > 0.0 {
                a.separation = f64::NAN;
            }
        });
        assert!(!report.agrees, "{}\n{report}", reference.name);
    }
}

#[test]
fn a_wrong_radius_is_caught() {
    for reference in simple_references() {
        let Subject { placement, request, .. } = subject(&reference);
        for body in 0..3 {
            let mut wrong = reference.clone();
            let segments = [&mut wrong.scene.rail, &mut wrong.scene.wheel];
            if let Some(segments) = segments.into_iter().nth(body) {
                let ReferenceSegment::Arc { r, .. } = &mut segments[0] else { continue };
                *r *= 1.0 + 1e-6;
            } else {
                wrong.scene.wheel_radius *= 1.0 + 1e-6;
            }
            let own = subject(&wrong).placement;
            // 1e-6 of a crown of 10 m is a nm at 15 mm from C: the window of the scene, not a point of it.
            let report = checked(&placement, &own, &request, |_, _, _| {});
            assert!(!report.agrees, "{} {body}\n{report}", reference.name);
        }
    }
}

#[test]
fn a_wrong_normal_is_caught() {
    for reference in references() {
        let Subject { placement, request, .. } = subject(&reference);
        type Normal = Option<Unit<Vector3<f64>>>;
        let flip = |n: &mut Normal| *n = n.map(|n| -n);
        let tilt = |n: &mut Normal| *n = n.map(|n| Unit::new_unchecked(*n + 1e-9 * Vector3::y()));
        let rail = checked(&placement, &placement, &request, |a, _, _| flip(&mut a.normals.rail));
        let wheel = checked(&placement, &placement, &request, |a, _, _| flip(&mut a.normals.wheel));
        let tilted = checked(&placement, &placement, &request, |a, _, _| tilt(&mut a.normals.wheel));
        let missing = checked(&placement, &placement, &request, |a, _, _| a.normals.rail = None);
        for report in [rail, wheel, tilted, missing] {
            assert!(!report.agrees && !report.normals.within(), "{}\n{report}", reference.name);
        }
    }
}

#[test]
fn a_skew_left_out_is_caught() {
    for reference in references() {
        let Subject { placement: own, request, .. } = subject(&reference);
        let placement = own.with_skew(own.skew() + 1e-3).expect("a finite skew");
        let report = checked(&placement, &own, &request, |_, _, _| {});
        assert!(!report.agrees, "{}\n{report}", reference.name);
    }
}

/// A rail and a wheel \[mm\], in contact at chosen abscissae.
fn pair(rail: Profile, wheel: Profile) -> Pair {
    Pair::new(rail, wheel, 460.0).expect("finite profiles")
}

fn arc(radius: f64, half: f64) -> Profile {
    let arc = Arc::about([0.0, -radius], radius, Half::Upper, [-half, half]).expect("an arc");
    Profile::new("crown", "test", vec![Segment::arc(arc)]).expect("a profile")
}

fn window(xi: [f64; 2], eta: [f64; 2], approach: f64) -> Request {
    Request { window: Window { xi: xi.into(), eta: eta.into() }, approach }
}

fn as_placed(placement: &Placement, request: &Request) -> Report {
    checked(placement, placement, request, |_, _, _| {})
}

#[test]
fn contact_at_an_edge_agrees() {
    // The wheel's profile ends at x = 8, steeper than the crown there: ξ is tangent to the rail only.
    let line = Arc::line([-30.0, 1.9], [8.0, 0.0]).expect("a line");
    let wheel = Profile::new("edge", "test", vec![Segment::arc(line)]).expect("a profile");
    let angle = -(8.0f64 / 300.0).asin();
    let placement = pair(arc(300.0, 36.0), wheel).placed_along([8.0, angle], [8.0, angle], 0.0);
    let placement = placement.expect("points of both");
    assert!(placement.rail().is_smooth() && !placement.wheel().is_smooth());
    let report = as_placed(&placement, &window([-5.0, 5.0], [-5.0, 5.0], 0.02));
    assert!(report.agrees, "{report}");
    // A smooth contact whose ξ is turned is still caught.
    let crowns = pair(arc(300.0, 36.0), arc(400.0, 36.0));
    let straight = crowns.placed(0.0, 0.0, 0.0).expect("points of both");
    let turned = crowns.placed_along([0.0, 1e-6], [0.0, 0.0], 0.0).expect("points of both");
    let request = window([-5.0, 5.0], [-5.0, 5.0], 0.02);
    for report in [as_placed(&turned, &request), checked(&turned, &straight, &request, |_, _, _| {})] {
        assert!(!report.agrees, "{report}");
    }
}

#[test]
fn the_closings_of_a_drawing_agree() {
    // S1002's zones A and B miss each other by 2.8e-10 mm; the point over their joint is in every check.
    let (rail, wheel) = (standards::rail("60E1"), standards::wheel("S1002"));
    let pair = pair(rail.expect("built in"), wheel.expect("built in"));
    for x in [4.0, 8.0, 12.0, 16.0] {
        let placement = pair.placed(x, x, 0.0).expect("points of both");
        let report = as_placed(&placement, &window([-20.0, 30.0], [-15.0, 15.0], 0.1));
        assert!(report.agrees, "{x}\n{report}");
        assert_eq!(report.normals.compared, 2 * report.counts.compared, "{report}");
    }
}

#[test]
fn an_inflection_between_foot_and_closest_point_agrees() {
    // The slope of z = x³ − 0.3x is least at x = 0, inside the piece and on the closest point's way.
    let wave = Polynomial::graph(&[0.0, -0.3, 0.0, 1.0], [-0.6, 0.6]).expect("a cubic");
    let segment = Segment { label: String::new(), shape: Shape::Polynomial(wave) };
    let rail = Profile::new("wave", "test", vec![segment]).expect("a profile");
    let placement = pair(rail, arc(300.0, 36.0)).placed(-0.316, 0.0, 0.0).expect("points of both");
    let report = as_placed(&placement, &window([-0.2, 0.8], [-2.0, 2.0], 0.05));
    assert!(report.agrees, "{report}");
}

#[test]
fn a_check_without_any_closest_distance_does_not_agree() {
    let placement = pair(arc(300.0, 36.0), arc(3000.0, 36.0)).placed(0.0, 0.0, 0.0).expect("points of both");
    let report = as_placed(&placement, &window([28.0, 34.0], [-5.0, 5.0], 0.0));
    assert_eq!((report.distances.violation.compared, report.agrees), (0, false), "{report}");
}

/// A window of 270 km along ξ holds no more of the bodies than one of 270 m, and its check takes no more cells.
#[test]
fn a_far_value_of_the_grid_costs_nothing() {
    let rail = standards::rail("46E4").expect("a rail");
    let wheel = standards::wheel("S1002").expect("a wheel");
    let placement =
        Pair::new(rail, wheel, 460.0).and_then(|pair| pair.placed(0.0, 0.0, 0.0)).expect("a pair");
    for far in [270.0, 270_185.0, 1e9] {
        let window = Window { xi: Interval::new(-far, 9.0), eta: Interval::symmetric(0.8) };
        let report = checked(&placement, &placement, &Request { window, approach: 0.05 }, |_, _, _| {});
        assert!(report.agrees, "{far}\n{report}");
    }
    let window = Window { xi: Interval::new(-9.0, f64::INFINITY), eta: Interval::symmetric(0.8) };
    let mut evaluator = Evaluator::new(&placement);
    let mut answer = |xi: f64, eta: f64| Answer::of(&mut evaluator, xi, eta);
    assert!(check(&placement, &Request { window, approach: 0.05 }, &mut answer).is_err());
}

/// A profile of which a part lies a thousand kilometres away is refused before its mesh is made.
#[test]
fn bodies_too_large_for_a_mesh_are_refused() {
    let arc = |radius: f64, half: f64| {
        let arc = Arc::about([0.0, -radius], radius, Half::Upper, [-half, half]).expect("an arc");
        Profile::new("arc", "", vec![Segment::arc(arc)]).expect("a profile")
    };
    let pair = Pair::new(arc(1e9, 1e8), arc(1e10, 1e8), 1e9).expect("a pair");
    let placement = pair.placed(0.0, 0.0, 0.0).expect("a placed pair");
    let window = Window { xi: Interval::symmetric(1e8), eta: Interval::symmetric(1e8) };
    let mut evaluator = Evaluator::new(&placement);
    let mut answer = |xi: f64, eta: f64| Answer::of(&mut evaluator, xi, eta);
    let refused = check(&placement, &Request { window, approach: 0.05 }, &mut answer);
    assert!(refused.is_err_and(|error| error.found.contains("cells")));
}

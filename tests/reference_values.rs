//! Every scene of `tests/reference` against its 60-digit values: the one table of accuracy bounds.
#![allow(clippy::expect_used, clippy::panic, clippy::print_stdout)]

mod common;

use common::{Reference, references};
use wheelrail::interpenetration::Slicer;
use wheelrail::placement::Placement;
use wheelrail::separation::axis::EtaAxis;
use wheelrail::separation::grid::Method;
use wheelrail::separation::plan;

/// What is promised to users; no row of [`BOUNDS`] may be looser.
const PROMISED_RELATIVE: f64 = 1e-13;
const PROMISED_ABSOLUTE: f64 = 2e-12;

/// A row whose measured error is this much below its bound fails as "tighten me".
const MOST_SLACK: f64 = 4.0;

/// One measured quantity and the bound it is held to.
struct Bound {
    /// Method that computes it.
    method: Method,
    /// Largest relative error of s where the point lies over both contact segments.
    relative: f64,
    /// Largest absolute error elsewhere \[mm\], × max(1, R_max/300 mm).
    absolute: f64,
}

/// The historical baseline cancels (erratum 7): it has absolute digits only, and near C no relative ones.
const BOUNDS: [Bound; 3] = [
    Bound { method: Method::Spectral, relative: 5e-15, absolute: 2.5e-15 },
    Bound { method: Method::Pointwise, relative: 3e-15, absolute: 2.5e-15 },
    Bound { method: Method::ReportNewton, relative: f64::INFINITY, absolute: 1.2e-13 },
];

/// |Δη| ≤ (R/η) × the bound on s there, as a share of that.
const BOUNDARY_SHARE: f64 = 0.01;

fn exact(text: &str) -> f64 {
    let value: f64 = text.parse().expect("a number");
    // 60-digit arithmetic leaves ±1e-59 where s is 0.
    if value.abs() < 1e-40 { 0.0 } else { value }
}

fn over_contact(placement: &Placement, xi: f64, eta: f64) -> bool {
    let (rail, wheel) = (&placement.rail.section, &placement.wheel.section);
    let frame = wheel.frame;
    // The foot ξ − e sinθ of the point on the wheel profile.
    let e = eta * eta / (2.0 * placement.rolling_radius());
    let inside = |section: &wheelrail::profile::Section, xi: f64| {
        section.piece_at(xi).is_some_and(|piece| section.contact == Some(piece.branch))
    };
    inside(rail, xi) && inside(wheel, xi) && inside(wheel, xi - e * frame.sin)
}

/// Largest (relative error over the contact, scaled absolute error elsewhere) of one method on one scene.
fn errors(reference: &Reference, method: Option<Method>, estimate: &mut f64) -> (f64, f64, f64) {
    let placement = reference.placement().expect("a placement");
    let scene = &reference.scene;
    let mut eta = scene.eta.clone();
    eta.sort_by(f64::total_cmp);
    let axis = EtaAxis::new(&eta);
    let plan = plan::plan(&placement, &scene.xi, &axis, 1e-12, method);
    *estimate = plan.error;
    let mut values = vec![0.0; scene.xi.len() * eta.len()];
    plan.choice.fill(&placement, &scene.xi, &axis, &mut values);
    let scale = (reference.largest_radius() / 300.0).max(1.0);
    let (mut relative, mut absolute, mut plain) = (0f64, 0f64, 0f64);
    for (k, (xi, eta_k, value)) in reference.separation.iter().enumerate() {
        let j = eta.iter().position(|e| e == eta_k).expect("η of the scene");
        let s = values[k / eta.len() * eta.len() + j];
        let Some(value) = value else {
            assert!(s.is_nan(), "{}: s({xi}, {eta_k}) = {s}, but there is no surface", reference.name);
            continue;
        };
        let value = exact(value);
        let error = (s - value).abs();
        assert!(!error.is_nan(), "{}: s({xi}, {eta_k}) is {s}, not {value:e}", reference.name);
        plain = plain.max(error);
        if over_contact(&placement, *xi, *eta_k) {
            relative = relative.max(if error == 0.0 { 0.0 } else { error / value.abs() });
        } else {
            absolute = absolute.max(error / scale);
        }
    }
    (relative, absolute, plain)
}

#[test]
fn separation_keeps_its_digits() {
    let references = references();
    for bound in &BOUNDS {
        let method = bound.method;
        assert!(method == Method::ReportNewton || bound.relative <= PROMISED_RELATIVE);
        assert!(bound.absolute <= PROMISED_ABSOLUTE);
        let (mut relative, mut absolute) = (0f64, 0f64);
        for reference in &references {
            let (r, a, _) = errors(reference, Some(method), &mut 0.0);
            println!("{:13} {:24} relative {r:8.1e} absolute {a:8.1e}", method.name(), reference.name);
            assert!(r <= bound.relative, "{} {}: relative error {r:e}", method.name(), reference.name);
            assert!(a <= bound.absolute, "{} {}: absolute error {a:e}", method.name(), reference.name);
            (relative, absolute) = (relative.max(r), absolute.max(a));
        }
        let tight = |measured: f64, bound: f64| bound.is_infinite() || measured * MOST_SLACK >= bound;
        assert!(tight(relative, bound.relative), "tighten {}: relative {relative:e}", method.name());
        assert!(tight(absolute, bound.absolute), "tighten {}: absolute {absolute:e}", method.name());
    }
}

#[test]
fn the_estimate_bounds_the_error_and_is_not_idle() {
    for reference in references() {
        let mut estimate = 0.0;
        let (.., error) = errors(&reference, None, &mut estimate);
        println!("{:24} estimate {estimate:8.1e} error {error:8.1e}", reference.name);
        assert!(error <= estimate, "{}: {error:e} > {estimate:e}", reference.name);
        assert!(estimate <= 100.0 * error, "{}: {estimate:e} for {error:e}", reference.name);
    }
}

#[test]
fn the_boundary_is_as_good_as_the_separation() {
    let mut worst = 0f64;
    for reference in references() {
        let placement = reference.placement().expect("a placement");
        let scale = (reference.largest_radius() / 300.0).max(1.0);
        for (delta, xi, value) in &reference.boundary {
            let eta = Slicer::new(&placement, *delta).slice(*xi).map(|slice| slice.eta[1]);
            let Some(value) = value else {
                assert_eq!(eta, None, "{}: ξ = {xi}, δ = {delta}", reference.name);
                continue;
            };
            let value = exact(value);
            let error = (eta.unwrap_or(f64::NAN) - value).abs();
            let bound = if over_contact(&placement, *xi, value) {
                PROMISED_RELATIVE * delta
            } else {
                PROMISED_ABSOLUTE * scale
            };
            let allowed = reference.scene.wheel_radius / value * bound + f64::EPSILON * value;
            assert!(
                error <= BOUNDARY_SHARE.max(2.0 * f64::EPSILON * value / allowed) * allowed,
                "{}: η({xi}) = {eta:?}, not {value}",
                reference.name
            );
            worst = worst.max(error / allowed);
        }
    }
    println!("worst share {worst}");
}

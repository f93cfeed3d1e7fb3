//! Yawed wheels against the 60-digit values of `tests/reference_yawed`, to the bounds of the unyawed ones.
#![allow(clippy::expect_used, clippy::panic, clippy::print_stdout)]

mod common;

use common::{ReferenceScene, chain, folder};
use serde::Deserialize;
use wheelrail::interpenetration::Slicer;
use wheelrail::placement::{Pair, Placement};
use wheelrail::separation::axis::EtaAxis;
use wheelrail::separation::grid::Method;
use wheelrail::separation::plan;

/// Largest relative error over both contact segments, and absolute error \[mm\] elsewhere.
const RELATIVE: f64 = 1e-13;
const ABSOLUTE: f64 = 2e-12;

#[derive(Debug, Deserialize)]
struct Yawed {
    scene: ReferenceScene,
    separation: Vec<(f64, f64, Option<String>)>,
    /// δ, ξ, both roots of s = δ in η, or none.
    boundary: Vec<(f64, f64, Vec<String>)>,
}

const NAMES: [&str; 3] = ["yawed_crown_on_cone", "yawed_60E1_S1002_tread", "yawed_flange"];

fn load(name: &str) -> (Yawed, Placement) {
    let text =
        std::fs::read_to_string(folder("reference_yawed").join(name).with_extension("json")).expect("values");
    let yawed: Yawed = serde_json::from_str(&text).expect("a file of values");
    let scene = &yawed.scene;
    let profiles =
        (chain("rail", &scene.rail).expect("a rail"), chain("wheel", &scene.wheel).expect("a wheel"));
    let pair = Pair::new(profiles.0, profiles.1, scene.wheel_radius).expect("a pair");
    let placement = pair.placed(scene.contact_rail_x, scene.contact_wheel_x, scene.chi).expect("a placement");
    (yawed, placement)
}

fn over_contact(placement: &Placement, xi: f64, eta: f64) -> bool {
    let (rail, wheel) = (&placement.rail.section, &placement.wheel.section);
    let (sin, cos) = placement.skew.sin_cos();
    let (xi_w, eta_w) = (xi * cos + eta * sin, eta * cos - xi * sin);
    let e = eta_w * eta_w / (2.0 * placement.rolling_radius());
    let inside = |section: &wheelrail::profile::Section, xi: f64| {
        section.piece_at(xi).is_some_and(|piece| section.contact == Some(piece.branch))
    };
    inside(rail, xi) && inside(wheel, xi_w) && inside(wheel, xi_w - e * wheel.frame.sin)
}

/// Worst (relative, absolute) error of s over an axis that holds the values' η among many others.
fn errors(yawed: &Yawed, placement: &Placement, method: Method, extra: usize) -> (f64, f64) {
    let mut eta = yawed.scene.eta.clone();
    eta.extend((0..extra).map(|k| -11.3 + 0.21 * k as f64));
    eta.sort_by(f64::total_cmp);
    let axis = EtaAxis::new(&eta);
    let plan = plan::plan(placement, &yawed.scene.xi, &axis, 1e-12, Some(method));
    let mut values = vec![0.0; yawed.scene.xi.len() * eta.len()];
    plan.choice.fill(placement, &yawed.scene.xi, &axis, &mut values);
    let (mut relative, mut absolute) = (0f64, 0f64);
    for (k, (xi, eta_k, value)) in yawed.separation.iter().enumerate() {
        let j = eta.iter().position(|e| e == eta_k).expect("η of the scene");
        let s = values[k / yawed.scene.eta.len() * eta.len() + j];
        let Some(value) = value else {
            assert!(s.is_nan(), "s({xi}, {eta_k}) = {s}, but there is no surface");
            continue;
        };
        let value: f64 = value.parse().expect("a number");
        let value = if value.abs() < 1e-40 { 0.0 } else { value };
        let error = (s - value).abs();
        assert!(!error.is_nan(), "s({xi}, {eta_k}) is {s}, not {value:e}");
        if !over_contact(placement, *xi, *eta_k) {
            absolute = absolute.max(error);
        } else if error > 0.0 {
            relative = relative.max(error / value.abs());
        }
    }
    (relative, absolute)
}

#[test]
fn yawed_separation_keeps_its_digits() {
    for name in NAMES {
        let (yawed, placement) = load(name);
        for (method, extra) in [(Method::Pointwise, 0), (Method::Spectral, 110)] {
            let (relative, absolute) = errors(&yawed, &placement, method, extra);
            println!("{name} {}: relative {relative:.1e} absolute {absolute:.1e}", method.name());
            assert!(relative <= RELATIVE, "{name} {}: relative {relative:e}", method.name());
            assert!(absolute <= ABSOLUTE, "{name} {}: absolute {absolute:e}", method.name());
        }
    }
}

#[test]
fn yawed_boundaries_have_both_roots() {
    for name in NAMES {
        let (yawed, placement) = load(name);
        for (delta, xi, roots) in &yawed.boundary {
            let slice = Slicer::new(&placement, *delta).slice(*xi);
            let roots: Vec<f64> = roots.iter().map(|r| r.parse().expect("a number")).collect();
            let [low, high] = roots[..] else {
                assert!(roots.is_empty() && slice.is_none(), "{name}: ξ = {xi}, δ = {delta}: {slice:?}");
                continue;
            };
            let found = slice.map_or([f64::NAN; 2], |slice| slice.eta);
            // |Δη| ≤ the bound on s over the slope ∂s/∂η, about (η − η of the lowest point)/R.
            let bound = if over_contact(&placement, *xi, high) { RELATIVE * delta } else { ABSOLUTE };
            let slope = (high - low) / 2.0 / yawed.scene.wheel_radius;
            for (found, exact) in found.into_iter().zip([low, high]) {
                let allowed = bound / slope + 4.0 * f64::EPSILON * exact.abs();
                assert!((found - exact).abs() <= allowed, "{name}: η({xi}; {delta}) = {found}, not {exact}");
            }
        }
    }
}

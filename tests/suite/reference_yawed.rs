//! Yawed wheels against the 60-digit values of `tests/reference_yawed`, to bounds near those of the unyawed ones.

use crate::common::{ReferenceFile, Worst, repository};
use wheelrail::patch::Slicer;
use wheelrail::placement::Placement;
use wheelrail::separation::{EtaAxis, FULL_PRECISION, Method, plan};
use wheelrail_report::errors::{compare, over_contact};

/// Largest relative error over both contact segments, and absolute error \[mm\] elsewhere.
const RELATIVE: f64 = 1e-14;
const ABSOLUTE: f64 = 2.5e-15;

/// Values, and the boundary in this folder's format: δ, ξ, both roots of s = δ in η, or none.
struct Yawed {
    reference: ReferenceFile,
    boundary: Vec<(f64, f64, Vec<String>)>,
}

const NAMES: [&str; 3] = ["yawed_crown_on_cone", "yawed_60E1_S1002_tread", "yawed_flange"];

fn load(name: &str) -> (Yawed, Placement) {
    let text = std::fs::read_to_string(repository("tests/reference_yawed").join(name).with_extension("json"))
        .expect("values");
    let mut values: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let boundary = std::mem::replace(&mut values["boundary"], serde_json::json!([]));
    let boundary = serde_json::from_value(boundary).expect("a boundary");
    let reference: ReferenceFile = serde_json::from_value(values).expect("a file of values");
    let placement = reference.placement().expect("a placement");
    (Yawed { reference, boundary }, placement)
}

#[test]
fn yawed_separation_keeps_its_digits() {
    for name in NAMES {
        let (mut yawed, placement) = load(name);
        // Few values of η are evaluated one by one, more are interpolated.
        for (method, extra) in [(Method::Pointwise, 0), (Method::Spectral, 110)] {
            extend(&mut yawed.reference, extra);
            let [xi, eta] = yawed.reference.scene.axes();
            let plan = plan(&placement, &xi, &EtaAxis::new(&eta), FULL_PRECISION, Some(method));
            let worst = Worst::of(name, &compare(&yawed.reference, &placement, &plan.choice, 0));
            println!("{name} {}: {worst:?}", method.name());
            assert!(worst.relative <= RELATIVE, "{name} {}: {worst:?}", method.name());
            assert!(worst.elsewhere <= ABSOLUTE, "{name} {}: {worst:?}", method.name());
        }
    }
}

#[test]
fn yawed_grids_keep_every_tolerance_and_know_their_error() {
    for name in NAMES {
        let (mut yawed, placement) = load(name);
        extend(&mut yawed.reference, 110);
        let [xi, eta] = yawed.reference.scene.axes();
        for tolerance in [1e-3, 1e-6, 1e-9, 1e-12] {
            let plan = plan(&placement, &xi, &EtaAxis::new(&eta), tolerance, None);
            let worst = Worst::of(name, &compare(&yawed.reference, &placement, &plan.choice, 0));
            println!("{name} {tolerance:e}: {:e} of {:e}", worst.anywhere, plan.error);
            assert!(
                worst.anywhere <= plan.error && plan.error <= tolerance,
                "{name} {tolerance:e}: {worst:?}"
            );
        }
    }
}

/// Adds values of η for which there is no reference.
fn extend(reference: &mut ReferenceFile, extra: usize) {
    reference.scene.eta.extend((0..extra).map(|k| -11.3 + 0.21 * k as f64));
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
            let found = slice.map_or([f64::NAN; 2], |slice| slice.eta.ends());
            // |Δη| ≤ the bound on s over the slope ∂s/∂η, about (η − η of the lowest point)/R.
            let bound = if over_contact(&placement, *xi, high) { RELATIVE * delta } else { ABSOLUTE };
            let slope = (high - low) / 2.0 / yawed.reference.scene.wheel_radius;
            for (found, exact) in found.into_iter().zip([low, high]) {
                let allowed = bound / slope + 4.0 * f64::EPSILON * exact.abs();
                assert!((found - exact).abs() <= allowed, "{name}: η({xi}; {delta}) = {found}, not {exact}");
            }
        }
    }
}

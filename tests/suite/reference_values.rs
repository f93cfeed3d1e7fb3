//! Every scene of `crates/report/src/reference` and `tests/reference_spline` against its 60-digit values: the one table of accuracy bounds.

use crate::common::{ReferenceFile, Worst, references, references_in};
use wheelrail::internal::missing_for_report_newton;
use wheelrail::patch::Slicer;
use wheelrail::separation::{EtaAxis, Method};
use wheelrail::separation::{FULL_PRECISION, plan};
use wheelrail_report::errors::{compare, over_contact};
use wheelrail_report::reference::exact;

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
    Bound { method: Method::Spectral, relative: 2e-15, absolute: 2.5e-15 },
    Bound { method: Method::Pointwise, relative: 3e-15, absolute: 2.5e-15 },
    Bound { method: Method::ReportNewton, relative: f64::INFINITY, absolute: 1.2e-13 },
];

/// |Δη| ≤ (R/η) × the bound on s there, as a share of that.
const BOUNDARY_SHARE: f64 = 0.01;

/// Scenes of the drawings' segments, and of the cubic spans that measured profiles are made of.
fn all_references() -> Vec<ReferenceFile> {
    references().into_iter().chain(references_in("reference_spline")).collect()
}

fn scale(reference: &ReferenceFile) -> f64 {
    (reference.scene.largest_radius() / 300.0).max(1.0)
}

/// Largest errors of one method on one scene, and their estimate \[mm\].
fn errors(reference: &ReferenceFile, method: Option<Method>, tolerance: f64) -> (Worst, f64) {
    let placement = reference.placement().expect("a placement");
    let [xi, eta] = reference.scene.axes();
    let plan = plan(&placement, &xi, &EtaAxis::new(&eta), tolerance, method);
    // Few columns are computed one by one, many by strips.
    let points = [0, 200, 2000].map(|columns| compare(reference, &placement, &plan.choice, columns)).concat();
    (Worst::of(&reference.name, &points), plan.error)
}

#[test]
fn separation_keeps_its_digits() {
    let references = all_references();
    for bound in &BOUNDS {
        let method = bound.method;
        assert!(method == Method::ReportNewton || bound.relative <= PROMISED_RELATIVE);
        assert!(bound.absolute <= PROMISED_ABSOLUTE);
        let (mut relative, mut absolute) = (0f64, 0f64);
        for reference in &references {
            let placement = reference.placement().expect("a placement");
            if method == Method::ReportNewton && missing_for_report_newton(&placement).is_some() {
                continue;
            }
            let (worst, _) = errors(reference, Some(method), FULL_PRECISION);
            let (r, a) = (worst.relative, worst.elsewhere / scale(reference));
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
    let chosen = [1e-1, 1e-3, 1e-6, 1e-9, FULL_PRECISION].map(|tolerance| (None, tolerance));
    let forced = Method::ALL.map(|method| (Some(method), FULL_PRECISION));
    for reference in all_references() {
        let placement = reference.placement().expect("a placement");
        let incomplete = missing_for_report_newton(&placement).is_some();
        let methods = chosen.into_iter().chain(forced);
        for (method, tolerance) in
            methods.filter(|(method, _)| !(incomplete && *method == Some(Method::ReportNewton)))
        {
            let (worst, estimate) = errors(&reference, method, tolerance);
            let (error, name) = (worst.anywhere, method.map_or("auto", Method::name));
            let what = format!("{}, {name} to {tolerance:e}", reference.name);
            assert!(error <= estimate, "{what}: {error:e} > {estimate:e}");
            assert!(estimate <= 100.0 * error, "{what}: {estimate:e} for {error:e}");
            assert!(method.is_some() || estimate <= tolerance, "{what}: {estimate:e}");
        }
    }
}

#[test]
fn the_boundary_is_as_good_as_the_separation() {
    let mut worst = 0f64;
    for reference in all_references() {
        let placement = reference.placement().expect("a placement");
        let scale = scale(&reference);
        for (delta, xi, value) in &reference.boundary {
            let eta = Slicer::new(&placement, *delta).slice(*xi).map(|slice| slice.eta[1]);
            let Some(value) = value.as_deref().map(exact) else {
                assert_eq!(eta, None, "{}: ξ = {xi}, δ = {delta}", reference.name);
                continue;
            };
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

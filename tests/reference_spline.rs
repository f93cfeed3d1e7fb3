//! Profiles of parametric cubic spans: 60-digit values, and the time against arcs.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

mod common;

use std::time::Instant;

use common::{Reference, references};
use wheelrail::interpenetration::Slicer;
use wheelrail::placement::{Pair, Placement};
use wheelrail::profile::measured::{self, CurveKind, Format, Options, write};
use wheelrail::profile::{Profile, Side, standards};
use wheelrail::separation::Evaluator;
use wheelrail::separation::axis::EtaAxis;
use wheelrail::separation::grid::Method;
use wheelrail::separation::plan;

/// What is promised of every profile.
const RELATIVE: f64 = 1e-13;
const ABSOLUTE: f64 = 2e-12;

/// 60-digit bisection leaves ±1e-45 where s is 0.
fn exact(text: &str) -> f64 {
    let value: f64 = text.parse().unwrap();
    if value.abs() < 1e-40 { 0.0 } else { value }
}

/// Whether a point lies over both spans through C, its foot on the wheel included.
fn over_contact(placement: &Placement, xi: f64, eta: f64) -> bool {
    let (rail, wheel) = (&placement.rail.section, &placement.wheel.section);
    let e = eta * eta / (2.0 * placement.rolling_radius());
    let inside = |section: &wheelrail::profile::Section, xi: f64| {
        section.piece_at(xi).is_some_and(|piece| section.contact == Some(piece.branch))
    };
    inside(rail, xi) && inside(wheel, xi) && inside(wheel, xi - 1.01 * e * wheel.frame.sin)
}

/// [ξ, η, s] by one method, in the order of the reference.
fn computed(reference: &Reference, placement: &Placement, method: Method) -> Vec<f64> {
    let (scene, axis) = (&reference.scene, EtaAxis::new(&reference.scene.eta));
    let plan = plan::plan(placement, &scene.xi, &axis, 1e-12, Some(method));
    let mut values = vec![0.0; scene.xi.len() * scene.eta.len()];
    plan.choice.fill(placement, &scene.xi, &axis, &mut values);
    values
}

#[test]
fn separations_on_spans_keep_their_digits() {
    for reference in references("reference_spline") {
        let placement = reference.placement().unwrap();
        for method in [Method::Spectral, Method::Pointwise] {
            let (mut relative, mut absolute) = (0f64, 0f64);
            let values = computed(&reference, &placement, method);
            for ((xi, eta, value), s) in reference.separation.iter().zip(values) {
                let Some(value) = value.as_deref().map(exact) else {
                    assert!(s.is_nan(), "{}: s({xi}, {eta}) = {s} off the surface", reference.name);
                    continue;
                };
                let error = (s - value).abs();
                assert!(
                    error <= ABSOLUTE,
                    "{} {}: s({xi}, {eta}) = {s}, not {value}",
                    reference.name,
                    method.name()
                );
                if over_contact(&placement, *xi, *eta) {
                    relative = relative.max(if error == 0.0 { 0.0 } else { error / value.abs() });
                } else {
                    absolute = absolute.max(error);
                }
            }
            println!(
                "{:12} {:10} relative {relative:8.1e} absolute {absolute:8.1e}",
                reference.name,
                method.name()
            );
            assert!(
                relative <= RELATIVE,
                "{} {}: relative error {relative:e}",
                reference.name,
                method.name()
            );
        }
    }
}

#[test]
fn boundaries_on_spans_keep_theirs() {
    for reference in references("reference_spline") {
        let placement = reference.placement().unwrap();
        let mut worst = 0f64;
        for (delta, xi, value) in &reference.boundary {
            let eta = Slicer::new(&placement, *delta).slice(*xi).map(|slice| slice.eta[1]);
            let Some(value) = value.as_deref().map(exact) else {
                assert_eq!(eta, None, "{}: ξ = {xi}, δ = {delta}", reference.name);
                continue;
            };
            let error = (eta.unwrap_or(f64::NAN) - value).abs();
            let allowed = reference.scene.wheel_radius / value * ABSOLUTE + f64::EPSILON * value;
            assert!(error <= allowed, "{}: η({xi}) = {eta:?}, not {value}", reference.name);
            worst = worst.max(error / allowed);
        }
        println!("{:12} boundary: {worst:.1e} of the bound", reference.name);
    }
}

/// The pair as smoothed from points every `spacing` mm; without one, as arcs within 0.01 mm of points every 0.5 mm:
/// the drawn S1002 is made of polynomials, and would be no arc pair.
fn pair(spacing: Option<f64>) -> Pair {
    let made = |profile: Profile, side: Side| {
        let points = write::sample(&profile, spacing.unwrap_or(0.5)).unwrap();
        let text = write::points(&points, Format::Csv, side, "sample");
        let curve = if spacing.is_none() { CurveKind::Arcs } else { CurveKind::Smoothing };
        let axes = Options { mirror: Some(false), flip_z: Some(false), ..Options::default() };
        let options = Options { curve: Some(curve), ..axes };
        measured::profile("sample.csv", text.as_bytes(), side, &options).unwrap().profile
    };
    let rail = made(standards::rail("60E1").unwrap(), Side::Rail);
    Pair::new(rail, made(standards::wheel("S1002").unwrap(), Side::Wheel), 460.0).unwrap()
}

/// Seconds of `f`, the best of three.
fn seconds(mut f: impl FnMut()) -> f64 {
    let once = |_| {
        let begun = Instant::now();
        f();
        begun.elapsed().as_secs_f64()
    };
    (0..3).map(once).fold(f64::INFINITY, f64::min)
}

/// `RAYON_NUM_THREADS=1 cargo test --release --test reference_spline -- --ignored --nocapture`
#[test]
#[ignore = "a measurement"]
fn time_of_spans_against_arcs() {
    println!(
        "points every (None: arcs) / grid / placing ms / plan ms / fill ms / columns' spans ms / midplane ms"
    );
    for spacing in [None, Some(1.0), Some(0.5), Some(0.1)] {
        let pair = pair(spacing);
        for n in [200usize, 2000] {
            let xi: Vec<f64> = (0..n).map(|k| -12.0 + 24.0 * k as f64 / (n - 1) as f64).collect();
            let eta: Vec<f64> = (0..n).map(|k| -10.0 + 20.0 * k as f64 / (n - 1) as f64).collect();
            let axis = EtaAxis::new(&eta);
            let mut placement = pair.placed(-3.0, -3.0, 0.0).unwrap();
            let placing = seconds(|| placement = pair.placed(-3.0, -3.0, 0.0).unwrap());
            let mut plan = plan::plan(&placement, &xi, &axis, 1e-12, None);
            let planning = seconds(|| plan = plan::plan(&placement, &xi, &axis, 1e-12, None));
            let mut out = vec![0.0; n * n];
            let fill = seconds(|| plan.choice.fill(&placement, &xi, &axis, &mut out));
            let mut evaluator = Evaluator::new(&placement);
            // One point of every column costs its spans and base.
            let midplane = seconds(|| xi.iter().for_each(|&x| out[0] += evaluator.separation(x, 0.0)));
            let edge = seconds(|| xi.iter().for_each(|&x| out[0] += evaluator.separation(x, 10.0)));
            let ms = [placing, planning, fill, edge, midplane].map(|s| format!("{:9.3}", 1e3 * s)).join(" ");
            println!("{spacing:?} {n} {ms}  {} n={}", plan.choice.method.name(), plan.choice.coefficients);
        }
    }
}

//! The parry3d check agrees on every scene it should agree on, and on no mutation.
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

mod common;

use common::{ReferenceScene, ReferenceSegment, chain, folder};
use rayon::prelude::*;
use wheelrail::check::{Answer, Report, Request, check};
use wheelrail::interpenetration::Window;
use wheelrail::placement::{Pair, Placement};
use wheelrail::profile::standards::{rail, rail_names, wheel, wheel_names};
use wheelrail::separation::Evaluator;

/// What the checker must reach itself, so that its verdict means something \[mm\].
const FLOOR: f64 = 1e-12;
const BRACKET: f64 = 1e-9;

/// Time for one scene \[s\]: 2 s are promised in release, on an idle machine.
const SECONDS: f64 = 2.0;

/// One scene of `src/accuracy/reference`; its 60-digit values are not needed here.
struct Scene {
    name: String,
    text: String,
    scene: ReferenceScene,
}

#[derive(serde::Deserialize)]
struct File {
    scene: ReferenceScene,
}

impl Scene {
    fn read(name: String, text: String) -> Self {
        let File { scene } = serde_json::from_str(&text).expect("a reference scene");
        Self { name, text, scene }
    }

    fn placement(&self) -> Placement {
        let scene = &self.scene;
        let (rail, wheel) = (chain("rail", &scene.rail), chain("wheel", &scene.wheel));
        let (rail, wheel) = (rail.expect("a rail"), wheel.expect("a wheel"));
        let pair = Pair::new(rail, wheel, scene.wheel_radius).expect("a pair");
        pair.placed(scene.contact_rail_x, scene.contact_wheel_x, scene.chi).expect("a placement")
    }
}

impl Clone for Scene {
    fn clone(&self) -> Self {
        Self::read(self.name.clone(), self.text.clone())
    }
}

/// All files of `src/accuracy/reference` with a scene in them.
fn references() -> Vec<Scene> {
    let files =
        std::fs::read_dir(folder("../src/accuracy/reference")).expect("the folder of reference values");
    let paths = files.map(|entry| entry.expect("a file").path());
    let mut all: Vec<Scene> = paths
        .filter(|path| path.extension().is_some_and(|e| e == "json"))
        .map(|path| (path.display().to_string(), std::fs::read_to_string(&path).expect("a readable file")))
        .filter(|(_, text)| text.contains("\"scene\""))
        .map(|(name, text)| Scene::read(name, text))
        .collect();
    all.sort_by(|a, b| a.name.cmp(&b.name));
    assert!(all.len() >= 12);
    all
}

fn range(values: &[f64]) -> [f64; 2] {
    values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], &v| [a.min(v), b.max(v)])
}

fn request(reference: &Scene) -> Request {
    let eta = range(&reference.scene.eta)[1];
    let window = Window { xi: range(&reference.scene.xi), eta: [-eta, eta] };
    Request { window, approach: reference.scene.delta[0] }
}

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

fn assert_agrees(name: &str, report: &Report) {
    assert!(report.agrees, "{name}\n{report}");
    let counts = report.counts;
    assert!(counts.compared >= counts.points / 2, "{name}\n{report}");
    assert!(report.floors.len() == 4 && report.floors.iter().all(|f| f.ray_mm < FLOOR), "{name}\n{report}");
    assert!(report.bracket_mm > 0.0 && report.bracket_mm < BRACKET, "{name}\n{report}");
    assert!(report.distances.violation.compared > 0, "{name}\n{report}");
    assert!(report.distances.bodies_mm > 0.0, "{name}\n{report}");
    assert!(report.seconds < SECONDS, "{name}: {} s", report.seconds);
}

#[test]
fn every_reference_scene_agrees_with_and_without_skew() {
    for reference in references() {
        let mut placement = reference.placement();
        for skew in [placement.skew, 0.01, -0.06] {
            placement.skew = skew;
            let report = checked(&placement, &placement, &request(&reference), |_, _, _| {});
            println!("{} χ = {skew}: {:.3} s\n{report}", reference.name, report.seconds);
            assert_agrees(&reference.name, &report);
        }
    }
}

#[test]
fn every_built_in_pair_agrees() {
    let names: Vec<_> = rail_names().flat_map(|r| wheel_names().map(move |w| (r, w))).collect();
    assert_eq!(names.len(), 25 * 14);
    names.par_iter().enumerate().for_each(|(k, (rail_name, wheel_name))| {
        let (rail, wheel) = (rail(rail_name).expect("a rail"), wheel(wheel_name).expect("a wheel"));
        let pair = Pair::new(rail, wheel, 460.0).expect("a pair");
        // Every third with yaw: crown under the wheel profile's origin.
        let skew = if k % 3 == 2 { 0.01 } else { 0.0 };
        let placement = pair.placed(0.0, 0.0, skew).expect("both profiles have a point at x = 0");
        let window = Window { xi: [-30.0, 30.0], eta: [-15.0, 15.0] };
        let report = checked(&placement, &placement, &Request { window, approach: 0.05 }, |_, _, _| {});
        assert_agrees(&format!("{rail_name} {wheel_name}"), &report);
    });
}

/// Scenes whose bodies are one arc or line each.
fn simple_references() -> Vec<Scene> {
    let simple = |r: &Scene| r.scene.rail.len() == 1 && r.scene.wheel.len() == 1;
    let all: Vec<_> = references().into_iter().filter(simple).collect();
    assert!(all.len() >= 5);
    all
}

#[test]
fn a_wrong_separation_is_caught() {
    for reference in references() {
        let placement = reference.placement();
        let request = request(&reference);
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
        let placement = reference.placement();
        for body in 0..3 {
            let mut wrong = reference.clone();
            let segments = [&mut wrong.scene.rail, &mut wrong.scene.wheel];
            if let Some(segments) = segments.into_iter().nth(body) {
                let ReferenceSegment::Arc { r, .. } = &mut segments[0] else { continue };
                *r *= 1.0 + 1e-6;
            } else {
                wrong.scene.wheel_radius *= 1.0 + 1e-6;
            }
            let own = wrong.placement();
            // 1e-6 of a crown of 10 m is a nm at 15 mm from C: the window of the scene, not a point of it.
            let report = checked(&placement, &own, &request(&reference), |_, _, _| {});
            assert!(!report.agrees, "{} {body}\n{report}", reference.name);
        }
    }
}

#[test]
fn a_wrong_normal_is_caught() {
    for reference in references() {
        let placement = reference.placement();
        let request = request(&reference);
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
        let own = reference.placement();
        let placement = Placement { skew: own.skew + 1e-3, ..own.clone() };
        let report = checked(&placement, &own, &request(&reference), |_, _, _| {});
        assert!(!report.agrees, "{}\n{report}", reference.name);
    }
}

//! Every file of `tests/hard_scenes`: whole scenes with provenance, a check and a status. An expected failure that passes
//! fails here.

use serde::Deserialize;
use wheelrail::case::{Run, SILENT};
use wheelrail::{Evaluator, scene};

use super::common::repository;

/// A file.
#[derive(Deserialize)]
struct HardScene {
    title: String,
    provenance: String,
    status: Status,
    check: Check,
    /// Largest relative difference that passes.
    largest: f64,
    scenes: Vec<serde_json::Value>,
}

#[derive(Deserialize, PartialEq, Clone, Copy, Debug)]
#[serde(rename_all = "kebab-case")]
enum Status {
    Holds,
    ExpectedFailure,
}

#[derive(Deserialize, Clone, Copy)]
#[serde(rename_all = "kebab-case")]
enum Check {
    /// Two scenes have the same normal force.
    EqualNormalForces,
    /// The largest pressure on the automatic grid is that on a grid three times as fine.
    PeakOfAutomaticGrid,
}

fn run(scene: &serde_json::Value) -> Run {
    let read = scene::parse(&scene.to_string(), true).expect("a scene");
    let case = scene::resolve(&read, std::path::Path::new("."), "hard scene").expect("a case");
    Run::new(case, SILENT).expect("a run")
}

impl HardScene {
    /// The relative difference that the check is about.
    fn difference(&self) -> f64 {
        match self.check {
            Check::EqualNormalForces => {
                let force =
                    |scene| -> f64 { run(scene).parts.iter().filter_map(|part| part.site.normal_load).sum() };
                (force(&self.scenes[1]) / force(&self.scenes[0]) - 1.0).abs()
            }
            Check::PeakOfAutomaticGrid => {
                let run = run(&self.scenes[0]);
                let [automatic, fine] = [1, 3].map(|finer| peak(&run, finer));
                (automatic / fine - 1.0).abs()
            }
        }
    }
}

/// The largest pressure, divided by π E*, of a half-space of cells around the points of the run's first grid, or of a grid that
/// is so many times as fine, under the run's approach. Conjugate gradients of Polonsky and Keer (1999).
fn peak(run: &Run, finer: usize) -> f64 {
    let (site, delta) = (&run.parts[0].site, run.parts[0].site.approach());
    let axis = |values: &[f64]| -> (Vec<f64>, f64) {
        let step = (values[values.len() - 1] - values[0]) / ((values.len() - 1) * finer) as f64;
        ((0..=(values.len() - 1) * finer).map(|k| values[0] + step * k as f64).collect(), step)
    };
    let ((xi, a), (eta, b)) = (axis(&site.grid.xi), axis(&site.grid.eta));
    let mut evaluator = Evaluator::new(&site.contact.placement);
    let mut cells = Vec::new();
    for (i, &x) in xi.iter().enumerate() {
        for (j, &y) in eta.iter().enumerate() {
            let depth = delta - evaluator.separation(x, y);
            if depth > 0.0 {
                cells.push((i, j, depth));
            }
        }
    }
    let influence: Vec<f64> = (0..xi.len() * eta.len())
        .map(|k| love([(k / eta.len()) as f64, (k % eta.len()) as f64], [a, b]))
        .collect();
    let apply = |pressed: &[f64]| -> Vec<f64> {
        let sum = |&(i, j, _): &(usize, usize, f64)| {
            let others = cells.iter().zip(pressed).filter(|(_, p)| **p != 0.0);
            others.map(|((k, l, _), p)| p * influence[i.abs_diff(*k) * eta.len() + j.abs_diff(*l)]).sum()
        };
        cells.iter().map(sum).collect()
    };
    let mut p: Vec<f64> = cells.iter().map(|cell| cell.2 / (4.0 * (a * b).sqrt())).collect();
    let (mut search, mut before) = (vec![0.0; p.len()], f64::INFINITY);
    for _ in 0..200 {
        let g: Vec<f64> = apply(&p).iter().zip(&cells).map(|(u, cell)| u - cell.2).collect();
        let square: f64 = p.iter().zip(&g).filter(|(p, _)| **p > 0.0).map(|(_, g)| g * g).sum();
        for ((t, g), p) in search.iter_mut().zip(&g).zip(&p) {
            *t = if *p > 0.0 { g + square / before * *t } else { 0.0 };
        }
        let response = apply(&search);
        let along = |v: &[f64]| search.iter().zip(v).map(|(t, v)| t * v).sum::<f64>();
        let length = along(&g) / along(&response);
        let (mut change, mut joined) = (0.0, false);
        for ((p, t), g) in p.iter_mut().zip(&search).zip(&g) {
            let old = *p;
            *p = (old - length * t).max(0.0);
            if *p == 0.0 && *g < 0.0 {
                (*p, joined) = (-length * g, true);
            }
            change += (*p - old).abs();
        }
        before = if joined { f64::INFINITY } else { square };
        if change <= 1e-4 * p.iter().sum::<f64>() {
            return p.into_iter().fold(0.0, f64::max);
        }
    }
    panic!("pressures that do not settle");
}

/// ∬ 1/r over a cell, from a point so many cells away \[mm\] (Love 1929).
fn love(cells: [f64; 2], step: [f64; 2]) -> f64 {
    let [x, y] = [0, 1].map(|k| [(cells[k] - 0.5) * step[k], (cells[k] + 0.5) * step[k]]);
    let part = |a: f64, [from, to]: [f64; 2]| a * ((to / a.abs()).asinh() - (from / a.abs()).asinh());
    part(x[1], y) - part(x[0], y) + part(y[1], x) - part(y[0], x)
}

#[test]
fn every_scene_is_as_its_status_says() {
    let mut seen = 0;
    for entry in std::fs::read_dir(repository("tests/hard_scenes")).expect("the folder of hard scenes") {
        let text = std::fs::read_to_string(entry.expect("a file").path()).expect("a readable file");
        let hard: HardScene = serde_json::from_str(&text).expect("its format");
        let difference = hard.difference();
        println!(
            "{}: {difference:.4} of {} ({:?}; {})",
            hard.title, hard.largest, hard.status, hard.provenance
        );
        let expected = if difference <= hard.largest { Status::Holds } else { Status::ExpectedFailure };
        assert_eq!(hard.status, expected, "{}: {difference} of {}", hard.title, hard.largest);
        seen += 1;
    }
    assert!(seen >= 2, "{seen}");
}

/// Places of contact that a region takes in are no near misses.
#[test]
fn a_place_is_merged_or_a_near_miss_but_not_both() {
    let scene = serde_json::json!({
        "rail": {"profile": "50E4", "rotate": "1:40"},
        "wheel": {"profile": "S1002-arcs-0.1um", "radius": 460.0},
        "contact": {"offset": -3.196_054_690_368_523_4, "within": 0.3},
        "patch": {"load": 54778.0}, "output": {"formats": []}
    });
    let found = run(&scene).parts[0].site.contact.found.clone().expect("a place that was found");
    assert!(!found.merged.is_empty(), "{found:?}");
    assert!(found.near_misses.iter().all(|place| !found.merged.contains(place)), "{found:?}");
}

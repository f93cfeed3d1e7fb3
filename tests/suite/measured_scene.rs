//! `examples/scenes/measured.toml`: two measured files from end to end, against the drawings they were sampled from.

use crate::common::repository;
use std::path::PathBuf;

use wheelrail::case::{Part, Run, SILENT};
use wheelrail::scene::{self, Scene};

/// Both profiles sampled every 0.5 mm and smoothed with the default cut-off: twice what was found (0.5 %, 2.2 µm of
/// δ = 80 µm). The contact point moves with the fit, so that the difference of s holds that of two frames.
const AREA: f64 = 0.01;
const SEPARATION_MM: f64 = 4e-3;
/// The same points interpolated: likewise, of 0.056 µm.
const INTERPOLATED_MM: f64 = 1.2e-4;

fn folder() -> PathBuf {
    repository("examples/scenes")
}

fn run(name: &str, change: impl Fn(&mut Scene)) -> Run {
    let mut scene = scene::load(&folder().join(name)).unwrap();
    change(&mut scene);
    Run::new(scene::resolve(&scene, &folder(), name).unwrap(), SILENT).unwrap()
}

/// Largest difference of s \[mm\] over the drawn profiles' patch; the grids are the same.
fn over_the_patch(measured: &Part, drawn: &Part, approach: f64) -> f64 {
    let pairs = measured.analysis.separation.iter().zip(drawn.analysis.separation.iter());
    pairs.filter(|(_, s)| **s < approach).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn measured_files_give_the_patch_of_their_drawings() {
    let (measured, drawn) = (run("measured.toml", |_| ()), run("60e1_s1002.toml", |_| ()));
    assert!(measured.refusals().is_empty(), "{:?}", measured.refusals());
    assert!(measured.case.measured().both().into_iter().all(Option::is_some));
    let (part, exact) = (&measured.parts[0], &drawn.parts[0]);
    assert_eq!((&part.site.grid.xi, &part.site.grid.eta), (&exact.site.grid.xi, &exact.site.grid.eta));
    let [patch, reference] = [part, exact].map(|part| part.analysis.patch.as_ref().unwrap());
    assert_eq!(patch.components.len(), reference.components.len(), "joints of spans must not cut the patch");
    let area = patch.area() / reference.area() - 1.0;
    let separation = over_the_patch(part, exact, reference.approach);
    println!("area {area:+.2e}, separation {separation:.2e} mm");
    assert!(area.abs() < AREA, "area off by {area}");
    assert!(separation < SEPARATION_MM, "s off by {separation} mm");
}

/// An interpolation at half a millimetre is nearer to a drawing without noise than any smoothing.
#[test]
fn interpolation_of_exact_points_is_nearer_still() {
    let interpolated = run("measured.toml", |scene| {
        scene.rail.curve = Some(wheelrail::measured::CurveKind::Interpolation);
        scene.wheel.curve = scene.rail.curve;
    });
    let drawn = run("60e1_s1002.toml", |_| ());
    let (part, exact) = (&interpolated.parts[0], &drawn.parts[0]);
    let separation = over_the_patch(part, exact, 0.08);
    println!("separation {separation:.2e} mm");
    assert!(separation < INTERPOLATED_MM, "s off by {separation} mm");
}

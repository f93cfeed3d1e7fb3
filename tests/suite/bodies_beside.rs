//! Wheels that stand beside their rail, on its sides, or on an end of a profile: a result or an error, and a patch wherever C is.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use crate::campaign;
use crate::common::repository;
use wheelrail::case::{Run, SILENT, contacts};
use wheelrail::internal::Random;
use wheelrail::patch::{Patch, Window};
use wheelrail::placement::Placement;
use wheelrail::profile::standards;
use wheelrail::scene;

/// Distance of C from a patch that holds it \[mm\]: some roundings.
const AT_C: f64 = 1e-9;

/// Runs a scene.
fn run(text: &str, json: bool) -> wheelrail::Result<Run> {
    let scene: scene::Scene = scene::parse(text, json)?;
    Run::new(scene::resolve(&scene, Path::new("."), "beside")?, SILENT)
}

/// Whether a scene has a result, or what is wrong with how it ends: a panic, or an error that says nothing.
fn ended(text: &str, json: bool) -> Result<bool, String> {
    match catch_unwind(AssertUnwindSafe(|| run(text, json))) {
        Err(_) => Err(format!("a panic\n{text}")),
        Ok(Err(error)) if error.found.is_empty() || error.expected.is_empty() => {
            Err(format!("{error:?}\n{text}"))
        }
        Ok(run) => Ok(run.is_ok()),
    }
}

/// Runs scenes; some have a result, some an error that says something.
fn all_end(scenes: impl Iterator<Item = (u64, String)>) {
    let (mut results, mut errors, mut wrong) = (0, 0, Vec::new());
    for (number, text) in scenes {
        match ended(&text, false) {
            Ok(true) => results += 1,
            Ok(false) => errors += 1,
            Err(text) => wrong.push(format!("{number}: {text}")),
        }
    }
    println!("{results} results, {errors} errors, {} wrong", wrong.len());
    assert!(wrong.is_empty(), "{} wrong\n{}", wrong.len(), wrong[..wrong.len().min(5)].join("\n"));
    assert!(results > 0 && errors > 0, "{results} results, {errors} errors");
}

/// Distance of the offsets of built-in pairs \[mm\], from −200 to 200 mm.
const APART: f64 = 7.3;

/// A built-in pair with the wheel's origin up to 200 mm beside that of the rail, alone or in a wheelset with either roll: of all pairs,
/// offsets and arrangements a campaign meets each once, and a short one a spread of them.
fn built_in(number: u64) -> String {
    /// A prime, so that all are met.
    const STRIDE: usize = 104_729;
    let mut dice = Random::new(number);
    let rails: Vec<&str> = standards::rail_names().collect();
    let wheels: Vec<&str> = standards::wheel_names().collect();
    let offsets = (400.0 / APART) as usize + 1;
    let mut rest = (number as usize).wrapping_mul(STRIDE) % (rails.len() * wheels.len() * offsets * 3);
    let mut next = |count: usize| {
        let own = rest % count;
        rest /= count;
        own
    };
    let (rail, wheel) = (rails[next(rails.len())], wheels[next(wheels.len())]);
    let (offset, arrangement) = (APART * next(offsets) as f64 - 200.0, next(3));
    let inclination = *dice.pick(&["1:20", "1:40", "-1:40"]);
    let bodies = format!(
        "[rail]\nprofile = {rail:?}\nrotate = {inclination:?}\n[wheel]\nprofile = {wheel:?}\nradius = 460.0\n\
         [patch]\napproach = {:?}\n",
        10f64.powf(dice.between(-3.0, 0.0))
    );
    let place = match arrangement {
        0 => format!("[contact]\noffset = {offset:?}\n"),
        roll => format!(
            "[track]\nspacing = 1500.0\n[wheelset]\nspacing = 1500.0\nlateral = {offset:?}\nroll = {:?}\n",
            ["solve", "neglect"][roll - 1]
        ),
    };
    bodies + &place
}

#[test]
fn every_built_in_pair_at_any_offset_gives_a_result_or_an_error() {
    all_end(campaign::seeds().map(|number| (number, built_in(number))));
}

/// A chain of two or three lines and arcs from left to right.
fn chain(dice: &mut Random, left: f64) -> String {
    let (mut at, mut segments) = ([left, dice.between(-60.0, 0.0)], Vec::new());
    for _ in 0..2 + dice.below(2) {
        let to = [at[0] + dice.between(2.0, 30.0), at[1] + 30.0 * dice.normal()];
        segments.push(format!("{{ line = {{ from = {at:?}, to = {to:?} }} }}"));
        at = to;
    }
    segments.join(", ")
}

/// Steep chains that meet with an end or a side.
#[test]
fn steep_bodies_that_meet_anywhere_give_a_result_or_an_error() {
    let steep = |number: u64| {
        let dice = &mut Random::new(number);
        let [rail, wheel] = [-20.0, -40.0].map(|left| {
            let left = left + dice.between(0.0, 40.0);
            chain(dice, left)
        });
        let roller = *dice.pick(&["", "", "[roller]\nradius = 350.0\n"]);
        let text = format!(
            "[rail]\nsegments = [{rail}]\n[wheel]\nsegments = [{wheel}]\nradius = {:?}\n{roller}[contact]\noffset = {:?}\n\
             yaw = {:?}\n[patch]\napproach = {:?}\n",
            dice.between(150.0, 600.0),
            dice.between(-60.0, 60.0),
            *dice.pick(&[0.0, 0.0, 0.01, -0.05]),
            *dice.pick(&[0.0, 0.01, 0.3]),
        );
        (number, text)
    };
    all_end(campaign::seeds().map(steep));
}

#[test]
fn ends_over_a_side_give_a_result_or_an_error() {
    for name in ["panic-end-over-side.toml", "panic-divided.json"] {
        let text = std::fs::read_to_string(repository("tests/defects").join(name)).expect("a scene");
        assert!(ended(&text, name.ends_with("json")).is_ok(), "{name}");
    }
}

/// The contacts of a scene.
fn placed(text: &str, json: bool) -> Option<Vec<(String, Placement)>> {
    let scene: scene::Scene = scene::parse(text, json).expect("a scene");
    let case = scene::resolve(&scene, Path::new("."), "beside").ok()?;
    contacts(&case).ok()
}

/// Checks that the patch of a placed pair holds C, over the tangent plane and over the rail's surface.
fn holds_c(name: &str, placement: &Placement, approach: f64) {
    for (over, find) in [("plane", Patch::new as fn(_, _, _) -> _), ("surface", Patch::over_rail)] {
        let patch: Patch = find(placement, approach, &Window::UNBOUNDED);
        let around = |window: Window| Window { xi: window.xi.grown(AT_C), eta: window.eta.grown(AT_C) };
        let held = patch.components.iter().any(|part| around(part.extent()).contains(0.0, 0.0));
        let parts: Vec<Window> = patch.components.iter().map(|part| part.extent()).collect();
        assert!(held, "{name}, over the {over}: C is in none of {parts:?}");
    }
}

/// Wheels of polynomials that rise at their ends, so that they often touch a crowned rail or roller with an end, under a small yaw.
#[test]
fn a_patch_holds_c_though_c_lies_on_an_end() {
    let mut found = 0;
    // Of 1484 C is the rail's end itself, in a frame that is turned from the tangent there.
    for number in campaign::seeds().chain([1484]) {
        let dice = &mut Random::new(number);
        let half = dice.between(4.0, 20.0);
        let coefficients: Vec<f64> =
            (0..=1 + dice.below(5)).map(|k| dice.normal() / half.powi(k as i32)).collect();
        let crown = 10f64.powf(dice.between(1.5, 3.3));
        let reach = (1.3 * half).min(0.9 * crown);
        let roller = *dice.pick(&["", "[roller]\nradius = 350.0\n", "[roller]\nradius = 900.0\n"]);
        let approach = 10f64.powf(dice.between(-4.0, -0.5));
        let text = format!(
            "[rail]\nsegments = [{{ arc = {{ center = [0.0, {:?}], radius = {crown:?}, half = \"upper\", x = [{:?}, {reach:?}] }} }}]\n\
             [wheel]\nsegments = [{{ polynomial = {{ x = [{:?}, {half:?}], coefficients = {coefficients:?} }} }}]\nradius = 460.0\n\
             {roller}[contact]\noffset = {:?}\nyaw = {:?}\n",
            -crown,
            -reach,
            -half,
            dice.normal(),
            dice.normal() * *dice.pick(&[0.0, 1e-3, 1e-2]),
        );
        for (name, placement) in placed(&text, false).into_iter().flatten() {
            found += 1;
            holds_c(&format!("scene {number}, {name}, δ = {approach:?}\n{text}"), &placement, approach);
        }
    }
    assert!(found * 2 > campaign::scenes(), "{found} contacts");
}

#[test]
fn a_patch_at_the_end_of_a_wheel_on_a_roller_is_found() {
    let text = std::fs::read_to_string(repository("tests/defects/roller-end-empty.json")).expect("a scene");
    let (name, placement) = placed(&text, true).expect("contacts").swap_remove(0);
    let approach = 0.012_947_646_403_039_104;
    holds_c(&name, &placement, approach);
    let area = Patch::new(&placement, approach, &Window::UNBOUNDED).area();
    // By the points of a grid of 2,000 × 2,000 that are inside.
    assert!((area - 0.056).abs() < 0.001, "{area} mm²");
}

//! Contacts with rails that vary along the track: separation, normals, patches and runs.

use crate::common::repository;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde_json::Value;
use wheelrail::Interval;
use wheelrail::case::{ALONG, MarchCase, MarchCourse, Part, Run, SILENT};
use wheelrail::error::Result;
use wheelrail::internal::Random;
use wheelrail::lofted::{Joining, Loft, LoftedBody};
use wheelrail::mesh::{StripCounts, StripMesh};
use wheelrail::placement::{Motion, Pitch, Rates};
use wheelrail::scene;
use wheelrail::search::TrackSide;
use wheelrail::{
    Evaluator, Half, ONE_CONTACT, Pair, Patch, Placement, Pose, Profile, ProfilePair, Segment, Selection,
    Window, feasibility,
};

use super::along_track::{RADIUS, cases, march_over, position, right, scene_of, slices};
use super::campaign::scenes;

/// Half the width of a head that is one crown, and its radius \[mm\].
const CROWN: [f64; 2] = [30.0, 300.0];

/// A crown of one radius with its top at `z`.
pub(super) fn crown(z: f64) -> Profile {
    let [half, radius] = CROWN;
    let arc = wheelrail::Arc::about([0.0, -radius], radius, Half::Upper, [-half, half]).unwrap();
    Profile::new("crown", "", vec![Segment::arc(arc)]).unwrap().shifted(0.0, z)
}

pub(super) fn cylinder() -> Profile {
    let line = wheelrail::Arc::line([-60.0, 0.0], [60.0, 0.0]).unwrap();
    Profile::new("tread", "", vec![Segment::arc(line)]).unwrap()
}

/// A place of contact of a cylinder on a crown whose height along the track a function gives.
pub(super) fn on_crown(height: impl Fn(f64) -> f64, at: &[f64], yaw: f64, along: f64) -> Result<Placement> {
    let rail = slices(at, |y| crown(height(y)));
    let march = march_over(&rail, cylinder(), position(0.0, yaw, 0.0), 0.0)?;
    let loft = Arc::new(Loft::new(&rail, Joining::Monotone)?);
    let pair = Pair::new(crown(0.0), cylinder(), RADIUS)?;
    right(&march, along).placed_on(
        &pair,
        &LoftedBody::Rail(loft),
        march.system.along(true, &march.position, along),
    )
}

/// ζ of a crown that rises at a rate, at (ξ, η) of a frame: by bisection along the line, in the axes of the slices.
fn risen(placement: &Placement, rate: f64, [xi, eta]: [f64; 2]) -> f64 {
    let frame = placement.lofted().unwrap();
    let (origin, axes) = (frame.origin(), frame.axes());
    let below = |zeta: f64| {
        let at = [0, 1, 2].map(|k| origin[k] + xi * axes[0][k] + eta * axes[1][k] + zeta * axes[2][k]);
        let radius = CROWN[1];
        // z + x²/(R + √(R² − x²)) − rate y, without a large difference.
        let fall = at[0] * at[0] / (radius + ((radius - at[0]) * (radius + at[0])).sqrt());
        at[2] + fall - rate * at[1] < 0.0
    };
    let (mut low, mut high) = (-20.0, 20.0);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if below(middle) { low = middle } else { high = middle }
    }
    low
}

#[test]
fn separation_and_normals_over_a_nose_that_rises_are_those_of_an_inclined_rail() -> Result<()> {
    let mut random = Random::new(343);
    for (rate, yaw) in [(0.1, 0.0), (-0.1, 0.0), (0.1, 0.02), (0.02, -0.03)] {
        let at = [-150.0, -110.0, -70.0, -35.0, 10.0, 45.0, 80.0, 120.0];
        let placement = on_crown(|y| rate * y, &at, yaw, 12.0)?;
        // A yawed wheel touches beside the top.
        assert!(yaw != 0.0 || (placement.turn() + f64::atan(rate)).abs() < 1e-7, "{}", placement.turn());
        let mut evaluator = Evaluator::new(&placement);
        let (sin, cos) = placement.skew().sin_cos();
        for _ in 0..500 {
            let at = [random.between(-25.0, 25.0), random.between(-40.0, 40.0)];
            // The cylinder about its axle, which lies R along the normal of C and is turned by the skew.
            let across = at[1] * cos - at[0] * sin;
            let wheel = across * across / (RADIUS + ((RADIUS - across) * (RADIUS + across)).sqrt());
            let expected = wheel - risen(&placement, rate, at);
            let found = evaluator.separation(at[0], at[1]);
            assert!((found - expected).abs() < 1e-10, "{rate} {yaw} {at:?}: {found} instead of {expected}");
            // Normals by differences of the closed form.
            let h = 1e-3;
            let slope = |step: [f64; 2]| {
                let beside = |sign: f64| risen(&placement, rate, [0, 1].map(|k| at[k] + sign * h * step[k]));
                (beside(1.0) - beside(-1.0)) / (2.0 * h)
            };
            let normal = evaluator.normals(at[0], at[1]).rail.unwrap();
            let off = [slope([1.0, 0.0]) + normal.x / normal.z, slope([0.0, 1.0]) + normal.y / normal.z];
            assert!(off[0].abs() < 1e-9 && off[1].abs() < 1e-9, "{at:?}: {off:?}");
        }
        assert!(evaluator.separation(2.0 * CROWN[0], 0.0).is_nan());
        assert!(feasibility(&placement).unwrap().feasible);
    }
    Ok(())
}

#[test]
fn a_wheel_that_rolls_up_a_nose_does_not_creep() -> Result<()> {
    for rate in [0.1f64, -0.03] {
        let at = [-150.0, -110.0, -70.0, -35.0, 10.0, 45.0, 80.0, 120.0];
        let placement = on_crown(|y| rate * y, &at, 0.0, 12.0)?;
        let speed = 2e4;
        let pitch = Pitch::Rate(-speed * 1f64.hypot(rate) / RADIUS);
        let rolling = Motion::new(speed, Rates { vertical: rate * speed, pitch, ..Rates::default() })?;
        let found = rolling.creepages(&placement, 750.0, RADIUS)?;
        assert!(
            found.longitudinal.abs() < 1e-9 && found.lateral.abs() < 1e-9,
            "{} {found:?}",
            placement.turn()
        );
        assert!(found.spin.abs() < 1e-12 && found.forward, "{found:?}");
        // One that does not turn for the rise slides by the share of it.
        let level = Motion::new(speed, Rates { vertical: rate * speed, ..Rates::default() })?;
        let found = level.creepages(&placement, 750.0, RADIUS)?.longitudinal;
        let [carried, turned] = [1f64.hypot(rate), 1.0];
        assert!((found + (carried - turned) / (0.5 * (carried + turned))).abs() < 1e-9, "{found}");
    }
    Ok(())
}

#[test]
fn equal_slices_have_separations_and_patches_of_the_extruded_rail() -> Result<()> {
    let pair = Pair::new(crown(0.0), cylinder(), RADIUS)?;
    let loft = Loft::new(&slices(&[-300.0, -40.0, 5.0, 45.0, 300.0], |_| crown(0.0)), Joining::Monotone)?;
    let body = LoftedBody::Rail(Arc::new(loft));
    let profiles = ProfilePair::new(&pair)?;
    let mut search = profiles.search();
    let mut random = Random::new(344);
    for _ in 0..scenes().div_ceil(8) {
        let pose = Pose::new(
            random.between(-3.0, 3.0),
            random.between(-0.005, 0.005),
            random.between(-0.005, 0.005),
        )?;
        let touch = search.touch(&pose, &Selection { within: 0.0, apart: ONE_CONTACT })?;
        let contact = touch.contacts[0];
        let (swept, lofted) =
            (contact.placed(&pair)?, contact.placed_on(&pair, &body, random.between(-9.0, 9.0))?);
        let (mut own, mut other) = (Evaluator::new(&lofted), Evaluator::new(&swept));
        for _ in 0..100 {
            let at = [random.between(-15.0, 15.0), random.between(-15.0, 15.0)];
            let (found, expected) = (own.separation(at[0], at[1]), other.separation(at[0], at[1]));
            let same = found.is_nan() && expected.is_nan() || (found - expected).abs() < 1e-10;
            assert!(same, "{pose:?} {at:?}: {found} instead of {expected}");
        }
        let approach = random.between(0.01, 0.1);
        let [found, expected] = [&lofted, &swept].map(|p| Patch::new(p, approach, &Window::UNBOUNDED));
        assert_eq!(found.components.len(), expected.components.len(), "{pose:?}");
        assert!((found.area() / expected.area() - 1.0).abs() < 1e-7, "{} {}", found.area(), expected.area());
        let mesh = StripMesh::new(&lofted, &found, StripCounts::default())?;
        for cell in &mesh.cells {
            let [xi, eta] = cell.centroid;
            assert!((cell.separation - own.separation(xi, eta)).abs() < 1e-10, "{pose:?} {cell:?}");
        }
        for (found, expected) in found.components.iter().zip(&expected.components) {
            let off = |a: Interval, b: Interval| (a.low - b.low).abs().max((a.high - b.high).abs());
            assert!(off(found.xi, expected.xi) < 1e-6 && off(found.eta, expected.eta) < 1e-3, "{pose:?}");
            assert!((found.perimeter / expected.perimeter - 1.0).abs() < 1e-6, "{pose:?}");
            assert!((found.deepest[0] - expected.deepest[0]).abs() < 1e-9, "{pose:?}");
            for at in &found.boundary {
                assert!((own.separation(at[0], at[1]) - approach).abs() < 1e-8, "{pose:?} {at:?}");
            }
        }
    }
    Ok(())
}

#[test]
fn the_patch_of_a_wheel_over_a_hollow_is_that_of_a_brute_force() -> Result<()> {
    let at: Vec<f64> = (-20..=20).map(|k| 10.0 * f64::from(k)).collect();
    let hollow = |y: f64| 5.0 * (1.0 - (-y * y / 1600.0).exp()) - 5.0;
    // One part beside the middle, two with the wheel nearly over it.
    for (along, approach, parts) in [(3.0, 0.4, None), (0.3, 0.2, Some(2))] {
        let placement = on_crown(hollow, &at, 0.0, along)?;
        let patch = Patch::new(&placement, approach, &Window::UNBOUNDED);
        assert!(parts.is_none_or(|parts| patch.components.len() == parts), "{}", patch.components.len());
        let mut evaluator = Evaluator::new(&placement);
        // Squares whose middles overlap, of a tenth of a millimetre.
        let (mut area, mut ends) = (0.0, [0.0f64; 2]);
        for i in -400..400 {
            for j in -1200..1200 {
                let [xi, eta] = [i, j].map(|k| 0.1 * (f64::from(k) + 0.5));
                if evaluator.separation(xi, eta) < approach {
                    area += 0.01;
                    ends = [ends[0].min(eta), ends[1].max(eta)];
                }
            }
        }
        assert!((patch.area() / area - 1.0).abs() < 0.01, "{along}: {} instead of {area}", patch.area());
        let extent = patch.extent().unwrap();
        let off = [0, 1].map(|end| (extent.eta[end] - ends[end]).abs());
        assert!(off[0] < 0.2 && off[1] < 0.2, "{along}: {extent:?} {ends:?}");
        for at in patch.components.iter().flat_map(|component| &component.boundary) {
            let s = evaluator.separation(at[0], at[1]);
            assert!((s - approach).abs() < 1e-8, "{along} {at:?}: {s}");
        }
    }
    Ok(())
}

/// Steps of the points of a flood fill across and along \[mm\], and how far it goes.
const FLOOD: [f64; 2] = [0.25, 0.5];
const FLOODED: [f64; 2] = [20.0, 70.0];

/// Distance of s from δ \[mm\] within which a point may be on either side of the boundary.
const ON_BOUNDARY: f64 = 1e-7;

/// Distance of s from δ \[mm\] at the points of a boundary: beside edges of a surface, where its curves are halved no more. Elsewhere it is
/// below 1e-6.
const OFF_BOUNDARY: f64 = 2e-4;

/// Whether every point of a flood fill is inside the patch where s < δ, neighbours inside are of one component, and s = δ on the boundary.
pub(super) fn floods(placement: &Placement, patch: &Patch) -> std::result::Result<usize, String> {
    let mut evaluator = Evaluator::new(placement);
    flooded(|xi, eta| evaluator.separation(xi, eta), patch)
}

/// The same of a gap over any two axes.
pub(super) fn flooded(
    mut gap: impl FnMut(f64, f64) -> f64,
    patch: &Patch,
) -> std::result::Result<usize, String> {
    for [xi, eta] in patch.components.iter().flat_map(|component| component.boundary.iter().copied()) {
        let s = gap(xi, eta);
        if (s - patch.approach).abs() > OFF_BOUNDARY {
            return Err(format!("({xi}, {eta}) of the boundary: s = {s}, δ = {}", patch.approach));
        }
    }
    let [columns, rows] = [0, 1].map(|k| (FLOODED[k] / FLOOD[k]) as i32);
    let mut inside = 0;
    let mut before: Vec<Option<usize>> = vec![None; 2 * rows as usize + 1];
    for i in -columns..=columns {
        // Off every symmetry.
        let xi = FLOOD[0] * (f64::from(i) + 0.137);
        let slices = patch.slices(xi);
        for j in -rows..=rows {
            let eta = FLOOD[1] * (f64::from(j) + 0.213);
            let s = gap(xi, eta);
            let of =
                slices.iter().find(|(_, slice)| slice.eta[0] <= eta && eta <= slice.eta[1]).map(|(k, _)| *k);
            if (s - patch.approach).abs() > ON_BOUNDARY && (s < patch.approach) != of.is_some() {
                return Err(format!("({xi}, {eta}): s = {s}, δ = {}, component {of:?}", patch.approach));
            }
            let known = &mut before[(j + rows) as usize];
            let mut joined = || (1..8).all(|k| gap(xi - FLOOD[0] * f64::from(k) / 8.0, eta) < patch.approach);
            if let (Some(a), Some(b)) = (*known, of)
                && a != b
                && joined()
            {
                return Err(format!("({xi}, {eta}): components {a} and {b} are one"));
            }
            (*known, inside) = (of, inside + usize::from(of.is_some()));
        }
    }
    Ok(inside)
}

#[test]
fn patches_over_random_rails_are_what_a_flood_fill_finds() -> Result<()> {
    let mut random = Random::new(346);
    let at: Vec<f64> = (-40..=40).map(|k| 7.5 * f64::from(k)).collect();
    let (mut found, mut several) = (0u64, 0);
    for scene in 0..scenes().div_ceil(2) {
        // Waves of 30 to 150 mm, of up to the depth that a wheel of 460 mm follows.
        let waves: [[f64; 3]; 3] = std::array::from_fn(|_| {
            let length = random.between(30.0, 150.0);
            let depth = random.between(0.0, 1.0) * length * length / (40.0 * RADIUS);
            [depth, std::f64::consts::TAU / length, random.between(0.0, 6.0)]
        });
        let height = |y: f64| waves.iter().map(|[depth, rate, phase]| depth * (rate * y + phase).sin()).sum();
        let (yaw, along) = (random.between(-0.02, 0.02), random.between(-20.0, 20.0));
        let placement = on_crown(height, &at, if scene % 3 == 0 { 0.0 } else { yaw }, along)?;
        let approach = 10.0f64.powf(random.between(-3.0, -0.3));
        let patch = Patch::new(&placement, approach, &Window::UNBOUNDED);
        match floods(&placement, &patch) {
            Ok(inside) => found += u64::from(inside > 0),
            Err(fault) => panic!("scene {scene}, yaw {yaw}, along {along}, {waves:?}: {fault}"),
        }
        several += usize::from(patch.components.len() > 1);
        assert!(patch.components.len() < 10, "scene {scene}: {} components", patch.components.len());
        assert!(feasibility(&placement).unwrap().least_separation_mm > -1e-8, "scene {scene}");
    }
    // A few scenes may have no patch of two parts.
    let enough = several > 0 || scenes() < 200;
    assert!(2 * found > scenes().div_ceil(2) && enough, "{found} {several}");
    Ok(())
}

/// The folder of an example and the text of its scene.
pub(super) fn example(name: &str) -> (PathBuf, String) {
    let folder = repository("examples").join(name);
    let text = std::fs::read_to_string(folder.join(format!("{name}.toml"))).unwrap();
    (folder, text)
}

/// A run of the example at a place along the track.
pub(super) fn run(along: f64, more: &str) -> Result<Run> {
    run_text(&along.to_string(), more)
}

#[test]
fn a_wheel_on_the_nose_of_a_crossing_is_run_like_any_other() -> Result<()> {
    let run = run(160.0, "[patch]\napproach = 0.05")?;
    let right = &run.parts[0];
    assert_eq!(right.site.side(), Some(TrackSide::Right));
    let placement = &right.site.contact.placement;
    assert!((placement.turn() + f64::atan(0.05)).abs() < 2e-3, "{}", placement.turn());
    assert!(run.refusals().is_empty(), "{:?}", run.refusals());
    let patch = right.analysis.patch.as_ref().unwrap();
    assert!(patch.components.len() == 1 && !patch.cut_by_window() && patch.area() > 10.0, "{patch:?}");
    // The mesh covers the patch, and the grid has numbers.
    let cells: f64 = right.analysis.strips.as_ref().unwrap().cells.iter().map(|cell| cell.area).sum();
    assert!((cells / patch.area() - 1.0).abs() < 1e-9, "{cells}");
    assert!(right.analysis.separation.iter().all(|s| s.is_finite()));
    assert!(right.analysis.plan.error < 1e-11, "{}", right.analysis.plan.error);
    // The other side is extruded.
    assert!(run.parts.last().unwrap().site.contact.placement.lofted().is_none());
    Ok(())
}

#[test]
fn a_single_wheel_stands_on_a_crossing_as_that_of_a_wheelset_does() -> Result<()> {
    let (folder, text) = example("crossing");
    let rail = text.split("[right.rail]").nth(1).unwrap().split("\n\n").next().unwrap();
    let text = format!(
        "[rail]{rail}\n[wheel]\nprofile = \"S1002\"\nradius = 460.0\n[contact]\noffset = 0.0\nalong = 160.0\n[patch]\napproach = 0.05"
    );
    let run = Run::new(scene::resolve(&scene::parse(&text, false)?, &folder, "")?, SILENT)?;
    let patch = run.parts[0].analysis.patch.as_ref().unwrap();
    assert!(patch.area() > 10.0 && patch.area() < 400.0, "{}", patch.area());
    assert!(run.parts[0].analysis.separation.iter().all(|s| s.is_finite()));
    Ok(())
}

#[test]
fn wing_and_nose_share_a_load() -> Result<()> {
    let run = run(122.5, "[patch]\nload = 1.0e5")?;
    let right = run.parts.iter().filter(|part| part.site.side() == Some(TrackSide::Right));
    let areas: Vec<f64> = right.map(|part| part.analysis.patch.as_ref().unwrap().area()).collect();
    assert!(!areas.is_empty() && areas.iter().all(|area| *area > 1.0 && *area < 1000.0), "{areas:?}");
    Ok(())
}

/// Holds what the right-hand wheel carries at the stops of a march against runs there: approach and normal force of each region.
pub(super) fn marches_as_it_runs(case: &MarchCase, course: MarchCourse, runs: &[(f64, Run)]) -> Result<()> {
    let places: Vec<f64> = runs.iter().map(|(at, _)| *at).collect();
    let mut stops = Vec::new();
    case.blocks(course, &places, |found, _| {
        stops.extend_from_slice(found);
        Ok(true)
    })?;
    assert_eq!(stops.len(), runs.len());
    for (stop, (at, run)) in stops.iter().zip(runs) {
        let right =
            stop.rows.iter().filter(|row| row.row.side == TrackSide::Right && row.approach.is_finite());
        let found: Vec<[f64; 2]> = right.map(|row| [row.approach, row.normal_load]).collect();
        let parts = run.parts.iter().filter(|part| part.site.side() == Some(TrackSide::Right));
        let of = |part: &Part| {
            let contact = &part.site.contact;
            [contact.approach.unwrap(), contact.normal_loads.iter().sum()]
        };
        let expected: Vec<[f64; 2]> = parts.map(of).collect();
        assert_eq!(found.len(), expected.len(), "{at}: {found:?} {expected:?}");
        for (a, b) in found.iter().flatten().zip(expected.iter().flatten()) {
            assert!((a / b - 1.0).abs() < 1e-9, "{at}: {found:?} {expected:?}");
        }
    }
    Ok(())
}

#[test]
fn a_march_under_a_load_carries_what_runs_do() -> Result<()> {
    let (folder, text) = example("crossing");
    let case = scene::march(&scene::parse(&format!("{text}\n[patch]\nload = 1.0e5"), false)?, &folder)?;
    // At the second place wing and nose share the load.
    let at = |along: f64| Ok((along, run(along, "[patch]\nload = 1.0e5")?));
    marches_as_it_runs(&case, ALONG, &[at(0.0)?, at(122.5)?, at(160.0)?])
}

#[test]
fn a_patch_that_the_last_slice_cuts_off_is_warned_of() -> Result<()> {
    for (along, cut) in [(160.0, false), (349.0, true), (-150.0, true)] {
        let run = run(along, "[patch]\napproach = 0.1")?;
        let warned = run.parts[0].warnings.iter().any(|warning| warning.contains("the end of the slices"));
        assert_eq!(warned, cut, "{along}: {:?}", run.parts[0].warnings);
    }
    Ok(())
}

#[test]
fn a_mere_touch_has_no_patch() -> Result<()> {
    let placement = on_crown(|y| 0.05 * y, &[-150.0, -70.0, 10.0, 80.0, 120.0], 0.01, 12.0)?;
    for approach in [0.0, 1e-15, 1e-12] {
        let patch = Patch::new(&placement, approach, &Window::UNBOUNDED);
        assert_eq!(patch.components.len(), 0, "{approach}");
    }
    assert_eq!(Patch::new(&placement, 1e-9, &Window::UNBOUNDED).components.len(), 1);
    let error = run(160.0, "[patch]\napproach = 0.0").map(drop).unwrap_err().to_string();
    assert!(error.contains("grid: found auto, and no patch"), "{error}");
    Ok(())
}

#[test]
fn what_rails_that_vary_do_not_have_is_refused_by_name() {
    for (along, more, message) in [
        ("160.0", "[patch]\napproach = 0.05\nframe = \"weighted\"", "patch: frame: found"),
        ("160.0", "[roller]\nradius = 350.0", "roller: found one"),
        ("999.0", "", "wheelset: along: found 999.0 mm; expected a place from -150 to 350 mm"),
        ("nan", "", "wheelset: along"),
        (
            "160.0",
            "[patch]\napproach = 20.0",
            "patch: approach: found 20.0 mm; expected 0 to 10 mm with a rail that varies",
        ),
        (
            "160.0",
            "[grid]\nmethod = \"report-newton\"\n[patch]\napproach = 0.05",
            "grid: method: found report-newton with",
        ),
    ] {
        let error = run_text(along, more).map(drop).unwrap_err().to_string();
        assert!(error.contains(message), "{more}: {error}");
    }
}

fn run_text(along: &str, more: &str) -> Result<Run> {
    let (folder, text) = example("crossing");
    let text = text.replace("lateral = 0.0", &format!("lateral = 0.0\nalong = {along}"));
    Run::new(scene::resolve(&scene::parse(&format!("{text}\n{more}"), false)?, &folder, "")?, SILENT)
}

/// Share by which forces differ from CONTACT's at the sinking that it imposes, where one place carries the wheel; its sinking has four
/// digits.
const FORCES: f64 = 0.03;

/// Where two places 12 mm apart carry the wheel \[mm\]: they have two frames here, and one weighted one there.
const TWO_PLACES: [f64; 3] = [2000.0, 2040.0, 2080.0];

#[test]
fn forces_on_a_crossing_are_contact_s() -> Result<()> {
    let Some(copy) = std::env::var_os("WHEELRAIL_CONTACT") else { return Ok(()) };
    let profiles = Path::new(&copy).join("testbank/profiles");
    let mut compared = 0;
    for case in cases() {
        let patches = case["patches"].as_array().unwrap();
        let (Some(touch), [patch]) = (case["z_first_touch"].as_f64(), patches.as_slice()) else { continue };
        let [force, s] = [&patch["fn"], &case["s"]].map(|value| value.as_f64().unwrap());
        if !case["rail"].as_str().unwrap().ends_with(".slcs") || force == 0.0 || TWO_PLACES.contains(&s) {
            continue;
        }
        // The vertical part of CONTACT's normal force, by its contact angle; friction carries the rest.
        let load = force * patch["deltcp_tr"].as_f64().unwrap().cos();
        let text = scene_of(&case, "cubic", &format!("along = {s}\nwithin = 1.0\n[patch]\nload = {load}\n"));
        let run = Run::new(scene::resolve(&scene::parse(&text, false)?, &profiles, "")?, SILENT)?;
        let parts = run.parts.iter().filter(|part| part.site.side() == Some(TrackSide::Right));
        let parts: Vec<_> = parts.collect();
        let [part] = parts.as_slice() else { continue };
        let contact = &part.site.contact;
        let sunk = contact.approach.unwrap() / contact.placement.upright();
        let off = ((case["z"].as_f64().unwrap() - touch) / sunk).powf(1.5) - 1.0;
        assert!(off.abs() < FORCES, "{} at {s}, y = {}: force off by {off:.4}", case["group"], case["y"]);
        compared += 1;
    }
    assert!(compared > 50, "{compared}");
    Ok(())
}

/// Difference of a height under load from CONTACT's \[mm\], and distance of C from the middle of its patch along the rail.
const HEIGHT: f64 = 1.5e-3;
const OF_MIDDLE: f64 = 0.6;

#[test]
fn heights_and_patches_under_a_load_are_contact_s() -> Result<()> {
    let Some(copy) = std::env::var_os("WHEELRAIL_CONTACT") else { return Ok(()) };
    let profiles = Path::new(&copy).join("testbank/profiles");
    let mut compared = 0;
    // CONTACT's height is prescribed in these, or under another force than its patches carry.
    for case in cases().iter().filter(|case| case["z_first_touch"].is_null()) {
        let number = |value: &Value| value.as_f64().unwrap();
        let patches = case["patches"].as_array().unwrap();
        let load: f64 = patches.iter().map(|own| number(&own["fn"]) * number(&own["deltcp_tr"]).cos()).sum();
        let more = format!("along = {:?}\nwithin = 1.0\n[patch]\nload = {load:?}\n", number(&case["s"]));
        let text = scene_of(case, "cubic", &more);
        let run = Run::new(scene::resolve(&scene::parse(&text, false)?, &profiles, "")?, SILENT)?;
        let right = run.parts.iter().filter(|part| part.site.side() == Some(TrackSide::Right));
        let parts: Vec<_> = right.collect();
        let contact = &parts[0].site.contact;
        let found = contact.found.as_ref().unwrap();
        let sunk = contact.approach.unwrap() / contact.placement.upright();
        let place = format!("{} {}", case["group"], case["case"]);
        // Down as CONTACT's.
        let height = sunk - found.height_mm;
        assert!((height - number(&case["z"])).abs() < HEIGHT, "{place}: {height} {}", case["z"]);
        assert_eq!(parts.len(), patches.len(), "{place}");
        let near = |own: &Value| (number(&own["ycp_r"]) - found.place.rail_x_mm).abs() < OF_MIDDLE;
        let own = patches.iter().find(|own| near(own)).unwrap_or_else(|| panic!("{place}: {found:?}"));
        let off = (number(&own["pen"]) / contact.approach.unwrap()).powf(1.5) - 1.0;
        assert!(off.abs() < FORCES, "{place}: force off by {off:.4}");
        compared += 1;
    }
    assert_eq!(compared, 27);
    Ok(())
}

//! Contacts of wheels that vary around their axle: the round wheel, a cone with a flat in space, flood fills, runs, and CONTACT's forces.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use wheelrail::case::{AROUND, Run, SILENT};
use wheelrail::error::Result;
use wheelrail::internal::Random;
use wheelrail::load::curvatures;
use wheelrail::lofted::{Flat, LoftedBody, LoftedWheel};
use wheelrail::nalgebra;
use wheelrail::patch::Patch;
use wheelrail::placement::{Creepages, Motion, Placement, Rates};
use wheelrail::scene;
use wheelrail::search::TrackSide;
use wheelrail::{Arc as Segments, Evaluator, Pair, Profile, Segment, Window, feasibility, standards};

use super::around_the_wheel::{RADIUS, cases, crown, of_right, position, turning};
use super::campaign::scenes;
use super::over_slices::{example, floods, marches_as_it_runs};

/// Slope of the cone's tread.
const SLOPE: f64 = 0.05;

/// A tread on a cone.
pub(super) fn cone() -> Result<Profile> {
    let line = Segments::line([-60.0, 60.0 * SLOPE], [60.0, -60.0 * SLOPE])?;
    Profile::new("cone", "", vec![Segment::arc(line)])
}

/// The right-hand contact of a wheel that is turned by a pitch \[rad\], with the pair placed there.
pub(super) fn placed(
    wheel: &LoftedWheel,
    rail: &Profile,
    [lateral, yaw, roll]: [f64; 3],
    pitch: f64,
) -> Result<Placement> {
    let march = turning(wheel, rail, position(lateral, yaw, roll), 0.0)?;
    let pair = Pair::new(rail.clone(), cone()?, RADIUS)?;
    let body = LoftedBody::Wheel(Arc::new(wheel.clone()));
    of_right(&march.turned(pitch)?)?.contact.placed_on(&pair, &body, 0.0)
}

pub(super) fn random_position(random: &mut Random) -> [f64; 3] {
    [random.between(-6.0, 6.0), random.between(-0.02, 0.02), random.between(-0.004, 0.004)]
}

/// A wheel whose radius does not vary at a random position, and the round wheel that it is.
pub(super) fn round_wheels(random: &mut Random) -> Result<[Placement; 2]> {
    let (profile, rail) = (standards::wheel("S1002")?, standards::rail("60E1")?);
    let wheel = LoftedWheel::out_of_round(&profile, RADIUS, &[[-2.0, 0.0], [1.0, 0.0]])?;
    let [lateral, yaw, roll] = random_position(random);
    let march = turning(&wheel, &rail, position(lateral, yaw, roll), 0.0)?;
    let contact = of_right(&march.turned(random.between(-7.0, 7.0))?)?.contact;
    let pair = Pair::new(rail, profile, RADIUS)?;
    Ok([contact.placed_on(&pair, &LoftedBody::Wheel(Arc::new(wheel)), 0.0)?, contact.placed(&pair)?])
}

#[test]
fn a_radius_that_does_not_vary_has_the_separation_and_patch_of_the_round_wheel() -> Result<()> {
    let mut random = Random::new(350);
    let mut alike = 0;
    for scene in 0..scenes().div_ceil(8) {
        let [lofted, round] = round_wheels(&mut random)?;
        let (mut own, mut other) = (Evaluator::new(&lofted), Evaluator::new(&round));
        for _ in 0..100 {
            let at = [random.between(-12.0, 12.0), random.between(-20.0, 20.0)];
            let (found, expected) = (own.separation(at[0], at[1]), other.separation(at[0], at[1]));
            // At its end one of them may have a surface by rounding.
            if found.is_nan() || expected.is_nan() {
                continue;
            }
            // A steep surface is off along its normal.
            let steep = 1.0 + other.separation_and_gradient(at[0], at[1]).1[0].abs();
            assert!((found - expected).abs() < 1e-10 * steep, "scene {scene} {at:?}: {found} {expected}");
            let [a, b] = [own.normals(at[0], at[1]), other.normals(at[0], at[1])].map(|n| n.wheel.unwrap());
            assert!((*a - *b).norm() < 1e-9, "scene {scene} {at:?}: {a:?} {b:?}");
            alike += 1;
        }
        let [a, b] = [curvatures(&lofted), curvatures(&round)];
        assert!(a.a_per_mm.is_nan() || (a.a_per_mm - b.a_per_mm).abs() < 1e-9, "{a:?} {b:?}");
        let rates = Rates { lateral: 90.0, yaw: 0.04, roll: 0.03, ..Rates::default() };
        let motion = Motion::new(2e4, rates)?;
        let [c, d] = [&lofted, &round].map(|placement| motion.creepages(placement, 680.0, RADIUS));
        let (c, d) = (c?, d?);
        let slips = |c: &Creepages| {
            [c.longitudinal, c.lateral, RADIUS * c.spin, RADIUS * c.turn[0], RADIUS * c.turn[1]]
        };
        for (found, expected) in slips(&c).into_iter().zip(slips(&d)) {
            assert!((found - expected).abs() < 1e-9, "scene {scene}: {c:?} {d:?}");
        }
        let [area, expected] =
            [&lofted, &round].map(|placement| Patch::new(placement, 0.05, &Window::UNBOUNDED).area());
        assert!((area / expected - 1.0).abs() < 1e-7, "scene {scene}: {area} {expected}");
    }
    assert!(alike > 90 * scenes().div_ceil(8), "{alike}");
    Ok(())
}

/// ζ of a cone with a flat of a half-angle at (ξ, η) of a frame: by bisection along the line, in the wheel's own axes.
fn flattened(placement: &Placement, half: f64, [xi, eta]: [f64; 2]) -> f64 {
    let frame = placement.lofted_wheel().unwrap();
    let (origin, axes) = (frame.origin(), frame.axes());
    let inside = |zeta: f64| {
        // Upside down: z counts away from the axle.
        let [x, y, out] =
            [0, 1, 2].map(|k| origin[k] + xi * axes[0][k] + eta * axes[1][k] + zeta * axes[2][k]);
        let angle = y.atan2(RADIUS + out);
        let around = frame.along() / RADIUS + angle;
        let share = if around.abs() < half { half.cos() / around.cos() } else { 1.0 };
        // √(y² + (R + z)²) < share (R + slope x), without a large difference.
        let distance = out + y * y / (RADIUS + out + y.hypot(RADIUS + out));
        distance < share * SLOPE * x + (share - 1.0) * RADIUS
    };
    let (mut outside, mut within) = (-20.0, 20.0);
    for _ in 0..200 {
        let middle = 0.5 * (outside + within);
        if inside(middle) { within = middle } else { outside = middle }
    }
    0.5 * (outside + within)
}

#[test]
fn a_cone_with_a_flat_has_the_height_of_its_surface_in_space() -> Result<()> {
    let mut random = Random::new(351);
    for scene in 0..scenes().div_ceil(8) {
        let length = random.between(20.0, 90.0);
        let half = (length / 2.0 / RADIUS).asin();
        let wheel = LoftedWheel::with_flat(&cone()?, RADIUS, &Flat { length, angle: 0.0, edge_radius: 0.0 })?;
        let [lateral, yaw, roll] = random_position(&mut random);
        let placement = placed(&wheel, &crown()?, [lateral, yaw, roll], random.between(-0.2, 0.2))?;
        let mut evaluator = Evaluator::new(&placement);
        for _ in 0..50 {
            let at = [random.between(-9.0, 9.0), random.between(-60.0, 60.0)];
            let found = evaluator.separation(at[0], at[1]) + evaluator.lower_height(at[0], at[1]);
            let expected = flattened(&placement, half, at);
            assert!((found - expected).abs() < 5e-13, "scene {scene}, {at:?}: {found} {expected}");
        }
        // The frame has the axle where the wheelset has it, and rail and wheel face each other at C unless an edge touches.
        let frame = placement.lofted_wheel().unwrap();
        let axle = frame.axes().map(|axis| axis[0]);
        let (sin, cos) = placement.rail().contact_angle().sin_cos();
        let axle =
            nalgebra::Vector3::new(cos * axle[0] - sin * axle[2], axle[1], sin * axle[0] + cos * axle[2]);
        let expected = position(lateral, yaw, roll).rotation(roll) * nalgebra::Vector3::x();
        assert!((axle - expected).norm() < 1e-9, "scene {scene}: {axle:?} {expected:?}");
        if curvatures(&placement).a_per_mm.is_finite() {
            let normals = evaluator.normals(0.0, 0.0);
            let sum = *normals.rail.unwrap() + *normals.wheel.unwrap();
            assert!(sum.norm() < 1e-7, "scene {scene}: {normals:?}");
        }
        let least = feasibility(&placement).unwrap().least_separation_mm;
        assert!(least > -1e-8, "scene {scene}: {least}");
    }
    Ok(())
}

#[test]
fn patches_of_random_flats_are_what_a_flood_fill_finds() -> Result<()> {
    let (mut random, mut found) = (Random::new(352), 0u64);
    let count = scenes().div_ceil(2);
    for scene in 0..count {
        let flat = Flat {
            length: random.between(10.0, 90.0),
            angle: 0.0,
            edge_radius: if scene % 2 == 0 { 0.0 } else { random.between(1.0, 60.0) },
        };
        let wheel = LoftedWheel::with_flat(&cone()?, RADIUS, &flat)?;
        let pitch = if scene % 5 == 0 { 0.0 } else { random.between(-0.12, 0.12) };
        let placement = placed(&wheel, &crown()?, random_position(&mut random), pitch)?;
        let patch = Patch::new(&placement, 10.0f64.powf(random.between(-3.0, -0.3)), &Window::UNBOUNDED);
        match floods(&placement, &patch) {
            Ok(inside) => found += u64::from(inside > 0),
            Err(fault) => panic!("scene {scene}, {flat:?}, pitch {pitch}: {fault}"),
        }
        assert!(patch.components.len() < 10, "scene {scene}: {} components", patch.components.len());
    }
    assert!(2 * found > count, "{found}");
    Ok(())
}

/// A run of the example at a pitch \[rad\].
pub(super) fn run(pitch: f64, more: &str) -> Result<Run> {
    let (folder, text) = example("wheel_flat");
    let text = text
        .replace("lateral = 0.0", &format!("lateral = 0.0\npitch = {}", format!("{pitch:?}").to_lowercase()));
    Run::new(scene::resolve(&scene::parse(&format!("{text}\n{more}"), false)?, &folder, "")?, SILENT)
}

#[test]
fn a_wheel_on_its_flat_is_run_like_any_other() -> Result<()> {
    // Away from the flat it is the round wheel; on its edge the patch is narrow, on the flat as long as that.
    let [round, edge, flat] = [1.0, 0.04, 0.0].map(|pitch| run(pitch, "[patch]\nload = 6.0e4"));
    let (round, edge, flat) = (round?, edge?, flat?);
    for run in [&round, &edge, &flat] {
        assert_eq!(run.parts.len(), 2);
        for part in &run.parts {
            let patch = part.analysis.patch.as_ref().unwrap();
            let cells: f64 = part.analysis.strips.as_ref().unwrap().cells.iter().map(|cell| cell.area).sum();
            assert!((cells / patch.area() - 1.0).abs() < 1e-6 && !patch.cut_by_window(), "{cells}");
            assert!(part.analysis.separation.iter().all(|s| s.is_finite()));
            let loads: f64 = part.site.contact.normal_loads.iter().sum();
            assert!((loads - 6.0e4).abs() < 100.0, "{loads}");
        }
    }
    let length = |run: &Run| {
        let extent = run.parts[0].analysis.patch.as_ref().unwrap().extent().unwrap();
        extent.eta.width()
    };
    let lengths = [&round, &edge, &flat].map(length);
    assert!(
        lengths[1] < lengths[0] && lengths[0] < 30.0 && (59.0..64.0).contains(&lengths[2]),
        "{lengths:?}"
    );
    // Left and right are mirror images.
    let areas: Vec<f64> =
        edge.parts.iter().map(|part| part.analysis.patch.as_ref().unwrap().area()).collect();
    assert!((areas[0] / areas[1] - 1.0).abs() < 1e-9, "{areas:?}");
    Ok(())
}

/// On the sharp edge of a flat s has a crease: its patch ends in two points.
#[test]
fn a_patch_on_the_edge_of_a_flat_has_two_tips() -> Result<()> {
    let text = "[rail]\nprofile = \"54E1\"\nrotate = \"1:40\"\n[wheel]\nradius = 337.3\nprofile = \"EN13715-1:40-h28-e32.5\"\n\
                flat = { length = 54.7, angle = -0.069 }\n[track]\ngauge = 1435\n[wheelset]\nback_to_back = 1360\n\
                flange_back_x = -70.0\nlateral = -5.113\nyaw = 0.03\nroll = \"neglect\"\npitch = 0.129\n\
                [patch]\napproach = 0.030434242730778938\n";
    let run = Run::new(scene::resolve(&scene::parse(text, false)?, Path::new(""), "")?, SILENT)?;
    let patch = run.parts[0].site.contact.whole_patch().expect("a patch");
    let tips = patch.components[0].xi;
    for (tip, inward) in [(tips.low, 1e-6), (tips.high, -1e-6)] {
        let width = patch.slices(tip + inward)[0].1.eta.width();
        assert!((1e-9..2e-6).contains(&width), "{width:e} at {tip}");
    }
    Ok(())
}

#[test]
fn a_wheel_that_turns_under_a_load_carries_what_runs_do() -> Result<()> {
    let (folder, text) = example("wheel_flat");
    let case = scene::march(&scene::parse(&format!("{text}\n[patch]\nload = 6.0e4"), false)?, &folder)?;
    let at = |pitch: f64| Ok((pitch, run(pitch, "[patch]\nload = 6.0e4")?));
    marches_as_it_runs(&case, AROUND, &[at(-0.03)?, at(0.0)?, at(1.0)?])
}

#[test]
fn a_single_wheel_with_a_flat_stands_as_that_of_a_wheelset_does() -> Result<()> {
    let text = |more: &str| {
        format!(
            "[rail]\nprofile = \"60E1\"\n[wheel]\nprofile = \"S1002\"\nradius = 460.0\n\
             flat = {{ length = 60.0, edge_radius = 20.0 }}\n[contact]\n{more}\n[patch]\napproach = 0.05"
        )
    };
    let made = |more: &str| {
        let scene = scene::parse(&text(more), false)?;
        Run::new(scene::resolve(&scene, Path::new(""), "")?, SILENT)
    };
    let run = made("offset = 0.0\npitch = 0.04")?;
    let contact = run.parts[0].site.contact.found.as_ref().unwrap();
    // The flat's middle is 18.4 mm ahead, and its edge behind that 30 mm away.
    assert!((contact.place.y_mm + 11.7).abs() < 0.2, "{contact:?}");
    assert!(run.parts[0].analysis.patch.as_ref().unwrap().area() > 10.0);
    for (more, message) in [
        ("offset = 0.0\nalong = 3.0", "contact: along: found 3 without effect"),
        ("rail_x = 0.0\nwheel_x = 0.0", "contact: rail_x: found a chosen point"),
        ("offset = 0.0\npitch = nan", "contact: pitch: found NaN"),
    ] {
        let error = made(more).map(drop).unwrap_err().to_string();
        assert!(error.contains(message), "{error}");
    }
    Ok(())
}

#[test]
fn what_wheels_that_vary_do_not_have_is_refused_by_name() {
    for (pitch, more, message) in [
        (0.0, "[patch]\napproach = 0.05\nframe = \"weighted\"", "patch: frame: found"),
        (0.0, "[roller]\nradius = 350.0", "roller: found one"),
        (f64::NAN, "", "wheelset: pitch: found NaN"),
        (0.0, "[patch]\napproach = 20.0", "patch: approach: found 20.0 mm; expected 0 to 10 mm with a wheel"),
        (
            0.0,
            "[grid]\nmethod = \"spectral\"\n[patch]\napproach = 0.05",
            "grid: method: found spectral with a wheel",
        ),
    ] {
        let error = run(pitch, more).map(drop).unwrap_err().to_string();
        assert!(error.contains(message), "{more}: {error}");
    }
}

/// Share by which forces differ from CONTACT's at the approach that it finds.
const FORCES: f64 = 0.01;

/// Writes CONTACT's list of slices with a flat and its slices, each the mean of itself (four parts of six) and its neighbours: the cubic
/// spline through these is the one that has the slices for its control points, which CONTACT takes here.
fn approximated(from: &Path, to: &Path) {
    let list = std::fs::read_to_string(from.join("flat_d09.slcw")).unwrap();
    let names: Vec<&str> = list.split('\'').filter(|name| name.ends_with(".txt")).collect();
    let read = |name: &&str| -> Vec<[f64; 2]> {
        let text = std::fs::read_to_string(from.join(name)).unwrap();
        let row =
            |line: &str| line.split_whitespace().map(|number| number.parse().unwrap()).collect::<Vec<f64>>();
        text.lines().map(row).map(|row| [row[0], row[1]]).collect()
    };
    let slices: Vec<Vec<[f64; 2]>> = names.iter().map(read).collect();
    std::fs::create_dir(to.join("flat_d09")).unwrap();
    for (k, name) in names.iter().enumerate() {
        let [before, after] = [k.saturating_sub(1), (k + 1).min(names.len() - 1)];
        let mean = |j: usize| {
            let [a, b, c] = [before, k, after].map(|k| slices[k][j]);
            format!("{:?} {:?}\n", b[0], (a[1] + 4.0 * b[1] + c[1]) / 6.0)
        };
        let text: String = (0..slices[k].len()).map(mean).collect();
        std::fs::write(to.join(name), text).unwrap();
    }
    std::fs::write(to.join("flat_d09.slcw"), list).unwrap();
    std::fs::copy(from.join("circ_r300.prr"), to.join("circ_r300.prr")).unwrap();
}

#[test]
fn forces_on_a_flat_are_contact_s() -> Result<()> {
    let Some(copy) = std::env::var_os("WHEELRAIL_CONTACT").map(PathBuf::from) else { return Ok(()) };
    let folder = tempfile::tempdir().unwrap();
    approximated(&copy.join("testbank/profiles"), folder.path());
    let mut compared = 0;
    for case in cases("rounded_flat_d09") {
        let [pitch, load] = ["pitch", "fz"].map(|key| case[key].as_f64().unwrap());
        // Differences of its heights have two digits.
        let expected = case["patches"][0]["pen"].as_f64().unwrap();
        let text = format!(
            "[rail]\nfile = \"circ_r300.prr\"\ncurve = \"interpolation\"\n\
             [wheel]\nfile = \"flat_d09.slcw\"\nradius = 450.0\ncurve = \"interpolation\"\nmirror = false\nflip_z = true\n\
             surface = \"cubic\"\n\
             [track]\nspacing = 1500.0\n[wheelset]\nspacing = 1500.0\nroll = 0.0\npitch = {pitch:?}\nwithin = 1.0\n\
             [patch]\nload = {load:?}\n"
        );
        let scene = scene::parse(&text, false)?;
        let run = Run::new(scene::resolve(&scene, folder.path(), "")?, SILENT)?;
        let right = run.parts.iter().find(|part| part.site.side() == Some(TrackSide::Right)).unwrap();
        let approach = right.site.contact.approach.unwrap();
        let off = (expected / approach).powf(1.5) - 1.0;
        assert!(off.abs() < FORCES, "at {pitch}: {approach} for {expected}, force off by {off:.4}");
        compared += 1;
    }
    assert_eq!(compared, 8);
    Ok(())
}

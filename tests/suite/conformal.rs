//! The normal gap of conformal contact against 60-digit values and closed forms.

use crate::common::{profile, repository};
use wheelrail::Evaluator;
use wheelrail::Interval;
use wheelrail::case::{Case, Profiles, Run, SILENT};
use wheelrail::conformal::{GapPoint, NormalGap, fill_normal_gap};
use wheelrail::scene::{self, Scene};
use wheelrail::search::TrackSide;
use wheelrail::separation::EtaAxis;
use wheelrail::{Arc, Half, Pair, Patch, Placement, Window, inclination};
use wheelrail_check::{NormalGapSample, check_normal_gap};
use wheelrail_report::conformal::values::{
    BOUNDS, FILES, GapBound, GapErrors, GapReference, GapValue, PROMISED_ABSOLUTE, PROMISED_RELATIVE,
    gap_references,
};
use wheelrail_report::reference::exact;
use wheelrail_report::specimen::{Instrument, Specimen, SpecimenKind};

fn references() -> Vec<GapReference> {
    gap_references().expect("the files' format")
}

/// A row of [`BOUNDS`] whose measured error is this much below it fails as "tighten me".
const MOST_SLACK: f64 = 4.0;

/// Largest error of α \[rad\] and of (ξ, ζ) \[mm\].
const PLACE: f64 = 1.5e-14;

#[test]
fn the_normal_gap_keeps_its_digits() {
    for GapBound { grid, skewed, relative, absolute } in BOUNDS {
        assert!(relative <= PROMISED_RELATIVE && absolute <= PROMISED_ABSOLUTE);
        let mut all = GapErrors::NONE;
        for reference in references().iter().filter(|reference| reference.skewed() == skewed) {
            let errors = reference.errors(&reference.placement().expect("a placement"), grid);
            let what = format!("{} grid {grid}: {errors:?}", reference.name);
            assert!(errors.relative <= relative && errors.absolute <= absolute, "{what}");
            assert_eq!(errors.wrongly_masked, 0, "{what}");
            all = all.and(errors);
        }
        println!("grid {grid} skewed {skewed}: {all:?}");
        assert!(all.over_contact > 80 && all.elsewhere > 15, "{all:?}");
        assert!(all.relative * MOST_SLACK >= relative, "tighten grid {grid} skewed {skewed}: {all:?}");
        assert!(all.absolute * MOST_SLACK >= absolute, "tighten grid {grid} skewed {skewed}: {all:?}");
    }
}

#[test]
fn closest_distances_agree_with_the_normal_gap_of_every_scene() {
    for reference in references() {
        let placement = reference.placement().expect("a placement");
        let gap = NormalGap::new(&placement);
        let values = reference.normal_gap.iter();
        let samples: Vec<_> =
            values.filter_map(|value| NormalGapSample::at(&gap, value.sigma, value.eta)).collect();
        let report = check_normal_gap(&placement, &samples).expect("a check");
        assert!(report.agrees && report.points > 10, "{}: {report}", reference.name);
    }
}

#[test]
fn every_file_of_values_is_embedded() {
    let files = std::fs::read_dir(repository("crates/report/src/conformal/reference"))
        .expect("the folder of reference values");
    let paths = files.map(|entry| entry.expect("a file").path());
    let mut on_disk: Vec<_> = paths.filter(|path| path.extension().is_some_and(|e| e == "json")).collect();
    on_disk.sort();
    let names: Vec<_> = on_disk.iter().filter_map(|path| path.file_stem()?.to_str()).collect();
    assert_eq!(names, FILES.map(|(name, _)| name));
}

#[test]
fn the_rail_is_where_its_arc_length_says() {
    let mut worst = 0f64;
    for GapReference { name, scene, normal_gap } in references() {
        let placement = scene.placement().expect("a placement");
        let gap = NormalGap::new(&placement);
        for GapValue { sigma, angle: alpha, xi, zeta, .. } in &normal_gap {
            let (Some(alpha), Some(xi), Some(zeta)) = (alpha, xi, zeta) else {
                assert!(gap.angle(*sigma).is_nan(), "{name} {sigma}");
                continue;
            };
            let at = gap.rail().point(*sigma).expect("a point of the rail");
            let errors = [gap.angle(*sigma) - exact(alpha), at.xi - exact(xi), at.zeta - exact(zeta)];
            let error = errors.into_iter().fold(0.0, |most: f64, error| most.max(error.abs()));
            assert!(error <= PLACE, "{name} {sigma}: {errors:?}");
            assert!((gap.rail().sigma(at.xi) - sigma).abs() <= 4.0 * PLACE, "{name} {sigma}");
            worst = worst.max(error);
        }
    }
    assert!(worst * MOST_SLACK >= PLACE, "tighten: {worst:e}");
}

/// An upper arc about (0, −r) under one about the same point or touching it at C.
fn arcs(rail: f64, wheel: f64, radius: f64, skew: f64) -> Placement {
    let arc = |r: f64| Arc::about([0.0, -r], r, Half::Upper, [-0.95 * r, 0.95 * r]).and_then(profile);
    let pair = Pair::new(arc(rail).expect("a rail"), arc(wheel).expect("a wheel"), radius);
    pair.and_then(|pair| pair.placed(0.0, 0.0, skew)).expect("a placement")
}

#[test]
fn coaxial_tori_have_the_gap_of_their_radii() {
    // Both arcs touch at C. In the midplane the ray at angle α meets the circle about (0, −r_W).
    let (rail, wheel) = (13.0, 15.0);
    let gap_of = arcs(rail, wheel, 460.0, 0.0);
    let gap = NormalGap::new(&gap_of);
    let apart = wheel - rail;
    for k in -9..=9 {
        let alpha = 0.1 * f64::from(k);
        // |O_R + (r + t) n − O_W| = r_W, with the centres `apart` one above the other.
        let (sin, cos) = (alpha.sin(), alpha.cos());
        let t = (wheel * wheel - (apart * sin).powi(2)).sqrt() - apart * cos - rail;
        let found = gap.gap(-rail * alpha, 0.0);
        assert!((found - t).abs() < 4e-15, "{alpha}: {found} {t}");
        assert!((gap.angle(-rail * alpha) - alpha).abs() < 1e-15);
    }
}

#[test]
fn an_arc_in_its_own_groove_has_no_gap_in_the_midplane() {
    let same = arcs(13.0, 13.0, 460.0, 0.0);
    let gap = NormalGap::new(&same);
    for sigma in [-12.0, -3.0, 0.0, 5.0, 13.0] {
        assert_eq!(gap.gap(sigma, 0.0), 0.0);
        // Along η the wheel rises by its sagitta: along the normal that is e cos α to first order.
        let (e, t) = (460.0 - (460.0f64 * 460.0 - 1.0).sqrt(), gap.gap(sigma, 1.0));
        let first = e * gap.angle(sigma).cos();
        assert!((t - first).abs() < e * (e / 13.0 + 13.0 / 460.0), "{sigma}: {t} {first}");
    }
}

#[test]
fn a_ball_in_a_torus_groove_has_the_gap_of_two_circles() {
    // The groove of a wheel whose arc's centre is on its axle is a ball.
    let (rail, ball) = (20.0, 100.0);
    let arc = |r: f64, half: Half, centre: f64| {
        Arc::about([0.0, centre], r, half, [-0.6 * r, 0.6 * r]).and_then(profile).expect("an arc")
    };
    let pair = Pair::new(arc(rail, Half::Upper, -rail), arc(ball, Half::Lower, ball), ball).expect("a pair");
    for skew in [0.0, 0.02] {
        let placement = pair.placed(0.0, 0.0, skew).expect("a placement");
        let gap = NormalGap::new(&placement);
        for (sigma, eta) in [(0.0, 0.0), (1e-4, 2e-5), (3.0, 1.0), (-7.0, 4.0), (9.0, -8.0)] {
            let angle: f64 = sigma / rail;
            // The line P + t n against the ball about (0, 0, ball): t² + 2 t b + c = 0.
            let p = [rail * angle.sin(), eta, -2.0 * rail * (0.5 * angle).sin().powi(2)];
            let n = [angle.sin(), 0.0, angle.cos()];
            let b = p[0] * n[0] + (p[2] - ball) * n[2];
            let c = p[0] * p[0] + p[1] * p[1] + p[2] * (p[2] - 2.0 * ball);
            let t = c / (-b + (b * b - c).sqrt());
            let found = gap.gap(sigma, eta);
            assert!((found - t).abs() <= 2e-15 * t.abs() + 1e-15 * t, "{skew} {sigma} {eta}: {found} {t}");
        }
    }
}

#[test]
fn the_gap_tends_to_the_separation_on_flat_rails() {
    let line = Arc::line([-30.0, 0.0], [30.0, 0.0]).and_then(profile).expect("a line");
    let tread =
        Arc::about([0.0, 330.0], 330.0, Half::Lower, [-60.0, 60.0]).and_then(profile).expect("an arc");
    let placement =
        Pair::new(line, tread, 460.0).and_then(|pair| pair.placed(0.0, 0.0, 0.01)).expect("a pair");
    let (gap, mut plane) = (NormalGap::new(&placement), Evaluator::new(&placement));
    for (sigma, eta) in [(1e-6, 0.0), (0.3, -2.0), (-8.0, 9.0), (25.0, 0.1)] {
        let (t, s) = (gap.gap(sigma, eta), plane.separation(sigma, eta));
        assert!((t - s).abs() <= 1e-15 * s, "{t} {s}");
    }
    // On a crown α = −σ/ρ, and t − s is of the order of s α² and of the slope of s times s α.
    let (mut last, mut ratios) = (f64::NAN, Vec::new());
    for radius in [300.0, 3000.0, 30_000.0] {
        let crown = Arc::about([0.0, -radius], radius, Half::Upper, [-30.0, 30.0]).and_then(profile);
        let cone = Arc::line([-60.0, 0.0], [60.0, 0.0]).and_then(profile).expect("a cone");
        let pair = crown.and_then(|crown| Pair::new(crown, cone, 460.0)).expect("a pair");
        let placement = pair.placed(0.0, 0.0, 0.0).expect("a placement");
        let gap = NormalGap::new(&placement);
        let at = gap.rail().point(8.0).expect("a point");
        let s = Evaluator::new(&placement).separation(at.xi, 3.0);
        let share = (gap.gap(8.0, 3.0) - s) / s;
        ratios.push(last / share);
        last = share;
    }
    // α falls by ten each time, so that the difference falls by a hundred.
    assert!(ratios[1..].iter().all(|ratio| (90.0..110.0).contains(ratio)), "{ratios:?}");
}

#[test]
fn rays_that_miss_are_no_numbers_and_overlap_is_negative() {
    let placement = arcs(13.0, 15.0, 460.0, 0.0);
    let gap = NormalGap::new(&placement);
    let Interval { low, high } = gap.rail().reach().expect("a range of σ");
    assert!((high - 13.0 * 0.95f64.asin()).abs() < 1e-13 && (low + high).abs() < 1e-13);
    assert!(gap.gap(high + 1e-9, 0.0).is_nan() && gap.point(high + 1e-9, 0.0).is_none());
    assert!(gap.gap(0.0, 470.0).is_nan());
    // A wheel's arc that is tighter than the rail's overlaps it on both sides of C.
    let tighter = arcs(15.0, 13.0, 460.0, 0.0);
    let gap = NormalGap::new(&tighter);
    for sigma in [-6.0, 2.0, 5.0] {
        let t = gap.gap(sigma, 0.0);
        let alpha: f64 = sigma / 15.0;
        let exact = (169.0 - (2.0 * alpha.sin()).powi(2)).sqrt() + 2.0 * alpha.cos() - 15.0;
        assert!(t < 0.0 && (t - exact).abs() < 4e-15, "{t} {exact}");
    }
}

#[test]
fn both_normals_are_those_of_the_surfaces() {
    for reference in references() {
        let placement = reference.placement().expect("a placement");
        let gap = NormalGap::new(&placement);
        for GapValue { sigma, eta, gap: t, angle: alpha, .. } in &reference.normal_gap {
            let (Some(_), Some(alpha)) = (t, alpha) else { continue };
            let GapPoint { rail, rail_normal, wheel_normal, gap: t, .. } =
                gap.point(*sigma, *eta).expect("a point");
            let (sin, cos) = exact(alpha).sin_cos();
            assert!((rail_normal.x + sin).abs() < 1e-14 && (rail_normal.z - cos).abs() < 1e-14);
            // The wheel's normal at the hit is that of the column over the same place.
            let over = rail.xi + t * rail_normal.x;
            let other = Evaluator::new(&placement).normals(over, *eta).wheel.expect("a normal");
            let normal = wheel_normal.expect("a normal of the wheel");
            assert!((normal.into_inner() - other.into_inner()).norm() < 1e-9, "{normal:?} {other:?}");
        }
    }
}

#[test]
fn on_a_flat_rail_the_conformal_patch_is_the_patch() {
    let line = Arc::line([-30.0, 0.0], [30.0, 0.0]).and_then(profile).expect("a line");
    let tread =
        Arc::about([0.0, 330.0], 330.0, Half::Lower, [-60.0, 60.0]).and_then(profile).expect("an arc");
    let pair = Pair::new(line, tread, 460.0).expect("a pair");
    for skew in [0.0, 0.03] {
        let placement = pair.placed(0.0, 0.0, skew).expect("a placement");
        let window = Window { xi: Interval::symmetric(12.0), eta: Interval::symmetric(14.0) };
        let found = Patch::over_rail(&placement, 0.05, &window);
        let patch = Patch::new(&placement, 0.05, &Window::UNBOUNDED);
        let ([found], [part]) = (&found.components[..], &patch.components[..]) else { panic!("{found:?}") };
        assert!((found.area / part.area - 1.0).abs() < 1e-12, "{} {}", found.area, part.area);
        assert!((found.perimeter / part.perimeter - 1.0).abs() < 1e-10, "{found:?}");
        for end in [0, 1] {
            assert!(
                (found.xi[end] - part.xi[end]).abs() < 1e-7 && (found.eta[end] - part.eta[end]).abs() < 2e-3
            );
        }
        assert!(!found.cut_by_window && NormalGap::new(&placement).angles(found.xi) == Interval::of(0.0));
    }
}

#[test]
fn a_conformal_patch_has_its_tips_where_the_gap_is_closed() {
    let placement = arcs(13.0, 13.5, 460.0, 0.0);
    let (gap, delta) = (NormalGap::new(&placement), 0.08);
    let window = Window { xi: Interval::symmetric(11.0), eta: Interval::symmetric(14.0) };
    let patch = Patch::over_rail(&placement, delta, &window);
    let [part] = &patch.components[..] else { panic!("{patch:?}") };
    for tip in part.xi.ends() {
        assert!((gap.gap(tip, 0.0) - delta * gap.angle(tip).cos()).abs() < 1e-14);
    }
    let angle = gap.angles(part.xi);
    assert!((part.xi.low + part.xi.high).abs() < 1e-9 && (angle[1] - part.xi.high / 13.0).abs() < 1e-12);
    // Cells of a fine grid.
    let step = 0.02;
    let axis =
        |reach: f64| (0..).map(move |k| step * (f64::from(k) + 0.5) - reach).take_while(move |v| *v < reach);
    let (sigma, eta): (Vec<f64>, Vec<f64>) = (axis(11.0).collect(), axis(12.0).collect());
    let mut t = vec![0.0; sigma.len() * eta.len()];
    fill_normal_gap(&gap, &sigma, &EtaAxis::new(&eta), 1e-9, &mut t);
    let inside = t.chunks(eta.len()).zip(&sigma).map(|(column, &sigma)| {
        let target = delta * gap.angle(sigma).cos();
        column.iter().filter(|&&t| t < target).count()
    });
    let cells = inside.sum::<usize>() as f64 * step * step;
    assert!((cells / patch.area() - 1.0).abs() < 1e-3, "{cells} {}", patch.area());
    let wider = Patch::over_rail(&placement, 0.1, &window);
    assert!(wider.area() > patch.area() && wider.components[0].xi.high > part.xi.high);
    // A window that is too small cuts the patch.
    let small = Window { xi: Interval::new(-11.0, 2.0), eta: Interval::symmetric(14.0) };
    assert!(Patch::over_rail(&placement, delta, &small).components[0].cut_by_window);
}

/// A gauge corner of 13 mm in a root of 14.5 mm.
const CORNER: &str = "rail.segments = [{ arc = { center = [0.0, -13.0], radius = 13.0, half = \"upper\", x = [-12.0, 12.0] } }]\n\
                      wheel = { radius = 460.0, segments = [{ arc = { center = [0.0, -14.5], radius = 14.5, half = \"upper\", \
                      x = [-13.5, 13.5] } }] }\ncontact = { rail_x = 0.0, wheel_x = 0.0 }\npatch = { approach = 0.08 }\n";

fn case(rest: &str) -> wheelrail::Result<Run> {
    let scene: Scene = scene::parse(&format!("{CORNER}{rest}"), false)?;
    Run::new(scene::resolve(&scene, ".".as_ref(), "corner")?, SILENT)
}

#[test]
fn a_run_over_the_plane_recommends_the_rail_where_the_normal_turns() {
    let warnings = case("").expect("a run").warnings();
    assert!(warnings.iter().any(|text| text.contains("grid.reference = \"rail\"")), "{warnings:?}");
    let tread = "rail.profile = \"60E1\"\nwheel = { profile = \"S1002\", radius = 460.0 }\n\
                 contact = { rail_x = 0.0, wheel_x = 0.0 }\npatch = { approach = 0.05 }\n";
    let scene: Scene = scene::parse(tread, false).expect("a scene");
    let case = scene::resolve(&scene, ".".as_ref(), "tread").expect("a case");
    assert_eq!(Run::new(case, SILENT).expect("a run").warnings(), [""; 0]);
}

#[test]
fn a_run_over_the_rail_has_both_gaps_at_the_same_points() {
    let run = case("grid = { reference = \"rail\" }\n").expect("a run");
    assert!(!run.warnings().iter().any(|text| text.contains("grid.reference")), "{:?}", run.warnings());
    let part = &run.parts[0];
    let (grid, conformal) = (&part.site.grid, part.analysis.conformal.as_ref().expect("a normal gap"));
    let gap = NormalGap::new(&part.site.contact.placement);
    for (i, at) in conformal.rail.iter().enumerate() {
        assert_eq!(at.xi, grid.xi[i]);
        for (j, &eta) in grid.eta.iter().enumerate().step_by(5) {
            let (found, t) = (conformal.gap[i * grid.eta.len() + j], gap.gap(at.sigma, eta));
            assert!((found - t).abs() < 1e-13 || (found.is_nan() && t.is_nan()), "{at:?} {eta}: {found} {t}");
        }
    }
    let patch = conformal.patch.as_ref().expect("a patch");
    assert!(patch.components.iter().all(|part| !part.cut_by_window), "{patch:?}");
}

/// The text of a scene with automatic grids over the rail.
fn over_rail(text: &str) -> Scene {
    scene::parse(&format!("{text}\n[grid]\nreference = \"rail\"\n"), false).expect("a scene")
}

/// Runs a case over the rail; no part of its grids' conformal patches is cut, and every grid has its margin.
fn uncut(case: wheelrail::Result<Case>) -> Run {
    let run = Run::new(case.expect("a case"), SILENT).expect("a run");
    for part in &run.parts {
        let conformal = part.analysis.conformal.as_ref().expect("a normal gap");
        let patch = conformal.patch.as_ref().expect("a patch");
        let name = part.site.name();
        assert!(!patch.components.is_empty(), "{name}");
        let sigma: Vec<f64> = conformal.rail.iter().map(|at| at.sigma).collect();
        for component in &patch.components {
            assert!(!component.cut_by_window, "{name}: {component:?}");
            for (axis, ends) in [(&sigma, component.xi), (&part.site.grid.eta, component.eta)] {
                let inner = [axis[1], axis[axis.len() - 2]];
                assert!(inner[0] < ends[0] && ends[1] < inner[1], "{name}: {ends:?} in {inner:?}");
            }
        }
    }
    assert!(!run.warnings().iter().any(|text| text.contains("cuts")), "{:?}", run.warnings());
    run
}

#[test]
fn automatic_grids_over_the_rail_cut_no_part() {
    let drawn = |text: &str| uncut(scene::resolve(&over_rail(text), ".".as_ref(), "uncut"));
    let pair =
        "[rail]\nprofile = \"60E1\"\nrotate = \"1:40\"\n[wheel]\nprofile = \"S1002\"\nradius = 460.0\n";
    for offset in [2.3, 3.0, 3.5] {
        for yaw in [0.0, 0.02] {
            let contact = format!("[contact]\noffset = {offset:?}\nyaw = {yaw:?}\n[patch]\nload = 60000.0\n");
            let run = drawn(&format!("{pair}{contact}"));
            assert!(run.parts.iter().all(|part| part.site.normal_load.is_some_and(|load| load > 0.0)));
        }
    }
    drawn(
        "[rail]\nprofile = \"54E3\"\n[wheel]\nprofile = \"EN15302-C\"\nradius = 460.0\n\
         [contact]\noffset = 4.0\n[patch]\napproach = 0.1\n",
    );
    let run = drawn(&format!("{pair}{WHEELSET}"));
    assert!(run.parts.iter().any(|part| part.site.side() == Some(TrackSide::Left)));
}

const WHEELSET: &str = "[track]\ngauge = 1435.0\n[wheelset]\nback_to_back = 1360.0\nflange_back_x = -70.0\nlateral = 5.0\n\
                        yaw = 0.005\n[patch]\nload = 60000.0\n";

#[test]
fn automatic_grids_over_worn_rails_cut_no_part() {
    let worn = |kind| Specimen::new(kind, Instrument::new(0.3, 3.0, 1979)).and_then(|made| made.profile());
    let [rail, wheel] =
        [SpecimenKind::WornRail, SpecimenKind::WornWheel].map(|kind| worn(kind).expect("a profile"));
    let pair =
        Pair::new(rail.rotated(inclination(1.0, 40.0).expect("a rotation")), wheel, 460.0).expect("a pair");
    let text = "[rail]\nprofile = \"60E1\"\n[wheel]\nprofile = \"S1002\"\nradius = 460.0\n";
    for rest in [WHEELSET, "[contact]\noffset = 3.0\nyaw = 0.02\n[patch]\napproach = 0.08\n"] {
        let scene = over_rail(&format!("{text}{rest}"));
        uncut(scene::with_profiles(&scene, Profiles::drawn(pair.clone()), "worn"));
    }
}

#[test]
fn bad_input_over_the_rail_is_refused() {
    let complaint = |rest: &str| case(rest).expect_err("an error").to_string();
    let beyond = complaint(
        "grid = { reference = \"rail\", xi = { from = -40.0, to = 4.0, n = 9 }, eta = { values = [0.0, 1.0] } }\n",
    );
    assert!(beyond.contains("grid: xi: found -40; expected σ within"), "{beyond}");
    let method = complaint("grid = { reference = \"rail\", method = \"pointwise\" }\n");
    assert!(method.contains("grid: method: found pointwise"), "{method}");
    let word = complaint("grid = { reference = \"wheel\" }\n");
    assert!(word.contains("wheel"), "{word}");
}

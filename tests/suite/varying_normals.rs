//! The gap along the rail's normals where a body varies: against the heights of both surfaces in space, against bodies that only seem to
//! vary, and its patches against a flood fill.

use std::sync::Arc;

use wheelrail::conformal::NormalGap;
use wheelrail::error::Result;
use wheelrail::internal::Random;
use wheelrail::lofted::{Flat, Joining, Loft, LoftedBody, LoftedWheel};
use wheelrail::{Evaluator, ONE_CONTACT, Pair, Patch, Placement, Pose, ProfilePair, Selection, Window};
use wheelrail_check::check_site;

use super::along_track::{RADIUS, slices};
use super::campaign::scenes;
use super::over_slices::{crown, cylinder, flooded, on_crown, run as crossing};
use super::turned_wheels::{cone, placed, random_position, round_wheels, run as flat};

/// Holds both ends of the normals' lines against the heights of the surfaces over the tangent plane, at random places up to `farthest`
/// \[mm\] from C. Returns how many were held.
fn on_both_surfaces(placement: &Placement, farthest: [f64; 2], random: &mut Random) -> usize {
    let (gap, mut evaluator) = (NormalGap::new(placement), Evaluator::new(placement));
    let mut held = 0;
    for _ in 0..200 {
        let [sigma, eta] = farthest.map(|most| random.between(-most, most));
        let Some(point) = gap.point(sigma, eta).filter(|point| point.gap.is_finite()) else { continue };
        assert_eq!(point.gap.to_bits(), gap.gap(sigma, eta).to_bits());
        let on_normal =
            |t: f64| [point.rail.xi + t * point.rail_normal.x, point.rail.zeta + t * point.rail_normal.z];
        let ends = [-point.below, point.gap - point.below].map(on_normal);
        let lower = evaluator.lower_height(ends[0][0], eta);
        let upper = evaluator.lower_height(ends[1][0], eta) + evaluator.separation(ends[1][0], eta);
        if lower.is_nan() || upper.is_nan() {
            continue;
        }
        // A steep surface is off along its normal.
        let wheel = evaluator.normals(ends[1][0], eta).wheel.unwrap();
        let steep = 1.0 + wheel.x.hypot(wheel.y) / wheel.z.abs();
        assert!((lower - ends[0][1]).abs() < 1e-10, "{sigma} {eta}: {lower}, {point:?}");
        assert!((upper - ends[1][1]).abs() < 1e-10 * steep, "{sigma} {eta}: {upper}, {point:?}");
        let normal = point.wheel_normal.unwrap();
        assert!((*normal - *wheel).norm() < 1e-8, "{sigma} {eta}: {normal:?} {wheel:?}");
        // ∂t/∂η, by a difference.
        let slope = (gap.gap(sigma, eta + 1e-4) - gap.gap(sigma, eta - 1e-4)) / 2e-4;
        let found = gap.slope(sigma, eta);
        assert!(slope.is_nan() || (found - slope).abs() < 1e-5, "{sigma} {eta}: {found} {slope}");
        held += 1;
    }
    held
}

/// Holds t and the conformal patch of a pair with a body that only seems to vary against those of the swept pair.
fn are_alike([varying, swept]: [&Placement; 2], random: &mut Random) -> usize {
    let [own, other] = [varying, swept].map(NormalGap::new);
    let mut alike = 0;
    for _ in 0..100 {
        let [sigma, eta] = [random.between(-12.0, 12.0), random.between(-20.0, 20.0)];
        let (found, expected) = (own.point(sigma, eta), other.point(sigma, eta));
        let (Some(found), Some(expected)) = (found, expected) else { continue };
        // At its end one of them may have a surface by rounding.
        if found.gap.is_nan() || expected.gap.is_nan() {
            continue;
        }
        // Both searches know C and its normal to 1e-10. A line along a surface is off along itself.
        let [rail, wheel] = [expected.rail_normal, expected.wheel_normal.unwrap()];
        let steep = 1.0 / rail.dot(&wheel).abs();
        let off = (found.gap - expected.gap).abs();
        assert!(off < 1e-9 * steep, "{sigma} {eta}: {found:?} {expected:?}");
        alike += 1;
    }
    let patches = [varying, swept].map(|placement| Patch::over_rail(placement, 0.05, &Window::UNBOUNDED));
    let [area, expected] = patches.each_ref().map(Patch::area);
    assert!((area / expected - 1.0).abs() < 1e-7, "{area} {expected}");
    assert_eq!(patches[0].components.len(), patches[1].components.len());
    alike
}

#[test]
fn a_wheel_whose_radius_does_not_vary_has_the_normal_gap_of_the_round_one() -> Result<()> {
    let (mut random, mut alike) = (Random::new(353), 0);
    for _ in 0..scenes().div_ceil(20) {
        let [varying, round] = round_wheels(&mut random)?;
        alike += are_alike([&varying, &round], &mut random);
    }
    assert!(alike as u64 > 50 * scenes().div_ceil(20), "{alike}");
    Ok(())
}

#[test]
fn equal_slices_have_the_normal_gap_of_the_extruded_rail() -> Result<()> {
    let pair = Pair::new(crown(0.0), cylinder(), RADIUS)?;
    let loft = Loft::new(&slices(&[-300.0, -40.0, 5.0, 45.0, 300.0], |_| crown(0.0)), Joining::Monotone)?;
    let (body, profiles) = (LoftedBody::Rail(Arc::new(loft)), ProfilePair::new(&pair)?);
    let (mut search, mut random, mut alike) = (profiles.search(), Random::new(354), 0);
    for _ in 0..scenes().div_ceil(20) {
        let [lateral, roll, yaw] = [3.0, 0.005, 0.005].map(|most| random.between(-most, most));
        let touch =
            search.touch(&Pose::new(lateral, roll, yaw)?, &Selection { within: 0.0, apart: ONE_CONTACT })?;
        let contact = touch.contacts[0];
        let varying = contact.placed_on(&pair, &body, random.between(-9.0, 9.0))?;
        alike += are_alike([&varying, &contact.placed(&pair)?], &mut random);
    }
    assert!(alike as u64 > 90 * scenes().div_ceil(20), "{alike}");
    Ok(())
}

#[test]
fn lines_along_normals_end_on_both_surfaces() -> Result<()> {
    let mut random = Random::new(355);
    // A nose that rises, a crossing where wing and nose lie beside each other, and a wheel on the edge of its flat.
    let nose = on_crown(|y| 0.1 * y, &[-150.0, -110.0, -70.0, -35.0, 10.0, 45.0, 80.0, 120.0], 0.02, 12.0)?;
    assert!(on_both_surfaces(&nose, [25.0, 30.0], &mut random) > 150);
    for along in [0.0, 122.5, 160.0] {
        let run = crossing(along, "[patch]\napproach = 0.05")?;
        let held = on_both_surfaces(&run.parts[0].site.contact.placement, [12.0, 15.0], &mut random);
        assert!(held > 100, "{along}: {held}");
    }
    for pitch in [0.0, 0.04, 1.0] {
        let run = flat(pitch, "[patch]\napproach = 0.05")?;
        let held = on_both_surfaces(&run.parts[0].site.contact.placement, [15.0, 30.0], &mut random);
        assert!(held > 100, "{pitch}: {held}");
    }
    Ok(())
}

/// Holds the conformal patch of a pair against a flood fill. Returns whether there is one.
fn is_flooded(placement: &Placement, approach: f64) -> std::result::Result<bool, String> {
    let patch = Patch::over_rail(placement, approach, &Window::UNBOUNDED);
    let gap = NormalGap::new(placement);
    let mut known = None;
    let level = |sigma: f64, eta: f64| {
        if known.as_ref().is_none_or(|(at, _)| *at != sigma) {
            known = Some((sigma, gap.column(sigma)));
        }
        let Some((_, Some(column))) = &mut known else { return f64::NAN };
        gap.gap_in(column, eta) + approach * (1.0 - column.rail.cos)
    };
    Ok(flooded(level, &patch)? > 0)
}

#[test]
fn conformal_patches_of_bodies_that_vary_are_what_a_flood_fill_finds() -> Result<()> {
    let (mut random, mut found) = (Random::new(356), 0);
    let at: Vec<f64> = (-40..=40).map(|k| 7.5 * f64::from(k)).collect();
    let count = scenes().div_ceil(20);
    for scene in 0..count {
        let length = random.between(30.0, 150.0);
        let depth = random.between(0.0, 1.0) * length * length / (40.0 * RADIUS);
        let wave = |y: f64| depth * (std::f64::consts::TAU / length * y).sin();
        let yaw = if scene % 3 == 0 { 0.0 } else { random.between(-0.02, 0.02) };
        let rail = on_crown(wave, &at, yaw, random.between(-20.0, 20.0))?;
        let flat =
            Flat { length: random.between(10.0, 90.0), angle: 0.0, edge_radius: random.between(1.0, 60.0) };
        let wheel = LoftedWheel::with_flat(&cone()?, RADIUS, &flat)?;
        let pitch = if scene % 5 == 0 { 0.0 } else { random.between(-0.12, 0.12) };
        let wheel = placed(&wheel, &super::around_the_wheel::crown()?, random_position(&mut random), pitch)?;
        for placement in [&rail, &wheel] {
            let approach = 10.0f64.powf(random.between(-3.0, -0.3));
            let flooded = is_flooded(placement, approach);
            let fault = |fault| {
                panic!("scene {scene}, {length} {depth}, yaw {yaw}, {flat:?}, pitch {pitch}: {fault}")
            };
            found += u64::from(flooded.unwrap_or_else(fault));
        }
    }
    assert!(found > count, "{found}");
    Ok(())
}

#[test]
fn runs_over_the_rail_s_surface_take_bodies_that_vary() -> Result<()> {
    let asked = "[patch]\napproach = 0.05\n[grid]\nreference = \"rail\"";
    for run in [crossing(160.0, asked)?, flat(0.04, asked)?] {
        for part in &run.parts {
            let conformal = part.analysis.conformal.as_ref().unwrap();
            let patch = conformal.patch.as_ref().unwrap();
            // Where the rail's normal turns by some degrees, both patches are much alike.
            let plane = part.analysis.patch.as_ref().unwrap().area();
            assert!((patch.area() / plane - 1.0).abs() < 0.02, "{} {plane}", patch.area());
            assert!(conformal.gap.iter().all(|t| t.is_finite()), "{:?}", part.warnings);
            let report = check_site(&part.site)?;
            assert!(report.agrees() && report.rail.is_some_and(|rail| rail.aligned > 20), "{report}");
            let held = report.lofted.as_ref().is_none_or(|found| found.ends.as_ref().unwrap().compared > 50);
            assert!(held, "{report}");
        }
    }
    Ok(())
}

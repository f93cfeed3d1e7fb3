use nalgebra::UnitComplex;
use std::f64::consts::PI;

use super::branches::{SideBranches, TouchBranch};
use super::movement::Knot;
use super::*;
use crate::placement::{Pair, RailDistance, Track, WheelDistance, Wheelset};
use crate::profile::{Arc, Profile, Segment, standards};
use crate::search::position::Position;
use crate::search::wheelset::WheelsetSearch;
use crate::search::{Selection, SideOnTrack};

fn system(rail: &Profile, wheel: &Profile) -> Result<WheelsetOnTrack> {
    let pair = Pair::new(rail.clone(), wheel.clone(), 460.0)?;
    WheelsetOnTrack::new(&pair, RailDistance::Spacing(1500.0), WheelDistance::Spacing(1500.0))
}

/// Returns UIC60 at 1:20, as in EN 15302's reference profiles.
fn reference_rail() -> Result<Profile> {
    Ok(standards::rail("UIC60")?.rotated(UnitComplex::new(0.05)).shifted(2.60264, 0.14155))
}

/// Returns tan γ_e for the time of a quarter.
fn conicity_of(time: f64) -> f64 {
    PI.powi(2) / (8.0 * time * time)
}

/// Integrates T(ŷ) = ∫ dy/√(E(ŷ) − E(y)) by the rectangle rule in u, y = ŷ(1 − u²), which the turning point
/// does not disturb.
fn quadrature(energy: impl Fn(f64) -> f64, amplitude: f64, steps: u32) -> f64 {
    let total = energy(amplitude);
    let sum: f64 = (0..steps)
        .map(|k| (f64::from(k) + 0.5) / f64::from(steps))
        .map(|u| u / (total - energy(amplitude * (1.0 - u * u))).sqrt())
        .sum();
    2.0 * amplitude * sum / f64::from(steps)
}

#[test]
fn a_cone_has_its_own_conicity() -> Result<()> {
    let system = system(&standards::rail("60E1")?, &standards::wheel("cone-1:20")?)?;
    let conicity = Conicity::new(&system, 4.0, Roll::Neglect)?;
    for y in [0.03, 0.5, -1.0, 3.999] {
        let found = conicity.at(y).map(|found| found.conicity);
        assert!(found.is_ok_and(|found| (found - 0.05).abs() < 1e-9), "{y}: {found:?}");
    }
    assert_eq!(conicity.at(0.0), Err(NoConicity::NoAmplitude));
    assert_eq!(conicity.at(4.5), Err(NoConicity::OffTrack));
    // Straight throughout: nothing to refine.
    assert_eq!(conicity.searches(), 41);
    Ok(())
}

#[test]
fn wheel_a_of_en_15302_has_its_published_conicity() -> Result<()> {
    let system = system(&reference_rail()?, &standards::wheel("EN15302-A")?)?;
    let conicity = Conicity::new(&system, 8.0, Roll::Neglect)?;
    // The wheel's ten segments are closed by twelve short ones, each with curvatures of its own.
    assert!(conicity.searches() <= 300, "{}", conicity.searches());
    // Annex E, case A/A/A, as reproduced by a public benchmark program.
    let table =
        [(1.0, 0.125), (2.0, 0.155), (3.0, 0.188), (4.0, 0.216), (5.0, 0.254), (6.0, 0.303), (7.0, 0.505)];
    for (y, expected) in table {
        let found = conicity.at(y).map(|found| found.conicity);
        assert!(found.is_ok_and(|found| (found - expected).abs() < 6e-4), "{y}: {found:?} is not {expected}");
    }
    Ok(())
}

/// Compares the rates that the contacts' curvatures (of ϱ) and angles (of the height) give with the positions
/// beside them.
#[test]
fn slopes_are_those_of_the_next_positions() -> Result<()> {
    let system = system(&reference_rail()?, &standards::wheel("EN15302-A")?)?;
    const STEP: f64 = 1e-4;
    for roll in [Roll::Neglect, Roll::Solve] {
        let mut searched = Searched::new(&system, roll);
        let mut at = |y: f64| -> Result<[TouchBranch; 2]> {
            let mut sides = SideBranches::default();
            assert!(searched.at(y, &mut sides)?);
            Ok([sides[0][0], sides[1][0]])
        };
        let mut compared = 0;
        for k in 0..70 {
            let y = 0.013 + 0.1 * f64::from(k);
            let (here, [below, above]) = (at(y)?, [at(y - STEP)?, at(y + STEP)?]);
            let steep = 1.0 + here[0].growth.abs() + here[1].growth.abs();
            for side in 0..2 {
                let [low, high] = [below[side], above[side]];
                let climb = (high.height - low.height) / (2.0 * STEP);
                let growth = (high.radius - low.radius) / (2.0 * STEP);
                // A joint or a hop is between.
                let near = |a: f64, b: f64| (a - b).abs() <= 1e-3 * (1.0 + b.abs());
                if !near(low.growth, high.growth) || !near(low.climb, high.climb) {
                    continue;
                }
                compared += 1;
                assert!(
                    (here[side].climb - climb).abs() < 1e-7 * steep,
                    "{roll:?} {y} {side}: {here:?} {climb}"
                );
                assert!(
                    (here[side].growth - growth).abs() < 1e-5 * steep,
                    "{roll:?} {y} {side}: {here:?} {growth}"
                );
            }
        }
        assert!(compared > 100, "{compared}");
    }
    Ok(())
}

/// A saw tooth, Δr = a y, less a tooth's depth beyond each hop, as the right side's contact makes it.
struct SawTooth {
    rise: f64,
    period: f64,
    depth: f64,
}

impl SawTooth {
    fn tooth(&self, y: f64) -> f64 {
        (y / self.period).floor()
    }

    /// Returns 2 ∫_0^y Δr.
    fn energy(&self, y: f64) -> f64 {
        let (tooth, period) = (self.tooth(y), self.period);
        let lost = self.depth * (period * tooth * (tooth - 1.0) / 2.0 + tooth * (y - tooth * period));
        self.rise * y * y - 2.0 * lost
    }

    /// Returns the two teeth beside y as places of contact; the gap of the next one closes at the rate 0.02.
    fn places(&self, y: f64, sides: &mut SideBranches) {
        let height = 0.02 * (self.tooth(y) * y - self.period * self.tooth(y) * (self.tooth(y) + 1.0) / 2.0);
        let place = |tooth: f64, gap: f64, climb: f64| TouchBranch {
            gap,
            height,
            climb,
            radius: 460.0 + self.rise * y - self.depth * tooth,
            growth: self.rise,
        };
        let tooth = self.tooth(y);
        let [below, above] = [y - tooth * self.period, (tooth + 1.0) * self.period - y];
        let climb = 0.02 * tooth;
        let radius = 460.0;
        sides[0] = vec![TouchBranch { gap: 0.0, height: 0.0, climb: 0.0, radius, growth: 0.0 }];
        sides[1] = vec![place(tooth, 0.0, climb)];
        let near = [(tooth + 1.0, 0.02 * above, climb + 0.02), (tooth - 1.0, 0.02 * below, climb - 0.02)];
        sides[1].extend(
            near.map(|(tooth, gap, climb)| place(tooth, gap, climb)).iter().filter(|b| b.gap <= 1e-3),
        );
        sides[1].retain(|b| tooth > 0.0 || b.climb >= 0.0);
    }
}

/// Returns the conicities of a Δr that a search gives, up to 5 mm.
fn refined(search: impl FnMut(f64, &mut SideBranches) -> Result<bool>) -> Result<Conicity> {
    let mut table = RefinedTable::new(search, 5.0, ACCURACY)?;
    let right = Swing::refined(&mut table, &mut |_, _| {})?;
    let [searches, _] = table.searches();
    Ok(Conicity { centre: Some(0.0), right, left: None, searches })
}

#[test]
fn the_conicity_of_a_saw_tooth_is_that_of_its_energy() -> Result<()> {
    for (period, depth) in [(0.7, 0.02), (0.0317, 2e-3), (0.3, 0.1)] {
        let saw = SawTooth { rise: 0.4, period, depth };
        let search = |y: f64, sides: &mut SideBranches| {
            saw.places(y, sides);
            Ok(true)
        };
        let conicity = refined(search)?;
        for amplitude in [0.02, 0.35, 1.0, 2.11, 3.0, 4.9999, 5.0] {
            let expected = conicity_of(quadrature(|y| saw.energy(y), amplitude, 1_000_000));
            let found = conicity.at(amplitude);
            let Ok(equivalent) = found else { panic!("{amplitude}: {found:?}") };
            let off = (equivalent.conicity / expected - 1.0).abs();
            assert!(
                off <= ACCURACY && equivalent.converged(),
                "{period} {amplitude}: {off:e} {equivalent:?}"
            );
        }
        let hops = (5.0 / period).floor();
        println!("{hops} hops, {} searches", conicity.searches());
        // Three for a hop, and some more for those on the grid of the first searches.
        assert!((conicity.searches() as f64) <= 51.0 + 4.0 * hops, "{hops} hops: {}", conicity.searches());
    }
    Ok(())
}

#[test]
fn more_hops_than_searches_give_a_flagged_result() -> Result<()> {
    for (period, depth) in [(5e-4, 1e-4), (1.3e-3, 4e-4)] {
        let saw = SawTooth { rise: 0.4, period, depth };
        let search = |y: f64, sides: &mut SideBranches| {
            saw.places(y, sides);
            // Only the touching one is seen: hops have to be found by halving.
            sides[1].truncate(1);
            Ok(true)
        };
        let conicity = refined(search)?;
        assert_eq!(conicity.searches(), Conicity::most_searches(5.0));
        for amplitude in [0.35, 1.0, 2.11, 3.0, 4.9] {
            let expected = conicity_of(quadrature(|y| saw.energy(y), amplitude, 1_000_000));
            let found = conicity.at(amplitude);
            let Ok(equivalent) = found else { panic!("{amplitude}: {found:?}") };
            let off = (equivalent.conicity / expected - 1.0).abs();
            println!("{period} {amplitude}: off by {off:.1e}, estimated {:.1e}", equivalent.error);
            assert!(
                !equivalent.converged() && off <= equivalent.error,
                "{amplitude}: {off:e} {equivalent:?}"
            );
        }
    }
    Ok(())
}

/// Makes knots of straight pieces through (y, Δr).
fn movement(points: &[[f64; 2]]) -> Movement {
    Movement::new(points.iter().map(|&[y, force]| Knot { y, force, defect: 0.0 }).collect())
}

#[test]
fn a_force_in_steps_has_its_closed_form() {
    // 1 up to 2, then 3: E = 2y, 4 + 6(y − 2).
    let movement = movement(&[[0.0, 1.0], [2.0, 1.0], [2.0, 3.0], [7.0, 3.0]]);
    for amplitude in [0.3, 2.0, 2.5, 6.9] {
        let cell = movement.cell(amplitude).unwrap_or(usize::MAX);
        let found = movement.quarter(cell, amplitude).map_or(f64::NAN, |quarter| quarter.time);
        let exact = if amplitude <= 2.0 {
            (2.0 * amplitude).sqrt()
        } else {
            let speed = (6.0f64 * (amplitude - 2.0)).sqrt();
            speed / 3.0 + ((speed * speed + 4.0).sqrt() - speed)
        };
        assert!((found / exact - 1.0).abs() < 1e-13, "{amplitude}: {found} {exact}");
    }
}

#[test]
fn blocks_give_what_their_cells_do() {
    // A rough force that grows, in 5000 cells.
    let mut random = 1u64;
    let mut next = || {
        random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (random >> 11) as f64 / (1u64 << 53) as f64
    };
    let points: Vec<[f64; 2]> =
        (0..=5000).map(|k| f64::from(k) * 2e-3).map(|y| [y, 0.1 * y + 0.05 * (next() - 0.5)]).collect();
    let movement = movement(&points);
    for amplitude in [3.1234, 7.0, 9.999] {
        let energy = |y: f64| {
            let k = ((y / 2e-3) as usize).min(4999);
            let below: f64 = points[..=k].windows(2).map(|p| 2e-3 * (p[0][1] + p[1][1])).sum();
            let (share, [from, to]) = (y / 2e-3 - k as f64, [points[k][1], points[k + 1][1]]);
            below + 2.0 * (y - points[k][0]) * (from + share / 2.0 * (to - from))
        };
        let Some(cell) = movement.cell(amplitude) else { panic!("{amplitude}") };
        let found = movement.quarter(cell, amplitude).map_or(f64::NAN, |quarter| quarter.time);
        let exact = quadrature(energy, amplitude, 20_000);
        assert!((found / exact - 1.0).abs() < 1e-6, "{amplitude}: {found} {exact}");
    }
}

#[test]
fn movements_that_do_not_come_back_have_no_conicity() {
    // Restores up to 1, drives outwards up to 2, restores again.
    let movement = movement(&[[0.0, 0.0], [0.5, 1.0], [1.0, 0.0], [1.5, -1.0], [2.0, 0.0], [4.0, 4.0]]);
    let comes_back = |amplitude: f64| {
        movement.cell(amplitude).and_then(|cell| movement.quarter(cell, amplitude)).is_some()
    };
    // E(1) = 1, E(2) = 0, then 2 (y − 2)²: from beyond 2 the movement comes through 1 from 2 + √½ on.
    let expected = [
        (0.3, true),
        (0.99, true),
        (1.2, false),
        (2.0, false),
        (2.4, false),
        (2.70, false),
        (2.71, true),
        (4.0, true),
    ];
    for (amplitude, expected) in expected {
        assert_eq!(comes_back(amplitude), expected, "{amplitude}");
    }
    // The top of the hump lies inside a cell: the energies of its ends do not show it.
    let movement = self::movement(&[[0.0, 1.0], [1.0, 1.0], [3.0, -1.0], [3.0, 1.0], [3.4, 1.0], [4.0, 1.0]]);
    for (amplitude, expected) in [(3.2, false), (3.49, false), (3.51, true)] {
        let found = movement.cell(amplitude).and_then(|cell| movement.quarter(cell, amplitude));
        assert_eq!(found.is_some(), expected, "{amplitude}");
    }
}

/// Returns a polyline of `spacing` mm along a curve, with corners off the curve by up to `noise` mm.
fn rough(curve: fn(f64) -> f64, spacing: f64, noise: f64, seed: u64) -> Result<Profile> {
    let mut random = seed;
    let mut next = || {
        random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (random >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    };
    let count = (24.0 / spacing) as i32;
    let points: Vec<[f64; 2]> = (0..=count)
        .map(|k| -12.0 + spacing * f64::from(k))
        .map(|x| [x, curve(x) + 2.0 * noise * next()])
        .collect();
    let lines =
        points.windows(2).map(|p| Arc::line(p[0], p[1]).map(Segment::arc)).collect::<Result<Vec<_>>>()?;
    Profile::new("rough", "seeded", lines)
}

/// Searches Δr at equal steps one by one; returns the movements over all steps and over every other one.
fn brute_force(
    search: &mut WheelsetSearch,
    steps: usize,
    amplitude: f64,
    roll: Roll,
) -> Result<[Movement; 2]> {
    let nothing_else = Selection { within: 0.0, apart: 0.0 };
    let mut knots = Vec::with_capacity(steps + 1);
    for k in 0..=steps {
        let lateral = amplitude * k as f64 / steps as f64;
        let position = Position { lateral, yaw: 0.0, roll };
        let Ok(touch) = search.touch(&position, &nothing_else) else { break };
        let [left, right] = touch.sides.map(|side| side.touch.contacts[0].rolling_radius);
        knots.push(Knot { y: lateral, force: right - left, defect: 0.0 });
    }
    let coarse = knots.iter().step_by(2).copied().collect();
    Ok([Movement::new(knots), Movement::new(coarse)])
}

#[test]
fn rough_pairs_agree_with_a_very_fine_table_or_say_by_how_much_not() -> Result<()> {
    const AMPLITUDE: f64 = 2.0;
    const FINE: usize = 30_000;
    let crown = |x: f64| -x * x / 600.0 - x * x * x * x / 2e7;
    let tread = |x: f64| x / 20.0 + x * x / 1200.0;
    let (mut converged, mut compared) = (0, 0);
    let pairs = [(1.0, 1e-3, 0.0), (0.5, 3e-3, 0.0), (0.2, 1e-3, 1e-3), (0.1, 5e-4, 3e-4)];
    for (k, (spacing, noise, on_wheel)) in pairs.into_iter().enumerate() {
        let rail = rough(crown, spacing, noise, 17 + k as u64)?;
        let wheel = rough(tread, 1.1 * spacing, on_wheel, 27 + k as u64)?;
        let system = system(&rail, &wheel)?;
        let roll = if k == 1 { Roll::Solve } else { Roll::Neglect };
        let conicity = Conicity::new(&system, AMPLITUDE, roll)?;
        assert!(conicity.searches() <= Conicity::most_searches(AMPLITUDE));
        let tables = brute_force(&mut system.search(), FINE, AMPLITUDE, roll)?;
        let mut worst = [0f64; 2];
        for n in 1..=100 {
            let amplitude = AMPLITUDE * f64::from(n) / 100.0 - 0.0017;
            let exact = tables.each_ref().map(|table| {
                let quarter = table.cell(amplitude).and_then(|cell| table.quarter(cell, amplitude));
                quarter.map(|quarter| conicity_of(quarter.time))
            });
            let found = conicity.at(amplitude);
            let ([Some(fine), Some(coarse)], Ok(found)) = (exact, found) else {
                // The movement comes back for neither.
                assert!(
                    exact[0].is_none() == found.is_err(),
                    "{spacing} {noise} {amplitude}: {found:?} {exact:?}"
                );
                continue;
            };
            let off = (found.conicity / fine - 1.0).abs();
            worst = [worst[0].max(off), worst[1].max(found.error)];
            compared += 1;
            converged += usize::from(found.converged());
            // The tables place a hop to within their steps: their own error is about the difference of both.
            let bound = found.error.max(ACCURACY) + 2.0 * (coarse / fine - 1.0).abs();
            assert!(off <= bound, "{spacing} {noise} {amplitude}: {off:e} {bound:e} {found:?}");
        }
        println!(
            "every {spacing} mm, {noise} mm: {} of {} searches, off by {:.1e}, estimated {:.1e}",
            conicity.searches(),
            Conicity::most_searches(AMPLITUDE),
            worst[0],
            worst[1]
        );
    }
    println!("{converged} of {compared}");
    assert!(compared > 200);
    Ok(())
}

/// A wheelset of two equal sides that are given apart: Δr is odd, and both tables find it.
#[test]
fn two_sides_that_are_alike_have_the_conicity_of_a_symmetric_wheelset() -> Result<()> {
    let symmetric = system(&reference_rail()?, &standards::wheel("EN15302-A")?)?;
    let apart = WheelsetOnTrack::of_sides(symmetric.left().clone(), symmetric.right().clone());
    let [one, two] = [&symmetric, &apart].map(|system| Conicity::new(system, 8.0, Roll::Neglect));
    let (one, two) = (one?, two?);
    assert!(two.centre().is_some_and(|y| y.abs() < 1e-9), "{:?}", two.centre());
    for amplitude in [0.3, 1.0, 3.0, 5.5, 7.0] {
        let [a, b] = [&one, &two].map(|table| table.at(amplitude).map(|found| found.conicity));
        let (Ok(a), Ok(b)) = (a, b) else { panic!("{a:?} {b:?}") };
        assert!((a / b - 1.0).abs() < 2e-4, "{amplitude}: {a} {b}");
    }
    Ok(())
}

/// Cones of two angles: Δr = (γ_l + γ_r)(y − y₀), whatever the amplitude.
#[test]
fn two_different_cones_swing_about_the_place_of_equal_radii() -> Result<()> {
    let crown = Arc::about([0.0, -300.0], 300.0, crate::profile::Half::Upper, [-40.0, 40.0])?;
    let (rail, distance) = (Profile::new("crown", "", vec![Segment::arc(crown)])?, 1500.0);
    let side = |wheel: &str, radius: f64| -> Result<SideOnTrack> {
        let pair = Pair::new(rail.clone(), standards::wheel(wheel)?, radius)?;
        let track = Track::new(&rail, RailDistance::Spacing(distance))?;
        SideOnTrack::new(&pair, track, Wheelset::new(WheelDistance::Spacing(distance), radius)?)
    };
    // A left wheel 0.6 mm larger in radius: Δr grows by 1/20 + 1/40.
    let system = WheelsetOnTrack::of_sides(side("cone-1:40", 460.6)?, side("cone-1:20", 460.0)?);
    let conicity = Conicity::new(&system, 3.0, Roll::Neglect)?;
    let centre = conicity.centre();
    // The cones touch the crown where it is inclined like them: 15 mm and 7.5 mm from the middle.
    let leans = [0.05f64.atan(), 0.025f64.atan()];
    let [right, left] = leans.map(|lean| 300.0 * lean.sin() * lean.tan());
    let expected = (0.6 - (right - left)) / 0.075;
    assert!(centre.is_some_and(|y| (y - expected).abs() < 1e-6), "{centre:?} {expected}");
    for amplitude in [0.2, 1.0, 2.9] {
        let found = conicity.at(amplitude).map(|found| found.conicity);
        assert!(found.is_ok_and(|found| (found - 0.0375).abs() < 1e-6), "{amplitude}: {found:?}");
    }
    Ok(())
}

/// Forces that are the same all over each side: with the larger one the movement turns nearer to the centre.
#[test]
fn a_movement_turns_at_one_energy_on_both_sides_or_beyond_the_table() {
    let [wall, tread] = [movement(&[[0.0, 8.0], [3.0, 8.0]]), movement(&[[0.0, 0.5], [20.0, 0.5]])];
    for amplitude in [0.3, 4.0, 10.6] {
        let near = 2.0 * amplitude * 0.5 / 8.5;
        let both = [turning([&wall, &tread], amplitude), turning([&tread, &wall], amplitude)];
        let found = both.map(|turns| turns.unwrap_or([f64::NAN; 2]));
        let close = |found: [f64; 2], expected: [f64; 2]| {
            found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-12)
        };
        let far = 2.0 * amplitude - near;
        assert!(close(found[0], [near, far]) && close(found[1], [far, near]), "{amplitude}: {found:?}");
    }
    // The tread ends at 20 mm, with the wall at 1.25 mm; a wall of 0.1 mm has the energy of 1.6 mm of tread.
    assert_eq!(turning([&wall, &tread], 10.7), None);
    let low = movement(&[[0.0, 8.0], [0.1, 8.0]]);
    assert!(turning([&low, &tread], 0.84).is_some());
    assert_eq!((turning([&low, &tread], 0.86), turning([&tread, &low], 0.86)), (None, None));
}

/// E has a top at 1 on the right, which the movement passes with 1 on the left: it then goes to 2.25 at once.
#[test]
fn no_movement_is_as_wide_as_up_to_behind_a_hump() {
    let left = movement(&[[0.0, 1.0], [9.0, 1.0]]);
    let right = movement(&[[0.0, 1.0], [1.0, 1.0], [1.0, -1.0], [2.0, -1.0], [2.0, 4.0], [9.0, 4.0]]);
    for (amplitude, expected) in
        [(0.99, true), (1.01, false), (1.3, false), (1.62, false), (1.63, true), (3.0, true)]
    {
        let turns = turning([&left, &right], amplitude).unwrap_or([f64::NAN; 2]);
        let comes_back = [(&left, turns[0]), (&right, turns[1])]
            .into_iter()
            .all(|(side, turn)| side.cell(turn).and_then(|cell| side.quarter(cell, turn)).is_some());
        assert_eq!(comes_back, expected, "{amplitude}: {turns:?}");
    }
}

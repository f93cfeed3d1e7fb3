//! What contacts carry adds up to what wheels and axles are loaded with.

use crate::campaign::scenes;
use crate::common::repository;
use std::path::Path;

use wheelrail::case::{Run, SILENT, Site, sites};
use wheelrail::internal::Random;
use wheelrail::load::{Cells, Elastic, HalfSpace, Pressures, effective_modulus, on_wider_cells, press_alone};
use wheelrail::nalgebra::Point2;
use wheelrail::profile::standards;
use wheelrail::search::TrackSide;
use wheelrail::{Evaluator, Result, scene};

/// What the sums may miss of a load, relative: rounding.
const SUM: f64 = 1e-10;

fn wheelset(lateral: f64, rest: &str) -> String {
    format!(
        "[rail]\nprofile = \"UIC60\"\nrotate = \"1:20\"\n[wheel]\nprofile = \"S1002\"\nradius = 460.0\n[track]\ngauge = 1435.0\n\
         [wheelset]\nback_to_back = 1360.0\nflange_back_x = -70.0\nlateral = {lateral:?}\n{rest}"
    )
}

fn found(text: &str) -> Result<Vec<Site>> {
    sites(&scene::resolve(&scene::parse(text, false)?, Path::new("."), "loads")?)
}

/// The vertical force of a site \[N\].
fn vertical(site: &Site) -> f64 {
    let placement = &site.contact.placement;
    // On a roller the normal also leans along the track.
    site.normal_load.unwrap() * placement.rail().point().station.cos * placement.turn().cos()
}

fn sum(sites: &[Site], side: Option<TrackSide>) -> f64 {
    let of_side = sites.iter().filter(|site| site.side() == side && site.normal_load.is_some());
    of_side.map(vertical).sum()
}

#[test]
fn the_contacts_of_every_wheel_carry_its_load() -> Result<()> {
    let (mut shared, mut alone) = (0, 0);
    for lateral in [0.0, 3.0, 5.5, 6.0, 6.2, -5.5] {
        let sites = found(&wheelset(lateral, "[patch]\nload = 60000.0\n"))?;
        for side in [TrackSide::Left, TrackSide::Right] {
            let total = sum(&sites, Some(side));
            assert!((total / 60e3 - 1.0).abs() < SUM, "{lateral} {side}: {total}");
            let count = sites.iter().filter(|site| site.side() == Some(side)).count();
            if count > 1 { shared += 1 } else { alone += 1 }
        }
    }
    assert!(shared >= 3 && alone >= 6, "{shared} {alone}");
    Ok(())
}

#[test]
fn both_wheels_of_an_axle_sink_alike_and_carry_its_load_together() -> Result<()> {
    for lateral in [0.0, 2.0, 5.0] {
        let sites = found(&wheelset(lateral, "roll = \"solve\"\nload = 120000.0\n"))?;
        let total = sum(&sites, Some(TrackSide::Left)) + sum(&sites, Some(TrackSide::Right));
        assert!((total / 120e3 - 1.0).abs() < SUM, "{lateral}: {total}");
        let sunk = [TrackSide::Left, TrackSide::Right].map(|side| {
            let first = sites.iter().find(|site| site.side() == Some(side)).unwrap();
            first.approach() / first.contact.placement.rail().point().station.cos
        });
        assert!((sunk[0] / sunk[1] - 1.0).abs() < 1e-12, "{lateral}: {sunk:?}");
    }
    Ok(())
}

/// With `roll = "load"` each wheel carries its load, and the middle of the axle is as high over one rail as over the other.
#[test]
fn the_roll_follows_the_loads() -> Result<()> {
    for (lateral, rest) in
        [(2.0, "[patch]\nload = 60000.0\n"), (5.5, "load = 120000.0\n"), (0.0, "load = 90000.0\n")]
    {
        let load = if lateral == 0.0 { 45e3 } else { 60e3 };
        let sites = found(&wheelset(lateral, &format!("roll = \"load\"\n{rest}")))?;
        let heights = [TrackSide::Left, TrackSide::Right].map(|side| {
            let total = sum(&sites, Some(side));
            assert!((total / load - 1.0).abs() < SUM, "{lateral} {side}: {total}");
            let first = sites.iter().find(|site| site.side() == Some(side)).unwrap();
            let sunk = first.approach() / first.contact.placement.rail().point().station.cos;
            first.contact.found.as_ref().unwrap().height_mm - sunk
        });
        assert!((heights[0] - heights[1]).abs() < 1e-8, "{lateral}: {heights:?}");
        let roll = sites[0].contact.found.as_ref().unwrap().roll_rad;
        assert!(if lateral == 0.0 { roll.abs() < 1e-12 } else { roll != 0.0 }, "{lateral}: {roll}");
    }
    let error = found(&wheelset(0.0, "roll = \"load\"\n")).err().map(|error| error.to_string());
    assert!(
        error.as_deref().is_some_and(|e| e.contains("wheelset: roll: found \"load\" without a load")),
        "{error:?}"
    );
    Ok(())
}

#[test]
fn a_load_on_chosen_points_is_vertical_and_shared_by_all_parts() -> Result<()> {
    let text = "[rail]\nprofile = \"60E1\"\nrotate = \"1:40\"\n[wheel]\nprofile = \"S1002\"\nradius = 460.0\n\
                [contact]\nrail_x = -20.0\nwheel_x = -20.0\n[patch]\nload = 50000.0\n";
    let sites = found(text)?;
    let total: f64 = sites.iter().map(vertical).sum();
    assert!((total / 50e3 - 1.0).abs() < SUM, "{total}");
    Ok(())
}

#[test]
fn places_with_one_patch_are_one_region_that_names_them() -> Result<()> {
    let text = "[rail]\nprofile = \"60E1\"\nrotate = \"1:40\"\n[wheel]\nprofile = \"S1002\"\nradius = 460.0\n\
                [contact]\noffset = -3.0\n[patch]\nload = 60000.0\n";
    let sites = found(text)?;
    let [site] = sites.as_slice() else { panic!("{} regions", sites.len()) };
    let merged = &site.contact.found.as_ref().unwrap().merged;
    assert_eq!(merged.len(), 1, "{merged:?}");
    assert!(site.contact.is_loaded());
    Ok(())
}

#[test]
fn loads_beyond_reason_name_side_and_key() {
    let complaint = |text: &str| found(text).err().map(|error| error.to_string()).unwrap_or_default();
    let wheel = complaint(&wheelset(0.0, "[patch]\nload = 1e12\n"));
    assert!(wheel.contains("patch: load: found 1000000000000 N on the right side; expected"), "{wheel}");
    let axle = complaint(&wheelset(0.0, "load = 1e12\n"));
    assert!(axle.contains("wheelset: load: found 1000000000000 N; expected"), "{axle}");
    let both = complaint(&wheelset(0.0, "load = 1e5\n[patch]\nload = 5e4\n"));
    assert!(both.contains("wheelset: load: found 100000 beside [patch]; expected"), "{both}");
    let negative = complaint(&wheelset(0.0, "load = -1.0\n"));
    assert!(negative.contains("wheelset: load: found -1; expected a positive load"), "{negative}");
}

#[test]
fn each_wheel_may_have_its_own_load() -> Result<()> {
    let own =
        |rest: &str| format!("{}[left]\nload = 40000.0\n[right]\nload = 70000.0\n", wheelset(3.0, rest));
    for rest in ["", "roll = \"load\"\n", "[patch]\nframe = \"weighted\"\n"] {
        let sites = found(&own(rest))?;
        for (side, load) in [(TrackSide::Left, 40e3), (TrackSide::Right, 70e3)] {
            let total = sum(&sites, Some(side));
            assert!((total / load - 1.0).abs() < SUM, "{rest} {side}: {total}");
        }
    }
    let complaint = |text: &str| found(text).err().map(|error| error.to_string()).unwrap_or_default();
    let one = complaint(&wheelset(0.0, "[left]\nload = 40000.0\n"));
    assert!(one.contains("right: found no load beside that of [left]; expected"), "{one}");
    let twice = complaint(&own("[patch]\nload = 1000.0\n"));
    assert!(twice.contains("left: load: found 40000 beside [patch]; expected"), "{twice}");
    let heavy = complaint(&own("").replace("70000.0", "1e12"));
    assert!(heavy.contains("right: load: found 1000000000000 N on the right side"), "{heavy}");
    Ok(())
}

/// The weighted frame is another frame over the same bodies: points s above the rail lie on the wheel, whichever the frame.
#[test]
fn the_weighted_frame_moves_no_body() -> Result<()> {
    let mut turned = 0;
    for (lateral, yaw) in
        [(0.0, false), (3.0, false), (5.5, false), (6.2, false), (3.0, true), (5.5, true), (6.2, true)]
    {
        let yaw = if yaw { "yaw = 0.01\n" } else { "" };
        let framed = |frame| {
            found(&wheelset(lateral, &format!("{yaw}[patch]\nload = 60000.0\nframe = \"{frame}\"\n")))
        };
        let (plain, weighted) = (framed("contact")?, framed("weighted")?);
        for site in weighted {
            let placement = &site.contact.placement;
            let number = site.contact.found.as_ref().map(|found| (found.side, found.contact));
            let same = plain
                .iter()
                .find(|plain| plain.contact.found.as_ref().map(|f| (f.side, f.contact)) == number);
            let old = &same.unwrap().contact.placement;
            let frames = [placement, old].map(|placement| placement.rail().contact_frame());
            turned += usize::from(frames[0].rotation.angle_to(&frames[1].rotation).abs() > 1e-3);
            let [mut here, mut there] = [placement, old].map(Evaluator::new);
            for &xi in site.grid.xi.iter().step_by(3) {
                for &eta in site.grid.eta.iter().step_by(5) {
                    let (s, rail) = (here.separation(xi, eta), here.rail_height(xi));
                    let point = frames[1].inverse_transform_point(&(frames[0] * Point2::new(xi, rail + s)));
                    let height =
                        there.rail_height(point.x) + there.separation(point.x, eta + placement.ahead());
                    assert!((point.y - height).abs() < 1e-10, "{lateral} {xi} {eta}: {point} {height}");
                }
            }
            // What the wheel sinks by, which is that of its first contact, hardly depends on the frame.
            if number.is_some_and(|(_, contact)| contact == 1) {
                let cos = [placement, old].map(|placement| placement.rail().point().station.cos);
                let sunk = [site.approach() / cos[0], same.unwrap().approach() / cos[1]];
                assert!((sunk[0] / sunk[1] - 1.0).abs() < 0.05, "{lateral}: {sunk:?} {cos:?}");
            }
        }
    }
    assert!(turned >= 3, "{turned}");
    Ok(())
}

/// Decks of every example add up to the load that it names.
#[test]
fn the_decks_of_every_example_carry_its_load() -> Result<()> {
    let folder = repository("examples/scenes");
    let mut loaded = 0;
    for entry in std::fs::read_dir(&folder).unwrap() {
        let path = entry.unwrap().path();
        let example = scene::load(&path)?;
        let of_wheel = example.patch.as_ref().and_then(|patch| patch.load);
        let of_axle = example.wheelset.as_ref().and_then(|wheelset| wheelset.load);
        let sites = sites(&scene::resolve(&example, &folder, "example")?)?;
        let totals = [Some(TrackSide::Left), Some(TrackSide::Right), None].map(|side| sum(&sites, side));
        if let Some(load) = of_wheel {
            let carried = totals.iter().filter(|total| **total > 0.0);
            assert!(
                carried.clone().count() > 0 && carried.clone().all(|total| (total / load - 1.0).abs() < SUM)
            );
        }
        if let Some(load) = of_axle {
            assert!((totals.iter().sum::<f64>() / load - 1.0).abs() < SUM, "{}: {totals:?}", path.display());
        }
        loaded += usize::from(of_wheel.or(of_axle).is_some());
    }
    assert!(loaded >= 2, "{loaded} examples have loads");
    Ok(())
}

/// A deck has the force of its own contact, and the summary both parts of it.
#[test]
fn a_run_has_the_load_of_every_part() -> Result<()> {
    let text = wheelset(5.0, "[patch]\nload = 60000.0\n[grid]\nspacing = 0.2\n");
    let case = scene::resolve(&scene::parse(&text, false)?, Path::new("."), "loads")?;
    let run = Run::new(case, SILENT)?;
    assert!(run.warnings().is_empty(), "{:?}", run.warnings());
    assert!(run.parts.iter().all(|part| part.site.normal_load.is_some_and(|load| load > 0.0)));
    Ok(())
}

/// What a run says of a grid that is too coarse for a solver.
const ROUGH: &str = "on the cells of this grid a solver finds";

#[test]
fn a_run_says_what_the_cells_of_its_grid_do_to_the_largest_pressure() -> Result<()> {
    for (grid, lost, warned) in [("", [0.09, 0.11], true), ("[grid]\nspacing = 0.1\n", [-1e-3, 1e-3], false)]
    {
        let text = format!(
            "[rail]\nprofile = \"49E1\"\nrotate = \"1:40\"\n[wheel]\nprofile = \"EN15302-A\"\nradius = 460.0\n[contact]\n\
             offset = 3.23\n[patch]\nload = 20000.0\n{grid}"
        );
        let run = Run::new(scene::resolve(&scene::parse(&text, false)?, Path::new("."), "loads")?, SILENT)?;
        let on_grid = run.parts[0].analysis.pressure.as_ref().and_then(|pressure| pressure.on_grid).unwrap();
        let found = -on_grid.difference();
        assert!(lost[0] < found && found < lost[1], "{grid}: {on_grid:?}");
        assert_eq!(run.warnings().iter().any(|text| text.contains(ROUGH)), warned, "{:?}", run.warnings());
    }
    Ok(())
}

#[test]
fn the_page_on_loads_names_wheels_and_rails_that_are_built_in() {
    let page = include_str!("../../src/docs/loads.md");
    let pairs =
        page.lines().filter_map(|line| line.strip_prefix("| ")?.split(" | ").next()?.split_once(" under "));
    let mut read = 0;
    for (rail, wheel) in pairs {
        let rail = rail.split(' ').next().unwrap_or_default();
        assert!(standards::rail(rail).is_ok(), "{rail}");
        assert!(standards::wheel(wheel).is_ok(), "{wheel}");
        read += 1;
    }
    assert!(read > 40, "{read}");
}

/// Number of places that the first region has swallowed, and vertical displacement \[mm\], of a wheel at an offset \[mm\].
fn sunk(rail: &str, wheel: &str, radius: f64, offset: f64, load: f64) -> Result<(usize, f64)> {
    let sites = found(&format!(
        "[rail]\nprofile = \"{rail}\"\nrotate = \"1:40\"\n[wheel]\nprofile = \"{wheel}\"\nradius = {radius:?}\n[contact]\n\
         offset = {offset:?}\n[patch]\nload = {load:?}\n"
    ))?;
    let merged = sites[0].contact.found.as_ref().map_or(0, |found| found.merged.len());
    Ok((merged, sites[0].approach() / sites[0].contact.placement.rail().point().station.cos))
}

/// Where curvature becomes nearly constant over the patch, and another formula would do, nothing jumps.
#[test]
fn displacements_are_continuous_over_nearly_constant_curvature() -> Result<()> {
    let of = |offset| sunk("60E2", "EN13715-1:40-h28-e32.5", 420.0, offset, 60e3);
    for from in [-0.099_92, 0.506_58] {
        let mut before = of(from)?.1;
        for step in 1..=30 {
            let (merged, here) = of(from + 1e-6 * f64::from(step))?;
            assert!(merged == 0 && (here - before).abs() < 1e-4, "{from} {step}: {before} {here}");
            before = here;
        }
    }
    Ok(())
}

/// Where two regions become one, the wheel does not move, since they pressed upon each other before.
#[test]
fn displacements_are_continuous_where_regions_join() -> Result<()> {
    let of = |offset| sunk("60E1", "S1002", 460.0, offset, 60e3);
    let [mut apart, mut joined] = [1.70, 1.80];
    assert_eq!([of(apart)?.0, of(joined)?.0], [0, 1]);
    while joined - apart > 1e-6 {
        let middle = apart + (joined - apart) / 2.0;
        *(if of(middle)?.0 == 0 { &mut apart } else { &mut joined }) = middle;
    }
    let jump = of(joined)?.1 - of(apart)?.1;
    assert!(jump.abs() < 2e-4, "{apart}: {jump}");
    Ok(())
}

/// The pressures that decide an approach are those of fine cells under the same approach.
#[test]
fn contacts_have_the_pressures_of_their_loads() -> Result<()> {
    let mut alone = 0;
    for lateral in [0.0, 3.0, 5.5] {
        let sites = found(&wheelset(lateral, "[patch]\nload = 60000.0\n"))?;
        for site in &sites {
            let [pressures] = site.contact.pressures.as_slice() else { panic!("one group of parts") };
            assert!((pressures.load() / site.normal_load.unwrap() - 1.0).abs() < 1e-3);
            if sites.iter().filter(|other| other.side() == site.side()).count() > 1 {
                continue;
            }
            alone += 1;
            let cells = Cells::over(&site.window(), [96, 64])?;
            let separations = cells.separations(&site.contact.placement);
            let region = HalfSpace::new(cells, &separations, site.approach())?;
            let [fine, wider] =
                press_alone(region, 1e-4, effective_modulus(&Elastic::STEEL, &Elastic::STEEL))?;
            let error =
                fine.largest_error(&wider) + pressures.largest_error(&on_wider_cells(pressures, 3e-4)?);
            let [found, expected] = [pressures, &fine].map(Pressures::largest);
            let miss = (found.pressure_n_per_mm2 - expected.pressure_n_per_mm2).abs();
            assert!(
                miss < error && error < 0.1 * expected.pressure_n_per_mm2,
                "{lateral}: {found:?} {expected:?}"
            );
            let miss = [pressures.load() / fine.load(), pressures.contact_area() / fine.contact_area()];
            assert!((miss[0] - 1.0).abs() < 3e-3 && (miss[1] - 1.0).abs() < 0.05, "{lateral}: {miss:?}");
        }
    }
    assert!(alone >= 3, "{alone}");
    Ok(())
}

/// Forces are continuous where the place that touches first changes within one region: random pairs, and the one that jumped by 9.6 %
/// in the frame of the contact.
#[test]
fn forces_of_a_region_of_several_places_do_not_jump() -> Result<()> {
    let mut random = Random::new(6516);
    let rails: Vec<&str> = standards::rail_names().collect();
    let wheels: Vec<&str> = standards::wheel_names().collect();
    let mut pairs = vec![("50E6", "EN15302-H", "1:20")];
    let (mut swaps, mut most) = (0, 0.0_f64);
    while swaps < 1 + scenes() / 5 {
        let (rail, wheel, inclination) = pairs.pop().unwrap_or_else(|| {
            (*random.pick(&rails), *random.pick(&wheels), *random.pick(&["1:20", "1:40"]))
        });
        let text = |lateral: f64, rest: &str| {
            format!(
                "[rail]\nprofile = \"{rail}\"\nrotate = \"{inclination}\"\n[wheel]\nprofile = \"{wheel}\"\nradius = 460.0\n\
                 [contact]\noffset = {lateral:?}\n{rest}"
            )
        };
        // The abscissa on the rail of the place that touches first.
        let first = |lateral: f64| {
            let case = scene::resolve(&scene::parse(&text(lateral, ""), false)?, Path::new("."), "swap")?;
            let found = wheelrail::case::contacts(&case)?;
            Ok::<f64, wheelrail::Error>(found[0].1.rail().point().station.x)
        };
        let mut steps: Vec<(f64, f64)> = Vec::new();
        for step in -40..=40 {
            let lateral = -(0.2 * f64::from(step) + 0.013);
            if let Ok(x) = first(lateral) {
                steps.push((lateral, x));
            }
        }
        for pair in steps.windows(2) {
            let [mut a, mut b] = [pair[0], pair[1]];
            if (a.1 - b.1).abs() < 2.0 {
                continue;
            }
            while (a.0 - b.0).abs() > 1e-6 {
                let middle = 0.5 * (a.0 + b.0);
                let x = first(middle)?;
                *(if (x - a.1).abs() < (x - b.1).abs() { &mut a } else { &mut b }) = (middle, x);
            }
            if (a.1 - b.1).abs() < 2.0 {
                continue;
            }
            let load = "[patch]\nload = 60000.0\n";
            let [before, after] = [found(&text(a.0, load))?, found(&text(b.0, load))?];
            let merged = |sites: &[Site]| {
                sites.len() == 1 && !sites[0].contact.found.as_ref().unwrap().merged.is_empty()
            };
            if !merged(&before) || !merged(&after) {
                continue;
            }
            swaps += 1;
            let jump = before[0].normal_load.unwrap() / after[0].normal_load.unwrap() - 1.0;
            most = most.max(jump.abs());
            assert!(jump.abs() < 2e-3, "{rail} {inclination} under {wheel} at {}: {jump}", a.0);
        }
    }
    println!("{swaps} changes of the first place within a region: forces jump by {most:.1e} at most");
    Ok(())
}

/// Offsets at which the tread of a wheel hands over to its flange, and no roll gives both sides of the axle one height.
const AT_A_JUMP: [(&str, &str, &str, f64); 2] =
    [("60E1", "S1002", "1:40", 6.260_393_172), ("60E1", "S1002", "1:40", 6.27)];
/// Difference of the heights over both rails of an axle that rests \[mm\].
const ONE_HEIGHT: f64 = 1e-8;
/// Distance \[rad\] from an axle's roll up to which a jump of the heights is sought.
const BESIDE: f64 = 2e-8;
/// Distance \[rad\] of the two rolls on both sides of a jump at which halving ends.
const AT_JUMP: f64 = 1e-13;
/// Largest distance \[rad\] of an axle's roll from a jump.
const NEAR_JUMP: f64 = 1e-8;

/// A wheelset at an offset with a roll and a load.
fn rolled((rail, wheel, inclination, lateral): (&str, &str, &str, f64), rest: &str) -> String {
    format!(
        "[rail]\nprofile = \"{rail}\"\nrotate = \"{inclination}\"\n[wheel]\nprofile = \"{wheel}\"\nradius = 460.0\n\
         [track]\ngauge = 1435.0\n[wheelset]\nback_to_back = 1360.0\nflange_back_x = -70.0\nlateral = {lateral:?}\n{rest}"
    )
}

/// By how much the middle of the axle is higher over the left rail than over the right \[mm\].
fn higher_on_the_left(sites: &[Site]) -> f64 {
    let [left, right] = [TrackSide::Left, TrackSide::Right].map(|side| {
        let first = sites.iter().find(|site| site.side() == Some(side)).unwrap();
        first.contact.found.as_ref().unwrap().height_mm - first.approach() / first.contact.placement.upright()
    });
    left - right
}

/// An axle's load alone: each wheel carries half of it wherever the wheelset stands, and the axle is as high over one rail as over the other.
/// The load acts in the middle, and its moment about the axle's middle is that of equal forces on both rails. Where the heights differ they
/// jump over each other: so they do at fixed rolls beside that of the axle, where each wheel carries half by itself.
#[test]
fn an_axle_s_load_is_halved_wherever_it_stands() -> Result<()> {
    let mut random = Random::new(6517);
    let names = [
        ("60E1", "S1002", "1:40"),
        ("60E2", "EN13715-1:40-h28-e32.5", "1:40"),
        ("54E3", "EN15302-C", "1:20"),
    ];
    let (count, mut jumps) = (scenes().div_ceil(4), 0);
    let drawn = (0..count).map(|_| {
        let (rail, wheel, inclination) = *random.pick(&names);
        (rail, wheel, inclination, random.between(-6.5, 6.5))
    });
    for (number, place) in drawn.chain(AT_A_JUMP).enumerate() {
        let text = rolled(place, "load = 100000.0\n");
        let sites = found(&text).map_err(|error| error.within(format!("{number}: {text}")))?;
        for side in [TrackSide::Left, TrackSide::Right] {
            let total = sum(&sites, Some(side));
            assert!((total / 50e3 - 1.0).abs() < SUM, "{number}: {text}{side}: {total}");
        }
        let own = higher_on_the_left(&sites);
        if own.abs() < ONE_HEIGHT {
            continue;
        }
        jumps += 1;
        let roll = sites[0].contact.found.as_ref().unwrap().roll_rad;
        let beside = |by: f64| {
            let fixed = format!("roll = {:?}\n[patch]\nload = 50000.0\n", roll + by);
            found(&rolled(place, &fixed)).map(|sites| higher_on_the_left(&sites))
        };
        let (mut low, mut high) = (-BESIDE, BESIDE);
        let (mut below, mut above) = (beside(low)?, beside(high)?);
        assert!(below > 0.0 && above < 0.0, "{number}: {text}: {own}, {below} and {above} beside it");
        while high - low > AT_JUMP {
            let middle = low + (high - low) / 2.0;
            let here = beside(middle)?;
            *(if here > 0.0 { &mut below } else { &mut above }) = here;
            *(if here > 0.0 { &mut low } else { &mut high }) = middle;
        }
        assert!(below - above > ONE_HEIGHT, "{number}: {text}: {own}, {below} and {above} at {low}");
        assert!(low.abs().min(high.abs()) <= NEAR_JUMP, "{number}: {text}: at {low} from the roll");
        let here = beside(0.0)?;
        assert!(
            (here - own).abs() < ONE_HEIGHT,
            "{number}: {text}: {own}, and {here} under the loads of the wheels"
        );
        let run = Run::new(scene::resolve(&scene::parse(&text, false)?, Path::new("."), "jump")?, SILENT)?;
        let said = format!("the middle of the axle is {:.4} mm higher", own.abs());
        let is_said = run.warnings().iter().any(|warning| warning.contains(&said));
        assert!(is_said == (own.abs() > 1e-4), "{number}: {text}: {own}: {:?}", run.warnings());
    }
    println!("{} axles, {jumps} at a jump", count + 2);
    assert!(jumps >= 2 && (jumps - 2) * 20 <= count, "{jumps}");
    Ok(())
}

/// Another roll that is asked for stays, and a run says how the wheels then share the load.
#[test]
fn a_roll_that_is_asked_for_stays_and_unequal_shares_are_told() -> Result<()> {
    let run = |roll: &str| {
        let text = wheelset(6.0, &format!("{roll}load = 100000.0\n"));
        Run::new(scene::resolve(&scene::parse(&text, false)?, Path::new("."), "shares")?, SILENT)
    };
    let told = |run: &Run| run.warnings().iter().any(|warning| warning.contains("the left wheel carries"));
    let (usual, first_touch) = (run("")?, run("roll = \"solve\"\n")?);
    assert!(!told(&usual) && told(&first_touch), "{:?} {:?}", usual.warnings(), first_touch.warnings());
    Ok(())
}

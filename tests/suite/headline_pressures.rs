//! The largest pressure of a run beside that of finer cells: it holds its error, or an edge in the contact leaves it unbounded.

use std::path::PathBuf;

use wheelrail::case::{FACTS, Part, Profiles, Run, SILENT};
use wheelrail::error::{ErrorKind, Result};
use wheelrail::internal::Random;
use wheelrail::load::{Cells, HalfSpace, Pressures, press_alone};
use wheelrail::measured::{CurveKind, Options, profile};
use wheelrail::profile::trace;
use wheelrail::{Interval, Pair, Profile, Scene, Side, Window, inclination, scene, standards};

use crate::campaign;
use crate::common::repository;

const RAILS: [&str; 7] = ["60E1", "54E5", "49E1", "46E2", "UIC60", "60E2", "50E3"];
const WHEELS: [&str; 7] = [
    "S1002",
    "EN13715-S1002-h28-e28.5",
    "EN13715-1:40-h28-e32.5",
    "EN13715-S1002-h30-e29",
    "EN15302-A",
    "cone-1:20",
    "S1002-arcs-1um",
];

/// E* of steel \[N/mm²\].
const STEEL: f64 = 2.1e5 / (2.0 * (1.0 - 0.28 * 0.28));

fn parsed(text: &str) -> Result<Scene> {
    scene::parse(&format!("{text}[output]\nformats = []\n"), false)
}

fn defect(name: &str) -> Result<Run> {
    let folder = repository("tests/defects");
    Run::new(scene::resolve(&scene::load(&folder.join(name))?, &folder, name)?, SILENT)
}

/// A chain of arcs and lines around x = 0 whose joints have kinks of up to 3°; `up` is +1 for a wheel, −1 for a rail.
fn kinked(dice: &mut Random, up: f64) -> Result<Profile> {
    let (mut points, mut slope) = (vec![[-40.0, 0.0]], -0.05 * up);
    while points[points.len() - 1][0] < 40.0 {
        let [x, z] = points[points.len() - 1];
        let step = dice.between(2.0, 9.0);
        points.push([x + step, z + slope * step]);
        slope += up * 10f64.powf(dice.between(-4.0, -1.2));
    }
    let line = |pair: &[[f64; 2]]| Ok(wheelrail::Segment::arc(wheelrail::Arc::line(pair[0], pair[1])?));
    Profile::new("kinked", "random", points.windows(2).map(line).collect::<Result<_>>()?)
}

/// A profile as an instrument measures it: points of a drawn one with noise.
fn measured(drawn: &Profile, side: Side, dice: &mut Random) -> Result<Profile> {
    let (step, noise) = (dice.between(0.2, 0.8), dice.between(0.0, 0.003));
    let points: String = trace(drawn, step)
        .windows(2)
        .filter(|pair| pair[1].s - pair[0].s > 0.5 * step)
        .map(|pair| format!("{},{}\n", pair[0].station.x, pair[0].station.z + noise * dice.normal()))
        .collect();
    let curve = if dice.below(2) == 0 { CurveKind::Smoothing } else { CurveKind::Interpolation };
    let options =
        Options { mirror: Some(false), flip_z: Some(false), curve: Some(curve), ..Options::default() };
    Ok(profile("points.csv", points.as_bytes(), side, &options)?.profile)
}

/// A rail's nose: two flanks with a rounding between them.
fn nose(dice: &mut Random) -> String {
    let (radius, half) = (10f64.powf(dice.between(0.9, 2.0)), dice.between(1.5, 6.0));
    let slope = |at: f64| at / (radius * radius - at * at).sqrt();
    let half = half.min(0.6 * radius);
    format!(
        "rail = {{ start = [-18.0, 0.0], segments = [{{ line = {{ slope = {:?}, to_x = {:?} }} }}, \
         {{ arc = {{ radius = {radius:?}, half = \"upper\", to_x = {half:?} }} }}, {{ line = {{ slope = {:?}, to_x = 18.0 }} }}] }}\n",
        slope(half),
        -half,
        -slope(half)
    )
}

/// Bodies of a kind that text describes: with a flat, with a nose, or of a wheelset that touches with tread and flange.
fn described(kind: u64, dice: &mut Random) -> String {
    let [rail, wheel] = [dice.pick(&RAILS), dice.pick(&WHEELS)];
    let cone = *dice.pick(&["cone-1:20", "cone-1:40"]);
    let turned = format!("rail = {{ profile = {rail:?}, rotate = \"1:40\" }}\n");
    match kind {
        2 => {
            let (length, edge) = (dice.between(10.0, 70.0), 10f64.powf(dice.between(-1.0, 1.8)));
            let flat = format!("flat = {{ length = {length:?}, angle = 0.0, edge_radius = {edge:?} }}");
            let offset = dice.between(-8.0, 10.0);
            format!(
                "{turned}wheel = {{ profile = \"S1002\", radius = 460.0, {flat} }}\ncontact = {{ offset = {offset:?} }}\n"
            )
        }
        5 => {
            let offset = dice.between(-2.0, 2.0);
            let nose = nose(dice);
            format!(
                "{nose}wheel = {{ profile = {cone:?}, radius = 460.0 }}\ncontact = {{ offset = {offset:?} }}\n"
            )
        }
        _ => {
            let lateral = dice.between(4.0, 7.5);
            format!(
                "{turned}wheel = {{ profile = {wheel:?}, radius = 460.0 }}\ntrack = {{ gauge = 1435.0 }}\n\
                 wheelset = {{ back_to_back = 1360.0, flange_back_x = -70.0, lateral = {lateral:?}, roll = \"neglect\" }}\n"
            )
        }
    }
}

/// A random pair under a random load, of eight kinds: built-in, flanging with yaw, with a flat, drawn with kinks, measured, a nose, of a
/// wheelset near its flange, and a thin flange whose wheel has a kink beside C. `more` are keys of its patch.
fn random(seed: u64, more: &str) -> Result<Run> {
    let mut dice = Random::stream(65, seed);
    let (load, radius) = (dice.between(10e3, 150e3), dice.between(300.0, 500.0));
    let patch = format!("patch = {{ load = {load:?}{more} }}\n");
    let [rail, wheel] = [dice.pick(&RAILS), dice.pick(&WHEELS)];
    let turned = standards::rail(rail)?.rotated(inclination(1.0, *dice.pick(&[20.0, 30.0, 40.0]))?);
    let (place, pair) = match seed % 8 {
        0 => (format!("offset = {}", dice.between(-8.0, 12.0)), (turned, standards::wheel(wheel)?)),
        1 => {
            let (offset, yaw) = (dice.between(-9.0, -3.0), dice.between(-0.02, 0.02));
            (format!("offset = {offset}, yaw = {yaw}"), (turned, standards::wheel("S1002")?))
        }
        3 => {
            let rail = if dice.below(2) == 0 { turned } else { kinked(&mut dice, -1.0)? };
            (format!("offset = {}", dice.between(-4.0, 4.0)), (rail, kinked(&mut dice, 1.0)?))
        }
        4 => {
            let rail = measured(&turned, Side::Rail, &mut dice)?;
            let wheel = measured(&standards::wheel("S1002")?, Side::Wheel, &mut dice)?;
            (format!("offset = {}", dice.between(-6.0, 6.0)), (rail, wheel))
        }
        7 => {
            let name: &&str = dice.pick(&WHEELS[1..4]);
            let thin = standards::wheel(name)?;
            (format!("offset = {}", dice.between(0.0, 4.0)), (turned, thin))
        }
        kind => {
            let text = patch + &described(kind, &mut dice);
            return Run::new(scene::resolve(&parsed(&text)?, ".".as_ref(), "random")?, SILENT);
        }
    };
    let text = format!(
        "rail.profile = \"60E1\"\nwheel = {{ profile = \"S1002\", radius = {radius} }}\ncontact = {{ {place} }}\n{patch}"
    );
    let pair = Pair::new(pair.0, pair.1, radius)?;
    Run::new(scene::with_profiles(&parsed(&text)?, Profiles::drawn(pair), "random")?, SILENT)
}

/// Most cells of the finest solution; of the few scenes of every run they are fewer.
fn most_cells() -> f64 {
    if campaign::scenes() > 20 { 150e3 } else { 60e3 }
}

/// The largest pressure of a part on cells up to 4 times finer than its own, and its difference from that on cells twice as wide.
fn truth(part: &Part) -> Result<[f64; 2]> {
    let (contact, found) = (&part.site.contact, part.analysis.pressure.as_ref().expect("pressures"));
    let of = |own: &Pressures, share: f64| -> Result<f64> {
        let range = |k: usize| {
            let (from, width) = (own.cells.from[k], own.cells.step[k] * own.cells.count[k] as f64);
            Interval::new(from, from + width)
        };
        let count = [0, 1].map(|k| range(k).width() / found.cell[k]);
        let finer = share * f64::min(4.0, (most_cells() / (count[0] * count[1])).sqrt());
        let cells = Cells::over(
            &Window { xi: range(0), eta: range(1) },
            count.map(|n| (finer * n).max(8.0) as usize),
        )?;
        let approach = contact.approach.expect("an approach") - own.lowered;
        let region = HalfSpace::new(cells, &cells.separations(&contact.placement), approach)?;
        Ok(press_alone(region, 3e-4, STEEL)?[0].largest().pressure_n_per_mm2)
    };
    let most = |share| {
        let mut each = contact.pressures.iter().map(|own| of(own, share));
        each.try_fold(0.0, |most, p| Ok::<_, wheelrail::Error>(f64::max(most, p?)))
    };
    let [coarse, fine] = [most(0.5)?, most(1.0)?];
    Ok([fine, (fine - coarse).abs()])
}

/// Whether a body has a joint with a kink.
fn has_kink(part: &Part) -> bool {
    let bodies = [part.site.contact.placement.rail(), part.site.contact.placement.wheel()];
    bodies.iter().any(|body| body.profile().continuity().iter().any(|joint| joint.kink.abs() > 1e-6))
}

#[test]
fn the_largest_pressure_holds_its_error_or_an_edge_is_named() {
    let (mut known, mut edges, mut refused, mut worst, mut failed) = (0, 0, 0, 0.0_f64, Vec::new());
    let mut errors = Vec::new();
    for seed in campaign::seeds() {
        let run = match random(seed, "") {
            Ok(run) => run,
            // Chains of kinks may not touch, or be rough beyond reason.
            Err(error) => {
                assert!(matches!(error.kind, ErrorKind::NoContact | ErrorKind::Input), "{seed}: {error}");
                refused += 1;
                continue;
            }
        };
        for part in &run.parts {
            let Some(found) = &part.analysis.pressure else { continue };
            let p = found.largest.pressure_n_per_mm2;
            if found.unbounded.is_some() {
                assert!(has_kink(part), "{seed}: an edge on smooth profiles");
                assert!(found.largest_error.is_infinite());
                assert!(part.warnings.iter().any(|warning| warning.contains("unbounded: an edge at x = ")));
                edges += 1;
                continue;
            }
            let Ok([fine, rest]) = truth(part) else { continue };
            let (miss, error) = ((p - fine).abs(), found.largest_error);
            known += 1;
            errors.push(error / p);
            worst = worst.max(miss / (error + rest));
            if miss > error + rest {
                println!("{seed}: {p} ± {error}: {fine} ± {rest}");
                failed.push(format!(
                    "{seed} ({}): {p:.1} ± {error:.1}, on finer cells {fine:.1} ± {rest:.1}",
                    seed % 8
                ));
            }
        }
    }
    errors.sort_by(f64::total_cmp);
    let share = |of: f64| errors.get((of * errors.len() as f64) as usize).copied().unwrap_or(f64::NAN);
    println!(
        "{known} largest pressures, {edges} with an edge, {refused} refused; worst miss {worst:.2} of the error; errors: median {:.2} %, \
         95 % below {:.2} %",
        100.0 * share(0.5),
        100.0 * share(0.95)
    );
    assert!(failed.is_empty(), "{} of {known}:\n{}", failed.len(), failed.join("\n"));
    assert!(known > 5 && edges > 0, "{known} {edges}");
}

#[test]
fn the_sum_of_the_pressures_over_a_grid_is_the_normal_force() {
    // Their cells are many: a quarter as many as of the largest pressure.
    let (mut worst, mut sums) = (0.0_f64, 0);
    for seed in 0..campaign::scenes().div_ceil(4) {
        // Flats in every run, and each of the other kinds in turn.
        let seed = if seed == 0 { 2 } else { 7 * seed };
        let Ok(run) = random(seed, ", pressure = true") else { continue };
        for part in &run.parts {
            let Some(found) = &part.analysis.pressure else { continue };
            let grid = &part.site.grid;
            let cell = (grid.xi[1] - grid.xi[0]) * (grid.eta[1] - grid.eta[0]);
            let sum = cell * found.field.as_ref().expect("a field").iter().sum::<f64>();
            let Some(load) = part.site.normal_load else { continue };
            let miss = sum / load - 1.0;
            assert!(miss.abs() < 5e-3, "{seed} ({}): {miss:.4}", seed % 8);
            worst = worst.max(miss.abs());
            sums += 1;
        }
    }
    println!("{sums} sums, off by at most {:.2} %", 100.0 * worst);
    assert!(sums > 2, "{sums}");
}

#[test]
fn edges_and_flats_that_went_wrong_are_right_or_named() -> Result<()> {
    let run = defect("kink-pressure.toml")?;
    let found = run.parts[0].analysis.pressure.as_ref().expect("pressures");
    assert!(found.unbounded.is_some(), "{:?}", found.largest);
    let told: Vec<String> = FACTS.iter().filter_map(|fact| fact.text(&run.parts[0])).collect();
    assert!(told.iter().any(|text| text.starts_with("unbounded: an edge at x = ")), "{told:?}");
    // The kink is that of the drawing.
    let kink = found.unbounded.as_ref().map_or(0.0, |found| found.edge.kink);
    let placement = &run.parts[0].site.contact.placement;
    let joints = placement.wheel().profile().continuity();
    assert!(joints.iter().any(|joint| (joint.kink - kink).abs() < 1e-4), "{kink}: {joints:?}");
    let run = defect("headline-pressure-flat.toml")?;
    for part in &run.parts {
        let found = part.analysis.pressure.as_ref().expect("pressures");
        let [fine, rest] = truth(part)?;
        let miss = (found.largest.pressure_n_per_mm2 - fine).abs();
        assert!(
            miss <= found.largest_error + rest,
            "{:?} ± {}: {fine} ± {rest}",
            found.largest,
            found.largest_error
        );
    }
    let Some(contact) = std::env::var_os("WHEELRAIL_CONTACT").map(PathBuf::from) else { return Ok(()) };
    let text = "[rail]\nprofile = \"60E1\"\nrotate = \"1:40\"\n[right.rail]\nfile = \"testbank/profiles/cross_nose.slcs\"\n[wheel]\n\
                profile = \"S1002\"\nradius = 460.0\n[track]\nspacing = 1500.0\n[wheelset]\nback_to_back = 1360\nflange_back_x = -70\n\
                lateral = 2\nyaw = 0.001\nroll = \"solve\"\nalong = 60\n[patch]\nload = 60000.0\n";
    let run = Run::new(scene::resolve(&parsed(text)?, &contact, "nose")?, SILENT)?;
    assert!(run.parts[0].analysis.pressure.as_ref().expect("pressures").unbounded.is_some());
    Ok(())
}

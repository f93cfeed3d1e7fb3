//! Tests what is promised of s on random pairs, against 28-digit values: relative and absolute errors, error estimates at every
//! tolerance, and where there is a surface at all.
//!
//! `WHEELRAIL_PROMISE_SCENES=5000 cargo test promises -- --nocapture` is the long run.

mod exact;
mod twice;

use exact::{Exact, Found, doubled};
use wheelrail::internal::Random;
use wheelrail::mesh::equal_steps;
use wheelrail::nalgebra::Vector2;
use wheelrail::placement::{Pair, Placement};
use wheelrail::profile::{Profile, Shape, Side, standards};
use wheelrail::separation::{EtaAxis, FULL_PRECISION, Method, plan};
use wheelrail_report::errors::{inside_contact, over_contact};
use wheelrail_report::reference::ReferenceFile;
use wheelrail_report::specimen::{Instrument, Specimen, SpecimenKind};

/// Scenes of one ordinary test run.
const SCENES: u64 = 100;

/// Seed of the first scene; the k-th has `SEED + k`.
const SEED: u64 = 0x5EED_0F1E_0000;

const TOLERANCES: [f64; 4] = [FULL_PRECISION, 1e-9, 1e-6, 1e-3];

/// Errors of s that are promised to users: over both contact segments a share of the terms of s, elsewhere a length \[mm\].
const RELATIVE: f64 = 1e-13;
const ABSOLUTE: f64 = 2e-12;

/// Number of points of a grid that are compared, besides those where a surface ends.
const COMPARED: usize = 40;

/// Distance \[mm\] from the end of a surface within which both a value and none are right.
const AT_AN_END: f64 = 1e-6;

/// Largest |s| \[mm\] that 28 digits cannot tell from 0.
const RESIDUE: f64 = 1e-26;

/// Kinds of measured rails and wheels.
const SPECIMENS: [[SpecimenKind; 4]; 2] = [
    [SpecimenKind::NewRail, SpecimenKind::WornRail, SpecimenKind::ConformalRail, SpecimenKind::SwitchBlade],
    [
        SpecimenKind::NewWheel,
        SpecimenKind::FullFlangeWheel,
        SpecimenKind::WornWheel,
        SpecimenKind::HollowWheel,
    ],
];

/// A profile and its exact double.
type Doubled = (Profile, Exact);

/// Returns every built-in profile of one side that can be written by centres and radii.
fn built_in(side: Side) -> Vec<Doubled> {
    let all: Vec<_> = match side {
        Side::Rail => standards::rail_names().map(standards::rail).collect(),
        Side::Wheel => standards::wheel_names().map(standards::wheel).collect(),
    };
    all.into_iter().filter_map(|profile| doubled(&profile.expect("a built-in profile"))).collect()
}

/// Returns a smoothed profile through measured points, worn or new; `None` if it turns back.
fn measured(kinds: &[SpecimenKind], dice: &mut Random) -> Option<Doubled> {
    let instrument = Instrument::new(dice.between(0.2, 1.0), dice.between(0.0, 0.005), dice.bits());
    doubled(&Specimen::new(*dice.pick(kinds), instrument).ok()?.profile().ok()?)
}

/// One random scene.
struct Scene<'a> {
    name: String,
    placement: Placement,
    exact: exact::Pair<'a>,
    /// The exact pair without yaw.
    straight: exact::Pair<'a>,
    xi: Vec<f64>,
    axis: EtaAxis,
}

/// Returns ascending values over a random window.
fn values(dice: &mut Random, widest: f64, most: usize, extra: &[f64]) -> Vec<f64> {
    let half = 10f64.powf(dice.between(-1.0, widest));
    let centre = if dice.below(2) == 0 { 0.0 } else { dice.between(-half, half) };
    let n = 2 + dice.below(most);
    let step = |k: usize| (2 * k) as f64 - (n - 1) as f64;
    let mut all: Vec<f64> = (0..n).map(|k| centre + half * step(k) / (n - 1) as f64).collect();
    let [first, last] = [all[0], all[n - 1]];
    all.extend(extra.iter().copied().filter(|x| first < *x && *x < last));
    all.sort_by(f64::total_cmp);
    all.dedup();
    all
}

impl<'a> Scene<'a> {
    /// Places a pair in contact, without a grid.
    fn placed([rail, wheel]: [&'a Doubled; 2], radius: f64, skew: f64, at: [f64; 2]) -> Option<Self> {
        let pair = Pair::new(rail.0.clone(), wheel.0.clone(), radius).ok()?;
        let placement = pair.placed(at[0], at[1], skew).ok()?;
        let [exact, straight] = [skew, 0.0].map(|skew| exact::Pair::new(&rail.1, &wheel.1, radius, at, skew));
        let names = [&rail.0.name, &wheel.0.name];
        let name = format!("{} at {}, {} at {}, R {radius}, skew {skew}", names[0], at[0], names[1], at[1]);
        let axis = EtaAxis::new(&[]);
        Some(Self { name, placement, exact: exact?, straight: straight?, xi: Vec::new(), axis })
    }

    /// Makes a random scene; `None` if the dice give no placed pair.
    fn new([rail, wheel]: [&'a Doubled; 2], dice: &mut Random) -> Option<Self> {
        let radius = dice.between(150.0, 1000.0);
        let skew = if dice.below(2) == 0 { 0.0 } else { dice.between(-0.08, 0.08) };
        let at = [dice.between(-36.0, 36.0), dice.between(-60.0, 60.0)];
        let mut scene = Self::placed([rail, wheel], radius, skew, at)?;
        let joints = if dice.below(3) == 0 { scene.placement.joints(-60.0, 60.0) } else { Vec::new() };
        let xi = values(dice, 1.6, 120, &joints);
        let axis = EtaAxis::new(&values(dice, 1.5, 60, &[]));
        (scene.xi, scene.axis) = (xi, axis);
        Some(scene)
    }

    /// Returns s over the grid and its estimated error \[mm\].
    fn filled(&self, tolerance: f64, method: Option<Method>) -> (Vec<f64>, f64) {
        let mut plan = plan(&self.placement, &self.xi, &self.axis, tolerance, method);
        let mut s = vec![0.0; self.xi.len() * self.axis.eta().len()];
        s.fill(f64::INFINITY);
        plan.fill(&self.placement, &self.xi, &self.axis, &mut s);
        (s, plan.error)
    }

    /// Returns ξ and η of a point of the grid \[mm\].
    fn place(&self, index: usize) -> [f64; 2] {
        [self.xi[index / self.axis.eta().len()], self.axis.eta()[index % self.axis.eta().len()]]
    }

    /// Returns whether s leads from the rail to the wheel.
    fn on_both(&self, place: [f64; 2], s: f64) -> bool {
        self.exact.on_both(place, self.placement.rail().section().height(place[0]), s)
    }

    /// Returns the sum of the magnitudes of the terms of s \[mm\]: midplane gap, climb of the wheel along ξ′ − ξ, rise across.
    fn size(&self, [xi, eta]: [f64; 2], s: f64) -> f64 {
        let skew = self.placement.skew_rotation();
        let midplane = |xi: f64| match self.straight.wheel(xi, 0.0) {
            Found::At(zeta) => Some(zeta),
            _ => None,
        };
        let xi_w = skew.inverse_transform_vector(&Vector2::new(xi, eta)).x;
        let (Found::At(gap), Some(here), Some(there)) =
            (self.straight.separation(xi, 0.0), midplane(xi), midplane(xi_w))
        else {
            return s.abs();
        };
        let (gap, climb) = (gap.high, (there - here).high);
        gap.abs() + climb.abs() + (s - gap - climb).abs()
    }

    /// Returns what lies at a place. It is unclear also if there is no surface at the place but one nearby.
    fn exactly(&self, [xi, eta]: [f64; 2]) -> Found {
        let here = self.exact.separation(xi, eta);
        if here == Found::Nothing {
            let near = [[-1.0, 0.0], [1.0, 0.0], [0.0, -1.0], [0.0, 1.0]];
            let same = |[x, y]: [f64; 2]| {
                self.exact.separation(xi + x * AT_AN_END, eta + y * AT_AN_END) == Found::Nothing
            };
            return if near.into_iter().all(same) { here } else { Found::Unclear };
        }
        here
    }
}

/// Returns the factor R_max/300 mm of [`ABSOLUTE`], at least 1.
fn scale(placement: &Placement) -> f64 {
    let segments = placement.rail().profile().segments().iter().chain(placement.wheel().profile().segments());
    let radius = |shape: &Shape| match shape {
        Shape::Arc(arc) if arc.radius().is_finite() => arc.radius().abs(),
        _ => 0.0,
    };
    segments.map(|segment| radius(&segment.shape)).fold(300.0, f64::max) / 300.0
}

/// The results over all scenes.
#[derive(Default)]
struct Tally {
    scenes: usize,
    points: usize,
    /// Largest shares of what is promised: relative, absolute, estimates by tolerance.
    worst: [f64; 6],
    /// Largest overstepping share of each promise in the scene under test, with its place.
    of_scene: [Option<(f64, String)>; 6],
    overstepped: Vec<String>,
}

impl Tally {
    fn judge(&mut self, promise: usize, error: f64, allowed: f64, what: impl Fn() -> String) {
        let share = error / allowed;
        self.worst[promise] = self.worst[promise].max(share);
        let kept = error <= allowed;
        if kept {
            return;
        }
        // Only the worst place of a scene is kept.
        match &mut self.of_scene[promise] {
            Some((worst, _)) if *worst >= share => {}
            worst => *worst = Some((share, what())),
        }
    }

    fn add(&mut self, scene: &Scene<'_>, dice: &mut Random) {
        let grids: Vec<_> =
            [(FULL_PRECISION, Some(Method::Pointwise)), (FULL_PRECISION, Some(Method::Spectral))]
                .into_iter()
                .chain(TOLERANCES.map(|tolerance| (tolerance, None)))
                .map(|(tolerance, method)| (tolerance, method, scene.filled(tolerance, method)))
                .collect();
        let (pointwise, spectral) = (&grids[0].2.0, &grids[1].2.0);
        let count = pointwise.len();
        let mut places: Vec<usize> = (0..COMPARED).map(|_| dice.below(count)).collect();
        places.extend([0, scene.axis.eta().len() - 1, count - scene.axis.eta().len(), count - 1]);
        let at_c = scene.xi.partition_point(|&xi| xi < 0.0).min(scene.xi.len() - 1) * scene.axis.eta().len();
        places
            .push(at_c + scene.axis.eta().partition_point(|&eta| eta < 0.0).min(scene.axis.eta().len() - 1));
        // Points with a value next to points without one.
        let ends = (1..count).filter(|&k| pointwise[k].is_nan() != pointwise[k - 1].is_nan());
        places.extend(ends.take(COMPARED / 4).flat_map(|k| [k - 1, k]));
        for k in 0..count {
            let others = grids[2..].iter().any(|(.., (s, _))| s[k].is_nan() != pointwise[k].is_nan());
            if (pointwise[k].is_nan() != spectral[k].is_nan() || others)
                && scene.exactly(scene.place(k)) != Found::Unclear
            {
                self.overstepped.push(format!(
                    "a value by one method at {:?}: {}",
                    scene.place(k),
                    scene.name
                ));
                break;
            }
        }
        self.scenes += 1;
        let mut masked = false;
        let scale = scale(&scene.placement);
        for k in places {
            let place = scene.place(k);
            let exact = match scene.exactly(place) {
                Found::At(exact) => exact,
                Found::Unclear => continue,
                Found::Nothing => {
                    if !masked && !pointwise[k].is_nan() && !scene.on_both(place, pointwise[k]) {
                        masked = true;
                        let line = format!("{} for none at {place:?}: {}", pointwise[k], scene.name);
                        self.overstepped.push(line);
                    }
                    continue;
                }
            };
            if exact.high.abs() < RESIDUE {
                continue;
            }
            self.points += 1;
            let error = |s: f64| ((s - exact.high) - exact.low).abs();
            // The exact search stepped over a feature of the surface: the value found is farther out, and on both surfaces.
            if pointwise[k] < exact.high - AT_AN_END && scene.on_both(place, pointwise[k]) {
                continue;
            }
            let [inside, over] =
                [inside_contact, over_contact].map(|over| over(&scene.placement, place[0], place[1]));
            let size = scene.size(place, exact.high);
            for (at, (tolerance, method, (s, estimate))) in grids.iter().enumerate() {
                let what = || {
                    let by = method.map_or("auto", Method::name);
                    format!(
                        "{by} to {tolerance:e}: {} for {exact:?} at {place:?}, estimate {estimate:e}: {}",
                        s[k], scene.name
                    )
                };
                if at < 3 && inside {
                    self.judge(0, error(s[k]), RELATIVE * size, what);
                } else if at < 3 && !over {
                    self.judge(1, error(s[k]), ABSOLUTE * scale, what);
                }
                self.judge(2 + at.saturating_sub(2), error(s[k]), *estimate, what);
            }
        }
    }
}

/// A scene that once overstepped a promise: why; rail and wheel; abscissae of C on both, rolling radius \[mm\] and skew \[rad\];
/// first value, last value and number of ξ and η.
type Mended = (&'static str, [&'static str; 2], [f64; 4], [(f64, f64, usize); 2]);

const MENDED: [Mended; 6] = [
    (
        "the arc next to C was placed from its far end: 4.2 times the estimate",
        ["52E1", "EN15302-H"],
        [-18.029613782175787, 6.794909407022686, 523.3352920826783, 0.0],
        [(-3.772936953905333, 3.772936953905333, 33), (-0.6167972241811461, 0.6167972241811461, 21)],
    ),
    (
        "the arc next to C on a wheel was placed from its far end: 3.8 times",
        ["50E5", "EN15302-B"],
        [-11.49809772770083, -0.27613964117112744, 351.8847820855062, 0.0],
        [(-0.24756297349982343, 0.24756297349982343, 86), (-0.8000281322929101, 10.609630784434785, 23)],
    ),
    (
        "the angle of a steep rail is off by the rounding of its sine over its cosine: 2.7 times",
        ["49E5", "APTA-220"],
        [-33.729325731506606, -2.6263549019121797, 518.9165331604975, 0.027084526575921225],
        [(-6.0, 6.0, 60), (-31.0, 31.0, 40)],
    ),
    (
        "a steep arc: the rounding of its sine times the radius times the slope, 1.3 times",
        ["49E5", "EN15302-H"],
        [33.896785912583596, -14.711637474315786, 350.0428709455566, 0.0],
        [(-23.3, 10.0, 70), (-3.0, 3.0, 20)],
    ),
    (
        "a polynomial tread takes more roundings than an arc: 1.4 times",
        ["50E6", "S1002"],
        [4.277825490909073, -8.704879560424494, 773.6546993174749, 0.0],
        [(-9.50068797473938, 9.50068797473938, 80), (-0.5, 0.5, 11)],
    ),
    (
        "wide across under yaw: s itself takes more than two roundings",
        ["UIC60", "S1002-arcs-0.1um"],
        [5.442924492056562, 15.233777198061574, 384.519117030454, 0.026305572381724804],
        [(-1.5, 1.5, 40), (-30.0, 30.0, 41)],
    ),
];

#[test]
fn mended_scenes_stay_so() {
    let mut tally = Tally::default();
    for (k, (why, [rail, wheel], [rail_x, wheel_x, radius, skew], window)) in MENDED.into_iter().enumerate() {
        let drawn = [standards::rail(rail), standards::wheel(wheel)];
        let [rail, wheel] = drawn.map(|profile| doubled(&profile.expect("a built-in")).expect("a graph"));
        let mut scene =
            Scene::placed([&rail, &wheel], radius, skew, [rail_x, wheel_x]).expect("a placed pair");
        let [xi, eta] = window.map(|(from, to, n)| equal_steps(from, to, n));
        (scene.xi, scene.axis) = (xi, EtaAxis::new(&eta));
        tally.add(&scene, &mut Random::new(SEED + k as u64));
        let worst: Vec<_> = std::mem::take(&mut tally.of_scene).into_iter().flatten().collect();
        assert!(worst.is_empty() && tally.overstepped.is_empty(), "{why}: {worst:?}");
    }
}

#[test]
fn promises_are_kept_on_random_pairs() {
    let scenes = std::env::var("WHEELRAIL_PROMISE_SCENES").map_or(SCENES, |n| n.parse().expect("a number"));
    let [rails, wheels] = [built_in(Side::Rail), built_in(Side::Wheel)];
    assert!(rails.len() > 20 && wheels.len() > 10, "{} rails, {} wheels", rails.len(), wheels.len());
    let mut tally = Tally::default();
    for k in 0..scenes {
        let mut dice = Random::new(SEED + k);
        let drawn = [dice.pick(&rails), dice.pick(&wheels)];
        let smoothed = if dice.below(4) == 0 {
            [&SPECIMENS[0][..], &SPECIMENS[1][..]].map(|kinds| measured(kinds, &mut dice))
        } else {
            [None, None]
        };
        let pair = [smoothed[0].as_ref().unwrap_or(drawn[0]), smoothed[1].as_ref().unwrap_or(drawn[1])];
        let before = tally.overstepped.len();
        if let Some(scene) = Scene::new(pair, &mut dice) {
            tally.add(&scene, &mut dice);
            let worst = std::mem::take(&mut tally.of_scene).into_iter().flatten();
            tally.overstepped.extend(worst.map(|(share, what)| format!("{share:.2}: {what}")));
        }
        for line in &mut tally.overstepped[before..] {
            line.insert_str(0, &format!("scene {k}: "));
        }
    }
    println!(
        "{} scenes, {} points, seeds from {SEED:#x}; largest shares of: relative {:.3}, absolute {:.3}, estimates {:.3?}",
        tally.scenes,
        tally.points,
        tally.worst[0],
        tally.worst[1],
        &tally.worst[2..]
    );
    for line in tally.overstepped.iter().take(200) {
        println!("{line}");
    }
    assert!(tally.scenes as u64 > scenes / 2 && tally.overstepped.is_empty(), "{}", tally.overstepped.len());
}

/// The 28-digit values have the digits of the 60-digit values.
#[test]
fn exact_values_are_the_60_digit_ones() {
    let yawed = ["yawed_crown_on_cone", "yawed_60E1_S1002_tread", "yawed_flange"].map(|name| {
        let path = crate::common::repository("tests/reference_yawed").join(name).with_extension("json");
        let mut values: serde_json::Value =
            serde_json::from_str(&std::fs::read_to_string(path).expect("values")).expect("JSON");
        values["boundary"] = serde_json::json!([]);
        serde_json::from_value::<ReferenceFile>(values).expect("a file of values")
    });
    let mut compared = 0;
    for reference in crate::common::references()
        .into_iter()
        .chain(crate::common::references_in("reference_spline"))
        .chain(yawed)
    {
        let profiles =
            [&reference.scene.rail, &reference.scene.wheel].map(|segments| Exact::of_reference(segments));
        let at = [reference.scene.contact_rail_x, reference.scene.contact_wheel_x];
        let (radius, skew) = (reference.scene.wheel_radius, reference.scene.chi);
        let pair = exact::Pair::new(&profiles[0], &profiles[1], radius, at, skew).expect("a pair");
        for (xi, eta, value) in &reference.separation {
            let (Found::At(s), Some(value)) = (pair.separation(*xi, *eta), value) else { continue };
            // The text to 25 digits: its first 16, and what is left.
            let high: f64 = value.parse().expect("a number");
            let error = (s.high - high).abs();
            assert!(
                error <= 2.0 * f64::EPSILON * high.abs() + 1e-26,
                "{}: {s:?}, not {value}",
                reference.name
            );
            compared += 1;
        }
    }
    assert!(compared > 600, "{compared}");
}

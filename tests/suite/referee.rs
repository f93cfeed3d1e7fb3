//! Patches of random placements against those that were found before, which `tests/reference_patches.bin` holds.
//!
//! `WHEELRAIL_CAMPAIGN=2000 cargo test referee -- --nocapture` is the long run, and
//! `cargo test -p wheelrail-tests --test suite -- --ignored referee` writes the file anew.

use crate::campaign;
use crate::common::repository;
use crate::conformal_brute::placements::strange;
use rayon::prelude::*;
use wheelrail::Interval;
use wheelrail::internal::Random;
use wheelrail::patch::{Component, Patch, Window};
use wheelrail::placement::{Pair, Placement};
use wheelrail::profile::{Polynomial, Profile, Section, Segment, Shape, Side, inclination, standards};
use wheelrail::search::{ONE_CONTACT, Pose, ProfilePair, Selection};

/// Random placements in the file.
const PLACEMENTS: usize = 2000;

/// Least number of them in a run.
const EVERY_RUN: u64 = 60;

/// Count of components in the file where the bodies do not meet.
const APART: u8 = u8::MAX;

/// Numbers of each component in the file: area and perimeter, both ends along ξ and along η.
const NUMBERS: usize = 6;

/// Largest relative difference of areas and perimeters, and of ends as a share of the component's size.
const AREA: f64 = 1e-12;
const PERIMETER: f64 = 1e-10;
const EXTENT: f64 = 1e-10;

/// Roundings of the profiles' coordinates by which s may differ.
const ROUNDINGS: f64 = 16.0;

/// Size of the profiles \[mm\].
const SIZE: f64 = 70.0;

/// Profiles of one kind, and the range of abscissae \[mm\] of either body at which points are put together.
struct Stock {
    rails: Vec<Profile>,
    wheels: Vec<Profile>,
}

/// Cubic curves through heights of a profile at even abscissae with some noise \[mm\].
fn curved(profile: &Profile, side: Side, [low, high]: [f64; 2], [step, noise]: [f64; 2]) -> Profile {
    let (section, mut dice) = (Section::own_axes(profile, side), Random::new(66));
    let count = ((high - low) / step).round() as usize;
    let x: Vec<f64> = (0..=count).map(|k| Interval::new(low, high).step(k, count)).collect();
    let z: Vec<f64> = x.iter().map(|&x| section.height(x) + noise * dice.normal()).collect();
    let slope = |k: usize| {
        let (p, q) = (k.saturating_sub(1), (k + 1).min(count));
        (z[q] - z[p]) / (x[q] - x[p])
    };
    let piece = |k: usize| {
        let (h, [m, n]) = (x[k + 1] - x[k], [slope(k), slope(k + 1)]);
        let rise = (z[k + 1] - z[k]) / h;
        let t = [0.0, h];
        let c = [z[k], m, (3.0 * rise - 2.0 * m - n) / h, (m + n - 2.0 * rise) / (h * h)];
        let curve = Polynomial::span(&[x[k], 1.0], &c, t).expect("a piece");
        Segment { label: String::new(), shape: Shape::Polynomial(curve) }
    };
    Profile::new(format!("{} every {step} mm", profile.name), "", (0..count).map(piece).collect())
        .expect("a profile")
}

/// Drawn profiles; smooth and rough curves through their points; profiles with kinks, steps and ends near the contact.
fn stocks() -> [Stock; 4] {
    let drawn = |rails: &[&str], wheels: &[&str]| {
        let [rails, wheels] = [(rails, Side::Rail), (wheels, Side::Wheel)].map(|(names, side)| {
            let profile = |name: &&str| match side {
                Side::Rail => standards::rail(name),
                Side::Wheel => standards::wheel(name),
            };
            names.iter().map(|name| profile(name).expect("a profile")).collect()
        });
        Stock { rails, wheels }
    };
    let some = drawn(&["60E1", "54E3", "46E1"], &["S1002", "EN15302-A"]);
    let through = |points: [f64; 2]| {
        let curves = |profiles: &[Profile], side: Side, over: [f64; 2]| {
            profiles.iter().map(|profile| curved(profile, side, over, points)).collect()
        };
        Stock {
            rails: curves(&some.rails, Side::Rail, [-30.0, 30.0]),
            wheels: curves(&some.wheels, Side::Wheel, [-40.0, 50.0]),
        }
    };
    let names = [standards::rail_names().collect::<Vec<_>>(), standards::wheel_names().collect()];
    let [rails, wheels] = strange().expect("profiles");
    [drawn(&names[0], &names[1]), through([2.5, 0.0]), through([1.0, 2e-5]), Stock { rails, wheels }]
}

/// What is asked of one random placement.
struct Request {
    name: String,
    pair: Pair,
    /// Lateral displacement \[mm\] of a wheel that is let down, or abscissae \[mm\] of two points that are put together.
    stands: Result<f64, [f64; 2]>,
    yaw: f64,
    approach: f64,
    over_rail: bool,
    window: Window,
}

impl Request {
    fn new(stocks: &[Stock; 4], number: usize) -> Self {
        let mut dice = Random::stream(66, number as u64);
        let kind = *dice.pick(&[0, 0, 0, 1, 2, 3]);
        let stock = &stocks[kind];
        let rail =
            dice.pick(&stock.rails).rotated(inclination(*dice.pick(&[0.0, 0.05]), 1.0).expect("a rotation"));
        let wheel = dice.pick(&stock.wheels).clone();
        let radius = dice.between(300.0, 550.0);
        let name = format!("case {number}: {} under {}, R {radius}", rail.name, wheel.name);
        let mut pair = Pair::new(rail, wheel, radius).expect("a pair");
        let roller = dice.between(250.0, 600.0);
        let rolls = dice.below(2) == 0;
        if rolls {
            pair = pair.on_roller(roller).expect("a roller");
        }
        let yaw = *dice.pick(&[0.0, 1.0, 1.0]) * dice.between(-0.05, 0.05);
        let offset = dice.between(-9.0, 9.0);
        let points = [dice.between(-34.0, 34.0), dice.between(-44.0, 45.0)];
        let stands = if dice.below(4) == 0 { Err(points) } else { Ok(offset) };
        let approach = 10f64.powf(dice.between(-4.0, 0.0));
        let over_rail = dice.below(4) == 0;
        let half = approach.sqrt() * *dice.pick(&[10.0, 30.0]);
        let mut end = |sign: f64| sign * half * dice.between(0.2, 1.0);
        let cut = Window { xi: Interval::new(end(-1.0), end(1.0)), eta: Interval::new(end(-1.0), end(1.0)) };
        let window = if dice.below(6) == 0 { cut } else { Window::UNBOUNDED };
        let roller = if rolls { format!("roller {roller}") } else { "rail".into() };
        let name = format!(
            "{name}, {roller}, yaw {yaw}, {stands:?}, δ {approach}, over rail {over_rail}, {window:?}"
        );
        Self { name, pair, stands, yaw, approach, over_rail, window }
    }

    /// The points of both profiles \[mm\] and the skew, in few digits; `None` where the bodies do not meet.
    fn found(&self) -> Option<[f32; 3]> {
        let at = match self.stands {
            Err([rail, wheel]) => [rail, wheel, self.yaw],
            Ok(offset) => {
                let profiles = ProfilePair::new(&self.pair).ok()?;
                let pose = Pose::new(offset, self.yaw, 0.0).ok()?;
                let mut search = profiles.search();
                let touch = search.touch(&pose, &Selection { within: 0.0, apart: ONE_CONTACT }).ok()?;
                let contact = touch.contacts.first()?;
                [contact.rail_x, contact.wheel_x, contact.skew]
            }
        };
        let at = at.map(|value| value as f32);
        self.placed(at).map(|_| at)
    }

    fn placed(&self, [rail, wheel, skew]: [f32; 3]) -> Option<Placement> {
        self.pair.placed(rail.into(), wheel.into(), skew.into()).ok()
    }

    fn patch(&self, placement: &Placement) -> Patch {
        let find = if self.over_rail { Patch::over_rail } else { Patch::new };
        find(placement, self.approach, &self.window)
    }
}

fn numbers(c: &Component) -> [f64; NUMBERS] {
    [c.area, c.perimeter, c.xi.low, c.xi.high, c.eta.low, c.eta.high]
}

/// The file's part on one placement: its points, and the numbers of its components.
type Known = Option<([f32; 3], Vec<[f64; NUMBERS]>)>;

fn written(known: &Known) -> Vec<u8> {
    let Some((at, components)) = known else { return vec![APART] };
    let mut bytes = vec![components.len() as u8];
    bytes.extend(at.iter().flat_map(|value| value.to_le_bytes()));
    bytes.extend(components.iter().flatten().flat_map(|value| value.to_le_bytes()));
    bytes
}

fn read() -> Vec<Known> {
    let bytes = std::fs::read(repository("tests/reference_patches.bin")).expect("the patches of before");
    let mut rest = bytes.as_slice();
    let mut next = |count: usize| {
        let (these, others) = rest.split_at(count);
        rest = others;
        these
    };
    let mut all = Vec::new();
    for _ in 0..PLACEMENTS {
        let count = next(1)[0];
        all.push((count != APART).then(|| {
            let at = [0; 3].map(|_| f32::from_le_bytes(next(4).try_into().expect("four bytes")));
            let number = |_| f64::from_le_bytes(next(8).try_into().expect("eight bytes"));
            let mut number = number;
            (at, (0..count).map(|_| [0; NUMBERS].map(&mut number)).collect())
        }));
    }
    all
}

/// The largest differences of a patch from that of before, in what is allowed: of areas, perimeters, ends; or the counts, if they differ.
fn apart(patch: &Patch, before: &[[f64; NUMBERS]]) -> Result<[f64; 3], [usize; 2]> {
    if patch.components.len() != before.len() {
        return Err([patch.components.len(), before.len()]);
    }
    let mut most = [0.0f64; 3];
    for (c, old) in patch.components.iter().zip(before) {
        let new = numbers(c);
        // A part that is shallower than that is all rounding.
        let depth = (patch.approach - c.deepest[0]).abs();
        let rounding = 1.0 + ROUNDINGS * f64::EPSILON * SIZE / depth / AREA;
        let relative = |k: usize| (new[k] / old[k] - 1.0).abs();
        most[0] = most[0].max(relative(0) / (AREA * rounding));
        most[1] = most[1].max(relative(1) / (PERIMETER + AREA * rounding));
        for k in 2..NUMBERS {
            let size = if k < 4 { old[3] - old[2] } else { old[5] - old[4] };
            most[2] = most[2].max((new[k] - old[k]).abs() / size / (EXTENT + AREA * rounding));
        }
    }
    Ok(most)
}

#[test]
fn the_referee_finds_the_patches_of_before() {
    let (stocks, known) = (stocks(), read());
    let count = campaign::scenes().max(EVERY_RUN).min(PLACEMENTS as u64) as usize;
    let number = |k: usize| k * PLACEMENTS / count;
    let one = |number: usize| {
        let (at, before) = known[number].as_ref()?;
        let request = Request::new(&stocks, number);
        let patch = request.patch(&request.placed(*at).expect("the points of before"));
        let found = apart(&patch, before);
        let good = found.is_ok_and(|most| most.iter().all(|most| *most <= 1.0));
        (!good).then(|| {
            let new: Vec<_> = patch.components.iter().map(numbers).collect();
            format!("{}\n{found:?} of what is allowed: {new:?}, before {before:?}", request.name)
        })
    };
    let differ: Vec<String> = (0..count).into_par_iter().filter_map(|k| one(number(k))).collect();
    assert!(differ.is_empty(), "{} of {count} differ:\n{}", differ.len(), differ.join("\n"));
    assert!(known.iter().flatten().count() > PLACEMENTS * 9 / 10);
}

#[test]
#[ignore = "writes the patches of today into the file"]
fn the_referee_writes_the_patches_of_today() {
    let stocks = stocks();
    let one = |number: usize| {
        let request = Request::new(&stocks, number);
        let at = request.found()?;
        let patch = request.patch(&request.placed(at)?);
        (patch.components.len() < APART.into())
            .then(|| (at, patch.components.iter().map(numbers).collect::<Vec<_>>()))
    };
    let known: Vec<Known> = (0..PLACEMENTS).into_par_iter().map(one).collect();
    let bytes: Vec<u8> = known.iter().flat_map(written).collect();
    std::fs::write(repository("tests/reference_patches.bin"), bytes).expect("the patches of today");
}

//! Curves through noisy points of drawn profiles, full-sized and models: how near they are, what is doubted, which kinks are corners.

use std::path::Path;

use wheelrail::case::{Landmarks, Run, SILENT, usual};
use wheelrail::internal::Random;
use wheelrail::measured::{Check, Finding, Measured, Options, Unit, of_points};
use wheelrail::profile::{Mark, Profile, beside, inclination, standards, trace};
use wheelrail::search::WheelsetOnTrack;
use wheelrail::{Conicity, Pair, RailDistance, Result, Roll, Side, WheelDistance, scene};

use crate::campaign;
use crate::common::repository;

/// Distance of the points that drawn profiles are sampled from \[mm\].
const FINE: f64 = 0.01;

/// Largest relative error of a pressure and of a conicity that nothing doubts.
const PRESSURE: f64 = 0.025;
const CONICITY: f64 = 0.01;

/// How a profile is measured.
#[derive(Debug, Clone, Copy)]
struct Sampling {
    /// Distance of the points \[mm\].
    spacing: f64,
    /// Size of the model, 1 for a full-sized profile.
    size: f64,
    /// Standard deviation of the points across the profile \[mm\].
    noise: f64,
}

impl Sampling {
    fn random(random: &mut Random) -> Self {
        Self {
            spacing: 0.1 * 10f64.powf(random.uniform()),
            size: *random.pick(&[1.0, 1.0, 0.5, 0.25, 0.2]),
            noise: *random.pick(&[0.0, 0.0, 3e-4, 1e-3, 3e-3, 0.01, 0.03]),
        }
    }

    /// Gives the points of a model of a profile.
    fn points(self, exact: &Profile, random: &mut Random) -> Vec<[f64; 2]> {
        let mut next = 0.0;
        let mut out = Vec::new();
        for Mark { s, station, .. } in trace(exact, FINE) {
            if self.size * s >= next {
                next += self.spacing;
                let off = self.noise * random.normal();
                out.push([
                    self.size * station.x - off * station.sin,
                    self.size * station.z + off * station.cos,
                ]);
            }
        }
        out
    }

    fn measured(
        self,
        exact: &Profile,
        side: Side,
        random: &mut Random,
        options: &Options,
    ) -> Result<Measured> {
        of_points("sample", &self.points(exact, random), side, options)
    }
}

/// The options of points in the axes of a profile.
fn upright() -> Options {
    Options { mirror: Some(false), flip_z: Some(false), unit: Some(Unit::Millimetre), ..Options::default() }
}

fn doubts_of_curve(found: &Measured) -> Vec<&Finding> {
    let of_curve = |check| matches!(check, Check::Smoothing | Check::Sparse | Check::Noise);
    found.record.warnings.iter().filter(|finding| of_curve(finding.check)).collect()
}

/// A random drawn body of those that are one smooth curve.
fn body(random: &mut Random) -> Result<(Profile, Side)> {
    Ok(match random.below(2) {
        0 => (
            standards::rail(random.pick::<&str>(&["60E1", "UIC60", "54E1", "49E1", "50E3", "46E2"]))?,
            Side::Rail,
        ),
        _ => (
            standards::wheel(random.pick::<&str>(&["S1002", "EN15302-A", "EN15302-B", "EN15302-H"]))?,
            Side::Wheel,
        ),
    })
}

#[test]
fn curves_are_as_near_as_noise_allows_or_doubted() -> Result<()> {
    let mut random = Random::new(65);
    let (mut told, mut refused, mut worst, mut wrong) = (0, 0, 0f64, Vec::new());
    let count = campaign::scenes();
    for number in 0..count {
        let ((exact, side), sampling) = (body(&mut random)?, Sampling::random(&mut random));
        let Ok(found) = sampling.measured(&exact, side, &mut random, &upright()) else {
            // Noise of a quarter of the distance of the points may turn the path back.
            assert!(sampling.noise > 0.1 * sampling.spacing, "{number}: {} {sampling:?}", exact.name);
            refused += 1;
            continue;
        };
        let (curve, what) = (&found.record.curve, format!("{number}: {} {sampling:?}", exact.name));
        let (noise, cutoff) = (curve.noise.unwrap(), curve.cutoff_wavelength.unwrap());
        if sampling.noise > 1e-3 && sampling.spacing < 0.5 * sampling.size {
            assert!((noise / sampling.noise - 1.0).abs() < 0.4, "{what}: noise {noise}");
        }
        if doubts_of_curve(&found).iter().any(|finding| finding.check != Check::Noise) {
            told += 1;
            continue;
        }
        // What smoothing may move unseen, a mean that noise may have, and what it leaves of the noise.
        let left = (2.0 * sampling.spacing / cutoff).min(1.0).sqrt();
        let bound = 0.008 * sampling.size + 9.0 * left * noise.max(sampling.noise);
        let (marks, mut hint) = (trace(&found.profile, 0.05 * sampling.size), 0);
        let all = trace(&exact, 0.5);
        // Curves end freely, and drawn kinks lie between points.
        let kinks =
            exact.continuity().into_iter().filter(|joint| joint.kink.abs() > 0.01).map(|joint| joint.x);
        let ends = [all[0].station.x, all[all.len() - 1].station.x];
        let free: Vec<f64> = kinks.chain(ends).collect();
        let reach = (cutoff + 3.0 * sampling.spacing) / sampling.size;
        let inside = |mark: &&Mark| free.iter().all(|x| (mark.station.x - x).abs() > reach);
        for Mark { station, s, .. } in all.iter().filter(inside) {
            let near = beside(&marks, [station.x, station.z].map(|x| sampling.size * x), hint).unwrap();
            hint = near.mark;
            worst = worst.max(near.across.abs() / bound);
            if near.across.abs() > bound {
                wrong.push(format!("{what}, cut-off {cutoff}: off by {} at s = {s}, {bound}", near.across));
                break;
            }
        }
    }
    println!("{count} curves: {told} doubted, {refused} refused, others off by up to {worst} of the bound");
    assert!(wrong.is_empty(), "{} wrong: {wrong:#?}", wrong.len());
    assert!(3 * (told + refused) < 2 * count && told > 0, "{told} doubted, {refused} refused of {count}");
    Ok(())
}

/// A pair of rail and wheel in their own axes, a model or full-sized.
struct Standing<'a> {
    rail: String,
    wheel: String,
    folder: &'a Path,
    size: f64,
    lateral: f64,
}

impl Standing<'_> {
    /// Gives the largest pressures on both sides, and the conicity for ±3 mm of the full-sized wheelset.
    fn answers(&self) -> Result<([f64; 2], f64)> {
        let Self { rail, wheel, folder, size, lateral } = self;
        let mm = |length: f64| length * size;
        let text = format!(
            "[rail]\n{rail}\nrotate = \"1:40\"\n[wheel]\n{wheel}\nradius = {:?}\n[track]\ngauge = {:?}\ngauge_height = {:?}\n\
             [wheelset]\nback_to_back = {:?}\nflange_back_x = {:?}\nlateral = {:?}\n[patch]\nload = {:?}\n[output]\nformats = []",
            mm(460.0),
            mm(1435.0),
            mm(14.0),
            mm(1360.0),
            mm(-70.0),
            mm(*lateral),
            6e4 * size * size,
        );
        let case = scene::resolve(&scene::parse(&text, false)?, folder, "smoothing")?;
        let pair = case.profiles().right.pair.clone();
        let run = Run::new(case, SILENT)?;
        let pressure = |k: usize| {
            run.parts[k].analysis.pressure.as_ref().map_or(f64::NAN, |found| found.largest.pressure_n_per_mm2)
        };
        let rails = RailDistance::Gauge { gauge: mm(1435.0), height: mm(14.0) };
        let wheels = WheelDistance::BackToBack { distance: mm(1360.0), flange_back_x: mm(-70.0) };
        let system = WheelsetOnTrack::new(&pair, rails, wheels)?;
        let table = Conicity::new(&system, mm(3.0), Roll::Neglect)?;
        let conicity = table.at(mm(3.0)).map_or(f64::NAN, |found| found.conicity);
        Ok(([pressure(0), pressure(1)], conicity))
    }
}

#[test]
fn pressures_and_conicities_of_measured_pairs_are_right_or_doubted() -> Result<()> {
    let folder = tempfile::tempdir().unwrap();
    let mut random = Random::new(1465);
    let (mut told, mut refused, mut worst, mut wrong) = (0, 0, [0f64; 2], Vec::new());
    let scenes = campaign::scenes().div_ceil(4);
    for number in 0..scenes {
        let names =
            [*random.pick(&["60E1", "UIC60", "54E1"]), *random.pick(&["S1002", "EN13715-1:40-h28-e32.5"])];
        let bodies = [(standards::rail(names[0])?, Side::Rail), (standards::wheel(names[1])?, Side::Wheel)];
        let (drawn, lateral) = (Sampling::random(&mut random), *random.pick(&[0.0, 2.0, 3.0, 4.0]));
        // Of points as they come few pairs are without a doubt: every second one is fine.
        let sampling = if number % 2 == 0 {
            let Sampling { spacing, size, noise } = drawn;
            Sampling { spacing: 0.3 * size * spacing, noise: 0.03 * size * noise, ..drawn }
        } else {
            drawn
        };
        let mut doubted = false;
        let mut file = |k: usize| -> Result<String> {
            let points = sampling.points(&bodies[k].0, &mut random);
            let lines: String = points.iter().map(|[x, z]| format!("{x:.6},{z:.6}\n")).collect();
            let name = format!("{k}.csv");
            std::fs::write(folder.path().join(&name), lines).unwrap();
            doubted |= !doubts_of_curve(&of_points("sample", &points, bodies[k].1, &upright())?).is_empty();
            Ok(format!("file = \"{name}\"\nunit = \"mm\"\nmirror = false\nflip_z = false"))
        };
        let (Ok(rail), Ok(wheel)) = (file(0), file(1)) else {
            refused += 1;
            continue;
        };
        if doubted {
            told += 1;
            continue;
        }
        let model = Standing { rail, wheel, folder: folder.path(), size: sampling.size, lateral };
        let [rail, wheel] = names.map(|name| format!("profile = \"{name}\""));
        let exact = Standing { rail, wheel, folder: folder.path(), size: 1.0, lateral };
        let (found, truth) = (model.answers()?, exact.answers()?);
        let pressure = [0, 1].map(|k| (found.0[k] / truth.0[k] - 1.0).abs()).into_iter().fold(0.0, f64::max);
        let conicity = (found.1 / truth.1 - 1.0).abs();
        worst = [worst[0].max(pressure), worst[1].max(conicity)];
        // NaN is neither.
        if !(pressure < PRESSURE && conicity < CONICITY) {
            wrong.push(format!("{number}: {names:?} {sampling:?} at {lateral}: {found:?} for {truth:?}"));
        }
    }
    println!("{scenes} pairs: {told} doubted, {refused} refused, others off by up to {worst:?}");
    assert!(wrong.is_empty(), "{} wrong: {wrong:#?}", wrong.len());
    assert!(told + refused < scenes, "{told} doubted, {refused} refused of {scenes}");
    Ok(())
}

#[test]
fn a_cutoff_that_takes_shape_is_doubted_and_the_record_says_why() -> Result<()> {
    let (mut random, rail) = (Random::new(5), standards::rail("60E1")?);
    let clean = Sampling { spacing: 0.2, size: 1.0, noise: 0.0 };
    let own = clean.measured(&rail, Side::Rail, &mut random, &upright())?;
    let curve = &own.record.curve;
    assert!(
        curve.cutoff_wavelength.unwrap() < 1.0 && curve.cutoff_because == Some("the noise of the points"),
        "{curve:?}"
    );
    assert!(doubts_of_curve(&own).is_empty(), "{:?}", own.record.warnings);
    let given = Options { cutoff_wavelength: Some(5.0), ..upright() };
    let given = clean.measured(&rail, Side::Rail, &mut random, &given)?;
    let curve = &given.record.curve;
    assert_eq!(
        (curve.cutoff_wavelength, curve.cutoff_because),
        (Some(5.0), Some("option `cutoff_wavelength`"))
    );
    let taken = curve.shape_taken.as_ref().expect("what 5 mm take of a gauge corner");
    assert!(taken.distance.abs() > 2e-3 && taken.point[0].abs() > 20.0, "{taken:?}");
    assert!(doubts_of_curve(&given)[0].found.contains("takes away shape"), "{:?}", given.record.warnings);
    // Under usual noise the customary cut-off wavelength stays.
    let noisy = Sampling { noise: 0.01, ..clean }.measured(&rail, Side::Rail, &mut random, &upright())?;
    assert_eq!(noisy.record.curve.cutoff_wavelength, Some(5.0));
    assert!(
        doubts_of_curve(&noisy)[0].found.contains("leaves the curvature uncertain by"),
        "{:?}",
        noisy.record.warnings
    );
    Ok(())
}

#[test]
fn noise_makes_no_corner_whatever_the_cutoff() -> Result<()> {
    let mut random = Random::new(2);
    let (mut read, mut corners) = (0, Vec::new());
    for number in 0..campaign::scenes() {
        let (exact, side) = body(&mut random)?;
        let noise = random.between(0.0, 0.05);
        let sampling = Sampling { noise, ..Sampling::random(&mut random) };
        let mut points = sampling.points(&exact, &mut random);
        // Two neighbours that are off, to either side.
        let at = 10 + random.below(points.len() - 20);
        for point in &mut points[at..at + 2] {
            point[1] += sampling.spacing * random.between(-0.5, 0.5);
        }
        let mut of_cutoffs = Vec::new();
        for cutoff in [None, Some(1.0), Some(5.0), Some(20.0)] {
            let options = Options { cutoff_wavelength: cutoff, ..upright() };
            let Ok(found) = of_points("sample", &points, side, &options) else { break };
            of_cutoffs.push(found.record.curve.corners);
        }
        read += of_cutoffs.len();
        assert!(of_cutoffs.windows(2).all(|pair| pair[0] == pair[1]), "{number}: {of_cutoffs:?}");
        // The chamfers of drawn wheels are corners.
        let drawn = |x: f64| {
            let near = |at: f64| (at * sampling.size - x).abs() < 0.5 + 2.0 * sampling.spacing;
            exact.continuity().iter().any(|joint| joint.kink.abs() > 0.4 && near(joint.x))
        };
        let found = of_cutoffs.into_iter().next().unwrap_or_default();
        if found.iter().any(|corner| !drawn(corner.point[0])) {
            corners.push(format!("{number}: {} {sampling:?}, off at {at}: {found:?}", exact.name));
        }
    }
    println!("{read} curves of {} samples, {} with a corner that is none", campaign::scenes(), corners.len());
    assert!(read > 0 && corners.is_empty(), "{corners:#?}");
    Ok(())
}

#[test]
fn an_isolated_kink_stays_a_corner_under_noise() -> Result<()> {
    let mut random = Random::new(30);
    for number in 0..campaign::scenes() {
        let degrees = *random.pick(&[5.0, 10.0, 30.0, 45.0]);
        let (kink, spacing) = (f64::to_radians(degrees), 0.1 * 10f64.powf(0.7 * random.uniform()));
        // A fifth of the noise under which a turn over 2.5 mm is no noise.
        let noise = random.uniform() * 0.2 * kink * 2.5 * (2.5 / spacing).sqrt() / 100.0;
        let place = random.between(-10.0, 10.0);
        let radius = random.between(80.0, 400.0);
        let points: Vec<[f64; 2]> = (0..(80.0 / spacing) as usize)
            .map(|k| spacing * k as f64 - 40.0)
            .map(|x| {
                [x, -x * x / (2.0 * radius) - (x - place).max(0.0) * kink.tan() + noise * random.normal()]
            })
            .collect();
        for cutoff in [None, Some(5.0), Some(15.0)] {
            let options = Options { kink_angle: Some(0.7 * kink), cutoff_wavelength: cutoff, ..upright() };
            let found = of_points("roof", &points, Side::Rail, &options)?;
            let corners = &found.record.curve.corners;
            let what =
                format!("{number}: {degrees}° at {place}, every {spacing}, noise {noise}: {corners:?}");
            assert_eq!(corners.len(), 1, "{what}");
            assert!((corners[0].point[0] - place).abs() < 0.5 + spacing, "{what}");
            assert!((corners[0].angle.abs() / kink - 1.0).abs() < 0.25, "{what}");
        }
    }
    Ok(())
}

#[test]
fn a_flange_back_that_the_wheel_does_not_have_is_doubted() -> Result<()> {
    let mut random = Random::new(70);
    let rail = standards::rail("60E1")?.rotated(inclination(1.0, 40.0)?);
    let mut told = 0;
    for number in 0..campaign::scenes() {
        let wheel = standards::wheel(random.pick::<&str>(&[
            "S1002",
            "EN15302-A",
            "EN15302-H",
            "EN13715-1:40-h28-e32.5",
        ]))?;
        let sampling = Sampling {
            spacing: random.between(0.1, 0.4),
            size: 1.0,
            noise: *random.pick(&[0.0, 0.005, 0.02]),
        };
        let moved = random.between(-12.0, 12.0);
        let measured = sampling.measured(&wheel.shifted(moved, 0.0), Side::Wheel, &mut random, &upright())?;
        let back = wheel.segments()[0].start().x + moved;
        let marks = Landmarks::new(&Pair::new(rail.clone(), measured.profile, 460.0)?);
        let off = *random.pick(&[0.0, 0.4, 1.4, 3.0, 8.0]) * random.pick(&[-1.0, 1.0]);
        let doubt = usual::flange_back_x(["flange_back_x", "wheel"], back + off, &marks);
        assert_eq!(
            doubt.is_some(),
            f64::abs(off) > 1.0,
            "{number}: {} moved by {moved}, {off}: {doubt:?}",
            wheel.name
        );
        told += u64::from(doubt.is_some());
    }
    assert!(told > 0 && told < campaign::scenes(), "{told} doubted");
    Ok(())
}

/// Runs a scene of `tests/defects/measured`.
fn defect(name: &str, change: [&str; 2]) -> Result<Run> {
    let folder = repository("tests/defects/measured");
    let text = std::fs::read_to_string(folder.join(name)).expect(name).replace(change[0], change[1]);
    let text = format!("{text}\n[output]\nformats = []");
    Run::new(scene::resolve(&scene::parse(&text, false)?, &folder, name)?, SILENT)
}

#[test]
fn a_rig_has_the_pressures_of_the_full_scale() -> Result<()> {
    let run = defect("scaled-rig.toml", ["", ""])?;
    let mut found: Vec<f64> = run
        .parts
        .iter()
        .filter_map(|part| Some(part.analysis.pressure.as_ref()?.largest.pressure_n_per_mm2))
        .collect();
    found.sort_by(f64::total_cmp);
    assert!(
        found.len() == 2 && (found[0] / 1465.0 - 1.0).abs() < 0.01 && (found[1] / 1781.0 - 1.0).abs() < 0.01,
        "{found:?}"
    );
    let warnings = run.warnings();
    assert!(
        !warnings.iter().any(|text| text.contains("takes away shape") || text.contains("uncertain")),
        "{warnings:?}"
    );
    // 5 mm of the user are kept, and doubted.
    let given =
        defect("scaled-rig.toml", ["radius = 92.0", "radius = 92.0\ncutoff_wavelength = 5.0"])?.warnings();
    assert!(given.iter().any(|text| text.contains("takes away shape")), "{given:?}");
    Ok(())
}

#[test]
fn a_wheel_measured_from_beside_its_tape_is_doubted() -> Result<()> {
    let doubts = |x: &str| -> Result<Vec<String>> {
        let run = defect("wheel-origin-5mm.toml", ["flange_back_x = -70.0", x])?;
        Ok(run.warnings().into_iter().filter(|text| text.contains("flange_back_x: ")).collect())
    };
    let found = doubts("flange_back_x = -70.0")?;
    assert!(
        found.len() == 1 && found[0].contains("-70 mm, and the back of wheel is at x = -75.0 mm"),
        "{found:?}"
    );
    assert_eq!(doubts("flange_back_x = -75.0")?, [""; 0]);
    Ok(())
}

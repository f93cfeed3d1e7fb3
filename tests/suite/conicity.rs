//! Equivalent conicities of random wheelsets against dense tables of Δr.

use wheelrail::nalgebra::UnitComplex;
use wheelrail::placement::{Track, Wheelset};
use wheelrail::profile::{Profile, inclination, standards};
use wheelrail::search::{SideOnTrack, TwoStep, geometry_over};
use wheelrail::{
    Conicity, Pair, Position, RailDistance, Roll, Selection, Sweep, WheelDistance, WheelsetOnTrack,
};

use super::campaign;

/// Accuracy that is promised unless a larger error is announced, relative.
const PROMISED: f64 = 1e-4;

/// Largest amplitude \[mm\], and the number of steps of the dense table up to there.
const AMPLITUDE: f64 = 8.0;
const STEPS: usize = 8000;

/// Amplitudes that are compared in every scene.
const COMPARED: usize = 40;

/// Δr at equal steps of y, straight between them.
struct Dense {
    step: f64,
    force: Vec<f64>,
    /// 2 ∫ Δr from 0 \[mm²\].
    energy: Vec<f64>,
}

impl Dense {
    /// Searches one position after the other, until the wheelset leaves its track.
    fn new(system: &WheelsetOnTrack) -> Self {
        let mut sweep = Sweep::new(system, Selection { within: 0.0, apart: 0.0 }, None);
        let (mut rows, mut force) = (Vec::new(), Vec::new());
        let step = AMPLITUDE / STEPS as f64;
        for k in 0..=STEPS {
            rows.clear();
            let position = Position { lateral: step * k as f64, yaw: 0.0, roll: Roll::Neglect };
            sweep.position(&position, &mut rows).expect("a position");
            let Some(row) = rows.first() else { break };
            force.push(row.delta_r);
        }
        Self::of(step, force)
    }

    fn of(step: f64, force: Vec<f64>) -> Self {
        let mut energy = vec![0.0; force.len()];
        for k in 1..force.len() {
            energy[k] = energy[k - 1] + step * (force[k] + force[k - 1]);
        }
        Self { step, force, energy }
    }

    fn every_other(&self) -> Self {
        Self::of(2.0 * self.step, self.force.iter().step_by(2).copied().collect())
    }

    /// tan γ_e = π²/8T² at the amplitude of an entry; `None` if the movement does not come back from there.
    fn conicity(&self, entry: usize) -> Option<f64> {
        let speed = |k: usize| {
            let square = self.energy[entry] - self.energy[k];
            (square > 0.0 || k == entry).then(|| square.sqrt())
        };
        let mut time = 0.0;
        for k in 0..entry {
            // Under a force with the stiffness g, tan(√g t/2) = √g · run/(v0 + v1).
            let mean = self.step / (speed(k)? + speed(k + 1)?);
            let square = (self.force[k + 1] - self.force[k]) / self.step * mean * mean;
            let root = square.abs().sqrt();
            time += match square {
                _ if root < 1e-3 => 2.0 * mean * (1.0 - square / 3.0),
                _ if square > 0.0 => 2.0 * mean * root.atan() / root,
                _ => 2.0 * mean * root.atanh() / root,
            };
        }
        Some(std::f64::consts::PI.powi(2) / (8.0 * time * time)).filter(|c| c.is_finite())
    }
}

/// Makes a wheelset of built-in profiles; `None` where the wheels do not fit the track.
fn system(rail: &str, run: f64, wheel: &str, gauge: f64) -> Option<(String, WheelsetOnTrack)> {
    let inclined: Profile =
        standards::rail(rail).expect("a rail").rotated(inclination(1.0, run).expect("a slope"));
    let pair = Pair::new(inclined, standards::wheel(wheel).expect("a wheel"), 460.0).expect("a pair");
    let rails = RailDistance::Gauge { gauge, height: 14.0 };
    let wheels = WheelDistance::BackToBack { distance: 1360.0, flange_back_x: -70.0 };
    let system = WheelsetOnTrack::new(&pair, rails, wheels).ok()?;
    Some((format!("{rail} 1:{run}, {wheel}, gauge {gauge}"), system))
}

/// A random wheelset.
fn random(state: &mut u64) -> (String, WheelsetOnTrack) {
    let mut next = |count: usize| {
        *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*state >> 33) as usize % count
    };
    let rails: Vec<_> = standards::rail_names().collect();
    let wheels: Vec<_> = standards::wheel_names().collect();
    loop {
        let (rail, wheel) = (rails[next(rails.len())], wheels[next(wheels.len())]);
        let run = [20.0, 30.0, 40.0][next(3)];
        let gauge = 1430.0 + 0.5 * next(21) as f64;
        if let Some(found) = system(rail, run, wheel, gauge) {
            return found;
        }
    }
}

#[test]
fn conicities_are_as_accurate_as_promised_or_announced() {
    let (mut state, mut compared, mut wrong, mut worst) = (5, 0, Vec::new(), 0f64);
    let scenes = campaign::scenes();
    for number in 0..=scenes {
        // The bends of this one all go one way.
        let known = system("UIC60", 40.0, "EN15302-C", 1437.0).filter(|_| number == 0);
        let (name, system) = known.unwrap_or_else(|| random(&mut state));
        let Ok(conicity) = Conicity::new(&system, AMPLITUDE, Roll::Neglect) else { continue };
        let fine = Dense::new(&system);
        let coarse = fine.every_other();
        for k in (1..=COMPARED).map(|k| k * STEPS / COMPARED - 50).filter(|k| *k < fine.force.len()) {
            let amplitude = fine.step * k as f64;
            let (Some(exact), Some(half), Ok(found)) =
                (fine.conicity(k), coarse.conicity(k / 2), conicity.at(amplitude))
            else {
                continue;
            };
            let off = (found.conicity / exact - 1.0).abs();
            // The table's own error, from its hops: that of half as many steps is twice as large.
            let own = 2.0 * (half / exact - 1.0).abs();
            if own > PROMISED / 10.0 {
                continue;
            }
            (compared, worst) = (compared + 1, worst.max(off));
            if off > found.error.max(PROMISED) + own {
                wrong.push(format!("{name} at {amplitude}: off by {off:e}, announced {:e}", found.error));
            }
        }
    }
    println!("{compared} conicities of {scenes} wheelsets, off by at most {worst:e}");
    assert!(wrong.is_empty(), "{} of {compared}: {wrong:#?}", wrong.len());
    assert!(compared as u64 > 10 * scenes, "{compared}");
}

/// Case of Annex E of EN 15302:2008+A1:2010 over rail A: right and left wheel, diameter of the left one \[mm\] beside one of 920, and
/// tan γ_e at 1, 2 … 7 mm, as a public benchmark program reproduces them to three digits.
type Case = (&'static str, &'static str, f64, [f64; 7]);

const ANNEX_E: [Case; 9] = [
    ("A", "A", 920.0, [0.125, 0.155, 0.188, 0.216, 0.254, 0.303, 0.505]),
    ("B", "B", 920.0, [0.025, 0.025, 0.058, 0.241, 0.283, 0.302, 0.485]),
    ("H", "H", 920.0, [0.025, 0.025, 0.245, 0.319, 0.306, 0.284, 0.437]),
    ("I", "I", 920.0, [0.0, 0.293, 0.489, 0.485, 0.475, 0.447, 0.486]),
    ("A", "A", 918.0, [0.280, 0.272, 0.261, 0.269, 0.307, 0.395, 0.492]),
    ("B", "B", 918.0, [0.660, 0.376, 0.278, 0.227, 0.295, 0.409, 0.478]),
    ("H", "H", 918.0, [0.712, 0.381, 0.270, 0.217, 0.275, 0.421, 0.443]),
    ("I", "I", 918.0, [0.780, 0.418, 0.449, 0.479, 0.458, 0.497, 0.564]),
    ("A", "B", 920.0, [0.137, 0.104, 0.132, 0.225, 0.271, 0.307, 0.493]),
];

/// Rail A: UIC 60 inclined by 1:20, 1500 mm apart as the wheels.
fn annex_e(right: &str, left: &str, diameter: f64) -> wheelrail::Result<WheelsetOnTrack> {
    let rail = standards::rail("UIC60")?.rotated(UnitComplex::new(0.05)).shifted(2.60264, 0.14155);
    let side = |wheel: &str, diameter: f64| {
        let pair = Pair::new(rail.clone(), standards::wheel(&format!("EN15302-{wheel}"))?, diameter / 2.0)?;
        let track = Track::new(&rail, RailDistance::Spacing(1500.0))?;
        SideOnTrack::new(&pair, track, Wheelset::new(WheelDistance::Spacing(1500.0), diameter / 2.0)?)
    };
    let right_side = side(right, 920.0)?;
    if right == left && diameter == 920.0 {
        return Ok(WheelsetOnTrack::symmetrical(right_side));
    }
    Ok(WheelsetOnTrack::of_sides(side(left, diameter)?, right_side))
}

/// Tolerance of Annex F.
fn tolerance(conicity: f64) -> f64 {
    f64::min(0.05, (0.5 * conicity).max(0.01))
}

/// Largest share of the tolerance by which the energy integral and the two-step integration may be off the table.
const HELD: [f64; 2] = [0.43, 0.09];

/// The one entry that the energy integral does not have: at 3 mm wheel B is just beyond a jump of Δr, which steps of 0.1 mm smear.
const SMEARED: (&str, &str, f64, f64) = ("B", "B", 920.0, 3.0);

/// Both integrations at 1, 2 … 7 mm; 0 where the movement does not come back, as the table has it for the cylinder of wheel I.
fn both_integrations(system: &WheelsetOnTrack) -> [[f64; 2]; 7] {
    let conicity = Conicity::new(system, 8.0, Roll::Neglect).expect("a table");
    let lateral: Vec<f64> = (-140..=140).map(|k| 0.1 * f64::from(k)).collect();
    let found = geometry_over(system, &lateral, Roll::Neglect).expect("positions");
    let on_track: Vec<_> = found.into_iter().flatten().collect();
    let (lateral, delta_r): (Vec<f64>, Vec<f64>) = on_track.iter().map(|at| (at.lateral, at.delta_r)).unzip();
    let two_step = TwoStep::new(&lateral, &delta_r).expect("a table");
    std::array::from_fn(|k| {
        let amplitude = 1.0 + k as f64;
        let energy = conicity.at(amplitude).map_or(0.0, |found| found.conicity);
        [energy, two_step.at(amplitude).unwrap_or(0.0)]
    })
}

#[test]
fn the_tables_of_annex_e_are_met_by_both_integrations() {
    let mut worst = [0f64; 2];
    let mut off = Vec::new();
    for (right, left, diameter, table) in ANNEX_E {
        let system = annex_e(right, left, diameter).expect("a wheelset");
        for ((amplitude, expected), found) in
            (1..=7).map(f64::from).zip(table).zip(both_integrations(&system))
        {
            let smeared = (right, left, diameter, amplitude) == SMEARED;
            for (which, (worst, held)) in worst.iter_mut().zip(HELD).enumerate() {
                let share = (found[which] - expected).abs() / tolerance(expected);
                let exception = smeared && which == 0;
                // An exception that is none any more has to go.
                if exception == (share <= held) {
                    off.push(format!(
                        "{right}/{left}/{diameter} at {amplitude} mm: {found:.4?}, not {expected}"
                    ));
                }
                *worst = if exception { *worst } else { worst.max(share) };
            }
        }
    }
    println!("off by at most {worst:.3?} of the tolerances");
    assert!(off.is_empty(), "{off:#?}");
}

/// Beside the jump the energy integral has the entry of the table: the jump lies within a step of it.
#[test]
fn the_smeared_entry_lies_between_the_conicities_beside_its_jump() {
    let (right, left, diameter, amplitude) = SMEARED;
    let system = annex_e(right, left, diameter).expect("a wheelset");
    let conicity = Conicity::new(&system, 8.0, Roll::Neglect).expect("a table");
    let [low, high] =
        [amplitude, amplitude + 0.1].map(|amplitude| conicity.at(amplitude).expect("a movement").conicity);
    assert!(low < 0.058 && 0.058 < high, "{low} {high}");
}

//! Equivalent conicities of random wheelsets against dense tables of Δr.

use wheelrail::profile::{Profile, inclination, standards};
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

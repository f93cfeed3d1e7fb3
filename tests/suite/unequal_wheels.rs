//! Equivalent conicities of wheels that differ, against a motion that the test integrates itself from single touches.

use wheelrail::case::{ConicityBasis, ConicityOptions, DoubtSet, Landmarks, SideLandmarks, contact_geometry};
use wheelrail::internal::Random;
use wheelrail::placement::{RailDistance, Track, WheelDistance, Wheelset};
use wheelrail::profile::{inclination, standards};
use wheelrail::search::SideOnTrack;
use wheelrail::{Conicity, ONE_CONTACT, Pair, Position, Result, Roll, Selection, Sweep, WheelsetOnTrack};

use super::campaign;

const RAILS: [&str; 5] = ["60E1", "54E1", "UIC60", "49E1", "60E2"];
const WHEELS: [&str; 7] =
    ["S1002", "EN15302-A", "EN15302-B", "EN15302-H", "EN15302-I", "EN13715-1:40-h28-e32.5", "cone-1:20"];
/// By how much the left wheel is smaller in radius \[mm\].
const SMALLER: [f64; 9] = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 1.0];
/// Amplitudes \[mm\] at which each is compared: 5 × 7 × 9 × 8 = 2520 values of the first 315 wheelsets.
const AMPLITUDES: [f64; 8] = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0];
const SYSTEMS: u64 = 315;

/// Step \[mm\] of the first touches of the test, how far to both sides they go, the largest change of Δr \[mm\] from one to the next, and the
/// width \[mm\] from which on a jump is left as it is.
const STEP: f64 = 0.02;
const REACH: i32 = 2000;
const CHANGE: f64 = 0.004;
const NARROWEST: f64 = 1e-7;

/// Accuracy that is promised unless a larger error is announced, relative.
const PROMISED: f64 = 1e-4;

/// Δr \[mm\] over displacements \[mm\], straight between them.
#[derive(Clone)]
struct Motion(Vec<[f64; 2]>);

impl Motion {
    /// Touches at equal steps, and between two of them while Δr changes by more than [`CHANGE`].
    fn new(system: &WheelsetOnTrack, roll: Roll) -> Self {
        let mut search = system.search();
        let mut touch = |lateral: f64| {
            let selection = Selection { within: 0.0, apart: 0.0 };
            let touch = search.touch(&Position { lateral, yaw: 0.0, roll }, &selection).ok()?;
            let [left, right] = touch.sides.map(|side| side.touch.contacts[0].rolling_radius);
            Some([lateral, right - left])
        };
        let mut outward = |sign: f64| {
            let mut known: Vec<[f64; 2]> = touch(0.0).into_iter().collect();
            for k in 1..=REACH {
                let Some(next) = touch(sign * STEP * f64::from(k)) else { break };
                let mut open = vec![next];
                while let (Some(&[from, low]), Some(&[to, high])) = (known.last(), open.last()) {
                    let middle = f64::midpoint(from, to);
                    let wide = (high - low).abs() > CHANGE && (to - from).abs() > NARROWEST;
                    match wide.then(|| touch(middle)).flatten() {
                        Some(between) => open.push(between),
                        None => known.extend(open.pop()),
                    }
                }
            }
            known
        };
        let (left, right) = (outward(-1.0), outward(1.0));
        Self(left.into_iter().skip(1).rev().chain(right).collect())
    }

    fn every_other(&self) -> Self {
        Self(self.0.iter().step_by(2).copied().collect())
    }

    /// The displacement nearest to 0 at which Δr grows through 0, as an entry of its own.
    fn with_centre(mut self) -> Option<(Self, usize)> {
        let crossing = |k: usize| {
            let [[a, low], [b, high]] = [self.0[k], self.0[k + 1]];
            (low <= 0.0 && high > 0.0).then(|| (k + 1, a - low * (b - a) / (high - low)))
        };
        let all = (0..self.0.len() - 1).filter_map(crossing);
        let (at, y) = all.min_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
        self.0.insert(at, [y, 0.0]);
        Some((self, at))
    }

    /// Goes outward from the centre to one side, with half the square of the speed there; returns the distance of the turning point and the
    /// time to it, 0 unless it is asked for; `None` if the wheelset leaves the table.
    fn outward(&self, centre: usize, energy: f64, sign: isize, timed: bool) -> Option<[f64; 2]> {
        let (mut k, mut left, mut time) = (centre, energy, 0.0);
        let [start, _] = self.0[centre];
        let mut cross = |run: f64, stiffness: f64, energies: [f64; 2]| {
            time += if timed { crossing(run, stiffness, energies) } else { 0.0 };
            time
        };
        loop {
            let next = k.checked_add_signed(sign)?;
            let ([y, from], [to, until]) = (self.0[k], *self.0.get(next)?);
            let width = (to - y).abs();
            let [from, until] = [from, until].map(|force| sign as f64 * force);
            let after = left - width * (from + until) / 2.0;
            let stiffness = (until - from) / width;
            let topped = from > 0.0 && until < 0.0 && left <= from * from / (-2.0 * stiffness);
            if after <= 0.0 || topped {
                let root = (from * from + 2.0 * stiffness * left).max(0.0).sqrt();
                let run = 2.0 * left / (from + root);
                return Some([(y - start).abs() + run, cross(run, stiffness, [left, 0.0])]);
            }
            cross(width, stiffness, [left, after]);
            (k, left) = (next, after);
        }
    }

    /// tan γ_e at an amplitude; `None` where no movement about the centre is so wide.
    fn conicity(&self, centre: usize, amplitude: f64) -> Option<f64> {
        let turns = |energy: f64, timed: bool| {
            let [left, right] = [-1, 1].map(|sign| self.outward(centre, energy, sign, timed));
            Some([left?, right?])
        };
        let (mut low, mut high) = (0.0, 1e3);
        for _ in 0..60 {
            let middle = f64::midpoint(low, high);
            let within =
                turns(middle, false).is_some_and(|[left, right]| left[0] + right[0] <= 2.0 * amplitude);
            if within { low = middle } else { high = middle }
        }
        let [left, right] = turns(low, true)?;
        let mean = (left[1] + right[1]) / 2.0;
        let whole = left[0] + right[0] > 2.0 * amplitude * (1.0 - 1e-6);
        whole.then(|| std::f64::consts::PI.powi(2) / (8.0 * mean * mean))
    }
}

/// Time over a run under a force of a stiffness, from one half square of the speed to another.
fn crossing(run: f64, stiffness: f64, energies: [f64; 2]) -> f64 {
    let [from, to] = energies.map(|energy| (2.0 * energy).sqrt());
    let mean = run / (from + to);
    let square = stiffness * mean * mean;
    let root = square.abs().sqrt();
    match square {
        _ if root < 1e-3 => 2.0 * mean * (1.0 - square / 3.0),
        _ if square > 0.0 => 2.0 * mean * root.atan() / root,
        _ => 2.0 * mean * root.min(1.0 - 1e-15).atanh() / root,
    }
}

/// A wheelset whose left wheel is smaller in radius, and perhaps another one.
struct Unequal {
    name: String,
    pairs: [Pair; 2],
    system: WheelsetOnTrack,
    roll: Roll,
}

impl Unequal {
    fn new([rail, left, right]: [&str; 3], [run, gauge, smaller]: [f64; 3], roll: Roll) -> Result<Self> {
        let rail_profile = standards::rail(rail)?.rotated(inclination(1.0, run)?);
        let pair =
            |wheel: &str, radius: f64| Pair::new(rail_profile.clone(), standards::wheel(wheel)?, radius);
        let pairs = [pair(left, 460.0 - smaller)?, pair(right, 460.0)?];
        let side = |pair: &Pair| {
            let track = Track::new(pair.rail(), RailDistance::Gauge { gauge, height: 14.0 })?;
            let wheels = WheelDistance::BackToBack { distance: 1360.0, flange_back_x: -70.0 };
            SideOnTrack::new(pair, track, Wheelset::new(wheels, pair.wheel_radius())?)
        };
        let system = WheelsetOnTrack::of_sides(side(&pairs[0])?, side(&pairs[1])?);
        let name = format!(
            "{rail} 1:{run}, {left} and {right}, gauge {gauge}, left smaller by {smaller} mm, {roll:?}"
        );
        Ok(Self { name, pairs, system, roll })
    }

    /// The first ones are all of the lists, in an order that mixes them; further ones are random.
    fn numbered(number: u64) -> Result<Self> {
        if number < SYSTEMS {
            let k = (number * 59 % SYSTEMS) as usize;
            let (rail, wheel, smaller) = (RAILS[k % 5], WHEELS[k / 5 % 7], SMALLER[k / 35]);
            let run = [20.0, 30.0, 40.0][(k % 5 + k / 5 % 7) % 3];
            return Self::new([rail, wheel, wheel], [run, 1435.0, smaller], Roll::Neglect);
        }
        let mut random = Random::stream(65, number);
        let names = [*random.pick(&RAILS), *random.pick(&WHEELS), *random.pick(&WHEELS)];
        let run = *random.pick(&[20.0, 30.0, 40.0]);
        let gauge = random.between(1430.0, 1442.0);
        let smaller = random.between(-1.2, 1.2);
        Self::new(names, [run, gauge, smaller], *random.pick(&[Roll::Neglect, Roll::Solve]))
    }
}

#[test]
fn conicities_of_unequal_wheels_are_those_of_their_motion() -> Result<()> {
    let [mut compared, mut skipped, mut refused, mut doubted] = [0; 4];
    let (mut wrong, mut worst) = (Vec::new(), 0f64);
    for number in 0..campaign::scenes() {
        let Unequal { name, pairs, system, roll } = Unequal::numbered(number)?;
        let table = Conicity::new(&system, 8.0, roll)?;
        let whole_track = Conicity::new(&system, 200.0, roll)?;
        let basis = ConicityBasis::new(&system, &table, roll)?;
        let [left, right] = pairs.each_ref().map(Landmarks::new);
        let landmarks = SideLandmarks::new(right, Some(left));
        let motion = Motion::new(&system, roll);
        let (Some((fine, centre)), Some((coarse, other))) =
            (motion.clone().with_centre(), motion.every_other().with_centre())
        else {
            wrong.extend(table.centre().map(|y| format!("{name}: a centre at {y}")));
            continue;
        };
        for amplitude in AMPLITUDES {
            let truths = [1.0 - 1e-3, 1.0, 1.0 + 1e-3].map(|share| fine.conicity(centre, share * amplitude));
            let alone = Conicity::new(&system, amplitude, roll)?.at(amplitude);
            let all = [table.at(amplitude), alone, whole_track.at(amplitude)];
            let (exact, all) = match (truths, all) {
                ([Some(_), Some(exact), Some(_)], [Ok(to_8), Ok(alone), Ok(whole)]) => {
                    (exact, [to_8, alone, whole])
                }
                ([None, None, None], [Err(_), Err(_), Err(_)]) => {
                    refused += 1;
                    continue;
                }
                ([Some(_), _, None] | [None, _, Some(_)] | [Some(_), None, Some(_)], ..) => {
                    skipped += 1;
                    continue;
                }
                (truths, all) => {
                    wrong.push(format!("{name} at {amplitude}: {truths:?}, found {all:?}"));
                    continue;
                }
            };
            let own = coarse.conicity(other, amplitude).map_or(1.0, |half| (half / exact - 1.0).abs());
            if own > 1e-3 {
                skipped += 1;
                continue;
            }
            compared += 1;
            for one in all {
                let off = (one.conicity / exact - 1.0).abs();
                worst = worst.max(off);
                if off > one.error.max(PROMISED) + 2.0 * own {
                    wrong.push(format!(
                        "{name} at {amplitude}: {exact}, off by {off:e}, {one:?}, own {own:e}"
                    ));
                }
            }
            let said = basis.doubts(&[amplitude], &landmarks, |_| 460.0);
            doubted += usize::from(said.iter().any(|said| said.contains("in two steps")));
        }
    }
    println!(
        "{compared} conicities off by at most {worst:e}; {refused} refused, {skipped} skipped, {doubted} doubted"
    );
    assert!(wrong.is_empty(), "{} of {compared}: {wrong:#?}", wrong.len());
    assert!(
        compared > 0 && skipped * 20 <= compared,
        "{skipped} of {compared} are not known to the test itself"
    );
    assert!(doubted * 100 <= compared + 100, "{doubted} right ones of {compared} are doubted");
    Ok(())
}

/// What `conicity` says of its displacements is what a sweep says of them, whatever wheel stands on whatever rail.
#[test]
fn doubts_of_conicity_are_those_of_a_sweep() -> Result<()> {
    let (mut random, mut doubtful) = (Random::new(66), 0);
    for _ in 0..campaign::scenes().min(300) {
        let gauge = random.between(1300.0, 1500.0);
        let names = [*random.pick(&RAILS), *random.pick(&WHEELS), *random.pick(&WHEELS)];
        let Ok(Unequal { name, pairs, system, roll }) =
            Unequal::new(names, [40.0, gauge, random.between(-1.0, 1.0)], Roll::Neglect)
        else {
            continue;
        };
        let [left, right] = pairs.each_ref().map(Landmarks::new);
        let landmarks = SideLandmarks::new(right, Some(left));
        let options = ConicityOptions { amplitude: 4.0, step: 0.5, gauges: Vec::new(), noise: None };
        let report = contact_geometry(&system, [&pairs[0], &pairs[1]], roll, &options, &|_| {})?;
        let mut sweep = Sweep::new(&system, Selection { within: 0.0, apart: ONE_CONTACT }, None);
        let (mut rows, mut counted) = (Vec::new(), 0);
        for (&lateral, found) in report.function("lateral_mm").iter().zip(&report.doubts) {
            rows.clear();
            sweep.position(&Position { lateral, yaw: 0.0, roll }, &mut rows)?;
            let sets = landmarks.of_rows(&rows).map(|(_, doubts)| doubts.kinds());
            let expected = sets.fold(DoubtSet::default(), DoubtSet::with);
            assert_eq!(*found, expected, "{name} at {lateral}");
            counted += usize::from(expected != DoubtSet::default());
        }
        let said = format!("doubts at {counted} of {} positions, in the column doubt", report.doubts.len());
        let has = report.findings.iter().any(|finding| finding.starts_with(&said));
        assert_eq!(has, counted > 0, "{name}: {:?}", report.findings);
        doubtful += usize::from(counted > 0);
    }
    assert!(doubtful > 2, "{doubtful}");
    Ok(())
}

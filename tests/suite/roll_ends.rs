//! Where the rows of a sweep lie on different branches of the roll, the sweep says where: against branches that the test follows itself.

use std::path::Path;

use wheelrail::case::{Arrangement, Case, RollEnds};
use wheelrail::internal::Random;
use wheelrail::profile::standards;
use wheelrail::scene;
use wheelrail::search::{ONE_CONTACT, ParallelSweep, WheelsetOnTrack, WheelsetSearch};
use wheelrail::{Position, Result, Roll, Selection};

use crate::campaign::seeds;

/// The lowest place of each side alone.
const LOWEST: Selection = Selection { within: 0.0, apart: ONE_CONTACT };

/// Longest and shortest step \[mm\] by which a branch is followed.
const STEPS: [f64; 2] = [0.02, 1e-6];

/// Farthest change of a roll \[rad\] over one step that is still the same branch.
const FARTHEST: f64 = 5e-5;

/// Height of the right wheel over the left one \[mm\] at a given roll.
fn difference(search: &mut WheelsetSearch<'_>, lateral: f64, yaw: f64, roll: f64) -> Option<f64> {
    let touch = search.touch(&Position { lateral, yaw, roll: Roll::Fixed(roll) }, &LOWEST).ok()?;
    Some(touch.sides[1].z - touch.sides[0].z)
}

/// The roll nearby at which the difference grows through 0, by halving.
fn root(search: &mut WheelsetSearch<'_>, lateral: f64, yaw: f64, near: f64) -> Option<f64> {
    let mut half = 1e-9;
    while half <= FARTHEST {
        let [mut low, mut high] = [near - half, near + half];
        if difference(search, lateral, yaw, low)? <= 0.0 && difference(search, lateral, yaw, high)? >= 0.0 {
            for _ in 0..60 {
                let middle = low + (high - low) / 2.0;
                if difference(search, lateral, yaw, middle)? < 0.0 { low = middle } else { high = middle }
            }
            return Some(low);
        }
        half *= 2.0;
    }
    None
}

/// The roll at another displacement on the branch of a roll, or the displacement at which it ends.
fn followed(
    search: &mut WheelsetSearch<'_>,
    [from, to]: [f64; 2],
    yaw: f64,
    mut roll: f64,
) -> std::result::Result<f64, f64> {
    let (mut at, mut step) = (from, STEPS[0]);
    while at != to {
        let next = if (to - at).abs() <= step { to } else { at + step.copysign(to - at) };
        match root(search, next, yaw, roll) {
            Some(found) => (at, roll, step) = (next, found, (2.0 * step).min(STEPS[0])),
            None if step <= STEPS[1] => return Err(at),
            None => step /= 2.0,
        }
    }
    Ok(roll)
}

fn system(case: &Case) -> &WheelsetOnTrack {
    match &case.setup().arrangement {
        Arrangement::Wheelset { system, .. } => system,
        _ => panic!("a wheelset"),
    }
}

/// A wheelset of built-in profiles whose left wheel is smaller: large wheels roll over on flanges of 70° already.
fn random_case(random: &mut Random) -> Result<Case> {
    let rails: Vec<&str> = standards::rail_names().collect();
    let wheels: Vec<&str> = standards::wheel_names().collect();
    let (rail, wheel) = (*random.pick(&rails), *random.pick(&wheels));
    let (radius, smaller) = (random.between(460.0, 660.0), random.between(0.0, 1.0));
    let text = format!(
        "rail = {{ profile = {rail:?}, rotate = \"1:40\" }}\nwheel = {{ profile = {wheel:?}, radius = {radius:?} }}\n\
         track = {{ gauge = 1435.0 }}\nwheelset = {{ back_to_back = 1360.0, flange_back_x = -70.0 }}\n\
         [left.wheel]\nprofile = {wheel:?}\nradius = {:?}\n",
        radius - smaller
    );
    scene::resolve(&scene::parse(&text, false)?, Path::new("."), &format!("{rail} under {wheel}"))
}

/// Displacements \[mm\] that the lines name.
fn named(lines: &[String]) -> Vec<f64> {
    let place = |line: &String| line.split_once(" mrad at ")?.1.split_once(" mm")?.0.parse().ok();
    lines.iter().filter_map(place).collect()
}

#[test]
fn a_sweep_says_where_its_branch_of_the_roll_ends() -> Result<()> {
    let (mut sweeps, mut pairs, mut ended, mut wrong) = (0, 0, 0, Vec::new());
    for seed in seeds() {
        let mut random = Random::stream(6520, seed);
        let Ok(case) = random_case(&mut random) else { continue };
        let (system, yaw) = (system(&case), *random.pick(&[0.0, 0.0, 0.004]));
        let step = *random.pick(&[0.1, 0.25, 0.5, 1.0]);
        let count = (3.0 / step) as u32;
        let from = *random.pick(&[-1.0, 1.0]) * random.between(3.0, 7.0);
        let positions: Vec<Position> = (0..=count)
            .map(|k| Position { lateral: from + step * f64::from(k), yaw, roll: Roll::Solve })
            .collect();
        let mut found = RollEnds::default();
        let mut rolls = vec![None; positions.len()];
        let sweep = ParallelSweep { system, selection: LOWEST, conicity: None, positions: &positions };
        sweep.blocks(
            |chunk: &mut (RollEnds, Vec<_>), number, rows| {
                chunk.0.add(&positions[number], rows);
                chunk.1.push((number, rows.first().map(|row| row.roll)));
                Ok(())
            },
            |_, chunks| {
                for (ends, own) in chunks {
                    found.join(&ends);
                    own.iter().for_each(|(number, roll)| rolls[*number] = *roll);
                }
                Ok(true)
            },
        )?;
        sweeps += 1;
        let lines = found.lines(system, || Ok(()))?;
        let named = named(&lines);
        let mut search = system.search();
        for (at, roll) in positions.windows(2).zip(rolls.windows(2)) {
            let ([a, b], [Some(own), Some(next)]) = ([at[0].lateral, at[1].lateral], [roll[0], roll[1]])
            else {
                continue;
            };
            pairs += 1;
            let what = format!("{seed}: {a} to {b} mm, yaw {yaw}, rolls {own} {next}: {lines:?}");
            let between: Vec<f64> = named.iter().copied().filter(|at| (a..=b).contains(at)).collect();
            let ways = [followed(&mut search, [a, b], yaw, own), followed(&mut search, [b, a], yaw, next)];
            // From either side the branch may go on beyond the end of the other one, to a roll that no search finds.
            let same = [(ways[0], next), (ways[1], own)]
                .iter()
                .all(|(way, roll)| way.is_ok_and(|way| (way - roll).abs() < 1e-8));
            if same {
                wrong.extend((!between.is_empty()).then(|| format!("one branch: {what}")));
                continue;
            }
            ended += 1;
            let there = match (ways, &between[..]) {
                (_, []) => false,
                ([Err(end), Err(begin)], [at]) => (end - at).abs() < 1e-4 || (begin - at).abs() < 1e-4,
                _ => true,
            };
            wrong.extend((!there).then(|| format!("two branches: {what} {ways:?}")));
        }
    }
    println!("{sweeps} sweeps, {pairs} pairs of neighbours, {ended} on different branches");
    assert!(wrong.is_empty(), "{} wrong:\n{}", wrong.len(), wrong.join("\n"));
    assert!(pairs > 2 * sweeps && (ended > 0 || sweeps < 20), "{pairs} {ended}");
    Ok(())
}

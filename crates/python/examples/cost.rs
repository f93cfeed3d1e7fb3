//! What a grid and a sweep take in Rust, for `benches/cost.py`: a line of JSON.
//!
//!     PYO3_BUILD_EXTENSION_MODULE=1 cargo run --release -p wheelrail-python --example cost
#![allow(clippy::print_stdout, reason = "its line of JSON is what it is for")]

use std::hint::black_box;
use std::time::Instant;

use wheelrail::case::{DoubtSet, SweepColumns};
use wheelrail::search::ONE_CONTACT;
use wheelrail::search::ParallelSweep;
use wheelrail::separation::{EtaAxis, plan};
use wheelrail::{
    Pair, Position, RailDistance, Roll, Selection, WheelDistance, WheelsetOnTrack, inclination, standards,
};

/// Times that the grid is filled; the median counts.
const GRIDS: usize = 501;
/// Positions of the sweep, and times that it runs; the fastest counts.
const SWEEP: (usize, usize) = (1_000_000, 3);

fn main() -> wheelrail::Result<()> {
    let rail = standards::rail("60E1")?.rotated(inclination(1.0, 40.0)?);
    let pair = Pair::new(rail, standards::wheel("S1002")?, 460.0)?;
    let rails = RailDistance::Gauge { gauge: 1435.0, height: 14.0 };
    let wheels = WheelDistance::BackToBack { distance: 1360.0, flange_back_x: -70.0 };
    let system = WheelsetOnTrack::new(&pair, rails, wheels)?;
    println!("{{\"grid_us\": {}, \"sweep_s\": {}}}", grid(&pair)?, sweep(&system)?);
    Ok(())
}

/// Gives the microseconds of a grid of 200 × 200 points at all digits, planned and filled.
fn grid(pair: &Pair) -> wheelrail::Result<f64> {
    let placement = pair.placed(0.0, 0.0, 0.0)?;
    let axis = |half: f64| (0..200).map(|k| half * (f64::from(k) / 99.5 - 1.0)).collect::<Vec<f64>>();
    let (xi, eta) = (axis(12.0), axis(10.0));
    let mut times: Vec<f64> = (0..GRIDS)
        .map(|_| {
            let start = Instant::now();
            let axis = EtaAxis::new(&eta);
            let mut values = vec![0.0; xi.len() * axis.eta().len()];
            plan(&placement, &xi, &axis, 1e-12, None).fill(&placement, &xi, &axis, &mut values);
            black_box(&values);
            1e6 * start.elapsed().as_secs_f64()
        })
        .collect();
    times.sort_by(f64::total_cmp);
    Ok(times[GRIDS / 2])
}

/// Gives the seconds of a sweep, all columns, without conicity.
fn sweep(system: &WheelsetOnTrack) -> wheelrail::Result<f64> {
    let (count, repeats) = SWEEP;
    let mut fastest = f64::INFINITY;
    for _ in 0..repeats {
        let start = Instant::now();
        let lateral = |k: usize| -8.0 + 16.0 * k as f64 / (count - 1) as f64;
        let positions: Vec<Position> =
            (0..count).map(|k| Position { lateral: lateral(k), yaw: 0.0, roll: Roll::Solve }).collect();
        let selection = Selection { within: 0.0, apart: ONE_CONTACT };
        let mut all = SweepColumns::default();
        all.reserve(2 * count);
        ParallelSweep { system, selection, conicity: None, positions: &positions }.blocks(
            |chunk: &mut SweepColumns, number, rows| {
                rows.iter().for_each(|row| chunk.push(number, row, None, DoubtSet::default()));
                Ok(())
            },
            |_, chunks| {
                chunks.iter().for_each(|chunk| all.extend(chunk));
                Ok(true)
            },
        )?;
        black_box(&all);
        fastest = fastest.min(start.elapsed().as_secs_f64());
    }
    Ok(fastest)
}

//! Positions per second of a sweep on one core: `cargo run --release --example sweep_speed`.
#![allow(clippy::print_stdout)]

use std::time::Instant;

use wheelrail::Result;
use wheelrail::contact::search::Selection;
use wheelrail::contact::search::wheelset::{Position, Roll, WheelsetOnTrack};
use wheelrail::contact::sweep::{Conicity, Sweep};
use wheelrail::placement::Pair;
use wheelrail::placement::track::{RailDistance, WheelDistance};
use wheelrail::profile::standards;

const POSITIONS: u32 = 20_000;

fn system(wheel: &str) -> Result<WheelsetOnTrack> {
    let norm = 40f64.hypot(1.0);
    let rail = standards::rail("60E1")?.rotated(40.0 / norm, norm.recip());
    let backs = WheelDistance::BackToBack { distance: 1360.0, flange_back_x: -70.0 };
    let pair = Pair::new(rail, standards::wheel(wheel)?, 460.0)?;
    WheelsetOnTrack::new(&pair, RailDistance::Gauge { gauge: 1435.0, height: 14.0 }, backs)
}

/// Time on the processor where the system tells it, else on the wall: other work on the machine then does not count.
struct Clock(Instant, Option<f64>);

impl Clock {
    fn start() -> Self {
        Self(Instant::now(), on_processor())
    }

    fn seconds(&self) -> f64 {
        let on_processor = on_processor().zip(self.1).map(|(end, start)| end - start);
        on_processor.unwrap_or_else(|| self.0.elapsed().as_secs_f64())
    }
}

fn on_processor() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/self/schedstat").ok()?;
    Some(text.split_whitespace().next()?.parse::<f64>().ok()? * 1e-9)
}

fn main() -> Result<()> {
    println!("{:<16} {:>8} {:>9} {:>9} {:>14}", "wheel", "yaw", "roll", "conicity", "positions/s");
    for wheel in ["EN15302-A", "S1002-arcs-1um", "S1002"] {
        let system = system(wheel)?;
        for (yaw, roll) in
            [(0.0, Roll::Neglect), (0.0, Roll::Solve), (2e-3, Roll::Neglect), (2e-3, Roll::Solve)]
        {
            for with_conicity in [false, true] {
                let conicity =
                    with_conicity.then(|| Conicity::new(&system, 10.0, Roll::Neglect)).transpose()?;
                let mut sweep = Sweep::new(&system, Selection { within: 0.0, apart: 0.0 }, conicity.as_ref());
                let mut rows = Vec::new();
                let start = Clock::start();
                let mut sum = 0.0;
                for k in 0..POSITIONS {
                    let lateral = -10.0 + 20.0 * f64::from(k) / f64::from(POSITIONS);
                    rows.clear();
                    sweep.position(&Position { lateral, yaw: yaw * lateral, roll }, &mut rows)?;
                    sum += rows.iter().map(|row| row.z).sum::<f64>();
                }
                let rate = f64::from(POSITIONS) / start.seconds();
                let solved = if roll == Roll::Solve { "solved" } else { "none" };
                println!("{wheel:<16} {yaw:>8} {solved:>9} {with_conicity:>9} {rate:>14.0}   ({sum:.6})");
            }
        }
    }
    Ok(())
}

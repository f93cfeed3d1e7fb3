//! Positions per second of a sweep on one core: `cargo run --release -p wheelrail-report --example sweep_speed`.
//!
//! The rows of the report's table, without the rest of the report.
#![allow(clippy::print_stdout)]

use wheelrail::Result;
use wheelrail_report::rates::{Extent, rates};

/// Time each sweep gets at least \[s\].
const SECONDS: f64 = 0.25;

fn main() -> Result<()> {
    println!(
        "{:<40} {:<18} {:>12} {:>11} {:>9} {:>9}",
        "pair", "motion", "positions/s", "table, s", "searches", "error"
    );
    for row in rates(&Extent::full(), SECONDS)? {
        println!(
            "{:<40} {:<18} {:>12.0} {:>11.4} {:>9} {:>9.0e}",
            row.pair,
            row.motion.name(),
            row.rate(),
            row.table_seconds,
            row.searches,
            row.conicity_error
        );
    }
    Ok(())
}

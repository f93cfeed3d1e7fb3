//! Runs one stage of a whole case, or a sweep, as often as it is told: what `.ci/instructions` counts the instructions of.
//!
//!     stages "measured, yawed" patch 10
//!     stages measured "roll solved" 1000

use std::env;
use std::error::Error;

use wheelrail_report::rates::{Freedoms, sweep};
use wheelrail_report::whole_case::{CASES, PARTS, with_parts};

/// Points of the grid along ξ and η.
const SIDE: usize = 200;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [case, stage, times] = arguments.as_slice() else { return Err("expected CASE STAGE TIMES".into()) };
    let times: usize = times.parse()?;
    if !CASES.contains(&case.as_str()) {
        return Err(format!("expected one of {CASES:?}").into());
    }
    if PARTS.contains(&stage.as_str()) {
        return Ok(with_parts(case, SIDE, |run| (0..times).for_each(|_| run(stage)))?);
    }
    let motion = Freedoms::ALL.into_iter().find(|motion| motion.name() == stage);
    Ok(sweep(case == "measured", motion.ok_or("expected a part of a case or a sweep's motion")?, times)?)
}

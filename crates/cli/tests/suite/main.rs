//! The tests of the program and what other programs make of its files, in one binary: each binary links the whole library.
#![allow(
    clippy::expect_used,
    clippy::unwrap_used,
    clippy::panic,
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "tests stop at the first surprise and say what they saw"
)]

// Modules of the program that have tests of their own. The program uses more of them.
#[path = "../../src/answer.rs"]
#[allow(dead_code)]
mod answer;
#[path = "../../src/sweep/conicity.rs"]
#[allow(dead_code)]
mod conicity;
#[path = "../../src/png.rs"]
#[allow(dead_code)]
mod png;
#[path = "../../src/sweep/positions.rs"]
#[allow(dead_code)]
mod positions;
#[path = "../../src/progress.rs"]
#[allow(dead_code)]
mod progress;
#[path = "../../src/range.rs"]
#[allow(dead_code)]
mod range;
#[path = "../../src/report/splice.rs"]
#[allow(dead_code)]
mod splice;

mod absurd;
mod answers;
#[path = "../../../../tests/suite/campaign.rs"]
mod campaign;
mod clients;
mod clients_runs;
mod conformal_table;
mod conicity_cli;
mod doubts_cli;
mod fleet_cli;
mod hostile;
#[path = "../../../../tests/suite/in_time.rs"]
mod in_time;
mod load_table;
mod manual;
mod march_cli;
mod measure_cli;
mod measured_cli;
mod pages;
mod profile_cli;
mod programs;
mod run_cli;
mod sweep_cli;
mod table_cli;
#[path = "../../../../tests/suite/whole_rails.rs"]
mod whole_rails;

//! How far apart are rail and wheel around a contact point?
//!
//!     cargo run --release --example 01_separation
#![allow(clippy::print_stdout)]

use wheelrail::placement::Pair;
use wheelrail::profile::standards;
use wheelrail::separation::Evaluator;

fn main() -> wheelrail::Result<()> {
    let rail = standards::rail("60E1")?;
    let wheel = standards::wheel("S1002")?;
    let placement = Pair::new(rail, wheel, 460.0)?.placed(-2.5, 1.5, 0.0)?;
    let mut evaluator = Evaluator::new(&placement);
    for xi in [-6.0, -3.0, 0.0, 3.0, 6.0] {
        let row = [0.0, 2.0, 6.0].map(|eta| format!("{:.6e}", evaluator.separation(xi, eta)));
        println!("xi = {xi:4} mm: s = {} mm at eta = 0, 2, 6 mm", row.join(", "));
    }
    Ok(())
}

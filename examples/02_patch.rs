//! Which patch does an approach of 0.05 mm cut out, and how large is it?
//!
//!     cargo run --release --example 02_patch
#![allow(clippy::print_stdout)]

use wheelrail::Interval;
use wheelrail::load::feasibility;
use wheelrail::patch::{Patch, Window};
use wheelrail::placement::Pair;
use wheelrail::profile::standards;

fn main() -> wheelrail::Result<()> {
    let pair = Pair::new(standards::rail("60E1")?, standards::wheel("cone-1:20")?, 460.0)?;
    let placement = pair.placed(-14.0, 0.0, 0.0)?;
    if let Some(feasibility) = feasibility(&placement) {
        println!("feasible: {}", feasibility.feasible);
    }
    let window = Window { xi: Interval::symmetric(15.0), eta: Interval::symmetric(15.0) };
    for component in Patch::new(&placement, 0.05, &window).components {
        println!("xi from {:.4} to {:.4} mm", component.xi[0], component.xi[1]);
        println!("area {:.6} mm2, perimeter {:.6} mm", component.area, component.perimeter);
        println!("{} boundary points, deepest s = {:.6} mm", component.boundary.len(), component.deepest[0]);
    }
    Ok(())
}

//! At which lateral displacement does a wheelset touch with tread and flange at once?
//!
//!     cargo run --release --example 04_two_point_contact
#![allow(clippy::print_stdout)]

use wheelrail::placement::{Pair, RailDistance, WheelDistance};
use wheelrail::profile::{inclination, standards};
use wheelrail::search::{Position, Roll, Selection, WheelsetOnTrack};

fn main() -> wheelrail::Result<()> {
    let rail = standards::rail("60E1")?.rotated(inclination(1.0, 40.0)?);
    let pair = Pair::new(rail, standards::wheel("S1002")?, 460.0)?;
    let backs = WheelDistance::BackToBack { distance: 1360.0, flange_back_x: -70.0 };
    let system = WheelsetOnTrack::new(&pair, RailDistance::Gauge { gauge: 1435.0, height: 14.0 }, backs)?;
    let mut search = system.search();
    let selection = Selection { within: 0.02, apart: 2.0 };
    for step in 0..=80 {
        let lateral = 0.1 * f64::from(step);
        let position = Position { lateral, yaw: 0.0, roll: Roll::Solve };
        let touch = search.touch(&position, &selection)?;
        let right = touch.sides[1].touch.contacts;
        if right.len() > 1 {
            println!("y = {lateral:.1} mm:");
            for contact in right {
                let placement = contact.placed(&pair)?;
                println!(
                    "  rail x = {:8.3}, wheel x = {:8.3} mm, angle {:5.1} deg, gap {:.4} mm, rolling radius {:.3} mm",
                    contact.rail_x,
                    contact.wheel_x,
                    placement.rail().contact_angle().to_degrees(),
                    contact.gap,
                    placement.rolling_radius()
                );
            }
        }
    }
    Ok(())
}

//! The motion of a wheelset: what belongs to it depends on no frame.

use std::path::Path;

use crate::campaign;
use wheelrail::Result;
use wheelrail::case::{Run, SILENT};
use wheelrail::internal::Random;
use wheelrail::scene;

/// Runs a scene in a frame, and gives the rates of pitch of all its parts \[rad/s\].
fn pitches(scene: &str, frame: &str) -> Result<Vec<f64>> {
    let text = format!(
        "{scene}frame = \"{frame}\"\n[motion]\nspeed = 30.0\n[grid]\nxi = {{ from = -1.0, to = 1.0, n = 3 }}\n\
         eta = {{ from = -1.0, to = 1.0, n = 3 }}\n"
    );
    let run = Run::new(scene::resolve(&scene::parse(&text, false)?, Path::new("."), "motion")?, SILENT)?;
    run.parts.iter().map(|part| Ok(run.creepages(part)?.expect("a motion").pitch)).collect()
}

#[test]
fn the_rolling_pitch_is_the_wheelsets_in_every_frame() -> Result<()> {
    let mut random = Random::new(30);
    let mut moved = 0;
    for number in 0..campaign::scenes() {
        let (rail, wheel) = (random.pick(&["60E1", "56E1", "49E1"]), random.pick(&["S1002", "EN15302-A"]));
        let lateral = random.between(-4.0, 4.0);
        let place = match number % 3 {
            0 => format!(
                "[track]\ngauge = 1435.0\n[wheelset]\nback_to_back = 1360.0\nflange_back_x = -70.0\nlateral = {lateral}\n"
            ),
            1 => format!("[contact]\noffset = {lateral}\n"),
            _ => {
                let x = random.between(-5.0, 15.0);
                format!("[contact]\nrail_x = {x}\nwheel_x = {}\n", x + random.between(-1.0, 1.0))
            }
        };
        let scene = format!(
            "[rail]\nprofile = \"{rail}\"\nrotate = \"1:40\"\n[wheel]\nprofile = \"{wheel}\"\nradius = 460.0\n{place}\
             [patch]\napproach = {}\n",
            random.between(0.01, 0.3)
        );
        let [plain, weighted] = ["contact", "weighted"].map(|frame| pitches(&scene, frame));
        let (plain, weighted) = (plain?, weighted?);
        // Parts of one wheelset turn alike.
        for pitch in plain.iter().chain(&weighted) {
            assert_eq!(*pitch, plain[0], "scene {number}:\n{scene}");
        }
        moved += usize::from(plain[0] != -30_000.0 / 460.0);
    }
    assert!(moved > 10, "{moved} rolling radii other than R");
    Ok(())
}

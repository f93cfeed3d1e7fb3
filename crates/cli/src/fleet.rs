//! `wheelrail fleet`: every wheelset on every rail section, as a table, a summary and pages.

use std::path::PathBuf;
use std::time::Instant;

use super::progress::Progress;
use crate::answer::{Outcome, complain, counted, folder_of};
use wheelrail::error::Result;
use wheelrail::fleet::Fleet;
use wheelrail::scene;

/// The scene, what the fleet consists of, and the folder.
#[derive(Debug, clap::Args)]
pub(super) struct FleetArguments {
    /// Scene file with what all pairs share: [track], [wheelset], radius, options of measured files.
    scene: PathBuf,
    /// Folder in which each file is both wheels of a wheelset, or a CSV file with the columns wheelset, left, right and perhaps
    /// `radius_left_mm`, `radius_right_mm`, `rail_left`, `rail_right`.
    #[arg(long, value_name = "DIR|CSV")]
    wheels: PathBuf,
    /// Folder of rail sections, a file, or a built-in name; if not given, the rails of the CSV file, or the scene's.
    #[arg(long, value_name = "DIR|NAME")]
    rails: Option<String>,
    /// Folder to write. A run that was stopped is taken up again there.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

/// Runs a fleet. The exit code is 1 if no pair has an equivalent conicity.
///
/// # Errors
/// A wrong scene or list; the disk. What is wrong with a profile is in its row.
pub(super) fn fleet(arguments: &FleetArguments) -> Result<Outcome> {
    let progress = Progress::of("fleet", "list");
    let path = arguments.scene.as_path();
    let scene = scene::load(path)?;
    scene::doubts_of_keys(&scene).iter().for_each(|doubt| complain(&format!("warning: {doubt}")));
    let fleet = Fleet::new(scene, folder_of(path), &arguments.wheels, arguments.rails.as_deref())?;
    let start = Instant::now();
    let tell = |done: usize, all: usize| {
        let rate = done as f64 / start.elapsed().as_secs_f64();
        progress.share(format!("{done} of {all} pairs, {rate:.0} a second"), done as f64 / all as f64);
        Ok(())
    };
    let outcome = fleet.run(&arguments.out, &tell)?;
    drop(progress);
    if outcome.kept > 0 {
        complain(&format!("fleet: {} were there", counted(outcome.kept, "part")));
    }
    if outcome.changed > 0 {
        let parts = counted(outcome.changed, "part");
        complain(&format!("fleet: {parts} computed again: scene, list or files have changed"));
    }
    if outcome.with_finding > 0 {
        complain(&format!(
            "fleet: findings at {} of {}",
            outcome.with_finding,
            counted(outcome.pairs, "pair")
        ));
    }
    Ok(if outcome.with_conicity > 0 { Outcome::Done } else { Outcome::No })
}

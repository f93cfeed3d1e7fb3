//! `wheelrail sweep`: the contact geometry of a wheelset at many positions, as CSV, and with files of
//! every patch.

mod curves;
mod patches;
mod positions;
mod table;

use std::path::{Path, PathBuf};
use std::time::Duration;

use super::{Outcome, folder_of, print};
use crate::contact::hertz::effective_modulus;
use crate::contact::search::wheelset::{Position, Roll, WheelsetOnTrack};
use crate::contact::search::{ONE_CONTACT, Selection};
use crate::contact::sweep::Conicity;
use crate::error::{Error, Result};
use crate::export::write_file;
use crate::run::question;
use crate::scene::{self, Place, Scene};
use positions::{lateral_range, read_positions};
use table::Table;

/// Silence on stderr after which progress is reported.
const PATIENCE: Duration = Duration::from_secs(2);

/// What to sweep over and where to write.
#[derive(Debug, clap::Args)]
pub(super) struct SweepArguments {
    /// Scene file with [track] and [wheelset].
    scene: PathBuf,
    /// Lateral displacements FROM:TO:STEP, mm; yaw and roll as in the scene.
    #[arg(long, value_name = "FROM:TO:STEP", allow_hyphen_values = true)]
    lateral: Option<String>,
    /// CSV file with columns `lateral_mm`, `yaw_rad`, `roll_rad`; an empty roll is solved.
    #[arg(long, value_name = "FILE.csv", conflicts_with = "lateral")]
    positions: Option<PathBuf>,
    /// File to write; by default stdout.
    #[arg(long, value_name = "FILE.csv")]
    out: Option<PathBuf>,
    /// Besides, for every position the files that `run` writes, as subfolders, and `surface.pvd` over all of them.
    #[arg(long, value_name = "DIR")]
    patches: Option<PathBuf>,
    /// Besides, the usual curves over the lateral displacement, as SVG, or as PNG where the name ends so.
    #[arg(long, value_name = "FILE.svg")]
    picture: Option<PathBuf>,
}

/// Runs the sweep.
pub(super) fn sweep(arguments: &SweepArguments) -> Result<Outcome> {
    let scene = scene::load(&arguments.scene)?;
    let (system, template, within) =
        system(&scene, folder_of(&arguments.scene)).map_err(|e| e.within(arguments.scene.display()))?;
    let positions = match (&arguments.lateral, &arguments.positions) {
        (Some(range), None) => {
            let lateral = lateral_range(range)?;
            lateral.into_iter().map(|lateral| Position { lateral, ..template }).collect()
        }
        (None, Some(file)) => read_positions(file)?,
        _ => {
            let expected = "either --lateral FROM:TO:STEP or --positions FILE.csv";
            return Err(Error::new("sweep", "neither", expected, "say what to sweep over"));
        }
    };
    let amplitude = positions.iter().fold(0.0, |most: f64, p| most.max(p.lateral.abs()));
    let conicity = match template.roll {
        Roll::Fixed(_) => None,
        _ if amplitude == 0.0 => None,
        roll => Some(Conicity::new(&system, amplitude, roll)?),
    };
    let asked = question(&scene).map_err(|e| e.within(arguments.scene.display()))?;
    let [rail, wheel] = &asked.material;
    let ellipses = asked.approach.map(|approach| (approach, effective_modulus(rail, wheel)));
    let selection = Selection { within, apart: ONE_CONTACT };
    let table = Table { system, conicity, selection, positions, ellipses };
    if let Some(dir) = &arguments.patches {
        patches::write(dir, &scene, &arguments.scene, &table)?;
    }
    if let Some(file) = &arguments.picture {
        let name = arguments.scene.file_stem().unwrap_or_default().to_string_lossy();
        let title = scene.title.as_deref().unwrap_or(&name);
        let picture = curves::picture(&table, title)?;
        let png = file.extension().is_some_and(|e| e.eq_ignore_ascii_case("png"));
        write_file(file, &if png { picture.png()? } else { picture.svg().into_bytes() })?;
    }
    match &arguments.out {
        None => table.blocks(0, |_, text| print(text).map(|_| ())),
        Some(out) => table.write(out),
    }
}

/// The wheelset and track of a scene, its own position, and how far near misses are reported.
fn system(scene: &Scene, folder: &Path) -> Result<(WheelsetOnTrack, Position, f64)> {
    let standing = scene.standing()?;
    let Place::Wheelset { rails, wheels, position } = standing.place else {
        let expected = "[track] and [wheelset]";
        return Err(Error::new("", "a single wheel", expected, "a sweep moves a wheelset over its track"));
    };
    let pair = scene.pair(folder)?;
    Ok((WheelsetOnTrack::new(&pair, rails, wheels)?, position, standing.within))
}

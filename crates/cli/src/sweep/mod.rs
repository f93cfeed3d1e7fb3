//! `wheelrail sweep`: the contact geometry of a wheelset at many positions, as CSV, and with files of
//! every patch.

mod conicity;
mod curves;
mod patches;
mod positions;
mod table;

use std::path::PathBuf;

use super::output::{PictureFormat, refuse_taken};
use super::progress::Progress;
use super::{Outcome, complain, folder_of, print_to_reader};
use positions::{lateral_range, read_positions};
use table::Table;
use wheelrail::case::question;
use wheelrail::error::{Error, Result};
use wheelrail::export::write_file;
use wheelrail::load::hertz::effective_modulus;
use wheelrail::placement::Pair;
use wheelrail::scene::{self, Place, Scene};
use wheelrail::search::wheelset::{Position, WheelsetOnTrack};
use wheelrail::search::{ONE_CONTACT, Selection};

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

impl SweepArguments {
    /// Complains of outputs before an hour's work: a picture of no known format, a file that is read or written twice.
    fn check_outputs(&self, scene: &Scene) -> Result<()> {
        if let Some(file) = &self.picture {
            PictureFormat::of_file("--picture", file)?;
        }
        let folder = folder_of(&self.scene);
        let profiles =
            [&scene.rail.file, &scene.wheel.file].into_iter().flatten().map(|file| folder.join(file));
        let mut taken: Vec<PathBuf> =
            profiles.chain(self.positions.clone()).chain([self.scene.clone()]).collect();
        for (option, file) in [("--out", &self.out), ("--picture", &self.picture)] {
            let Some(file) = file else { continue };
            refuse_taken(option, file, &taken)?;
            taken.push(file.clone());
        }
        Ok(())
    }
}

/// Runs the sweep.
pub(super) fn sweep(arguments: &SweepArguments) -> Result<Outcome> {
    let progress = Progress::of("sweep", "scene");
    let scene = scene::load(&arguments.scene)?;
    arguments.check_outputs(&scene)?;
    let in_scene = |error: Error| error.within(arguments.scene.display());
    let profiles = scene.pair_and_records(folder_of(&arguments.scene)).map_err(in_scene)?;
    let (system, template, within) = system(&scene, &profiles.0).map_err(in_scene)?;
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
    let conicity = conicity::conicity(&system, &positions, &progress)?;
    for remark in conicity.iter().flat_map(|conicity| conicity::remarks(conicity, &positions)) {
        complain(&format!("sweep: {remark}"));
    }
    let asked = question(&scene).map_err(in_scene)?;
    let [rail, wheel] = &asked.material;
    let ellipses = asked.approach.map(|approach| (approach, effective_modulus(rail, wheel)));
    let selection = Selection { within, apart: ONE_CONTACT };
    let table = Table { system, conicity, selection, positions, ellipses };
    if let Some(dir) = &arguments.patches {
        patches::write(
            dir,
            &patches::Origin { scene: &scene, path: &arguments.scene, profiles: &profiles },
            &table,
            &progress,
        )?;
    }
    if let Some(file) = &arguments.picture {
        progress.at("picture");
        let name = arguments.scene.file_stem().unwrap_or_default().to_string_lossy();
        let title = scene.title.as_deref().unwrap_or(&name);
        let picture = curves::picture(&table, title)?;
        let bytes = match PictureFormat::of_file("--picture", file)? {
            PictureFormat::Png => picture.png().map_err(|error| error.within(file.display()))?,
            PictureFormat::Svg => picture.svg().into_bytes(),
        };
        write_file(file, &bytes)?;
    }
    match &arguments.out {
        None => table.blocks(0, &progress, |_, text| print_to_reader(text)),
        Some(out) => table.write(out, &progress),
    }
}

/// The wheelset and track of a scene, its own position, and how far near misses are reported.
fn system(scene: &Scene, pair: &Pair) -> Result<(WheelsetOnTrack, Position, f64)> {
    let standing = scene.standing()?;
    let Place::Wheelset { rails, wheels, position } = standing.place else {
        let expected = "[track] and [wheelset]";
        return Err(Error::new("", "a single wheel", expected, "a sweep moves a wheelset over its track"));
    };
    Ok((WheelsetOnTrack::new(pair, rails, wheels)?, position, standing.within))
}

//! `wheelrail sweep`: writes the contact geometry of a wheelset at many positions as CSV, and on request the files of every
//! patch.

mod conicity;
mod curves;
mod patches;
mod positions;
mod table;

use std::path::PathBuf;
use std::sync::Arc;

use super::output::{PictureFormat, refuse_files};
use super::progress::Progress;
use crate::answer::{Outcome, complain, folder_of, print_to_reader};
use crate::range::range;
use positions::read_positions;
use table::SweepTable;
use wheelrail::case::{Arrangement, Case, PATCHES_FOLDER, ascending, doubts_of_conicities};
use wheelrail::error::{Error, Result};
use wheelrail::files::{Folder, NewFile};
use wheelrail::scene::{self, Scene};
use wheelrail::search::{ONE_CONTACT, Position, Selection, WheelsetOnTrack, conicity_over};

/// The scene, the positions, and the outputs.
#[derive(Debug, clap::Args)]
pub(super) struct SweepArguments {
    /// Scene file with [track] and [wheelset].
    scene: PathBuf,
    /// Lateral displacements FROM:TO:STEP, mm; yaw and roll are those of the scene.
    #[arg(long, value_name = "FROM:TO:STEP", allow_hyphen_values = true)]
    lateral: Option<String>,
    /// CSV file with columns `lateral_mm`, `yaw_rad`, `roll_rad`; an empty roll is solved.
    #[arg(long, value_name = "FILE.csv", conflicts_with = "lateral")]
    positions: Option<PathBuf>,
    /// File to write; if not given, stdout.
    #[arg(long, value_name = "FILE.csv")]
    out: Option<PathBuf>,
    /// Folder that also gets the files of `run` for every position, in subfolders; `surface.pvd` and
    /// `wheelset.pvd` play them.
    #[arg(long, value_name = "DIR")]
    patches: Option<PathBuf>,
    /// Picture of the usual curves over the lateral displacement, in addition: .svg or .png.
    #[arg(long, value_name = "FILE.svg")]
    picture: Option<PathBuf>,
    /// Page for a browser, in addition: the same curves, with the profiles at the position under the pointer.
    #[arg(long, value_name = "FILE.html")]
    html: Option<PathBuf>,
}

impl SweepArguments {
    /// Returns the positions of the range or the file. Positions of a range have the yaw and roll of `template`.
    fn positions(&self, template: Position) -> Result<Vec<Position>> {
        match (&self.lateral, &self.positions) {
            (Some(text), None) => {
                let lateral = range("--lateral", text)?.into_iter();
                Ok(lateral.map(|lateral| Position { lateral, ..template }).collect())
            }
            (None, Some(file)) => read_positions(file),
            _ => {
                let expected = "either --lateral FROM:TO:STEP or --positions FILE.csv";
                Err(Error::new("sweep", "neither", expected, "say what to sweep over"))
            }
        }
    }
}

/// The outputs of a sweep besides stdout. All have temporary names until the sweep has ended.
struct SweepOutputs {
    table: Option<NewFile>,
    picture: Option<(PictureFormat, NewFile)>,
    html: Option<NewFile>,
    patches: Option<Folder>,
}

impl SweepOutputs {
    /// Opens the outputs, so that their faults show before an hour's work.
    ///
    /// # Errors
    /// A picture of an unknown format; a file that is read, or written twice; any error of the disk.
    fn create(arguments: &SweepArguments, scene: &Scene) -> Result<Self> {
        let picture = arguments.picture.as_deref();
        let format = picture.map(|file| PictureFormat::of_file("--picture", file)).transpose()?;
        let files =
            [("--out", &arguments.out), ("--picture", &arguments.picture), ("--html", &arguments.html)];
        refuse_files(&arguments.scene, scene, arguments.positions.as_ref(), &files)?;
        Ok(Self {
            table: arguments.out.as_deref().map(NewFile::create).transpose()?,
            picture: format.zip(picture.map(NewFile::create).transpose()?),
            html: arguments.html.as_deref().map(NewFile::create).transpose()?,
            patches: arguments
                .patches
                .as_deref()
                .map(|dir| Folder::create(dir, PATCHES_FOLDER))
                .transpose()?,
        })
    }

    /// Gives all outputs their names.
    fn commit(self) -> Result<()> {
        self.patches.map_or(Ok(()), Folder::commit)?;
        self.picture.map_or(Ok(()), |(_, file)| file.commit())?;
        self.html.map_or(Ok(()), NewFile::commit)?;
        self.table.map_or(Ok(()), NewFile::commit)
    }
}

/// Runs the sweep.
pub(super) fn sweep(arguments: &SweepArguments) -> Result<Outcome> {
    let progress = Progress::of("sweep", "scene");
    let path = arguments.scene.as_path();
    let scene = scene::load(path)?;
    let mut outputs = SweepOutputs::create(arguments, &scene)?;
    let in_scene = |error: Error| error.within(path.display());
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    let case = scene::resolve(&scene, folder_of(path), &name).map_err(in_scene)?.read_from(path);
    for warning in case.warnings() {
        complain(&format!("warning: {warning}"));
    }
    let (system, template) = wheelset(&case).map_err(in_scene)?;
    let positions = arguments.positions(template)?;
    let mut told = |done: usize, most: usize| {
        progress.at(format!("equivalent conicity, {done} of at most {most} searches"));
    };
    let conicity = conicity_over(system, &positions, &mut told)?;
    let radius = |side| case.profiles().on(Some(side)).pair.wheel_radius();
    if let Some(conicity) = &conicity {
        let doubts = doubts_of_conicities(system, conicity, &positions, case.landmarks(), radius)?;
        for remark in conicity::remarks(conicity, &positions).into_iter().chain(doubts) {
            complain(&format!("sweep: {remark}"));
        }
    }
    let asked = case.question();
    let ellipses = asked.approach.map(|approach| (approach, asked.modulus()));
    let selection = Selection { within: case.setup().within, apart: ONE_CONTACT };
    let drawn = [("--picture", outputs.picture.is_some()), ("--html", outputs.html.is_some())];
    let drawn = drawn.into_iter().find_map(|(option, given)| given.then_some(option));
    if let Some(option) = drawn {
        let lateral: Vec<f64> = positions.iter().map(|position| position.lateral).collect();
        ascending(&lateral).map_err(|error| error.at(option))?;
    }
    let drawn = drawn.is_some();
    let table =
        SweepTable { system, conicity, selection, positions, ellipses, landmarks: case.landmarks(), drawn };
    if let Some(folder) = &outputs.patches {
        patches::write(folder, &scene, &case, &table, &progress)?;
    }
    let swept = match &mut outputs.table {
        None => {
            // What is drawn needs all positions, whether the reader of the table has gone away or not.
            let mut read = true;
            table.blocks(&progress, |text| {
                read = read && print_to_reader(text)?;
                Ok(read || drawn)
            })?
        }
        Some(file) => table.blocks(&progress, |text| file.put(text.as_bytes()).map(|()| true))?,
    };
    if let Some((format, file)) = &mut outputs.picture {
        progress.at("picture");
        let gauge = scene.track.as_ref().and_then(|track| track.gauge);
        let picture = curves::picture(&table, &swept.drawn, &case, gauge)?;
        file.put(&format.bytes(picture.svg())?)?;
    }
    if let Some(file) = &mut outputs.html {
        progress.at("page");
        file.put(&curves::page(&table, &swept.drawn, &case)?.html())?;
    }
    progress.at("ends of the roll");
    let ends = swept.roll_ends.lines(system, || Ok(()))?;
    outputs.commit()?;
    drop(progress);
    for end in ends {
        complain(&format!("sweep: {end}"));
    }
    if let Some(line) = swept.doubts.line(table.positions.len(), radius) {
        complain(&format!("sweep: {line}"));
    }
    Ok(Outcome::Done)
}

/// Returns the wheelset and track of a case, and the position in the case.
fn wheelset(case: &Case) -> Result<(&Arc<WheelsetOnTrack>, Position)> {
    let Arrangement::Wheelset { system, position } = &case.setup().arrangement else {
        let expected = "[track] and [wheelset]";
        return Err(Error::new("", "a single wheel", expected, "a sweep moves a wheelset over its track"));
    };
    case.profiles().swept("take `wheelrail march`")?;
    Ok((system, *position))
}

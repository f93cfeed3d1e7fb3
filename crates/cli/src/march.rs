//! `wheelrail march`: writes the contact geometry of a wheelset at many places along rails that vary, or as wheels that vary turn, and
//! what happens in between.

use std::path::PathBuf;

use super::output::{PictureFormat, refuse_files};
use super::progress::Progress;
use super::range::{range, range_in};
use crate::answer::{Outcome, complain, counted, folder_of, print_to_reader};
use wheelrail::case::{
    ALONG, AROUND, Columns, DoubtSet, MOST_DRAWN, MarchCourse, append_event, append_stop, events_head,
    march_curves, march_head,
};
use wheelrail::error::Result;
use wheelrail::files::NewFile;
use wheelrail::scene::{self, Scene};
use wheelrail::search::{Event, Stop};

/// The scene, the places, and the outputs.
#[derive(Debug, clap::Args)]
pub(super) struct MarchArguments {
    /// Scene file with [track] and [wheelset], and a rail whose `file` is a list of slices, `.slcs`, without `along`, or a wheel with
    /// `flat`, `radii`, or a list `.slcw` without `angle`.
    scene: PathBuf,
    #[command(flatten)]
    places: Places,
    /// File to write; if not given, stdout.
    #[arg(long, value_name = "FILE.csv")]
    out: Option<PathBuf>,
    /// Table of events in addition: transfers, second places, least clearances.
    #[arg(long, value_name = "FILE.csv")]
    events: Option<PathBuf>,
    /// Picture of the usual curves along the march, in addition: .svg or .png.
    #[arg(long, value_name = "FILE.svg")]
    picture: Option<PathBuf>,
}

/// Where a march goes.
#[derive(Debug, clap::Args)]
#[group(required = true, multiple = false)]
struct Places {
    /// Places of the axle's middle along the track FROM:TO:STEP, mm, as the lists count.
    #[arg(long, value_name = "FROM:TO:STEP", allow_hyphen_values = true)]
    along: Option<String>,
    /// Pitches of the wheelset FROM:TO:STEP, rad: what lies at −pitch around a wheel is lowest.
    #[arg(long, value_name = "FROM:TO:STEP", allow_hyphen_values = true)]
    angle: Option<String>,
}

impl Places {
    /// Reads the places, with the course on which they lie.
    fn read(&self) -> Result<(MarchCourse, Vec<f64>)> {
        match (&self.along, &self.angle) {
            (_, Some(text)) => Ok((AROUND, range_in(("rad", "-0.1:0.1:0.001"), "--angle", text)?)),
            (along, None) => Ok((ALONG, range("--along", along.as_deref().unwrap_or_default())?)),
        }
    }
}

/// The outputs of a march. All have temporary names until it has ended.
struct MarchOutputs {
    table: Option<NewFile>,
    events: Option<NewFile>,
    picture: Option<(PictureFormat, NewFile)>,
}

impl MarchOutputs {
    /// Opens the outputs, so that their faults show before the work.
    fn create(arguments: &MarchArguments, scene: &Scene) -> Result<Self> {
        let picture = arguments.picture.as_deref();
        let format = picture.map(|file| PictureFormat::of_file("--picture", file)).transpose()?;
        let files =
            [("--out", &arguments.out), ("--events", &arguments.events), ("--picture", &arguments.picture)];
        refuse_files(&arguments.scene, scene, None, &files)?;
        Ok(Self {
            table: arguments.out.as_deref().map(NewFile::create).transpose()?,
            events: arguments.events.as_deref().map(NewFile::create).transpose()?,
            picture: format.zip(picture.map(NewFile::create).transpose()?),
        })
    }

    /// Puts text into the table, or to stdout. Returns whether anybody still reads.
    fn put(&mut self, text: &str) -> Result<bool> {
        match &mut self.table {
            None => Ok(print_to_reader(text)? || self.events.is_some() || self.picture.is_some()),
            Some(file) => file.put(text.as_bytes()).map(|()| true),
        }
    }

    fn commit(self) -> Result<()> {
        self.picture.map_or(Ok(()), |(_, file)| file.commit())?;
        self.events.map_or(Ok(()), NewFile::commit)?;
        self.table.map_or(Ok(()), NewFile::commit)
    }
}

/// Runs the march.
pub(super) fn march(arguments: &MarchArguments) -> Result<Outcome> {
    let progress = Progress::of("march", "surfaces");
    let path = arguments.scene.as_path();
    let scene = scene::load(path)?;
    let (course, places) = arguments.places.read()?;
    let mut outputs = MarchOutputs::create(arguments, &scene)?;
    let (march, warnings) =
        scene::march(&scene, folder_of(path)).map_err(|error| error.within(path.display()))?;
    for warning in warnings.into_iter().chain(unused(&scene)) {
        complain(&format!("warning: {warning}"));
    }
    let stride = places.len().div_ceil(MOST_DRAWN).max(1);
    let (mut drawn, mut columns, mut done, mut without) =
        (Columns::default(), Columns::default(), 0_usize, 0);
    outputs.put(&march_head(course))?;
    if let Some(file) = &mut outputs.events {
        file.put(events_head(course).as_bytes())?;
    }
    progress.at(format!("0 of {} places", places.len()));
    let sink = |stops: &[Stop], events: &[Event]| {
        let (mut table, mut told) = (String::new(), String::new());
        for stop in stops {
            append_stop(&mut table, stop, &mut columns);
            without += usize::from(stop.rows.is_empty());
            if done.is_multiple_of(stride) {
                stop.rows.iter().for_each(|row| drawn.push(done / stride, row, None, DoubtSet::default()));
            }
            done += 1;
        }
        events.iter().for_each(|event| append_event(&mut told, event));
        if let Some(file) = &mut outputs.events {
            file.put(told.as_bytes())?;
        }
        progress.share(format!("{done} of {} places", places.len()), done as f64 / places.len() as f64);
        outputs.put(&table)
    };
    if course == AROUND { march.turns(&places, sink) } else { march.blocks(&places, sink) }?;
    if let Some((format, file)) = &mut outputs.picture {
        progress.at("picture");
        let shown: Vec<f64> = places.iter().copied().step_by(stride).collect();
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        let about = format!(
            "{}; lowest contact of each side, in its own profile axes",
            counted(places.len(), "place")
        );
        let picture =
            march_curves(&drawn, (course, &shown), [scene.title.as_deref().unwrap_or(&name), &about])?;
        file.put(&format.bytes(picture.svg())?)?;
    }
    outputs.commit()?;
    drop(progress);
    if without > 0 {
        complain(&format!("march: no contact at {}", counted(without, "place")));
    }
    Ok(Outcome::Done)
}

/// Names what the scene asks for and a march does not give.
fn unused(scene: &Scene) -> Option<String> {
    let sides = [&scene.left, &scene.right].into_iter().flatten();
    let loaded = scene.wheelset.as_ref().is_some_and(|wheelset| wheelset.load.is_some());
    let asked = [
        ("[patch]", scene.patch.is_some()),
        ("loads", loaded || sides.into_iter().any(|side| side.load.is_some())),
        ("[motion]", scene.motion.is_some()),
    ];
    let names: Vec<&str> = asked.into_iter().filter_map(|(name, given)| given.then_some(name)).collect();
    (!names.is_empty()).then(|| format!("a march gives first touch: it does not use {}", names.join(", ")))
}

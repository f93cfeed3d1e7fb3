//! `wheelrail march`: writes the contact geometry of a wheelset at many places along rails that vary, or as wheels that vary turn, and
//! the events in between; draws it as a picture and as a page.

use std::path::PathBuf;

use super::output::{PictureFormat, refuse_files};
use super::progress::Progress;
use super::range::{range, range_in};
use crate::answer::{Outcome, complain, counted, folder_of, print_to_reader};
use wheelrail::case::{
    ALONG, AROUND, DrawnMarch, ListedEvents, MOST_DRAWN, MarchColumns, MarchCourse, MarchStop, Tally,
    append_event, cut_off_warning, events_head, hole_warning, march_head,
};
use wheelrail::error::Result;
use wheelrail::files::NewFile;
use wheelrail::scene::{self, Scene};
use wheelrail::search::Event;

/// The scene, the places, and the outputs.
#[derive(Debug, clap::Args)]
pub(super) struct MarchArguments {
    /// Scene file with [track] and [wheelset], and a rail whose `file` is a list of slices, `.slcs`, without `along`, or a wheel with
    /// `flat`, `radii`, or a list `.slcw` without `angle`.
    scene: PathBuf,
    #[command(flatten)]
    places: MarchPlaces,
    /// File to write; if not given, stdout.
    #[arg(long, value_name = "FILE.csv")]
    out: Option<PathBuf>,
    /// Table of events in addition: transfers, second places, least clearances.
    #[arg(long, value_name = "FILE.csv")]
    events: Option<PathBuf>,
    /// Picture of the usual curves along the march, in addition: .svg or .png.
    #[arg(long, value_name = "FILE.svg")]
    picture: Option<PathBuf>,
    /// Page for a browser, in addition: the same curves over a slider, with the sections of wheels and rails there, and the events.
    #[arg(long, value_name = "FILE.html")]
    html: Option<PathBuf>,
}

/// Where a march goes.
#[derive(Debug, clap::Args)]
#[group(required = true, multiple = false)]
struct MarchPlaces {
    /// Places of the axle's middle along the track FROM:TO:STEP, mm, as the lists count.
    #[arg(long, value_name = "FROM:TO:STEP", allow_hyphen_values = true)]
    along: Option<String>,
    /// Pitches of the wheelset FROM:TO:STEP, rad: what lies at −pitch around a wheel is lowest.
    #[arg(long, value_name = "FROM:TO:STEP", allow_hyphen_values = true)]
    angle: Option<String>,
}

impl MarchPlaces {
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
    html: Option<NewFile>,
}

impl MarchOutputs {
    /// Opens the outputs, so that their faults show before the work.
    fn create(arguments: &MarchArguments, scene: &Scene) -> Result<Self> {
        let picture = arguments.picture.as_deref();
        let format = picture.map(|file| PictureFormat::of_file("--picture", file)).transpose()?;
        let files = [
            ("--out", &arguments.out),
            ("--events", &arguments.events),
            ("--picture", &arguments.picture),
            ("--html", &arguments.html),
        ];
        refuse_files(&arguments.scene, scene, None, &files)?;
        Ok(Self {
            table: arguments.out.as_deref().map(NewFile::create).transpose()?,
            events: arguments.events.as_deref().map(NewFile::create).transpose()?,
            picture: format.zip(picture.map(NewFile::create).transpose()?),
            html: arguments.html.as_deref().map(NewFile::create).transpose()?,
        })
    }

    /// Puts text into the table, or to stdout. Returns whether more is wanted: by the reader, the events or what is drawn.
    fn put(&mut self, text: &str) -> Result<bool> {
        match &mut self.table {
            None => Ok(print_to_reader(text)? || self.events.is_some() || self.draws()),
            Some(file) => file.put(text.as_bytes()).map(|()| true),
        }
    }

    /// Tells whether the march is drawn.
    fn draws(&self) -> bool {
        self.picture.is_some() || self.html.is_some()
    }

    /// Puts what is drawn into its files.
    fn draw(&mut self, drawn: &DrawnMarch<'_>, events: &ListedEvents, progress: &Progress) -> Result<()> {
        if let Some((format, file)) = &mut self.picture {
            progress.at("picture");
            file.put(&format.bytes(drawn.picture()?.svg())?)?;
        }
        if let Some(file) = &mut self.html {
            progress.at("page");
            file.put(&drawn.page(events)?.html())?;
        }
        Ok(())
    }

    fn commit(self) -> Result<()> {
        self.picture.map_or(Ok(()), |(_, file)| file.commit())?;
        self.html.map_or(Ok(()), NewFile::commit)?;
        self.events.map_or(Ok(()), NewFile::commit)?;
        self.table.map_or(Ok(()), NewFile::commit)
    }
}

/// The state of a march.
struct Marched {
    outputs: MarchOutputs,
    /// Number of stops, and the distance between those that are drawn.
    all: usize,
    stride: usize,
    done: usize,
    /// Stops without contact.
    without: usize,
    /// Stops over a hole of a list of slices.
    holes: usize,
    /// Stops with a patch that the end of the slices cuts off.
    cut_off: usize,
    doubts: Tally,
    /// The rows of the stops that were taken last.
    rows: MarchColumns,
    /// The rows of the stops that are drawn, which are numbered among themselves.
    drawn: MarchColumns,
    events: ListedEvents,
}

impl Marched {
    /// Begins the tables.
    fn new(mut outputs: MarchOutputs, course: MarchCourse, all: usize) -> Result<Self> {
        outputs.put(&march_head(course))?;
        if let Some(file) = &mut outputs.events {
            file.put(events_head(course).as_bytes())?;
        }
        let (rows, drawn, events) = Default::default();
        let stride = all.div_ceil(MOST_DRAWN).max(1);
        let doubts = Tally::default();
        Ok(Self {
            outputs,
            all,
            stride,
            done: 0,
            without: 0,
            holes: 0,
            cut_off: 0,
            doubts,
            rows,
            drawn,
            events,
        })
    }

    /// Takes the next stops, and the events up to them. Returns whether more are wanted.
    fn take(&mut self, stops: &[MarchStop], events: &[Event], progress: &Progress) -> Result<bool> {
        let (mut table, mut told) = (String::new(), String::new());
        self.rows.clear();
        for stop in stops {
            self.rows.push(self.done, stop);
            let hole = stop.holes.contains(&true);
            self.holes += usize::from(hole);
            self.without += usize::from(stop.rows.is_empty() && !hole);
            self.cut_off += usize::from(stop.rows.iter().any(|row| row.cut_off));
            self.doubts.add(stop.rows.iter().map(|row| (&row.row, row.doubts)));
            if self.outputs.draws() && self.done.is_multiple_of(self.stride) {
                self.drawn.push(self.done / self.stride, stop);
            }
            self.done += 1;
        }
        self.rows.append_csv(&mut table);
        for event in events {
            append_event(&mut told, event);
            self.events.push(event);
        }
        if let Some(file) = &mut self.outputs.events {
            file.put(told.as_bytes())?;
        }
        let step = format!("{} of {} places", self.done, self.all);
        progress.share(step, self.done as f64 / self.all as f64);
        self.outputs.put(&table)
    }
}

/// Runs the march.
pub(super) fn march(arguments: &MarchArguments) -> Result<Outcome> {
    let progress = Progress::of("march", "surfaces");
    let path = arguments.scene.as_path();
    let scene = scene::load(path)?;
    let (course, places) = arguments.places.read()?;
    let outputs = MarchOutputs::create(arguments, &scene)?;
    let case = scene::march(&scene, folder_of(path)).map_err(|error| error.within(path.display()))?;
    for warning in case.warnings.iter().cloned().chain(unused(&scene)) {
        complain(&format!("warning: {warning}"));
    }
    let mut marched = Marched::new(outputs, course, places.len())?;
    progress.at(format!("0 of {} places", places.len()));
    case.blocks(course, &places, |stops, events| marched.take(stops, events, &progress))?;
    let Marched { mut outputs, stride, without, holes, cut_off, doubts, drawn, events, .. } = marched;
    let shown: Vec<f64> = places.iter().copied().step_by(stride).collect();
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    let number = counted(places.len(), "place");
    let about = format!("{number}; lowest contact of each side, in its own profile axes");
    let headings = [scene.title.as_deref().unwrap_or(&name), &about];
    let drawn = DrawnMarch { case: &case, course, columns: &drawn, places: &shown, headings };
    outputs.draw(&drawn, &events, &progress)?;
    outputs.commit()?;
    drop(progress);
    if without > 0 {
        complain(&format!("march: no contact at {}", counted(without, "place")));
    }
    for warning in hole_warning(holes).into_iter().chain(cut_off_warning(cut_off)) {
        complain(&format!("march: {warning}"));
    }
    let radius = |side| case.profiles.on(Some(side)).pair.wheel_radius();
    if let Some(line) = doubts.line(places.len(), radius) {
        complain(&format!("march: {line}"));
    }
    Ok(Outcome::Done)
}

/// Names what the scene asks for and a march does not give.
fn unused(scene: &Scene) -> Option<String> {
    let asked = [
        ("[patch] approach", scene.patch.as_ref().is_some_and(|patch| patch.approach.is_some())),
        ("[motion]", scene.motion.is_some()),
    ];
    let names: Vec<&str> = asked.into_iter().filter_map(|(name, given)| given.then_some(name)).collect();
    (!names.is_empty()).then(|| format!("a march does not use {}", names.join(", ")))
}

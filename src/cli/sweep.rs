//! `wheelrail sweep`: the contact geometry of a wheelset at many positions, as CSV.

use std::fmt::Write as _;
use std::fs::File;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use rayon::prelude::*;

use super::{Outcome, complain, folder_of, print};
use crate::contact::search::wheelset::{Position, Roll, WheelsetOnTrack};
use crate::contact::search::{ProfilePair, Selection};
use crate::contact::sweep::{Conicity, Row, Sweep, TrackSide};
use crate::error::{Error, Result, finite};
use crate::placement::track::{Track, Wheelset};
use crate::scene::{self, Place, Scene};

/// Columns of the table: those of the design, then curvatures.
const HEADER: &str = "lateral_mm,yaw_rad,roll_rad,side,contact,z_mm,rail_x_mm,wheel_x_mm,y_mm,contact_angle_rad,\
                      rolling_radius_mm,delta_r_mm,conicity,gap_mm,skew_rad,rail_curvature_per_mm,\
                      wheel_curvature_per_mm,kink\n";

/// Positions of one block: enough work for all threads, and little lost when a run is stopped.
const BLOCK: usize = 8192;

/// Positions that one thread takes at a time.
const CHUNK: usize = 256;

/// Most positions of one `--lateral` range: a day's work.
const MOST_POSITIONS: f64 = 1e9;

/// Places closer than this \[mm\] are one contact: drawings' steps and kinks make groups within 0.1 mm.
const ONE_CONTACT: f64 = 0.5;

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
    let table = Table { system, conicity, selection: Selection { within, apart: ONE_CONTACT }, positions };
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
    let system = WheelsetOnTrack {
        pair: ProfilePair::new(&pair.rail, &pair.wheel, pair.wheel_radius)?,
        track: Track::new(&pair.rail, rails)?,
        wheelset: Wheelset::new(wheels, pair.wheel_radius)?,
    };
    Ok((system, position, standing.within))
}

/// FROM:TO:STEP, both ends included.
fn lateral_range(text: &str) -> Result<Vec<f64>> {
    let bad = || {
        let expected = "FROM:TO:STEP in mm with FROM <= TO and STEP > 0";
        Error::new("--lateral", text, expected, "for example --lateral -8:8:0.1")
    };
    let parts: Vec<f64> = text.split(':').filter_map(|part| part.trim().parse().ok()).collect();
    let [from, to, step] = parts[..] else { return Err(bad()) };
    if !(from.is_finite()
        && to.is_finite()
        && step > 0.0
        && from <= to
        && (to - from) / step < MOST_POSITIONS)
    {
        return Err(bad());
    }
    // A last step that ends within a millionth of TO ends there.
    let n = ((to - from) / step + 1e-6).floor() as usize;
    Ok((0..=n).map(|k| (from + step * k as f64).min(to)).collect())
}

fn read_positions(path: &Path) -> Result<Vec<Position>> {
    let place = path.display().to_string();
    let unreadable = |error: csv::Error| {
        Error::new(&place, error.to_string(), "columns lateral_mm,yaw_rad,roll_rad", "correct the file")
    };
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_path(path).map_err(unreadable)?;
    let headers = reader.headers().map_err(unreadable)?.clone();
    let column = |name: &str| headers.iter().position(|header| header == name);
    let Some(lateral) = column("lateral_mm") else {
        let found = format!("columns {}", headers.iter().collect::<Vec<_>>().join(","));
        return Err(Error::new(place, found, "a column lateral_mm", "name the columns in the first line"));
    };
    let (yaw, roll) = (column("yaw_rad"), column("roll_rad"));
    let mut positions = Vec::new();
    for record in reader.records() {
        let record = record.map_err(unreadable)?;
        let line = record.position().map_or(0, csv::Position::line);
        let number = |column: Option<usize>| -> Result<Option<f64>> {
            let Some(text) = column.and_then(|c| record.get(c)).filter(|text| !text.is_empty()) else {
                return Ok(None);
            };
            let place = format!("{place}: line {line}");
            let value = text
                .parse()
                .map_err(|_| Error::new(&place, format!("\"{text}\""), "a number", "correct it"))?;
            finite(&place, value).map(Some)
        };
        positions.push(Position {
            lateral: number(Some(lateral))?.unwrap_or(0.0),
            yaw: number(yaw)?.unwrap_or(0.0),
            roll: number(roll)?.map_or(Roll::Solve, Roll::Fixed),
        });
    }
    Ok(positions)
}

/// A sweep ready to run.
struct Table {
    system: WheelsetOnTrack,
    conicity: Option<Conicity>,
    selection: Selection,
    positions: Vec<Position>,
}

impl Table {
    /// Hands the text of every block from position `first` on to `sink`, with the number of positions done.
    fn blocks(&self, first: usize, mut sink: impl FnMut(usize, &str) -> Result<()>) -> Result<Outcome> {
        let (start, mut told) = (Instant::now(), Instant::now());
        if first == 0 {
            sink(0, HEADER)?;
        }
        let mut done = first;
        for block in self.positions[first.min(self.positions.len())..].chunks(BLOCK) {
            let texts = block.par_chunks(CHUNK).map(|chunk| self.rows(chunk)).collect::<Result<Vec<_>>>()?;
            done += block.len();
            sink(done, &texts.concat())?;
            if told.elapsed() > PATIENCE {
                told = Instant::now();
                let rate = (done - first) as f64 / start.elapsed().as_secs_f64();
                complain(&format!("sweep: {done} of {} positions, {rate:.0} a second", self.positions.len()));
            }
        }
        Ok(Outcome::Done)
    }

    /// The rows of a few positions as text.
    fn rows(&self, positions: &[Position]) -> Result<String> {
        let mut sweep = Sweep::new(&self.system, self.selection, self.conicity.clone());
        let (mut rows, mut text) = (Vec::new(), String::new());
        for position in positions {
            rows.clear();
            sweep.position(position, &mut rows)?;
            for row in &rows {
                append(&mut text, row);
            }
        }
        Ok(text)
    }

    /// Writes a file block by block, going on where a stopped sweep of the same input left off; the file has its
    /// name only when it is complete.
    fn write(&self, out: &Path) -> Result<Outcome> {
        let partial = beside(out, "partial");
        let journal = beside(out, "progress");
        let broken = |error: std::io::Error| {
            Error::new(out.display().to_string(), error.to_string(), "a file written whole", "check the disk")
        };
        let key = self.key();
        let resumed = resume(&journal, &partial, &key);
        let (done, length) = resumed.unwrap_or((0, 0));
        if done > 0 {
            complain(&format!("sweep: going on after {done} positions of an earlier run"));
        }
        let mut file =
            File::options().create(true).write(true).truncate(false).open(&partial).map_err(broken)?;
        file.set_len(length).map_err(broken)?;
        let mut length = length;
        std::io::Seek::seek(&mut file, std::io::SeekFrom::Start(length)).map_err(broken)?;
        let outcome = self.blocks(done, |done, text| {
            file.write_all(text.as_bytes()).map_err(broken)?;
            length += text.len() as u64;
            std::fs::write(&journal, format!("{key} {done} {length}")).map_err(broken)
        })?;
        std::fs::rename(&partial, out).map_err(broken)?;
        std::fs::remove_file(&journal).map_err(broken)?;
        Ok(outcome)
    }

    /// What a partial file has to have been made from.
    fn key(&self) -> String {
        use sha2::{Digest, Sha256};
        let input = format!(
            "{} {:?} {:?} {:?}",
            env!("CARGO_PKG_VERSION"),
            self.system,
            self.selection,
            self.positions
        );
        Sha256::digest(input).iter().map(|byte| format!("{byte:02x}")).collect()
    }
}

/// `.NAME.suffix` in the same folder.
fn beside(out: &Path, suffix: &str) -> PathBuf {
    let name = out.file_name().unwrap_or_default().to_string_lossy();
    out.with_file_name(format!(".{name}.{suffix}"))
}

/// Positions and bytes that an earlier run of the same input has safely written.
fn resume(journal: &Path, partial: &Path, key: &str) -> Option<(usize, u64)> {
    let text = std::fs::read_to_string(journal).ok()?;
    let mut words = text.split(' ');
    let (same, done, length) =
        (words.next()? == key, words.next()?.parse().ok()?, words.next()?.parse().ok()?);
    let there = partial.metadata().ok()?.len();
    (same && done > 0 && there >= length).then_some((done, length))
}

fn append(out: &mut String, row: &Row) {
    let c = &row.contact;
    let side = match row.side {
        TrackSide::Left => "left",
        TrackSide::Right => "right",
    };
    let conicity = if row.conicity.is_nan() { String::new() } else { row.conicity.to_string() };
    let _ = writeln!(
        out,
        "{},{},{},{side},{},{},{},{},{},{},{},{},{conicity},{},{},{},{},{}",
        row.lateral,
        row.yaw,
        row.roll,
        row.number + 1,
        row.z,
        c.rail_x,
        c.wheel_x,
        c.y,
        c.contact_angle,
        c.rolling_radius,
        row.delta_r,
        c.gap,
        c.skew,
        c.rail_curvature,
        c.wheel_curvature,
        u8::from(c.kink())
    );
}

//! The table of a sweep, block by block, resumable.

use std::fmt::Write as _;
use std::fs::{File, TryLockError};
use std::io::{Seek, SeekFrom, Write as _};
use std::path::{Path, PathBuf};
use std::time::Instant;

use rayon::prelude::*;

use super::super::progress::Progress;
use super::super::{Outcome, complain};
use wheelrail::case::ApproachBy;
use wheelrail::error::{Error, Result};
use wheelrail::export::behind_links;
use wheelrail::load::hertz::curvatures_at;
use wheelrail::search::sweep::{Conicity, Row, Sweep, TrackSide};
use wheelrail::search::wheelset::{Position, WheelsetOnTrack};
use wheelrail::search::{Contact, Selection};

/// Columns of the table.
const HEADER: &str = "lateral_mm,yaw_rad,roll_rad,side,contact,z_mm,rail_x_mm,wheel_x_mm,y_mm,contact_angle_rad,\
                      rolling_radius_mm,delta_r_mm,conicity,gap_mm,skew_rad,rail_curvature_per_mm,\
                      wheel_curvature_per_mm,kink,hertz_xi_mm,hertz_eta_mm\n";

/// Positions of one block: enough work for all threads, and little lost when a run is stopped.
const BLOCK: usize = 8192;

/// Positions that one thread takes at a time.
const CHUNK: usize = 256;

/// A sweep ready to run.
pub(super) struct Table {
    pub system: WheelsetOnTrack,
    pub conicity: Option<Conicity>,
    pub selection: Selection,
    pub positions: Vec<Position>,
    /// Approach or load, and E*, of the ellipses.
    pub ellipses: Option<(ApproachBy, f64)>,
}

impl Table {
    /// Hands the text of every block from position `first` on to `sink`, with the number of positions done, as long as it
    /// wants more.
    pub(super) fn blocks(
        &self,
        first: usize,
        progress: &Progress,
        mut sink: impl FnMut(usize, &str) -> Result<bool>,
    ) -> Result<Outcome> {
        let start = Instant::now();
        if first == 0 && !sink(0, HEADER)? {
            return Ok(Outcome::Done);
        }
        let mut done = first;
        progress.at(format!("{first} of {} positions", self.positions.len()));
        for block in self.positions[first.min(self.positions.len())..].chunks(BLOCK) {
            let texts = block.par_chunks(CHUNK).enumerate();
            let texts =
                texts.map(|(k, chunk)| self.rows(done + k * CHUNK, chunk)).collect::<Result<Vec<_>>>()?;
            done += block.len();
            if !sink(done, &texts.concat())? {
                break;
            }
            let rate = (done - first) as f64 / start.elapsed().as_secs_f64();
            progress.at(format!("{done} of {} positions, {rate:.0} a second", self.positions.len()));
        }
        Ok(Outcome::Done)
    }

    /// The rows of a few positions as text, after so many others.
    fn rows(&self, before: usize, positions: &[Position]) -> Result<String> {
        let mut sweep = Sweep::new(&self.system, self.selection, self.conicity.as_ref());
        let (mut rows, mut text) = (Vec::new(), String::new());
        for (k, position) in positions.iter().enumerate() {
            rows.clear();
            sweep
                .position(position, &mut rows)
                .map_err(|error| error.within(format!("position {}", before + k + 1)))?;
            for row in &rows {
                append(&mut text, row, self.ellipses);
            }
        }
        Ok(text)
    }

    /// Writes a file block by block, going on where a stopped sweep of the same input left off; the file has its
    /// name only when it is complete.
    pub(super) fn write(&self, out: &Path, progress: &Progress) -> Result<Outcome> {
        let out = &behind_links(out)?;
        if out.metadata().is_ok_and(|found| !found.is_file()) {
            let (place, expected) = (out.display().to_string(), "an ordinary file, or nothing yet");
            return Err(Error::new(place, "a folder or device", expected, "without --out rows go to stdout"));
        }
        let partial = beside(out, "partial");
        let journal = beside(out, "progress");
        let broken = |error: std::io::Error| {
            let advice = "check path, permissions and free space; a sweep that was stopped then goes on";
            Error::new(out.display().to_string(), error.to_string(), "a file written whole", advice)
        };
        let mut file =
            File::options().create(true).write(true).truncate(false).open(&partial).map_err(broken)?;
        if matches!(file.try_lock(), Err(TryLockError::WouldBlock)) {
            let (place, expected) = (out.display().to_string(), "one sweep at a time");
            return Err(Error::new(
                place,
                "another sweep that writes it",
                expected,
                "give each its own --out",
            ));
        }
        let key = self.key();
        let Resumed { done, mut length, said } = resume(&journal, &partial, &key).unwrap_or_default();
        if done > 0 {
            complain(&format!("sweep: going on after {done} positions of an earlier run"));
        }
        file.set_len(length).and_then(|()| file.seek(SeekFrom::Start(length))).map_err(broken)?;
        let mut log = File::options().create(true).append(true).open(&journal).map_err(broken)?;
        log.set_len(said).map_err(broken)?;
        if said == 0 {
            writeln!(log, "{key}").map_err(broken)?;
        }
        let outcome = self.blocks(done, progress, |done, text| {
            file.write_all(text.as_bytes()).map_err(broken)?;
            length += text.len() as u64;
            log.write_all(format!("{done} {length}\n").as_bytes()).map_err(broken)?;
            Ok(true)
        })?;
        std::fs::rename(&partial, out).map_err(broken)?;
        std::fs::remove_file(&journal).map_err(broken)?;
        Ok(outcome)
    }

    /// What a partial file has to have been made from.
    fn key(&self) -> String {
        use sha2::{Digest, Sha256};
        let input = format!(
            "{} {:?} {:?} {:?} {:?}",
            env!("CARGO_PKG_VERSION"),
            self.system,
            self.selection,
            self.positions,
            self.ellipses
        );
        Sha256::digest(input).iter().map(|byte| format!("{byte:02x}")).collect()
    }
}

/// `.NAME.suffix` in the same folder.
fn beside(out: &Path, suffix: &str) -> PathBuf {
    let name = out.file_name().unwrap_or_default().to_string_lossy();
    out.with_file_name(format!(".{name}.{suffix}"))
}

/// What an earlier run of the same input has safely written.
#[derive(Default)]
struct Resumed {
    /// Positions.
    done: usize,
    /// Bytes of the table.
    length: u64,
    /// Bytes of the journal that say so.
    said: u64,
}

/// The journal is only added to: its key, and a line for every block. A last line without its end may be cut.
fn resume(journal: &Path, partial: &Path, key: &str) -> Option<Resumed> {
    let text = std::fs::read_to_string(journal).ok()?;
    let (whole, _) = text.rsplit_once('\n')?;
    let (same, lines) = whole.split_once('\n')?;
    let (done, length) = lines.lines().next_back()?.split_once(' ')?;
    let resumed =
        Resumed { done: done.parse().ok()?, length: length.parse().ok()?, said: whole.len() as u64 + 1 };
    let there = partial.metadata().ok()?.len();
    (same == key && resumed.done > 0 && there >= resumed.length).then_some(resumed)
}

fn append(out: &mut String, row: &Row, ellipses: Option<(ApproachBy, f64)>) {
    let c = &row.contact;
    let side = match row.side {
        TrackSide::Left => "left",
        TrackSide::Right => "right",
    };
    let conicity = row.conicity.map_or(String::new(), |found| found.conicity.to_string());
    let _ = writeln!(
        out,
        "{},{},{},{side},{},{},{},{},{},{},{},{},{conicity},{},{},{},{},{},{}",
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
        u8::from(c.kink()),
        semi_axes(c, ellipses)
    );
}

/// The two last cells: empty without approach or load, at kinks, and where s is not convex.
fn semi_axes(contact: &Contact, ellipses: Option<(ApproachBy, f64)>) -> String {
    let ellipse = |(by, modulus)| {
        let curvatures = curvatures_at(contact);
        let ellipse = match by {
            ApproachBy::Given(approach) => curvatures.under_approach(approach, modulus),
            ApproachBy::Load(load) => curvatures.under_load(load, modulus),
        };
        let [xi, eta] = curvatures.along(&ellipse?);
        Some(format!("{xi},{eta}"))
    };
    ellipses.and_then(ellipse).unwrap_or_else(|| ",".into())
}

//! Writes the patches of a sweep: the files of `wheelrail run` for every position, and one collection of them.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;
use serde_json::{Value, json};

use super::super::png::png;
use super::super::progress::Progress;
use super::table::SweepTable;
use crate::answer::{complain, counted};
use wheelrail::case::{self, Arrangement, Case, Run, SILENT, Setup};
use wheelrail::error::{Error, ErrorKind, Result, in_order};
use wheelrail::export::collection_pvd;
use wheelrail::files::Folder;
use wheelrail::scene::{self, Scene};
use wheelrail::search::Position;

/// Most positions. Each makes some forty files.
const MOST_POSITIONS: usize = 5000;

/// A position whose folders have been written.
struct WrittenPosition {
    position: Position,
    /// Names of the folders; none for a position without contact.
    folders: Vec<String>,
}

/// Writes `position-0001/` and so on, `surface.pvd`, `wheelset.pvd` and `summary.json` into a folder. All positions share the
/// profiles and the search of the case; the scene is only copied into the summaries.
pub(super) fn write(
    folder: &Folder,
    scene: &Scene,
    case: &Case,
    table: &SweepTable,
    progress: &Progress,
) -> Result<()> {
    let positions = &table.positions;
    if positions.len() > MOST_POSITIONS {
        let found = format!("{} positions", positions.len());
        let expected = format!("{MOST_POSITIONS} positions or fewer");
        return Err(Error::new("--patches", found, expected, "take a larger step, or the table alone"));
    }
    let done = AtomicUsize::new(0);
    let one = |(k, position): (usize, &Position)| {
        let name = format!("position-{:04}", k + 1);
        let written = patch(folder, scene, case, table, position, &name)
            .map_err(|error| error.within(format!("position {}", k + 1)))?;
        let done = 1 + done.fetch_add(1, Ordering::Relaxed);
        let all = positions.len();
        progress.share(format!("patches of {done} of {all} positions"), done as f64 / all as f64);
        Ok(written)
    };
    let written = in_order(positions.par_iter().enumerate().map(one))?;
    folder.write("surface.pvd", collection(&written, every_part).as_bytes())?;
    folder.write("wheelset.pvd", collection(&written, wheelset).as_bytes())?;
    folder.write("summary.json", &summary(scene, &case.echo().hash, &written))?;
    let missing = written.iter().filter(|written| written.folders.is_empty()).count();
    if missing > 0 {
        let positions = counted(missing, "position");
        complain(&format!("sweep: {positions} without contact, and without a folder"));
    }
    Ok(())
}

/// Writes the folders of one position.
fn patch(
    folder: &Folder,
    scene: &Scene,
    case: &Case,
    table: &SweepTable,
    position: &Position,
    name: &str,
) -> Result<WrittenPosition> {
    let position = *position;
    let arrangement = Arrangement::Wheelset { system: Arc::clone(table.system), position };
    let setup = Setup { arrangement, ..case.setup().clone() };
    let here = case.at(setup, scene::echo(&scene.at(&position), name)).as_one_of_many();
    let run = match Run::new(here, SILENT) {
        Err(error) if error.kind == ErrorKind::NoContact => {
            return Ok(WrittenPosition { position, folders: Vec::new() });
        }
        run => run?.filed_under(name),
    };
    case::write(&run, folder, Some(png), SILENT)?;
    Ok(WrittenPosition { position, folders: run.parts.into_iter().map(|part| part.site.folder).collect() })
}

/// Returns the files with the separation of every part of a position.
fn every_part(written: &WrittenPosition) -> Vec<String> {
    written.folders.iter().map(|folder| format!("{folder}/separation.vts")).collect()
}

/// Returns the file with the wheelset on its track at a position.
fn wheelset(written: &WrittenPosition) -> Vec<String> {
    written.folders.first().map(|folder| format!("{folder}/wheelset.vtm")).into_iter().collect()
}

/// Returns the collection of files of every position over time. Time is the lateral displacement if it always grows, else the
/// number of the position.
fn collection(written: &[WrittenPosition], files: fn(&WrittenPosition) -> Vec<String>) -> String {
    let grows = written.windows(2).all(|pair| pair[0].position.lateral < pair[1].position.lateral);
    let mut steps = Vec::new();
    for (k, written) in written.iter().enumerate() {
        let time = if grows { written.position.lateral } else { (k + 1) as f64 };
        steps.extend(files(written).into_iter().enumerate().map(|(part, file)| (time, part, file)));
    }
    collection_pvd(&steps)
}

fn summary(scene: &Scene, hash: &str, written: &[WrittenPosition]) -> Vec<u8> {
    let positions: Vec<Value> = written
        .iter()
        .map(|WrittenPosition { position, folders }| {
            let scene = scene.at(position);
            let roll = scene.wheelset.map(|wheelset| wheelset.roll);
            json!({ "lateral_mm": position.lateral, "yaw_rad": position.yaw, "roll": roll, "folders": folders })
        })
        .collect();
    let value = json!({
        "program": "wheelrail",
        "version": env!("CARGO_PKG_VERSION"),
        "title": scene.title,
        "scene": scene,
        "scene_sha256": hash,
        "positions": positions,
    });
    let mut text = serde_json::to_vec_pretty(&value).unwrap_or_default();
    text.push(b'\n');
    text
}

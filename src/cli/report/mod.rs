//! `wheelrail report`: speed against error, hard cases; Markdown, CSV, SVG.

mod origin;
mod splice;

use std::path::Path;

use super::progress::Progress;
use super::{Outcome, complain, print};
use crate::accuracy::measurements::{Effort, measure};
use crate::accuracy::page::{FILES, PAGE, excerpt, page, sections};
use crate::error::Result;
use crate::files::{Folder, Names};

/// By what a folder of `wheelrail report` is known, and all that it may contain.
const REPORT_FOLDER: Names = Names { marker: PAGE, files: &FILES, is_part: |_| false };

/// Measures, writes the folder, and puts the table into `splice` when there is one; exit code 1 when a hard case is
/// not as its file states or parry3d's meshes disagree. The ratios decide nothing here: they depend on the machine.
pub(super) fn report(out: Option<&Path>, splice: Option<&Path>) -> Result<Outcome> {
    let target = out.unwrap_or(Path::new("output/report"));
    // Whatever is wrong with the targets is to be known before two minutes of measuring.
    let folder = Folder::create(target, REPORT_FOLDER)?;
    let splice = splice.map(splice::Target::open).transpose()?;
    let origin = origin::origin();
    let progress = Progress::of("report", "measurements");
    let measurements = measure(&Effort::full(), &mut |step| progress.at(step))?;
    drop(progress);
    let sections = sections(&measurements);
    for (name, content) in sections.iter().flat_map(|section| &section.files) {
        folder.write(name, content)?;
    }
    folder.write(PAGE, page(&origin, &sections).as_bytes())?;
    folder.commit()?;
    if let Some(target) = splice {
        target.replace(&excerpt(&measurements, &origin))?;
    }
    print(&format!("{}\n", target.display()))?;
    let wrong: Vec<_> = measurements.hard_cases.iter().filter(|outcome| !outcome.as_stated()).collect();
    for outcome in &wrong {
        complain(&format!("no: hard case {} is not as stated", outcome.case.reference.name));
    }
    let disputed: Vec<_> =
        measurements.verified.iter().flatten().filter(|verified| !verified.report.agrees).collect();
    for verified in &disputed {
        complain(&format!("no: {} disagrees with parry3d's meshes", verified.name));
    }
    Ok(if wrong.is_empty() && disputed.is_empty() { Outcome::Done } else { Outcome::No })
}

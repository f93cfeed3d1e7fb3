//! `wheelrail report`: speed against error, and the hard cases, as Markdown, CSV and SVG.

mod origin;
mod processes;
mod splice;

use std::path::Path;

use super::progress::Progress;
use crate::answer::{Outcome, outcome, print};
use wheelrail::error::Result;
use wheelrail::files::{Folder, Names};
use wheelrail_report::measurements::{Effort, measure};
use wheelrail_report::page::{FILES, PAGE, excerpt, page, sections};

/// The names by which a folder of `wheelrail report` is known.
const REPORT_FOLDER: Names =
    Names { marker: PAGE, is_file: |name| FILES.contains(&name), is_part: |_| false };

/// Measures, writes the folder, and puts the table into `splice` if given. The exit code is 1 if a hard case is not as its
/// file states, or if parry3d's meshes disagree. Ratios of times have no influence on it, because they depend on the
/// machine.
pub(super) fn report(out: Option<&Path>, splice: Option<&Path>) -> Result<Outcome> {
    let target = out.unwrap_or(Path::new("output/report"));
    // The outputs are opened first, so that their faults show before three minutes of measuring.
    let folder = Folder::create(target, REPORT_FOLDER)?;
    let splice = splice.map(splice::SplicedFile::open).transpose()?;
    let origin = origin::origin();
    let progress = Progress::of("report", "measurements");
    let mut measurements = measure(&Effort::full(), &mut |step| progress.at(step))?;
    progress.at("whole processes");
    measurements.processes = processes::costs()?;
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
    let wrong = measurements.hard_cases.iter().filter(|case| !case.as_stated());
    let wrong = wrong.map(|case| format!("hard case {} is not as stated", case.case.reference.name));
    let disputed = measurements.verified.iter().flatten().filter(|verified| !verified.report.agrees);
    let disputed = disputed.map(|verified| format!("{} disagrees with parry3d's meshes", verified.name));
    let gaps = measurements.normal_gap.scenes.iter().filter(|scene| !scene.check.agrees);
    let gaps = gaps.map(|scene| format!("the normal gap of {} disagrees with closest distances", scene.name));
    Ok(outcome(wrong.chain(disputed).chain(gaps)))
}

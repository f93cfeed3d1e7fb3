//! `wheelrail check`: every contact of a scene against triangle meshes measured by parry3d.

use std::path::Path;

use super::progress::Progress;
use super::{Outcome, folder_of, outcome, print};
use wheelrail::case::{Part, Run};
use wheelrail::error::Result;
use wheelrail::scene;
use wheelrail::separation::Evaluator;
use wheelrail_check::{Answer, Report, Request, check as compare};

/// Checks a scene; exit code 1 where something disagrees, and where `run` says no: then there is nothing worth
/// agreeing on.
pub(super) fn check(path: &Path) -> Result<Outcome> {
    let progress = Progress::of("check", "scene");
    let run = Run::told(scene::load(path)?, folder_of(path), "check", &|step| progress.at(step))
        .map_err(|e| e.within(path.display()))?;
    let mut agrees = true;
    for part in &run.parts {
        progress.at(format!("{}: meshes", part.name()));
        let report = check_part(part)?;
        agrees &= report.agrees;
        print(&format!("{}: {report}", part.name()))?;
    }
    let outcome = outcome(run.refusals());
    Ok(if agrees { outcome } else { Outcome::No })
}

fn check_part(part: &Part) -> Result<Report> {
    let placement = &part.contact.placement;
    let approach = part.contact.approach.map_or(0.0, |(approach, _)| approach);
    let mut evaluator = Evaluator::new(placement);
    let request = Request { window: part.analysis.window(), approach };
    compare(placement, &request, &mut |xi, eta| Answer::of(&mut evaluator, xi, eta))
}

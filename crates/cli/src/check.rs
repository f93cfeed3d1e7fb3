//! `wheelrail check`: every contact of a scene against triangle meshes measured by parry3d.

use std::path::Path;

use super::progress::Progress;
use crate::answer::{Outcome, folder_of, outcome, print};
use wheelrail::case::{Site, sites};
use wheelrail::error::Result;
use wheelrail::scene;
use wheelrail::separation::Evaluator;
use wheelrail_check::{Answer, Report, Request, check as compare};

/// Checks a scene, whose grids are not filled. The exit code is 1 where something disagrees, and where `run` says no: then
/// there is nothing worth agreeing on.
pub(super) fn check(path: &Path) -> Result<Outcome> {
    let progress = Progress::of("check", "scene");
    let scene = scene::load(path)?;
    progress.at("contacts");
    let case = scene::resolve(&scene, folder_of(path), "check");
    let sites = case.and_then(|case| sites(&case)).map_err(|error| error.within(path.display()))?;
    let mut agrees = true;
    for site in &sites {
        progress.at(format!("{}: meshes", site.name()));
        let report = check_site(site)?;
        agrees &= report.agrees;
        print(&format!("{}: {report}", site.name()))?;
    }
    let outcome = outcome(sites.iter().flat_map(|site| site.refusals(site.patch().as_ref())));
    Ok(if agrees { outcome } else { Outcome::No })
}

fn check_site(site: &Site) -> Result<Report> {
    let placement = &site.contact.placement;
    let mut evaluator = Evaluator::new(placement);
    let request = Request { window: site.window(), approach: site.approach() };
    compare(placement, &request, &mut |xi, eta| Answer::of(&mut evaluator, xi, eta))
}

//! `wheelrail check`: compares every contact of a scene with triangle meshes that parry3d measures.

use std::path::Path;

use super::progress::Progress;
use crate::answer::{Outcome, folder_of, outcome, print};
use wheelrail::case::sites;
use wheelrail::error::Result;
use wheelrail::scene;
use wheelrail_check::check_site;

/// Checks a scene without filling its grids. The exit code is 1 if something disagrees. It is also 1 where `run` answers
/// "no", because there is then nothing to compare.
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
        agrees &= report.agrees();
        print(&format!("{}: {report}", site.name()))?;
    }
    let outcome = outcome(sites.iter().flat_map(|site| site.refusals(site.patch().as_ref())));
    Ok(if agrees { outcome } else { Outcome::No })
}

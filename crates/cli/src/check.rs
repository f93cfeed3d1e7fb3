//! `wheelrail check`: compares every contact of a scene with triangle meshes that parry3d measures.

use std::path::Path;

use super::progress::Progress;
use crate::answer::{Outcome, folder_of, outcome, print};
use wheelrail::case::{Site, sites};
use wheelrail::conformal::NormalGap;
use wheelrail::error::Result;
use wheelrail::scene;
use wheelrail::separation::Evaluator;
use wheelrail_check::{Answer, NormalGapSample, Report, Request, check as compare, check_normal_gap};

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
        agrees &= report.agrees;
        print(&format!("{}: {report}", site.name()))?;
        if let Some(samples) = normal_gaps(site) {
            let report = check_normal_gap(&site.contact.placement, &samples)?;
            agrees &= report.agrees;
            print(&report.to_string())?;
        }
    }
    let outcome = outcome(sites.iter().flat_map(|site| site.refusals(site.patch().as_ref())));
    Ok(if agrees { outcome } else { Outcome::No })
}

/// Points a side at which the normal gap of a grid over the rail's surface is measured.
const SAMPLES: usize = 9;

/// Gives normal gaps over the grid of a site, evenly spread; `None` for a grid over the tangent plane.
fn normal_gaps(site: &Site) -> Option<Vec<NormalGapSample>> {
    let sigma = site.grid.sigma.as_ref()?;
    let gap = NormalGap::new(&site.contact.placement);
    let spread = |values: &[f64]| -> Vec<f64> {
        values.iter().step_by(values.len().div_ceil(SAMPLES).max(1)).copied().collect()
    };
    let eta = spread(&site.grid.eta);
    let samples = spread(sigma).into_iter().flat_map(|sigma| {
        eta.iter().filter_map(|&eta| NormalGapSample::at(&gap, sigma, eta)).collect::<Vec<_>>()
    });
    Some(samples.collect())
}

fn check_site(site: &Site) -> Result<Report> {
    let placement = &site.contact.placement;
    let mut evaluator = Evaluator::new(placement);
    let request = Request { window: site.window(), approach: site.approach() };
    compare(placement, &request, &mut |xi, eta| Answer::of(&mut evaluator, xi, eta))
}

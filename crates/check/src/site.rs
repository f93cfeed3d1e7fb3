//! The check of a contact of a case.

use std::fmt;

use serde::Serialize;
use wheelrail::case::Site;
use wheelrail::conformal::NormalGap;
use wheelrail::error::Result;
use wheelrail::separation::Evaluator;

use super::compare::check;
use super::normal_gap::{NormalGapReport, NormalGapSample, check_normal_gap};
use super::report::Report;
use super::request::{Answer, Request};

/// Points a side at which the normal gap of a grid over the rail's surface is measured.
const SAMPLES: usize = 9;

/// The result for a contact of a case.
#[derive(Debug, Clone, Serialize)]
pub struct SiteReport {
    /// s and the normals over the tangent plane.
    pub plane: Report,
    /// The normal gap; `None` for a grid over the tangent plane.
    pub rail: Option<NormalGapReport>,
}

impl SiteReport {
    /// Returns whether all measurements agree.
    pub fn agrees(&self) -> bool {
        self.plane.agrees && self.rail.as_ref().is_none_or(|rail| rail.agrees)
    }
}

impl fmt::Display for SiteReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.plane)?;
        self.rail.as_ref().map_or(Ok(()), |rail| write!(f, "{rail}"))
    }
}

/// Checks a contact over its own window and approach, without filling its grid.
///
/// # Errors
/// Those of [`check`].
pub fn check_site(site: &Site) -> Result<SiteReport> {
    let placement = &site.contact.placement;
    let mut evaluator = Evaluator::new(placement);
    let request = Request { window: site.window(), approach: site.approach() };
    let plane = check(placement, &request, &mut |xi, eta| Answer::of(&mut evaluator, xi, eta))?;
    let samples = normal_gaps(site);
    let rail = samples.map(|samples| check_normal_gap(placement, &samples)).transpose()?;
    Ok(SiteReport { plane, rail })
}

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

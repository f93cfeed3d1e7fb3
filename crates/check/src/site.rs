//! The check of a contact of a case.

use std::fmt;

use serde::Serialize;
use wheelrail::case::Site;
use wheelrail::conformal::NormalGap;
use wheelrail::error::Result;
use wheelrail::separation::Evaluator;

use super::compare::check;
use super::lofted::{LoftedReport, check_lofted};
use super::normal_gap::{NormalGapReport, NormalGapSample, check_normal_gap};
use super::report::Report;
use super::request::{Answer, Request};

/// Most values of σ, and of η, at which the normal gap of a grid over the rail's surface is measured.
const SAMPLES: usize = 9;

/// The result for a contact of a case.
#[derive(Debug, Clone, Serialize)]
pub struct SiteReport {
    /// s and the normals over the tangent plane; `None` with a body that varies.
    pub plane: Option<Report>,
    /// The normal gap; `None` for a grid over the tangent plane.
    pub rail: Option<NormalGapReport>,
    /// s and the normals of a body that varies; `None` where both are swept.
    pub lofted: Option<LoftedReport>,
}

impl SiteReport {
    /// Returns whether all measurements agree.
    pub fn agrees(&self) -> bool {
        self.plane.as_ref().is_none_or(|plane| plane.agrees)
            && self.rail.as_ref().is_none_or(|rail| rail.agrees)
            && self.lofted.as_ref().is_none_or(|lofted| lofted.agrees)
    }
}

impl fmt::Display for SiteReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.plane.as_ref().map_or(Ok(()), |plane| write!(f, "{plane}"))?;
        self.lofted.as_ref().map_or(Ok(()), |lofted| write!(f, "{lofted}"))?;
        self.rail.as_ref().map_or(Ok(()), |rail| write!(f, "{rail}"))
    }
}

/// Checks a contact over its own window and approach, without filling its grid.
///
/// # Errors
/// Those of [`check`] and [`check_normal_gap`]; with a body that varies, a window that is not finite or too wide.
pub fn check_site(site: &Site) -> Result<SiteReport> {
    let placement = &site.contact.placement;
    let mut evaluator = Evaluator::new(placement);
    let request = Request { window: site.window(), approach: site.approach() };
    let mut answer = |xi: f64, eta: f64| Answer::of(&mut evaluator, xi, eta);
    let samples = normal_gaps(site);
    let rail = samples.as_ref().map(|samples| check_normal_gap(placement, samples)).transpose()?;
    if let Some(lofted) = placement.lofted() {
        let ends: Option<Vec<[f64; 3]>> =
            samples.map(|samples| samples.iter().map(|sample| sample.end(lofted.side())).collect());
        let lofted = Some(check_lofted((placement, lofted), &request, &mut answer, ends.as_deref())?);
        return Ok(SiteReport { plane: None, rail, lofted });
    }
    let plane = Some(check(placement, &request, &mut answer)?);
    Ok(SiteReport { plane, rail, lofted: None })
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

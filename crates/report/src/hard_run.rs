//! Runs a hard case by every method and collects what came out.

use super::errors::{ComparedPoint, Errors, compare};
use super::hard_case::{COLUMNS, HardCase, METHODS, Status};
use super::hard_checks::{self, HardCheck};
use wheelrail::error::Result;
use wheelrail::separation::Method;

/// A case and the results of its checks.
#[derive(Debug, Clone, PartialEq)]
pub struct HardOutcome {
    /// The case that was run.
    pub case: HardCase,
    /// Number of points of the case's file.
    pub points: usize,
    /// Errors for each of [`METHODS`], over the points that have a value where they should.
    pub errors: [Errors; 3],
    /// All checks.
    pub checks: Vec<HardCheck>,
}

impl HardOutcome {
    /// Returns the checks that failed.
    pub fn failures(&self) -> impl Iterator<Item = &HardCheck> {
        self.checks.iter().filter(|check| !check.passed)
    }

    /// Returns whether the result is the one that the status states.
    pub fn as_stated(&self) -> bool {
        let passed = self.failures().next().is_none();
        passed == (self.case.status == Status::Holds)
    }
}

/// Runs all checks; `all` holds the cases that a relation may name.
///
/// # Errors
/// A scene that cannot be placed; a relation to a case that does not exist.
pub fn run(case: &HardCase, all: &[HardCase]) -> Result<HardOutcome> {
    let placement = case.reference.placement()?;
    let points: [Vec<ComparedPoint>; 3] = METHODS.map(|method| {
        let choice = case.choice(&placement, method);
        let columns = if method == Method::Spectral { &COLUMNS[..] } else { &COLUMNS[..1] };
        columns.iter().flat_map(|&n| compare(&case.reference, &placement, &choice, n)).collect()
    });
    let checks = hard_checks::all(case, &placement, &points, all)?;
    let errors = points.each_ref().map(|points| {
        let defined: Vec<ComparedPoint> = points.iter().filter(|p| !p.error().is_nan()).copied().collect();
        let wrongly_masked = points.len() - defined.len();
        Errors { wrongly_masked, ..Errors::of(&defined) }
    });
    Ok(HardOutcome { case: case.clone(), points: case.reference.separation.len(), errors, checks })
}

//! Runs the check by parry3d's meshes over every reference scene and every pair of built-in profiles.

use rayon::prelude::*;

use super::inclined::RADIUS;
use super::reference::ReferenceFile;
use wheelrail::Interval;
use wheelrail::error::Result;
use wheelrail::patch::Window;
use wheelrail::placement::{Pair, Placement};
use wheelrail::profile::standards;
use wheelrail::separation::Evaluator;
use wheelrail_check::{Answer, Floor, Report, Request, check};

/// Skew of every third built-in pair \[rad\].
const SKEW: f64 = 0.01;
const SKEWS: [f64; 2] = [SKEW, -0.06];

const HALF_WIDTHS: [f64; 2] = [30.0, 15.0];
const APPROACH: f64 = 0.05;

/// Distance of the window from the ends of a rail \[mm\]: light rails end within the half width, and meshes do not resolve
/// points on the edge of a head.
const EDGE: f64 = 4.0;

/// A placed pair to be checked, with window and approach.
#[derive(Debug, Clone)]
pub struct Subject {
    /// Name of the scene, or of rail and wheel, with the skew.
    pub name: String,
    /// The placed pair.
    pub placement: Placement,
    /// Window and approach.
    pub request: Request,
}

/// A subject's name and the result of its check.
#[derive(Debug, Clone, PartialEq)]
pub struct Verified {
    /// Name of the subject.
    pub name: String,
    /// Agreement and floors.
    pub report: Report,
}

impl Subject {
    /// Makes the subject of a reference scene: the window of its values, and its first approach.
    ///
    /// # Errors
    /// The errors of [`ReferenceFile::placement`].
    pub fn of_reference(reference: &ReferenceFile) -> Result<Self> {
        let [xi, eta] = reference.scene.axes();
        let reach = eta.last().copied().unwrap_or(0.0);
        let approach = reference.scene.delta.first().copied().unwrap_or(0.0);
        let request = Request {
            window: Window { xi: Interval::around(xi), eta: Interval::symmetric(reach) },
            approach,
        };
        Ok(Self { name: reference.name.clone(), placement: reference.placement()?, request })
    }

    /// Returns this pair under other skews.
    ///
    /// # Errors
    /// The errors of [`Placement::with_skew`].
    pub fn skewed(&self) -> Result<Vec<Self>> {
        let skewed = |skew: f64| {
            let name = format!("{}, skew {skew}", self.name);
            Ok(Self { name, placement: self.placement.with_skew(skew)?, request: self.request })
        };
        SKEWS.into_iter().map(skewed).collect()
    }

    /// Checks the point-wise evaluator's answers by the meshes.
    ///
    /// # Errors
    /// The errors of [`check`].
    pub fn verify(&self) -> Result<Verified> {
        let mut evaluator = Evaluator::new(&self.placement);
        let report =
            check(&self.placement, &self.request, &mut |xi, eta| Answer::of(&mut evaluator, xi, eta))?;
        Ok(Verified { name: self.name.clone(), report })
    }
}

/// Places every built-in rail under every built-in wheel, with the profiles' origins in contact, every third
/// pair with skew.
///
/// # Errors
/// A built-in profile without a point at its origin, which is a fault of this program.
pub fn built_in_pairs() -> Result<Vec<Subject>> {
    let names = standards::rail_names().flat_map(|rail| standards::wheel_names().map(move |w| (rail, w)));
    names
        .enumerate()
        .map(|(k, (rail, wheel))| {
            let skew = if k % 3 == 2 { SKEW } else { 0.0 };
            let pair = Pair::new(standards::rail(rail)?, standards::wheel(wheel)?, RADIUS)?;
            let placement = pair.placed(0.0, 0.0, skew)?;
            let [half, reach] = HALF_WIDTHS;
            let near = Interval::symmetric(half);
            let xi = placement.rail().section().reach().map_or(near, |rail| rail.grown(-EDGE).cut(near));
            let window = Window { xi, eta: Interval::symmetric(reach) };
            let request = Request { window, approach: APPROACH };
            Ok(Subject { name: format!("{rail} and {wheel}, skew {skew}"), placement, request })
        })
        .collect()
}

/// Checks all subjects, on all threads.
///
/// # Errors
/// The errors of [`check`].
pub fn verify(subjects: &[Subject]) -> Result<Vec<Verified>> {
    subjects.par_iter().map(Subject::verify).collect()
}

/// Returns the checker's largest errors on closed forms over several reports, form by form.
pub fn floors<'a>(all: impl Iterator<Item = &'a Verified>) -> Vec<Floor> {
    let mut floors: Vec<Floor> = Vec::new();
    for floor in all.flat_map(|verified| &verified.report.floors) {
        let Some(known) = floors.iter_mut().find(|known| known.form == floor.form) else {
            floors.push(floor.clone());
            continue;
        };
        known.ray_mm = known.ray_mm.max(floor.ray_mm);
        known.normal = known.normal.max(floor.normal);
        known.closest_mm = known.closest_mm.max(floor.closest_mm);
    }
    floors
}

//! The check by parry3d's meshes over every reference scene and every pair of built-in profiles.

use rayon::prelude::*;

use super::reference::Reference;
use wheelrail::error::Result;
use wheelrail::patch::Window;
use wheelrail::placement::{Pair, Placement};
use wheelrail::profile::standards;
use wheelrail::separation::Evaluator;
use wheelrail_check::{Answer, Floor, Report, Request, check};

/// Skew \[rad\] of every third built-in pair, and of the reference scenes besides their own.
const SKEW: f64 = 0.01;
const SKEWS: [f64; 2] = [SKEW, -0.06];

/// R \[mm\], half widths of the window and δ \[mm\] of the built-in pairs.
const WHEEL_RADIUS: f64 = 460.0;
const HALF_WIDTHS: [f64; 2] = [30.0, 15.0];
const APPROACH: f64 = 0.05;

/// What is checked: a placed pair and where.
#[derive(Debug, Clone)]
pub struct Subject {
    /// Scene, or rail and wheel, with its skew.
    pub name: String,
    /// The pair in contact.
    pub placement: Placement,
    /// Window and approach.
    pub request: Request,
}

/// A subject and what the meshes say of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Verified {
    /// Its name.
    pub name: String,
    /// Agreement and floors.
    pub report: Report,
}

impl Subject {
    /// The window of a reference scene's values, and its first approach.
    ///
    /// # Errors
    /// As [`Reference::placement`].
    pub fn of_reference(reference: &Reference) -> Result<Self> {
        let [xi, eta] = reference.scene.axes();
        let ends = |values: &[f64]| [values.first(), values.last()].map(|v| v.copied().unwrap_or(0.0));
        let reach = ends(&eta)[1];
        let approach = reference.scene.delta.first().copied().unwrap_or(0.0);
        let request = Request { window: Window { xi: ends(&xi), eta: [-reach, reach] }, approach };
        Ok(Self { name: reference.name.clone(), placement: reference.placement()?, request })
    }

    /// This pair under other skews.
    ///
    /// # Errors
    /// As [`Placement::with_skew`].
    pub fn skewed(&self) -> Result<Vec<Self>> {
        let skewed = |skew: f64| {
            let name = format!("{}, skew {skew}", self.name);
            Ok(Self { name, placement: self.placement.with_skew(skew)?, request: self.request })
        };
        SKEWS.into_iter().map(skewed).collect()
    }

    /// Asks the meshes about the point-wise evaluator's answers.
    ///
    /// # Errors
    /// As [`check`].
    pub fn verify(&self) -> Result<Verified> {
        let mut evaluator = Evaluator::new(&self.placement);
        let report =
            check(&self.placement, &self.request, &mut |xi, eta| Answer::of(&mut evaluator, xi, eta))?;
        Ok(Verified { name: self.name.clone(), report })
    }
}

/// Every built-in rail under every built-in wheel, the profiles' origins in contact, every third with skew.
///
/// # Errors
/// A built-in profile without a point at its origin: a fault of this program.
pub fn built_in_pairs() -> Result<Vec<Subject>> {
    let names = standards::rail_names().flat_map(|rail| standards::wheel_names().map(move |w| (rail, w)));
    names
        .enumerate()
        .map(|(k, (rail, wheel))| {
            let skew = if k % 3 == 2 { SKEW } else { 0.0 };
            let pair = Pair::new(standards::rail(rail)?, standards::wheel(wheel)?, WHEEL_RADIUS)?;
            let [xi, eta] = HALF_WIDTHS.map(|half| [-half, half]);
            let request = Request { window: Window { xi, eta }, approach: APPROACH };
            let name = format!("{rail} and {wheel}, skew {skew}");
            Ok(Subject { name, placement: pair.placed(0.0, 0.0, skew)?, request })
        })
        .collect()
}

/// All of them, on all threads.
///
/// # Errors
/// As [`check`].
pub fn verify(subjects: &[Subject]) -> Result<Vec<Verified>> {
    subjects.par_iter().map(Subject::verify).collect()
}

/// The checker's largest floors over several reports, form by form.
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

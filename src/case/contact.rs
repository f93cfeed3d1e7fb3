//! A placed pair and what follows from it without a grid.

use std::sync::OnceLock;
use std::time::Instant;

use serde::Serialize;

use super::input::ApproachBy;
use crate::error::{Error, Result};
use crate::load::{Curvatures, Ellipse, Estimate, Feasibility, approach_under_load, curvatures, feasibility};
use crate::patch::{Patch, Window};
use crate::placement::Placement;

/// What Hertz's ellipse belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum EllipseUnder {
    /// The load: the ellipse's δ differs from an estimate by virtual interpenetration.
    Load,
    /// The approach.
    Approach,
}

/// The contact point, its feasibility, curvatures and approach.
#[derive(Debug, Clone)]
pub struct PlacedContact {
    /// The placed pair.
    pub placement: Placement,
    /// Whether s ≥ 0 everywhere (4.1), with the least s.
    pub feasibility: Feasibility,
    /// Principal curvatures of s at C.
    pub curvatures: Curvatures,
    /// δ \[mm\], with the method of its estimate where it was estimated.
    pub approach: Option<(f64, Option<Estimate>)>,
    /// Hertz's ellipse under the load or the approach; `None` without either, and where s is not convex at C.
    pub ellipse: Option<Ellipse>,
    /// Which of the two the ellipse belongs to.
    pub ellipse_under: Option<EllipseUnder>,
    /// Seconds spent on estimating the approach; 0 for a given one.
    pub load_s: f64,
    /// The patch over the whole plane, once it was asked for.
    whole_patch: OnceLock<Patch>,
}

impl PlacedContact {
    /// Finds feasibility, curvatures and approach of a placed pair; `modulus` is E* \[N/mm²\].
    ///
    /// # Errors
    /// Bodies that nowhere lie over each other; a load that no approach carries.
    pub fn new(placement: Placement, asked: Option<ApproachBy>, modulus: f64) -> Result<Self> {
        let Some(feasibility) = feasibility(&placement) else {
            let expected = "two profiles that lie over each other in the contact frame";
            return Err(Error::new("contact", "no common ξ", expected, "choose other contact points"));
        };
        let curvatures = curvatures(&placement);
        let start = Instant::now();
        let (approach, ellipse, under) = match asked {
            None => (None, None, None),
            Some(ApproachBy::Given(approach)) => {
                let ellipse = curvatures.under_approach(approach, modulus);
                (Some((approach, None)), ellipse, Some(EllipseUnder::Approach))
            }
            Some(ApproachBy::Load(load)) => {
                let (approach, estimate) = approach_under_load(&placement, load, modulus)?;
                let ellipse = curvatures.under_load(load, modulus);
                (Some((approach, Some(estimate))), ellipse, Some(EllipseUnder::Load))
            }
        };
        let load_s = if under == Some(EllipseUnder::Load) { start.elapsed().as_secs_f64() } else { 0.0 };
        let ellipse_under = under.filter(|_| ellipse.is_some());
        let whole_patch = OnceLock::new();
        Ok(Self { placement, feasibility, curvatures, approach, ellipse, ellipse_under, load_s, whole_patch })
    }

    /// Gives the patch over the whole plane, found once; `None` without an approach.
    pub fn whole_patch(&self) -> Option<&Patch> {
        let (approach, _) = self.approach?;
        Some(self.whole_patch.get_or_init(|| Patch::new(&self.placement, approach, &Window::UNBOUNDED)))
    }

    /// Gives the patch in a window: the whole one's components where they are known and the window cuts none. `None`
    /// without an approach.
    pub fn patch_in(&self, window: &Window) -> Option<Patch> {
        let (approach, _) = self.approach?;
        let known = self.whole_patch.get().and_then(|patch| patch.within(window));
        Some(known.unwrap_or_else(|| Patch::new(&self.placement, approach, window)))
    }
}

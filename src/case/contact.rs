//! A placed pair and what follows from it without a grid.

use std::sync::{Arc, OnceLock};

use serde::Serialize;

use super::ends::{OpenEnd, end_in_contact};
use super::found::Found;
use super::unmeasured::{BridgeInContact, bridge_in_contact};
use super::wheel::ContactRegion;
use crate::error::{Error, Result};
use crate::load::{Curvatures, Ellipse, Feasibility, Pressures, curvatures, feasibility};
use crate::patch::{Patch, Window};
use crate::placement::Placement;

/// What Hertz's ellipse belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum EllipseUnder {
    /// The load: the ellipse's δ differs from the half-space's.
    Load,
    /// The approach.
    Approach,
}

/// The contact point, its feasibility, curvatures and approach.
#[derive(Debug, Clone)]
pub struct PlacedContact {
    /// How the contact was found; `None` for a chosen one.
    pub found: Option<Found>,
    /// The placed pair.
    pub placement: Placement,
    /// Whether s ≥ 0 everywhere (4.1), with the least s.
    pub feasibility: Feasibility,
    /// Principal curvatures of s at C.
    pub curvatures: Curvatures,
    /// δ \[mm\], as given or estimated from a load.
    pub approach: Option<f64>,
    /// Normal force \[N\] of every group of parts of the patch, in their order; empty unless a load was asked for.
    pub normal_loads: Vec<f64>,
    /// Pressures of every group of parts, whose sums are the normal forces to 0.02 %; empty unless a load was asked for.
    pub pressures: Vec<Pressures>,
    /// Hertz's ellipse under the normal force or the approach; `None` without either, and where s is not convex at C.
    pub ellipse: Option<Ellipse>,
    /// Which of the two the ellipse belongs to.
    pub ellipse_under: Option<EllipseUnder>,
    /// Seconds spent on estimating the approach of its wheel; 0 for a given one.
    pub load_s: f64,
    /// The patch over the whole plane, once it was asked for.
    whole_patch: OnceLock<Patch>,
}

impl PlacedContact {
    /// Finds feasibility and curvatures of a placed pair, and Hertz's ellipse under an approach \[mm\]; `modulus` is
    /// E* \[N/mm²\].
    ///
    /// # Errors
    /// Bodies that nowhere lie over each other.
    pub fn new(placement: Placement, approach: Option<f64>, modulus: f64) -> Result<Self> {
        let Some(feasibility) = feasibility(&placement) else {
            let expected = "two profiles that lie over each other in the contact frame";
            return Err(Error::new("contact", "no common ξ", expected, "choose other contact points"));
        };
        let curvatures = curvatures(&placement);
        let ellipse = approach.and_then(|approach| curvatures.under_approach(approach, modulus));
        Ok(Self {
            found: None,
            placement,
            feasibility,
            curvatures,
            approach,
            normal_loads: Vec::new(),
            pressures: Vec::new(),
            ellipse,
            ellipse_under: ellipse.map(|_| EllipseUnder::Approach),
            load_s: 0.0,
            whole_patch: OnceLock::new(),
        })
    }

    /// Makes the contact of a region, with what it carries; `load_s` are the seconds that this took to find.
    ///
    /// # Errors
    /// The errors of [`PlacedContact::new`].
    pub(super) fn of(region: ContactRegion, modulus: f64, load_s: f64) -> Result<Self> {
        let ContactRegion { placement, approach, patch, loads, pressures, .. } = region;
        let mut contact = Self::new(Arc::unwrap_or_clone(placement), Some(approach), modulus)?;
        if !loads.is_empty() {
            let ellipse = contact.curvatures.under_load(loads.iter().sum(), modulus);
            (contact.ellipse, contact.ellipse_under) = (ellipse, ellipse.map(|_| EllipseUnder::Load));
        }
        (contact.normal_loads, contact.pressures, contact.load_s) = (loads, pressures, load_s);
        contact.whole_patch = OnceLock::from(patch);
        Ok(contact)
    }

    /// Gives the same contact with how it was found.
    pub(super) fn found_as(self, found: Found) -> Self {
        Self { found: Some(found), ..self }
    }

    /// Names the contact as messages call it: by side and number, or "contact" for a chosen one.
    pub fn name(&self) -> String {
        self.found.as_ref().map_or_else(|| "contact".into(), Found::name)
    }

    /// Tells whether a load was asked for, from which half-spaces found δ.
    pub fn is_loaded(&self) -> bool {
        !self.normal_loads.is_empty()
    }

    /// Finds an open end of a profile at C or in the patch: pressures there are none that can be trusted.
    pub fn open_end(&self) -> Option<OpenEnd> {
        end_in_contact(&self.placement, self.whole_patch())
    }

    /// Finds a bridge over what was not measured at C or in the patch: pressures there are none that can be trusted.
    pub fn bridge(&self) -> Option<BridgeInContact> {
        bridge_in_contact(&self.placement, self.whole_patch())
    }

    /// Gives the patch over the whole plane, found once; `None` without an approach.
    pub fn whole_patch(&self) -> Option<&Patch> {
        let approach = self.approach?;
        Some(self.whole_patch.get_or_init(|| Patch::new(&self.placement, approach, &Window::UNBOUNDED)))
    }

    /// Gives the patch in a window: the whole one's components where they are known and the window cuts none. `None`
    /// without an approach.
    pub fn patch_in(&self, window: &Window) -> Option<Patch> {
        let approach = self.approach?;
        let known = self.whole_patch.get().and_then(|patch| patch.within(window));
        Some(known.unwrap_or_else(|| Patch::new(&self.placement, approach, window)))
    }
}

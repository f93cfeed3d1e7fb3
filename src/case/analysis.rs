//! The separation over the grid of a site, and the patch in its window.

use std::time::Instant;

use serde::Serialize;

use super::conformal::Conformal;
use super::input::Question;
use super::pressure::PartPressure;
use super::site::Site;
use crate::error::{Error, Result};
use crate::mesh::{StripCounts, StripMesh};
use crate::patch::Patch;
use crate::placement::Placement;
use crate::separation::methods::quadratic::quadratic_form;
use crate::separation::{EtaAxis, Method};
use crate::separation::{Plan, plan};

/// Seconds spent in the parts of an analysis.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Timings {
    /// Estimating the approaches of the wheel from its load; 0 for a given approach.
    pub load_s: f64,
    /// Choosing the method.
    pub plan_s: f64,
    /// Filling the grid.
    pub grid_s: f64,
    /// Boundary, area, perimeter, where they were not known from sizing the grid.
    pub patch_s: f64,
    /// Boundary-fitted mesh.
    pub mesh_s: f64,
    /// The normal gap and its patch; next to 0 where it is not asked for.
    pub conformal_s: f64,
    /// The pressures.
    pub pressure_s: f64,
}

/// The separation over a grid and the patch in its window.
#[derive(Debug, Clone)]
pub struct Analysis {
    /// s \[mm\] at i_ξ · n_η + i_η; NaN where a body has no surface.
    pub separation: Vec<f64>,
    /// Method, error estimate and reason.
    pub plan: Plan,
    /// The patch in the window of the grid; `None` without an approach.
    pub patch: Option<Patch>,
    /// The boundary-fitted mesh over the patch.
    pub strips: Option<StripMesh>,
    /// The normal gap over the rail's surface, where it is asked for.
    pub conformal: Option<Conformal>,
    /// The pressures: over the grid if they are asked for, else those of the load; `None` without either, and where nothing is pressed.
    pub pressure: Option<PartPressure>,
    /// Where the time went.
    pub timings: Timings,
}

impl Analysis {
    /// Fills the grid and cuts the patch out of its window; runs on the threads of the current rayon pool.
    ///
    /// # Errors
    /// The Report's method where it has no formula; the quadratic one at a kink; a patch that cannot be meshed.
    pub fn new(site: &Site, question: &Question) -> Result<Self> {
        let (placement, xi) = (&site.contact.placement, &site.grid.xi);
        check_method(placement, question.method)?;
        let start = Instant::now();
        let eta = EtaAxis::new(&site.grid.eta);
        let mut plan = plan(placement, xi, &eta, question.tolerance, question.method);
        let planned = Instant::now();
        let mut separation = vec![0.0; xi.len() * eta.eta.len()];
        plan.fill(placement, xi, &eta, &mut separation);
        let filled = Instant::now();
        let patch = site.patch();
        let cut = Instant::now();
        let mesh = |patch: &Patch| StripMesh::new(placement, patch, StripCounts::default());
        let strips = patch.as_ref().map(mesh).transpose()?;
        let meshed = Instant::now();
        let conformal = Conformal::new(site, question.tolerance);
        let unrolled = Instant::now();
        let pressure = PartPressure::new(site, question)?;
        let timings = Timings {
            load_s: site.contact.load_s,
            plan_s: (planned - start).as_secs_f64(),
            grid_s: (filled - planned).as_secs_f64(),
            patch_s: (cut - filled).as_secs_f64(),
            mesh_s: (meshed - cut).as_secs_f64(),
            conformal_s: (unrolled - meshed).as_secs_f64(),
            pressure_s: unrolled.elapsed().as_secs_f64(),
        };
        Ok(Self { separation, plan, patch, strips, conformal, pressure, timings })
    }
}

/// Refuses a method that has no formula for a placed pair: the quadratic one needs a smooth contact, those by columns a round wheel, and
/// the Report's knows no yaw, no rollers, no bodies that vary and no wheels of parametric curves.
///
/// # Errors
/// Says what the pair has that the method does not know, with the place "grid: method".
pub fn check_method(placement: &Placement, method: Option<Method>) -> Result<()> {
    let missing = match method {
        Some(Method::Quadratic) if quadratic_form(placement).iter().any(|c| c.is_nan()) => {
            Some("a contact at a kink or end")
        }
        method => method.and_then(|method| method.missing(placement)),
    };
    let (Some(method), Some(missing)) = (method, missing) else { return Ok(()) };
    let found = format!("{} with {missing}", method.name());
    let expected = "another method: this one has no formula for it";
    Err(Error::new("grid: method", found, expected, "leave the method to \"auto\""))
}

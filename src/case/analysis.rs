//! One placed pair from question to numbers.

use std::sync::OnceLock;
use std::time::Instant;

use serde::Serialize;

use crate::error::{Error, Result};
use crate::load::feasibility::{Feasibility, feasibility};
use crate::load::hertz::{Curvatures, Elastic, Ellipse, curvatures, effective_modulus};
use crate::load::virtual_interpenetration::{Estimate, approach_under_load};
use crate::mesh::strips::{Counts, StripMesh};
use crate::patch::{Patch, Window};
use crate::placement::Placement;
use crate::separation::axis::EtaAxis;
use crate::separation::grid::Method;
use crate::separation::methods::quadratic::quadratic_form;
use crate::separation::methods::report_newton;
use crate::separation::plan::{Plan, plan};
use crate::separation::values::Values;

/// How far the bodies approach, and how that is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ApproachBy {
    /// δ is given \[mm\].
    Given(f64),
    /// δ is estimated from a normal load \[N\].
    Load(f64),
}

/// What is asked of a placed pair.
#[derive(Debug, Clone, PartialEq)]
pub struct Question {
    /// The approach, or `None` for geometry only.
    pub approach: Option<ApproachBy>,
    /// Elastic constants of rail and wheel.
    pub material: [Elastic; 2],
    /// Absolute tolerance on s \[mm\].
    pub tolerance: f64,
    /// A method of the ladder, or `None` for the cheapest within the tolerance.
    pub method: Option<Method>,
    /// Parts of the patch closer than this are one \[mm\].
    pub merge: f64,
}

/// Seconds spent in the parts of an analysis.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Timings {
    /// Estimating the approach from the load; 0 for a given approach.
    pub load_s: f64,
    /// Choosing the method.
    pub plan_s: f64,
    /// Filling the grid.
    pub grid_s: f64,
    /// Boundary, area, perimeter, where they were not known from sizing the grid.
    pub patch_s: f64,
    /// Boundary-fitted mesh.
    pub mesh_s: f64,
}

/// What Hertz's ellipse belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum EllipseUnder {
    /// The load of the scene: its δ differs from an estimate by virtual interpenetration.
    Load,
    /// The approach of the scene.
    Approach,
}

/// The contact point and what follows from it without a grid.
#[derive(Debug, Clone)]
pub struct Contact {
    /// The placed pair.
    pub placement: Placement,
    /// (4.1), or `None` where the bodies nowhere lie over each other.
    pub feasibility: Feasibility,
    /// Principal curvatures of s at C.
    pub curvatures: Curvatures,
    /// δ \[mm\], and the method of its estimate.
    pub approach: Option<(f64, Option<Estimate>)>,
    /// Hertz's ellipse under what was asked for, where s is convex at C.
    pub ellipse: Option<Ellipse>,
    /// Whether that is the load or the approach.
    pub ellipse_under: Option<EllipseUnder>,
    /// Seconds spent on estimating the approach.
    pub load_s: f64,
    /// The patch over the whole plane, once it was asked for.
    whole_patch: OnceLock<Patch>,
}

impl Contact {
    /// Feasibility, curvatures and approach of a placed pair.
    ///
    /// # Errors
    /// Bodies that nowhere lie over each other; a load that no approach carries.
    pub fn new(placement: Placement, question: &Question) -> Result<Self> {
        let Some(feasibility) = feasibility(&placement) else {
            let expected = "two profiles that lie over each other in the contact frame";
            return Err(Error::new("contact", "no common ξ", expected, "choose other contact points"));
        };
        let curvatures = curvatures(&placement);
        let [rail, wheel] = &question.material;
        let modulus = effective_modulus(rail, wheel);
        let start = Instant::now();
        let (approach, ellipse, under) = match question.approach {
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

    /// The patch over the whole plane, found once; `None` without an approach.
    pub fn whole_patch(&self) -> Option<&Patch> {
        let (approach, _) = self.approach?;
        Some(self.whole_patch.get_or_init(|| Patch::new(&self.placement, approach, &Window::UNBOUNDED)))
    }

    /// The patch in a window: the whole one's components where they are known and the window cuts none.
    fn patch_in(&self, window: &Window) -> Option<Patch> {
        let (approach, _) = self.approach?;
        let known = self.whole_patch.get().and_then(|patch| patch.within(window));
        Some(known.unwrap_or_else(|| Patch::new(&self.placement, approach, window)))
    }
}

/// The separation over a grid and the patch in its window.
#[derive(Debug, Clone)]
pub struct Analysis {
    /// ξ \[mm\], ascending.
    pub xi: Vec<f64>,
    /// η \[mm\], ascending.
    pub eta: Vec<f64>,
    /// s \[mm\] at i_ξ · n_η + i_η; NaN where a body has no surface.
    pub separation: Values,
    /// Method, error estimate and reason.
    pub plan: Plan,
    /// The patch in the window of the grid, when there is an approach.
    pub patch: Option<Patch>,
    /// The boundary-fitted mesh over the patch.
    pub strips: Option<StripMesh>,
    /// Where the time went.
    pub timings: Timings,
}

impl Analysis {
    /// Fills the grid and cuts the patch out of its window; runs on the threads of the current rayon pool.
    ///
    /// # Errors
    /// The Report's method where it has no formula; the quadratic one at a kink; a patch that cannot be meshed.
    pub fn new(contact: &Contact, xi: Vec<f64>, eta: Vec<f64>, question: &Question) -> Result<Self> {
        let placement = &contact.placement;
        check_method(placement, question.method)?;
        let start = Instant::now();
        let axis = EtaAxis::new(&eta);
        let mut plan = plan(placement, &xi, &axis, question.tolerance, question.method);
        let planned = Instant::now();
        let mut separation = Values::new(xi.len() * eta.len());
        plan.fill(placement, &xi, &axis, &mut separation);
        let filled = Instant::now();
        let window = window(&xi, &eta);
        let patch = contact.patch_in(&window);
        let cut = Instant::now();
        let mesh = |patch: &Patch| StripMesh::new(placement, patch, Counts::default());
        let strips = patch.as_ref().map(mesh).transpose()?;
        let timings = Timings {
            load_s: contact.load_s,
            plan_s: (planned - start).as_secs_f64(),
            grid_s: (filled - planned).as_secs_f64(),
            patch_s: (cut - filled).as_secs_f64(),
            mesh_s: cut.elapsed().as_secs_f64(),
        };
        Ok(Self { xi, eta, separation, plan, patch, strips, timings })
    }

    /// The rectangle between the outermost points of the grid.
    pub fn window(&self) -> Window {
        window(&self.xi, &self.eta)
    }
}

/// Whether the method that is asked for has a formula for the pair.
fn check_method(placement: &Placement, method: Option<Method>) -> Result<()> {
    let missing = match method {
        Some(Method::ReportNewton) => report_newton::missing(placement),
        Some(Method::Quadratic) if quadratic_form(placement).iter().any(|c| c.is_nan()) => {
            Some("a contact at a kink or end")
        }
        _ => None,
    };
    let (Some(method), Some(missing)) = (method, missing) else { return Ok(()) };
    let found = format!("{} with {missing}", method.name());
    let expected = "another method: this one has no formula for it";
    Err(Error::new("grid: method", found, expected, "leave the method to \"auto\""))
}

fn window(xi: &[f64], eta: &[f64]) -> Window {
    Window { xi: ends(xi), eta: ends(eta) }
}

/// First and last value.
fn ends(values: &[f64]) -> [f64; 2] {
    match values {
        [first, .., last] => [*first, *last],
        [only] => [*only; 2],
        [] => [0.0; 2],
    }
}

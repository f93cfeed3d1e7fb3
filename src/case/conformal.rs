//! The normal gap over the rail's surface, and the warning to a case over the plane whose patch turns too much for it.

use serde_json::{Value, json};

use super::site::{Site, ends};
use crate::conformal::{NormalGap, RailPoint, fill_normal_gap};
use crate::numerics::interval::Interval;
use crate::patch::{Component, End, Patch, Window};
use crate::separation::{EtaAxis, Evaluator};

/// Turn of the rail's normal within the patch \[rad\] above which the plane's gap is too long by more than 3 %: 15°.
const MOST_TURN: f64 = 15.0 * std::f64::consts::PI / 180.0;

/// The normal gap over a grid of the rail's surface, and the conformal patch.
#[derive(Debug, Clone)]
pub struct Conformal {
    /// The rail's point and normal at every σ.
    pub rail: Vec<RailPoint>,
    /// t \[mm\] at i_σ · n_η + i_η; NaN where it is undefined.
    pub gap: Vec<f64>,
    /// Largest measured truncation error of t \[mm\].
    pub truncation: f64,
    /// The patch in the window of the grid; `None` without an approach, and on a grid of one row or column.
    pub patch: Option<Patch>,
    /// Range of the angle α of the rail's normal \[rad\] within each component of the patch.
    pub angles: Vec<Interval>,
}

impl Conformal {
    /// Fills the grid of a site; `None` for one over the tangent plane.
    pub(super) fn new(site: &Site, tolerance: f64) -> Option<Self> {
        let sigma = site.grid.sigma.as_ref()?;
        let gap = NormalGap::new(&site.contact.placement);
        let mut values = vec![0.0; sigma.len() * site.grid.eta.len()];
        let truncation = fill_normal_gap(&gap, sigma, &EtaAxis::new(&site.grid.eta), tolerance, &mut values);
        let window = Window { xi: ends(sigma), eta: ends(&site.grid.eta) };
        let approach = site.contact.approach.filter(|_| site.has_extent());
        let patch = approach.map(|approach| Patch::over_rail(&site.contact.placement, approach, &window));
        let components = patch.iter().flat_map(|patch| &patch.components);
        let angles = components.map(|component| gap.angles(component.xi)).collect();
        let rail = sigma.iter().filter_map(|&sigma| gap.rail().point(sigma)).collect();
        Some(Self { rail, gap: values, truncation, patch, angles })
    }

    /// Gives what the summary says.
    pub(super) fn summary(&self) -> Value {
        let patch = |patch: &Patch| {
            let parts = patch.components.iter().zip(&self.angles).map(|(part, angle)| {
                json!({
                    "sigma_extent_mm": part.xi,
                    "eta_extent_mm": part.eta,
                    "cut": is_cut(part),
                    "area_mm2": part.area,
                    "angle_extent_rad": angle,
                    "turn_rad": angle.width(),
                })
            });
            json!({ "area_mm2": patch.area(), "components": parts.collect::<Vec<_>>() })
        };
        json!({
            "n_sigma": self.rail.len(),
            "sigma_extent_mm": [self.rail.first().map(|at| at.sigma), self.rail.last().map(|at| at.sigma)],
            "undefined_points": self.gap.iter().filter(|t| t.is_nan()).count(),
            "truncation_mm": self.truncation,
            "patch": self.patch.as_ref().map(patch),
        })
    }
}

/// Returns whether the window or an end of a surface cuts a part.
fn is_cut(part: &Component) -> bool {
    part.cut_by_window || part.ends.contains(&End::ProfileEnd)
}

/// Says by how much the plane's gap is too long, if the rail's normal turns by more than 15° within the patch of a grid over
/// the plane; and that the window cuts a conformal patch.
pub(super) fn turning_warning(
    site: &Site,
    patch: Option<&Patch>,
    conformal: Option<&Conformal>,
) -> Option<String> {
    if let Some(conformal) = conformal {
        let cut = conformal.patch.as_ref()?.components.iter().any(is_cut);
        return cut.then(|| "the window of the grid cuts the conformal patch t < delta cos(alpha)".into());
    }
    let placement = &site.contact.placement;
    let gap = NormalGap::new(placement);
    let turns = patch?.components.iter().filter_map(|component| {
        let points = component.xi.ends().map(|xi| gap.rail().point(gap.rail().sigma(xi)));
        let [Some(a), Some(b)] = points else { return None };
        let turn = |at: &RailPoint| at.sin.atan2(at.cos);
        let steeper = if turn(&a).abs() > turn(&b).abs() { a } else { b };
        Some(((turn(&a) - turn(&b)).abs(), steeper))
    });
    let (turn, at) = turns.max_by(|a, b| a.0.total_cmp(&b.0)).filter(|(turn, _)| *turn > MOST_TURN)?;
    // Under skew a tip lies off the midplane; both gaps are compared at η = 0.
    let s = Evaluator::new(placement).separation(at.xi, 0.0);
    let t = gap.gap(at.sigma, 0.0);
    let own = if t.is_nan() {
        "the rail's own meets no wheel".into()
    } else {
        format!("along the rail's own {t:.4e} mm ({:+.1} %)", 100.0 * (s - t) / t)
    };
    Some(format!(
        "the rail's normal turns by {:.1} degrees within the patch: at xi = {:.3} mm the gap along the fixed normal is {s:.4e} mm, \
         {own}; a conformal solver needs grid.reference = \"rail\"",
        turn.to_degrees(),
        at.xi,
    ))
}

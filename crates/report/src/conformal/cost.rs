//! Times grids of the normal gap against grids of s over the same windows.

use super::values::GapReference;
use crate::speed::{LEAST_RUNS, Timing, race, timed};
use wheelrail::Interval;
use wheelrail::conformal::{NormalGap, fill_normal_gap};
use wheelrail::error::Result;
use wheelrail::mesh::equal_steps;
use wheelrail::separation::{EtaAxis, FULL_PRECISION, Method, plan};

/// The times of one grid.
#[derive(Debug, Clone, PartialEq)]
pub struct GapCost {
    /// Name of the scene.
    pub scene: String,
    /// Number n of the n × n grid.
    pub side: usize,
    /// Shortest time of t over the grid of σ and η \[s\].
    pub normal_gap: f64,
    /// Shortest time of s over the grid of ξ and η \[s\], by spectral columns.
    pub separation: f64,
}

impl GapCost {
    /// Returns the time of t over that of s.
    pub fn ratio(&self) -> f64 {
        self.normal_gap / self.separation
    }
}

/// Times n × n points over the window of a scene's values, t and s at full precision, each for at least `seconds`. Call it on
/// one thread.
///
/// # Errors
/// The errors of [`GapReference::placement`].
pub fn gap_cost(reference: &GapReference, side: usize, seconds: f64) -> Result<GapCost> {
    let placement = reference.placement()?;
    let gap = NormalGap::new(&placement);
    let [sigma, eta] = reference.scene.axes();
    let reach = eta.iter().fold(0.0, |most: f64, eta| most.max(eta.abs()));
    let axis = EtaAxis::new(&equal_steps(-reach, reach, side));
    let over = gap.rail().reach().map_or(Interval::of(0.0), |reach| reach.cut(Interval::around(sigma)));
    let sigma = equal_steps(over.low, over.high, side);
    let xi = over.map(|at| gap.rail().point(at).map_or(0.0, |at| at.xi));
    let xi = equal_steps(xi.low, xi.high, side);
    let choice = plan(&placement, &xi, &axis, FULL_PRECISION, Some(Method::Spectral)).choice;
    let mut values = vec![0.0; side * side];
    values.fill(0.0);
    let mut timings = [Timing::NONE; 2];
    race(&mut timings, seconds, LEAST_RUNS, |contestant| {
        timed(|| match contestant {
            0 => drop(fill_normal_gap(&gap, &sigma, &axis, FULL_PRECISION, &mut values)),
            _ => drop(choice.fill(&placement, &xi, &axis, &mut values)),
        })
    });
    let [normal_gap, separation] = timings.map(|timing| timing.best);
    Ok(GapCost { scene: reference.name.clone(), side, normal_gap, separation })
}

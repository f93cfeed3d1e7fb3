//! Measures the normal gap of conformal contact: [`values`] its errors, [`cost`] its time, [`pairs`] what it changes.

pub mod cost;
pub mod pairs;
pub mod values;

use cost::{GapCost, gap_cost};
use pairs::{ConformingPair, conforming_pairs};
use values::{GapErrors, GapReference, gap_references};
use wheelrail::conformal::NormalGap;
use wheelrail::error::Result;
use wheelrail_check::{NormalGapReport, NormalGapSample, check_normal_gap};

/// All figures of the normal gap.
#[derive(Debug, Clone)]
pub struct NormalGapFigures {
    /// The scenes with 60-digit values.
    pub scenes: Vec<GapScene>,
    /// The conforming pairs.
    pub pairs: Vec<ConformingPair>,
}

/// The figures of one scene.
#[derive(Debug, Clone, PartialEq)]
pub struct GapScene {
    /// Name of the scene.
    pub name: String,
    /// Whether the wheel is skewed.
    pub skewed: bool,
    /// Errors against the 60-digit values of single points, and of grids.
    pub errors: [GapErrors; 2],
    /// Times of grids.
    pub costs: Vec<GapCost>,
    /// Result of the check by closest distances.
    pub check: NormalGapReport,
}

/// Measures all figures, with n × n grids for every n in `sides` and at least `seconds` for each. Call it on one thread.
///
/// # Errors
/// Embedded files that are not in their format.
pub fn normal_gap_figures(sides: &[usize], seconds: f64) -> Result<NormalGapFigures> {
    let scene = |reference: &GapReference| {
        let placement = reference.placement()?;
        let costs = sides.iter().map(|&side| gap_cost(reference, side, seconds)).collect::<Result<_>>()?;
        let gap = NormalGap::new(&placement);
        let values = reference.normal_gap.iter();
        let samples: Vec<_> =
            values.filter_map(|value| NormalGapSample::at(&gap, value.sigma, value.eta)).collect();
        Ok(GapScene {
            name: reference.name.clone(),
            skewed: reference.skewed(),
            errors: [false, true].map(|grid| reference.errors(&placement, grid)),
            costs,
            check: check_normal_gap(&placement, &samples)?,
        })
    };
    let scenes = gap_references()?.iter().map(scene).collect::<Result<_>>()?;
    Ok(NormalGapFigures { scenes, pairs: conforming_pairs()? })
}

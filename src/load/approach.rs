//! The approach δ that a load causes: where Hertz's closed form holds, and the root of a load that grows with it.

use serde::Serialize;

use super::hertz::{Curvatures, Ellipse};
use crate::numerics::quadrature::integral;
use crate::patch::Window;
use crate::placement::Placement;
use crate::separation::methods::quadratic::quadratic_form;
use crate::separation::midplane_gap;

/// Largest mean departure of the gap from its parabola over Hertz's ellipse, relative to δ, for which curvature is taken
/// to be constant. Against Tamaas (table in the docs) Hertz then errs by 0.1 %; at 0.8 % by more than 1 %.
const CONSTANT_CURVATURE: f64 = 0.005;

/// Largest difference of the patch's extent from that of the parabola, relative: where it is larger the patch reaches into
/// other curvatures, which carry load.
const SAME_EXTENT: f64 = 0.05;

/// Demand on a mean that is only compared.
const COARSE: f64 = 1e-3;

/// Demand on the load, relative: far below the error of either estimate.
const FINE_ENOUGH: f64 = 1e-6;

/// How a load grows with the approach where it is looked for: as δ^3/2, after Hertz.
const USUAL_SLOPE: f64 = 1.5;

/// Least approach that is looked for \[mm\].
const LEAST: f64 = 1e-9;

/// How the loads of approaches were estimated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Estimate {
    /// Hertz's ellipse: curvature is constant over the patch.
    Hertz,
    /// An elastic half-space of some 500 cells of constant pressure.
    HalfSpace,
}

/// Tells whether Hertz's ellipse \[mm\] holds in a patch whose box is `extent`: the gap follows its parabola over the ellipse,
/// and the patch ends where the parabola's does.
///
/// To first order δ changes under a constant load by the departure, weighted by a flat punch's pressure (Betti), which
/// summed up along η is the same at every ξ: by the mean departure over the ellipse's extent in ξ. It counts here without
/// its sign, as what cancels in δ is still no ellipse.
pub fn hertz_holds(
    placement: &Placement,
    curvatures: &Curvatures,
    ellipse: &Ellipse,
    extent: &Window,
) -> bool {
    let [xx, xy, yy] = quadratic_form(placement);
    let determinant = xx * yy - xy * xy / 4.0;
    let reaches = [yy, xx].map(|other| (ellipse.approach_mm * other / determinant).sqrt());
    let ends = |[from, to]: [f64; 2], reach: f64| {
        (from + reach).abs() <= SAME_EXTENT * reach && (to - reach).abs() <= SAME_EXTENT * reach
    };
    if !ends(extent.xi, reaches[0]) || !ends(extent.eta, reaches[1]) {
        return false;
    }
    let placement = &placement.without_skew();
    let (sin, cos) = curvatures.long_axis_rad.sin_cos();
    let reach = (ellipse.a_mm * cos).hypot(ellipse.b_mm * sin);
    let [along, ..] = quadratic_form(placement);
    let mut departure = |xi: f64| (midplane_gap(placement, xi) - along * xi * xi).abs();
    let sum = integral(&mut departure, -reach, 0.0, COARSE) + integral(&mut departure, 0.0, reach, COARSE);
    sum / (2.0 * reach) <= CONSTANT_CURVATURE * ellipse.approach_mm
}

/// Finds the approach \[mm\] up to `most` at which `total`, a load that grows with it from 0, is `load`; `None` if none is.
///
/// Method: secants of ln N over ln δ, nearly a line, from `guess` on, with a bisection as every third step for where N jumps.
/// Accuracy: 1e-6 of the load, or the approach of a jump. Cost: some six evaluations.
pub fn under_total(mut total: impl FnMut(f64) -> f64, load: f64, guess: f64, most: f64) -> Option<f64> {
    let range = [LEAST, most].map(f64::ln);
    let ([mut low, mut high], mut here, mut slope) = (range, guess.ln(), USUAL_SLOPE);
    if !(here > low && here < high) {
        here = low + (high - low) / 2.0;
    }
    let (mut before, mut steps): (Option<[f64; 2]>, u32) = (None, 0);
    while high - low > FINE_ENOUGH {
        let miss = (load / total(here.exp())).ln();
        if miss.abs() <= FINE_ENOUGH {
            return Some(here.exp());
        }
        *(if miss > 0.0 { &mut low } else { &mut high }) = here;
        if let Some([there, missed]) = before.filter(|[_, missed]| missed.is_finite() && miss.is_finite()) {
            slope = ((missed - miss) / (here - there)).clamp(0.5 * USUAL_SLOPE, 4.0 * USUAL_SLOPE);
        }
        before = Some([here, miss]);
        steps += 1;
        let secant = here + miss / slope;
        let inside = secant > low && secant < high && steps % 3 != 0;
        here = if inside { secant } else { low + (high - low) / 2.0 };
    }
    (high < range[1]).then(|| high.exp())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Result;
    use crate::load::curvatures;
    use crate::patch::Patch;
    use crate::placement::Pair;
    use crate::profile::standards;

    #[test]
    fn approaches_of_growing_loads_are_found() {
        for load in [1e-3, 1.0, 4e4, 1e9] {
            let found = under_total(|u| 3e6 * u.powf(1.5) + 1e7 * (u - 0.1).max(0.0), load, 0.05, 100.0);
            let miss = found.map(|u| (3e6 * u.powf(1.5) + 1e7 * (u - 0.1).max(0.0)) / load - 1.0);
            assert!(miss.is_some_and(|miss| miss.abs() < 1e-5), "{load}: {found:?} {miss:?}");
        }
        assert_eq!(under_total(|u| u, 11.0, 0.05, 10.0), None);
        // A load that jumps over the one that is asked for: the jump.
        let jump = under_total(|u| if u < 0.2 { u } else { 2.0 + u }, 1.0, 0.05, 10.0);
        assert!(jump.is_some_and(|u| (u - 0.2).abs() < 1e-5), "{jump:?}");
    }

    #[test]
    fn hertz_holds_on_a_tread_and_not_over_a_jump_of_curvature() -> Result<()> {
        let rail = standards::rail("60E1")?;
        let cone = Pair::new(rail.clone(), standards::wheel("cone-1:40")?, 460.0)?;
        let worn = Pair::new(rail, standards::wheel("S1002")?, 460.0)?;
        for (pair, rail_x, wheel_x, holds) in [(&cone, 0.0, 0.0, true), (&worn, -10.6, -10.0, false)] {
            let placement = pair.placed(rail_x, wheel_x, 0.0)?;
            let curvatures = curvatures(&placement);
            let Some(ellipse) = curvatures.under_approach(0.02, 1e5) else { panic!("no ellipse") };
            let Some(extent) = Patch::new(&placement, 0.02, &Window::UNBOUNDED).extent() else {
                panic!("no patch")
            };
            assert_eq!(hertz_holds(&placement, &curvatures, &ellipse, &extent), holds, "{rail_x}");
        }
        Ok(())
    }
}

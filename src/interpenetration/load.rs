//! The approach δ that a normal load causes: an estimate, by Hertz or by virtual interpenetration.

use serde::Serialize;

use super::Slicer;
use super::measure::settled;
use crate::contact::hertz::{Curvatures, curvatures};
use crate::error::{Error, Result};
use crate::numerics::elliptic::complete;
use crate::numerics::roots::bracketed;
use crate::placement::Placement;
use crate::separation::gap::midplane_gap;

/// Share of δ by which Kik and Piotrowski let the bodies overlap: the surfaces between settle the rest.
const VIRTUAL_SHARE: f64 = 0.55;

/// Largest departure of the gap from its parabola at the ends of Hertz's ellipse, relative to it, for which
/// Hertz's assumption of constant curvature is taken to hold: the load then errs by less.
const CONSTANT_CURVATURE: f64 = 0.05;

/// Demand on the two integrals and on δ, relative: far below the error of the model.
const FINE_ENOUGH: f64 = 1e-7;

/// How δ was estimated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Estimate {
    /// Hertz's ellipse: curvature is constant over the patch.
    Hertz,
    /// Virtual interpenetration after Kik and Piotrowski: curvature changes inside the patch.
    VirtualInterpenetration,
}

/// δ \[mm\] for a load \[N\], with the method; `modulus` is E* \[N/mm²\].
///
/// An estimate, not a solution: within about 1e-3 of it for Hertzian geometry, within 10–20 % otherwise.
///
/// # Errors
/// A load that no approach below the wheel's own radius carries.
pub fn approach_under_load(placement: &Placement, load: f64, modulus: f64) -> Result<(f64, Estimate)> {
    if load == 0.0 {
        return Ok((0.0, Estimate::Hertz));
    }
    let curvatures = curvatures(placement);
    if let Some(ellipse) = curvatures.under_load(load, modulus)
        && constant_curvature(placement, &curvatures, ellipse.a_mm, ellipse.b_mm)
    {
        return Ok((ellipse.approach_mm, Estimate::Hertz));
    }
    // ln δ over all lengths that matter: from an atom to the wheel.
    let range = [1e-7f64, placement.rolling_radius().min(10.0)].map(f64::ln);
    let miss = |ln: f64| virtual_load(placement, ln.exp(), modulus).unwrap_or(0.0) - load;
    let root = bracketed_coarsely(miss, range);
    root.map(|ln| (ln.exp(), Estimate::VirtualInterpenetration)).ok_or_else(|| {
        let expected = "a load that an approach of 1e-7 to 10 mm carries";
        Error::new(
            "patch: load",
            format!("{load} N"),
            expected,
            "check the unit of the load and the contact point",
        )
    })
}

/// The load \[N\] that virtual interpenetration gives for δ \[mm\]: N = π E* δ I₁/I₂ with I₁ = ∬ √(l² − η²),
/// I₂ = ∬ √(l² − η²)/√(ξ² + η²) over the overlap at 0.55 δ, half width l(ξ). `None` where C does not overlap.
///
/// The skew is left out: it turns the overlap about C, and changes the load by its square.
pub fn virtual_load(placement: &Placement, approach: f64, modulus: f64) -> Option<f64> {
    let placement = &Placement { skew: 0.0, ..placement.clone() };
    let mut slicer = Slicer::new(placement, VIRTUAL_SHARE * approach);
    slicer.slice(0.0)?;
    let [first, last] = placement.overlap()?;
    let ends = [first, last].map(|end| end_of_overlap(&mut slicer, end));
    let mut half_width = |xi: f64| slicer.slice(xi).map_or(0.0, |s| (s.eta[1] - s.eta[0]) / 2.0);
    let (mut first_integral, mut second_integral) = (0.0, 0.0);
    for end in ends {
        // ξ = end (1 − (1 − t)²) t-graded at both ends: a square root at the tip, a logarithm at C.
        let graded = |t: f64| (end * t * t * (3.0 - 2.0 * t), end.abs() * 6.0 * t * (1.0 - t));
        first_integral += settled(
            &mut |t| {
                let (xi, step) = graded(t);
                std::f64::consts::FRAC_PI_2 * half_width(xi).powi(2) * step
            },
            0.0,
            1.0,
            FINE_ENOUGH,
        );
        second_integral += settled(
            &mut |t| {
                let (xi, step) = graded(t);
                let l = half_width(xi);
                let hypotenuse = l.hypot(xi);
                if hypotenuse == 0.0 {
                    0.0
                } else {
                    2.0 * l * l / hypotenuse * complete(xi.abs() / hypotenuse)[1] * step
                }
            },
            0.0,
            1.0,
            FINE_ENOUGH,
        );
    }
    Some(std::f64::consts::PI * modulus * approach * first_integral / second_integral)
}

/// Where the overlap that contains C ends, going towards `end`.
fn end_of_overlap(slicer: &mut Slicer<'_>, end: f64) -> f64 {
    let points = crate::contact::feasibility::critical_points(slicer.placement(), end.min(0.0), end.max(0.0));
    let mut outward = points;
    if end < 0.0 {
        outward.reverse();
    }
    for pair in outward.windows(2) {
        let (inside, outside) = (slicer.depth(pair[0]), slicer.depth(pair[1]));
        if inside < 0.0 && (outside >= 0.0 || outside.is_nan()) {
            return bracketed(|xi| slicer.depth(xi), pair[0], pair[1]).unwrap_or(pair[1]);
        }
    }
    end
}

/// Whether the gap follows its parabola to the ends of the ellipse in ξ.
fn constant_curvature(placement: &Placement, curvatures: &Curvatures, a: f64, b: f64) -> bool {
    let (cos, sin) = (curvatures.long_axis_rad.cos(), curvatures.long_axis_rad.sin());
    let reach = (a * cos).hypot(b * sin);
    let [along, ..] = crate::separation::approximate::quadratic_form(placement);
    [-reach, reach].into_iter().all(|xi| {
        let parabola = along * xi * xi;
        (midplane_gap(placement, xi) - parabola).abs() <= CONSTANT_CURVATURE * parabola
    })
}

/// A root to a relative accuracy far below the model's, where every evaluation costs two quadratures.
fn bracketed_coarsely(mut f: impl FnMut(f64) -> f64, [mut low, mut high]: [f64; 2]) -> Option<f64> {
    let (mut f_low, f_high) = (f(low), f(high));
    if !(f_low < 0.0 && f_high > 0.0) {
        return None;
    }
    while high - low > FINE_ENOUGH {
        let middle = low + (high - low) / 2.0;
        let value = f(middle);
        if value < 0.0 {
            (low, f_low) = (middle, value);
        } else {
            high = middle;
        }
    }
    f_low.is_finite().then_some(low + (high - low) / 2.0)
}
#[cfg(test)]
mod tests {
    use super::*;
    use crate::placement::Pair;
    use crate::profile::{Arc, Half, Profile, Segment};

    fn crossed_cylinders() -> Result<Placement> {
        let rail = Arc::about([0.0, -300.0], 300.0, Half::Upper, [-30.0, 30.0])?;
        let wheel = Arc::line([-30.0, 0.0], [30.0, 0.0])?;
        let profile = |arc| Profile::new("test", "test", vec![Segment::arc(arc)]);
        Pair::new(profile(rail)?, profile(wheel)?, 460.0)?.placed(0.0, 0.0, 0.0)
    }

    #[test]
    fn hertz_where_curvature_is_constant() -> Result<()> {
        let (approach, estimate) = approach_under_load(&crossed_cylinders()?, 80e3, 113_932.0)?;
        assert_eq!(estimate, Estimate::Hertz);
        assert!((approach - 0.090_487_9).abs() < 1e-6, "{approach}");
        Ok(())
    }

    #[test]
    fn virtual_interpenetration_is_within_a_few_per_cent_of_hertz() -> Result<()> {
        let load = virtual_load(&crossed_cylinders()?, 0.090_487_9, 113_932.0);
        assert!(load.is_some_and(|load| (load / 80e3 - 1.0).abs() < 0.05), "{load:?}");
        Ok(())
    }
}

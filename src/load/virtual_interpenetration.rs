//! The approach δ that a normal load causes: an estimate, by Hertz or by virtual interpenetration.

use std::f64::consts::{FRAC_PI_2, PI};

use serde::Serialize;

use super::hertz::{Curvatures, Ellipse, curvatures};
use crate::error::{Error, Result};
use crate::numerics::elliptic::complete;
use crate::numerics::quadrature::integral;
use crate::numerics::roots::bracketed;
use crate::patch::{Grading, Slicer};
use crate::placement::Placement;
use crate::separation::methods::quadratic::quadratic_form;
use crate::separation::midplane_gap;

/// Share of δ by which Kik and Piotrowski let the bodies overlap: the surfaces between settle the rest.
const VIRTUAL_SHARE: f64 = 0.55;

/// Largest mean departure of the gap from its parabola over Hertz's ellipse, relative to δ, for which curvature is taken
/// to be constant. Against Tamaas (table in the docs) Hertz then errs by 0.1 %; at 0.8 % by more than 1 %, and
/// virtual interpenetration is the better one.
const CONSTANT_CURVATURE: f64 = 0.005;

/// Demand on the integrals and on δ, relative: far below the error of the model.
const FINE_ENOUGH: f64 = 1e-7;

/// Demand on a mean that is only compared.
const COARSE: f64 = 1e-3;

/// Where δ \[mm\] is looked for first, and how N grows with it there: N ∝ δ^3/2 after Hertz.
const USUAL_APPROACH: f64 = 0.05;
const USUAL_SLOPE: f64 = 1.5;

/// How δ was estimated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Estimate {
    /// Hertz's ellipse: curvature is constant over the patch.
    Hertz,
    /// Virtual interpenetration after Kik and Piotrowski, scaled to be Hertz's on an ellipse: curvature changes inside
    /// the patch.
    VirtualInterpenetration,
}

/// δ \[mm\] for a load \[N\], with the method; `modulus` is E* \[N/mm²\].
///
/// An estimate for one half-space, not a solution: within 0.3 % of Tamaas on treads and flanges, within 3 % at a flange
/// root, 10 % above where the load reaches a second place of contact (table in the docs).
///
/// # Errors
/// A load that no approach of 1e-7 to 10 mm carries.
///
/// # Examples
/// ```
/// # use wheelrail::{Arc, Half, Pair, Profile, Segment};
/// use wheelrail::load::{Estimate, approach_under_load};
/// # let rail = Arc::about([0.0, -300.0], 300.0, Half::Upper, [-35.0, 35.0])?;
/// # let rail = Profile::new("crown", "", vec![Segment::arc(rail)])?;
/// # let wheel = Profile::new("cylinder", "", vec![Segment::arc(Arc::line([-60.0, 0.0], [60.0, 0.0])?)])?;
/// # let pair = Pair::new(rail, wheel, 460.0)?;
/// let placement = pair.placed(0.0, 0.0, 0.0)?; // a crown of 300 mm below a cylinder of 460 mm
/// let (approach, by) = approach_under_load(&placement, 80_000.0, 113_932.3)?;
/// assert!((approach - 0.090_487_9).abs() < 1e-6 && by == Estimate::Hertz);
/// # Ok::<(), wheelrail::Error>(())
/// ```
pub fn approach_under_load(placement: &Placement, load: f64, modulus: f64) -> Result<(f64, Estimate)> {
    if load == 0.0 {
        return Ok((0.0, Estimate::Hertz));
    }
    let curvatures = curvatures(placement);
    if let Some(ellipse) = curvatures.under_load(load, modulus)
        && constant_curvature(placement, &curvatures, &ellipse)
    {
        return Ok((ellipse.approach_mm, Estimate::Hertz));
    }
    let found = VirtualContact::under_load(placement, load, modulus);
    found.map(|contact| (contact.approach_mm, Estimate::VirtualInterpenetration)).ok_or_else(|| {
        let expected = "a load that an approach of 1e-7 to 10 mm carries";
        Error::new(
            "patch: load",
            format!("{load} N"),
            expected,
            "check the unit of the load and the contact point",
        )
    })
}

/// What virtual interpenetration makes of an approach.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VirtualContact {
    /// δ as Kik and Piotrowski have it \[mm\].
    pub published_approach_mm: f64,
    /// The same × Hertz's δ over theirs, under one load, for the ellipse that is as long as the overlap and has its
    /// I₁ \[mm\]: Hertz's own δ where the gap is a paraboloid.
    pub approach_mm: f64,
    /// Normal load \[N\].
    pub load_n: f64,
}

impl VirtualContact {
    /// From their δ \[mm\] and E* \[N/mm²\]: N = π E* δ I₁/I₂ with I₁ = ∬ √(l² − η²) and I₂ = ∬ √(l² − η²)/√(ξ² + η²)
    /// over the overlap at 0.55 δ, half width l(ξ). `None` where C does not overlap.
    ///
    /// The skew is left out: it turns the overlap about C, and changes the load by its square.
    pub fn at(placement: &Placement, approach: f64, modulus: f64) -> Option<Self> {
        let placement = &placement.without_skew();
        let depth = VIRTUAL_SHARE * approach;
        let mut slicer = Slicer::new(placement, depth);
        slicer.slice(0.0)?;
        let [first, last] = placement.overlap()?.map(|end| end_of_overlap(&mut slicer, end));
        let mut half_width = |xi: f64| slicer.slice(xi).map_or(0.0, |s| (s.eta[1] - s.eta[0]) / 2.0);
        let mut over_overlap = |integrand: &dyn Fn(f64, f64) -> f64| {
            // A square root at the ends, a logarithm at C.
            let sides = [[first, 0.0], [0.0, last]].map(|xi| Grading { xi, round: [true; 2] });
            sides
                .into_iter()
                .map(|side| side.integral(&mut |xi| integrand(xi, half_width(xi)), FINE_ENOUGH))
                .sum::<f64>()
        };
        let i_1 = over_overlap(&|_, l| FRAC_PI_2 * l * l);
        let i_2 = over_overlap(&|xi, l| {
            let reach = l.hypot(xi);
            if reach == 0.0 { 0.0 } else { 2.0 * l * l / reach * complete(xi.abs() / reach)[1] }
        });
        let a = (last - first) / 2.0;
        // I₁ = (2π/3) a b² of an ellipse.
        let b = (1.5 * i_1 / (PI * a)).sqrt();
        Some(Self {
            published_approach_mm: approach,
            approach_mm: approach * hertz_over_published(a, b, depth)?,
            load_n: PI * modulus * approach * i_1 / i_2,
        })
    }

    /// Under a load \[N\], to 1e-7 of it; `None` where no δ of 1e-7 to 10 mm carries it.
    ///
    /// Method: secants of ln N over ln δ, nearly a line, with a bisection as every third step for where N jumps.
    /// Cost: about six evaluations of [`VirtualContact::at`], a millisecond each.
    pub fn under_load(placement: &Placement, load: f64, modulus: f64) -> Option<Self> {
        // The approaches searched.
        let range = [1e-7, placement.rolling_radius().min(10.0)].map(f64::ln);
        let ([mut low, mut high], mut here, mut slope) = (range, USUAL_APPROACH.ln(), USUAL_SLOPE);
        let mut before: Option<[f64; 2]> = None;
        let mut steps = 0;
        while high - low > FINE_ENOUGH {
            let contact = Self::at(placement, here.exp(), modulus);
            let miss = contact.map_or(f64::INFINITY, |contact| (load / contact.load_n).ln());
            if miss.abs() <= FINE_ENOUGH {
                return contact;
            }
            *(if miss > 0.0 { &mut low } else { &mut high }) = here;
            if let Some([there, missed]) = before.filter(|[_, missed]| missed.is_finite() && miss.is_finite())
            {
                slope = ((missed - miss) / (here - there)).clamp(0.5 * USUAL_SLOPE, 2.0 * USUAL_SLOPE);
            }
            before = Some([here, miss]);
            steps += 1;
            let secant = here + miss / slope;
            here = if secant > low && secant < high && steps % 3 != 0 {
                secant
            } else {
                low + (high - low) / 2.0
            };
        }
        let between = low > range[0] && high < range[1];
        Self::at(placement, high.exp(), modulus).filter(|contact| between && contact.load_n.is_finite())
    }
}

/// Hertz's δ over Kik and Piotrowski's, under one load, for a gap that is a paraboloid: its overlap at this depth has the
/// semi-axes a and b, and I₂ = π min(a, b) b K.
fn hertz_over_published(a: f64, b: f64, depth: f64) -> Option<f64> {
    let (short, long) = (a.min(b), a.max(b));
    let paraboloid =
        Curvatures { a_per_mm: depth / (long * long), b_per_mm: depth / (short * short), long_axis_rad: 0.0 };
    let published = depth / VIRTUAL_SHARE;
    // The ratio is the same for every E*.
    let load = 2.0 / 3.0 * PI * published * long / complete(short / long)[0];
    Some(paraboloid.under_load(load, 1.0)?.approach_mm / published)
}

/// Where the overlap that contains C ends, going towards `end`.
fn end_of_overlap(slicer: &mut Slicer<'_>, end: f64) -> f64 {
    let points = crate::patch::turning_points(slicer.placement(), end.min(0.0), end.max(0.0));
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

/// Whether the gap follows its parabola over the ellipse.
///
/// To first order δ changes under a constant load by the departure, weighted by a flat punch's pressure (Betti), which
/// summed up along η is the same at every ξ: by the mean departure over the ellipse's extent in ξ. Here without its
/// sign, as what cancels in δ is still no ellipse.
fn constant_curvature(placement: &Placement, curvatures: &Curvatures, ellipse: &Ellipse) -> bool {
    let placement = &placement.without_skew();
    let (sin, cos) = curvatures.long_axis_rad.sin_cos();
    let reach = (ellipse.a_mm * cos).hypot(ellipse.b_mm * sin);
    let [along, ..] = quadratic_form(placement);
    let mut departure = |xi: f64| (midplane_gap(placement, xi) - along * xi * xi).abs();
    let sum = integral(&mut departure, -reach, 0.0, COARSE) + integral(&mut departure, 0.0, reach, COARSE);
    sum / (2.0 * reach) <= CONSTANT_CURVATURE * ellipse.approach_mm
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
    fn virtual_interpenetration_of_a_paraboloid_is_hertz() -> Result<()> {
        // Circles are paraboloids up to (δ/R) of themselves.
        let contact = VirtualContact::under_load(&crossed_cylinders()?, 80e3, 113_932.0);
        let Some(contact) = contact else { panic!("no approach") };
        assert!((contact.approach_mm / 0.090_487_9 - 1.0).abs() < 2e-4, "{contact:?}");
        assert!((contact.load_n / 80e3 - 1.0).abs() < 1e-6, "{contact:?}");
        // As published it is 3 % low.
        assert!((contact.published_approach_mm / 0.090_487_9 - 0.969).abs() < 1e-3, "{contact:?}");
        Ok(())
    }
}

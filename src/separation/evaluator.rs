//! s(ξ, η), its slopes and both unit normals at single points. This is the reference for all other methods.

use nalgebra::{Unit, Vector3};

use super::columns::skewed;
use super::demand::{Demand, FULL_PRECISION};
use super::relief::Relief;
use crate::lofted::{Feet, FramedLoft};
use crate::numerics::lanes::MANY;
use crate::placement::Placement;
use crate::profile::Section;

/// Both outward unit normals (ξ, η, ζ) over one point of the tangent plane; `None` where a body has no surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Normals {
    /// Normal of the rail or roller; it points up at C.
    pub rail: Option<Unit<Vector3<f64>>>,
    /// Normal of the wheel; it points down at C.
    pub wheel: Option<Unit<Vector3<f64>>>,
}

/// The gap at one place, its slopes, and the profiles' points from which the surfaces there are swept.
#[derive(Debug, Clone, Copy)]
pub(crate) struct GapSlopes {
    /// The gap \[mm\].
    pub(crate) gap: f64,
    /// Its slopes along ξ, or σ, and η.
    pub(crate) slopes: [f64; 2],
    /// Abscissae in the contact frame \[mm\] of these points of both profiles, the wheel's first. NaN for a body that varies, and for
    /// an extruded rail.
    pub(crate) abscissae: [f64; 2],
}

/// Evaluates single points over a placed pair.
///
/// # Examples
/// ```
/// # use wheelrail::{Arc, Half, Pair, Profile, Segment};
/// use wheelrail::Evaluator;
/// # let rail = Arc::about([0.0, -300.0], 300.0, Half::Upper, [-35.0, 35.0])?;
/// # let rail = Profile::new("crown", "", vec![Segment::arc(rail)])?;
/// # let wheel = Profile::new("cylinder", "", vec![Segment::arc(Arc::line([-60.0, 0.0], [60.0, 0.0])?)])?;
/// # let pair = Pair::new(rail, wheel, 460.0)?;
/// let placement = pair.placed(0.0, 0.0, 0.0)?; // a crown of 300 mm below a cylinder of 460 mm
/// let mut evaluator = Evaluator::new(&placement);
/// let across = 300.0 - f64::sqrt(300.0 * 300.0 - 2.0 * 2.0);
/// let along = 460.0 - f64::sqrt(460.0 * 460.0 - 5.0 * 5.0);
/// assert!((evaluator.separation(2.0, 0.0) - across).abs() < 1e-13);
/// assert!((evaluator.separation(0.0, 5.0) - along).abs() < 1e-13);
/// assert!(evaluator.separation(36.0, 0.0).is_nan()); // off the rail
/// # Ok::<(), wheelrail::Error>(())
/// ```
#[derive(Debug)]
pub struct Evaluator<'a> {
    placement: &'a Placement,
    upper: Upper<'a>,
    /// The lower profile over a roller, upside down; `None` for a rail.
    lower: Option<Relief<'a>>,
    /// Feet on a rail that varies along the track, over whose tangent plane the wheel's height is known.
    feet: Option<Feet<&'a FramedLoft>>,
}

/// The wheel, by its height over the lower profile, or over the tangent plane of a rail that varies.
#[derive(Debug)]
enum Upper<'a> {
    /// A wheel of revolution.
    Round(Box<Relief<'a>>),
    /// A wheel that varies, over the profile of its rail.
    Varying(Feet<&'a FramedLoft>, &'a Section),
}

impl<'a> Upper<'a> {
    fn new(placement: &'a Placement) -> Self {
        match placement.lofted_wheel() {
            Some(wheel) => Self::Varying(Feet::new(wheel), &placement.rail().section),
            None => Self::Round(Box::new(Relief::new(placement))),
        }
    }

    /// Computes the height and the sum of the magnitudes of its terms \[mm\]; NaN off the wheel and off the profile below it.
    fn height_and_size(&mut self, xi: f64, eta: f64) -> [f64; 2] {
        match self {
            Self::Round(relief) => relief.height_and_size(xi, eta),
            Self::Varying(feet, rail) => {
                let (above, below) = (feet.height(xi, eta), rail.height(xi));
                [above - below, above.abs() + below.abs()]
            }
        }
    }

    fn height(&mut self, xi: f64, eta: f64) -> f64 {
        match self {
            Self::Round(relief) => relief.height(xi, eta),
            Self::Varying(feet, rail) => feet.height(xi, eta) - rail.height(xi),
        }
    }

    /// Computes the height \[mm\], the abscissa of the profile's point \[mm\] (NaN for a wheel that varies), and the wheel's outward
    /// unit normal. `None` off the wheel; the height is NaN off the profile below it.
    fn height_and_normal(&mut self, xi: f64, eta: f64) -> Option<(f64, f64, Unit<Vector3<f64>>)> {
        match self {
            Self::Round(relief) => {
                let point = relief.point(xi, eta)?;
                Some((relief.height_at(xi, &point), relief.abscissa(&point), relief.normal(&point)))
            }
            Self::Varying(feet, rail) => {
                let foot = feet.at(xi, eta)?;
                Some((foot.zeta - rail.height(xi), f64::NAN, -foot.normal()))
            }
        }
    }

    fn column(&mut self, xi: f64, eta: &[f64], out: &mut [f64]) {
        match self {
            Self::Round(relief) => relief.column(xi, eta, out),
            Self::Varying(feet, _) => {
                feet.forget();
                out.iter_mut().zip(eta).for_each(|(s, &eta)| *s = self.height(xi, eta));
            }
        }
    }

    fn column_in_lanes(&mut self, xi: f64, eta: &[f64], out: &mut [f64]) {
        let Self::Round(relief) = self else { return self.column(xi, eta, out) };
        let demand = Demand::for_tolerance(FULL_PRECISION);
        for (eta, out) in eta.chunks(MANY).zip(out.chunks_mut(MANY)) {
            skewed::fill(relief, (pulp::Arch::new(), demand), xi, eta, out);
        }
    }
}

impl<'a> Evaluator<'a> {
    /// Makes an evaluator for a placed pair.
    pub fn new(placement: &'a Placement) -> Self {
        let (lower, feet) = (placement.under().map(Relief::new), placement.lofted_rail().map(Feet::new));
        Self { placement, upper: Upper::new(placement), lower, feet }
    }

    /// Computes s(ξ, η) \[mm\], which is negative where the bodies overlap, and NaN where a body has no surface.
    ///
    /// Method: sagitta form. Accuracy: over both contact segments the error is below 1e-13 times the sum of the magnitudes
    /// of the terms of s: the midplane gap, the rise of the wheel across, the fall of a roller and, under yaw, the climb of the
    /// wheel along ξ′ − ξ. If these terms have one sign, as at any contact that is open all around, this is a relative error of s
    /// below 1e-13. Elsewhere the absolute error is below 2e-12 mm × max(1, R_max/300 mm). Both are checked against 28- and
    /// 60-digit values. Over a rail that varies along the track, and under a wheel that varies around its axle, it is below 1e-11 mm.
    pub fn separation(&mut self, xi: f64, eta: f64) -> f64 {
        let above = self.upper.height(xi, eta);
        if let Some(feet) = &mut self.feet {
            return above - feet.height(xi, eta);
        }
        self.lower.as_mut().map_or(above, |lower| above + lower.height(xi, eta))
    }

    /// Returns whether swept bodies have surfaces at a place over the profile below, as [`Relief::has_surface`].
    pub(crate) fn has_surface(&mut self, xi: f64, eta: f64) -> bool {
        let upper = match &mut self.upper {
            Upper::Round(relief) => relief.has_surface(xi, eta),
            Upper::Varying(..) => false,
        };
        upper && self.lower.as_mut().is_none_or(|lower| lower.has_surface(xi, eta))
    }

    /// Computes s \[mm\] and its gradient [∂s/∂ξ, ∂s/∂η] at (ξ, η); one call costs less than two. s and ∂s/∂ξ are NaN off either
    /// body; ∂s/∂η is a number where only an extruded rail is missing.
    pub fn separation_and_gradient(&mut self, xi: f64, eta: f64) -> (f64, [f64; 2]) {
        self.gap_and_slopes(xi, eta).map_or((f64::NAN, [f64::NAN; 2]), |at| (at.gap, at.slopes))
    }

    /// Computes s, its gradient and the abscissae of the profiles' points at (ξ, η). Off either body the result is `None`, or s and
    /// ∂s/∂ξ are NaN.
    pub(crate) fn gap_and_slopes(&mut self, xi: f64, eta: f64) -> Option<GapSlopes> {
        let (s, abscissa, normal) = self.upper.height_and_normal(xi, eta)?;
        let ([along, across], alone) = (slopes(normal), [abscissa, f64::NAN]);
        if let Some(feet) = &mut self.feet {
            let foot = feet.at(xi, eta)?;
            let slopes = [along - foot.slopes[0], across - foot.slopes[1]];
            return Some(GapSlopes { gap: s - foot.zeta, slopes, abscissae: alone });
        }
        let Some(lower) = &mut self.lower else {
            return Some(GapSlopes {
                gap: s,
                slopes: [along - self.rail_slope(xi), across],
                abscissae: alone,
            });
        };
        let foot = lower.point(xi, eta)?;
        let below = slopes(lower.normal(&foot));
        Some(GapSlopes {
            gap: s + lower.height_at(xi, &foot),
            slopes: [along + below[0], across + below[1]],
            abscissae: [abscissa, lower.abscissa(&foot)],
        })
    }

    /// Computes [∂ζ^W/∂ξ, ∂ζ^W/∂η] at (ξ, η); NaN off the wheel.
    pub fn wheel_slopes(&mut self, xi: f64, eta: f64) -> [f64; 2] {
        self.upper.height_and_normal(xi, eta).map_or([f64::NAN; 2], |(.., normal)| slopes(normal))
    }

    /// Computes ζ(ξ, η) \[mm\] of the lower body; NaN off it. For an extruded rail it is [`Self::rail_height`] at every η.
    pub fn lower_height(&mut self, xi: f64, eta: f64) -> f64 {
        if let Some(feet) = &mut self.feet {
            return feet.height(xi, eta);
        }
        let profile = self.rail_height(xi);
        self.lower.as_mut().map_or(profile, |lower| profile - lower.height(xi, eta))
    }

    /// Computes both outward normals at (ξ, η).
    pub fn normals(&mut self, xi: f64, eta: f64) -> Normals {
        let rail = match (&mut self.feet, &mut self.lower) {
            (Some(feet), _) => feet.at(xi, eta).map(|foot| foot.normal()),
            (None, Some(lower)) => lower.point(xi, eta).map(|point| {
                let down = lower.normal(&point);
                Unit::new_unchecked(Vector3::new(down.x, down.y, -down.z))
            }),
            (None, None) => self.placement.rail().section.branch_at(xi).map(|branch| {
                let tangent = branch.station(xi);
                Unit::new_unchecked(Vector3::new(-tangent.sin, 0.0, tangent.cos))
            }),
        };
        Normals { rail, wheel: self.upper.height_and_normal(xi, eta).map(|(.., normal)| normal) }
    }

    /// Computes s, and the sum of the magnitudes of its terms \[mm\]. Both are NaN off either body.
    pub(super) fn separation_and_size(&mut self, xi: f64, eta: f64) -> [f64; 2] {
        let [s, size] = self.upper.height_and_size(xi, eta);
        if let Some(feet) = &mut self.feet {
            let below = feet.height(xi, eta);
            return [s - below, size + below.abs()];
        }
        let Some(lower) = &mut self.lower else { return [s, size] };
        let [fall, more] = lower.height_and_size(xi, eta);
        [s + fall, size + more]
    }

    /// Computes dζ/dξ of the lower body's profile at ξ; NaN off it.
    pub fn rail_slope(&self, xi: f64) -> f64 {
        self.placement.rail().section.branch_at(xi).map_or(f64::NAN, |branch| branch.chord_slope(xi, xi))
    }

    /// Computes ζ(ξ) of the lower body's profile \[mm\], the height of an extruded rail at every η; NaN off it.
    pub fn rail_height(&self, xi: f64) -> f64 {
        self.placement.rail().section.height(xi)
    }

    /// Computes s \[mm\] at all η \[mm\] of one column; NaN where a body has no surface.
    pub fn column(&mut self, xi: f64, eta: &[f64], out: &mut [f64]) {
        self.upper.column(xi, eta, out);
        self.add_lower(xi, eta, out);
    }

    /// Computes s \[mm\] at all η \[mm\] of one column, the wheel 16 points at once, as accurately as [`Self::column`]; NaN where a
    /// body has no surface.
    pub(crate) fn column_in_lanes(&mut self, xi: f64, eta: &[f64], out: &mut [f64]) {
        self.upper.column_in_lanes(xi, eta, out);
        self.add_lower(xi, eta, out);
    }

    /// Adds how far the lower body lies below its extruded profile (a roller), or below the tangent plane (a rail that varies).
    fn add_lower(&mut self, xi: f64, eta: &[f64], out: &mut [f64]) {
        if let Some(feet) = &mut self.feet {
            feet.forget();
            out.iter_mut().zip(eta).for_each(|(s, &eta)| *s -= feet.height(xi, eta));
        }
        if let Some(lower) = &mut self.lower {
            let mut falls = vec![f64::NAN; eta.len()];
            lower.column(xi, eta, &mut falls);
            out.iter_mut().zip(falls).for_each(|(s, fall)| *s += fall);
        }
    }
}

/// Computes [∂ζ/∂ξ, ∂ζ/∂η] of a surface from its normal.
fn slopes(normal: Unit<Vector3<f64>>) -> [f64; 2] {
    [-normal.x / normal.z, -normal.y / normal.z]
}

//! Feasibility of a chosen contact point (Report Sec. 4): s ≥ 0 everywhere, (4.1).

use nalgebra::Point2;
use serde::Serialize;

use crate::patch::{Patch, Window, least_separation, turning_points};
use crate::placement::Placement;
use crate::separation::{Evaluator, midplane_gap};

/// Overlap, as a share of the profiles' extent, up to which a contact counts as feasible: rounding of the
/// profile and of its drawing's tangents (1e-10 mm on a wheel), far below what any solver resolves.
const ROUNDING: f64 = 1e-12;

/// Overlap, as a share of the profiles' extent, up to which a contact counts as feasible by samples: the search for bodies that vary
/// finds its places to 1e-9 of a cell, and with them the frame's normal.
const ROUNDING_OF_PLACES: f64 = 1e-11;

/// The answer to (4.1).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Feasibility {
    /// Whether the bodies nowhere overlap in this position.
    pub feasible: bool,
    /// Least separation where the bodies lie over each other \[mm\], negative where they overlap: the least s along ζ, or the least
    /// vertical gap where the two differ in sign; see [`feasibility`].
    pub least_separation_mm: f64,
    /// ξ of the least separation \[mm\].
    pub at_xi_mm: f64,
    /// η of the least separation \[mm\]: 0 without skew.
    pub at_eta_mm: f64,
}

/// Finds the least separation of a placed pair and its place; `None` where the bodies nowhere lie over each other.
///
/// Without skew it is exact to rounding: over every interval in which neither body changes its branch the minimum is at an
/// end or where the two are parallel. The midplane suffices: at fixed ξ the wheel only rises with |η|, since its
/// profile angle is below 90°.
///
/// Along a steep ζ, s compares only the sheets that face each other at C. So without skew the vertical gap in the rail profile's axes,
/// where each body has one outer height, decides whether the bodies overlap. Where s is negative and the vertical gap is not, or the
/// other way round, the result is the least vertical gap with its place.
///
/// Under a skewed wheel s alone decides. Bounds of s and of its slopes over boxes leave the places at which it may be least, up to
/// |η| = 0.65 of the axle's distance, and find the least s to 1000 roundings of R.
///
/// Where a body varies, the least s is found from samples, as the patch: [`Patch::new`].
///
/// Cost: some ten nanoseconds a joint without skew, some hundred microseconds with skew.
///
/// # Examples
/// ```
/// # use wheelrail::{Arc, Half, Pair, Profile, Segment};
/// use wheelrail::feasibility;
/// # let rail = Arc::about([0.0, -300.0], 300.0, Half::Upper, [-35.0, 35.0])?;
/// # let rail = Profile::new("crown", "", vec![Segment::arc(rail)])?;
/// # let wheel = Profile::new("cylinder", "", vec![Segment::arc(Arc::line([-60.0, 0.0], [60.0, 0.0])?)])?;
/// # let pair = Pair::new(rail, wheel, 460.0)?;
/// let placement = pair.placed(0.0, 0.0, 0.0)?; // a crown of 300 mm below a cylinder of 460 mm
/// let found = feasibility(&placement).expect("bodies that lie over each other");
/// assert!(found.feasible);
/// # Ok::<(), wheelrail::Error>(())
/// ```
pub fn feasibility(placement: &Placement) -> Option<Feasibility> {
    if placement.lofted().is_some() {
        return by_overlap(placement);
    }
    let along_zeta = match placement.skew() == 0.0 {
        true => least_in_midplane(placement)?,
        false => least_separation(placement)?.into(),
    };
    let extent = placement.rail().profile().extent().max(placement.wheel().profile().extent());
    let apart = |gap: f64| gap >= -ROUNDING * extent;
    // An error along the normal of a steep surface is larger along the vertical.
    let steep = placement.rail().point().station.cos;
    let vertical = least_vertical_gap(placement);
    let feasible = vertical.map_or(apart(along_zeta.0), |(gap, ..)| apart(gap * steep));
    let agreed = feasible == apart(along_zeta.0);
    let (least_separation_mm, at_xi_mm, at_eta_mm) = vertical.filter(|_| !agreed).unwrap_or(along_zeta);
    Some(Feasibility { feasible, least_separation_mm, at_xi_mm, at_eta_mm })
}

/// Finds the least s of bodies that vary: at C, or where the bodies overlap most.
fn by_overlap(placement: &Placement) -> Option<Feasibility> {
    let at_contact = Evaluator::new(placement).separation(0.0, 0.0);
    let extent = placement.rail().profile().extent().max(placement.wheel().profile().extent());
    // Below 0 by rounding, which would otherwise make patches of its own around C.
    let overlap = Patch::new(placement, -ROUNDING_OF_PLACES * extent, &Window::UNBOUNDED);
    let places = overlap.components.iter().map(|component| component.deepest);
    let own = std::iter::once([at_contact, 0.0, 0.0]).filter(|[s, ..]| !s.is_nan());
    let [least, xi, eta] = own.chain(places).min_by(|a, b| a[0].total_cmp(&b[0]))?;
    let feasible = overlap.components.is_empty();
    Some(Feasibility { feasible, least_separation_mm: least, at_xi_mm: xi, at_eta_mm: eta })
}

/// Finds (gap, ξ, η) \[mm\] of the least vertical gap in the midplane, at its place on the rail; `None` under skew.
fn least_vertical_gap(placement: &Placement) -> Option<(f64, f64, f64)> {
    if placement.skew() != 0.0 {
        return None;
    }
    let upright = placement.reframed(placement.rail().point().station.x, 0.0).ok()?;
    let (gap, along, _) = least_in_midplane(&upright)?;
    let place = upright.rail().contact_frame() * Point2::new(along, upright.rail().section().height(along));
    let xi = placement.rail().contact_frame().inverse_transform_point(&place).x;
    Some((gap, xi, 0.0))
}

/// Finds (s, ξ, η) \[mm\] of the least s in the midplane.
fn least_in_midplane(placement: &Placement) -> Option<(f64, f64, f64)> {
    let over = placement.overlap()?;
    // C itself first: rounding may put a stationary point next to it.
    let mut least = over.contains(0.0).then(|| (midplane_gap(placement, 0.0), 0.0, 0.0));
    for xi in turning_points(placement, over.low, over.high) {
        let gap = midplane_gap(placement, xi);
        if least.is_none_or(|(smallest, ..)| gap < smallest) {
            least = Some((gap, xi, 0.0));
        }
    }
    least
}

//! Feasibility of a chosen contact point (Report Sec. 4): s ≥ 0 everywhere, (4.1).

use serde::Serialize;

use crate::placement::Placement;
use crate::profile::stationary_points;
use crate::separation::gap::midplane_gap;

/// Overlap, as a share of the profiles' extent, up to which a contact counts as feasible: rounding of the
/// profile and of its drawing's tangents (1e-10 mm on a wheel), far below what any solver resolves.
const ROUNDING: f64 = 1e-12;

/// The answer to (4.1).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Feasibility {
    /// Whether the bodies nowhere overlap in this position.
    pub feasible: bool,
    /// Least separation over the midplane overlap \[mm\], negative where they do.
    pub least_separation_mm: f64,
    /// ξ where it is \[mm\].
    pub at_xi_mm: f64,
}

/// The least separation of a placed pair and where it is.
///
/// Exact to rounding: over every interval in which neither body changes its branch the minimum is at an end or
/// where the two are parallel. The midplane suffices: at fixed ξ the wheel only rises with |η|, since its
/// profile angle is below 90°. Under a skewed wheel too only the midplane is searched: an overlap elsewhere is not found.
pub fn feasibility(placement: &Placement) -> Option<Feasibility> {
    let [a, b] = placement.overlap()?;
    // C itself first: rounding may put a stationary point next to it.
    let mut least = (a <= 0.0 && b >= 0.0).then(|| (0.0, midplane_gap(placement, 0.0)));
    for xi in critical_points(placement, a, b) {
        let gap = midplane_gap(placement, xi);
        if least.is_none_or(|(_, smallest)| gap < smallest) {
            least = Some((xi, gap));
        }
    }
    let (at_xi_mm, least_separation_mm) = least?;
    let extent = placement.rail.profile.extent().max(placement.wheel.profile.extent());
    let feasible = least_separation_mm >= -ROUNDING * extent;
    Some(Feasibility { feasible, least_separation_mm, at_xi_mm })
}

/// a, b and all ξ between them where the midplane gap may turn: joints and stationary points, ascending.
///
/// Between two neighbours the gap is monotone, or undefined throughout.
pub fn critical_points(placement: &Placement, a: f64, b: f64) -> Vec<f64> {
    let mut ends = vec![a];
    ends.extend(placement.joints(a, b));
    ends.push(b);
    let mut all = vec![a];
    for pair in ends.windows(2) {
        let middle = pair[0] + (pair[1] - pair[0]) / 2.0;
        let (rail, wheel) = (&placement.rail.section, &placement.wheel.section);
        if let (Some(rail), Some(wheel)) = (rail.branch_at(middle), wheel.branch_at(middle)) {
            all.extend(stationary_points(rail, wheel, pair[0], pair[1]));
        }
        all.push(pair[1]);
    }
    all
}

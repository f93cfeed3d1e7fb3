//! Finds where the midplane gap may turn.

use crate::placement::Placement;
use crate::profile::stationary_points;

/// Finds a, b, and all ξ between them \[mm\] where the midplane gap may turn, ascending: joints and stationary points.
///
/// Between two neighbours the gap is monotone, or undefined throughout.
pub fn turning_points(placement: &Placement, a: f64, b: f64) -> Vec<f64> {
    let mut ends = vec![a];
    ends.extend(placement.joints(a, b));
    ends.push(b);
    let mut all = vec![a];
    for pair in ends.windows(2) {
        let middle = pair[0] + (pair[1] - pair[0]) / 2.0;
        let bodies = [placement.rail(), placement.wheel()].map(|body| body.section.branch_and_slopes(middle));
        if let [Some((rail, slope_r)), Some((wheel, slope_w))] = bodies {
            // Bounds over whole pieces are found once for a placement, and settle most stretches.
            if slope_w.meets(slope_r) {
                all.extend(stationary_points(rail, wheel, pair[0], pair[1]));
            }
        }
        all.push(pair[1]);
    }
    all
}

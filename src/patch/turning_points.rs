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
        let (rail, wheel) = (&placement.rail().section, &placement.wheel().section);
        if let (Some(rail), Some(wheel)) = (rail.branch_at(middle), wheel.branch_at(middle)) {
            all.extend(stationary_points(rail, wheel, pair[0], pair[1]));
        }
        all.push(pair[1]);
    }
    all
}

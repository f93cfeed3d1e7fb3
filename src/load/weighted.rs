//! The frame at the centre of a region's overlap, defined as CONTACT defines its contact reference.

use nalgebra::Point2;

use crate::patch::Window;
use crate::placement::Placement;
use crate::separation::Evaluator;

/// Columns and rows of the midpoint rule: the centre of an ellipse is right to 1e-4 of its size.
const CELLS: [usize; 2] = [64, 32];

/// Finds the weighted frame of the region inside `extent`, the box around it, under an approach δ \[mm\]: the abscissa \[mm\] and
/// the angle \[rad\] in the rail profile's axes.
///
/// Both are means over the region, with the squared overlap (δ − s)² as weight: x of the rail's surface, and the angle of its
/// tangent. The origin is the rail's point at that x. A region of two lobes may have its origin between them, where the
/// bodies do not overlap. `None` where s < δ at no point of the rule.
pub fn weighted_frame(placement: &Placement, extent: &Window, approach: f64) -> Option<[f64; 2]> {
    let centres = |[from, to]: [f64; 2], count: usize| -> Vec<f64> {
        (0..count).map(|k| from + (k as f64 + 0.5) * ((to - from) / count as f64)).collect()
    };
    let eta = centres(extent.eta, CELLS[1]);
    let (frame, mut evaluator) = (placement.rail().contact_frame(), Evaluator::new(placement));
    let (mut gaps, mut sums) = (vec![0.0; eta.len()], [0.0; 3]);
    for xi in centres(extent.xi, CELLS[0]) {
        evaluator.column(xi, &eta, &mut gaps);
        let overlaps = gaps.iter().filter(|s| **s < approach);
        let weight: f64 = overlaps.map(|s| (approach - s) * (approach - s)).sum();
        if weight > 0.0 {
            let x = (frame * Point2::new(xi, evaluator.rail_height(xi))).x;
            let angle = placement.rail().contact_angle() + evaluator.rail_slope(xi).atan();
            sums = [sums[0] + weight, sums[1] + weight * x, sums[2] + weight * angle];
        }
    }
    let [weight, x, angle] = sums;
    (weight > 0.0).then(|| [x / weight, angle / weight])
}

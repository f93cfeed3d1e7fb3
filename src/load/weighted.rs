//! The frame at the centre of a region's overlap, defined as CONTACT defines its contact reference.

use nalgebra::Point2;

use crate::patch::Window;
use crate::placement::Placement;
use crate::separation::Evaluator;

/// Columns and rows of the midpoint rule: the centre of an ellipse is right to 1e-4 of its size.
const CELLS: [usize; 2] = [64, 32];

/// The centre of an overlap, on the rail.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WeightedFrame {
    /// Mean abscissa in the rail profile's axes \[mm\].
    pub rail_x: f64,
    /// Mean angle of the rail's surface in its profile's axes \[rad\], + counter-clockwise.
    pub angle: f64,
    /// The overlap's weight, ∬ (δ − s)² dξ dη \[mm⁴\], > 0.
    pub weight: f64,
}

/// Finds the weighted frame of the region inside `extent`, the box around it, under an approach δ \[mm\].
///
/// Abscissa and angle are means over the region, with the squared overlap (δ − s)² as weight: of the rail's surface and of its
/// tangent. In a frame whose ζ is vertical they are those of CONTACT, which weighs the vertical overlap over the track's plane. A
/// region of two lobes may have its origin between them, where the bodies do not overlap. `None` where s < δ at no point of the rule.
pub fn weighted_frame(placement: &Placement, extent: &Window, approach: f64) -> Option<WeightedFrame> {
    let step = |[from, to]: [f64; 2], count: usize| (to - from) / count as f64;
    let centres = |range: [f64; 2], count: usize| -> Vec<f64> {
        (0..count).map(|k| range[0] + (k as f64 + 0.5) * step(range, count)).collect()
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
            let angle = frame.rotation.angle() + evaluator.rail_slope(xi).atan();
            sums = [sums[0] + weight, sums[1] + weight * x, sums[2] + weight * angle];
        }
    }
    let ([weight, x, angle], cell) = (sums, step(extent.xi, CELLS[0]) * step(extent.eta, CELLS[1]));
    let found = WeightedFrame { rail_x: x / weight, angle: angle / weight, weight: weight * cell };
    (weight > 0.0).then_some(found)
}

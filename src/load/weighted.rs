//! The frame at the centre of a region's overlap, defined as CONTACT defines its contact reference.

use nalgebra::Point2;

use crate::numerics::interval::Interval;
use crate::patch::Window;
use crate::placement::Placement;
use crate::separation::Evaluator;

/// Number of columns and rows of the midpoint rule: the centre of an ellipse is right to 1e-4 of its size.
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
    let sides = [extent.xi, extent.eta].map(Interval::from);
    let steps = [0, 1].map(|k| sides[k].width() / CELLS[k] as f64);
    let centre = |k: usize, i: usize| sides[k].low + (i as f64 + 0.5) * steps[k];
    let [xi, eta] = [0, 1].map(|k| (0..CELLS[k]).map(|i| centre(k, i)).collect::<Vec<_>>());
    let (frame, mut evaluator) = (placement.rail().contact_frame(), Evaluator::new(placement));
    let (mut gaps, mut sums) = (vec![0.0; eta.len()], [0.0; 3]);
    for xi in xi {
        evaluator.column(xi, &eta, &mut gaps);
        let overlaps = gaps.iter().filter(|s| **s < approach);
        let weight: f64 = overlaps.map(|s| (approach - s) * (approach - s)).sum();
        if weight > 0.0 {
            let x = (frame * Point2::new(xi, evaluator.rail_height(xi))).x;
            let angle = frame.rotation.angle() + evaluator.rail_slope(xi).atan();
            sums = [sums[0] + weight, sums[1] + weight * x, sums[2] + weight * angle];
        }
    }
    let ([weight, x, angle], cell) = (sums, steps[0] * steps[1]);
    let found = WeightedFrame { rail_x: x / weight, angle: angle / weight, weight: weight * cell };
    (weight > 0.0).then_some(found)
}

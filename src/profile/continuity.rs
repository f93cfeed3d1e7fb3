//! Measures how well a chain closes, by the gap, kink and curvature jump at every joint. Rejects steps that are too large
//! for a drawing.

use serde::Serialize;

use super::segment::Segment;
use super::station::Station;
use crate::error::{Error, Result};

/// Largest step between two segments, as a share of the chain's extent, that counts as rounding of a drawing.
///
/// Standards print coordinates to 1e-3 mm or 1e-4 inch on profiles of 140 mm; the built-in profiles have
/// steps of up to 1.5e-5 of their extent. A step several times larger is a wrong number.
pub const LARGEST_STEP: f64 = 1e-4;

/// The gap, kink and curvature jump at the joint of two neighbouring segments.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Joint {
    /// Index of the segment on the left.
    pub left: usize,
    /// Abscissa of the left segment's end \[mm\].
    pub x: f64,
    /// Distance between the two ends \[mm\]; a few roundings in a profile's closed chain.
    pub gap: f64,
    /// Change of tangent angle \[rad\], positive counter-clockwise.
    pub kink: f64,
    /// Change of curvature \[1/mm\].
    pub curvature_jump: f64,
}

/// Returns the joints of a chain, from left to right. A joint lies between each segment and its right neighbour.
pub fn joints(segments: &[Segment]) -> Vec<Joint> {
    let joint = |(left, pair): (usize, &[Segment])| {
        let (end, start) = (pair[0].end(), pair[1].start());
        Joint {
            left,
            x: end.x,
            gap: (start.x - end.x).hypot(start.z - end.z),
            kink: start.seen_from(&end).angle(),
            curvature_jump: pair[1].end_curvatures()[0] - pair[0].end_curvatures()[1],
        }
    };
    segments.windows(2).enumerate().map(joint).collect()
}

/// Returns the part \[mm\] of a drawing's gap that rounded coordinates cannot explain: the larger of its run in x and its
/// part across the steeper tangent. Beside a vertical tangent the gap itself can be a hundred times larger.
fn step(end: &Station, start: &Station) -> f64 {
    let steeper = if end.cos < start.cos { end } else { start };
    let frame = Station { x: end.x, z: end.z, ..*steeper };
    (start.x - end.x).abs().max(start.seen_from(&frame).z.abs())
}

/// Rejects steps between drawn segments that rounding cannot explain. `extent` \[mm\] is the extent of the profile.
///
/// # Errors
/// The first such step, with its place and size.
pub(super) fn reject_jumps(segments: &[Segment], extent: f64) -> Result<()> {
    let limit = LARGEST_STEP * extent;
    for (index, pair) in segments.windows(2).enumerate() {
        let (end, start) = (pair[0].end(), pair[1].start());
        let step = step(&end, &start);
        if step.is_nan() || step > limit {
            let found =
                format!("a step of {step:.6} mm from the end of the segment before, at x = {}", end.x);
            let expected = format!("a step of at most {limit:.6} mm");
            let advice = "correct the end points: segments must join in order of x";
            return Err(Error::new(pair[1].place(index + 1), found, expected, advice));
        }
    }
    Ok(())
}

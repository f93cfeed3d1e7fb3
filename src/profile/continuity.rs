//! How well a chain closes: gap, kink and curvature jump at every joint.

use serde::Serialize;

use super::{Profile, Segment, Station};
use crate::error::{Error, Result};

/// Largest step between two segments, as a share of the chain's extent, that counts as rounding of a drawing.
///
/// Standards print coordinates to 1e-3 mm or 1e-4 inch on profiles of 140 mm; the built-in ones have steps of up to
/// 1.5e-5 of their extent. Several times that is a wrong number.
pub const LARGEST_STEP: f64 = 1e-4;

/// What happens at the joint between two neighbouring segments.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Joint {
    /// Index of the segment on the left.
    pub left: usize,
    /// Abscissa of the left segment's end \[mm\].
    pub x: f64,
    /// Distance between the two ends \[mm\].
    pub gap: f64,
    /// The part of the gap that rounded coordinates explain least: its run in x or its part across the steeper
    /// tangent, whichever is larger \[mm\]. Next to a vertical tangent the gap itself can be a hundred times that.
    pub step: f64,
    /// Change of tangent angle \[rad\], positive counter-clockwise.
    pub kink: f64,
    /// Change of curvature \[1/mm\].
    pub curvature_jump: f64,
}

pub(super) fn joints(segments: &[Segment]) -> Vec<Joint> {
    segments
        .windows(2)
        .enumerate()
        .map(|(left, pair)| {
            let (end, start) = (pair[0].end(), pair[1].start());
            let steeper = if end.cos < start.cos { end } else { start };
            let across = Station { x: start.x, z: start.z, ..steeper }.seen_from(&Station {
                x: end.x,
                z: end.z,
                ..steeper
            });
            Joint {
                left,
                x: end.x,
                gap: (start.x - end.x).hypot(start.z - end.z),
                step: (start.x - end.x).abs().max(across.z.abs()),
                kink: start.seen_from(&end).angle(),
                curvature_jump: pair[1].end_curvatures()[0] - pair[0].end_curvatures()[1],
            }
        })
        .collect()
}

pub(super) fn reject_jumps(profile: &Profile) -> Result<()> {
    let limit = LARGEST_STEP * profile.extent();
    let Some(jump) = profile.continuity().into_iter().find(|joint| joint.step.is_nan() || joint.step > limit)
    else {
        return Ok(());
    };
    let place = profile.segments()[jump.left + 1].place(jump.left + 1);
    let found =
        format!("a step of {:.6} mm from the end of the segment before, at x = {}", jump.step, jump.x);
    let expected = format!("a step of at most {limit:.6} mm");
    Err(Error::new(place, found, expected, "correct the end points: segments must join in order of x"))
}

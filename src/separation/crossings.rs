//! Finds the columns of a grid next to the places where a step of the wheel crosses it.

use super::axis::EtaAxis;
use super::relief::Relief;
use super::samples::places;
use super::wheel_surface::sagitta;

/// Number of η at which a step is followed over a grid: the ends, the middle and between.
const FOLLOWED: usize = 5;

/// Returns ξ \[mm\] of columns on both sides of every place where a step of the wheel's surface crosses the grid, ascending. The
/// circles of both ends of a step are followed. It is empty if no step crosses the grid.
pub fn beside_steps(relief: &Relief<'_>, xi: &[f64], axis: &EtaAxis) -> Vec<f64> {
    let (Some(&first), Some(&last)) = (xi.first(), xi.last()) else { return Vec::new() };
    let (wheel, skew) = (&relief.wheel, relief.skew.rotation);
    let pieces = &wheel.section.pieces;
    let ends = wheel.section.steps.iter().flat_map(|&step| [(step - 1, 1), (step, 0)]);
    let mut columns = Vec::new();
    for (piece, end) in ends {
        let (joint, height) = (pieces[piece].xi[end], pieces[piece].heights[end]);
        let radius = wheel.axle_distance(joint, height);
        // η is near η′. The circle does not reach every η; e = ρ − √(ρ² − u) is then NaN.
        let crossings: Vec<f64> = places(axis.eta.len(), FOLLOWED)
            .map(|k| [axis.eta[k], axis.u[k]])
            .map(|[eta, u]| {
                skew.re * (joint + wheel.sin * sagitta((radius * radius - u).sqrt(), u)) - skew.im * eta
            })
            .filter(|xi| !xi.is_nan())
            .collect();
        if crossings.iter().all(|&at| at < first) || crossings.iter().all(|&at| at > last) {
            continue;
        }
        for at in crossings {
            let beyond = xi.partition_point(|&xi| xi < at);
            columns.extend(&xi[beyond.saturating_sub(1)..xi.len().min(beyond + 1)]);
        }
    }
    columns.sort_by(f64::total_cmp);
    columns.dedup();
    columns
}

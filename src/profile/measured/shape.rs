//! What the shape of a profile proves about its orientation: foot and flange.

use std::ops::RangeInclusive;

use super::points::Point;
use crate::profile::Side;

/// The true upper side of a profile drops at both ends this many times as far as the wrong one: 4 leaves room
/// for hollow wear and for edges that curl.
const PLAIN: f64 = 4.0;
/// Least drop \[mm\] of both ends from a rail's top, or from a flange's tip, that counts as a shape and not as
/// wear or noise.
const LEAST_DROP: f64 = 0.5;
/// Heights \[mm\] of a flange tip over the tread: tram to full-wear railway flanges.
const FLANGE_HEIGHTS: RangeInclusive<f64> = 10.0..=60.0;
/// Depth \[mm\] below the top of rail that a side face must reach to be one; gauge faces are measured at 14.
const SIDE_FACE: f64 = 10.0;
/// A flange tip lies at least this share of the profile's width away from its middle.
const OFF_MIDDLE: f64 = 0.15;
/// Drop \[mm\] of the flange back from the tip that shows the flange back was measured.
const FLANGE_BACK: f64 = 5.0;

/// Largest height.
pub(super) fn top(points: &[Point]) -> f64 {
    points.iter().map(|p| p.z).fold(f64::NEG_INFINITY, f64::max)
}

/// Index of the extreme towards `sign`·z, and the smaller of the two drops from it to the ends.
fn extreme(points: &[Point], sign: f64) -> Option<(usize, f64)> {
    let height = |k: usize| sign * points[k].z;
    let best = (0..points.len()).max_by(|&a, &b| height(a).total_cmp(&height(b)))?;
    let drop = |end: usize| height(best) - height(end);
    Some((best, drop(0).min(drop(points.len() - 1))))
}

/// Whether z points up as given, with the reason; `None` where the shape does not prove it.
///
/// A rail drops to both sides of its head; a wheel's flange tip hangs below both its back and its tread. The
/// wrong extreme is an end of the profile, or nearly so.
pub(super) fn head_up(points: &[Point], side: Side) -> Option<(bool, String)> {
    let up = extreme(points, 1.0)?;
    let down = extreme(points, -1.0)?;
    let (humped_up, hump, other) = if up.1 >= down.1 { (true, up, down) } else { (false, down, up) };
    if hump.1 < LEAST_DROP || hump.1 < PLAIN * other.1 {
        return None;
    }
    let place = points[hump.0].place();
    match side {
        Side::Rail => {
            Some((humped_up, format!("side faces: both ends lie {:.1} mm below the top, {place}", hump.1)))
        }
        Side::Wheel => {
            let height = flange_height(points, hump.0);
            let flange = FLANGE_HEIGHTS.contains(&height);
            flange.then(|| (!humped_up, format!("flange tip, {height:.1} mm from the tread, at {place}")))
        }
    }
}

/// Height of the tip over the median height of the profile, which lies on the tread.
fn flange_height(points: &[Point], tip: usize) -> f64 {
    let mut heights: Vec<(f64, f64)> = points
        .windows(2)
        .map(|pair| (0.5 * (pair[0].z + pair[1].z), (pair[1].x - pair[0].x).abs()))
        .collect();
    heights.sort_by(|a, b| a.0.total_cmp(&b.0));
    let half = 0.5 * heights.iter().map(|(_, run)| run).sum::<f64>();
    let mut sum = 0.0;
    let median = heights.iter().find(|(_, run)| {
        sum += run;
        sum >= half
    });
    median.map_or(0.0, |(height, _)| (points[tip].z - height).abs())
}

/// Whether the flange of an upright wheel is at smaller x, with the reason.
pub(super) fn flange_side(points: &[Point]) -> Option<(bool, String)> {
    let (tip, drop) = extreme(points, -1.0)?;
    let [low, high] = width(points);
    let off = (points[tip].x - 0.5 * (low + high)) / (high - low);
    let height = flange_height(points, tip);
    let flange = FLANGE_HEIGHTS.contains(&height);
    (drop >= LEAST_DROP && flange && off.abs() >= OFF_MIDDLE)
        .then(|| (off < 0.0, format!("flange tip at {}", points[tip].place())))
}

/// Whether the gauge corner of an upright rail is at smaller x: the only side face that was measured is the
/// gauge face.
pub(super) fn gauge_side(points: &[Point]) -> Option<(bool, String)> {
    let [left, right] = side_depths(points)?;
    match (left >= SIDE_FACE, right >= SIDE_FACE) {
        (true, false) => {
            Some((true, format!("only the side face at smaller values is there, {left:.1} mm deep")))
        }
        (false, true) => {
            Some((false, format!("only the side face at larger values is there, {right:.1} mm deep")))
        }
        _ => None,
    }
}

/// How far below its top an upright rail was measured to the left and to the right.
pub(super) fn side_depths(points: &[Point]) -> Option<[f64; 2]> {
    let (best, _) = extreme(points, 1.0)?;
    let top = points[best];
    let depth =
        |left: bool| points.iter().filter(|p| (p.x < top.x) == left).map(|p| top.z - p.z).fold(0.0, f64::max);
    Some([depth(true), depth(false)])
}

/// Whether an upright right-hand wheel was measured on the back of its flange.
pub(super) fn has_flange_back(points: &[Point]) -> bool {
    match (extreme(points, -1.0), points.first()) {
        (Some((tip, _)), Some(first)) => first.z - points[tip].z >= FLANGE_BACK,
        _ => false,
    }
}

/// Smallest and largest x.
pub(super) fn width(points: &[Point]) -> [f64; 2] {
    let x = points.iter().map(|p| p.x);
    [x.clone().fold(f64::INFINITY, f64::min), x.fold(f64::NEG_INFINITY, f64::max)]
}

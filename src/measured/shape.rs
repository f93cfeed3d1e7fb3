//! Decides the orientation of a profile from its shape: foot, groove and flange.
//!
//! The shape decides where neither an option nor the format's definition does; elsewhere it may only contradict the definition. A
//! shape that looks like a body both ways up proves nothing. Example: a groove cut off on both its tops looks like an upside-down head.

use std::ops::RangeInclusive;

use super::read::points::Point;
use crate::numerics::interval::Interval;
use crate::profile::{Side, last_groove};

/// Least ratio of the drop from a wheel's flange tip to the drop from the extreme on its other side, each to the nearer end in z. The
/// value 4 leaves room for hollow wear and for edges that curl.
const PLAIN: f64 = 4.0;
/// Least drop \[mm\] of both ends from a rail's top, or from a flange's tip. A smaller drop may be wear or noise.
const LEAST_DROP: f64 = 0.5;
/// Heights \[mm\] of a flange tip over the tread, from tram flanges to fully worn railway flanges.
const FLANGE_HEIGHTS: RangeInclusive<f64> = 10.0..=60.0;
/// Least depth \[mm\] of a side face below the top of rail; gauge faces are measured at 14.
const SIDE_FACE: f64 = 10.0;
/// Least inclination of a side face: over a length l it falls by l sin 30°. Crowns end at less than 20°; the flattest worn
/// gauge faces are at 50°.
const FACE_SINE: f64 = 0.5;
/// Length \[mm\] along the path of an end that is tested for being a face. It is longer than the hooks and lips at the end
/// of a face.
const END: f64 = 6.0;
/// Number of chords into which a path is cut to see how it turns. Such chords are long against noise and short against a
/// head.
const CHORDS: usize = 16;
/// Least turn \[rad\] of a rail's crown from end to end: 75 mm of a radius of 300 mm. A smaller turn proves nothing.
const LEAST_TURN: f64 = 0.25;
/// Largest turn the other way, as a share of the turn, of an outline that bulges throughout. It leaves room for waves of
/// wear and noise.
const OTHER_WAY: f64 = 0.25;
/// Least distance of a flange tip from the middle of the profile, as a share of its width.
const OFF_MIDDLE: f64 = 0.15;
/// Drop \[mm\] from the tip that shows that the flange back was measured.
const FLANGE_BACK: f64 = 5.0;

/// Largest distance of the two ends of a closed outline, as a multiple of the median distance of neighbours, and as a share of the path.
const CLOSING: f64 = 3.0;
const CLOSING_SHARE: f64 = 0.02;
/// Least mean thickness \[mm\] of what a closed outline encloses. There and back along one face it is far less, around a rail more than 20.
const THICKNESS: f64 = 5.0;
/// Share of the height of a closed outline over which its head and its foot are as wide as their widest.
const OUTLINE_END: f64 = 0.15;
/// Least ratio of the width of a rail's foot to that of its head; grooved rails have 1.3, others 1.6 and more.
const BROADER: f64 = 1.2;
/// Largest distance \[mm\] of two profiles that are the same: the last digit of usual files.
const SAME_SHAPE: f64 = 1e-3;
/// Depth \[mm\] below the top of a rail that no wheel reaches: grooves are 47 mm deep.
const TOUCHED: f64 = 60.0;
/// Largest sagitta \[mm\] that is taken off that distance: steps of 1 mm on a fillet of 2 mm.
const LARGEST_SAGITTA: f64 = 0.06;

/// Returns the largest z of the points \[mm\].
pub(super) fn top(points: &[Point]) -> f64 {
    points.iter().map(|p| p.z).fold(f64::NEG_INFINITY, f64::max)
}

/// Returns the index of the extreme point towards `sign`·z, and the smaller one of its two drops to the ends.
fn extreme(points: &[Point], sign: f64) -> Option<(usize, f64)> {
    let height = |k: usize| sign * points[k].z;
    let best = (0..points.len()).max_by(|&a, &b| height(a).total_cmp(&height(b)))?;
    let drop = |end: usize| height(best) - height(end);
    Some((best, drop(0).min(drop(points.len() - 1))))
}

/// Returns whether z already points up, with the reason. Returns `None` if the shape does not prove it.
pub(super) fn head_up(points: &[Point], side: Side) -> Option<(bool, String)> {
    match side {
        Side::Rail => foot_down(points),
        Side::Wheel => flange_down(points),
    }
}

/// Returns the area \[mm²\] that a closed outline encloses, positive if the path goes around it counter-clockwise; `None` for a path that
/// does not return to its beginning or encloses next to nothing.
pub(super) fn outline(points: &[Point]) -> Option<f64> {
    let (first, last) = (*points.first()?, *points.last()?);
    let mut steps: Vec<f64> = points.windows(2).map(|pair| distance(pair[0], pair[1])).collect();
    let length: f64 = steps.iter().sum();
    let middle = steps.len() / 2;
    let (_, median, _) = steps.select_nth_unstable_by(middle, f64::total_cmp);
    let next = points.iter().skip(1).chain([&first]);
    // About the first point, so that far origins cost no digits.
    let area = |(a, b): (&Point, &Point)| {
        0.5 * ((a.x - first.x) * (b.z - first.z) - (b.x - first.x) * (a.z - first.z))
    };
    let area: f64 = points.iter().zip(next).map(area).sum();
    let closed = distance(first, last) <= (CLOSING * *median).min(CLOSING_SHARE * length);
    (closed && 2.0 * area.abs() >= THICKNESS * length).then_some(area)
}

/// Returns whether the foot of a closed outline is down, with the reason: the foot is wider than the head.
fn wider_end_down(points: &[Point]) -> Option<(bool, String)> {
    let heights = Interval::around(points.iter().map(|p| p.z));
    let wide = |from: f64, to: f64| {
        let part = Interval::new(heights.at(from), heights.at(to));
        Interval::around(points.iter().filter(|p| part.contains(p.z)).map(|p| p.x)).width()
    };
    let (low, high) = (wide(0.0, OUTLINE_END), wide(1.0 - OUTLINE_END, 1.0));
    let (narrow, broad) = (low.min(high), low.max(high));
    (broad >= BROADER * narrow && heights.width() >= SIDE_FACE).then(|| {
        (low > high, format!("closed outline: the foot is {broad:.1} mm wide, the head {narrow:.1} mm"))
    })
}

/// Returns whether the mirror image of an upright rail about x = `axis` is the same rail down to [`TOUCHED`], to [`SAME_SHAPE`] and the
/// sagitta of its polygon.
pub(super) fn symmetric(points: &[Point], axis: f64) -> bool {
    let around = outline(points).is_some();
    // The point at which an outline closes may be there twice.
    let points = match points {
        [rest @ .., last] if around && distance(points[0], *last) == 0.0 => rest,
        all => all,
    };
    let n = points.len();
    if n < 3 {
        return false;
    }
    let at = |k: usize| points[k % n];
    let edges = if around { n } else { n - 1 };
    let off = |p: &Point, k: usize| {
        let (a, b) = (at(k), at(k + 1));
        let [u, w] = [b.x - a.x, b.z - a.z];
        let square = u * u + w * w;
        let share = if square > 0.0 { ((p.x - a.x) * u + (p.z - a.z) * w) / square } else { 0.0 };
        let share = share.clamp(0.0, 1.0);
        (p.x - a.x - share * u).hypot(p.z - a.z - share * w)
    };
    // A quarter of the distance of a point from the chord between its neighbours is the sagitta of equal steps.
    let sagitta = |k: usize| {
        let bend = |k: usize| {
            let (a, p, b) = (at(k + n - 1), at(k), at(k + 1));
            let chord = distance(a, b);
            let cross = (b.x - a.x) * (p.z - a.z) - (b.z - a.z) * (p.x - a.x);
            if chord > 0.0 { cross.abs() / chord } else { 0.0 }
        };
        (0.25 * bend(k).max(bend(k + 1))).min(LARGEST_SAGITTA)
    };
    let image = |p: &Point| Point { x: 2.0 * axis - p.x, ..*p };
    let nearest = |p: &Point| (0..edges).min_by(|&a, &b| off(p, a).total_cmp(&off(p, b))).unwrap_or(0);
    // The images follow the path backwards: the nearest edge of one is near that of the last one.
    let mut edge = nearest(&image(&points[0]));
    let lowest = top(points) - TOUCHED;
    points.iter().map(image).filter(|p| p.z >= lowest).all(|p| {
        let same = |k: usize| off(&p, k) <= SAME_SHAPE + sagitta(k);
        loop {
            let ahead = (1..=3).flat_map(|step| [edge + step, edge + edges - step]).map(|k| k % edges);
            match ahead.min_by(|&a, &b| off(&p, a).total_cmp(&off(&p, b))) {
                Some(better) if off(&p, better) < off(&p, edge) => edge = better,
                _ => break,
            }
        }
        if !same(edge) {
            // The walk may have stopped short of a corner.
            edge = nearest(&p);
        }
        same(edge)
    })
}

/// Returns whether a rail's foot is down, with the reason. An upright rail ends in two side faces that fall outwards,
/// whatever grooves are between them; or its outline bulges upwards throughout.
fn foot_down(points: &[Point]) -> Option<(bool, String)> {
    if outline(points).is_some() {
        return wider_end_down(points);
    }
    let falls = [end_fall(points, false)?, end_fall(points, true)?];
    let face = |fall: f64| fall.abs() >= FACE_SINE;
    if falls.iter().all(|&fall| face(fall)) {
        // If one face rises and the other falls, the shape is a step, which looks alike both ways up.
        let up = falls[0] > 0.0;
        return (up == (falls[1] > 0.0)).then(|| {
            let way = if up { "falls" } else { "rises" };
            (up, format!("side faces: the profile {way} outwards at both ends"))
        });
    }
    let turn = bulge(points)?;
    let up = turn < 0.0;
    let (_, drop) = extreme(points, if up { 1.0 } else { -1.0 })?;
    (drop >= LEAST_DROP).then(|| {
        let way = if up { "upwards" } else { "downwards" };
        (up, format!("crown: the profile bulges {way} throughout, by {:.2} rad", turn.abs()))
    })
}

/// Returns the fall of the path towards an end \[mm/mm\], over the last [`END`] mm; negative if the path rises.
fn end_fall(points: &[Point], last: bool) -> Option<f64> {
    let n = points.len();
    let at = |k: usize| if last { points[n - 1 - k] } else { points[k] };
    let mut walked = 0.0;
    for k in 1..n {
        walked += distance(at(k - 1), at(k));
        if walked >= END || k + 1 == n {
            return (walked > 0.0).then(|| (at(k).z - at(0).z) / walked);
        }
    }
    None
}

fn distance(a: Point, b: Point) -> f64 {
    (b.x - a.x).hypot(b.z - a.z)
}

/// Returns the turn \[rad\] from the first chord to the last, negative if it is clockwise on the way to larger x. Returns
/// `None` if the path turns both ways or hardly turns.
fn bulge(points: &[Point]) -> Option<f64> {
    let chain = evenly(points)?;
    let angles: Vec<f64> =
        chain.windows(2).map(|pair| (pair[1][1] - pair[0][1]).atan2(pair[1][0] - pair[0][0])).collect();
    let turns = angles.windows(2).map(|pair| {
        let turn = pair[1] - pair[0];
        turn - std::f64::consts::TAU * (turn / std::f64::consts::TAU).round()
    });
    let (mut left, mut right) = (0.0, 0.0);
    for turn in turns {
        if turn > 0.0 { left += turn } else { right -= turn }
    }
    let (more, less) = if left > right { (left, right) } else { (right, left) };
    let turn = left - right;
    (turn.abs() >= LEAST_TURN && less <= OTHER_WAY * more).then_some(turn)
}

/// Returns [`CHORDS`] + 1 points at equal distances along the path, towards larger x. Returns `None` without points.
fn evenly(points: &[Point]) -> Option<Vec<[f64; 2]>> {
    let whole: f64 = points.windows(2).map(|pair| distance(pair[0], pair[1])).sum();
    let (first, last) = (points.first()?, points.last()?);
    let mut out = vec![first.xz()];
    let mut walked = 0.0;
    for pair in points.windows(2) {
        let step = distance(pair[0], pair[1]);
        while out.len() < CHORDS {
            let along = whole * out.len() as f64 / CHORDS as f64 - walked;
            if along > step {
                break;
            }
            let share = if step > 0.0 { along / step } else { 0.0 };
            let between = |a: f64, b: f64| a + share * (b - a);
            out.push([between(pair[0].x, pair[1].x), between(pair[0].z, pair[1].z)]);
        }
        walked += step;
    }
    out.push(last.xz());
    if last.x < first.x {
        out.reverse();
    }
    (out.len() == CHORDS + 1).then_some(out)
}

/// Returns whether a wheel's flange is down, with the reason. The tip of the flange is lower than both the flange back and
/// the tread. The extreme on the other side is at an end of the profile, or near one.
fn flange_down(points: &[Point]) -> Option<(bool, String)> {
    let up = extreme(points, 1.0)?;
    let down = extreme(points, -1.0)?;
    let (tip_up, tip, other) = if up.1 >= down.1 { (true, up, down) } else { (false, down, up) };
    if tip.1 < LEAST_DROP || tip.1 < PLAIN * other.1 {
        return None;
    }
    let (place, height) = (points[tip.0].place(), flange_height(points, tip.0));
    let flange = FLANGE_HEIGHTS.contains(&height);
    flange.then(|| (!tip_up, format!("flange tip, {height:.1} mm from the tread, at {place}")))
}

/// Returns the height \[mm\] of the tip over the median height of the profile, which is on the tread.
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

/// Returns whether the flange of an upright wheel is at smaller x, with the reason.
pub(super) fn flange_side(points: &[Point]) -> Option<(bool, String)> {
    let (tip, drop) = extreme(points, -1.0)?;
    let all = reach(points);
    let off = (points[tip].x - all.middle()) / all.width();
    let height = flange_height(points, tip);
    let flange = FLANGE_HEIGHTS.contains(&height);
    (drop >= LEAST_DROP && flange && off.abs() >= OFF_MIDDLE)
        .then(|| (off < 0.0, format!("flange tip at {}", points[tip].place())))
}

/// Returns whether the gauge corner of an upright rail is at smaller x, with the reason. If only one side face was
/// measured, it is the gauge face, or the face of a groove on that side.
pub(super) fn gauge_side(points: &[Point]) -> Option<(bool, String)> {
    let [left, right] = side_depths(points)?;
    let (is_left, name, depth) = match (left >= SIDE_FACE, right >= SIDE_FACE) {
        (true, false) => (true, "smaller", left),
        (false, true) => (false, "larger", right),
        _ => return None,
    };
    has_face(points, is_left)
        .then(|| (is_left, format!("only the side face at {name} values is there, {depth:.1} mm deep")))
}

/// Returns whether an upright rail falls by [`SIDE_FACE`] over a face on this side of its top.
fn has_face(points: &[Point], left: bool) -> bool {
    let Some((best, _)) = extreme(points, 1.0) else { return false };
    let top = points[best];
    let beside: Vec<Point> = points.iter().filter(|p| (p.x < top.x) == left).copied().collect();
    let reach = SIDE_FACE / FACE_SINE;
    let mut from = 0;
    (0..beside.len()).any(|k| {
        while (beside[k].x - beside[from].x).hypot(beside[k].z - beside[from].z) > reach {
            from += 1;
        }
        (beside[k].z - beside[from].z).abs() >= SIDE_FACE
    })
}

/// Returns how far below its top an upright rail was measured to the left and to the right \[mm\].
fn side_depths(points: &[Point]) -> Option<[f64; 2]> {
    let (best, _) = extreme(points, 1.0)?;
    let top = points[best];
    let depth =
        |left: bool| points.iter().filter(|p| (p.x < top.x) == left).map(|p| top.z - p.z).fold(0.0, f64::max);
    Some([depth(true), depth(false)])
}

/// Returns the part of an upright right-hand rail on which wheels run, right of its last groove. The points are from left
/// to right.
pub(super) fn running_head(points: &[Point]) -> &[Point] {
    let heights: Vec<f64> = points.iter().map(|p| p.z).collect();
    &points[last_groove(&heights).unwrap_or(0)..]
}

/// Returns how far below the top of the running head its gauge side was measured \[mm\].
pub(super) fn gauge_depth(points: &[Point]) -> f64 {
    side_depths(running_head(points)).map_or(0.0, |depths| depths[0])
}

/// Returns whether an upright right-hand wheel was measured on the back of its flange.
pub(super) fn has_flange_back(points: &[Point]) -> bool {
    match (extreme(points, -1.0), points.first()) {
        (Some((tip, _)), Some(first)) => first.z - points[tip].z >= FLANGE_BACK,
        _ => false,
    }
}

/// Returns the range of x.
pub(super) fn reach(points: &[Point]) -> Interval {
    Interval::around(points.iter().map(|p| p.x))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chain(xz: &[[f64; 2]]) -> Vec<Point> {
        xz.iter().map(|&[x, z]| Point { x, z, weight: 1.0, number: 1, line: 1 }).collect()
    }

    fn up(xz: &[[f64; 2]]) -> Option<bool> {
        let turned: Vec<[f64; 2]> = xz.iter().map(|[x, z]| [-x, -z]).collect();
        let [way, other] = [xz, &turned].map(|points| foot_down(&chain(points)).map(|(up, _)| up));
        // Turned by half a circle the proof is the opposite one, or none in both.
        assert_eq!(way, other.map(|up| !up), "{xz:?}");
        way
    }

    /// Heights every 0.5 mm.
    fn graph(from: f64, to: f64, z: impl Fn(f64) -> f64) -> Vec<[f64; 2]> {
        let n = ((to - from) / 0.5) as usize;
        (0..=n).map(|k| from + 0.5 * k as f64).map(|x| [x, z(x)]).collect()
    }

    #[test]
    fn heads_are_told_from_grooves_and_what_is_both_is_neither() {
        let head = [[-36.0, -30.0], [-36.0, -3.0], [0.0, 0.0], [36.0, -3.0], [36.0, -30.0]];
        assert_eq!(up(&head), Some(true));
        let keeper = [[-92.0, -30.0], [-92.0, -2.0], [-76.0, -2.0], [-70.0, -47.0], [-40.0, -47.0]];
        let grooved: Vec<[f64; 2]> = keeper.into_iter().chain(head[1..].iter().copied()).collect();
        assert_eq!(up(&grooved), Some(true));
        // Flat tops beside a round groove: the same as a round head on a plate.
        let groove = graph(-20.0, 20.0, |x| if x.abs() < 10.0 { -(100.0 - x * x).sqrt() } else { 0.0 });
        assert_eq!(up(&groove), None);
        // A crown measured from its top to the wall of the keeper: an upside-down head by its looks.
        let open = [[-74.0, -20.0], [-70.0, -47.0], [-40.0, -47.0], [-36.0, -2.0], [0.0, 0.0]];
        assert_eq!(up(&open), None);
        assert_eq!(up(&graph(-20.0, 20.0, |x| -x * x / 160.0)), Some(true));
        assert_eq!(up(&graph(-20.0, 20.0, |x| 0.2 * x)), None);
        assert_eq!(up(&graph(-20.0, 20.0, |x| -x * x / 2000.0)), None);
        assert_eq!(up(&[[-20.0, -40.0], [-18.0, 0.0], [18.0, 0.0], [20.0, 40.0]]), None);
    }
}

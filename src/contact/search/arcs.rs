//! Pairs of arcs, lines and fans: where wheel and rail have the same tangent at the same abscissa, in closed form
//! or, for a yawed torus, from roots that are known to be bracketed.

use super::element::ArcElement;
use super::isolate::monotone;
use super::locus::Attitude;
use super::walk::{Placed, Walk};
use crate::profile::Station;

/// Slack of a sine against the ends of an element: a root on a joint may come out this far beyond either
/// neighbour. Smaller loses it, larger only moves it, by as little.
pub(super) const SINE_ROUNDING: f64 = 4.0 * f64::EPSILON;

/// An arc or fan of the wheel over an arc or fan of the rail.
///
/// With σ = sinΘ both bodies' abscissae are functions of σ. Without yaw their difference is linear. With yaw its
/// derivative is (ϱ_c − r_R)/√(1 − σ²), and ϱ_c of [`super::locus`] is monotone in |σ|: between the at most two
/// places where ϱ_c = r_R there is at most one root each.
pub(super) fn arc_on_arc(walk: &mut Walk, wheel: (&ArcElement, &Placed), rail: (&ArcElement, [f64; 2])) {
    let ((arc, placed), (below, sine)) = (wheel, rail);
    let [low, high] = [placed.sine[0].max(sine[0]), placed.sine[1].min(sine[1])];
    let rounding = walk.rounding(arc.radius.abs() + below.radius.abs());
    let difference = below.radius - arc.radius;
    let slack = if difference == 0.0 { 0.0 } else { rounding / difference.abs() } + SINE_ROUNDING;
    if low > high + slack {
        return;
    }
    if walk.attitude.sin_yaw != 0.0 {
        return yawed(walk, arc, below, [low, high.max(low)], rounding);
    }
    let gap = placed.centre - below.centre[0];
    let sin = if difference == 0.0 {
        // Concentric and alike: they touch all along; the middle stands for it.
        if gap.abs() > rounding {
            return;
        }
        low + (high - low) / 2.0
    } else {
        let sin = gap / difference;
        if sin < low - slack || sin > high + slack {
            return;
        }
        sin.min(high).max(low)
    };
    offer(walk, arc, below, sin);
}

/// Roots over \[low, high\] of the difference of the two abscissae.
fn yawed(walk: &mut Walk, arc: &ArcElement, rail: &ArcElement, [low, high]: [f64; 2], rounding: f64) {
    let attitude = *walk.attitude;
    let mut cuts = [low; 4];
    let mut count = 1;
    for cut in turning_sines(&attitude, arc, rail.radius).into_iter().flatten() {
        if cut > cuts[count - 1] && cut < high {
            cuts[count] = cut;
            count += 1;
        }
    }
    cuts[count] = high;
    let mut apart = |sin: f64| {
        let cos = cosine(sin);
        let point = wheel_point(&attitude, arc, sin, cos);
        attitude.outline(&point).x - rail.at(sin, cos).x
    };
    let mut values = [0.0; 4];
    for k in 0..=count {
        values[k] = apart(cuts[k]);
    }
    for k in 0..count {
        let root = monotone(&mut apart, [cuts[k], cuts[k + 1]], [values[k], values[k + 1]], rounding);
        if let Some(sin) = root {
            offer(walk, arc, rail, sin);
        }
    }
}

/// Sines of the outline's tangent, ascending, where ϱ_c = r_R: (R − b) sin²ψ/cos³φ = r_R − r.
fn turning_sines(attitude: &Attitude, arc: &ArcElement, rail_radius: f64) -> [Option<f64>; 2] {
    let cube = (attitude.radius - arc.centre[1]) * attitude.sin_yaw_squared() / (rail_radius - arc.radius);
    if !(cube > 0.0 && cube < 1.0) {
        return [None; 2];
    }
    let cos = cube.cbrt();
    let sin = cosine(cos);
    [-sin, sin].map(|sin| Some(attitude.outline_sine(sin)))
}

/// A line of the wheel, a straight line as outline, over an arc or fan of the rail.
pub(super) fn line_on_arc(walk: &mut Walk, ends: &[Station; 2], rail: (&ArcElement, [f64; 2])) {
    let (below, sine) = rail;
    let outline = ends.map(|end| walk.attitude.outline(&end));
    let Station { sin, cos, .. } = outline[0];
    if !(cos > 0.0 && sin >= sine[0] - SINE_ROUNDING && sin <= sine[1] + SINE_ROUNDING) {
        return;
    }
    let foot = below.at(sin, cos);
    if let Some(point) = between(ends, &outline.map(|p| p.x), foot.x, walk.rounding(below.radius.abs())) {
        walk.offer(&point, f64::INFINITY, &foot, below.radius);
    }
}

/// An arc or fan of the wheel over a line of the rail.
pub(super) fn arc_on_line(walk: &mut Walk, wheel: (&ArcElement, &Placed), rail: &[Station; 2]) {
    let ((arc, placed), Station { sin, cos, .. }) = (wheel, rail[0]);
    if sin < placed.sine[0] - SINE_ROUNDING || sin > placed.sine[1] + SINE_ROUNDING {
        return;
    }
    let point = wheel_point(walk.attitude, arc, sin, cos);
    let x = walk.attitude.outline(&point).x;
    if let Some(foot) = between(rail, &rail.map(|p| p.x), x, walk.rounding(arc.radius.abs())) {
        walk.offer(&point, arc.radius, &foot, f64::INFINITY);
    }
}

/// Two lines: they touch all along if parallel; the middle stands for it.
pub(super) fn line_on_line(walk: &mut Walk, ends: &[Station; 2], rail: &[Station; 2]) {
    let outline = ends.map(|end| walk.attitude.outline(&end));
    let turn = outline[0].sin * rail[0].cos - outline[0].cos * rail[0].sin;
    if turn.is_nan() || turn.abs() > SINE_ROUNDING {
        return;
    }
    let (low, high) = (outline[0].x.max(rail[0].x), outline[1].x.min(rail[1].x));
    let x = low + (high - low) / 2.0;
    let point = between(ends, &outline.map(|p| p.x), x, 0.0);
    let foot = between(rail, &rail.map(|p| p.x), x, 0.0);
    if let (Some(point), Some(foot)) = (point, foot) {
        walk.offer(&point, f64::INFINITY, &foot, f64::INFINITY);
    }
}

/// The point of a line where a linear function of it, given at the ends, has a value.
pub(super) fn between(ends: &[Station; 2], values: &[f64; 2], value: f64, rounding: f64) -> Option<Station> {
    if !(value >= values[0] - rounding && value <= values[1] + rounding) {
        return None;
    }
    let share = ((value - values[0]) / (values[1] - values[0])).clamp(0.0, 1.0);
    let [a, b] = ends;
    Some(Station { x: a.x + share * (b.x - a.x), z: a.z + share * (b.z - a.z), ..*a })
}

fn offer(walk: &mut Walk, arc: &ArcElement, rail: &ArcElement, sin: f64) {
    let cos = cosine(sin);
    let point = wheel_point(walk.attitude, arc, sin, cos);
    walk.offer(&point, arc.radius, &rail.at(sin, cos), rail.radius);
}

/// The point of a wheel's arc whose outline has a given tangent.
fn wheel_point(attitude: &Attitude, arc: &ArcElement, sin: f64, cos: f64) -> Station {
    let (sin, cos) = attitude.profile_tangent(sin, cos);
    arc.at(sin, cos)
}

pub(super) fn cosine(sin: f64) -> f64 {
    ((1.0 - sin) * (1.0 + sin)).max(0.0).sqrt()
}

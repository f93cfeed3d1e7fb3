//! Solves pairs of arcs, lines and fans whose common tangent has a closed form: all except a yawed arc or fan over
//! an arc or fan.

use super::candidates::{Foot, Search};
use super::element::{ArcElement, Element, ElementCurve, SINE_ROUNDING, between};
use super::locus::Attitude;
use crate::numerics::cosine;
use crate::numerics::interval::Interval;
use crate::profile::Station;

/// Looks for contact of two elements; returns whether there is a closed form.
// As a call it would cost a sweep 2 per cent.
#[inline(always)]
pub(super) fn meet(search: &mut Search, elements: [u32; 2]) -> bool {
    let [wheel, rail] = search.elements(elements);
    let yawed = search.attitude.sin_yaw != 0.0;
    let mut pair = ArcPair { elements, search };
    match (&wheel.shape, &rail.shape) {
        (ElementCurve::Arc(arc), ElementCurve::Arc(below)) if !yawed => {
            pair.arc_on_arc((arc, wheel), (below, rail))
        }
        (ElementCurve::Line, ElementCurve::Arc(below)) => pair.line_on_arc(&wheel.ends, (below, rail)),
        (ElementCurve::Arc(arc), ElementCurve::Line) => pair.arc_on_line((arc, wheel), &rail.ends),
        (ElementCurve::Line, ElementCurve::Line) => pair.line_on_line(&wheel.ends, &rail.ends),
        _ => return false,
    }
    true
}

/// Two elements while they are solved.
struct ArcPair<'s, 'a> {
    elements: [u32; 2],
    search: &'s mut Search<'a>,
}

/// The outline of an arc or fan.
struct Seen {
    /// Sines of the tangents at both ends, ascending.
    sine: Interval,
    /// Abscissa of the centre without yaw \[mm\].
    centre: f64,
}

/// Returns the part of an arc or fan that has an outline; `None` if there is none.
///
/// An arc with its hollow side down has an outline only where ϱ_c < 0; elsewhere the rings beside it hide it.
fn seen(attitude: &Attitude, arc: &ArcElement, element: &Element) -> Option<Seen> {
    let mut sine = element.range;
    if attitude.sin_yaw != 0.0 {
        let steepest = steepest_seen(attitude, arc)?;
        if sine.low >= steepest || sine.high <= -steepest {
            return None;
        }
        sine = sine.map(|sin| attitude.outline_sine(sin.clamp(-steepest, steepest)));
    } else if attitude.sin_roll != 0.0 {
        sine = sine.map(|sin| attitude.rolled_sine(sin));
    }
    let centre = attitude.offset + arc.centre[0] * attitude.cos_roll + arc.centre[1] * attitude.sin_roll;
    (sine.low <= sine.high).then_some(Seen { sine, centre })
}

/// Returns the sine of the steepest profile tangent of an arc with an outline: cosψ; with the hollow side
/// down at most sinφ of cos³φ = (R − b) sin²ψ/|r|, `None` if no φ has that.
fn steepest_seen(attitude: &Attitude, arc: &ArcElement) -> Option<f64> {
    if arc.radius >= 0.0 {
        return Some(attitude.cos_yaw);
    }
    let cube = (attitude.radius - arc.centre[1]) * attitude.sin_yaw_squared() / -arc.radius;
    (cube < 1.0).then(|| cosine(cube.cbrt()).min(attitude.cos_yaw))
}

impl ArcPair<'_, '_> {
    /// Solves an arc or fan of the unyawed wheel over an arc or fan of the rail: both abscissae are linear in
    /// the sine of the tangent.
    #[inline(always)]
    fn arc_on_arc(&mut self, (arc, wheel): (&ArcElement, &Element), (below, rail): (&ArcElement, &Element)) {
        let Some(seen) = seen(self.search.attitude, arc, wheel) else { return };
        let Interval { low, high } = seen.sine.cut(rail.range);
        let rounding = self.search.rounding(arc.radius.abs() + below.radius.abs());
        let difference = below.radius - arc.radius;
        let slack = if difference == 0.0 { 0.0 } else { rounding / difference.abs() } + SINE_ROUNDING;
        if low > high + slack {
            return;
        }
        let gap = seen.centre - below.centre[0];
        let sin = if difference == 0.0 {
            // Concentric with equal radii: they touch all along, and the middle represents them.
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
        self.offer(arc, below, sin);
    }

    /// Solves a line of the wheel, whose outline is straight, over an arc or fan of the rail.
    fn line_on_arc(&mut self, ends: &[Station; 2], (below, rail): (&ArcElement, &Element)) {
        let outline = ends.map(|end| self.search.attitude.outline(&end));
        let Station { sin, cos, .. } = outline[0];
        if !(cos > 0.0 && rail.range.grown(SINE_ROUNDING).contains(sin)) {
            return;
        }
        let foot = below.at(sin, cos);
        let rounding = self.search.rounding(below.radius.abs());
        if let Some(point) = between(ends, abscissae(&outline), foot.x, rounding) {
            self.take(on_line(point), Foot { station: foot, radius: below.radius, parameter: sin });
        }
    }

    /// Solves an arc or fan of the wheel over a line of the rail.
    fn arc_on_line(&mut self, (arc, wheel): (&ArcElement, &Element), rail: &[Station; 2]) {
        let Station { sin, cos, .. } = rail[0];
        let Some(Seen { sine, .. }) = seen(self.search.attitude, arc, wheel) else { return };
        if !sine.grown(SINE_ROUNDING).contains(sin) {
            return;
        }
        let point = wheel_point(self.search.attitude, arc, sin, cos);
        let x = self.search.attitude.outline(&point).x;
        let rounding = self.search.rounding(arc.radius.abs());
        if let Some(foot) = between(rail, abscissae(rail), x, rounding) {
            let above = Foot { station: point, radius: arc.radius, parameter: point.sin };
            self.take(above, on_line(foot));
        }
    }

    /// Solves two lines: parallel ones touch all along, and the middle represents them.
    fn line_on_line(&mut self, ends: &[Station; 2], rail: &[Station; 2]) {
        let outline = ends.map(|end| self.search.attitude.outline(&end));
        let turn = outline[0].sin * rail[0].cos - outline[0].cos * rail[0].sin;
        if turn.is_nan() || turn.abs() > SINE_ROUNDING {
            return;
        }
        let (above, below) = (abscissae(&outline), abscissae(rail));
        let x = above.cut(below).middle();
        let (point, foot) = (between(ends, above, x, 0.0), between(rail, below, x, 0.0));
        if let (Some(point), Some(foot)) = (point, foot) {
            self.take(on_line(point), on_line(foot));
        }
    }

    fn offer(&mut self, arc: &ArcElement, rail: &ArcElement, sin: f64) {
        let cos = cosine(sin);
        let point = wheel_point(self.search.attitude, arc, sin, cos);
        let above = Foot { station: point, radius: arc.radius, parameter: point.sin };
        self.take(above, Foot { station: rail.at(sin, cos), radius: rail.radius, parameter: sin });
    }

    fn take(&mut self, wheel: Foot, rail: Foot) {
        self.search.offer(self.elements, &wheel, &rail);
    }
}

/// Returns the abscissae between the ends of a line \[mm\].
fn abscissae(ends: &[Station; 2]) -> Interval {
    ends.map(|end| end.x).into()
}

/// Returns the foot for a point of a line.
fn on_line(station: Station) -> Foot {
    Foot { station, radius: f64::INFINITY, parameter: station.x }
}

/// Returns the point of a wheel's arc whose outline has a given tangent.
fn wheel_point(attitude: &Attitude, arc: &ArcElement, sin: f64, cos: f64) -> Station {
    let (sin, cos) = attitude.profile_tangent(sin, cos);
    arc.at(sin, cos)
}

//! Pairs with a polynomial: roots isolated by bounds of slope and second derivative, so that none is missed.
//!
//! With dots for d/dx of the wheel profile's slope m and V = cos²ψ + sin²ψ(ϱ ṁ − m²) (positive where the outline is
//! seen), f = cosΘ_t/cosΘ = cos(roll) + tanΘ sin(roll), κ = ṁ cos³φ, along the outline
//!
//! ```text
//! dx/dx_W = f V/cosψ        d sinΘ_t/dx_W = f κ/cosψ
//! ```

use super::arcs::{SINE_ROUNDING, between, cosine};
use super::element::{ArcElement, Bounds, Element, Shape, Stretch};
use super::isolate::{Bounded, isolate};
use super::locus::Attitude;
use super::walk::{Placed, Walk};
use crate::profile::{Branch, Station};

type Interval = [f64; 2];

const ANYTHING: Interval = [f64::NEG_INFINITY, f64::INFINITY];

/// A polynomial stretch of the wheel over any element of the rail.
pub(super) fn over_rail(walk: &mut Walk, wheel: (&Stretch, Interval), rail: &Element) {
    let (stretch, x) = wheel;
    let pair = walk.pair;
    let branch = &pair.wheel_section.branches[stretch.branch];
    let below = match &rail.shape {
        Shape::Arc(arc) => Below::Arc(arc),
        Shape::Line(ends) => Below::Line(ends),
        Shape::Polynomial(stretch) => {
            Below::Stretch(&pair.rail_section.branches[stretch.branch], stretch.bounds.curvature, rail.x)
        }
    };
    let problem = OverRail { attitude: walk.attitude, branch, below };
    let rounding = problem.rounding(walk);
    let slope = problem.slope_from(&stretch.bounds, &stretch.middle, x);
    let half = (x[1] - x[0]) / 2.0;
    if problem.at(&stretch.middle).abs() - rounding > half * slope[0].abs().max(slope[1].abs()) {
        return;
    }
    isolate(&problem, x, slope, rounding, &mut |root| {
        let point = branch.station(root);
        let outline = problem.attitude.outline(&point);
        if let Some((foot, radius)) = problem.below.foot(&outline, rail.sine, walk.rounding(0.0)) {
            walk.offer(&point, branch.curvature(root).recip(), &foot, radius);
        }
    });
}

/// The element of the rail under a polynomial of the wheel.
enum Below<'a> {
    Arc(&'a ArcElement),
    Line(&'a [Station; 2]),
    Stretch(&'a Branch, Interval, Interval),
}

impl Below<'_> {
    /// The rail's point under an outline point with the same tangent, with its signed radius.
    fn foot(&self, outline: &Station, sine: Interval, rounding: f64) -> Option<(Station, f64)> {
        let Station { x, sin, cos, .. } = *outline;
        match self {
            Self::Arc(arc) => {
                let inside = sin >= sine[0] - SINE_ROUNDING && sin <= sine[1] + SINE_ROUNDING && cos > 0.0;
                inside.then(|| (arc.at(sin, cos), arc.radius))
            }
            Self::Line(ends) => {
                let foot = between(ends, &ends.map(|p| p.x), x, rounding)?;
                Some((foot, f64::INFINITY))
            }
            Self::Stretch(branch, _, [a, b]) => {
                let inside = x >= a - rounding && x <= b + rounding;
                let x = x.clamp(*a, *b);
                inside.then(|| (branch.station(x), branch.curvature(x).recip()))
            }
        }
    }
}

/// The condition for contact along a polynomial of the wheel: equal abscissae at equal tangents over an arc,
/// equal tangents at equal abscissae over a line or polynomial (held at its end value beyond its ends).
struct OverRail<'a> {
    attitude: &'a Attitude,
    branch: &'a Branch,
    below: Below<'a>,
}

impl OverRail<'_> {
    fn at(&self, point: &Station) -> f64 {
        let outline = self.attitude.outline(point);
        match &self.below {
            Below::Arc(arc) => outline.x - arc.at(outline.sin, outline.cos).x,
            Below::Line(ends) => outline.sin - ends[0].sin,
            Below::Stretch(branch, _, [a, b]) => outline.sin - branch.station(outline.x.clamp(*a, *b)).sin,
        }
    }

    fn slope_from(&self, bounds: &Bounds, middle: &Station, [a, b]: Interval) -> Interval {
        let Some(View { turn, seen }) = view(self.attitude, bounds, middle, b - a) else { return ANYTHING };
        let against = match &self.below {
            Below::Arc(arc) => minus(seen, scaled(bounds.curvature, arc.radius)),
            Below::Line(_) => bounds.curvature,
            Below::Stretch(_, curvature, _) => {
                let hull = [curvature[0].min(0.0), curvature[1].max(0.0)];
                minus(bounds.curvature, product(hull, seen))
            }
        };
        scaled(product(turn, against), self.attitude.cos_yaw.recip())
    }

    fn rounding(&self, walk: &Walk) -> f64 {
        match &self.below {
            Below::Arc(arc) => walk.rounding(arc.radius.abs()),
            _ => SINE_ROUNDING,
        }
    }
}

impl Bounded for OverRail<'_> {
    fn value(&self, x: f64) -> f64 {
        self.at(&self.branch.station(x))
    }

    fn slope(&self, a: f64, b: f64) -> Interval {
        let middle = self.branch.station(a + (b - a) / 2.0);
        self.slope_from(&Bounds::of(self.branch, a, b), &middle, [a, b])
    }
}

/// An arc, fan or line of the wheel over a polynomial stretch of the rail.
pub(super) fn under_wheel(walk: &mut Walk, wheel: &Element, placed: &Placed, rail: (&Stretch, Interval)) {
    let (stretch, x) = rail;
    let pair = walk.pair;
    let branch = &pair.rail_section.branches[stretch.branch];
    let above = match &wheel.shape {
        Shape::Arc(arc) => Above::Arc(arc),
        Shape::Line(ends) => Above::Line(ends),
        Shape::Polynomial(_) => return,
    };
    let problem = UnderWheel { attitude: walk.attitude, branch, above };
    let rounding = match &problem.above {
        Above::Arc(arc) => walk.rounding(arc.radius.abs()),
        Above::Line(_) => SINE_ROUNDING,
    };
    let slope = problem.slope_from(&stretch.bounds);
    isolate(&problem, x, slope, rounding, &mut |root| {
        let foot = branch.station(root);
        if let Some((point, radius)) = problem.above.point(walk, &foot, placed.sine) {
            walk.offer(&point, radius, &foot, branch.curvature(root).recip());
        }
    });
}

/// The element of the wheel over a polynomial of the rail.
enum Above<'a> {
    Arc(&'a ArcElement),
    Line(&'a [Station; 2]),
}

impl Above<'_> {
    fn point(&self, walk: &Walk, foot: &Station, sine: Interval) -> Option<(Station, f64)> {
        match self {
            Self::Arc(arc) => {
                let inside = foot.sin >= sine[0] - SINE_ROUNDING && foot.sin <= sine[1] + SINE_ROUNDING;
                let (sin, cos) = walk.attitude.profile_tangent(foot.sin, foot.cos);
                inside.then(|| (arc.at(sin, cos), arc.radius))
            }
            Self::Line(ends) => {
                let x = ends.map(|end| walk.attitude.outline(&end).x);
                let point = between(ends, &x, foot.x, walk.rounding(0.0))?;
                Some((point, f64::INFINITY))
            }
        }
    }
}

/// The condition for contact along a polynomial of the rail: equal abscissae at equal tangents under an arc, with
/// slope ϱ_c κ_R − 1; the line's tangent under a line.
struct UnderWheel<'a> {
    attitude: &'a Attitude,
    branch: &'a Branch,
    above: Above<'a>,
}

impl UnderWheel<'_> {
    fn slope_from(&self, bounds: &Bounds) -> Interval {
        let Above::Arc(arc) = &self.above else { return bounds.curvature };
        let cos = bounds.slope.map(|m| {
            let cos = m.hypot(1.0).recip();
            self.attitude.profile_tangent(if m.is_infinite() { m.signum() } else { m * cos }, cos)
        });
        let steep = cos[0].1.min(cos[1].1);
        let flat = if cos[0].0 * cos[1].0 <= 0.0 { 1.0 } else { cos[0].1.max(cos[1].1) };
        let ring = (self.attitude.radius - arc.centre[1]) * self.attitude.sin_yaw_squared();
        if steep <= 0.0 && ring != 0.0 {
            return ANYTHING;
        }
        let outline = if ring == 0.0 {
            [arc.radius; 2]
        } else {
            [flat, steep].map(|cos| arc.radius + ring / (cos * cos * cos))
        };
        minus(product(outline, bounds.curvature), [1.0; 2])
    }
}

impl Bounded for UnderWheel<'_> {
    fn value(&self, x: f64) -> f64 {
        let foot = self.branch.station(x);
        match &self.above {
            Above::Arc(arc) => {
                let (sin, cos) = self.attitude.profile_tangent(foot.sin, foot.cos);
                self.attitude.outline(&arc.at(sin, cos)).x - foot.x
            }
            Above::Line(ends) => foot.sin - self.attitude.outline(&ends[0]).sin,
        }
    }

    fn slope(&self, a: f64, b: f64) -> Interval {
        self.slope_from(&Bounds::of(self.branch, a, b))
    }
}

/// f and V over a stretch.
struct View {
    turn: Interval,
    seen: Interval,
}

/// Bounds of f and V, or `None` where part of the stretch has no outline or is turned over by the roll.
fn view(attitude: &Attitude, bounds: &Bounds, middle: &Station, width: f64) -> Option<View> {
    let mut tangents = bounds.slope;
    let mut seen = [1.0; 2];
    if attitude.sin_yaw != 0.0 {
        let steepness = bounds.slope.map(|m| m * attitude.sin_yaw / attitude.cos_yaw);
        if !steepness.iter().all(|s| s.abs() < 1.0) {
            return None;
        }
        for (tangent, s) in tangents.iter_mut().zip(steepness) {
            *tangent /= attitude.cos_yaw * cosine(s);
        }
        let steepest = bounds.slope[0].abs().max(bounds.slope[1].abs());
        let rise = steepest * width / 2.0;
        let rolling = attitude.radius - middle.z;
        let rings = product(bounds.second, [rolling - rise, rolling + rise]);
        let lowest = if bounds.slope[0] * bounds.slope[1] <= 0.0 {
            0.0
        } else {
            bounds.slope[0].abs().min(bounds.slope[1].abs())
        };
        let tilt = minus(rings, [lowest * lowest, steepest * steepest]);
        let square = attitude.sin_yaw_squared();
        seen = [1.0 - square + square * tilt[0], 1.0 - square + square * tilt[1]];
    }
    let turn = scaled(tangents, attitude.sin_roll).map(|v| v + attitude.cos_roll);
    (turn[0] > 0.0).then_some(View { turn, seen })
}

/// Abscissae between which the outline of a stretch lies, in any order; anything where it may turn back.
///
/// An outline that exists and is nowhere turned over by the roll runs to larger x as long as V > 0.
pub(super) fn range(attitude: &Attitude, stretch: &Stretch, element: &Element) -> Interval {
    if attitude.sin_yaw != 0.0 || attitude.sin_roll != 0.0 {
        let width = element.x[1] - element.x[0];
        if !view(attitude, &stretch.bounds, &stretch.middle, width).is_some_and(|view| view.seen[0] > 0.0) {
            return ANYTHING;
        }
    }
    element.ends.map(|end| attitude.outline(&end).x)
}

fn product(a: Interval, b: Interval) -> Interval {
    let all = [a[0] * b[0], a[0] * b[1], a[1] * b[0], a[1] * b[1]];
    // 0 × ∞ says nothing.
    if all.iter().any(|v| v.is_nan()) {
        return ANYTHING;
    }
    [all.into_iter().fold(f64::INFINITY, f64::min), all.into_iter().fold(f64::NEG_INFINITY, f64::max)]
}

fn minus(a: Interval, b: Interval) -> Interval {
    [a[0] - b[1], a[1] - b[0]]
}

fn scaled(a: Interval, by: f64) -> Interval {
    product(a, [by; 2])
}

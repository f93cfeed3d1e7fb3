//! The outer surface of a profile as the search walks over it: arcs, lines, polynomial stretches, and the fans
//! of normals at kinks, steps and ends.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use crate::profile::{ArcBranch, Branch, BranchShape, ONE_JOINT, Profile, Section, Side, Station};

/// A polynomial is cut until the second derivative varies by less than this share of its size, which makes
/// nearly every pair of stretches decidable at sight. Smaller shares make more stretches to look at.
const VARIATION: f64 = 0.25;

/// No stretch of a polynomial is halved more often than this: 2⁻¹⁰ of a zone of 60 mm is 0.06 mm.
const DEEPEST_CUT: u32 = 10;

/// One stretch of a profile, or the fan of normals at one of its points.
#[derive(Debug, Clone)]
pub(super) struct Element {
    /// What it is.
    pub shape: Shape,
    /// Abscissae between which it lies, ascending \[mm\].
    pub x: [f64; 2],
    /// Sines of the tangent angles it has, ascending.
    pub sine: [f64; 2],
    /// Its points with the extreme tangents of `sine`; of a polynomial the two ends.
    pub ends: [Station; 2],
}

/// The shapes the search tells apart.
#[derive(Debug, Clone)]
pub(super) enum Shape {
    /// An arc; of radius 0 for a fan.
    Arc(ArcElement),
    /// A line with its two ends.
    Line([Station; 2]),
    /// Part of a polynomial.
    Polynomial(Stretch),
}

/// An arc in terms of its tangent's sine.
#[derive(Debug, Clone, Copy)]
pub(super) struct ArcElement {
    anchor: Station,
    /// Signed radius \[mm\]: positive with the hollow side up; +0 for a fan of the wheel, −0 of the rail, so that
    /// the curvature is ±∞ as it should.
    pub radius: f64,
    /// Centre \[mm\]: good for abscissae, too coarse for heights when the radius is large.
    pub centre: [f64; 2],
}

/// Part of a polynomial branch with what bounds it.
#[derive(Debug, Clone)]
pub(super) struct Stretch {
    /// The branch it is part of.
    pub branch: usize,
    /// The point in its middle.
    pub middle: Station,
    /// Bounds over the stretch.
    pub bounds: Bounds,
}

/// Bounds of a branch over an interval: slope ζ′, ζ″ \[1/mm\], curvature \[1/mm\].
#[derive(Debug, Clone, Copy)]
pub(super) struct Bounds {
    /// ζ′.
    pub slope: [f64; 2],
    /// ζ″.
    pub second: [f64; 2],
    /// ζ″ cos³φ.
    pub curvature: [f64; 2],
}

impl ArcElement {
    fn of(arc: &ArcBranch) -> Self {
        let [x, z] = arc.anchor;
        let centre = [x - arc.radius * arc.sin, z + arc.radius * arc.cos];
        Self { anchor: Station { x, z, cos: arc.cos, sin: arc.sin }, radius: arc.radius, centre }
    }

    fn fan(point: &Station, side: Side) -> Self {
        let anchor = Station { cos: 1.0, sin: 0.0, ..*point };
        let radius = if side == Side::Wheel { 0.0 } else { -0.0 };
        Self { anchor, radius, centre: [point.x, point.z] }
    }

    /// The point with a given tangent.
    #[inline]
    pub fn at(&self, sin: f64, cos: f64) -> Station {
        let a = &self.anchor;
        let run = self.radius * (sin - a.sin);
        Station { x: a.x + run, z: a.z + run * ((a.sin + sin) / (a.cos + cos)), cos, sin }
    }
}

impl Bounds {
    /// Bounds over \[a, b\] of a branch.
    pub fn of(branch: &Branch, a: f64, b: f64) -> Self {
        let [slope, second] = branch.derivative_bounds(a, b);
        let steepest = slope[0].abs().max(slope[1].abs());
        let flattest = if slope[0] * slope[1] <= 0.0 { 0.0 } else { slope[0].abs().min(slope[1].abs()) };
        let cubes = [steepest, flattest].map(|m| m.hypot(1.0).powi(-3));
        let largest = |v: f64, up: bool| if (v > 0.0) == up { v * cubes[1] } else { v * cubes[0] };
        Self { slope, second, curvature: [largest(second[0], false), largest(second[1], true)] }
    }

    fn varies(&self) -> bool {
        let size = self.second[0].abs().max(self.second[1].abs());
        self.second[1] - self.second[0] > VARIATION * size
    }
}

/// All elements of the outer surface, from left to right.
pub(super) fn elements(profile: &Profile, section: &Section, side: Side) -> Vec<Element> {
    let rounding = ONE_JOINT * profile.extent();
    let (material_left, material_right) = match side {
        Side::Wheel => (-FRAC_PI_2, FRAC_PI_2),
        Side::Rail => (FRAC_PI_2, -FRAC_PI_2),
    };
    let mut out = Vec::new();
    let mut last: Option<Station> = None;
    for piece in &section.pieces {
        let branch = &section.branches[piece.branch];
        let [start, end] = piece.xi.map(|x| branch.station(x));
        match last {
            None => out.extend(fan(&start, material_left, start.angle(), side)),
            Some(before) => corner(&before, &start, rounding, side, &mut out),
        }
        smooth(branch, piece.branch, [start, end], &mut out);
        last = Some(end);
    }
    out.extend(last.and_then(|end| fan(&end, end.angle(), material_right, side)));
    out
}

/// The fans between the end of one stretch and the start of the next; a step is bridged by a straight line.
fn corner(end: &Station, start: &Station, rounding: f64, side: Side, out: &mut Vec<Element>) {
    let (run, rise) = (start.x - end.x, start.z - end.z);
    if run.hypot(rise) <= rounding {
        out.extend(fan(start, end.angle(), start.angle(), side));
    } else {
        let step = rise.atan2(run);
        out.extend(fan(end, end.angle(), step, side));
        out.extend(fan(start, step, start.angle(), side));
    }
}

/// The fan of normals where the direction of travel turns from one angle to another, or `None` where the corner
/// is hollow: nothing touches there first.
fn fan(point: &Station, from: f64, to: f64, side: Side) -> Option<Element> {
    let mut turn = to - from;
    if turn > PI {
        turn -= TAU;
    } else if turn <= -PI {
        turn += TAU;
    }
    let [low, high] = match side {
        Side::Wheel if turn > 0.0 => [from, from + turn],
        Side::Rail if turn < 0.0 => [from + turn, from],
        _ => return None,
    };
    let (low, high) = (low.max(-FRAC_PI_2), high.min(FRAC_PI_2));
    let ends = [low, high].map(|angle| Station { sin: angle.sin(), cos: angle.cos().max(0.0), ..*point });
    (low < high).then(|| Element {
        shape: Shape::Arc(ArcElement::fan(point, side)),
        x: [point.x; 2],
        sine: ends.map(|end| end.sin),
        ends,
    })
}

fn smooth(branch: &Branch, index: usize, mut ends: [Station; 2], out: &mut Vec<Element>) {
    let x = ends.map(|end| end.x);
    let shape = match &branch.shape {
        BranchShape::Arc(arc) if arc.curvature == 0.0 => Shape::Line(ends),
        BranchShape::Arc(arc) => Shape::Arc(ArcElement::of(arc)),
        BranchShape::Polynomial(_) => return cut(branch, index, x, DEEPEST_CUT, out),
    };
    if ends[0].sin > ends[1].sin {
        ends.swap(0, 1);
    }
    out.push(Element { shape, x, sine: ends.map(|end| end.sin), ends });
}

/// Cuts a polynomial until its second derivative is nearly constant.
fn cut(branch: &Branch, index: usize, [a, b]: [f64; 2], depth: u32, out: &mut Vec<Element>) {
    let bounds = Bounds::of(branch, a, b);
    let middle = a + (b - a) / 2.0;
    if depth > 0 && bounds.varies() && a < middle && middle < b {
        cut(branch, index, [a, middle], depth - 1, out);
        return cut(branch, index, [middle, b], depth - 1, out);
    }
    let stretch = Stretch { branch: index, middle: branch.station(middle), bounds };
    let sine = bounds.slope.map(sine_of_slope);
    let ends = [a, b].map(|x| branch.station(x));
    out.push(Element { shape: Shape::Polynomial(stretch), x: [a, b], sine, ends });
}

fn sine_of_slope(slope: f64) -> f64 {
    if slope.is_infinite() { slope.signum() } else { slope / slope.hypot(1.0) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Result;
    use crate::profile::standards;

    #[test]
    fn fans_stand_at_ends_and_at_outward_kinks_only() -> Result<()> {
        let profile = standards::wheel("EN15302-A")?;
        let section = Section::own_axes(&profile, Side::Wheel);
        let fans: Vec<f64> = elements(&profile, &section, Side::Wheel)
            .iter()
            .filter(|e| e.x[0] == e.x[1])
            .map(|e| e.x[0])
            .collect();
        // The flange back, the kinks to 1:15 and to the chamfer, and the outer face; beside them only steps and
        // kinks of the drawing's rounding.
        for x in [30.0, 60.0, 65.0] {
            assert!(fans.contains(&x), "{x} is not among {fans:?}");
        }
        Ok(())
    }

    #[test]
    fn polynomials_are_cut_to_nearly_constant_second_derivatives() -> Result<()> {
        let profile = standards::wheel("S1002")?;
        let section = Section::own_axes(&profile, Side::Wheel);
        let all = elements(&profile, &section, Side::Wheel);
        assert!(all.len() < 400, "{}", all.len());
        for pair in all.windows(2) {
            assert!((pair[0].x[1] - pair[1].x[0]).abs() < 2e-3);
        }
        Ok(())
    }
}

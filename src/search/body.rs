//! Prepares a profile for searches: the elements of its outer surface from left to right, and a balanced tree
//! of bounds over them.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::bounds::{Bounds, DerivativeBounds};
use super::element::{ArcElement, Element, ElementCurve, ElementPoint, PolynomialPart};
use crate::numerics::interval::Interval;
use crate::numerics::polynomial::bernstein;
use crate::profile::{Branch, BranchPoint, BranchShape, ONE_JOINT, PolynomialBranch, Section, Side, Station};

/// Most halvings of a stretch of a polynomial: 2⁻¹⁰ of a zone of 60 mm is 0.06 mm.
const DEEPEST_CUT: u32 = 10;

/// Turn \[rad\] up to which a joint is no kink: both neighbours take a contact there. The tangents at a joint
/// of spans differ by some roundings; a fan for each would double the elements.
pub(super) const LEAST_KINK: f64 = 64.0 * f64::EPSILON;

/// Roundings of a profile's extent by which bounds are widened: those of a point's coordinates and of its
/// level.
const BOUND_ROUNDINGS: f64 = 16.0;

/// Fewest corners of the polygon of tangents around an arc: with four, the corners are off the arc by a
/// sixteenth of its height.
const CORNERS: f64 = 4.0;

/// Largest turn \[rad\] of the tangent from one corner of that polygon to the next.
const CORNER_TURN: f64 = 0.125;

/// The outer surface of one body, prepared for searches.
#[derive(Debug, Clone)]
pub(super) struct SearchBody {
    /// The elements, from left to right.
    pub elements: Vec<Element>,
    /// Coefficients \[x, z\] of all stretches.
    pub coefficients: Vec<[f64; 2]>,
    /// The tree over the elements: the root is first, a left child follows its parent.
    pub nodes: Vec<TreeNode>,
    /// Rounding of a bound \[mm\].
    pub rounding: f64,
    /// Bounds of x and of z of the whole surface \[mm\].
    pub extent: [Interval; 2],
}

/// A node of the tree: a range of elements.
#[derive(Debug, Clone, Copy)]
pub(super) struct TreeNode {
    /// Bounds of all elements of the node.
    pub bounds: Bounds,
    /// Index of the right child, or 0 for a leaf.
    pub right: u32,
    /// Index of the first element.
    pub element: u32,
    /// Larger side of the bounding box \[mm\].
    pub size: f64,
}

impl SearchBody {
    /// Prepares the part of a profile that faces the other body in its own axes; `extent` is the profile's
    /// extent \[mm\]. `None` if no part faces the other body.
    ///
    /// Cost: n log n for n elements; some microseconds each.
    pub fn new(section: &Section, extent: f64, side: Side) -> Option<Self> {
        Self::with_arcs_up_to(f64::INFINITY, section, extent, side)
    }

    /// Prepares the part of a profile that faces the other body, with arcs, lines and polynomials cut to `longest` \[mm\] or less in x, so
    /// that the bounds of each are narrow. `None` if no part faces the other body.
    pub fn with_arcs_up_to(longest: f64, section: &Section, extent: f64, side: Side) -> Option<Self> {
        let rounding = BOUND_ROUNDINGS * f64::EPSILON * extent;
        let mut builder = TreeBuilder {
            side,
            rounding,
            longest,
            elements: Vec::new(),
            coefficients: Vec::new(),
            hull: Vec::new(),
            firsts: Vec::new(),
        };
        builder.surface(section, ONE_JOINT * extent);
        builder.firsts.push(builder.hull.len());
        let mut nodes = Vec::with_capacity(2 * builder.elements.len());
        if builder.elements.is_empty() {
            return None;
        }
        builder.tree(0, builder.elements.len(), &mut nodes);
        let TreeBuilder { elements, coefficients, .. } = builder;
        let whole = &nodes[0].bounds;
        let extent = [whole.x, whole.z];
        Some(Self { elements, coefficients, nodes, rounding, extent })
    }

    /// Returns the point at an abscissa \[mm\], with the index of its element and its parameter. The abscissa must be within the body's extent.
    pub fn point_at(&self, x: f64) -> (u32, f64, ElementPoint) {
        let index = self.elements.partition_point(|element| element.bounds.x.high < x);
        let index = index.min(self.elements.len() - 1);
        let element = &self.elements[index];
        let parameter = element.parameter_at(&self.coefficients, x);
        (index as u32, parameter, element.place(&self.coefficients, parameter))
    }
}

struct TreeBuilder {
    side: Side,
    rounding: f64,
    /// Largest run of an element in x \[mm\].
    longest: f64,
    elements: Vec<Element>,
    coefficients: Vec<[f64; 2]>,
    /// Points whose hull holds the elements, in the order of the elements.
    hull: Vec<[f64; 2]>,
    /// Index in `hull` of each element's first point.
    firsts: Vec<usize>,
}

impl TreeBuilder {
    /// Appends all elements, from left to right.
    fn surface(&mut self, section: &Section, joint: f64) {
        let (material_left, material_right) = match self.side {
            Side::Wheel => (-FRAC_PI_2, FRAC_PI_2),
            Side::Rail => (FRAC_PI_2, -FRAC_PI_2),
        };
        let mut last: Option<Station> = None;
        for piece in &section.pieces {
            let (branch, xi) = (&section.branches[piece.branch], piece.xi);
            let [start, end] = xi.ends().map(|x| branch.station(x));
            match last {
                None => self.fan(&start, material_left, start.angle()),
                Some(before) => self.corner(&before, &start, joint),
            }
            let parts = (xi.width() / self.longest).ceil().max(1.0);
            let cut = |k: f64| if k < parts { xi.at(k / parts) } else { xi.high };
            for k in 0..parts as u32 {
                let part = Interval::new(cut(f64::from(k)), cut(f64::from(k) + 1.0));
                self.smooth(branch, part, part.ends().map(|x| branch.station(x)));
            }
            last = Some(end);
        }
        if let Some(end) = last {
            self.fan(&end, end.angle(), material_right);
        }
    }

    /// Appends the fans between the end of one piece and the start of the next: one fan if they meet, two if
    /// the surface continues at another height, behind a part that overhangs.
    fn corner(&mut self, end: &Station, start: &Station, joint: f64) {
        let (run, rise) = (start.x - end.x, start.z - end.z);
        if run.hypot(rise) <= joint {
            self.fan(start, end.angle(), start.angle());
        } else {
            let step = rise.atan2(run);
            self.fan(end, end.angle(), step);
            self.fan(start, step, start.angle());
        }
    }

    /// Appends the fan of normals where the direction of travel turns from one angle to another; none at a
    /// hollow corner, as nothing touches there first.
    fn fan(&mut self, point: &Station, from: f64, to: f64) {
        let mut turn = to - from;
        if turn > PI {
            turn -= TAU;
        } else if turn <= -PI {
            turn += TAU;
        }
        let angles = match self.side {
            Side::Wheel if turn > LEAST_KINK => Interval::new(from, from + turn),
            Side::Rail if turn < -LEAST_KINK => Interval::new(from + turn, from),
            _ => return,
        };
        let angles = angles.cut(Interval::symmetric(FRAC_PI_2));
        if !angles.has_width() {
            return;
        }
        let ends =
            angles.ends().map(|angle| Station { sin: angle.sin(), cos: angle.cos().max(0.0), ..*point });
        let at = [point.x, point.z];
        let curvature = match self.side {
            Side::Wheel => f64::INFINITY,
            Side::Rail => f64::NEG_INFINITY,
        };
        let shape = ElementCurve::Arc(ArcElement::fan(point, self.side));
        let sines = sines(&ends);
        self.push(shape, sines, ends, &[at], [at; 2], [sines, Interval::of(curvature)]);
    }

    fn smooth(&mut self, branch: &Branch, xi: Interval, mut ends: [Station; 2]) {
        let outer = ends.map(|end| [end.x, end.z]);
        match (&branch.shape, xi.ends().map(|xi| branch.point(xi).0)) {
            (BranchShape::Arc(arc), _) if arc.curvature == 0.0 => {
                self.push(ElementCurve::Line, xi, ends, &outer, outer, [sines(&ends), Interval::of(0.0)]);
            }
            (BranchShape::Arc(arc), _) => {
                let hull = tangents(&ends, arc.radius);
                if ends[0].sin > ends[1].sin {
                    ends.swap(0, 1);
                }
                let shape = ElementCurve::Arc(ArcElement::of(arc));
                let sines = sines(&ends);
                self.push(shape, sines, ends, &hull, outer, [sines, Interval::of(arc.curvature)]);
            }
            (
                BranchShape::Polynomial(polynomial),
                [BranchPoint::Polynomial { t: [a], .. }, BranchPoint::Polynomial { t: [b], .. }],
            ) => {
                self.polynomial(polynomial, Interval::new(a, b));
            }
            // Both ends of a polynomial's piece are points of a polynomial, so this does not occur.
            (BranchShape::Polynomial(_), _) => {}
        }
    }

    fn polynomial(&mut self, polynomial: &PolynomialBranch, range: Interval) {
        let first = self.coefficients.len();
        let count = polynomial.xi.len().max(polynomial.zeta.len());
        let get = |c: &[f64], k: usize| c.get(k).copied().unwrap_or(0.0);
        self.coefficients.extend((0..count).map(|k| [get(&polynomial.xi, k), get(&polynomial.zeta, k)]));
        self.cut(first, count, range, DEEPEST_CUT);
    }

    /// Cuts a polynomial until its bounds are narrow enough to be useful, and appends the parts.
    fn cut(&mut self, first: usize, count: usize, range: Interval, depth: u32) {
        let own = &self.coefficients[first..first + count];
        let (reach, middle, [a, b]) = (DerivativeBounds::of(own, range), range.middle(), range.ends());
        if depth > 0 && reach.is_wide(range.width()) && a < middle && middle < b {
            return range.halves().into_iter().for_each(|half| self.cut(first, count, half, depth - 1));
        }
        let [x, z] = [0, 1].map(|axis| {
            let c: Vec<f64> = own.iter().map(|c| c[axis]).collect();
            bernstein(&c, range)
        });
        let hull: Vec<[f64; 2]> = x.into_iter().zip(z).map(|(x, z)| [x, z]).collect();
        let stretch = PolynomialPart { first, count, reach };
        let shape = ElementCurve::Stretch(stretch);
        let ends = [a, b].map(|t| stretch.place(&self.coefficients, t).station);
        let outer = ends.map(|end| [end.x, end.z]);
        self.push(shape, range, ends, &hull, outer, [reach.sine, reach.curvature]);
    }

    fn push(
        &mut self,
        shape: ElementCurve,
        range: Interval,
        ends: [Station; 2],
        hull: &[[f64; 2]],
        outer: [[f64; 2]; 2],
        turns: [Interval; 2],
    ) {
        let bounds = Bounds::of_hull(hull, outer, turns, self.side, self.rounding);
        self.firsts.push(self.hull.len());
        self.hull.extend_from_slice(hull);
        let middle = shape.place(&ends[0], &self.coefficients, range.middle());
        self.elements.push(Element { shape, range, ends, middle, bounds });
    }

    /// Appends the tree over a range of elements, the parent first; returns the index of its root.
    fn tree(&self, from: usize, to: usize, nodes: &mut Vec<TreeNode>) -> u32 {
        let own = nodes.len();
        let bounds = if to - from == 1 { self.elements[from].bounds } else { self.joined(from, to) };
        let size = bounds.x.width().max(bounds.z.width());
        nodes.push(TreeNode { bounds, right: 0, element: from as u32, size });
        if to - from > 1 {
            let middle = self.middle(from, to);
            self.tree(from, middle, nodes);
            nodes[own].right = self.tree(middle, to, nodes);
        }
        own as u32
    }

    /// Returns where to cut a range of elements in two: near the middle of its length, with at least a
    /// quarter of the elements on either side.
    fn middle(&self, from: usize, to: usize) -> usize {
        let own = &self.elements[from..to];
        let length = |e: &Element| e.bounds.x.width() + e.bounds.z.width();
        let half = 0.5 * own.iter().map(length).sum::<f64>();
        let mut walked = 0.0;
        let cut = own.iter().position(|element| {
            walked += length(element);
            walked > half
        });
        let count = to - from;
        let least = (count / 4).max(1);
        from + cut.unwrap_or(count / 2).clamp(least, count - least)
    }

    /// Returns the bounds of several elements.
    fn joined(&self, from: usize, to: usize) -> Bounds {
        let own = &self.elements[from..to];
        let hull = |of: fn(&Element) -> Interval| own.iter().map(of).fold(Interval::NONE, Interval::hull);
        let (sine, curvature) = (hull(|e| e.bounds.sine), hull(|e| e.bounds.curvature));
        let x = hull(|e| e.bounds.x);
        let hull = &self.hull[self.firsts[from]..self.firsts[to]];
        let height = |points: Option<&[f64; 2]>| points.map_or(0.0, |p| p[1]);
        let ends = [[x.low, height(hull.first())], [x.high, height(hull.last())]];
        Bounds::of_hull(hull, ends, [sine, curvature], self.side, self.rounding)
    }
}

/// Returns the sines of the tangents at both ends.
fn sines(ends: &[Station; 2]) -> Interval {
    ends.map(|end| end.sin).into()
}

/// Returns both ends of an arc and the corners of its tangents, in order of travel.
fn tangents(ends: &[Station; 2], radius: f64) -> Vec<[f64; 2]> {
    let [start, end] = ends;
    let relative = end.seen_from(start);
    let turn = relative.sin.atan2(relative.cos);
    let corners = (turn.abs() / CORNER_TURN).ceil().max(CORNERS);
    let half = 0.5 * turn / corners;
    let mut out = vec![[start.x, start.z]];
    for k in 0..corners as u32 {
        // The chord from the start to the point before the corner, then along the tangent there.
        let before = f64::from(k) * turn / corners;
        let chord = 2.0 * radius * (0.5 * before).sin();
        let lead = radius * half.tan();
        let x = chord * (0.5 * before).cos() + lead * before.cos();
        let z = chord * (0.5 * before).sin() + lead * before.sin();
        let corner = Station { x, z, ..Station::AXES }.placed_by(start);
        out.push([corner.x, corner.z]);
    }
    out.push([end.x, end.z]);
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Result;
    use crate::profile::standards;

    #[test]
    fn fans_stand_at_ends_and_at_outward_kinks_only() -> Result<()> {
        let profile = standards::wheel("EN15302-A")?;
        let body = SearchBody::new(&Section::own_axes(&profile, Side::Wheel), profile.extent(), Side::Wheel)
            .expect("a wheel");
        let fans: Vec<f64> =
            body.elements.iter().map(|e| e.bounds.x).filter(|x| x.low == x.high).map(|x| x.low).collect();
        // The flange back, the kinks to 1:15 and to the chamfer, and the outer face; apart from these, only
        // kinks of the drawing's rounding.
        for x in [30.0, 60.0, 65.0] {
            assert!(fans.contains(&x), "{x} is not among {fans:?}");
        }
        Ok(())
    }

    #[test]
    fn polynomials_are_cut_into_few_stretches_without_gaps() -> Result<()> {
        let profile = standards::wheel("S1002")?;
        let body = SearchBody::new(&Section::own_axes(&profile, Side::Wheel), profile.extent(), Side::Wheel)
            .expect("a wheel");
        assert!(body.elements.len() < 200, "{}", body.elements.len());
        for pair in body.elements.windows(2) {
            assert!((pair[0].bounds.x.high - pair[1].bounds.x.low).abs() < 2e-3);
        }
        Ok(())
    }

    /// Checks that every point of every element lies within the bounds of all nodes above it.
    #[test]
    fn bounds_hold() -> Result<()> {
        for (name, side) in [("S1002", Side::Wheel), ("EN15302-A", Side::Wheel), ("60E1", Side::Rail)] {
            let profile = if side == Side::Rail { standards::rail(name)? } else { standards::wheel(name)? };
            let body = SearchBody::new(&Section::own_axes(&profile, side), profile.extent(), side)
                .expect("a surface");
            let mut checked = 0;
            for (index, node) in body.nodes.iter().enumerate() {
                let next = if node.right == 0 {
                    node.element as usize + 1
                } else {
                    // The right child ends where this node does: at its last leaf.
                    let mut last = &body.nodes[node.right as usize];
                    while last.right != 0 {
                        last = &body.nodes[last.right as usize];
                    }
                    last.element as usize + 1
                };
                for element in &body.elements[node.element as usize..next] {
                    for k in 0..=20 {
                        let p = element.range.at(f64::from(k) / 20.0);
                        let Station { x, z, sin, .. } = element.place(&body.coefficients, p).station;
                        let b = &node.bounds;
                        let level = z * b.chord[0] - x * b.chord[1];
                        let over = if side == Side::Wheel { level - b.level } else { b.level - level };
                        assert!(over >= 0.0, "{name} {index}: {over:e}");
                        let slack = 1e-13;
                        assert!(b.x.grown(slack).contains(x), "{name} {index}");
                        assert!(b.sine.grown(slack).contains(sin), "{name} {index}: {sin} {:?}", b.sine);
                        checked += 1;
                    }
                }
            }
            assert!(checked > 500, "{checked}");
        }
        Ok(())
    }
}

//! Edges in a contact: kinks and steps of s at which the elastic pressure has no bound, and roundings that cells do not show.

use std::f64::consts::{LN_2, PI};

use super::pressures::Pressures;
use crate::numerics::interval::Interval;
use crate::placement::Placement;
use crate::separation::Evaluator;

/// Lines along either axis on which edges are looked for: edges cross the contact along either of the axes.
const LINES: usize = 5;

/// Most parts into which a line is divided; each is halved as long as s turns enough in it.
const PARTS: usize = 64;

/// Width \[mm\] in which s turns at a sharp edge. One that turns over more is rounded.
const SHARP: f64 = 1e-6;

/// Least step of s \[mm\] at which a surface ends. Gaps between segments are a thousand times smaller.
const STEP: f64 = 1e-4;

/// ln 1000. An edge counts if its pressure passes the largest one on cells of a thousandth of the sides: smaller ones are no
/// continuum.
const FINEST: f64 = 6.9;

/// Most e-folds of a rounded edge: just fewer than of a sharp one.
const ROUNDED: f64 = 0.99 * FINEST;

/// How much an edge raises the largest pressure, relative, before it counts: that is the error of the cells.
const RISE: f64 = 0.01;

/// Growth of p/(π E*) at an edge wherever cells are e times smaller, per change of slope.
const GROWTH: f64 = 0.5 / (PI * PI);

/// An edge in the contact, along ξ or η, at which the surfaces press into each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SharpEdge {
    /// ξ and η \[mm\].
    pub at_mm: [f64; 2],
    /// Change of the slope of s along the line across it \[1\], > 0; infinite where a surface ends.
    pub kink: f64,
    /// Rise of its pressure where cells are half as wide \[N/mm²\].
    pub rise_n_per_mm2: f64,
    /// By how much its pressure passes the largest one on the cells \[N/mm²\]: as far as cells a thousandth as wide show it, or as its
    /// rounding bounds it.
    pub beyond_n_per_mm2: f64,
    /// Whether it is rounded, so that its pressure has a bound.
    pub rounded: bool,
}

/// An edge on a line of cells: its place \[mm\], the change of slope, whether it is rounded, p/(π E*) that it reaches, and that on cells of
/// half the sides less that of the cells.
#[derive(Debug, Clone, Copy)]
struct OnLine {
    t: f64,
    kink: f64,
    rounded: bool,
    reached: f64,
    rise: f64,
}

/// Finds the edge in the contact whose pressure passes all others on fine cells: where it is sharp, there is no largest pressure. One that
/// is rounded counts if none is sharp. `None` where cells show all edges.
///
/// Method: on a line across an edge at which the slope of s rises by Δ, p grows by E* Δ/2π wherever cells are e times smaller, since
/// that of a plane wedge is E* Δ/2π ln(1/ξ). Where the slope rises, the line is halved until the rest is 1e-6 mm wide; if the slope turns
/// over more, p grows until cells are as wide as the part in which that counts most. Where a surface ends beside cells whose pressures rise
/// towards it, p grows with the root, as under a punch.
/// Cost: 1000 values of s. An edge that meets none of five lines across the contact along either axis is missed.
pub fn sharp_edge(pressures: &Pressures, placement: &Placement) -> Option<SharpEdge> {
    let on = OnLines(pressures);
    let mut evaluator = Evaluator::new(placement);
    let most = pressures.relative.iter().fold(0.0, |most: f64, p| most.max(*p));
    let mut worst: Option<(f64, SharpEdge)> = None;
    for axis in [0, 1] {
        for line in on.lines(axis, most) {
            let across = pressures.cells.middle(1 - axis, line as f64);
            let point = |t: f64| if axis == 0 { [t, across] } else { [across, t] };
            let mut gap = |t: f64| {
                let [xi, eta] = point(t);
                let (s, gradient) = evaluator.separation_and_gradient(xi, eta);
                [s, gradient[axis]]
            };
            let found = on.kinks(axis, line, most, &mut gap).into_iter();
            for OnLine { t, kink, rounded, reached, rise } in found.chain(on.steps(axis, line, &mut gap)) {
                let order = |rounded: bool, reached: f64| (!rounded, reached);
                let passed = worst.map_or((false, 0.0), |(reached, edge)| order(edge.rounded, reached));
                if reached > (1.0 + RISE) * most && order(rounded, reached) > passed {
                    let [rise_n_per_mm2, beyond_n_per_mm2] =
                        [rise, reached - most].map(|p| p * pressures.unit);
                    let edge = SharpEdge { at_mm: point(t), kink, rise_n_per_mm2, beyond_n_per_mm2, rounded };
                    worst = Some((reached, edge));
                }
            }
        }
    }
    worst.map(|(_, edge)| edge)
}

/// Pressures as lines of cells along either axis.
struct OnLines<'p>(&'p Pressures);

impl OnLines<'_> {
    /// Gives p/(π E*) \[1\] of a cell of a line along an axis; 0 beyond the cells.
    fn on_line(&self, axis: usize, line: usize, cell: usize) -> f64 {
        let [i, j] = if axis == 0 { [cell, line] } else { [line, cell] };
        if cell < self.0.cells.count[axis] { self.0.relative[i * self.0.cells.count[1] + j] } else { 0.0 }
    }

    /// Lists the kinks on a line of cells that pass the largest pressure, `most`; `gap` gives s and its slope.
    fn kinks(
        &self,
        axis: usize,
        line: usize,
        most: f64,
        gap: &mut impl FnMut(f64) -> [f64; 2],
    ) -> Vec<OnLine> {
        let Some([first, last]) = self.pressed(axis, line) else { return Vec::new() };
        let range =
            Interval::new(self.0.cells.middle(axis, first as f64), self.0.cells.middle(axis, last as f64));
        let cell = |t: f64| ((t - self.0.cells.from[axis]) / self.0.cells.step[axis]) as usize;
        let at = |k: usize| range.low + range.width() * k as f64 / PARTS as f64;
        let (mut out, [_, mut from]) = (Vec::new(), gap(range.low));
        for k in 0..PARTS {
            let part = Interval::new(at(k), at(k + 1));
            let [_, to] = gap(part.high);
            let here = part.ends().map(|t| self.on_line(axis, line, cell(t))).into_iter().fold(0.0, f64::max);
            let least = ((1.0 + RISE) * most - here) / (FINEST * GROWTH);
            if here > 0.0 {
                let side = self.0.cells.step[axis];
                out.extend(kink(gap, part, [from, to], (least, side)).map(|SlopeTurn { t, kink, folds }| {
                    let reached = here + folds * GROWTH * kink;
                    OnLine { t, kink, rounded: folds < FINEST, reached, rise: LN_2 * GROWTH * kink }
                }));
            }
            from = to;
        }
        out
    }

    /// Lists the ends of a surface on a line of cells towards which the pressures rise.
    fn steps(&self, axis: usize, line: usize, gap: &mut impl FnMut(f64) -> [f64; 2]) -> Vec<OnLine> {
        let Some([first, last]) = self.pressed(axis, line) else { return Vec::new() };
        let (step, ends) =
            (self.0.cells.step[axis], [(first, first + 1, -1.0), (last, last.wrapping_sub(1), 1.0)]);
        let found = ends.into_iter().filter_map(|(end, before, outwards)| {
            let pressure = self.on_line(axis, line, end);
            let t = self.0.cells.middle(axis, end as f64);
            let t = (pressure > self.on_line(axis, line, before))
                .then(|| surface_end(gap, [t, t + outwards * step]))??;
            let root = |finer: f64| pressure * finer.sqrt();
            let (reached, rise) = (root(FINEST.exp()), root(2.0) - pressure);
            Some(OnLine { t, kink: f64::INFINITY, rounded: false, reached, rise })
        });
        found.collect()
    }

    /// Lists the lines of cells along an axis on which edges are looked for: that of the largest pressure, and some spread over the contact.
    fn lines(&self, axis: usize, most: f64) -> Vec<usize> {
        let [columns, rows] = self.0.cells.count;
        let number = |cell: usize| if axis == 0 { cell % rows } else { cell / rows };
        let pressed = || (0..columns * rows).filter(|&cell| self.0.relative[cell] > 0.0).map(number);
        let (Some(first), Some(last)) = (pressed().min(), pressed().max()) else { return Vec::new() };
        let largest = self.0.relative.iter().position(|p| *p == most).map(number);
        let spread = (1..LINES).map(|k| first + (last - first) * k / LINES);
        largest.into_iter().chain(spread).collect()
    }

    /// Gives the first and the last cell of a line that is pressed; `None` of fewer than two.
    fn pressed(&self, axis: usize, line: usize) -> Option<[usize; 2]> {
        let mut on = (0..self.0.cells.count[axis]).filter(|&k| self.on_line(axis, line, k) > 0.0);
        let first = on.next()?;
        Some([first, on.next_back()?])
    }
}

/// A turn of s: its place \[mm\], the change of slope, and the e-folds by which cells may shrink until they show it.
#[derive(Debug, Clone, Copy)]
struct SlopeTurn {
    t: f64,
    kink: f64,
    folds: f64,
}

/// Finds where in a part of a line \[mm\] a slope rises most for the width of it, by at least `least`; `slopes` are those at both ends, and
/// `side` is that of a cell \[mm\]. Of several such places it is the one in the halves that rise most.
fn kink(
    gap: &mut impl FnMut(f64) -> [f64; 2],
    mut part: Interval,
    mut slopes: [f64; 2],
    (least, side): (f64, f64),
) -> Option<SlopeTurn> {
    let mut most: Option<SlopeTurn> = None;
    while slopes[1] - slopes[0] >= least {
        let (middle, kink) = (part.low + 0.5 * part.width(), slopes[1] - slopes[0]);
        let sharp = part.width() <= SHARP || middle <= part.low || middle >= part.high;
        let folds = if sharp { FINEST } else { (side / part.width()).ln().clamp(0.0, ROUNDED) };
        if most.is_none_or(|turn| folds * kink >= turn.folds * turn.kink) {
            most = Some(SlopeTurn { t: middle, kink, folds });
        }
        if sharp {
            break;
        }
        let [_, here] = gap(middle);
        let left = here - slopes[0] >= slopes[1] - here;
        *(if left { &mut part.high } else { &mut part.low }) = middle;
        slopes[usize::from(left)] = here;
    }
    most
}

/// Finds the place between two of a line \[mm\] at which s steps or ends; the first one has a surface.
fn surface_end(gap: &mut impl FnMut(f64) -> [f64; 2], [mut inside, mut outside]: [f64; 2]) -> Option<f64> {
    let [[mut here, _], [mut there, _]] = [gap(inside), gap(outside)];
    while (outside - inside).abs() > SHARP {
        let middle = inside + 0.5 * (outside - inside);
        let [s, _] = gap(middle);
        let beyond = s.is_nan() || (!there.is_nan() && (s - here).abs() > (there - s).abs());
        if beyond {
            (outside, there) = (middle, s);
        } else {
            (inside, here) = (middle, s);
        }
    }
    (there.is_nan() || (there - here).abs() > STEP).then_some(inside)
}

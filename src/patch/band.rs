//! Bands: parts of a component in which each ξ has one interval of η.

use super::grading::Grading;
use super::outline::{End, Outline};
use super::slice::Slice;
use super::stretch::{Fit, Stretch};
use super::varying::SMOOTH;
use crate::numerics::nan_max;
use crate::profile::Section;

/// Least step of a surface, in roundings of the profile's extent. A smaller one counts as a smooth joint.
const STEP_ROUNDINGS: f64 = 64.0;

/// Length, as a share of a band, of what lies between two corners that are one.
const ONE_CORNER: f64 = 1e-11;

/// Rounding of s in units of the rounding of the coordinates.
const ROUNDINGS: f64 = 4.0;

/// A range of ξ over which a component has one interval of η, whose ends vary without a jump.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Band {
    /// Range of ξ \[mm\].
    pub(crate) xi: [f64; 2],
    /// What bounds the band at either end of `xi`; `None` where the component continues in other bands.
    pub(crate) ends: [Option<End>; 2],
    /// Interval of η \[mm\] at either end of `xi`. It has no width at a tip.
    pub(crate) sides: [[f64; 2]; 2],
    /// Pairs (ξ, valleys) by ascending ξ, empty without skew: the valleys that lie in the band up to that ξ, the deepest
    /// first. Slices are found from the deepest valley.
    pub(super) valleys: Vec<(f64, Vec<usize>)>,
    /// Both ends of `xi`, and every ξ between them where a side may have a corner \[mm\], ascending.
    pub(crate) corners: Vec<f64>,
    /// The edges between the corners, as if there were no window in η; by ascending ξ.
    pub(super) stretches: Vec<Stretch>,
    /// Range of η of the window \[mm\].
    pub(super) window: [f64; 2],
}

impl Band {
    /// Returns the valleys in the band at ξ, the deepest first. There are none without skew.
    pub(super) fn valleys_at(&self, xi: f64) -> &[usize] {
        let k = self.valleys.partition_point(|(to, _)| *to < xi).min(self.valleys.len().saturating_sub(1));
        self.valleys.get(k).map_or(&[], |(_, valleys)| valleys)
    }

    /// Returns the valley from which the slice at ξ is found; `None` without skew.
    pub(crate) fn valley(&self, xi: f64) -> Option<usize> {
        self.valleys_at(xi).first().copied()
    }

    /// Makes a band without corners and stretches; [`Self::fit`] finds the latter.
    pub(super) fn new(xi: [f64; 2], ends: [Option<End>; 2], sides: [[f64; 2]; 2], window: [f64; 2]) -> Self {
        Self { xi, ends, sides, valleys: Vec::new(), corners: Vec::new(), stretches: Vec::new(), window }
    }

    /// Fits interpolants to the edges between the corners.
    pub(super) fn fit(&mut self, outline: &mut Outline<'_>) {
        let length = self.xi[1] - self.xi[0];
        let mut corners = vec![self.xi[0]];
        for &corner in &self.corners {
            let apart = |other: f64| (corner - other).abs() > ONE_CORNER * length;
            if apart(corners[corners.len() - 1]) && apart(self.xi[1]) {
                corners.push(corner);
            }
        }
        corners.push(self.xi[1]);
        let inside = |[low, high]: [f64; 2]| self.window[0] < low && high < self.window[1];
        let zero = [0, 1].map(|end| {
            let [low, high] = self.sides[end];
            low == high && (self.ends[end] == Some(End::Tip) || inside([low, high]))
        });
        let root = self.ends.map(|end| matches!(end, None | Some(End::ProfileEnd)));
        let noise = self.noise(outline);
        let mut stretches = Vec::new();
        // ξ, the square of half the width and the middle of the last two slices.
        let mut known = [[f64::NAN; 3]; 2];
        let edges = |xi: f64| {
            let valley = self.valley(xi);
            let edges = outline
                .slicer
                .edges_near(xi, extrapolated(&known, xi))
                .or_else(|| outline.slicer.edges(xi, valley).map(|edges| edges.map(|edge| edge.eta)));
            let [low, high] = edges.unwrap_or_else(|| [outline.slicer.valley(valley, xi); 2]);
            let half = (high - low) / 2.0;
            known = [known[1], [xi, half * half, low + half]];
            [low, high]
        };
        let mut fit = Fit { edges, band: self.xi, zero, root, noise };
        for pair in corners.windows(2) {
            fit.add([pair[0], pair[1]], &mut stretches);
        }
        self.stretches = stretches;
    }

    /// Returns the rounding of the square of half the width \[mm²\]: that of s, by what the square is per depth in the middle of the
    /// band.
    fn noise(&self, outline: &mut Outline<'_>) -> f64 {
        let rail = &outline.slicer.placement().rail().section;
        // The arc length is as large as both coordinates.
        let height = |xi: f64| if outline.slicer.is_over_rail() { xi.abs() } else { rail.height(xi).abs() };
        let size = self.xi.map(|xi| height(xi) + xi.abs());
        let middle = self.xi[0] + (self.xi[1] - self.xi[0]) / 2.0;
        let valley = self.valley(middle);
        let depth = outline.slicer.depth_over(valley, middle).abs();
        let square: f64 = outline
            .slicer
            .edges(middle, valley)
            .map_or(0.0, |[low, high]| ((high.eta - low.eta) / 2.0).powi(2));
        if outline.slicer.varying.is_some() {
            return SMOOTH * square;
        }
        ROUNDINGS * f64::EPSILON * square * (1.0 + nan_max(size[0], size[1]) / depth)
    }

    fn stretch(&self, xi: f64) -> Option<&Stretch> {
        let k = self.stretches.partition_point(|stretch| stretch.xi[1] < xi);
        self.stretches.get(k.min(self.stretches.len().saturating_sub(1)))
    }

    /// Returns the slice at ξ, which must lie within `xi`.
    pub(crate) fn slice(&self, xi: f64) -> Slice {
        if let Some(end) = (0..2).find(|&end| xi == self.xi[end]) {
            return Slice { eta: self.sides[end] };
        }
        let [low, high] = self.stretch(xi).map_or([f64::NAN; 2], |stretch| stretch.edges(xi));
        let [from, to] = self.window;
        Slice { eta: [low.max(from).min(to), high.min(to).max(from)] }
    }

    /// Returns the slice at ξ \[mm\], and dη/dξ of both its ends, which is infinite at a tip and 0 along the window.
    pub(super) fn edges_and_slopes(&self, xi: f64) -> ([f64; 2], [f64; 2]) {
        let Some(stretch) = self.stretch(xi) else { return ([f64::NAN; 2], [f64::NAN; 2]) };
        let (edges, slopes) = stretch.edges_and_slopes(xi);
        let [from, to] = self.window;
        let clipped = [edges[0].max(from).min(to), edges[1].min(to).max(from)];
        (clipped, [0, 1].map(|k| if clipped[k] == edges[k] { slopes[k] } else { 0.0 }))
    }

    /// Returns ξ as a function of t in \[0, 1\] in which the width of the band is smooth except at corners. An end at a
    /// window is not round.
    pub(crate) fn grading(&self) -> Grading {
        Grading { xi: self.xi, round: self.ends.map(|end| end != Some(End::Window)) }
    }

    /// Returns the ranges of t between neighbouring corners.
    pub(crate) fn pieces(&self) -> impl Iterator<Item = [f64; 2]> {
        let (grading, last) = (self.grading(), self.corners.len().saturating_sub(1));
        // The ends are exactly 0 and 1, in spite of rounding.
        let parameter = move |k: usize| match k {
            0 => 0.0,
            k if k == last => 1.0,
            k => grading.parameter(self.corners[k]),
        };
        (1..self.corners.len()).map(move |k| [parameter(k - 1), parameter(k)])
    }

    /// Returns whether the component continues in `next`: this band ends where `next` begins, and their slices overlap
    /// there.
    pub(crate) fn meets(&self, next: &Self) -> bool {
        self.xi[1] == next.xi[0] && overlap(self.sides[1], next.sides[0])
    }
}

/// Returns the edges \[mm\] at ξ that follow from two slices, each given by ξ, the square of half the width and the middle; NaN
/// if there are none.
fn extrapolated(&[[x, square, middle], [y, other, last]]: &[[f64; 3]; 2], xi: f64) -> [f64; 2] {
    let share = (xi - y) / (y - x);
    let half = (other + (other - square) * share).sqrt();
    let middle = last + (last - middle) * share;
    [middle - half, middle + half]
}

/// Returns whether two intervals have more than a point in common.
pub(super) fn overlap(a: [f64; 2], b: [f64; 2]) -> bool {
    a[0].max(b[0]) < a[1].min(b[1])
}

/// Returns the ξ inside (a, b) at which a body's surface steps or ends because its profile overhangs. `extent` is that of
/// the profile.
pub(super) fn steps(section: &Section, [a, b]: [f64; 2], extent: f64) -> impl Iterator<Item = f64> {
    let rounding = STEP_ROUNDINGS * f64::EPSILON * extent;
    let torn = move |k: usize| {
        let [left, right] = [&section.pieces[k - 1], &section.pieces[k]];
        left.xi[1] != right.xi[0] || (left.heights[1] - right.heights[0]).abs() > rounding
    };
    let torn = (1..section.pieces.len()).filter(move |&k| torn(k));
    let ends = torn.flat_map(|k| [section.pieces[k - 1].xi[1], section.pieces[k].xi[0]]);
    ends.filter(move |xi| a < *xi && *xi < b)
}
